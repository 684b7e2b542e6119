"""The charts are drawn in time with the scrubber, and a click in them moves it."""
from controls_scenarios import busiest, open_pawn
from page import expect, expect_equal

CHARTS = ("Milliseconds per stage", "Contacts per interval", "Pairs per interval (#PCPs)")
# The axis to the left of the plot, and a margin to its right, in pixels.
LEFT, RIGHT = 52, 12


def charts_are_there(context):
    _, page = open_pawn(context)
    for name in CHARTS:
        check_drawn(page, page.element("figure", name), name)


def check_drawn(page, figure, name):
    expect(figure.rect["width"] > 100 and figure.rect["height"] > 40, f"{name} is {figure.rect} large")
    inked = "return [...arguments[0].querySelectorAll('canvas')].some((canvas) => canvas.getContext('2d')" \
            ".getImageData(0, 0, canvas.width, canvas.height).data.some((value) => value > 0));"
    page.wait(lambda: page.script(inked, figure), f"something drawn in {name}")


def a_click_moves_the_scrubber(context):
    made, page = open_pawn(context)
    last = len(made.summary()["intervals"])
    for name in CHARTS:
        for part in (0.25, 0.8):
            figure = page.element("figure", name)
            width = figure.rect["width"]
            page.click_at(figure, (LEFT + part * (width - LEFT - RIGHT)) / width, 0.6)
            expect(abs(page.frame() - part * last) <= 3, f"{name}: a click at {part} leads to frame {page.frame()}")
            expect_equal(page.element("slider", "Frame").get_attribute("value"), str(page.frame()), "the slider's frame")


def the_cursor_follows_the_time(context):
    """Something in each chart moves with the frame that is shown."""
    made, page = open_pawn(context)
    page.go_to(2)
    early = [page.element("figure", name).screenshot_as_png for name in CHARTS]
    page.go_to(busiest(made))
    for name, before in zip(CHARTS, early):
        expect(page.element("figure", name).screenshot_as_png != before, f"{name} does not show where the scrubber is")


SCENARIOS = (charts_are_there, a_click_moves_the_scrubber, the_cursor_follows_the_time)
