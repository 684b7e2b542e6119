#!/usr/bin/env python3
"""Plans by method auto compared with one region for each component: prints a table for docs/about/measurements.md. Linux.

Usage: python3 benchmarks/auto_plans.py [--rounds N] CSCD MODEL.obj...

The recording of each model is MODEL.pc2 in the same folder. For each model `preprocess --method auto` makes a plan for the rest
and one for the
frames, and `replay` runs with them and with one region, by turns: once so that every interval is culled, and once so that each
component is culled where that pays, with lists of pairs. The table has the mean milliseconds of an interval with one region,
the least of all rounds, and how many times as fast the plans are. Its last column is the price of the plan for the rest: the time
that it takes over that of an interval of the whole command, which reads the frames and checks them.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import time

COLUMNS = ["rest", "motion", "rest, with lists", "motion, with lists"]


def run(*arguments):
    """Runs the tool, and returns what it printed."""
    done = subprocess.run(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout


def make_plans(tool, model, frames, folder):
    """Returns the method that auto has kept, the path of the plan, and its seconds: for one region, the rest and the motion."""
    plans = []
    for name, inputs, method in (("single", [model], "single"), ("rest", [model], "auto"), ("motion", [model, frames], "auto")):
        path = os.path.join(folder, name + ".plan.ply")
        printed = run(tool, "preprocess", *inputs, "--method", method, "-o", path)
        kept = [line.split()[0].split(":")[0] for line in printed.splitlines() if line.endswith("   kept")]
        seconds = [float(line.split()[-1]) for line in printed.splitlines() if line.startswith("seconds: ")]
        plans.append((kept[0] if kept else "single", path, seconds[0]))
    return plans


def measure(tool, model, frames, plans, rounds, folder):
    """Returns the milliseconds of an interval: of each plan where every interval is culled, then of each with lists."""
    least = [math.inf] * (2 * len(plans))
    summary = os.path.join(folder, "summary.json")
    for _ in range(rounds):
        for i in range(2 * len(plans)):
            method, plan, _ = plans[i % len(plans)]
            forced = ["--method", method] if i < len(plans) else []
            run(tool, "replay", model, frames, "--plan", plan, *forced, "--no-check", "--threads", "1", "--json", summary)
            with open(summary, encoding="utf-8") as file:
                least[i] = min(least[i], json.load(file)["summary"]["total_ms"]["mean"])
    return least


def price(tool, model, frames, plan, folder):
    """Returns in how many intervals of a replay the plan is made."""
    summary = os.path.join(folder, "summary.json")
    start = time.monotonic()
    run(tool, "replay", model, frames, "--plan", plan[1], "--threads", "1", "--json", summary)
    seconds = time.monotonic() - start
    with open(summary, encoding="utf-8") as file:
        return plan[2] / seconds * json.load(file)["summary"]["intervals"]


def main():
    """Prints a row for each recording, and the geometric means."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5, metavar="N", help="how often everything is measured (default: 5)")
    parser.add_argument("tool", metavar="CSCD")
    parser.add_argument("models", metavar="MODEL.obj", nargs="+")
    given = parser.parse_args()
    print("| recording | kept: rest, motion | one region | " + " | ".join(COLUMNS) + " | price, intervals |")
    print("| --- " * (4 + len(COLUMNS)) + "|")
    gains = []
    for model in given.models:
        frames = os.path.splitext(model)[0] + ".pc2"
        with tempfile.TemporaryDirectory() as folder:
            plans = make_plans(given.tool, model, frames, folder)
            single, rest, motion, single_lists, rest_lists, motion_lists = \
                measure(given.tool, model, frames, plans, given.rounds, folder)
            intervals = min(price(given.tool, model, frames, plans[1], folder) for _ in range(given.rounds))
        gains.append([single / rest, single / motion, single_lists / rest_lists, single_lists / motion_lists])
        print(f"| {os.path.splitext(os.path.basename(model))[0]} | {plans[1][0]}, {plans[2][0]} | {single:.3f} ms | "
              + " | ".join(f"{gain:.2f}" for gain in gains[-1]) + f" | {intervals:.0f} |", flush=True)
    means = [math.exp(sum(math.log(row[i]) for row in gains) / len(gains)) for i in range(len(COLUMNS))]
    print("| geometric mean | | | " + " | ".join(f"{mean:.2f}" for mean in means) + " | |")


if __name__ == "__main__":
    main()
