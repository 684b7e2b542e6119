"""Every control by its accessible name and every key does what it says, and all of it works without a mouse."""
import re

from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

from page import expect, expect_equal

BUTTONS = ("First frame", "Previous frame with contacts", "Previous frame", "Play", "Next frame",
           "Next frame with contacts", "Last frame", "Frame with most contacts", "Reset view", "Zoom to contacts",
           "Save picture", "Light or dark", "Keyboard help")
COLOURS = {"Plain": "plain", "Charge": "charge", "Equalized charge": "equalized", "Region": "region",
           "Orientation": "orientation", "Contact heat": "heat"}
MARKS = {"Intersections": "answers", "Contacts": "contacts", "Trail": "trail", "Through the surface": "through",
         "Detector points": "points",
         "Region cuts": "cuts", "Edges": "edges", "Surroundings": "scenery"}
MARK_KEYS = {"i": "answers", "c": "contacts", "t": "trail", "x": "through", "d": "points", "r": "cuts", "e": "edges",
             "b": "scenery"}
LANDMARKS = ("Playback", "Colour and marks", "Contacts of this interval", "Charts", "Timings", "Intervals", "Regions",
             "Provenance", "Licences")
TABS_MOST = 250
# A window of half the pixels, which are drawn by software, for scenarios that do not look at the view.
SMALL = {"width": 1000, "height": 560}


def expect_frame(page, frame, what):
    expect_equal(page.frame(), frame, f"frame after {what}")
    words = re.sub(r" \(\d+\.\d\d s\)", "", page.status())  # seconds are told where the frames have a rate
    expect(words.startswith(f"Frame {frame} of "), f"status after {what}: {page.status()!r}")


def frames_with_contacts(made):
    return sorted({contact[0] for contact in made.contacts()})


def busiest(made):
    """Returns the interval with most contacts, or the first of several."""
    return max(made.summary()["intervals"], key=lambda interval: interval["vf"] + interval["ee"])["frame"]


def open_pawn(context, **arguments):
    made = context.material.replay("pawn-drop")
    context.page.open(made.page, **{**SMALL, **arguments})
    return made, context.page


def everything_has_its_name(context):
    _, page = open_pawn(context)
    missing = [f"button {name}" for name in BUTTONS if not page.has("button", name)]
    missing += [f"radio {name}" for name in COLOURS if not page.has("radio", name)]
    missing += [f"checkbox {name}" for name in (*MARKS, "Loop") if not page.has("checkbox", name)]
    missing += [f"region {name}" for name in LANDMARKS if not page.has("region", name)]
    others = {"image": "3D view", "slider": "Frame", "combobox": "Speed", "radiogroup": "Colour by", "group": "Show"}
    missing += [f"{role} {name}" for role, name in others.items() if not page.has(role, name)
                and not (role == "radiogroup" and page.has("group", name))]
    expect(not missing, f"not in the accessibility tree: {', '.join(missing)}")
    told = page.script("""return document.querySelector('#view canvas').getAttribute('aria-describedby').split(' ')
        .map((id) => document.getElementById(id).textContent);""")
    expect(told[0].startswith("Frame 0") and "Alt" in told[1], f"the view is described as {told}")
    empty = page.script("""return [...document.querySelectorAll('th')].filter((one) => one.textContent.trim() === '')
        .length;""")
    expect_equal(empty, 0, "header cells without text")
    heard = page.script("return document.querySelectorAll('.plot canvas:not([aria-hidden])').length;")
    expect_equal(heard, 0, "canvases of charts that readers meet")


def buttons_step_and_jump(context):
    made, page = open_pawn(context)
    touching, last = frames_with_contacts(made), len(made.summary()["intervals"])
    expect_frame(page, 0, "opening")
    steps = [("Next frame", 1), ("Next frame", 2), ("Previous frame", 1), ("Last frame", last), ("Previous frame", last - 1),
             ("First frame", 0), ("Next frame with contacts", touching[0]), ("Next frame with contacts", touching[1]),
             ("Previous frame with contacts", touching[0]), ("Frame with most contacts", busiest(made))]
    for name, frame in steps:
        page.click("button", name)
        expect_frame(page, frame, name)


def state_in_words(interval):
    """Returns the page's word for the state that the summary gives an interval."""
    return "intersecting" if interval["state"] == "penetrating" else interval["state"]


def status_tells_state_and_counts(context):
    made, page = open_pawn(context)
    intervals = made.summary()["intervals"]
    for interval in (intervals[0], intervals[busiest(made)], next(i for i in intervals if i["state"] == "contact")):
        page.go_to(interval["frame"])
        text = page.status()
        expect(text.startswith(f"Frame {interval['frame']} of 0 to {len(intervals)}"), text)
        words = state_in_words(interval)
        expect(words in text, f"no {words} in {text!r}")
        counts = f"{interval['vf']} VF, {interval['ee']} EE"
        if interval["vf"] + interval["ee"] > 0:
            expect(counts in text, f"no {counts} in {text!r}")


def playing_moves_and_pausing_stops(context):
    _, page = open_pawn(context)
    page.click("button", "Play")
    expect(page.has("button", "Pause") and not page.has("button", "Play"), "while it plays the button is called Pause")
    page.wait(lambda: page.frame() > 3, "the time does not pass")
    page.click("button", "Pause")
    page.wait(lambda: not page.state("playing"), "it does not pause")
    stopped = page.frame()
    page.settle()
    expect_equal(page.frame(), stopped, "time of a stopped recording")
    expect(page.has("button", "Play"), "when it stands the button is called Play")


def the_end_stops_or_begins_again(context):
    made, page = open_pawn(context)
    last = len(made.summary()["intervals"])
    loop = page.element("checkbox", "Loop")
    if loop.is_selected():
        page.click("checkbox", "Loop")
    page.go_to(last - 2)
    page.click("button", "Play")
    page.wait(lambda: not page.state("playing"), "it does not stop at the end")
    expect_frame(page, last, "playing to the end")
    page.click("checkbox", "Loop")
    page.go_to(last - 2)
    page.click("button", "Play")
    page.wait(lambda: page.frame() < last - 2, "it does not begin again")
    expect(page.state("playing"), "it stopped although it loops")
    page.click("button", "Pause")


def speed_is_chosen(context):
    _, page = open_pawn(context)
    select = Select(page.element("combobox", "Speed"))
    before = page.state("speed")
    expect(len(select.options) >= 3, "less than three speeds")
    for index in range(len(select.options)):
        select.select_by_index(index)
        expect_equal(page.script("return window.cscd.store.get().speed > 0;"), True, "a speed")
    expect(page.state("speed") != before, "the last speed is the first")
    page.leave_controls()
    chosen = page.state("speed")
    page.press("-")
    expect(page.state("speed") < chosen, "- makes it no slower")
    page.press("+")
    expect_equal(page.state("speed"), chosen, "speed after - and +")


def slider_takes_keys_and_mouse(context):
    made, page = open_pawn(context)
    last = len(made.summary()["intervals"])
    slider = page.element("slider", "Frame")
    page.click_at(slider, 0.5, 0.5)
    expect(abs(page.frame() - last / 2) <= 3 and page.frame() % 1 == 0, f"a click in the middle leads to {page.frame()}")
    middle = page.frame()
    page.press(Keys.ARROW_RIGHT)
    expect_frame(page, middle + 1, "right, on the slider")
    page.press(Keys.ARROW_LEFT, Keys.ARROW_LEFT)
    expect_frame(page, middle - 1, "left twice, on the slider")
    page.press(Keys.END)
    expect_frame(page, last, "end, on the slider")
    page.press(Keys.HOME)
    expect_frame(page, 0, "home, on the slider")


def colours_and_marks_are_chosen(context):
    _, page = open_pawn(context)
    for name, value in COLOURS.items():
        page.click("radio", name)
        expect_equal(page.state("colour"), value, f"colour after {name}")
    for name, key in MARKS.items():
        before = page.state(key)
        page.click("checkbox", name)
        expect_equal(page.state(key), not before, f"{key} after a click on {name}")
        expect_equal(page.element("checkbox", name).is_selected(), not before, f"box {name}")
        page.click("checkbox", name)
        expect_equal(page.state(key), before, f"{key} after two clicks on {name}")


def keys_do_what_the_help_says(context):
    made, page = open_pawn(context)
    touching, last = frames_with_contacts(made), len(made.summary()["intervals"])
    page.leave_controls()
    right, left, shift = Keys.ARROW_RIGHT, Keys.ARROW_LEFT, Keys.SHIFT
    steps = [(right, 1), (right, 2), (left, 1), ((shift, right), touching[0]), ("]", touching[1]), ("[", touching[0]),
             ((shift, right), touching[1]), ((shift, left), touching[0]), (Keys.END, last), (Keys.HOME, 0),
             ("m", busiest(made))]
    for key, frame in steps:
        page.press(key)
        expect_frame(page, frame, repr(key))
    for number, colour in enumerate(COLOURS.values(), 1):
        page.press(str(number))
        expect_equal(page.state("colour"), colour, f"colour after {number}")
    for key, mark in MARK_KEYS.items():
        before = page.state(mark)
        page.press(key)
        expect_equal(page.state(mark), not before, f"{mark} after {key}")
        page.press(key)
    page.press(" ")
    expect(page.state("playing"), "space does not play")
    page.press(" ")
    expect(not page.state("playing"), "space does not pause")
    theme = page.state("theme")
    page.press("l")
    expect(page.state("theme") != theme, "l does not change light and dark")


def help_opens_and_closes(context):
    _, page = open_pawn(context)
    page.leave_controls()
    for opening in (lambda: page.press("?"), lambda: page.click("button", "Keyboard help")):
        expect(not page.nodes("dialog"), "a dialog is open")
        opening()
        expect_equal(len(page.nodes("dialog")), 1, "dialogs after asking for help")
        text = page.of_node(page.nodes("dialog")[0]).text.lower()
        expect("space" in text and "home" in text, f"the help says {text!r}")
        page.press(Keys.ESCAPE)
    expect(not page.nodes("dialog"), "Escape does not close the help")


def names_by_tab(page):
    """Returns the names that Tab leads to, from the top of the page to its end or to where it began."""
    page.script("document.activeElement.blur(); window.scrollTo(0, 0);")
    names = []
    for _ in range(TABS_MOST):
        page.driver.switch_to.active_element.send_keys(Keys.TAB)
        element = page.driver.switch_to.active_element
        if element.tag_name == "body":
            break
        names.append(element.accessible_name)
        if names.count(names[0]) > 1:
            break
    return names


def tab_reaches_every_control(context):
    """Tab reaches the chosen one of a group of radios, and arrows lead on from there."""
    made, page = open_pawn(context)
    page.go_to(busiest(made))
    names = names_by_tab(page)
    wanted = [*BUTTONS, *MARKS, "Frame", "Speed", "Loop", "Contact 1"]
    missing = [name for name in wanted if name not in names]
    expect(not missing, f"Tab does not reach {missing}, but {names}")
    chosen = page.element("radio", "Plain")
    page.script("arguments[0].focus();", chosen)
    page.press(Keys.ARROW_DOWN)
    expect_equal(page.state("colour"), "heat", "colour after an arrow in the group")
    focused = page.driver.find_element(By.CSS_SELECTOR, ":focus")
    outline = page.script("const s = getComputedStyle(arguments[0]); return s.outlineStyle + s.boxShadow;", focused)
    expect(outline != "nonenone", "the focus cannot be seen")


SCENARIOS = (everything_has_its_name, buttons_step_and_jump, status_tells_state_and_counts,
             playing_moves_and_pausing_stops, the_end_stops_or_begins_again, speed_is_chosen,
             slider_takes_keys_and_mouse, colours_and_marks_are_chosen, keys_do_what_the_help_says,
             help_opens_and_closes, tab_reaches_every_control)
