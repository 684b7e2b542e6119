#!/usr/bin/env python3
"""Compares the product with the data to develop against: every sequence, two pairs of simulation frames, query sets.

usage: CSCD_TOOL=path/to/cscd CSCD_QUERIES=path/to/benchmarks/queries check_recordings.py DATA

Each sequence has a JSON file by independent programs: `static_pairs` per frame (properly crossing triangle pairs) and
`ccd_hits` per interval (feature pairs that come within 1e-7 of the diagonal: an upper estimate of the contacts).
"""
import glob
import json
import os
import subprocess
import sys
import tempfile

CHUNK = 32  # intervals, with each of which a new detector of the tool begins

# Exact truth (rational arithmetic) of one interval each.
FRAME_PAIRS = [("cloth_ball92.ply", "cloth_ball93.ply", 19032, 94822),
               ("cloth_funnel227.ply", "cloth_funnel228.ply", 27, 107)]


def replay(tool, model, frames, *options):
    """The JSON summary of a replay."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "summary.json")
        command = [tool, "replay", model, *frames, "--json", path, "--quiet", "--threads", "0", *options]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}: exit {done.returncode}: {done.stderr.strip()}")
        with open(path, encoding="utf-8") as file:
            return json.load(file)


def ranges(numbers):
    """[3, 4, 5, 9] as '3-5 9'."""
    spans = []
    for n in numbers:
        if spans and spans[-1][1] == n - 1:
            spans[-1][1] = n
        else:
            spans.append([n, n])
    return " ".join(f"{a}-{b}" if b > a else str(a) for a, b in spans) or "none"


def compare_sequence(summary, truth):
    """The violations, and the intervals that come near without touching."""
    static, hits = truth["static_pairs"], truth["ccd_hits"]
    crossing = [frame["crossing"] for frame in summary["frames"]]
    found = [interval["vf"] + interval["ee"] > 0 for interval in summary["intervals"]]
    if len(crossing) != len(static) or len(found) != len(hits):
        return [f"{len(crossing)} frames, {len(found)} intervals; expected {len(static)}, {len(hits)}"], []
    wrong = [k for k in range(len(static)) if crossing[k] != (static[k] > 0)]
    invented = [k for k in range(len(hits)) if found[k] and hits[k] == 0]
    missed = [k for k in range(len(hits)) if static[k] == 0 and static[k + 1] > 0 and not found[k]]
    clean = [k for k, interval in enumerate(summary["intervals"]) if interval["state"] == "clean" and crossing[k + 1]]
    violations = [f"{what} {ranges(frames)}" for what, frames in
                  (("static check differs at frames", wrong), ("contact where nothing comes near, intervals", invented),
                   ("no contact although a crossing begins, intervals", missed),
                   ("called clean although they end crossing, intervals", clean)) if frames]
    return violations, [k for k in range(len(hits)) if hits[k] > 0 and not found[k]]


def check_sequence(tool, path):
    with open(path, encoding="utf-8") as file:
        truth = json.load(file)
    base = path[:-len(".json")]
    summary = replay(tool, base + ".obj", [base + ".pc2"])
    violations, near = compare_sequence(summary, truth)
    crossing = sum(frame["crossing"] for frame in summary["frames"])
    expected = sum(pairs > 0 for pairs in truth["static_pairs"])
    total = summary["summary"]
    print(f"{os.path.basename(base):<17} {len(summary['frames']):>6} {crossing:>8} {expected:>8} "
          f"{total['vf']:>7} {total['ee']:>7} {total['total_ms']['mean']:>8.2f}  {'; '.join(violations) or 'agrees'}")
    if near:
        at = ", ".join(f"{k} ({truth['ccd_hits'][k]} near pairs)" for k in near)
        print(f"    near, within 1e-7 of the diagonal, but exactly no contact: intervals {at}")
    return not violations


def check_pair(tool, folder, first, second, vf, ee):
    first_path = os.path.join(folder, first)
    summary = replay(tool, first_path, [first_path, os.path.join(folder, second)])["summary"]
    good = summary["vf"] == vf and summary["ee"] == ee
    print(f"{first:<20} VF {summary['vf']:>6} of {vf:>6}   EE {summary['ee']:>6} of {ee:>6}   "
          f"{'exact' if good else 'DIFFERS'}")
    return good


def check_culling(tool, path):
    """A recording without contact: culling leaves a quarter of the triangle pairs at most, for one static check per chunk."""
    sums = {}
    for method in ("none", "single"):
        intervals = replay(tool, path + ".obj", [path + ".pc2"], "--method", method, "--mode", "earliest", "--no-check")["intervals"]
        sums[method] = sum(interval["pcp"] for interval in intervals)
        checks = sum(interval["static_checks"] for interval in intervals)
    chunks = -(-len(intervals) // CHUNK)
    good = 4 * sums["single"] <= sums["none"] and checks == chunks
    print(f"{os.path.basename(path)}: culling leaves {100 * sums['single'] / sums['none']:.1f} % of {sums['none']} pairs, "
          f"{checks} static checks   {'agrees' if good else f'VIOLATES: a quarter at most, {chunks} checks'}")
    return good


def check_iccd(tool, path, share):
    """Normal cones and contours leave this share of the triangle pairs at most, and every contact, in every interval."""
    none, iccd = (replay(tool, path + ".obj", [path + ".pc2"], "--method", method, "--no-check")["intervals"]
                  for method in ("none", "iccd"))
    pairs = [sum(interval["pcp"] for interval in intervals) for intervals in (none, iccd)]
    differing = [k for k in range(len(none)) for key in ("vf", "ee", "earliest_toi") if none[k][key] != iccd[k][key]]
    good = pairs[1] <= share * pairs[0] and not differing
    print(f"{os.path.basename(path)}: iccd leaves {100 * pairs[1] / pairs[0]:.1f} % of {pairs[0]} pairs, at most "
          f"{100 * share:.0f}; contacts differ from none's in intervals {ranges(sorted(set(differing)))}   "
          f"{'agrees' if good else 'VIOLATES'}")
    return good


def check_queries(program, folder):
    """Every query set: the verdicts must be the truth."""
    files = sorted(glob.glob(os.path.join(folder, "*.csv")))
    done = subprocess.run([program, "--json", *files], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{program}: exit {done.returncode}: {done.stderr.strip()}")
    total = json.loads(done.stdout)["total"]
    good = total["fp"] == 0 and total["fn"] == 0
    print(f"{len(files)} query sets: {total['queries']} queries, {total['fp']} false positives, "
          f"{total['fn']} false negatives, decided by level {total['levels']}   {'exact' if good else 'DIFFERS'}")
    return good


def main():
    data, tool = sys.argv[1], os.environ["CSCD_TOOL"]
    sequences = sorted(glob.glob(os.path.join(data, "sequences", "*.json")))
    if not sequences:
        print(f"{data}: no sequences")
        return 1
    print(f"{'sequence':<17} {'frames':>6} {'crossing':>8} {'expected':>8} {'VF':>7} {'EE':>7} {'ms/frame':>8}")
    good = [check_sequence(tool, path) for path in sequences]
    good += [check_pair(tool, os.path.join(data, "frames"), *pair) for pair in FRAME_PAIRS]
    good.append(check_culling(tool, os.path.join(data, "sequences", "elephant_free")))
    for name in ("elephant_free", "hand_fist"):
        good.append(check_iccd(tool, os.path.join(data, "sequences", name), 0.6))
    good.append(check_queries(os.environ["CSCD_QUERIES"], os.path.join(data, "queries")))
    print(f"{sum(good)} of {len(good)} comparisons agree")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
