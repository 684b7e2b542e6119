"""`replay --shard` and `merge`: the shards of a recording give what one run gives, byte for byte."""
import fcntl
import os
import shutil
import signal
import time
from pathlib import Path

import pytest

from support.tool.reading import read_csv, read_json, read_json_lines
from support.tool.recordings import fold, spindle
from support.tool.running import SLOW_MACHINE, fails, finish, limited_to, run, start, usage_error

FOLD, SPINDLE = "fold.obj fold.pc2", "spindle.obj spindle.pc2"
CLOSED = f"{SPINDLE} --method single"
OUTPUTS = "--contacts {0}.contacts.csv --events {0}.events.csv --json {0}.summary.json --report {0}.page.html"
ENDINGS = ("contacts.csv", "events.csv", "summary.json", "page.html")


@pytest.fixture(scope="module")
def scenes(tmp_path_factory):
    """A fold that opens and closes, in five chunks, so that events go on over their borders; and a closed body."""
    folder = tmp_path_factory.mktemp("scenes")
    for name, scene, frame_count in (("fold", fold(8, 6, 12), 150), ("spindle", spindle(12, 8, 14), 70)):
        scene.write_mesh(folder / f"{name}.obj")
        scene.write_cache(folder / f"{name}.pc2", frame_count)
    return folder


@pytest.fixture(autouse=True)
def files(own_folder, scenes):
    for path in scenes.iterdir():
        shutil.copy(path, own_folder)


# ---- runs


def whole_run(options):
    run(f"replay {options} --quiet --reproducible {OUTPUTS.format('one')}")


def shard_run(options, shard, count, code=0):
    run(f"replay {options} --quiet --shard {shard}/{count} --results {shard}.shard", code=code)


def all_shards(options, count, code=0):
    for path in Path().glob("*.shard"):
        path.unlink()
    for shard in range(1, count + 1):
        shard_run(options, shard, count, code)


def merged_as_one():
    run(f"merge --quiet --reproducible {OUTPUTS.format('merged')}", *sorted(Path().glob("*.shard")))
    for ending in ENDINGS:
        assert Path(f"one.{ending}").read_bytes() == Path(f"merged.{ending}").read_bytes(), ending


# ---- the same bytes


WHOLE_RUNS = [
    FOLD,
    f"{FOLD} --no-check",  # each shard proves its start
    f"{FOLD} --frames 11:100 --no-depths --first-frame 1",
    # Orientations and detector points come from the files of the shards.
    f"{SPINDLE} --method kmeans:4",
    f"{CLOSED} --mode earliest",
    f"{SPINDLE} --method charge",
    f"{SPINDLE} --method iccd",
    f"{SPINDLE} --method brute",
    # Two objects, one closed and at rest, of which more is promised than of the open one.
    f"{FOLD} --object Spindle=spindle.obj --method single --mode earliest",
]


@pytest.mark.parametrize("options", WHOLE_RUNS[:: 3 if SLOW_MACHINE else 1])
def test_shards_give_what_one_run_gives(options):
    whole_run(options)
    for count in (1, 3, 5, 7):
        all_shards(options, count)
        merged_as_one()
    if options == FOLD:
        assert len(read_csv("one.contacts.csv")) > 99 and len(read_csv("one.events.csv")) > 2
    if "--object" in options:
        reasons = [each["reason"] for interval in read_json("one.summary.json")["intervals"] for each in interval["guarantee"]
                   if each["count"] == 1]
        assert any("embedded" in reason for reason in reasons) and any(reason.startswith("open") for reason in reasons)


def test_exit_code_and_words_are_those_of_one_run():
    all_shards(FOLD, 2)
    assert run("merge 1.shard 2.shard").out == run(f"replay {FOLD}").out
    all_shards(f"{FOLD} --fail-on crossing", 2, code=3)
    run("merge 1.shard 2.shard --quiet", code=3)


def test_without_reproducible_there_are_times():
    all_shards(FOLD, 3)
    run("merge 1.shard 2.shard 3.shard --quiet --json timed.json")
    root = read_json("timed.json")
    assert "total_ms" in root["summary"] and "date" in root["provenance"]


# ---- stopped and resumed


def test_a_shard_that_was_stopped_goes_on():
    """A file that ends anywhere is gone on with, and ends as if nothing had happened.

    A closed body, so that counters depend on where its detector started.
    """
    whole_run(CLOSED)
    all_shards(CLOSED, 1)
    size = os.path.getsize("1.shard")
    for cut in (size, size - 1, size * 2 // 3, size // 2, size * 2 // 5, 400, 120, 80, 40, 1):
        os.truncate("1.shard", cut)
        run(f"replay {CLOSED} --quiet --results 1.shard --resume")
        merged_as_one()


def test_a_shard_that_is_killed_loses_nothing():
    """Killed at any moment, again and again."""
    whole_run(CLOSED)
    for i in range(12):
        process = start(f"replay {CLOSED} --quiet --results 1.shard --resume")
        time.sleep(0.001 * (1 + 3 * i))
        process.kill()
        finish(process, code=0 if process.wait() == 0 else 128 + signal.SIGKILL)
    run(f"replay {CLOSED} --quiet --results 1.shard --resume")
    merged_as_one()


def test_a_full_disk_loses_nothing():
    """The disk is full after ever more bytes: what is whole is kept, and the next run goes on with it."""
    whole_run(CLOSED)
    run(f"replay {CLOSED} --quiet --results 1.shard")
    whole = os.path.getsize("1.shard")
    for size in (0, 1, 100, whole // 3, whole // 2, whole - 1):
        os.unlink("1.shard")
        error = run(f"replay {CLOSED} --quiet --results 1.shard", code=1, preexec_fn=limited_to(size)).error
        assert "1.shard: cannot write: File too large" in error
        run(f"replay {CLOSED} --quiet --results 1.shard --resume")
        merged_as_one()


def test_results_are_not_written_over():
    all_shards(FOLD, 1)
    fails(f"replay {FOLD} --results 1.shard", "1.shard", "--resume")
    fails(f"replay {FOLD} --results 1.shard --resume --no-check", "other options", "resumed")
    fails(f"replay {SPINDLE} --results 1.shard --resume", "results of another model")
    fails(f"replay {FOLD} --results 1.shard --resume --shard 1/2", "another number of shards")
    all_shards(FOLD, 2)
    fails(f"replay {FOLD} --results 1.shard --resume --shard 2/2", "results of another shard")
    Path("notes.txt").write_text("bread\n")
    fails(f"replay {FOLD} --results notes.txt --resume", "this is no shard")
    with open("1.shard", "a") as locked:
        fcntl.flock(locked, fcntl.LOCK_EX)
        fails(f"replay {FOLD} --results 1.shard --resume", "another process")


# ---- what does not belong together


def refused(files, words):
    """Merging says so, and writes nothing."""
    assert words in run(f"merge {files} --contacts none.csv", code=1).error and not os.path.exists("none.csv")


def test_missing_doubled_and_foreign_shards_are_named():
    all_shards(FOLD, 5)
    refused("1.shard 3.shard", "of 5 shards these are missing: 2, 4, 5")
    refused("4.shard", "missing: 1 to 3, 5")
    shutil.copy("2.shard", "again.shard")
    refused("1.shard 2.shard 3.shard 4.shard 5.shard again.shard", "both are shard 2/5")
    os.unlink("1.shard")
    shard_run(f"{FOLD} --no-depths", 1, 5)
    refused("1.shard 2.shard", "2.shard: it is of other options than 1.shard is")
    os.truncate("3.shard", os.path.getsize("3.shard") - 5)
    refused("2.shard 3.shard", "3.shard: shard 3/5 has 31 of 32 intervals; start it again with --resume")
    refused("2.shard notes.none", "notes.none: cannot read")


def overwrite(path, place, byte=b"x"):
    with open(path, "r+b") as file:
        file.seek(place)
        file.write(byte)


def test_files_that_have_changed_are_noticed():
    all_shards(FOLD, 2)
    text = Path("fold.obj").read_text()
    Path("fold.obj").write_text("v 9 9 9\n" + text.split("\n", 1)[1])
    refused("1.shard 2.shard", "the shard is of another model")
    Path("fold.obj").write_text(text)
    run("merge 1.shard 2.shard --quiet")
    overwrite("2.shard", 2000)
    refused("1.shard 2.shard", "2.shard: shard 2/2 has 2 of 85 intervals; start it again with --resume")


def test_other_frames_are_noticed():
    """The frame between two shards, which both have read."""
    shard_run(FOLD, 1, 2)
    shutil.copy("fold.pc2", "kept.pc2")
    overwrite("fold.pc2", 32 + 64 * 63 * 12 + 2)
    shard_run(FOLD, 2, 2)
    shutil.copy("kept.pc2", "fold.pc2")
    assert "have seen different frames" in run("merge 1.shard 2.shard", code=1).error


def test_options_that_do_not_fit_are_refused():
    usage_error(f"replay {FOLD} --shard 1/2", "--shard needs --results")
    usage_error(f"replay {FOLD} --resume", "--resume needs --results")
    usage_error(f"replay {FOLD} --shard 1/2 --results none.shard --contacts none.csv", "--contacts", "cscd merge")
    usage_error(f"replay {FOLD} --job-timeout 3", "--job-timeout is for --list")
    usage_error(f"replay {FOLD} --results none.shard --resume=failed", "--resume=failed is for --list")
    all_shards(FOLD, 1)
    assert "-o is for the results of a list" in run("merge 1.shard -o none.jsonl", code=2).error
    assert "--contacts" in run("merge 1.shard --contacts 1.shard", code=2).error
    run("merge 1.shard --quiet")


def test_shards_of_a_list_have_whole_recordings():
    """--shard of a list says which jobs, each of which is a whole recording."""
    Path("jobs.jsonl").write_text('{"model": "fold.obj", "frames": "fold.pc2"}\n')
    one = run("replay --list jobs.jsonl").out
    assert one == run("replay --list jobs.jsonl --shard 1/2 --results list-1.jsonl --job-timeout 100").out and "of 150" in one


def test_two_checks_of_meshes_give_the_same_bytes():
    """The lines of meshes have times as well."""
    for name in ("1.jsonl", "2.jsonl"):
        run(f"check --each fold.obj spindle.obj none.obj --reproducible --quiet --json {name}", code=1)
    assert Path("1.jsonl").read_bytes() == Path("2.jsonl").read_bytes()
    assert len(read_json_lines("1.jsonl")) == 3 and "_ms" not in Path("1.jsonl").read_text()
