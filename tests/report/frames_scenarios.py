"""Frames keep the numbers that the artist gave them, whatever their step is, and whatever is missing between them."""
from selenium.webdriver.common.keys import Keys

from controls_scenarios import SMALL, expect_frame
from page import expect, expect_equal
from report_file import Report


def open_stepped(context):
    made = context.material.stepped()
    context.page.open(made.page, **SMALL)
    return made, context.page


def steps_lead_to_the_neighbouring_frame(context):
    made, page = open_stepped(context)
    expect_frame(page, 1001, "opening")
    for number in made.numbers[1:]:
        page.click("button", "Next frame")
        expect_frame(page, number, "a step forwards")
        expect(page.status().startswith(f"Frame {number} ({number / 25:.2f} s) of "), page.status())
    expect(page.element("button", "Next frame").get_property("disabled"), "there is no frame after the last")
    for number in made.numbers[-2::-1]:
        page.press(Keys.ARROW_LEFT) if number % 4 == 1 else page.click("button", "Previous frame")
        page.leave_controls()
        expect_frame(page, number, "a step backwards")
    page.go_to(1014.5)
    page.leave_controls()
    page.press(Keys.ARROW_RIGHT)
    expect_frame(page, 1017, "a step from within the gap")


def the_slider_and_the_charts_know_the_frames(context):
    made, page = open_stepped(context)
    slider = page.element("slider", "Frame")
    page.script("arguments[0].focus();", slider)
    page.press(*[Keys.ARROW_RIGHT] * 6)
    expect_frame(page, 1017, "six keys on the slider")
    expect_equal(slider.get_attribute("aria-valuetext"), "1017", "what the slider says")
    plot = page.find_all("#charts .plot .u-over")[0]
    page.click_at(plot, 5.5 / 9, 0.5)
    expect_frame(page, 1011, "a click on the sixth interval of a chart")
    rows = page.table("Intervals")[1:]
    expect_equal([row[0] for row in rows], [str(number) for number in made.numbers[:-1]], "frames of the intervals")
    page.click("button", "Frame 1019")
    expect_frame(page, 1019, "a row of the table")


def contacts_are_at_their_moments(context):
    """In the page's document, under the marks of the view and in the list: an interval may be longer than 1."""
    made, page = open_stepped(context)
    scene = Report(made.page).scene
    expect_equal(scene["numbers"], made.numbers, "numbers of the frames")
    contacts = made.contacts()
    expect(len({contact[0] for contact in contacts}) >= 2, "contacts in one interval only: the case shows nothing")
    for number in made.numbers[:-1]:
        page.go_to(number)
        expected = [contact for contact in contacts if contact[0] == number]
        marks = page.markers()
        expect_equal(len(marks), len(expected), f"marks in interval {number}")
        expect(all(mark["interval"] == number for mark in marks), f"marks of other intervals: {marks}")
    last = contacts[-1]
    page.go_to(last[0])
    page.click("button", f"Contact {sum(contact[0] == last[0] for contact in contacts)}")
    length = made.numbers[made.numbers.index(last[0]) + 1] - last[0]
    expect(abs(page.frame() - (last[0] + last[3] * length)) < 1e-6,
           f"the moment of a contact at {last[3]} of {last[0]}: {page.frame()}")


def playing_takes_the_gap_and_ends(context):
    made, page = open_stepped(context)
    page.go_to(1011.5)
    page.click("button", "Play")
    page.wait(lambda: page.frame() >= 1012.5, "the time does not pass in the gap")
    page.wait(lambda: not page.state("playing"), "it does not stop at the end")
    expect_frame(page, made.numbers[-1], "playing to the end")


def the_address_names_the_frame(context):
    made, page = open_stepped(context)
    hash_of = "return window.location.hash;"
    page.click("button", "Next frame")
    expect_equal(page.script(hash_of), "#frame=1003", "the address after a step")
    page.script("window.location.hash = '#frame=1017';")
    page.wait(lambda: page.frame() == 1017, "the page does not follow the address")
    page.script("window.location.hash = '#frame=1014';")
    page.wait(lambda: page.frame() == 1011, "in a gap the frame before it is shown")
    page.driver.get("file://" + page.path + "#frame=1019")
    page.driver.refresh()
    page.driver.execute_async_script("const done = arguments[0]; window.cscd.ready.then(() => done());")
    expect_frame(page, 1019, "opening with a frame in the address")
    page.forget()


SCENARIOS = (steps_lead_to_the_neighbouring_frame, the_slider_and_the_charts_know_the_frames,
             contacts_are_at_their_moments, playing_takes_the_gap_and_ends, the_address_names_the_frame)
