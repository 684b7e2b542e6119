"""`cscd render`: single pictures, strips of frames, and scenery beside them."""
from pathlib import Path

import pytest

from support.tool.exported import png_size, read_png
from support.tool.recordings import Recording, cube, tetrahedra, torus
from support.tool.running import fails, run, usage_error

WIDTH, HEIGHT, LABEL_WIDTH, LABEL_HEIGHT = 160, 120, 60, 30
WHITE, CONTACT = (255, 255, 255), (0, 90, 181)


@pytest.fixture(autouse=True)
def files(own_folder):
    flight = tetrahedra(8)
    flight.write_mesh("flight.obj")
    flight.write_cache("flight.pc2")
    # A level square much larger than the body, seen from above and from below.
    Path("ground.obj").write_text("v -900 -900 -1\nv 900 -900 -1\nv 900 900 -1\nv -900 900 -1\nf 1 2 3 4\n")
    cube(False).write_mesh("ball.obj")


def render(options, model="flight.obj flight.pc2"):
    run(f"render {model} -o picture.png {options}")
    return read_png("picture.png")


def strip(options, columns, rows, model="flight.obj flight.pc2"):
    """The tiles of a strip, and those that are left empty."""
    picture = render(f"--size {WIDTH}x{HEIGHT} {options}", model)
    assert (picture.width, picture.height) == (columns * WIDTH, rows * HEIGHT)
    return [picture.tile(i, columns, WIDTH, HEIGHT) for i in range(columns * rows)]


def differences(a, b):
    """Counts of different pixels in the label's corner and elsewhere, without the lines at the left and at the top."""
    label = elsewhere = 0
    for row in range(1, HEIGHT):
        if a.rows[row] != b.rows[row]:
            for column in range(1, WIDTH):
                differs = a.rows[row][4 * column : 4 * column + 4] != b.rows[row][4 * column : 4 * column + 4]
                if row < LABEL_HEIGHT and column < LABEL_WIDTH:
                    label += differs
                else:
                    elsewhere += differs
    return label, elsewhere


def coloured(picture):
    return picture.width * picture.height - picture.count(WHITE)


def test_draws_a_frame():
    assert render("--frame 4 --size 320x240") != render("--frame 0 --size 320x240")
    run("render flight.obj -o picture.png --wire --up y --view 30,20")
    assert png_size("picture.png") == (1280, 960)


def test_marks_contacts():
    assert render("--frame 3 --colour contacts --size 320x240").count(CONTACT) > 20  # dots and legend
    assert render("--frame 3 --colour plain --size 320x240").count(CONTACT) == 0
    run("render flight.obj flight.pc2 --frame 3 --color contacts --zoom -o picture.png")
    assert png_size("picture.png") == (1280, 960)


def test_draws_a_plan():
    region, charge = (render(f"--colour {colour} --size 320x240", "flight.obj") for colour in ("region", "charge"))
    assert region.count((86, 180, 233)) > 5 and region.count((230, 159, 0)) > 5
    assert charge.count((68, 1, 84)) > 5 and charge.count((253, 231, 37)) > 5
    density = render("--colour density --size 320x240", "flight.obj")
    assert density != charge and density.count((253, 231, 37)) > 5 and density.count((68, 1, 84)) > 5
    run("preprocess flight.obj --method single -o two.ply --quiet")
    assert render("--colour region --plan two.ply --size 320x240", "flight.obj") != region  # the caption names another method
    run("render flight.obj flight.pc2 --frame 5 --colour region -o picture.png")
    fails("render flight.obj --colour charge --plan two.ply -o picture.png", "two.ply", "of method single, expected charge")


@pytest.mark.parametrize("model", ["flight.obj", "flight.obj flight.pc2 --frames 0:1"])
def test_text_can_be_left_out(model):
    usual, bare = (render(f"--colour region --size {WIDTH}x{HEIGHT} {text}", model) for text in ("", "--no-text"))
    ink = [
        any(max(row[4 * x : 4 * x + 3]) < 60 for row in picture.rows[1:LABEL_HEIGHT] for x in range(1, LABEL_WIDTH))
        for picture in (usual, bare)
    ]
    assert ink == [True, False] and coloured(bare) > 100


def test_refuses_frames_that_are_not_there():
    fails("render flight.obj flight.pc2 -o picture.png --frame 8", "--frame 8", "frames 0 to 7")
    fails("render flight.obj flight.pc2 -o picture.png --frame 7 --colour contacts", "--frame 7", "next")
    run("render flight.obj flight.pc2 -o picture.png --frame 7")


def test_a_strip_is_a_grid_of_tiles():
    tiles = strip("--frames 0:6:2 --columns 3", 3, 2)
    for i in range(4):
        assert coloured(tiles[i]) > 500
        for j in range(i):
            label, elsewhere = differences(tiles[i], tiles[j])
            assert label > 10 and elsewhere > 50
    assert coloured(tiles[5]) == WIDTH + HEIGHT - 1  # only the lines
    strip("--frames 3:", 3, 2)
    strip("--frames 2:3 --columns 9", 2, 1)
    run("render flight.obj --frames 0 -o picture.png")
    assert png_size("picture.png") == (400, 300)


def test_the_camera_holds_the_whole_motion():
    """The tetrahedron flies along a line, so all frames need the same camera as the first and the last position.

    The tiles are the same, bit for bit. The camera for the fourth frame alone is nearer.
    """
    every, ends = strip("--frames 0: --columns 4", 4, 2), strip("--frames 0::7 --columns 2", 2, 1)
    (alone,) = strip("--frames 4", 1, 1)
    assert differences(every[0], ends[0]) == differences(every[7], ends[1]) == (0, 0)
    assert differences(every[4], alone)[1] > 500


def test_a_following_camera_keeps_the_body_in_the_middle():
    """A torus that flies without turning looks the same in all tiles that follow it, except for the label's number."""
    body = torus(12, 8)
    body = Recording(body.triangles, [[(x + 2 * k, y + 2 * k, z - 8 * k) for x, y, z in body.frames[0]] for k in range(4)])
    body.write_mesh("torus.obj")
    body.write_cache("torus.pc2")
    still, followed, grounded = (strip(f"--frames :3 {options}", 2, 2, "torus.obj torus.pc2")
                                 for options in ("", "--follow", "--follow --scenery ground.obj"))
    for i in range(1, 4):
        assert differences(still[0], still[i])[1] > 200
        label, elsewhere = differences(followed[0], followed[i])
        assert label > 10 and elsewhere < 10
    assert sum(map(coloured, followed)) > sum(map(coloured, still))
    assert differences(grounded[0], grounded[3])[1] > 200  # the ground comes nearer


def test_a_strip_shows_contacts_where_they_begin():
    """Intervals 3 and 5 have contacts; the last frame begins no interval, so it has none."""
    marked, plain = (strip(f"--frames 0:7 --columns 8 {options}", 8, 1) for options in ("--colour contacts", ""))
    for i in range(8):
        assert marked[i].count(CONTACT) > 10 if i in (3, 5) else marked[i] == plain[i]


def test_the_last_frame_has_no_contacts_of_the_tile_before():
    tetrahedra(5).write_cache("short.pc2")
    touching, last = strip("--frames 3:4 --columns 2 --colour contacts", 2, 1, "flight.obj short.pc2")
    assert touching.count(CONTACT) > 10 and last.count(CONTACT) == 0


def test_a_strip_shows_a_plan():
    plain, *painted = (strip(f"--frames 0:3 --colour {colour}", 2, 2) for colour in ("plain", "charge", "region"))
    for tiles in painted:
        for i in range(4):
            assert differences(plain[i], tiles[i])[1] > 300


def test_scenery_leaves_the_framing_alone():
    """The ground fills the background and leaves the body where it was, except for its smoothed rim."""
    (alone,), (grounded,) = strip("--frame 2", 1, 1), strip("--frame 2 --scenery ground.obj", 1, 1)
    body = [(a, b) for a, b in zip(alone.pixels(), grounded.pixels()) if a[0] != 255]
    assert len(body) > 1500 and sum(a == b for a, b in body) > len(body) * 3 // 4
    assert coloured(grounded) > WIDTH * HEIGHT - 2000  # all but the label


def test_scenery_moves_with_its_frames():
    scenery = cube(False)
    scenery.write_cache("cube.mdd")
    scenery.write_cache("cube_8.pc2", 8)
    Recording(scenery.triangles, scenery.frames[:1]).write_cache("cube_1.pc2")
    still, single, moving = (strip(f"--frames 0:1 --scenery ball.obj {frames}", 2, 1)
                             for frames in ("", "--scenery-frames cube_1.pc2", "--scenery-frames cube_8.pc2"))
    assert still == single and still[0] == moving[0] and still[1] != moving[1]
    refused = "render flight.obj flight.pc2 -o picture.png --scenery ball.obj --scenery-frames"
    fails(f"{refused} cube.mdd", "cube.mdd: 3 frames", "one or the recording's 8")
    fails(f"{refused} flight.pc2", "--scenery-frames", "flight.pc2", "points")


@pytest.mark.parametrize("code, options, says", [
    (2, "--frame 1 --frames 0:3", ["--frame and --frames", "one of them"]),
    (2, "--columns 3", ["--columns is for a strip", "--frames"]),
    (2, "--follow --frame 3", ["--follow is for a strip", "--frames"]),
    (2, "--zoom --frames 0:3", ["--zoom is for a single"]),
    (2, "--scenery-frames a.pc2", ["--scenery-frames", "--scenery MODEL"]),
    (2, "--frames 0:3 --columns 0", ["--columns cannot be '0'"]),
    (2, "--frames 3:0", ["--frames cannot be '3:0'"]),
    (1, "--frames 0:9", ["no frame 9", "frames 0 to 7"]),
    (1, "--frames 0:2 --columns 3 --size 8000x8000", ["24000 x 8000 pixels"]),
    (1, "--scenery none.obj", ["none.obj", "No such file"]),
])
def test_refuses_what_does_not_go_together(code, options, says):
    fails(f"render flight.obj flight.pc2 -o picture.png {options}", *says, code=code)


def test_overwrites_no_scenery():
    usage_error("render flight.obj flight.pc2 -o ground.txt --scenery ground.txt", "would overwrite")


def test_a_failed_strip_keeps_the_picture_that_was_there():
    """A later frame cannot be read."""
    tetrahedra(8).write_sequence("g_%02d.ply")
    cube(False).write_mesh("g_05.ply")
    Path("kept.png").write_text("kept")
    fails("render flight.obj g_%02d.ply -o kept.png --frames 2:7", "g_05.ply")
    assert Path("kept.png").read_text() == "kept"
