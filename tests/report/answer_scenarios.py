"""The page begins with the answer: a sentence, parts against parts, events that the view goes to, and what intersects there."""
from selenium.webdriver.common.keys import Keys

from controls_scenarios import SMALL
from page import expect, expect_equal
from report_file import Report

CURVE_SEGMENTS = "return window.cscd.viewer.curves.segments;"
FILLED = "return [...window.cscd.viewer.painter.filled];"


def open_pawn(context, **arguments):
    made = context.material.replay("pawn-drop")
    context.page.open(made.page, **{**SMALL, **arguments})
    return made, context.page, Report(made.page)


def crossing_frames(made):
    return [row["frame"] for row in made.summary()["frames"] if row["crossing_pairs"] + row["touching_pairs"] > 0]


def expect_event(page, report, number):
    event = report.scene["answers"]["events"][number]
    expect_equal((page.state("event"), page.frame()), (number, event["worst"]), "the event and its worst frame")
    return event


def answers_are_those_of_the_run(context):
    """The frames in which something was found are those of the summary with pairs, and each event lies in them."""
    for name in ("pawn-drop", "figure-balls"):
        made = context.material.replay(name)
        report = Report(made.page)
        answers, arrays = report.scene["answers"], report.arrays
        found = [report.scene["numbers"][place] for place in arrays["answer_frame"]]
        expect_equal(found, crossing_frames(made), f"{name}: frames in which triangles intersect or touch")
        expect_equal(answers["frames_checked"], len(report.scene["numbers"]), f"{name}: frames checked")
        counts = [arrays["answer_counts"][5 * i:5 * i + 5] for i in range(len(found))]
        for what, place in (("triangles", 2), ("points", 3), ("depths", 4)):
            total = sum(row[place] for row in counts)
            expect_equal((answers[f"{what}_kept"], answers[f"{what}_found"]), (total, total), f"{name}: {what}")
        expect(answers["events_found"] == len(answers["events"]) > 3, f"{name}: {answers['events_found']} events")
        for event in answers["events"]:
            expect(event["pairs"] == 0 or event["worst"] in found, f"{name}: {event} is worst where nothing intersects")
        deepest = max(event["depth"] for event in answers["events"])
        stored = max(arrays["depth"]) * report.scene["unit"]
        expect(0.5 * deepest <= stored <= 1.001 * deepest, f"{name}: events are {deepest} deep, vertices {stored}")


def the_sentence_says_what_intersects(context):
    made, page, report = open_pawn(context)
    text = page.script("return document.getElementById('answer-line').textContent;")
    expect(f"{len(crossing_frames(made))} of 150 frames checked" in text, text)
    events = report.scene["answers"]["events"]
    worst = max(events, key=lambda event: event["depth"])
    for words in (f"{len(events)} events", f"frames {worst['first']} to {worst['last']}", f"deep at frame {worst['worst']}"):
        expect(words in text, f"no {words!r} in {text!r}")


def what_has_no_surface_is_named(context):
    """A frame in which no triangle has an area does not count as checked."""
    sizes = [(1, 1), (0, 1), (0, 1), (1, 1), (0, 0), (1, 1)]
    for name, shown, checked in (("hidden", sizes, "Nothing intersects (5 frames checked)."),
                                 ("nothing", [(1, 1), (0, 0), (0, 0)], "Nothing intersects (1 frame checked).")):
        made, page = context.material.sized(name, shown), context.page
        page.open(made.page)
        text = page.script("return document.getElementById('answer-line').textContent;")
        expect(text.startswith(checked), text)
        for part, places in (("Puff", {"hidden": "frames 1 to 2, 4", "nothing": "frames 1 to 2"}),
                             ("Rock", {"hidden": "frame 4", "nothing": "frames 1 to 2"})):
            said = f"{part} has no surface in {places[name]} (all its triangles have no area), and was not looked at there."
            expect(said in text, f"no {said!r} in {text!r}")


def what_shares_space_has_words(context):
    """Parts that lie in each other although no triangles cross: flush on two sides, and two copies of one solid."""
    for name, size, apart, word in (("flush", 0.5, -0.25, "overlapping"), ("copies", 1, 0.0, "copies of one solid")):
        made, page = context.material.sized(name, [(1, size)] * 2, apart), context.page
        page.open(made.page)
        text = page.script("return document.getElementById('answer-line').textContent;")
        expect(text.startswith("No triangles cross, but parts share space (2 frames checked). 1 event, the worst: "), text)
        shown = page.script("return [...document.querySelectorAll('.events tbody tr .who')].map((one) => one.title);")
        expect_equal(shown, [f"Puff × Rock: {word}"], "the event")


def what_was_left_out_is_said(context):
    """As the tool says it: the two overlap, and nobody was to look at them."""
    for name, options, said in (
            ("ignored", ["--ignore-parts", "Puff,Rock"], "As asked, 1 of 3 pairs of parts was not looked at."),
            ("only", ["--only", "Puff,Puff"], "As asked, 2 of 3 pairs of parts were not looked at."),
            ("all", [], "")):
        made, page = context.material.sized(f"left-{name}", [(1, 0.5)] * 2, -0.25, options), context.page
        page.open(made.page)
        text = page.script("return document.getElementById('answer-line').textContent;")
        if said:
            expect_equal(text, f"Nothing intersects (2 frames checked). {said}", name)
        else:
            expect("As asked" not in text, text)


def clicks_and_keys_walk_the_events(context):
    _, page, report = open_pawn(context)
    count = len(report.scene["answers"]["events"])
    expect_equal(len(page.table("Events")) - 1, count, "rows of the table of events")
    page.click("button", "Event 2")
    expect_event(page, report, 1)
    page.click("button", "Next event")
    expect_event(page, report, 2)
    page.leave_controls()
    page.press("p", "p")
    expect_event(page, report, 0)
    page.press("p")
    expect_event(page, report, count - 1)
    page.press("n")
    expect_event(page, report, 0)


def an_event_is_seen(context):
    """The camera is near its place, triangles are filled, curves are drawn, and the box 'Intersections' takes them away."""
    _, page, report = open_pawn(context, width=1280, height=800)
    page.go_to(0)
    expect_equal((page.script(FILLED), page.script(CURVE_SEGMENTS)), ([], 0), "what is filled where nothing intersects")
    page.click("button", "Event 2")
    page.rest()
    event = expect_event(page, report, 1)
    place = report.scene["numbers"].index(event["worst"])
    row = list(report.arrays["answer_frame"]).index(place)
    counts = report.arrays["answer_counts"][5 * row:5 * row + 5]
    filled = set(page.script(FILLED))
    begin = sum(report.arrays["answer_counts"][5 * i + 2] for i in range(row))
    triangles = set(report.arrays["answer_triangle"][begin:begin + counts[2]])
    expect(len(triangles) > 50 and triangles <= filled, f"{len(triangles - filled)} of {len(triangles)} triangles are not filled")
    expect(page.script(CURVE_SEGMENTS) > 50, "no curves")
    near = context.pictures.view("event")
    red = context.pictures.count(near, (150, 20, 110), 70)
    expect(red > 1000, f"{red} pixels of depth")
    legend = page.script("return document.querySelector('.legend-body').textContent;")
    expect("in the unit of the file" in legend and f"frame {event['worst']}" in legend, legend)
    page.set_box("Intersections", False)
    page.rest()
    expect_equal((page.script(FILLED), page.script(CURVE_SEGMENTS)), ([], 0), "what is filled without the box")


def parts_stand_against_parts(context):
    made = context.material.tetrahedra()
    context.page.open(made.page, **SMALL)
    page, events = context.page, Report(made.page).scene["answers"]["events"]
    expect_equal([(event["a"], event["b"]) for event in events], [("component 0", "component 1")], "the events' parts")
    expect(page.has("table", "Parts against parts"), "no matrix")
    cell = next(e for e in page.find_all(".matrix button.cell"))
    cell.click()
    expect_equal(cell.get_attribute("aria-pressed"), "true", "the cell after a click")
    page.press(Keys.ENTER)
    expect_equal(cell.get_attribute("aria-pressed"), "false", "the cell after Enter")
    page.leave_controls()
    page.press("n")
    expect_equal(page.frame(), events[0]["worst"], "the worst frame")


def curves_lie_on_the_bodies(context):
    """The points of curves, as the page draws them, lie in planes of the tetrahedron that stands still."""
    made = context.material.tetrahedra()
    report = Report(made.page)
    frames, arrays = report.frames(), report.arrays
    planes = [lambda p: p[0], lambda p: p[0] - p[1] - p[2] + 4]
    checked = at = 0
    for row, place in enumerate(arrays["answer_frame"]):
        for _ in range(arrays["answer_counts"][5 * row + 3]):
            a, b = arrays["curve_vertices"][2 * at:2 * at + 2]
            share = arrays["curve_share"][at]
            shown = [(1 - share) * axis[a] + share * axis[b] for axis in frames[place]]
            off = min(min(abs(shown[1]), abs(shown[2])), *(abs(plane(shown)) for plane in planes))
            expect(off < 1e-3, f"frame {place}: {shown} is off the surface by {off}")
            checked, at = checked + 1, at + 1
    expect(checked > 10, f"{checked} points of curves")


def the_camera_stays_above_the_ground(context):
    """There is ground in this recording, and events on the lower side of the pawn."""
    _, page, report = open_pawn(context)
    for number in range(len(report.scene["answers"]["events"])):
        page.script("window.cscd.player.toEvent(arguments[0]);", number)
        over = page.script("""const { camera, controls } = window.cscd.viewer.view;
            return camera.position.z - controls.target.z;""")
        expect(over > 0, f"event {number + 1} is looked at from {over} below it")


def the_method_is_folded(context):
    _, page, _ = open_pawn(context)
    summary = page.find_all("#method > summary")[0]
    page.script("document.getElementById('method').open = false; arguments[0].focus();", summary)
    page.settle()
    expect(not page.has("table", "Timings"), "timings are seen although the method is folded")
    page.press(Keys.ENTER)
    expect(page.has("table", "Timings") and page.has("table", "Regions"), "Enter does not unfold the method")
    width = page.script("return document.querySelector('#charts .plot canvas').clientWidth;")
    expect(width > 400, f"charts that were folded are {width} wide")


def colours_of_the_method_are_folded(context):
    """They lie beside the view, folded at first; the key of one of them unfolds them, and a plan has nothing else."""
    folded = "return document.querySelector('.method-choices').open;"
    made = context.material.replay("pawn-drop")
    page = context.page
    for path, opened in ((made.page, False), (context.material.preprocess().page, True)):
        page.open(path, **SMALL, unfold=False)
        expect_equal(page.script(folded), opened, f"whether {path} shows the choices of the method")
        expect_equal(page.has("radio", "Charge"), opened, "whether charge can be chosen")
        expect(page.has("radio", "Plain") and page.has("checkbox", "Intersections"), "what anybody needs is not there")
    page.open(made.page, **SMALL)
    page.script("document.querySelector('.method-choices').open = false;")
    page.press("2")
    expect_equal((page.state("colour"), page.script(folded)), ("charge", True), "after the key for charge")


def parts_are_told_by_name(context):
    """The matrix has each pair of parts that meet, a click lists its events alone, and a click on one of them goes there."""
    made, page = context.material.limbs("before"), context.page
    page.open(made.page, width=1280, height=800)
    text = page.script("return document.getElementById('answer-line').textContent;")
    expect("2 events, the worst: Body × Arm, frames 3 to 6, 6.68 mm deep at frame 4." in text, text)
    rows = page.table("Parts against parts")
    expect_equal([row[0] for row in rows[1:]], ["Body", "Arm", "Leg"], "parts with events, the worst first")
    expect_equal((rows[2][1], rows[3][1]), ("6.68 mm", "2 mm"), "depths against the body")
    page.click("button", "Body × Leg: 1 event, at most 2 mm deep")
    expect_equal(page.state("speed"), 12, "the speed, where the frames have a rate")
    shown = page.script("return [...document.querySelectorAll('.events tbody tr:not([hidden]) .who')].map((one) => one.title);")
    expect_equal(shown, ["Body × Leg: crossing"], "events after a click in the matrix")
    page.click("button", "Event 2")
    page.rest()
    event = expect_event(page, Report(made.page), 1)
    expect_equal((event["a"], event["b"]), ("Body", "Leg"), "the parts of the second event")
    expect(len(page.script(FILLED)) > 0 and page.script(CURVE_SEGMENTS) > 0, "nothing is filled or drawn there")
    context.pictures.whole("parts")


def the_picture_is_saved(context):
    _, page, _ = open_pawn(context)
    page.click("button", "Event 2")
    page.script("""window.saved = []; const click = HTMLAnchorElement.prototype.click;
        HTMLAnchorElement.prototype.click = function () {
          if (this.download) window.saved.push([this.download, this.href]); else click.call(this); };""")
    page.click("button", "Save picture")
    page.wait(lambda: page.script("return window.saved.length;") == 1, "no picture is offered")
    name, address = page.script("return window.saved[0];")
    expect_equal((name, address[:5]), (f"pawn-drop.obj-{page.frame()}.png", "blob:"), "the offered picture")
    size = page.driver.execute_async_script(
        "const done = arguments[1], image = new Image(); image.onload = () => done(image.naturalWidth);"
        "image.onerror = () => done(0); image.src = arguments[0];", address)
    expect(size >= page.view_box()[2], f"the picture is {size} pixels wide")


def what_is_told_of_a_triangle_fits(context):
    for width in (1280, 360):
        _, page, _ = open_pawn(context, width=width, height=800)
        page.script("const { report, store } = window.cscd; store.set("
                    "{time: 40, triangle: report.scene.orientation.at(40).indexOf(0)});")  # the longest words
        page.settle()
        over = page.script("""const box = document.querySelector('.readout');
            const most = Math.max(...[...box.querySelectorAll('*')].map((e) => e.getBoundingClientRect().right));
            return [box.scrollWidth - box.clientWidth, most - box.getBoundingClientRect().right];""")
        expect(max(over) <= 0, f"{width} pixels: the readout overflows by {over}")


SCENARIOS = (answers_are_those_of_the_run, the_sentence_says_what_intersects, what_has_no_surface_is_named,
             what_shares_space_has_words,
             what_was_left_out_is_said,
             clicks_and_keys_walk_the_events,
             an_event_is_seen, parts_stand_against_parts, curves_lie_on_the_bodies,
             the_camera_stays_above_the_ground, the_method_is_folded, colours_of_the_method_are_folded,
             parts_are_told_by_name, the_picture_is_saved, what_is_told_of_a_triangle_fits)
