"""The 3D view draws the body, each contact at its place, every colour and mark, in pixels of the screen."""
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.keys import Keys

from controls_scenarios import COLOURS, busiest, open_pawn
from material import RECORDINGS
from page import expect, expect_equal

VF, EE = (0, 90, 181), (220, 50, 32)
POSITION_TOLERANCE = 1e-6
TRAIL = 8


def bare(page):
    """Switches off everything but the plain body."""
    page.script("window.cscd.store.set({playing: false, colour: 'plain', contacts: false, trail: false, through: false,"
                " points: false, cuts: false, edges: false, scenery: false, selected: null, triangle: null});")
    page.settle()


def at_most_contacts(context, name="pawn-drop"):
    made = context.material.replay(name)
    page = context.page
    page.open(made.page)
    bare(page)
    page.go_to(busiest(made))
    return made, page


def in_view(page, markers):
    """Returns the markers that the window shows."""
    _, _, width, height = page.view_box()
    return [marker for marker in markers if 0 <= marker["screen"][0] <= width and 0 <= marker["screen"][1] <= height]


def same_place(a, b):
    return max(abs(p - q) for p, q in zip(a, b)) <= POSITION_TOLERANCE


def check_markers(page, contacts, interval):
    """There is one marker for each contact of the interval, at its point."""
    expected = sorted((kind, point) for frame, kind, _, _, point in contacts if frame == interval)
    markers = [marker for marker in page.markers() if marker["interval"] == interval]
    found = sorted((marker["kind"], tuple(marker["position"])) for marker in markers)
    expect_equal(len(found), len(expected), f"markers of interval {interval}")
    for (kind, position), (true_kind, point) in zip(found, expected):
        expect(kind == true_kind and same_place(position, point), f"{kind} at {position}, not {true_kind} at {point}")
    expect_equal(len(in_view(page, markers)), len(markers), f"markers of interval {interval} within the view")
    return markers


def contacts_are_where_the_csv_has_them(context):
    for name in RECORDINGS:
        made, page = at_most_contacts(context, name)
        without = context.pictures.view()
        page.set_box("Contacts", True)
        markers = check_markers(page, made.contacts(), busiest(made))
        page.set_box("Through the surface", True)
        through = context.pictures.view(f"{name}-through")
        places = [marker["screen"] for marker in markers]
        hidden = [n for n in context.pictures.difference(without, through, places)["near"] if n == 0]
        expect(not hidden, f"{name}: {len(hidden)} of {len(places)} contacts cannot be seen through the surface")


def contacts_in_sight_are_drawn(context):
    """Without the markers behind the surface there are fewer pixels, but some."""
    made, page = at_most_contacts(context)
    without = context.pictures.view()
    page.set_box("Contacts", True)
    shown = context.pictures.view("contacts")
    context.pictures.whole("page")
    in_sight = context.pictures.difference(without, shown)["all"]
    page.set_box("Through the surface", True)
    with_hidden = context.pictures.difference(without, context.pictures.view())["all"]
    expect(0 < in_sight < with_hidden, f"{in_sight} pixels in sight, {with_hidden} with those behind the surface")


def kinds_differ_in_colour_and_shape(context):
    made, page = at_most_contacts(context)
    page.set_box("Contacts", True)
    page.set_box("Through the surface", True)
    page.click("button", "Zoom to contacts")
    page.settle()
    picture = context.pictures.view("zoomed")
    markers = in_view(page, page.markers())
    expect({marker["kind"] for marker in markers} == {"vf", "ee"}, "not both kinds are in view")
    for kind, colour in (("vf", VF), ("ee", EE)):
        places = [marker["screen"] for marker in markers if marker["kind"] == kind]
        found = sum(count > 0 for count in context.pictures.count_near(picture, colour, places))
        print(f"{found} of {len(places)} {kind} markers have pixels of their colour")
        expect(found > 0, f"no {kind} marker has its colour")
    expect(context.pictures.count(picture, VF) > 20 and context.pictures.count(picture, EE) > 20, "too few pixels")


def trail_keeps_the_intervals_before(context):
    made, page = at_most_contacts(context)
    interval = busiest(made)
    page.set_box("Contacts", True)
    page.set_box("Through the surface", True)
    without, now = context.pictures.view(), len(page.markers())
    page.set_box("Trail", True)
    with_trail = context.pictures.view("trail")
    markers = page.markers()
    window = range(interval - TRAIL, interval + 1)
    expected = sum(contact[0] in window for contact in made.contacts())
    expect(now < len(markers) == expected, f"{len(markers)} markers, not {expected}, {now} of them new")
    for marker in markers:
        expect_equal(marker["age"], interval - marker["interval"], f"age of a contact of interval {marker['interval']}")
    expect(context.pictures.difference(without, with_trail)["all"] > 50, "the trail changes nothing")


def every_colour_is_another_picture(context):
    made, page = at_most_contacts(context)
    pictures = {}
    for name, value in COLOURS.items():
        page.click("radio", name)
        pictures[name] = context.pictures.view(f"colour-{value}")
    names = list(pictures)
    for i, one in enumerate(names):
        for other in names[i + 1:]:
            difference = context.pictures.difference(pictures[one], pictures[other])
            expect(difference["all"] > 0.002 * difference["pixels"],
                   f"{one} and {other} differ in {difference['all']} of {difference['pixels']} pixels only")


def every_mark_changes_the_picture(context):
    _, page = at_most_contacts(context, "figure-balls")
    plain = context.pictures.view("plain")
    for name in ("Detector points", "Region cuts", "Edges", "Surroundings"):
        page.set_box(name, True)
        marked = context.pictures.view("mark-" + name.lower().replace(" ", "-"))
        difference = context.pictures.difference(plain, marked)["all"]
        expect(difference > 30, f"{name} changes {difference} pixels")
        page.set_box(name, False)
        context.pictures.expect_back(plain, name)


def body_moves_between_frames_too(context):
    made, page = at_most_contacts(context)
    pictures = []
    for time in (busiest(made), busiest(made) + 0.5, busiest(made) + 1):
        page.go_to(time)
        pictures.append(context.pictures.view())
    for one, other in ((0, 1), (1, 2)):
        expect(context.pictures.difference(pictures[one], pictures[other])["all"] > 50, "half a frame moves nothing")


def camera_turns_zooms_and_comes_back(context):
    _, page = at_most_contacts(context)
    page.press("0")
    page.leave_controls()
    page.settle()
    start = context.pictures.view()
    canvas = page.element("image", "3D view")
    ActionChains(page.driver, duration=50).click_and_hold(canvas).move_by_offset(120, 30).release().perform()
    page.settle()
    turned = context.pictures.view()
    expect(context.pictures.difference(start, turned)["all"] > 1000, "dragging turns nothing")
    ActionChains(page.driver).scroll_from_origin(ScrollOrigin.from_element(canvas), 0, -300).perform()
    page.settle()
    expect(context.pictures.difference(turned, context.pictures.view())["all"] > 1000, "the wheel zooms nothing")
    page.press("0")
    page.leave_controls()
    context.pictures.expect_back(start, "turning and zooming")


def keys_turn_the_camera(context):
    _, page = at_most_contacts(context)
    start = context.pictures.view()
    for keys in ((Keys.ALT, Keys.ARROW_LEFT), (Keys.ALT, Keys.ARROW_UP), (Keys.ALT, Keys.PAGE_UP)):
        before = context.pictures.view()
        page.script("arguments[0].focus();", page.element("image", "3D view"))
        page.press(keys)
        page.leave_controls()
        expect(context.pictures.difference(before, context.pictures.view())["all"] > 500, f"{keys!r} turns nothing")
    page.press("0")
    context.pictures.expect_back(start, "turning by keys")


def a_click_picks_contacts_and_triangles(context):
    """A click on a marker selects the contact, a click on the bare body a triangle, and a click beside it nothing."""
    _, page = at_most_contacts(context)
    canvas = page.element("image", "3D view")
    _, _, width, height = page.view_box()
    page.set_box("Contacts", True)
    marker = page.markers()[-1]
    page.click_at(canvas, marker["screen"][0] / width, marker["screen"][1] / height)
    selected = page.state("selected")
    expect(selected is not None, "a click on a marker selects no contact")
    chosen = [m for m in page.markers() if m["contact"] == selected]
    expect(len(chosen) == 1, f"the marker of contact {selected} is gone")
    page.set_box("Contacts", False)
    x, y = chosen[0]["screen"]
    page.click_at(canvas, x / width, y / height)
    expect(isinstance(page.state("triangle"), int), "a click on the body picks no triangle")
    page.click_at(canvas, 0.02, 0.5)
    expect_equal(page.state("triangle"), None, "triangle after a click beside the body")


def zoom_looks_at_the_contacts(context):
    made, page = at_most_contacts(context)
    page.set_box("Contacts", True)
    before = spread(page.markers())
    page.click("button", "Zoom to contacts")
    page.settle()
    markers = page.markers()
    expect_equal(len(in_view(page, markers)), len(markers), "contacts in view")
    expect(spread(markers) > 1.2 * before, f"contacts spread over {spread(markers):.0f} pixels, {before:.0f} before")


def spread(markers):
    return max(max(m["screen"][k] for m in markers) - min(m["screen"][k] for m in markers) for k in (0, 1))


SCENARIOS = (contacts_are_where_the_csv_has_them, contacts_in_sight_are_drawn, kinds_differ_in_colour_and_shape,
             trail_keeps_the_intervals_before, every_colour_is_another_picture, every_mark_changes_the_picture,
             body_moves_between_frames_too, camera_turns_zooms_and_comes_back, keys_turn_the_camera,
             a_click_picks_contacts_and_triangles, zoom_looks_at_the_contacts)
