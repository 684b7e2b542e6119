#!/usr/bin/python3
"""Compares our pairs of triangles with those of other programs, one by one.

usage: compare.py [--build FOLDER] [--work FOLDER] [--data FOLDER] [--repeats N] [--limit SECONDS] [--quick]

The same files go to all programs. A pair that one of them lists and we do not, or the reverse, is judged in integers
(exact_pair.py): either a program's definition explains it, or somebody is wrong. Ends with 1 if we are.
--build: where the programs are built (default build/release); --work: for meshes and answers (default build/referee);
--data: with cloth_ball92.ply and so on (default: frames/ in CSCD_DATA, if that is set); --repeats: runs of a program on a
large mesh, of which the one with the least processor time counts (default 3); --limit: seconds of a run at most (default
300); --quick: no mesh of a million.
Prints the tables of docs/about/referee.md.
"""

import argparse
import collections
import os
import random
import subprocess
import sys

from exact_pair import CASES, case_of
from programs import TIMER, Failed, all_programs, ours
from small_meshes import meshes

SCENES = [("figure", 20000, "a figure whose legs cross"), ("knot", 20000, "a knot in itself"),
          ("spheres", 27000, "27 balls, each in its neighbours"), ("clean", 100000, "a torus without a pair"),
          ("scan", 100000, "a scan with spikes"), ("scan", 1000000, "a scan with spikes")]
FRAMES = ["cloth_funnel227", "cloth_funnel228", "cloth_ball92", "cloth_ball93"]
JUDGED_KINDS = 300  # of the pairs that all agree on, so many are judged, too
OUR_KINDS = {"crossing": "crossing", "area": "coplanar", "duplicate": "duplicate"}


class Mesh:
    def __init__(self, name, path):
        self.name, self.path = name, path
        with open(path, encoding="utf-8") as file:
            lines = file.read().splitlines()
        vertex_count, triangle_count = (int(word) for word in lines[1].split()[:2])
        self.vertices = [tuple(float(word) for word in line.split()) for line in lines[2:2 + vertex_count]]
        faces = lines[2 + vertex_count:2 + vertex_count + triangle_count]
        self.triangles = [tuple(int(word) for word in line.split()[1:]) for line in faces]

    def diagonal(self):
        lows, highs = ([pick(v[k] for v in self.vertices) for k in range(3)] for pick in (min, max))
        return sum((h - l) ** 2 for l, h in zip(lows, highs)) ** 0.5

    def case(self, a, b):
        return case_of(self.triangles[a], self.triangles[b], self.vertices)

    def box(self, t):
        corners = [self.vertices[v] for v in self.triangles[t]]
        return [(min(c[k] for c in corners), max(c[k] for c in corners)) for k in range(3)]

    def met_by(self, t):
        """All triangles that meet this one, by trying each."""
        box = self.box(t)
        near = [s for s in range(len(self.triangles)) if s != t and
                all(l <= box[k][1] and box[k][0] <= h for k, (l, h) in enumerate(self.box(s)))]
        return [s for s in near if self.case(s, t) != "apart"]


def write_off(path, vertices, triangles):
    with open(path, "w", encoding="utf-8") as out:
        out.write(f"OFF\n{len(vertices)} {len(triangles)} 0\n")
        out.writelines("%.17g %.17g %.17g\n" % tuple(v) for v in vertices)
        out.writelines("3 %d %d %d\n" % t for t in triangles)


# ---- verdicts


class Verdict:
    """The places where a program differs from us. explained: reason -> how many; wrong: whose -> [(what, triangles)]."""

    def __init__(self):
        self.explained = collections.Counter()
        self.theirs, self.ours = [], []


def judge_missing_pair(mesh, program, pair, out):
    """We list it, they do not."""
    case = mesh.case(*pair)
    reason = program.reason(case, *pair, mesh)
    if case == "apart":
        out.ours.append((CASES[case], pair))
    elif reason:
        out.explained[reason] += 1
    else:
        out.theirs.append((f"leaves out two triangles that {CASES[case]}", pair))


def judge_extra_pair(mesh, pair, out):
    """They list it, we do not."""
    if pair[0] == pair[1]:
        return  # a triangle without area; its pairs are judged where they are missing
    case = mesh.case(*pair)
    wrong = out.theirs if case == "apart" else out.ours
    wrong.append((f"lists two triangles that {CASES[case]}", pair))


def judge_missing_face(mesh, program, face, partners, out):
    """We have pairs of it, they do not name it. It is explained if all its pairs are."""
    reasons = []
    for partner in partners:
        case = mesh.case(face, partner)
        reasons.append(program.reason(case, face, partner, mesh))
        if case == "apart":
            out.ours.append((CASES[case], (face, partner)))
        elif not reasons[-1]:
            out.theirs.append((f"leaves out one of two triangles that {CASES[case]}", (face, partner)))
            return
    out.explained[reasons[0]] += 1


def judge_extra_face(mesh, face, out):
    met = mesh.met_by(face)
    if met:
        out.ours.append(("leaves out a triangle that meets others", (face, met[0])))
    else:
        out.theirs.append(("names a triangle that meets no other", (face,)))


def judge(mesh, program, we, they):
    out = Verdict()
    if they.pairs is not None:
        for pair in sorted(we.pairs - they.pairs):
            judge_missing_pair(mesh, program, pair, out)
        for pair in sorted(they.pairs - we.pairs):
            judge_extra_pair(mesh, pair, out)
        return out
    partners = collections.defaultdict(list)
    for a, b in we.pairs:
        partners[a].append(b)
        partners[b].append(a)
    for face in sorted(we.faces - they.faces):
        judge_missing_face(mesh, program, face, partners[face], out)
    for face in sorted(they.faces - we.faces):
        judge_extra_face(mesh, face, out)
    return out


def judge_kinds(mesh, we):
    """Pairs of ours, and their kinds, that are not as the referee says."""
    pairs = sorted(we.pairs)
    random.Random(1).shuffle(pairs)
    wrong = []
    for pair in pairs[:JUDGED_KINDS]:
        kind = "coplanar" if we.kinds[pair] == "folded" else we.kinds[pair]
        case = mesh.case(*pair)
        if kind != OUR_KINDS.get(case, "touching") or case == "apart":
            wrong.append((f"says {we.kinds[pair]} of two triangles that {CASES[case]}", pair))
    return wrong


# ---- words


def count_of(count, what):
    return f"{count:,} {what}" + ("" if count == 1 else "s")


def clause(program, we, they, verdict):
    """The answers of a program where it differs."""
    what = "pair" if they.pairs is not None else "triangle"
    all_count = len(we.pairs if they.pairs is not None else we.faces)
    parts = []
    for reason, count in verdict.explained.items():
        parts.append(f"leaves out {count:,} of {count_of(all_count, what)}, because {reason}")
    for (text, _), count in collections.Counter((t, None) for t, _ in verdict.theirs).items():
        parts.append(f"**is wrong** about {count_of(count, what)}, as it {text}")
    return f"{program.name} {', and '.join(parts)}"


def sentence(same, clauses):
    start = " and ".join([", ".join(same[:-1]), same[-1]] if len(same) > 1 else same)
    first = [f"{start} {'agree' if len(same) > 1 else 'agrees'}"] if same else []
    return "; ".join(first + clauses) + "."


def kinds_text(we):
    counts = collections.Counter(we.kinds.values())
    return ", ".join(f"{count:,} {kind}" for kind, count in counts.most_common()) or "none"


def show_example(mesh, name, text, triangles):
    print(f"    {name} {text}: {', '.join(str(t) for t in triangles)}", file=sys.stderr)
    for t in triangles:
        print(f"      {[mesh.vertices[v] for v in mesh.triangles[t]]}", file=sys.stderr)


# ---- runs


def best_run(program, mesh, folder, o, large):
    best = None
    for _ in range(o.repeats if large else 1):
        answer = program.run(mesh.path, folder, o.limit)
        if best is None or answer.seconds < best.seconds:
            best = answer
        if best.seconds > 5.0:
            break
    return best


def cost_text(answer):
    alone = f" ({answer.alone:.3f})" if answer.alone is not None else ""
    return f"{answer.seconds:.2f}{alone}; {answer.megabytes:.0f}"


class Comparison:
    def __init__(self, o):
        self.o = o
        self.we = ours(o.build)
        self.programs = []
        self.wrong = 0
        for program in all_programs(o.build):
            if program.missing():
                print(f"{program.name} is left out: {program.missing()}.")
            else:
                self.programs.append(program)

    def compare(self, mesh, large):
        """Returns our answer, a sentence, and what each program costs."""
        we = best_run(self.we, mesh, self.o.work, self.o, large)
        same, clauses, costs = [], [], [cost_text(we)]
        mistakes = judge_kinds(mesh, we)
        for program in self.programs:
            try:
                they = best_run(program, mesh, self.o.work, self.o, large)
            except Failed as problem:
                clauses.append(f"{program.name} {problem}")
                costs.append("-")
                continue
            costs.append(cost_text(they))
            verdict = judge(mesh, program, we, they)
            mistakes += verdict.ours
            if verdict.theirs:
                show_example(mesh, program.name, *verdict.theirs[0])
            if verdict.explained or verdict.theirs:
                clauses.append(clause(program, we, they, verdict))
            else:
                same.append(program.name)
        for mistake in mistakes[:5]:
            show_example(mesh, "cscd", *mistake)
        self.wrong += len(mistakes)
        if mistakes:
            clauses.append(f"cscd **wrong** in {len(mistakes)}")
        return we, sentence(same, clauses), costs


def small_table(comparison):
    print("\n| mesh | pairs | what the others say |\n| --- | --- | --- |")
    for i, (name, (vertices, triangles)) in enumerate(meshes().items()):
        path = os.path.join(comparison.o.work, f"small{i}.off")
        write_off(path, vertices, triangles)
        we, text, _ = comparison.compare(Mesh(name, path), False)
        print(f"| {name} | {kinds_text(we)} | {text} |", flush=True)


def large_meshes(o):
    """Writes one after another: its path and what it is."""
    program = os.path.join(o.build, "benchmarks/referee")
    for name, count, what in SCENES:
        if o.quick and count > 100000:
            continue
        path = os.path.join(o.work, f"{name}{count}.off")
        subprocess.run([program, "scene", name, str(count), path], check=True)
        yield path, what
    if o.data is None:
        print("The frames of cloth are left out: neither --data nor CSCD_DATA names a folder.")
        return
    for name in FRAMES:
        path = os.path.join(o.work, f"{name}.off")
        subprocess.run([program, "convert", os.path.join(o.data, f"{name}.ply"), path], check=True)
        yield path, name


def large_table(comparison):
    rows = []
    names = [comparison.we.name] + [program.name for program in comparison.programs]
    print("\n| mesh | triangles | pairs | what the others say |\n| --- | --- | --- | --- |")
    for path, what in large_meshes(comparison.o):
        mesh = Mesh(what, path)
        we, text, costs = comparison.compare(mesh, True)
        size = f"{len(mesh.triangles):,}"
        print(f"| {what} | {size} | {kinds_text(we)} | {text} |", flush=True)
        rows.append(f"| {what} | {size} | {' | '.join(costs)} |")
    print(f"\n| mesh | triangles | {' | '.join(names)} |\n|{' --- |' * (len(names) + 2)}")
    print("\n".join(rows))


def parse_options():
    data = os.environ.get("CSCD_DATA")
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--work", default="build/referee")
    parser.add_argument("--data", default=os.path.join(data, "frames") if data else None)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--limit", type=int, default=300)
    parser.add_argument("--quick", action="store_true")
    o = parser.parse_args()
    o.build, o.work = os.path.abspath(o.build), os.path.abspath(o.work)
    return o


def main():
    o = parse_options()
    if not os.access(TIMER, os.X_OK):
        sys.exit(f"compare.py: there is no {TIMER}, which measures the programs: install the package `time`")
    os.makedirs(o.work, exist_ok=True)
    comparison = Comparison(o)
    if comparison.we.missing():
        sys.exit(f"compare.py: {comparison.we.missing()}")
    small_table(comparison)
    large_table(comparison)
    sys.exit(1 if comparison.wrong else 0)


if __name__ == "__main__":
    main()
