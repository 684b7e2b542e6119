"""The numbers in the page's tables are those of the summary, digit by digit."""
import json
import os

from charts_scenarios import check_drawn
from controls_scenarios import busiest, open_pawn, state_in_words
from page import CELLS, expect, expect_equal
from report_file import Report

STAGES = (("BVH update", "update_ms"), ("traversal", "traversal_ms"), ("contact", "contact_ms"), ("proof", "proof_ms"),
          ("#PCPs", "pcp"), ("total", "total_ms"), ("check", "check_ms"))
INTERVAL_COLUMNS = {"VF": "vf", "EE": "ee", "#PCPs": "pcp", "tests": "tests"}


def column(header, name):
    """Returns the column whose title begins with `name`; a unit may follow."""
    found = [k for k, title in enumerate(header) if str(title).lower().startswith(name.lower())]
    expect(found, f"no column {name} in {header}")
    return found[0]


def check_timings(rows, total):
    header = rows[0]
    for what in ("mean", "max"):
        row = next((row for row in rows[1:] if any(str(cell).lower().startswith(what) for cell in row[:2])), None)
        expect(row is not None, f"no row {what} in {rows}")
        for title, key in STAGES:
            expect_equal(row[column(header, title)], total[key][what], f"{what} of {title}")
    expect(any("X" in row for row in rows[1:]), "no X where a method has no such stage")


def timings_are_the_summarys(context):
    made, page = open_pawn(context)
    check_timings(page.table("Timings"), made.summary()["summary"])


def check_interval(header, row, interval):
    for title, key in INTERVAL_COLUMNS.items():
        expect_equal(row[column(header, title)], interval[key], f"{title} of interval {interval['frame']}")
    expect_equal(row[column(header, "ms")], interval["ms"]["total"], f"ms of interval {interval['frame']}")
    words = state_in_words(interval)
    expect(words in str(row[column(header, "state")]), f"{row} is not {words}")
    if interval["earliest_toi"] is not None:
        expect_equal(row[column(header, "earliest")], interval["earliest_toi"], "earliest toi")


def shown_intervals(page):
    """Returns the rows that are in the document, by frame; the table brings others when it is scrolled."""
    rows = page.script(CELLS + "return [...arguments[0].tBodies[0].rows].filter((row) => row.dataset.frame !== undefined)"
                       ".map((row) => [Number(row.dataset.frame), [...row.cells].map(contentOf)]);",
                       page.element("table", "Intervals"))
    return {frame: cells for frame, cells in rows}


def scroll_intervals(page, part):
    """Scrolls the box in which the table lies to a part of its height."""
    page.script(
        "let box = arguments[0]; while (box && box.scrollHeight <= box.clientHeight + 1) box = box.parentElement;"
        "if (box) box.scrollTop = arguments[1] * box.scrollHeight;", page.element("table", "Intervals"), part)
    page.settle()


def intervals_are_the_summarys(context):
    made, page = open_pawn(context)
    intervals = {interval["frame"]: interval for interval in made.summary()["intervals"]}
    header = page.table("Intervals")[0]
    seen = {}
    for step in range(21):
        scroll_intervals(page, step / 20)
        seen.update(shown_intervals(page))
    expect_equal(sorted(seen), sorted(intervals), "intervals in the table")
    for frame, row in seen.items():
        check_interval(header, row, intervals[frame])


def intervals_are_filtered_and_lead_to_frames(context):
    made, page = open_pawn(context)
    intervals = made.summary()["intervals"]
    tests = {"With contacts": lambda interval: interval["vf"] + interval["ee"] > 0,
             "Intersecting": lambda interval: interval["state"] == "penetrating"}
    for name, test in tests.items():
        page.click("radio", name)
        expected = [interval["frame"] for interval in intervals if test(interval)]
        seen = shown_intervals(page)
        expect(seen and set(seen) <= set(expected), f"{name}: {sorted(seen)}, of {expected}")
    frame = sorted(seen)[1]
    page.click("button", f"Frame {frame}")
    expect_equal(page.frame(), frame, "frame after a click in the table")


def contact_list_is_the_csvs(context):
    made, page = open_pawn(context)
    interval = busiest(made)
    page.go_to(interval)
    expected = [contact for contact in made.contacts() if contact[0] == interval]
    rows = page.table("Contacts of this interval")[1:]
    expect(min(len(expected), 20) <= len(rows) <= len(expected), f"{len(rows)} rows for {len(expected)} contacts")
    for row, (_, kind, vertices, toi, point) in zip(rows, expected):
        text = " ".join(str(cell) for cell in row)
        expect(kind.upper() in text, f"{row} is not {kind}")
        shown = text.replace("\u202f", "")
        expect(all(str(vertex) in shown for vertex in vertices), f"{row} does not name {vertices}")
        expect(any(cell == toi or shortened(str(cell), toi) for cell in row), f"{row} has no toi of {toi}")
        expect(shortened_all(text, point), f"{row} has no position {point}")
    page.click("button", "Contact 2")
    first = next(k for k, contact in enumerate(made.contacts()) if contact[0] == interval)
    expect_equal(page.state("selected"), first + 1, "selected contact")


def shortened(text, value):
    """True if the text is the number, rounded to the digits that it has."""
    try:
        found = float(text.replace("\u202f", "").replace("\u2212", "-"))
    except ValueError:
        return False
    return abs(found - value) <= 1e-3 * max(1.0, abs(value))


def shortened_all(text, point):
    words = text.replace(",", " ").replace("(", " ").replace(")", " ").split()
    return all(any(shortened(word, value) for word in words) for value in point)


def contact_list_is_filtered(context):
    made, page = open_pawn(context)
    interval = busiest(made)
    page.go_to(interval)
    for name, kind, other in (("VF only", "VF", "EE"), ("EE only", "EE", "VF")):
        page.click("radio", name)
        rows = [" ".join(str(cell) for cell in row) for row in page.table("Contacts of this interval")[1:]]
        expect(rows and all(kind in row and other not in row for row in rows), f"{name}: {rows[:3]}")


def regions_and_provenance_are_told(context):
    made, page = open_pawn(context)
    regions, total = Report(made.page).scene["plan"]["regions"], made.summary()
    rows = page.table("Regions")
    expect_equal(len(rows) - 1, len(regions), "rows of the table of regions")
    for row, region in zip(rows[1:], regions):
        expect(region["triangles"] in row, f"{row} does not have {region['triangles']} triangles")
    text = page.element("region", "Provenance").get_attribute("textContent")
    provenance = total["provenance"]
    for value in (provenance["version"], provenance["commit"], provenance["compiler"], provenance["inputs"][0]["fnv1a64"],
                  provenance["machine"]["processor"]):
        expect(value in text, f"the provenance does not say {value}")
    licences = page.element("region", "Licences").get_attribute("textContent")
    expect(all(word in licences for word in ("three", "uplot", "MIT")), "the licences are not all there")


def comparison_shows_each_summary(context):
    made = context.material.comparison()
    context.page.open(made.page)
    figures = context.page.nodes("figure")
    expect(len(figures) >= 3, f"{len(figures)} charts")
    for node in figures:
        check_drawn(context.page, context.page.of_node(node), node["name"]["value"])
    names = ", ".join(os.path.basename(path) for path in made.summaries)
    titles = context.page.script("return [document.title, document.querySelector('h1').textContent];")
    expect_equal(titles, [f"{names} · cscd report", names], "the titles")
    context.pictures.whole("comparison")
    totals = []
    for path in made.summaries:
        with open(path, encoding="utf-8") as file:
            totals.append(json.load(file)["summary"])
    rows = context.page.table("Timings")
    for total in totals:
        means = [row for row in rows if total["total_ms"]["mean"] in row]
        expect(means and total["pcp"]["mean"] in means[0], f"the means of {total['method']} are not in {rows}")
    text = context.page.script("return document.body.innerText;")
    expect(all(total["method"] in text for total in totals), "a method is not named")


def preprocess_shows_regions(context):
    made = context.material.preprocess()
    page = context.page
    page.open(made.page)
    report = Report(made.page)
    expect_equal((report.document["kind"], report.document["summaries"]), ("preprocess", []), "kind and summaries")
    pictures = {}
    for name in ("Plain", "Charge", "Equalized charge", "Region"):
        page.click("radio", name)
        pictures[name] = context.pictures.view("preprocess-" + name.lower().replace(" ", "-"))
    names = list(pictures)
    for one, other in zip(names, names[1:]):
        expect(context.pictures.difference(pictures[one], pictures[other])["all"] > 1000, f"{one} looks like {other}")
    for name in ("Orientation", "Contact heat"):
        expect(not page.element("radio", name).is_enabled(), f"{name} can be chosen where nothing moves")
    rows = page.table("Regions")
    expect_equal(len(rows) - 1, len(report.scene["plan"]["regions"]), "rows of the table of regions")
    context.pictures.whole("preprocess")


SCENARIOS = (timings_are_the_summarys, intervals_are_the_summarys, intervals_are_filtered_and_lead_to_frames,
             contact_list_is_the_csvs, contact_list_is_filtered, regions_and_provenance_are_told,
             comparison_shows_each_summary, preprocess_shows_regions)
