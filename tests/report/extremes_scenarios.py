"""Unusual reports: empty ones, hostile names, parts of recordings, 100,000 triangles."""
from material import HOSTILE, LARGE_TRIANGLES
from page import expect, expect_equal
from report_file import Report


def names_are_text(context):
    """A file's name may contain markup, quotes and lines; the page shows it and does nothing else with it."""
    made, page = context.material.tetrahedra(HOSTILE.replace("/", ":")), context.page
    page.open(made.page)
    expect_equal(Report(made.page).document["title"], made.name, "title in the data")
    expect(page.driver.title != "owned" and not page.find_all("img"), "the name of a file has become markup")
    flat = " ".join(made.name.split())
    heading = " ".join(page.script("return document.querySelector('h1').textContent;").split())
    expect(flat in heading, f"the page is headed {heading!r}, not {flat!r}")


def part_of_a_recording_keeps_its_numbers(context):
    made, page = context.material.tetrahedra("part", "--frames", "2:8"), context.page
    page.open(made.page)
    expect(page.status().startswith("Frame 2 of 2 to 8"), page.status())
    page.click("button", "Last frame")
    expect_equal(page.frame(), 8, "last frame")
    page.click("button", "First frame")
    page.click("button", "Next frame with contacts")
    first = made.contacts()[0]
    expect_equal((page.frame(), first[0]), (3, 3), "interval of the first contact")
    page.set_box("Contacts", True)
    marker = page.markers()[0]
    expect(max(abs(a - b) for a, b in zip(marker["position"], first[4])) < 1e-6, f"{marker} is not at {first[4]}")


def nothing_touches(context):
    made, page = context.material.tetrahedra("apart", "--frames", "0:2"), context.page
    page.open(made.page)
    expect_equal(made.contacts(), [], "contacts")
    for name in ("Next frame with contacts", "Previous frame with contacts", "Frame with most contacts",
                 "Zoom to contacts"):
        button = page.element("button", name)
        if button.is_enabled():
            page.click("button", name)
        expect_equal(page.frame(), 0, f"frame after {name}")
    expect_equal(page.markers(), [], "markers")


def a_single_interval(context):
    made, page = context.material.tetrahedra("single", "--frames", "3:4"), context.page
    page.open(made.page)
    expect(page.status().startswith("Frame 3 of 3 to 4"), page.status())
    page.click("button", "Next frame")
    expect_equal(page.frame(), 4, "frame after a step")
    page.click("button", "Play")
    page.settle()
    expect(3 <= page.frame() <= 4, f"frame {page.frame()} of 3 to 4")


def y_may_point_up(context):
    made, page = context.material.tetrahedra("turned", "--up", "y"), context.page
    page.open(made.page)
    expect_equal(page.state("up"), "y", "axis that points up")
    standing = context.pictures.view()
    page.script("window.cscd.store.set({up: 'z'});")
    changed = context.pictures.difference(standing, context.pictures.view())["all"]
    expect(changed > 500, f"another axis up changes {changed} pixels")


def damaged_pages_say_so(context):
    """A page that was cut, or whose data were changed, says which part cannot be read."""
    made, page = context.material.tetrahedra("damaged"), context.page
    with open(made.page, encoding="utf-8") as file:
        text = file.read()
    begin = text.index('id="cscd-array-frames">') + len('id="cscd-array-frames">')
    damages = {"frames": text[:begin + 30] + "AAAA" + text[begin + 34:],
               "heat": text.replace('id="cscd-array-heat"', 'id="cscd-array-gone"'),
               "cscd-report": text.replace('{"format":1', '{"format":1,,', 1)}
    for part, damaged in damages.items():
        path = made.page.replace(".html", "-damaged.html")
        with open(path, "w", encoding="utf-8") as file:
            file.write(damaged)
        page.open(path, whole=False)
        alerts = [page.of_node(node).text for node in page.nodes("alert")]
        expect(len(alerts) == 1 and part in alerts[0], f"damaged {part}: the page says {alerts}")
        page.forget()


def pages_without_webgl_show_the_rest(context):
    made, page = context.material.tetrahedra("flat"), context.page
    blocked = page.command("Page.addScriptToEvaluateOnNewDocument", source="""
        const getContext = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
          return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...more);
        };""")["identifier"]
    try:
        page.open(made.page)
        notes = [page.of_node(node).text for node in page.nodes("note")]
        expect(any("WebGL" in note for note in notes), f"the page says {notes}")
        expect(page.status().startswith("Frame 0 of 0 to 9"), page.status())
        page.click("button", "Next frame with contacts")
        expect_equal(page.frame(), made.contacts()[0][0], "frame after a jump")
        expect(len(page.table("Intervals")) == 10, "the table of intervals")
        useless = page.script("""return [...document.querySelectorAll('#choices input, #choices select')]
            .filter((one) => !one.disabled || !one.title.includes('WebGL')).map((one) => one.ariaLabel);""")
        expect(not useless, f"without a view {useless} can be chosen, or do not say why not")
    finally:
        page.command("Page.removeScriptToEvaluateOnNewDocument", identifier=blocked)
        page.forget()


def large_recordings_are_thinned_and_say_so(context):
    made, page = context.material.large(), context.page
    page.open(made.page)
    scene = Report(made.page).scene
    expect_equal(scene["triangles"], LARGE_TRIANGLES, "triangles")
    frames = scene["frames"]
    expect(frames == sorted(set(frames)) and (frames[0], frames[-1]) == (scene["first"], scene["last"]), f"{frames}")
    print(f"100,000 triangles: {len(frames)} of {scene['last'] + 1} frames, {len(Report(made.page).page) / 1e6:.1f} MB, "
          f"open after {page.open_ms():.0f} ms")
    if len(frames) <= scene["last"]:
        notes = page.script("return document.querySelector('#notes').innerText;")
        expect("frame" in notes and str(len(frames)) in notes, f"the page does not say that it has {len(frames)} frames"
               f" only, but {notes!r}")
    context.pictures.whole("large")
    page.click("button", "Last frame")
    expect_equal(page.frame(), scene["last"], "last frame")


def long_recordings_stay_small(context):
    """Of many intervals the page has columns: the same numbers, few bytes each, and no more elements of twice as many."""
    page = context.page
    elements, sizes = [], []
    for intervals in (500, 2000, 4000):
        made = context.material.long(intervals)
        page.open(made.page)
        report, summary = Report(made.page), made.summary()
        expect_equal(report.summary(), summary, f"summary of {intervals} intervals in the page")
        shown = page.script("""
            const plain = (row) => row === null || typeof row !== 'object' || Array.isArray(row) ? row : Object.fromEntries(
              [...new Set([...Object.keys(row), ...Object.keys(Object.getPrototypeOf(row))])].map((key) => [key, plain(row[key])]));
            const { intervals, frames } = window.cscd.report.summaries[0].summary;
            return [intervals, frames].map((rows) => rows.map(plain));""")
        expect_equal(shown, [summary["intervals"], summary["frames"]], f"{intervals} intervals as the page reads them")
        expect_equal(len(page.table("Intervals")) > 20, True, "rows of intervals are shown")
        page.click("button", "Last frame")
        expect_equal(page.frame(), intervals, "last frame")
        elements.append(page.script("return document.querySelectorAll('*').length;"))
        sizes.append(len(report.page))
    bytes_each = (sizes[2] - sizes[1]) / 2000
    print(f"long recordings: {bytes_each:.0f} bytes an interval, {elements} elements")
    expect(bytes_each < 150, f"an interval takes {bytes_each:.0f} bytes of the page")
    expect(elements[2] < elements[1] + 100, f"{elements} elements of 500, 2000 and 4000 intervals")


SCENARIOS = (names_are_text, part_of_a_recording_keeps_its_numbers, nothing_touches, a_single_interval,
             y_may_point_up, damaged_pages_say_so, pages_without_webgl_show_the_rest,
             large_recordings_are_thinned_and_say_so, long_recordings_stay_small)
