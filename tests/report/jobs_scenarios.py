"""The page of many jobs: what it lists and in which order, its filters, its links, and names that are no friends of pages."""
import os
import urllib.parse

from selenium.webdriver.common.keys import Keys

from layout_scenarios import CONTRASTS, LEAST_CONTRAST, WIDER
from material import Made
from night_file import job_line, worst_line, write_night
from page import expect, expect_equal

JOBS, MOST_BYTES, MOST_ROWS = 100_000, 20e6, 100
FEW = 300
GRAVE = ("failed", "found", "crossing", "inside", "touching", "duplicate", "missing", "clean")
WORDS = {"failed": "failed", "crossing": "intersections", "inside": "shared space", "touching": "only touching", "duplicate": "only duplicates",
         "missing": "not done", "clean": "clean"}
ODD = "<script>document.title = 'owned'</script><img src=x onerror=\"document.title='owned'\">&amp;'\n\u202e"
ROWS = """
return [...document.querySelectorAll('table.jobs tr.item')].map((row) =>
  Object.fromEntries([...row.cells].map((cell) => [cell.className.split(' ')[0], cell.textContent])));
"""
LISTED = "return document.querySelector('#choices [role=status]').textContent.replaceAll('\\u202f', '');"
# Returns the milliseconds until the rows stand after an action, layout included.
TIMED = """
const start = performance.now();
if (arguments[0] === 'sort') document.querySelector(`th[data-column=${arguments[1]}] button`).click();
else {
  const input = document.querySelector('input[type=search]');
  input.value = arguments[1];
  input.dispatchEvent(new Event('input'));
}
document.body.getBoundingClientRect();
return performance.now() - start;
"""


class Night:
    """The page of made-up results, and their lines."""

    def __init__(self, context, name, count, given=None, code=1, make=job_line):
        made = Made(context.material.folder, name)
        self.path, self.page, self.count = made.base + ".jsonl", made.page, count
        self.lines = write_night(self.path, count, lines=given, make=make)
        self.by_number = {line["job"]: line for line in self.lines}
        run_ending(context, code, "report", self.path, "-o", self.page)


def run_ending(context, code, *arguments):
    """Runs the tool, which ends with this code."""
    try:
        context.material.run("cscd", *arguments)
    except AssertionError as error:
        expect(f"exit {code}:" in str(error), f"not {code}: {error}")
    else:
        expect(code == 0, f"{arguments}: not {code}")


def large(context):
    return context.material.once("night", lambda name: Night(context, name, JOBS))


def few(context):
    """Makes a night of a few jobs with every outcome, three of which are not done."""
    given = {7: None, 8: None, 50: None, 20: {"result": "duplicate"}, 30: {"result": "failed", "error": "/a/b.obj:3: no number"},
             40: {"result": "crossing", "found": True, "depth": 0.5, "frames_crossing": 4, "answer": "Deep."},
             41: {"result": "crossing", "depth": 2.5, "frames_crossing": 1, "answer": "Deeper, but not asked for."},
             60: {"result": "touching", "found": True}}
    return context.material.once("night-few", lambda name: Night(context, name, FEW, given))


def rows(page):
    return page.script(ROWS)


def numbers(page):
    return [int(row["number"]) for row in rows(page)]


def gravity(line):
    key = "found" if line["found"] and line["result"] != "failed" else line["result"]
    return (GRAVE.index(key), -(line["depth"] or 0.0), -(line["frames_crossing"] or 0), -(line["crossing_pairs"] or 0),
            line["job"])


def scroll_to_end(page):
    page.script("const box = document.querySelector('#jobs .scroll'); box.scrollTop = box.scrollHeight;")
    page.settle()


# ---- a hundred thousand


def jobs_page_is_small_and_quick(context):
    page, night = context.page, Night(context, "night-worst", JOBS, make=worst_line, code=3)
    page.open(night.page)
    size, opened = os.path.getsize(night.page), page.open_ms()
    times = {word: page.script(TIMED, "filter", word) for word in ("f", "ferry", "ferryman v004", "no such job", "")}
    times.update({column: page.script(TIMED, "sort", column) for column in ("name", "depth", "pairs", "outcome")})
    print(f"{JOBS} jobs: {size / 1e6:.2f} MB, table after {opened:.0f} ms; "
          + ", ".join(f"{step!r} {ms:.0f} ms" for step, ms in times.items()))
    expect(size < MOST_BYTES, f"{size} bytes")
    expect(0 < opened < 10_000, f"open after {opened} ms")
    expect(max(times.values()) < 3000, f"slow: {times}")
    expect(len(rows(page)) < MOST_ROWS, f"{len(rows(page))} rows in the document")
    expect_equal(page.script(LISTED), f"all {JOBS} jobs", "listed")


def jobs_page_answers_first(context):
    night, page = large(context), context.page
    page.open(night.page)
    sums = {result: sum(line["result"] == result for line in night.lines) for result in WORDS}
    expect_equal(page.script("return document.querySelector('h1').textContent;").replace("\u202f", ""),
                 f"{JOBS} jobs: {sums['clean']} clean, {sums['crossing']} with intersections, {sums['touching']} only touching, "
                 f"{sums['failed']} failed", "the first line")


def jobs_stand_worst_first(context):
    for night in (large(context), few(context)):
        page = context.page
        page.open(night.page)
        missing = [number for number in range(1, night.count + 1) if number not in night.by_number]
        expected = [line["job"] for line in sorted(night.lines, key=gravity)]
        clean = next(i for i, job in enumerate(expected) if night.by_number[job]["result"] == "clean")
        expected[clean:clean] = missing
        shown = numbers(page)
        expect_equal(shown, expected[:len(shown)], "the first jobs")
        scroll_to_end(page)
        shown = numbers(page)
        expect_equal(shown, expected[-len(shown):], "the last jobs")


def expect_sorted(page, night, column, key, descending):
    """key: None for what stands at the end."""
    worst = {line["job"]: place for place, line in enumerate(sorted(night.lines, key=gravity))}
    known = [line for line in night.lines if key(line) is not None]
    known.sort(key=lambda line: worst[line["job"]])
    known.sort(key=key, reverse=descending)
    shown = numbers(page)
    expect_equal(shown, [line["job"] for line in known][:len(shown)], f"jobs by {column}, descending: {descending}")
    state = page.script("return document.querySelector(`th[data-column=${arguments[0]}]`).ariaSort;", column)
    expect_equal(state, "descending" if descending else "ascending", f"aria-sort of {column}")


def jobs_are_sorted_by_columns(context):
    night, page = large(context), context.page
    page.open(night.page)
    keys = {"name": lambda line: line["name"], "crossing_frames": lambda line: line["frames_crossing"],
            "events": lambda line: line["events"], "depth": lambda line: line["depth"],
            "pairs": lambda line: line["crossing_pairs"], "number": lambda line: line["job"]}
    for column, key in keys.items():
        down = column not in ("name", "number")
        for descending in (down, not down):
            page.script(TIMED, "sort", column)
            expect_sorted(page, night, column, key, descending)


# ---- filters


def fitting(night, words, kind=None):
    return [line["job"] for line in night.lines
            if all(word in f"{line['name']}\n{line['error'] or line['answer']}".lower() for word in words)
            and (kind is None or (line["found"] if kind == "found" else line["result"] == kind))]


def jobs_are_filtered(context):
    night, page = large(context), context.page
    page.open(night.page)
    for text in ("FERRYMAN v004", "sq018/sh0120", "deep at frame 1040", "took longer", "no such job at all"):
        page.script(TIMED, "filter", text)
        wanted = fitting(night, text.lower().split())
        expect_equal(page.script(LISTED), f"{len(wanted)} job{'' if len(wanted) == 1 else 's'} of {JOBS}", text)
        expect(set(numbers(page)) <= set(wanted), f"{text}: others are listed, too")
    page.script(TIMED, "filter", "ferryman")
    for kind, label in (("failed", "failed"), ("found", "fail by the rules"), ("crossing", "intersections")):
        total = len(fitting(night, [], kind))
        page.click("radio", f"{label} {total}")
        wanted = fitting(night, ["ferryman"], kind)
        expect_equal(page.script(LISTED), f"{len(wanted)} job{'' if len(wanted) == 1 else 's'} of {JOBS}", label)
        expect(set(numbers(page)) <= set(wanted), f"{label}: others are listed, too")


# ---- what is missing


def jobs_that_are_not_done_are_named(context):
    night, page = few(context), context.page
    page.open(night.page)
    expect(page.script("return document.querySelector('h1').textContent;").endswith(", 3 not done"), "the first line")
    note = page.script("return document.querySelector('.note.warn').textContent;")
    expect(note.startswith("3 jobs are not done: 7 to 8, 50. "), note)
    page.click("radio", "not done 3")
    found = rows(page)
    expect_equal([(row["name"], row["outcome"], row["depth"]) for row in found],
                 [(f"job {number}", "not done", "") for number in (7, 8, 50)], "jobs that are not done")
    context.pictures.whole("jobs-not-done")


# ---- links and names


def jobs_link_to_their_reports(context):
    page, folder = context.page, context.material.folder
    os.makedirs(os.path.join(folder, "odd"), exist_ok=True)
    name = "odd/a #1?%41 <b>:.html"
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write("<!doctype html><title>the single report</title>")
    crossing = {"result": "crossing", "depth": 9.0}
    night = Night(context, "night-links", 4, code=0,
                  given={1: {"report": os.path.join(folder, name), **crossing}, 2: {"report": "javascript:document.title='owned'"},
                         3: {"report": "lost-\ufffd.html"}, 4: {"report": None, "name": "a"}})
    page.open(night.page)
    hrefs = page.script("return Object.fromEntries([...document.querySelectorAll('tr.item')].map((row) => "
                        "[row.id, row.querySelector('a').getAttribute('href')]));")
    expect_equal(hrefs["job-1"], urllib.parse.quote(name, safe="/!*'()"), "the link of job 1")
    expect_equal((hrefs["job-3"], hrefs["job-4"]), (None, None), "jobs without a link")
    resolved = page.script("return document.querySelector('#job-2 a').href;")
    expect(resolved.startswith("file:///"), f"the link of job 2 leads to {resolved}")
    page.check_quiet()
    page.script("document.querySelector('#job-1 a').click();")
    page.wait(lambda: page.driver.title == "the single report", "the single report opens")
    page.forget()


def odd_names_are_only_text(context):
    page = context.page
    night = Night(context, "night-odd", 3,
                  given={1: {"name": ODD, "result": "failed", "error": ODD}, 2: {"name": "\ufeff\ufffd \u0001"}})
    with open(night.path, "rb") as file:
        text = file.read().replace("\ufffd".encode(), b"\xff\xc0")
    with open(night.path, "wb") as file:
        file.write(text)
    run_ending(context, 1, "report", night.path, "-o", night.page, "--title", ODD)
    page.open(night.page)
    expect_equal(page.driver.title, " ".join(ODD.split()) + " · cscd report", "title")
    found = {int(row["number"]): row for row in rows(page)}
    expect_equal(found[1]["name"], ODD, "name of job 1")
    expect_equal(found[1]["answer"], ODD, "reason of job 1")
    expect_equal(found[2]["name"], "\ufeff\ufffd\ufffd \u0001", "name of job 2")
    expect_equal(page.script("return document.querySelectorAll('img, #jobs script').length;"), 0, "elements made of names")
    page.script("document.querySelector('#job-1').click();")
    expect_equal(page.script("return document.querySelector('#details h2').textContent;"), ODD, "name in the details")


# ---- keys and looks


def jobs_page_works_by_keys(context):
    night, page = few(context), context.page
    page.open(night.page)
    page.press("/")
    page.press(*"deep")
    expect_equal(page.script("return document.activeElement.value;"), "deep", "the filter has the focus")
    page.press(Keys.ENTER, Keys.ARROW_DOWN)
    order = numbers(page)
    expect_equal(order[:2], [40, 41], "the deepest that fails first, then the deeper one that does not")
    expect_equal(page.state("selected"), 39, "the selected job")
    page.press(Keys.ARROW_DOWN)
    expect_equal(page.script("return document.querySelector('#details .answer').textContent;"), "Deeper, but not asked for.",
                 "the answer in the details")
    expect_equal(page.script("return document.querySelector('table.jobs').getAttribute('aria-activedescendant');"), "job-41",
                 "the row for screen readers")
    page.press("/", Keys.ESCAPE)
    expect_equal(page.script(LISTED), f"all {FEW} jobs", "listed after Escape")
    page.press(Keys.ENTER, Keys.END)
    lowest, bottom = page.script(
        "return [document.querySelector('tr[aria-selected=true]').getBoundingClientRect().bottom, "
        "document.querySelector('#jobs .scroll').getBoundingClientRect().bottom];")
    expect(lowest <= bottom + 1, f"the last row ends at {lowest}, below the table at {bottom}")
    page.leave_controls()
    theme = page.state("theme")
    page.press("l")
    expect(page.state("theme") != theme, "L changes the theme")


def jobs_page_looks_right_in_both_themes(context):
    night, page = few(context), context.page
    parts = ["h1", "#status", ".note.warn", "td.name", "td.answer", "th > button", "span.outcome.failed > span",
             "#choices [role=status]", ".segments label:last-child span", "#details .quiet"]
    for theme in ("light", "dark"):
        page.open(night.page, theme=theme)
        page.script("document.querySelector('tr.item:nth-child(2)').click();")
        page.settle()
        context.pictures.whole(f"jobs-{theme}")
        poor = [found for found in page.script(CONTRASTS, parts) if found[1] is None or found[1] < LEAST_CONTRAST]
        expect(not poor, f"{theme}: contrast of {poor}")
    for width in (380, 360):
        page.open(night.page, width=width, height=800)
        found = page.script(WIDER)
        expect(found["page"] <= found["wide"], f"{width} pixels wide: scrolls to {found}")
        context.pictures.whole("narrow-jobs")


SCENARIOS = (jobs_page_is_small_and_quick, jobs_page_answers_first, jobs_stand_worst_first, jobs_are_sorted_by_columns,
             jobs_are_filtered, jobs_that_are_not_done_are_named, jobs_link_to_their_reports, odd_names_are_only_text,
             jobs_page_works_by_keys, jobs_page_looks_right_in_both_themes)
