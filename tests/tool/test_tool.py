"""The tool's command line: usage errors, bad input, and outputs that must not overwrite anything."""
import os
from pathlib import Path

import pytest

from support.tool.recordings import tetrahedra
from support.tool.running import fails, run, usage_error

COMMANDS = ("preprocess", "replay", "check", "info", "render")


@pytest.fixture(autouse=True)
def scene(own_folder):
    scene = tetrahedra(6)
    scene.write_mesh("model.obj")
    scene.write_cache("frames.pc2")
    return scene


def says(line, text):
    answer = run(line)
    assert text in answer.out and answer.error == ""


def test_says_its_version():
    says("--version", "cscd 2.0.0 (")


def test_helps_on_every_command():
    says("--help", "usage: cscd COMMAND")
    says("help", "usage: cscd COMMAND")
    for command in COMMANDS:
        says(f"{command} --help", f"usage: cscd {command} MODEL")
        says(f"help {command}", f"usage: cscd {command} MODEL")
        says("--help", command)
    usage_error("help play", "unknown command 'play'")


@pytest.mark.parametrize("command", COMMANDS)
def test_refuses_unknown_options(command):
    usage_error(f"{command} --fast model.obj", "unknown option '--fast'", command)
    usage_error(f"{command} model.obj -xy", "unknown option '-x'")
    usage_error(f"{command} model.obj --weld", "--weld needs a value")
    usage_error(f"{command} --weld=loosely model.obj", "--weld cannot be 'loosely'")
    usage_error(command, "MODEL")


@pytest.mark.parametrize("line, says", [
    ("", "no command given"),
    ("play", "unknown command 'play'"),
    ("play", "'cscd --help'"),
    ("replay model.obj", "no FRAMES given"),
    ("render model.obj", "no -o"),
    ("info model.obj model.obj", "one MODEL"),
    ("render model.obj -o a.png --frame x", "--frame cannot be 'x'"),
    ("render model.obj -o a.png --colour=red", "--colour cannot be 'red'"),
    ("render model.obj -o a.png --size 9x9", "--size cannot be '9x9'"),
    ("render model.obj -o", "-o needs a value"),
])
def test_refuses_unfit_lines(line, says):
    usage_error(line, says)


@pytest.mark.parametrize("option, values", [
    ("--frames", ["a:b", "3:1", ":", "", "1:2:0", "-:2", "4294967296:"]),
    ("--method", ["icc", "kmeans:0", "kmeans:x"]),
    ("--mode", ["some"]),
    ("--threads", ["-1", "257", "two"]),
    ("--weld", ["-1", "0", "nan"]),
    ("--contacts", ["out.txt", ".csv"]),
    ("--start", ["maybe"]),
])
def test_refuses_unfit_values(option, values):
    for value in values:
        usage_error(f"replay model.obj frames.pc2 {option} '{value}'", option, value)


@pytest.mark.parametrize("line, says", [
    *((f"replay model.obj frames.pc2 --frames {frames}", "frames 0 to 5") for frames in ("0:6", "6:", "9:12", ":6")),
    ("check model.obj frames.pc2 --frames 6", "frames 0 to 5"),
    ("replay model.obj frames.pc2 --frames 3", "an interval needs two frames"),
    ("replay model.obj frames.pc2 --frames 5:", "an interval needs two frames"),
    ("replay model.obj model.obj", "an interval needs two frames"),
])
def test_refuses_frames_that_are_not_there(line, says):
    fails(line, says)


@pytest.mark.parametrize("line", [
    "replay missing.obj frames.pc2", "replay model.obj missing.obj", "replay model.obj missing.pc2", "check missing.obj",
    "info missing.obj", "render missing.obj -o a.png", "replay model.obj frames.pc2 --ignore missing.list",
])
def test_names_missing_files(line):
    fails(line, next(word for word in line.split() if "missing" in word), "No such file")


def test_names_a_pattern_without_files():
    fails("replay model.obj none_%04d.obj", "none_%04d.obj")


@pytest.mark.parametrize("text, line", [
    ("v 0 0 0\nv 1 0 0\nv 0 one 0\nf 1 2 3\n", "bad.obj:3: "),
    ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "bad.obj:4: "),
    ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n", "no faces found"),
])
def test_names_the_line_of_a_malformed_mesh(text, line):
    Path("bad.obj").write_text(text)
    for command in ("info bad.obj", "replay bad.obj frames.pc2", "check bad.obj"):
        fails(command, "bad.obj", line)


def test_names_the_bytes_of_a_truncated_cache():
    whole = Path("frames.pc2").read_bytes()
    Path("cut.pc2").write_bytes(whole[:-5])
    fails("replay model.obj cut.pc2", "cut.pc2", "byte", len(whole) - 5, len(whole))


@pytest.mark.parametrize("line, output", [
    ("replay model.obj frames.pc2 --contacts", "out.csv"),
    ("replay model.obj frames.pc2 --json", "out.json"),
    ("check model.obj --json", "out.json"),
    ("render model.obj -o", "out.png"),
])
def test_refuses_outputs_that_it_cannot_write(line, output):
    """Nothing is computed, and only the error is printed."""
    path = os.path.abspath(f"no/such/folder/{output}")
    answer = run(line, path, code=1)
    assert answer.out == "" and path in answer.error and answer.error.count("\n") == 1


def test_never_overwrites_an_input(own_folder):
    Path("list.txt").write_text("# no pairs\n")
    Path("linked.csv").symlink_to("frames.pc2")
    before = {name: Path(name).read_bytes() for name in ("model.obj", "frames.pc2", "list.txt")}
    for line in (
        "replay model.obj frames.pc2 --json model.obj",
        f"replay model.obj frames.pc2 --json ../{own_folder.name}/model.obj",
        "replay --json frames.pc2 model.obj frames.pc2",
        "replay model.obj frames.pc2 --contacts linked.csv",
        "replay model.obj frames.pc2 --json list.txt --ignore list.txt",
        "replay model.obj frames.pc2 --json same.csv --contacts same.csv",
        "check model.obj frames.pc2 --json frames.pc2",
        "render model.obj frames.pc2 -o frames.pc2",
    ):
        usage_error(line, "would overwrite")
    usage_error("replay model.obj frames.pc2 --json missing.obj", "named like")
    assert before == {name: Path(name).read_bytes() for name in before}


def test_names_the_first_ranges_of_a_long_recording(scene):
    def ranges(frame_count):
        scene.write_cache("cycle.pc2", frame_count)
        return run("replay model.obj cycle.pc2").out.split("; from frame ")[1].split("\n")[0]

    assert ranges(31).count(",") < 19 and "others" not in ranges(31)
    assert ranges(1001).count(",") == 19 and ranges(1001).endswith(" and others")
