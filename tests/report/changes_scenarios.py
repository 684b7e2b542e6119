"""The comparison of two runs begins with what changed, event by event: new, still there, fixed."""
import json
import os

from page import expect, expect_equal


def whats(context, *others, **arguments):
    """Opens the comparison; returns the rows of its table: change, parts, frames before and after, depths."""
    context.page.open(context.material.limbs_compared(*others).page, **arguments)
    return [row for row in context.page.table("Events of limbs-before.json and " + os.path.basename(others[0]))[1:]]


def sentence(context):
    return context.page.script("return document.querySelector('.change-sentence').textContent;")


def events_of(made):
    return {event["b"] if event["a"] == "Body" else event["a"]: event for event in made.summary()["events"]}


def a_comparison_says_what_is_fixed_new_and_still_there(context):
    before, after = context.material.limbs("before"), context.material.limbs("after")
    rows = whats(context, after.json, width=1280, height=900)
    mine, other = events_of(before), events_of(after)
    expect_equal((sorted(mine), sorted(other)), (["Arm", "Leg"], ["Eye", "Leg"]), "events by the limb that they are of")
    expect_equal([row[0] for row in rows], ["new", "still there, deeper", "fixed"], "what became of each event")
    for row, name in zip(rows, ("Eye", "Leg", "Arm")):
        expect(name in row[1] and "Body" in row[1], f"{row} is not of Body and {name}")
        found = [events.get(name) for events in (mine, other)]
        expect_equal(row[2:4], ["–" if one is None else f"{one['first']} to {one['last']}" for one in found], f"frames of {name}")
        expect_equal(row[4:6], ["–" if one is None else one["depth"] for one in found], f"depths of {name}")
    expect(mine["Leg"]["depth"] > 0.1, "the limbs are deep in the body")
    expect_equal(sentence(context), "From limbs-before.json to limbs-after.json, 1 event is fixed, 1 is new and 1 is still "
                 "there (1 deeper).", "the sentence")
    first = context.page.script("return document.querySelector('#main section:not([hidden])').id;")
    expect_equal(first, "changes", "the first thing on the page")
    context.pictures.whole("changes")
    context.page.click("radio", "Fixed 1")
    shown = context.page.script("return [...document.querySelectorAll('.changes tbody tr:not([hidden])')].length;")
    expect_equal(shown, 1, "rows after the choice of what is fixed")


def a_run_that_ended_early_fixes_nothing(context):
    """What a run did not look at is not fixed."""
    after = context.material.limbs("after")
    short = os.path.join(context.material.folder, "limbs-short.json")
    context.material.run("cscd", "replay", after.model, after.frames, "--frames", "0:4", "--json", short, "--quiet")
    rows = whats(context, short)
    expect_equal([row[0] for row in rows], ["not known", "not known"], "events that end after the last frame")
    with open(short, encoding="utf-8") as file:
        text = json.load(file)
    for frame in range(5, 10):
        text["frames"].append({"frame": frame, "crossing": False})
    with open(short, "w", encoding="utf-8") as file:
        json.dump(text, file)
    expect_equal([row[0] for row in whats(context, short)], ["fixed", "fixed"], "events where all frames were looked at")


def event(place, first, last, parts=("Body", "Arm"), depth=0.5):
    return {"a": parts[0], "b": parts[1], "first": first, "last": last, "worst": first, "kinds": ["crossing"], "pairs": 4,
            "contacts": 0, "depth": depth, "length": 1.0, "point": place, "triangle": 0, "face": 0, "object": None}


def written(context, name, source, events):
    text = source.summary()
    if events is None:
        del text["events"]
    else:
        text["events"] = events
    path = os.path.join(context.material.folder, name)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(text, file)
    return path


def events_match_by_parts_frames_and_places(context):
    """Two places stay two; parts are the same in either order; what pauses has a partner before and after the pause."""
    source = context.material.limbs("before")
    here, there = [0.0, 0.0, 0.0], [10.0, 0.0, 0.0]
    cases = (
        ([event(here, 0, 5), event(there, 0, 5, depth=0.7)], [event([9.0, 0.0, 0.0], 2, 7)], ["still there, less deep", "fixed"]),
        ([event(there, 0, 5, depth=0.7), event(here, 0, 5)], [event([1.0, 0.0, 0.0], 2, 7)], ["still there", "fixed"]),
        ([event(here, 0, 5)], [event(here, 0, 5, ("Arm", "Body"))], ["still there"]),
        ([event(here, 0, 5)], [event(here, 0, 5, ("Leg", "Body"))], ["new", "fixed"]),
        ([event(here, 0, 2)], [event(here, 3, 5)], ["new", "fixed"]),
        ([event(here, 0, 8)], [event(here, 0, 2), event(there, 5, 8)], ["still there"]),
        ([event(None, 0, 2)], [event(here, 1, 4)], ["still there"]),
        ([event(here, 0, 2)], [event(here, 0, 2, depth=0.1)], ["still there, less deep"]),
    )
    for before, after, expected in cases:
        paths = [written(context, f"{name}.json", source, events) for name, events in (("one", before), ("two", after))]
        made = os.path.join(context.material.folder, "matched.html")
        context.material.run("cscd", "report", *paths, "-o", made)
        context.page.open(made)
        rows = context.page.table("Events of one.json and two.json")[1:]
        expect_equal([row[0] for row in rows], expected, f"{before} and {after}")


def a_summary_without_events_is_of_an_older_version(context):
    source = context.material.limbs("before")
    old = written(context, "old.json", source, None)
    context.page.open(context.material.limbs_compared(old).page)
    text = context.page.script("return document.getElementById('changes').innerText;")
    expect("old.json has no list of events" in text and "older version" in text, text)
    expect(context.page.has("table", "Comparison"), "the rest of the comparison is there")


def runs_without_events_agree(context):
    source = context.material.limbs("before")
    paths = [written(context, name, source, []) for name in ("clean.json", "tidy.json")]
    made = os.path.join(context.material.folder, "clean.html")
    context.material.run("cscd", "report", *paths, "-o", made)
    context.page.open(made)
    expect_equal(sentence(context), "Neither clean.json nor tidy.json has an event: nothing meets or intersects.", "sentence")


def many_runs_are_each_compared_with_the_first(context):
    """A sentence for each; their tables are folded."""
    source = context.material.limbs("before")
    there = event([0.0, 0.0, 0.0], 0, 5)
    paths = [written(context, f"{name}.json", source, events) for name, events in (("one", [there]), ("two", []),
                                                                                 ("three", [there, there]))]
    made = os.path.join(context.material.folder, "many.html")
    context.material.run("cscd", "report", *paths, "-o", made)
    context.page.open(made)
    said = context.page.script("return [...document.querySelectorAll('.change-sentence')].map((one) => one.textContent);")
    expect_equal(said, ["From one.json to two.json, 1 event is fixed, none is new and none is still there.",
                        "From one.json to three.json, no events are fixed, 1 is new and 1 is still there."], "the sentences")
    expect(not context.page.has("table", "Events of one.json and three.json"), "a table of many runs is unfolded")
    context.page.script("document.querySelectorAll('#changes details')[1].open = true;")
    rows = context.page.table("Events of one.json and three.json")[1:]
    expect_equal([row[0] for row in rows], ["new", "still there"], "the table of the third run")


SCENARIOS = (a_comparison_says_what_is_fixed_new_and_still_there, a_run_that_ended_early_fixes_nothing,
             events_match_by_parts_frames_and_places, a_summary_without_events_is_of_an_older_version,
             runs_without_events_agree, many_runs_are_each_compared_with_the_first)
