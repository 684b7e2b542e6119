"""What the tool makes of a file of a mesh: every frame as it exports it, or what it says of one that is wrong."""
import os
from pathlib import Path

from support.tool.exported import read_ply
from support.tool.mesh_files import HALVES, SQUARE
from support.tool.reading import read_json
from support.tool.running import read_results, run, write_list


def write_file(path, content):
    """Writes a text or bytes; returns the path."""
    Path(path).write_bytes(content.encode("utf-8") if isinstance(content, str) else content)
    return path


def frames_read(content, name="mesh.glb", options=""):
    """The frames of a file, exactly as they were read: no vertices are joined."""
    write_file(name, content)
    for path in Path().glob("out_*.ply"):
        path.unlink()
    run(f"check {name} --weld none --no-depths --quiet --ply out --json out.json {options}")
    return [read_ply(path) for path in sorted(Path().glob("out_*.ply"))]


def expect_mesh(content, points, triangles, name="mesh.glb", options=""):
    """A file of one frame has these points and triangles, to the last bit."""
    (mesh,) = frames_read(content, name, options)
    assert mesh.points == [tuple(map(float, point)) for point in points] and mesh.triangles == [tuple(each) for each in triangles]


def errors_of(contents, name="mesh.glb", **members):
    """What the tool says of each file, all of which it must refuse, without its name. members: of their jobs."""
    for i, content in enumerate(contents):
        os.makedirs(f"case{i}", exist_ok=True)
        write_file(f"case{i}/{name}", content)
    write_list("jobs.jsonl", *({"model": f"case{i}/{name}", **members} for i in range(len(contents))))
    run("check --list jobs.jsonl --results out.jsonl --quiet", code=1)
    errors = [line["error"] for _, line in sorted(read_results("out.jsonl").items())]
    os.remove("out.jsonl")
    assert all(error and error.count(f"{name}:") == 1 and "\n" not in error for error in errors), errors
    return [error.split(f"{name}:")[1] for error in errors]


def expect_errors(table, **options):
    """table: rows of a content and the texts that are in what is said of it."""
    errors = errors_of([content for content, *_ in table], **options)
    missing = [(error, says) for error, (_, *says) in zip(errors, table) if not all(text in error for text in says)]
    assert missing == [], missing


def expect_squares(contents, name):
    """Each of these files is the square of two triangles."""
    for content in contents:
        expect_mesh(content, SQUARE, HALVES, name)


def info_of(content, name="mesh.glb", options=""):
    """What --json of info says of a file."""
    run(f"info {write_file(name, content)} --json info.json {options}")
    return read_json("info.json")


def expect_parts(content, names, name, parts_by=None):
    """The parts of a file, and what each triangle is in; names: of the triangles' parts, None for none."""
    options = f"--parts-by {parts_by}" if parts_by else ""
    (mesh,) = frames_read(content, name, options)
    known = mesh.named("part") if any(names) else {}
    assert [known.get(part) for part in mesh.faces("part")] == names


def shown(most):
    """What is shown of a name, which has a two-byte character across the byte where it is cut."""
    return "x" * (most - 1)


def whole(most):
    """The name itself."""
    return shown(most) + "\u00e9tail"
