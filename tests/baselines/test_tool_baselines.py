"""How `cscd replay` reports on baselines: their columns, their guarantees, and the plan that they use."""
from pathlib import Path

import pytest

from support.tool.reading import read_json
from support.tool.recordings import spindle
from support.tool.running import run, usage_error


@pytest.fixture(autouse=True)
def files(own_folder):
    scene = spindle(24, 10, 16)
    scene.write_mesh("spindle.obj")
    scene.write_cache("spindle.pc2")


def replay(options):
    """What is said, and the summary."""
    answer = run(f"replay spindle.obj spindle.pc2 --timings --json out.json {options}")
    return answer, read_json("out.json")


def test_published_is_marked_as_such():
    """The method promises nothing, so the contacts that it loses are no reason for a warning."""
    answer, root = replay("--method published")
    assert answer.error == "" and "method published: in " in answer.out and "\npublished " in answer.out
    assert root["summary"]["method"] == "published"


@pytest.mark.parametrize("method", ["iccd", "cones"])
def test_contours_have_a_column(method):
    """Contours stand in the place of orientations; they promise all contacts, and need neither a proven start nor a plan."""
    answer, root = replay(f"--method {method}")
    _, none = replay("--method none")
    assert f"\n{method} " in answer.out and " contour " in answer.out and "plan: none" in answer.out
    assert "may be missing" not in answer.out and answer.out.count(" X ") == 4  # for orientation and proof, in both rows
    total = root["summary"]
    assert (total["method"], total["static_checks"], total["intervals_complete"]) == (method, 0, 15)
    assert total["contour_ms"]["mean"] > 0
    for interval, plain in zip(root["intervals"], none["intervals"]):
        (guarantee,) = interval["guarantee"]
        assert guarantee["mode"] == "all" and "patches" in guarantee["reason"]
        assert interval["ms"]["contour"] > 0 == plain["ms"]["contour"] and interval["pcp"] < plain["pcp"]


def test_iccd_as_published_is_marked_as_such():
    answer, root = replay("--method iccd-published")
    assert answer.error == "" and "method iccd-published: in 15 of 15 intervals contacts" in answer.out
    assert "\niccd-published " in answer.out and len(root["intervals"]) == 15
    for interval in root["intervals"]:
        (guarantee,) = interval["guarantee"]
        assert guarantee["mode"] == "earliest" and "published" in guarantee["reason"]


@pytest.mark.parametrize("options, lines", [("--threads 2", 10), ("--mode earliest", 1)])
def test_contours_lose_no_contact(options, lines):
    tables = []
    for method in ("none", "iccd", "cones"):
        run(f"replay spindle.obj spindle.pc2 --quiet --contacts out.csv --method {method} {options}")
        tables.append(Path("out.csv").read_text())
    assert tables[0] == tables[1] == tables[2] and tables[0].count("\n") > lines


def test_published_makes_its_plan_or_takes_any():
    """A plan of another method, which lies beside the model, is taken only if it is named."""
    run("preprocess spindle.obj --quiet --method kmeans:4")
    answer, _ = replay("--method published --frames 0:2")
    assert "plan: published, 2 regions, made in memory" in answer.out and "left aside, it is of method kmeans" in answer.out
    answer, _ = replay("--method published --frames 0:2 --plan spindle.plan.ply")
    assert "plan: kmeans, 4 regions, " in answer.out and "\npublished " in answer.out
    run("preprocess spindle.obj --quiet --method published")
    answer, _ = replay("--method published --frames 0:2 --ours charge")
    assert "plan: published, 2 regions, made in memory" in answer.out
    assert "left aside, since --ours says how to make one" in answer.out


def test_published_steps_one_by_one():
    """Exact tests find no contact that there is not, and each step shows in what is counted."""
    def pairs(options):
        return replay(f"--frames 0:4 --method {options}")[1]["summary"]["pcp"]["mean"]

    all_boxes, dops = pairs("published --ours boxes,tests"), pairs("published --ours tests")
    assert all_boxes >= dops > 0
    assert pairs("iccd-published --ours tests,neighbours") >= pairs("iccd-published --ours tests")
    usage_error("replay spindle.obj spindle.pc2 --method charge --ours tests", "--ours counts with --method published")
    usage_error("replay spindle.obj spindle.pc2 --method published --ours speed", "--ours", "speed")
    usage_error("replay spindle.obj spindle.pc2 --method iccd-published --ours tests,motion", "--ours motion counts with")
    usage_error("replay spindle.obj spindle.pc2 --method published --ours cuts", "give --ours ranks,cuts")
    usage_error("preprocess spindle.obj --method published --ours ranks,points", "give --ours ranks,cuts,points")
    usage_error("replay spindle.obj spindle.pc2 --method published --plan p.ply --ours charge,tests", "leave out either")
    usage_error("replay spindle.obj spindle.pc2 --method cones --plan p.ply", "--plan is of no use with --method cones")
    _, written = replay("--frames 0:2 --method published --ours charge,tests")
    assert written["summary"]["plan"]["made"].startswith("method=published solver=tree threshold=0.1 growing=0.0025 ours=1 ")
