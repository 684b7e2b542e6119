"""Replays that end early keep what they have written."""
import os
import signal
import struct
import time
from pathlib import Path

import pytest

from support.tool.reading import read_contacts, read_json
from support.tool.recordings import cube, fold, tetrahedra
from support.tool.running import fails, finish, run, start, wait_until


def stopped(interval_count, frame_count, reason):
    """The JSON has these intervals and frames and says why it is not complete; the CSV has contacts of these intervals only."""
    root, contacts = read_json("out.json"), read_contacts("out.csv")
    total = root["summary"]
    assert total["complete"] is False and reason in total["stopped_by"]
    assert [interval["frame"] for interval in root["intervals"]] == list(range(interval_count))
    assert len(root["frames"]) == frame_count
    assert total["vf"] + total["ee"] == len(contacts) and all(contact.frame < interval_count for contact in contacts)


@pytest.mark.parametrize("frame, vertex, value, kept, reason", [
    (3, 5, "nan", (2, 3), "vertex 5"), (6, 0, "inf", (5, 6), "frame 6"), (0, 7, "nan", (0, 0), "frame 0"),
])
def test_a_bad_frame_keeps_the_intervals_before(frame, vertex, value, kept, reason):
    scene = tetrahedra(8)
    scene.write_mesh("model.obj")
    scene.write_cache("spoilt.pc2")
    with open("spoilt.pc2", "r+b") as file:
        file.seek(32 + (frame * 8 + vertex) * 12)
        file.write(struct.pack("<f", float(value)))
    fails("replay model.obj spoilt.pc2 --contacts out.csv --json out.json", f"frame {frame}", f"vertex {vertex}")
    stopped(*kept, reason)


def test_a_frame_of_another_size_keeps_the_intervals_before():
    tetrahedra(8).write_mesh("model.obj")
    tetrahedra(8).write_sequence("walk_%03d.obj")
    cube(False).write_mesh("walk_005.obj")
    fails("replay model.obj walk_%03d.obj --contacts out.csv --json out.json", "walk_005.obj", "12", "8")
    stopped(4, 5, "walk_005.obj")
    cube(False).write_cache("other.pc2")
    fails("replay model.obj other.pc2", "other.pc2", "12", "8")


def test_a_full_disk_is_an_error():
    tetrahedra(8).write_mesh("model.obj")
    tetrahedra(8).write_cache("frames.pc2")
    Path("full.csv").symlink_to("/dev/full")
    answer = run("replay model.obj frames.pc2 --contacts full.csv --json out.json", code=1)
    assert "full.csv: cannot write: No space left" in answer.error and read_json("out.json")["summary"]["complete"] is False
    assert "/dev/full: cannot write: No space left" in run("replay model.obj frames.pc2 --json /dev/full", code=1).error


def outputs_have(size):
    """Both outputs, which lie beside their places until they are whole, have that many bytes."""
    outputs = list(Path().glob(".cscd-output-*"))
    return len(outputs) == 2 and all(path.stat().st_size >= size for path in outputs)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_interrupt_keeps_what_is_written(number):
    """Brute force over a thousand features has far more intervals to do than it can finish before the signal."""
    scene = fold(30, 20, 2)
    scene.write_mesh("sheet.obj")
    scene.write_cache("sheet.pc2", 5000)
    process = start("replay sheet.obj sheet.pc2 --method brute --contacts out.csv --json out.json")
    wait_until(lambda: outputs_have(400), process)  # the contacts of two intervals
    process.send_signal(number)
    answer = finish(process, code=128 + number)
    done = len(read_json("out.json")["intervals"])
    assert 1 <= done < 4999 and "contacts: " in answer.out
    said = f"cscd: interrupted after {done} of 4999 intervals (frames 0 to {done}); "
    assert f"{said}what was found is kept in out.csv, out.json\n" in answer.error
    stopped(done, done + 1, "interrupted")


def interrupted_first(line):
    """Starts the tool, and interrupts it when its outputs have been begun."""
    process = start(line)
    wait_until(lambda: outputs_have(0), process)
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    return finish(process, code=130).error


def test_an_interrupt_ends_a_long_interval():
    """One interval that takes much longer than the signal needs is not waited for."""
    scene = fold(120, 80, 2)
    scene.write_mesh("large.obj")
    scene.write_cache("large.pc2")
    error = interrupted_first("replay large.obj large.pc2 --method brute --no-check --contacts out.csv --json out.json")
    assert "cscd: interrupted after 0 of 1 intervals; what was found is kept in " in error
    stopped(0, 1, "interrupted")


def test_an_interrupt_ends_a_long_frame():
    """Needles that lie across each other: every one of count crosses every one of another count."""
    count = 1500
    points = "".join(f"v -1 {i} -0.5\nv {count} {i} -0.5\nv 0 {i}.1 0.5\nv {i} -1 -0.5\nv {i} {count} -0.5\nv {i}.1 0 0.5\n"
                     for i in range(count))
    Path("needles.obj").write_text(points + "".join(f"f {v} {v + 1} {v + 2}\n" for v in range(1, 6 * count, 3)))
    error = interrupted_first("check needles.obj --csv out.csv --json out.json")
    assert "cscd: interrupted after 0 of 1 frames; what was found is kept in " in error
    root = read_json("out.json")
    assert (root["complete"], root["stopped_by"], root["frames"]) == (False, "interrupted", [])


def test_an_interrupted_preprocess_writes_nothing():
    """A signal during seconds of work stops it at once, and there is no plan, neither partial nor whole.

    One that comes before the tool has begun ends it as any program, without a sentence.
    """
    fold(200, 200, 1).write_mesh("wide.obj")
    for wait in (0.2, 0.4, 0.8, 1.6, 3.2, 6.4):
        process = start("preprocess wide.obj")
        time.sleep(wait)
        process.send_signal(signal.SIGINT)
        error = finish(process, code=130).error
        if error:
            break
    assert "interrupted; no plan was written" in error and not os.path.exists("wide.plan.ply")


def test_an_interrupt_keeps_the_frames_untangled_so_far():
    """Frames so far stay, as a whole file, with the numbers that they have."""
    sheet = fold(24, 16, 12)
    sheet.write_mesh("sheet.obj")
    sheet.write_cache("sheet.pc2", 4000)
    process = start("untangle sheet.obj sheet.pc2 -o clean.pc2 --first-frame 10 --json out.json")
    wait_until(lambda: any(path.stat().st_size > 20000 for path in Path().glob(".cscd-output-*")), process)
    process.send_signal(signal.SIGINT)
    answer = finish(process, code=130)
    root = read_json("out.json")
    done = len(root["frames"])
    assert 1 <= done < 4000 and (root["complete"], root["stopped_by"]) == (False, "interrupted")
    assert answer.first_line.startswith(f"Not finished: interrupted. {done} of 4000 frames done. Clean: ")
    said = f"cscd: interrupted after {done} of 4000 frames (frames 10 to {done + 9}); "
    assert f"{said}what was found is kept in clean.pc2, out.json" in answer.error
    data = Path("clean.pc2").read_bytes()
    assert struct.unpack("<f", data[20:24]) == (10.0,) and struct.unpack("<i", data[28:32]) == (done,)
    if done > 1:
        assert run("check sheet.obj clean.pc2").first_line.startswith("No frame crosses or touches")


def test_an_interrupt_of_a_mesh_keeps_the_best_so_far():
    """The best so far is an answer as any other."""
    sheet = fold(150, 100, 8)
    sheet.write_mesh("sheet.obj", 7)
    process = start("untangle sheet.obj -o out.obj --json out.json")
    wait_until(lambda: any(Path().glob(".cscd-output-*")), process)
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    answer = finish(process, code=130)
    frames = read_json("out.json")["frames"]
    assert answer.first_line.startswith("Not finished: interrupted. 1 of 1 frame done. ") and len(frames) == 1
    assert "cscd: interrupted after 1 of 1 frames" in answer.error and frames[0]["pairs_after"] <= frames[0]["pairs_before"]
    assert os.path.exists("out.obj") == frames[0]["clean"]
