"""A report contains the data of its recording, and of what the same run wrote elsewhere."""
import os

import recording_file
from material import RECORDINGS
from page import expect, expect_equal
from report_file import Report

LARGEST_PAGE = 8 << 20
LARGEST_RELATIVE_ERROR = 1e-4


def longest_side(axes):
    return max(max(axis) - min(axis) for axis in axes)


def largest_distance(shown, true):
    return max(abs(a - b) for s, t in zip(shown, true) for a, b in zip(s, t))


def check_positions(report, made):
    """Every position that is shown is within the error that the report states, which is small, and no larger than needed."""
    scene = report.scene
    true = list(recording_file.read_pc2(made.frames))
    shown = report.frames()
    expect_equal(len(shown), len(scene["frames"]), f"{made.name}: frames in the page")
    expect_equal(scene["frames"], list(range(len(true))), f"{made.name}: numbers of the frames")
    error = relative = 0.0
    for frame, axes in zip(scene["frames"], shown):
        distance = largest_distance(axes, true[frame])
        error = max(error, distance)
        relative = max(relative, distance / longest_side(true[frame]))
    print(f"{made.name}: largest error {error:.3g}, {relative:.3g} of the box")
    expect(relative < LARGEST_RELATIVE_ERROR, f"{made.name}: off by {relative} of the box")
    for what, found in (("max_error", error), ("relative_error", relative)):
        expect(found <= scene[what] * (1 + 1e-9), f"{made.name}: {what} is {found}, not {scene[what]}")
        expect(scene[what] <= 1.001 * found, f"{made.name}: {what} is stated as {scene[what]}, and is {found}")


def positions_are_those_of_the_recording(context):
    for name in RECORDINGS:
        made = context.material.replay(name)
        check_positions(Report(made.page), made)


def check_mesh(report, made):
    positions, triangles = recording_file.read_obj(made.model)
    scene = report.scene
    expect_equal((scene["vertices"], scene["triangles"]), (len(positions), len(triangles)), f"{made.name}: mesh")
    corners = [corner for triangle in triangles for corner in triangle]
    expect_equal(report.arrays["triangles"].tolist(), corners, f"{made.name}: triangles")


def contacts_are_those_of_the_csv(context):
    for name in RECORDINGS:
        made = context.material.replay(name)
        report, contacts = Report(made.page), made.contacts()
        check_mesh(report, made)
        expect(len(contacts) > 100, f"{made.name}: {len(contacts)} contacts in the CSV")
        expect_equal(len(report.contacts()), len(contacts), f"{made.name}: contacts")
        for found, expected in zip(report.contacts(), contacts):
            expect_equal(found, expected, f"{made.name}: contact")
        stated = report.scene["contacts"]
        expect_equal((stated["found"], stated["kept"]), (len(contacts), len(contacts)), f"{made.name}: counts")


def summary_is_that_of_the_run(context):
    for name in RECORDINGS:
        made = context.material.replay(name)
        document = Report(made.page).document
        expect_equal(len(document["summaries"]), 1, f"{made.name}: summaries")
        expect_equal(document["summaries"][0]["summary"], made.summary(), f"{made.name}: summary")
        expect_equal((document["format"], document["kind"], document["title"]), (1, "replay", made.name), "document")
        intervals = made.summary()["intervals"]
        expect_equal((document["scene"]["first"], document["scene"]["last"]),
                     (intervals[0]["frame"], intervals[-1]["frame"] + 1), f"{made.name}: first and last frame")


def heat_is_what_the_contacts_add_up_to(context):
    for name in RECORDINGS:
        made = context.material.replay(name)
        triangles = recording_file.read_obj(made.model)[1]
        expected = recording_file.heat(triangles, made.contacts())
        expect_equal(Report(made.page).arrays["heat"].tolist(), expected, f"{made.name}: contacts per triangle")


def orientations_count_as_in_the_summary(context):
    made = context.material.replay("pawn-drop")
    report = Report(made.page)
    intervals = {interval["frame"]: interval for interval in made.summary()["intervals"]}
    seen = 0
    for interval, orientation in report.orientations():
        found = (orientation.count(1), orientation.count(2))
        expected = (intervals[interval]["plus"], intervals[interval]["minus"])
        expect_equal(found, expected, f"{made.name}: S+ and S- of interval {interval}")
        expect(3 not in orientation, "an orientation of 3")
        seen += 1
    expect_equal(seen, len(intervals), "intervals with orientations")


def check_ranks(charge, equalized):
    """0 is the least charge, 1 the most, in order. Charges that float32 rounds to one number may differ in rank."""
    order = sorted(range(len(charge)), key=lambda t: charge[t])
    for t, next_one in zip(order, order[1:]):
        expect(equalized[t] < equalized[next_one] or charge[t] == charge[next_one],
               f"ranks {equalized[t]} and {equalized[next_one]} of charges {charge[t]} and {charge[next_one]}")
    expect_equal((min(equalized), max(equalized)), (0.0, 1.0), "least and largest rank")


def regions_and_charges_fit_the_plan(context):
    """The plan in the page is the one that the summary names, and the points move with the body."""
    made = context.material.replay("pawn-drop")
    report = Report(made.page)
    arrays, regions = report.arrays, report.scene["plan"]["regions"]
    expect_equal(len(regions), made.summary()["summary"]["plan"]["regions"], "regions")
    for k, region in enumerate(regions):
        expect_equal(arrays["region"].tolist().count(k), region["triangles"], f"triangles of region {k}")
        expect(0 < region["visible_share"] <= 1 and region["area"] > 0, f"region {k}: {region}")
    expect(max(arrays["region"]) == len(regions) - 1, "a region without triangles or beyond the last")
    check_ranks(arrays["charge"], arrays["equalized"])
    points, intervals = arrays["detector_points"], report.scene["last"] - report.scene["first"]
    expect_equal(len(points), 6 * len(regions) * intervals, "numbers of detector points")
    for frame, axes in ((0, report.frames()[0]), (intervals - 1, report.frames()[intervals - 1])):
        for k in range(len(regions)):
            point = points[6 * (frame * len(regions) + k):][:3]
            inside = all(min(axis) < value < max(axis) for axis, value in zip(axes, point))
            expect(inside, f"the point of region {k} is at {point.tolist()} in frame {frame}, outside of the body's box")


def pages_are_small(context):
    for name in RECORDINGS:
        made = context.material.replay(name)
        size, report = os.path.getsize(made.page), Report(made.page)
        parts = ", ".join(f"{array} {bytes_ >> 10}" for array, bytes_ in
                          sorted(report.packed_sizes.items(), key=lambda item: -item[1])[:4])
        print(f"{made.name}: page of {size / (1 << 20):.2f} MiB; KiB of {parts}")
        expect(size < LARGEST_PAGE, f"{made.name}: {size} bytes")


SCENARIOS = (positions_are_those_of_the_recording, contacts_are_those_of_the_csv, summary_is_that_of_the_run,
             heat_is_what_the_contacts_add_up_to, orientations_count_as_in_the_summary,
             regions_and_charges_fit_the_plan, pages_are_small)
