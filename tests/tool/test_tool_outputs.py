"""What a command writes takes the place of an older file when it is whole, and "-" is the standard output."""
import os
import shutil
import signal
import time
from pathlib import Path

import pytest

from support.tool.reading import json_of
from support.tool.recordings import balls, fold, tetrahedra
from support.tool.running import finish, limited_to, run, start, usage_error

FULL_DISK = 600
OLDER = "what was there"


@pytest.fixture(autouse=True)
def files(own_folder):
    for name, scene in (("pair", tetrahedra(8)), ("sheet", fold(30, 20, 6))):
        scene.write_mesh(f"{name}.obj")
        scene.write_cache(f"{name}.pc2")


def fails_on_a_full_disk(line):
    """Runs the tool where no file may have more than FULL_DISK bytes."""
    error = run(line, code=1, preexec_fn=limited_to(FULL_DISK)).error
    assert error.count("File too large") == 1
    assert ": File too large: a limit of the system on the size of files; raise it" in error


@pytest.mark.parametrize("line, output", [
    ("check sheet.obj sheet.pc2 --quiet --json", "old.json"),
    ("replay sheet.obj sheet.pc2 --quiet --json", "old.json"),
    ("sense pair.obj pair.pc2 --quiet --json", "old.json"),
    ("render sheet.obj -o", "old.png"),
    ("replay pair.obj pair.pc2 --quiet --report", "old.html"),
    ("untangle sheet.obj -o", "old.obj"),
    ("untangle pair.obj pair.pc2 -o", "old.pc2"),
])
def test_a_full_disk_leaves_the_older_file(line, output):
    """It is there, byte for byte, and nothing beside it."""
    Path(output).write_text(OLDER)
    before = sorted(os.listdir())
    fails_on_a_full_disk(f"{line} {output}")
    assert Path(output).read_text() == OLDER and sorted(os.listdir()) == before


def test_a_full_disk_leaves_the_good_plan():
    run("preprocess sheet.obj --method kmeans:3 --quiet")
    good, before = Path("sheet.plan.ply").read_bytes(), sorted(os.listdir())
    fails_on_a_full_disk("preprocess sheet.obj --method single --quiet")
    assert Path("sheet.plan.ply").read_bytes() == good and sorted(os.listdir()) == before


def test_a_full_disk_keeps_the_contacts_of_own_intervals():
    """Hours of contacts are not lost because the disk has no room for the last of them."""
    tetrahedra(8).write_cache("often.pc2", 60)
    run("replay pair.obj often.pc2 --csv whole.csv --quiet")
    fails_on_a_full_disk("replay pair.obj often.pc2 --csv cut.csv --quiet")
    whole, cut = Path("whole.csv").read_bytes(), Path("cut.csv").read_bytes()
    assert 300 < len(cut) <= FULL_DISK < len(whole)
    assert whole.startswith(cut) and cut.endswith(b"\n")


def test_a_killed_replay_leaves_the_older_files():
    fold(30, 20, 2).write_cache("long.pc2", 5000)
    for name in ("old.json", "old.csv"):
        Path(name).write_text(OLDER)
    before = len(os.listdir())
    process = start("replay sheet.obj long.pc2 --method brute --contacts old.csv --json old.json")
    while len(os.listdir()) < before + 2 and process.poll() is None:
        time.sleep(0.002)
    process.kill()
    finish(process, code=128 + signal.SIGKILL)
    assert Path("old.json").read_text() == Path("old.csv").read_text() == OLDER and len(os.listdir()) == before + 2


def test_inputs_are_replaced_only_by_name():
    """-o in the words of MODEL or FRAMES is meant; a link to it, or any other input, is not."""
    balls(1.6).write_mesh("balls.obj")
    balls(1.6, 2.1).write_cache("balls.pc2")
    Path("link.obj").symlink_to("balls.obj")
    usage_error("untangle balls.obj -o link.obj", "-o 'link.obj' would overwrite 'balls.obj'")
    usage_error("untangle balls.obj --obstacle other=link.obj -o link.obj", "would overwrite")
    shutil.copy("balls.obj", "mine.obj")
    run("untangle mine.obj -o mine.obj --quiet")
    shutil.copy("balls.pc2", "mine.pc2")
    run("untangle balls.obj mine.pc2 -o mine.pc2 --quiet")
    assert run("check mine.obj").first_line.startswith("Clean:")
    assert run("check balls.obj mine.pc2").first_line.startswith("No frame")


# ---- the standard output


@pytest.mark.parametrize("line, output", [
    ("check pair.obj pair.pc2 --json", "out.json"),
    ("replay pair.obj pair.pc2 --json", "out.json"),
    ("replay pair.obj pair.pc2 --contacts", "out.csv"),
    ("replay pair.obj pair.pc2 --csv", "out.csv"),
    ("replay pair.obj pair.pc2 --ignore-rest --csv", "out.csv"),
    ("sense pair.obj pair.pc2 --json", "out.json"),
    ("sense pair.obj pair.pc2 --csv", "out.csv"),
])
def test_a_dash_is_the_standard_output(line, output):
    """It gets the file that the same command writes, and the standard error what people read."""
    assert run(f"{line} {output}").out != ""
    answer = run(f"{line} -")
    assert " cross" in answer.error or "warnings" in answer.error
    if output == "out.csv":
        assert answer.out == Path(output).read_text()
    else:
        assert list(json_of(answer.out)) == list(json_of(Path(output).read_text()))


@pytest.mark.parametrize("command", ["replay", "sense"])
def test_two_dashes_are_refused(command):
    usage_error(f"{command} pair.obj pair.pc2 --json - --csv -", "standard output twice")


@pytest.mark.parametrize("line, name, ending", [
    ("render sheet.obj -o", "x.jpg", ".png"),
    ("replay sheet.obj sheet.pc2 --report", "x.PDF", ".html"),
    ("replay sheet.obj sheet.pc2 --json", "x.csv", ".json"),
    ("preprocess sheet.obj --report", "x.pdf", ".html"),
    ("check sheet.obj --json", "x.html", ".json"),
    ("sense sheet.obj sheet.pc2 --picture", "x.tiff", ".png"),
    ("sense sheet.obj sheet.pc2 --csv", "x.json", ".csv"),
    ("report a.json -o", "x.txt", ".html"),
])
def test_names_of_other_formats_are_refused(line, name, ending):
    """A name that says another format than the one that would be written is refused, and no file is there."""
    before = sorted(os.listdir())
    usage_error(f"{line} {name}", f"'{name}'", f"ends in {ending}")
    assert sorted(os.listdir()) == before


def test_a_frame_number_is_no_ending():
    run("render sheet.obj --size 32x24 -o frame.0012")
