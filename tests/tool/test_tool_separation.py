"""`replay --min-separation`: which pairs are reported, where they are written, and what is refused."""
from pathlib import Path

import pytest

from support.tool.reading import CONTACT_COLUMNS, read_csv, read_json, read_json_lines
from support.tool.recordings import fold, tetrahedra
from support.tool.running import run, usage_error


@pytest.fixture(autouse=True)
def files(own_folder):
    for name, scene in (("flight", tetrahedra(8)), ("fold", fold(24, 5, 16))):
        scene.write_mesh(f"{name}.obj")
        scene.write_cache(f"{name}.pc2")


def csv_of(distance, options=""):
    run(f"replay fold.obj fold.pc2 --contacts out.csv --min-separation {distance} {options}")
    return Path("out.csv").read_text()


def test_reports_what_comes_within():
    """The tip flies towards x = 0 by one unit per frame. It is 3.5 away in frame 0, and 0.5 in frame 3."""
    run("replay flight.obj flight.pc2 --contacts out.csv --min-separation 0.25")
    row = read_csv("out.csv")[0]
    assert list(row) == CONTACT_COLUMNS + ["bounded"]
    assert [row[key] for key in ("frame", "kind", "bounded")] == ["3", "vf", "0"]
    assert [row[key] for key in ("a0", "a1", "b0", "b1", "b2")] == ["4", "", "0", "1", "2"]
    toi, u, v, *place = (float(row[key]) for key in ("toi", "u", "v", "x", "y", "z", "nx", "ny", "nz"))
    assert 0.25 - 1e-6 <= toi <= 0.25 and (u, v) == pytest.approx((0.25, 0.25), abs=1e-9)
    assert place == [pytest.approx(0.125, abs=1e-6), 1, 1, 1, 0, 0]


def test_json_lines_say_bounded_too():
    rows = csv_of("0.05").count("\n") - 1
    run("replay fold.obj fold.pc2 --contacts out.jsonl --min-separation 0.05")
    assert [line["bounded"] for line in read_json_lines("out.jsonl")] == [False] * rows and rows > 10


def test_summary_and_table_name_the_distance():
    out = run("replay fold.obj fold.pc2 --json out.json --min-separation 0.0625").out
    assert "minimum separation: 0.0625; contacts whose time is a bound only: 0\n" in out
    root = read_json("out.json")
    assert (root["summary"]["min_separation"], root["summary"]["bounded"]) == (0.0625, 0) and root["summary"]["vf"] > 0
    assert {interval["bounded"] for interval in root["intervals"]} == {0}


def test_zero_is_as_without():
    """Nothing changes, and the summary says 0."""
    zero = csv_of("0", "--json out.json")
    run("replay fold.obj fold.pc2 --contacts without.csv")
    assert Path("without.csv").read_text() == zero and "bounded" not in zero
    assert read_json("out.json")["summary"]["min_separation"] == 0
    assert "minimum separation" not in run("replay fold.obj fold.pc2 --min-separation 0.0").out


def test_same_bytes_whatever_the_way():
    expected = csv_of("0.03125", "--threads 1")
    assert expected.count("\n") > csv_of("0").count("\n")
    for options in ("--threads 4", "--method brute", "--method none"):
        assert csv_of("0.03125", options) == expected


@pytest.mark.parametrize("value", ["-1", "-1e-300", "nan", "inf", "1mm", "", "1e-300", "1e300", "1,5"])
def test_unfit_distances_are_refused(value):
    usage_error(f"replay flight.obj flight.pc2 --min-separation '{value}'", f"--min-separation cannot be '{value}'")


def test_a_distance_is_needed():
    usage_error("replay flight.obj flight.pc2 --min-separation", "--min-separation needs a value")
    assert "--min-separation D" in run("replay --help").out
