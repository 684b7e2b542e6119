"""What cannot be written is said once, with its name and the reason, whichever output of whichever command it is."""
from pathlib import Path

import pytest

from support.tool.recordings import tetrahedra
from support.tool.running import fails, run, write_list

REASON = "No space left on device"


@pytest.fixture(autouse=True)
def files(own_folder):
    """Names of a disk without room, with the endings that outputs have."""
    scene = tetrahedra(8)
    scene.write_mesh("model.obj")
    scene.write_cache("frames.pc2")
    for ending in ("csv", "json", "jsonl", "html", "xml", "png", "ply"):
        Path(f"full.{ending}").symlink_to("/dev/full")


@pytest.mark.parametrize("line", [
    "check model.obj frames.pc2 --json full.json",
    "check model.obj frames.pc2 --csv full.csv",
    "check model.obj frames.pc2 --events full.csv",
    "check model.obj frames.pc2 --junit full.xml",
    "check model.obj frames.pc2 --select full.json",
    "check model.obj frames.pc2 --csv full.csv --json full.json",
    "replay model.obj frames.pc2 --contacts full.csv",
    "replay model.obj frames.pc2 --contacts full.jsonl",
    "replay model.obj frames.pc2 --json full.json",
    "replay model.obj frames.pc2 --report full.html",
    "replay model.obj frames.pc2 --json full.json --report full.html --contacts full.csv",
    "sense model.obj frames.pc2 --csv full.csv",
    "sense model.obj frames.pc2 --json full.json",
    "sense model.obj frames.pc2 --picture full.png",
    "preprocess model.obj -o full.ply",
    "preprocess model.obj -o plan.ply --report full.html",
    "render model.obj -o full.png",
    "info model.obj --json full.json",
])
def test_a_full_disk_is_said_once(line):
    """Of several outputs the last of these."""
    fails(line, f"{line.split()[-1]}: cannot write", REASON)


def test_a_full_disk_is_said_once_by_what_reads_results():
    write_list("list.jsonl", {"model": "model.obj"})
    run("check --list list.jsonl --results results.jsonl --quiet")
    run("replay model.obj frames.pc2 --json run.json --quiet")
    for line in ("report run.json -o full.html", "report results.jsonl -o full.html", "merge results.jsonl -o full.jsonl",
                 "merge results.jsonl --junit full.xml"):
        fails(line, f"{line.split()[-1]}: cannot write", REASON)
    for line in ("check --list list.jsonl --results full.jsonl", "check --each model.obj --json full.jsonl"):
        fails(line, "full.jsonl: cannot write", REASON, code=4)


@pytest.mark.parametrize("line", [
    "check model.obj frames.pc2", "info model.obj", "--version", "check model.obj frames.pc2 --quiet --json -",
    "replay model.obj frames.pc2 --quiet --json -",
])
def test_a_full_standard_output_is_said_once(line):
    """It has no name of its own, and what is printed beside a JSON goes elsewhere."""
    with open("/dev/full", "w") as full:
        assert run(line, code=1, stdout=full).error == f"cscd: standard output: cannot write: {REASON}\n"
