"""The tool finds and writes files whatever their paths look like: names in UTF-8, long paths, the separators of the system.

It reads lines that end as on the other system; and whoever reads an output while it is replaced finds the older or the newer one.
"""
import os
import threading
import time
from pathlib import Path

import pytest

from support.tool.reading import lines_of, read_json
from support.tool.recordings import fold, tetrahedra
from support.tool.running import WINDOWS, fails, run

SCENE = tetrahedra(8)


def system_path(path):
    """As the system of the tool separates folders."""
    return str(path).replace("/", "\\") if WINDOWS else str(path)


def expect_replayed(folder, name):
    """Replays a recording, by cache and by frames, with every output beside it; the contacts have the bytes of Linux."""
    SCENE.write_mesh(folder / f"{name}.obj")
    SCENE.write_cache(folder / f"{name}.pc2")
    SCENE.write_sequence(f"{folder / name}-%03d.obj")
    model, cache, frames, csv, json, page = (system_path(folder / (name + ending)) for ending in (
        ".obj", ".pc2", "-%03d.obj", ".csv", ".json", ".html"))
    for motion in (cache, frames):
        run("replay", model, motion, "--contacts", csv, "--json", json, "--report", page, "--quiet")
        text = (folder / f"{name}.csv").read_bytes()
        assert len(lines_of(text.decode())) > 1 and b"\r" not in text
        assert read_json(folder / f"{name}.json")["summary"]["complete"] is True
        for ending in ("csv", "json", "html"):
            (folder / f"{name}.{ending}").unlink()


def expect_part(folder, name):
    """A mesh in one piece is called by its file's name, without folder and ending."""
    sheet = fold(12, 8, 6)
    sheet.write_mesh(folder / f"{name}.obj")
    sheet.write_cache(folder / "folding.pc2")
    assert f"\n{name} x itself" in run("check", system_path(folder / f"{name}.obj"), system_path(folder / "folding.pc2")).out


def expect_plan(folder, name):
    """It lies beside the model, where a replay finds it."""
    model = system_path(folder / f"{name}.obj")
    run("preprocess --method kmeans:2 --quiet", model)
    assert (folder / f"{name}.plan.ply").is_file()
    assert f"{name}.plan.ply" in run("replay", model, system_path(folder / f"{name}.pc2")).out


NAME = "K\u00f6rper \u5f62 \U0001f9ca"  # letters of two, three and four bytes


def test_names_are_utf8(own_folder):
    folder = own_folder / f"Ordner {NAME}"
    folder.mkdir()
    expect_replayed(folder, NAME)
    expect_plan(folder, NAME)
    run("render --frame 5", folder / f"{NAME}.obj", folder / f"{NAME}.pc2", "-o", folder / f"{NAME}.png")
    assert (folder / f"{NAME}.png").is_file()
    expect_part(folder, f"{NAME} sheet")
    fails(f"check '{folder / NAME} is not there.obj'", f"{NAME} is not there.obj", "No such file")


def test_paths_are_long(own_folder):
    """260 characters were all that Windows took; it still takes no longer one for the current folder."""
    folder, name = own_folder / ("f" * 96), "n" * 160
    folder.mkdir()
    assert len(str(folder / name)) > 260
    expect_replayed(folder, name)


def test_short_names_are_in_long_folders(own_folder, monkeypatch):
    """Each name is short, and the path that the system makes of it is not."""
    folder = own_folder / ("f" * (239 - len(str(own_folder))))
    folder.mkdir()
    monkeypatch.chdir(folder)
    expect_replayed(Path(), "a name of 23 bytes.....")


def test_backslashes_separate(own_folder):
    """On Windows; elsewhere a backslash is a letter like others. The folder is what precedes the last of either."""
    if WINDOWS:
        expect_replayed(own_folder, "pair")
        expect_plan(own_folder, "pair")
    expect_part(own_folder, "sheet" if WINDOWS else "left\\right")


def test_names_are_bytes(own_folder):
    """Quotes, a backslash, a tab, characters beyond ASCII, and a byte that is no UTF-8. On Windows names are text."""
    model, cache = "\"Mod\\ell\"\t\u00e4\u20ac.obj", os.fsdecode(b"'\xff frames\x01.pc2")
    if WINDOWS:
        model, cache = "model.obj", "frames.pc2"
    SCENE.write_mesh(model)
    SCENE.write_cache(cache)
    run("replay", model, cache, "--json", "\u65e5 out.json")
    inputs = read_json("\u65e5 out.json")["provenance"]["inputs"]
    assert [each["name"] for each in inputs] == [model, cache.encode("utf-8", "surrogateescape").decode("utf-8", "replace")]


@pytest.mark.parametrize("model", ["model.obj", "model.ply"])
def test_lines_end_either_way(own_folder, model):
    """Models, tables and lists, with the line ends of either system."""
    SCENE.write_mesh(model)
    SCENE.write_cache("frames.pc2")
    Path("ignore.txt").write_text("# rests\n0 4\n1 5\n")
    Path("parts.csv").write_text("triangle,name\n" + "".join(f"{t},{'Wall' if t < 4 else 'Dart'}\n" for t in range(8)))
    outputs = []
    for end in (b"\n", b"\r\n"):
        for name in (model, "ignore.txt", "parts.csv"):
            Path(name).write_bytes(Path(name).read_bytes().replace(b"\n", end))
        run(f"check {model} frames.pc2 --ignore ignore.txt --parts parts.csv --events out.csv --json out.json --quiet")
        outputs.append((Path("out.csv").read_bytes(), Path("out.json").read_bytes()))
    assert outputs[0] == outputs[1] and b"\r" not in outputs[0][0] and outputs[0][0].count(b"\n") > 1


def test_an_output_is_replaced_in_one_step():
    """Who reads it over and over finds it there, and whole."""
    SCENE.write_mesh("pair.obj")
    SCENE.write_cache("pair.pc2")
    run("check pair.obj pair.pc2 --json out.json --quiet --reproducible")
    whole, found, ends = Path("out.json").read_bytes(), [], threading.Event()

    def watch():
        while not ends.is_set():
            found.append(Path("out.json").read_bytes())
            time.sleep(0.0002)

    watcher = threading.Thread(target=watch)
    watcher.start()
    for _ in range(20):
        run("check pair.obj pair.pc2 --json out.json --quiet --reproducible")
    ends.set()
    watcher.join()
    assert len(found) > 20 and set(found) == {whole}


def test_an_open_output_is_replaced():
    """As a page that a browser shows: it keeps nobody from writing the next one, and stays as it was."""
    SCENE.write_mesh("pair.obj")
    Path("out.json").write_text("what was there")
    with open("out.json", encoding="utf-8") as reader:
        run("check pair.obj --json out.json --quiet")
        assert reader.read() == "what was there"
    assert read_json("out.json")
