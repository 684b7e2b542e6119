"""Point caches: PC2 and MDD, every header error, every truncation, every flipped bit."""
import math
import os
import struct
from pathlib import Path

import pytest

from support.tool.exported import read_ply
from support.tool.running import WINDOWS, fails, read_results, run, write_list

VERTICES, FRAMES = 5, 4
KINDS = pytest.mark.parametrize("kind", ["pc2", "mdd"])
ORDER = {"pc2": "<", "mdd": ">"}
HEADERS = {"pc2": 32, "mdd": 8 + 4 * FRAMES}
POINTS_AT, FRAMES_AT = {"pc2": 16, "mdd": 4}, {"pc2": 28, "mdd": 0}


def value(frame, vertex, axis):
    """What every cache has there; it is exact in float32."""
    return frame * 64 - vertex * 0.75 + axis * 0.0625 - 3.5 + 2 * (axis == vertex % 3)


def frame_of(frame, vertices=VERTICES):
    return [tuple(value(frame, v, axis) for axis in range(3)) for v in range(vertices)]


def cache(kind, vertices=VERTICES, frames=FRAMES):
    numbers = [number for frame in range(frames) for point in frame_of(frame, vertices) for number in point]
    if kind == "pc2":
        return b"POINTCACHE2\0" + struct.pack(f"<iiffi{len(numbers)}f", 1, vertices, 1.0, 0.5, frames, *numbers)
    times = [frame / 24 for frame in range(frames)]
    return struct.pack(f">ii{frames}f{len(numbers)}f", frames, vertices, *times, *numbers)


def changed(content, at, form, *numbers):
    packed = struct.pack(form, *numbers)
    return content[:at] + packed + content[at + len(packed) :]


def write_model(vertices=VERTICES):
    Path("model.obj").write_text("".join("v {} {} {}\n".format(*point) for point in frame_of(0, vertices)) + "f 1 2 3\n")


def errors_of(kind, contents):
    """What is said of each of these caches of the model: None of those that are read."""
    write_model()
    for i, content in enumerate(contents):
        Path(f"case{i}.{kind}").write_bytes(content)
    write_list("jobs.jsonl", *({"model": "model.obj", "frames": f"case{i}.{kind}"} for i in range(len(contents))))
    run("check --list jobs.jsonl --results out.jsonl --no-depths --quiet", code=1)
    errors = [line["error"] for _, line in sorted(read_results("out.jsonl").items())]
    os.remove("out.jsonl")
    unnamed = [error for i, error in enumerate(errors) if error is not None and f"case{i}.{kind}: " not in error]
    assert unnamed == [], unnamed
    return errors


def expect_errors(kind, table):
    errors = errors_of(kind, [content for content, *_ in table])
    for error, (_, *says) in zip(errors, table):
        assert error and all(text in error for text in says), (error, says)


def expect_frames(name, expected):
    run(f"check model.obj {name} --no-depths --quiet --ply out")
    assert [read_ply(path).points for path in sorted(Path().glob("out_*.ply"))] == expected


@pytest.mark.parametrize("kind, name", [
    ("pc2", "cache.pc2"), ("mdd", "cache.mdd"),
    # A PC2 file is known by its content.
    ("pc2", "without_extension"), ("pc2", "misnamed.mdd"), ("pc2", "misnamed.obj"), ("mdd", "percent_%d.MDD"),
])
def test_reads_both_formats(kind, name):
    write_model()
    Path(name).write_bytes(cache(kind))
    expect_frames(name, [frame_of(frame) for frame in range(FRAMES)])


def test_decodes_bytes_exactly():
    """1.5, -2 and 2^-149, every byte written out by hand, of each of three vertices."""
    write_model(3)
    header, point = [1, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0], [0, 0, 192, 63, 0, 0, 0, 192, 1, 0, 0, 0]
    Path("hand.pc2").write_bytes(b"POINTCACHE2\0" + bytes(header + 3 * point))
    header, point = [0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0, 0], [63, 192, 0, 0, 192, 0, 0, 0, 0, 0, 0, 1]
    Path("hand.mdd").write_bytes(bytes(header + 3 * point))
    for name in ("hand.pc2", "hand.mdd"):
        expect_frames(name, [[(1.5, -2.0, 2.0**-149)] * 3])


def test_reads_frames_of_many_vertices():
    """More than are read at a time, the last of them not finite in the last frame."""
    write_model(9001)
    Path("many.pc2").write_bytes(cache("pc2", 9001, 2))
    expect_frames("many.pc2", [frame_of(frame, 9001) for frame in range(2)])
    Path("many.pc2").write_bytes(cache("pc2", 9001, 2)[:-4] + b"\xff\xff\xff\xff")
    fails("check model.obj many.pc2 --no-depths --quiet", "sample 1, vertex 9000, z at byte 216052")


# ---- what is refused

def test_refuses_other_files():
    whole, other = cache("pc2"), cache("mdd")
    expect_errors("pc2", [
        (whole[:10] + b"\n" + whole[11:], 'not a PC2 file: starts with "POINTCACHE\\x0a\\x00"', 'expected "POINTCACHE2'),
        (other, "not a PC2 file"),
        (changed(whole, 12, "<i", 2), "PC2 version 2 at byte 12, expected 1"),
        # All of a header in the order of the other format.
        (changed(whole, 12, ">ii", 1, VERTICES), "its numbers are big-endian, and those of a PC2 file are little-endian"),
    ])
    expect_errors("mdd", [(changed(other, 0, "<ii", FRAMES, VERTICES),
                           "its numbers are little-endian, and those of an MDD file are big-endian")])


@KINDS
def test_refuses_wrong_counts(kind):
    whole, form = cache(kind), ORDER[kind] + "i"
    expect_errors(kind, [
        *((changed(whole, POINTS_AT[kind], form, points), f"holds {points} points, the model has 5 vertices",
           "it was exported from another mesh") for points in (VERTICES - 1, VERTICES + 1, 0, -1, -(2**31), 2**31 - 1)),
        *((changed(whole, FRAMES_AT[kind], form, frames), f"holds {frames} frames, expected at least 1")
          for frames in (0, -1, -(2**31))),
    ])


@KINDS
def test_refuses_every_truncation(kind):
    whole = cache(kind)
    expect_errors(kind, [(whole[:size], "too short") for size in range(len(whole))])


def test_says_how_far_the_size_is_off():
    whole, other = cache("pc2"), cache("mdd")
    expect_errors("pc2", [
        (whole[: 32 + 2 * 60 + 7], "too short: 159 bytes, expected 272 for 4 frames of 60 bytes", "room for 2 whole frames"),
        (whole + bytes(60), "too long: 332 bytes, expected 272", "room for 5 whole frames"),
    ])
    expect_errors("mdd", [(other + b"\0", "too long: 265 bytes, expected 264", "room for 4 whole frames"),
                          (other[:20], "too short: 20 bytes", "room for 0 whole frames")])


@KINDS
def test_survives_flipped_header_bits(kind):
    """A flipped bit in the times changes nothing; any other one is refused."""
    whole, times = cache(kind), range(20, 28) if kind == "pc2" else range(8, HEADERS[kind])
    bits = range(8 * HEADERS[kind])
    errors = errors_of(kind, [changed(whole, bit // 8, "B", whole[bit // 8] ^ 1 << bit % 8) for bit in bits])
    assert [error is None for error in errors] == [bit // 8 in times for bit in bits]


@KINDS
def test_refuses_values_that_are_not_finite(kind):
    at = HEADERS[kind] + 2 * 60 + 3 * 12 + 4
    expect_errors(kind, [(changed(cache(kind), at, ORDER[kind] + "f", number), f"sample 2, vertex 3, y at byte {at} is ", word,
                          "finite") for number, word in ((math.nan, "nan"), (math.inf, "inf"), (-math.inf, "inf"))])


def test_refuses_what_is_no_animation():
    write_model()
    fails("check model.obj missing.pc2", "missing.pc2: cannot open: No such file")
    Path("notes.txt").write_text("v 0 0 0")
    fails("check model.obj notes.txt", "notes.txt: ", "unknown extension", ".pc2", ".mdd", ".obj")
    if not WINDOWS:
        os.mkfifo("pipe.pc2")
        fails("check model.obj pipe.pc2", "pipe.pc2: ", "not a regular file")
