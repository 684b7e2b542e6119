"""The page fits and can be read in narrow windows, on fine screens, in light and dark."""
from controls_scenarios import BUTTONS, busiest, open_pawn
from page import HEIGHT, WIDTH, expect, expect_equal

LEAST_CONTRAST = 4.5
# Returns the colours of text and of its background (the first that is not transparent) as numbers.
CONTRASTS = """
const numbers = (text) => (text.match(/[\\d.]+/g) ?? []).map(Number);
const linear = (c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4);
const light = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
const ground = (element) => {
  for (let e = element; e; e = e.parentElement) {
    const colour = numbers(getComputedStyle(e).backgroundColor);
    if (colour.length === 3 || colour[3] === 1) return colour;
  }
  return [255, 255, 255];
};
return arguments[0].map((selector) => {
  const element = document.querySelector(selector);
  if (!element) return [selector, null];
  const [a, b] = [light(numbers(getComputedStyle(element).color)), light(ground(element))].sort((x, y) => y - x);
  return [selector, (a + 0.05) / (b + 0.05)];
});
"""
WIDER = """
const wide = document.documentElement.clientWidth;
return {page: document.documentElement.scrollWidth, wide,
        culprits: [...document.querySelectorAll('body *')].filter((e) => e.getBoundingClientRect().right > wide + 1)
          .slice(0, 5).map((e) => `${e.tagName}#${e.id}.${e.className}`)};
"""


# Finds boxes whose content does not fit, in which nothing takes the focus.
UNREACHABLE = """
return [...document.querySelectorAll('.scroll')].filter((e) => e.scrollWidth > e.clientWidth + 1 && e.tabIndex < 0 &&
  !e.querySelector('button, a, input')).map((e) => e.firstElementChild.getAttribute('aria-label'));
"""


def what_scrolls_does_so_by_keyboard(context):
    for path in (context.material.replay("pawn-drop").page, context.material.preprocess().page,
                 context.material.comparison().page):
        context.page.open(path, width=360, height=800)
        expect_equal(context.page.script(UNREACHABLE), [], "tables that only a pointer can scroll")


def narrow_windows_do_not_scroll_sideways(context):
    made = context.material.replay("pawn-drop")
    for name, path in (("replay", made.page), ("preprocess", context.material.preprocess().page),
                       ("comparison", context.material.comparison().page)):
        for width in (380, 360):
            context.page.open(path, width=width, height=800)
            found = context.page.script(WIDER)
            expect(found["page"] <= found["wide"], f"{name}, {width} pixels wide: scrolls to {found}")
        context.pictures.whole(f"narrow-{name}")


def narrow_windows_have_every_control(context):
    _, page = open_pawn(context, width=380, height=800)
    missing = [name for name in BUTTONS if not page.has("button", name)]
    expect(not missing, f"missing when narrow: {missing}")
    page.click("button", "Next frame")
    expect_equal(page.frame(), 1, "frame after a step")
    expect(page.view_box()[2] > 300, "the view is narrow")


def fine_screens_get_fine_pictures(context):
    _, page = open_pawn(context, ratio=2)
    page.rest()
    width, client = page.script("const c = arguments[0]; return [c.width, c.getBoundingClientRect().width];",
                                page.element("image", "3D view"))
    expect(abs(width - 2 * client) <= 2, f"{width} pixels for {client} of the page, at two a pixel")
    context.pictures.whole("fine")


def light_and_dark_follow_the_system_and_the_button(context):
    pictures = {}
    for theme in ("light", "dark"):
        made, page = open_pawn(context, width=WIDTH, height=HEIGHT, theme=theme)
        expect_equal(page.state("theme"), theme, "theme")
        page.go_to(busiest(made))
        context.pictures.whole(f"page-{theme}")
        pictures[theme] = brightness(page)
        for selector, contrast in page.script(CONTRASTS, ["body", "h1", "[role=status]", "button", "table td", "label"]):
            expect(contrast is None or contrast >= LEAST_CONTRAST, f"{theme}: contrast of {selector} is {contrast:.2f}")
    expect(pictures["dark"] < 0.3 and pictures["light"] > 0.7, f"brightness of the ground: {pictures}")
    page.click("button", "Light or dark")
    expect_equal((page.state("theme"), brightness(page) > 0.7), ("light", True), "theme after the button")


def brightness(page):
    return page.script("const c = getComputedStyle(document.body).backgroundColor.match(/[\\d.]+/g).map(Number);"
                       "return (c[0] + c[1] + c[2]) / 765;")


def the_view_is_the_largest_part(context):
    _, page = open_pawn(context, width=WIDTH, height=HEIGHT)
    _, _, width, height = page.view_box()
    expect(width > 0.5 * WIDTH and height > 300, f"the view is {width} by {height}")
    found = page.script(WIDER)
    expect(found["page"] <= found["wide"], f"the page scrolls sideways: {found}")


SCENARIOS = (what_scrolls_does_so_by_keyboard, narrow_windows_do_not_scroll_sideways, narrow_windows_have_every_control,
             fine_screens_get_fine_pictures, light_and_dark_follow_the_system_and_the_button, the_view_is_the_largest_part)
