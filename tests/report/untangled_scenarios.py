"""The page of what was untangled: before, after, how far vertices moved, and what is left."""
from controls_scenarios import SMALL
from page import expect, expect_equal
from report_file import Report

FILLED = "return window.cscd.viewer.painter.filled.length;"
SEGMENTS = "return window.cscd.viewer.curves.segments;"
PLACE = "return window.cscd.viewer.body.local[0] + window.cscd.viewer.body.center[0];"
COLOURS = "return new Set(window.cscd.viewer.painter.rgb).size;"
LEGEND = "return document.querySelector('.legend-body').textContent;"


def answer_line(page):
    return page.script("return document.getElementById('answer-line').textContent;")


def the_slider_leads_from_before_to_after(context):
    made, page = context.material.untangled("one", "--frames", "5"), context.page
    page.open(made.page, **SMALL)
    expect(answer_line(page).startswith("Clean: ") and " none after; " in answer_line(page), answer_line(page))
    expect(page.script(FILLED) > 3 and page.script(SEGMENTS) > 2, "nothing is shown to cross before")
    expect("How far vertices moved" in page.script(LEGEND) and "What intersects before" in page.script(LEGEND), page.script(LEGEND))
    before = page.script(PLACE)
    page.click("button", "After")
    expect_equal((page.state("share"), page.script(FILLED), page.script(SEGMENTS)), (1, 0, 0), "share, fills and curves after")
    after = page.script(PLACE)
    page.script("window.cscd.store.set({share: 0.5});")
    page.settle()
    expect(abs(page.script(PLACE) - (before + after) / 2) < 1e-6, "half of the way is not in the middle")
    expect(page.element("slider", "From before to after").get_attribute("value") == "0.5", "the slider stays")
    page.leave_controls()
    page.press("a")
    expect_equal(page.state("share"), 0, "share after the key A")
    expect_equal(page.script(PLACE), before, "where it was")


def colours_say_how_far_it_moved(context):
    made, page = context.material.untangled("one", "--frames", "5"), context.page
    page.open(made.page, **SMALL)
    page.set_box("Intersections", False)
    expect_equal(page.state("colour"), "displacement", "the colour at first")
    expect(page.script(COLOURS) > 6, "displacements have one colour")
    page.click("radio", "Plain")
    expect_equal(page.script(COLOURS), 3, "values of the plain colour")
    expect(not page.has("radio", "Charge") and not page.has("checkbox", "Contacts"), "a page without contacts offers them")
    page.press("z")
    page.check_quiet()


def frames_are_listed(context):
    made, page = context.material.untangled("all"), context.page
    page.open(made.page, **SMALL)
    frames = Report(made.page).document["untangled"]["frames"]
    worst = max(frames, key=lambda frame: frame["displacement"])
    expect_equal(page.frame(), worst["frame"], "the frame at first")
    rows = page.table("Frames")
    expect_equal([row[1:4] for row in rows[1:]], [[frame["pairs_before"], frame["pairs_after"], frame["moved_vertices"]] for frame in frames],
                 "the table of frames")
    page.click("button", "Frame 7")
    expect_equal(page.frame(), 7, "the frame of the row")
    page.click("button", "Next frame")
    expect_equal(page.frame(), 8, "the next frame")
    expect(page.status().startswith("Frame 8 of 0 to 9"), page.status())


def what_is_left_has_a_reason(context):
    made, page = context.material.untangled("left", "--frames", "5", "--time", "1e-9", "--partial", code=3), context.page
    page.open(made.page, **SMALL)
    expect(answer_line(page).startswith("Not clean: "), answer_line(page))
    rows = page.table("What is left")
    expect_equal(rows[1][0::2], ["component 0 × component 1", "the time was up"], "the parts, and why")
    page.click("button", "After")
    expect(page.script(FILLED) > 3 and "What intersects after" in page.script(LEGEND), "what is left is not shown")


SCENARIOS = (the_slider_leads_from_before_to_after, colours_say_how_far_it_moved, frames_are_listed, what_is_left_has_a_reason)
