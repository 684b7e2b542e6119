"""`cscd preprocess` from end to end: what it writes, what it refuses, and which plan a replay then uses."""
import os
import struct
from pathlib import Path

import pytest

from support.tool.mesh_files import write_soft_bar
from support.tool.reading import read_json
from support.tool.recordings import cube, fold, spindle, torus
from support.tool.running import fails, run, usage_error


@pytest.fixture(scope="module")
def scene():
    return spindle(30, 10, 12)


@pytest.fixture(autouse=True)
def files(own_folder, scene):
    scene.write_mesh("spindle.obj")
    scene.write_cache("spindle.pc2")


def says(line, *texts):
    """Runs the tool without a complaint, and expects the texts."""
    answer = run(line)
    assert answer.error == ""
    for text in texts:
        assert text in answer.out


# ---- preprocess


def test_tells_what_it_found():
    says("preprocess spindle.obj", "302 vertices, 600 triangles, 1 component\n", "component 0: 600 triangles, capacitance ",
         "     0         0       600       100.0 %", "seconds: assembly ", "written: spindle.plan.ply\n")
    says("preprocess spindle.obj --method kmeans:4", ": 4 regions by method kmeans; their points see ")
    says("preprocess spindle.obj --method single -o other.ply", ": 1 region by method single; its point sees ")
    assert run("preprocess spindle.obj").out.startswith("spindle.obj: 1 region by method charge; its point sees ")
    says("info spindle.plan.ply", "vertices    302\n")  # a plan is a mesh


def test_makes_plans_for_a_motion():
    says("preprocess spindle.obj --method auto", "method      regions ", "charge            1 ", "single            1 ",
         "kmeans:4          4 ", "%   kept\n")
    options = "--frames 0 --method auto --seed 2 --threshold 0.2 --charge coarse"
    says(f"preprocess spindle.obj spindle.pc2 {options}", "charge            1 ")
    says("preprocess spindle.obj spindle.pc2 --method auto", "charge            3 ")


def test_the_last_frame_of_a_motion_counts():
    """At rest, in frame 0, there is one region; bent, in frame 11, there are three."""
    says("preprocess spindle.obj spindle.pc2 --frames 0:11:11 --method auto", "charge            3 ")
    says("preprocess spindle.obj spindle.pc2 --frames 0:0 --method auto", "charge            1 ")


def test_what_the_points_see_is_counted_by_area():
    """The first line has the mean of the table's column, by its shares of the area; a mean of equal weights is 94.1."""
    torus(12, 8).write_mesh("torus.obj")
    lines = run("preprocess torus.obj --method kmeans:4").out.split("\n")
    rows = [line.split() for line in lines if line.count("%") == 2]
    assert len(rows) == 4 and len({row[5] for row in rows}) > 1
    seen = sum(float(row[3]) * float(row[5]) for row in rows) / 100
    assert lines[0] == f"torus.obj: 4 regions by method kmeans; their points see {seen:.1f} % of the area"


def test_published_steps_one_by_one(scene):
    """From the plan of the thesis to ours, and a file says how each was made."""
    scene.write_mesh("bent.obj", 11)
    regions, origins = [], []
    for steps in ("", " --ours charge", " --ours charge,ranks", " --ours charge,ranks,cuts", " --ours charge,ranks,cuts,points"):
        lines = run(f"preprocess bent.obj --method published{steps}").out.split("\n")
        regions.append([lines[0], *(line for line in lines if line.count("%") == 2)])
        origins.append(Path("bent.plan.ply").read_bytes().split(b"comment cscd made ")[1].split(b"\n")[0])
    ours = run("preprocess bent.obj").out
    assert regions[0] != regions[2] != regions[3] != regions[4]
    assert regions[3][0].startswith("bent.obj: 3 regions") and len(regions[3]) == 4
    assert all(line in ours for line in regions[4][1:]) and not all(line in ours for line in regions[3][1:])
    assert origins[0].startswith(b"method=published solver=dense threshold=0.1 growing=0.0025 ours=0 version=")
    assert origins[4].startswith(b"method=published solver=tree threshold=0.1 growing=0.0025 ours=15 version=")
    assert b"comment cscd made method=charge solver=tree threshold=0.1 frames=0 stiffness=0 version=" in \
        Path("bent.plan.ply").read_bytes()


def test_seeds_choose_the_regions():
    plans = []
    for seed in (1, 1, 2):
        run(f"preprocess spindle.obj --method kmeans:5 --seed {seed} --quiet")
        plans.append(Path("spindle.plan.ply").read_bytes())
    assert plans[0] == plans[1] != plans[2]


def test_names_the_plan_after_the_model(scene):
    scene.write_mesh("a.b.ply")
    scene.write_mesh("C.OBJ")
    for model, plan in (("a.b.ply", "a.b.plan.ply"), ("C.OBJ", "C.plan.ply"), ("a.b.plan.ply", "a.b.plan.plan.ply")):
        run(f"preprocess {model} --method single --quiet")
        assert os.path.exists(plan)


@pytest.mark.parametrize("option, values", [
    ("--method", ["none", "brute", "kmeans:0", "kmeans:x", "kmeans:"]), ("--threshold", ["0", "1", "nan"]),
    ("--seed", ["-1"]), ("--growing", ["-0.1", "1.1"]), ("--ours", ["speed", "charge,"]), ("--threads", ["300"]),
    ("--weld", ["0"]),
])
def test_refuses_unfit_values(option, values):
    for value in values:
        usage_error(f"preprocess spindle.obj {option} {value}", option, value)


@pytest.mark.parametrize("line, says", [
    ("", ["expected MODEL"]),
    ("spindle.obj spindle.pc2 -o spindle.pc2", ["-o", "spindle.pc2"]),
    ("spindle.obj --frames 0:3", ["--frames", "none are given"]),
    ("spindle.obj spindle.pc2 --method published", ["FRAMES count with"]),
    ("spindle.obj --method published --charge coarse", ["--ours has charge"]),
    ("spindle.obj --growing 0.1", ["--growing counts with --method published; leave it out"]),
    ("spindle.obj --ours ranks", ["--ours counts with --method published; leave it out"]),
    ("spindle.obj spindle.pc2 --method single", ["FRAMES count with"]),
    ("spindle.obj --method single --threshold 0.2", ["--threshold counts with --method charge, auto or published; leave"]),
    ("spindle.obj --method kmeans:4 --charge coarse", ["--charge counts with --method charge or auto, or with --ours charge;"]),
    ("spindle.obj --seed 2", ["--seed counts with --method kmeans:K or auto; leave it out"]),
    ("spindle.obj -o plan.obj", ["ends in .ply"]),
])
def test_refuses_what_does_not_go_together(line, says):
    usage_error(f"preprocess {line}", *says)
    assert not os.path.exists("spindle.plan.ply")


def test_refuses_what_is_not_there():
    fails("preprocess spindle.obj spindle.pc2 --frames 99", "frame 99")
    fails("preprocess spindle.obj -o no/such/a.ply", "cannot write", "no/such/")
    Path("one.obj").write_text("v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n")
    fails("preprocess one.obj --weld exact", "--weld exact leaves none")


def test_overwrites_no_mesh(scene):
    """A plan may replace only a plan."""
    scene.write_mesh("mesh.ply", 3)
    before = Path("mesh.ply").read_bytes()
    usage_error("preprocess mesh.ply -o mesh.ply", "would overwrite")
    usage_error("preprocess spindle.obj -o mesh.ply", "exists and is no plan")
    assert Path("mesh.ply").read_bytes() == before
    run("preprocess spindle.obj -o other.ply --quiet")
    run("preprocess spindle.obj -o other.ply --quiet")
    os.rename("other.ply", "plan.data")
    usage_error("render spindle.obj --colour region --plan plan.data -o plan.data", "would overwrite")
    usage_error("replay spindle.obj spindle.pc2 --plan plan.data --json plan.data", "would overwrite")


def test_says_how_much_memory_is_missing():
    rows, columns = 500, 800
    points = "".join(f"v {i} {j} 0\n" for i in range(rows) for j in range(columns))
    corners = (i * columns + j for i in range(rows - 1) for j in range(1, columns))
    Path("large.obj").write_text(points + "".join(f"f {c} {c + 1} {c + columns + 1} {c + columns}\n" for c in corners))
    error = run("preprocess large.obj --charge dense", code=1).error
    for text in ("large.obj: ", "797402 triangles", "GiB", "--charge tree"):
        assert text in error
    assert not os.path.exists("large.plan.ply")


# ---- which plan a replay takes


def takes_plan(options, source, method, regions, remark):
    """Replays, and checks the plan in the summary and what the table says about it."""
    out = run(f"replay spindle.obj spindle.pc2 --json out.json --frames 0:2 {options}").out
    chosen = read_json("out.json")["summary"]["plan"]
    assert (chosen["source"], chosen["method"], chosen["regions"]) == (source, method, regions)
    assert (chosen["path"] is None) == (source != "file")
    assert f"plan: {method}" + (f", {regions} region{'s' * (regions > 1)}, " if regions else "") in out and remark in out


def test_takes_the_plan_of_the_model():
    takes_plan("", "memory", "charge", 1, "made in memory in ")
    assert not os.path.exists("spindle.plan.ply")  # replay writes none
    run("preprocess spindle.obj --quiet --method kmeans:4")
    takes_plan("", "file", "kmeans", 4, "spindle.plan.ply")
    takes_plan("--method charge", "memory", "charge", 1, "left aside, it is of method kmeans")
    takes_plan("--method kmeans:3", "memory", "kmeans", 3, "made in memory")
    takes_plan("--method single", "memory", "single", 1, "made in memory")
    takes_plan("--method none", "none", "none", 0, "plan: none\n")
    takes_plan("--method brute", "none", "none", 0, "plan: none\n")
    takes_plan("--min-separation 0.001", "none", "none", 0, "with --min-separation nothing is culled")
    takes_plan("--min-separation 0.001 --method single", "none", "none", 0, "with --min-separation nothing is culled")


def test_takes_the_plan_that_it_is_given(scene):
    run("preprocess spindle.obj --quiet --method kmeans:4")
    run("preprocess spindle.obj --quiet --method single -o other.ply")
    takes_plan("--plan other.ply", "file", "single", 1, "other.ply")
    takes_plan("--plan other.ply --method single", "file", "single", 1, "other.ply")
    takes_plan("--plan spindle.plan.ply --method kmeans", "file", "kmeans", 4, "spindle.plan.ply")
    replay = "replay spindle.obj spindle.pc2 --plan"
    fails(f"{replay} other.ply --method charge", "other.ply", "of method single, expected charge")
    usage_error(f"{replay} other.ply --method none", "--plan is of no use with --method none")
    fails(f"{replay} none.ply", "none.ply", "No such file")
    scene.write_mesh("mesh.ply")
    fails(f"{replay} mesh.ply", "lacks 'comment cscd plan'")


def test_a_plan_of_another_version_is_told():
    """It is taken, since contacts are the same with any plan, but not in silence."""
    run("preprocess spindle.obj --quiet")
    mine = Path("spindle.plan.ply").read_bytes()
    line = mine[mine.index(b"comment cscd made"):mine.index(b"\nelement")]
    said = "from spindle.plan.ply (made by cscd 9.8.7; cscd preprocess makes it anew)\n"
    for other, remark in ((line[:line.index(b"version=")] + b"version=9.8.7", said),
                          (b"comment", "(it does not say which version of cscd made it; cscd preprocess makes it anew)\n"),
                          (line + b"  ", "from spindle.plan.ply\n")):
        Path("spindle.plan.ply").write_bytes(mine.replace(line, other))
        assert remark in run("replay spindle.obj spindle.pc2 --json said.json").out
    assert read_json("said.json")["summary"]["plan"]["made"] == line.decode().removeprefix("comment cscd made ")


def test_refuses_the_plan_of_another_mesh():
    """A plan that does not fit is ignored, with a reason, when it lies beside the model; it is an error when it is named."""
    torus(20, 10).write_mesh("torus.obj")
    run("preprocess torus.obj -o spindle.plan.ply --quiet")
    takes_plan("", "memory", "charge", 1, "another mesh: it has 200 vertices and 400 triangles")
    fails("replay spindle.obj spindle.pc2 --plan spindle.plan.ply", "another mesh", "expected 302 and 600")


def test_welds_before_it_compares():
    split = cube(True)
    split.write_mesh("split.obj")
    split.write_cache("split.pc2")
    run("preprocess split.obj --weld exact --quiet --method single")
    says("replay split.obj split.pc2 --weld exact", "plan: single, 2 regions, from ")
    assert "expected 28 and 16, of the same model with the same --weld: left aside" in run("replay split.obj split.pc2").out


def test_culls_nothing_on_open_meshes():
    sheet = fold(16, 4, 3)
    sheet.write_mesh("sheet.obj")
    sheet.write_cache("sheet.pc2")
    nothing = "plan: none (no component is a closed surface, so there is nothing to cull)\n"
    assert nothing in run("replay sheet.obj sheet.pc2").out


@pytest.fixture
def large():
    large = torus(60, 51)
    large.write_mesh("large.obj")
    large.write_cache("large.pc2", 2)
    return large


def test_large_meshes_get_one_region_in_short_recordings(large):
    says("replay large.obj large.pc2", "plan: single, 1 region, made in memory in ",
         "(a plan by charge takes as long as 400 intervals, and here are 1; cscd preprocess")
    says("replay large.obj large.pc2 --method charge", "plan: charge, ")
    run("preprocess large.obj --quiet --method kmeans:6")
    says("replay large.obj large.pc2", "plan: kmeans, 6 regions, from ")


@pytest.mark.parametrize("frame_count, plan", [
    (4000, ["plan: single, ", "400 intervals, and here are 3999;"]),
    (4001, ["plan: charge, "]),
])
def test_long_recordings_get_a_plan_by_charge(large, frame_count, plan):
    """The price of a plan is one of triangles times intervals of the whole recording, whatever is replayed of it.

    The frames behind the first two are a hole in the file, which nobody reads.
    """
    with open("large.pc2", "r+b") as file:
        file.seek(28)
        file.write(struct.pack("<i", frame_count))
        file.truncate(32 + frame_count * len(large.frames[0]) * 12)
    says("replay large.obj large.pc2 --frames :1", *plan)


def test_without_an_answer_there_is_one_region():
    """Two triangles of one component with the same centroid make the charge's equations singular."""
    Path("star.obj").write_text("v 1 0 0\nv -.5 .75 0\nv -.5 -.75 0\nv -1 0 0\nv .5 -.75 0\nv .5 .75 0\nv 0 0 2\n"
                                "v 9 0 0\nv 8 0 0\nv 9 1 0\nv 9 0 1\n"
                                "f 1 3 2\nf 1 2 7\nf 2 3 7\nf 3 1 7\nf 4 6 5\nf 4 5 7\nf 5 6 7\nf 6 4 7\n"
                                "f 8 9 10\nf 9 8 11\nf 10 9 11\nf 8 10 11\n")
    fails("preprocess star.obj --quiet", "star.obj: ", "centroid")
    out = run("replay star.obj star.obj star.obj").out
    assert "plan: single, 2 regions, made in memory in " in out and "centroid" in out


def test_a_model_may_say_where_it_is_soft():
    write_soft_bar("even.ply")
    write_soft_bar("bar.ply", 0.25)
    says("preprocess even.ply", "stiffness: 3 to 3, from even.ply\n", ": 1 region by")
    says("preprocess bar.ply -o other.ply", "stiffness: 0.25 to 3, from bar.ply\n", ": 2 regions by method charge;",
         "component 0: 956 triangles")


def test_published_asks_for_no_stiffness():
    write_soft_bar("bar.ply", 0.25)
    answer = run("preprocess bar.ply --threads 2 --method published --threshold 0.2 --growing 0.1")
    assert answer.error == "" and "method published" in answer.out and "stiffness" not in answer.out


def test_bad_stiffness_is_refused():
    write_soft_bar("bad.ply", bad=(7, 0.0))
    fails("preprocess bad.ply", "bad.ply: the stiffness of face 7 is 0, expected a positive finite number")
    write_soft_bar("bad.ply", bad=(90, float("inf")))
    error = run("replay bad.ply bad.ply bad.ply --method charge", code=1).error
    assert "bad.ply: the stiffness of face 90 is inf, expected" in error
