"""The programs that are compared: how each is run on a mesh, and how its answer is read."""

import json
import math
import os
import re
import shutil
import struct
import subprocess

from exact_pair import case_of

SCRIPT = """<!DOCTYPE FilterScript>
<FilterScript><filter name="Select Self Intersecting Faces"/></FilterScript>
"""
SELECTED = 0x20  # of the flags of a face in MeshLab's files


TIMER = "/usr/bin/time"


class Failed(Exception):
    """A program has no answer; its text says why."""


class Answer:
    """pairs: a set of (a, b), a < b, or None where a program names faces only; faces: a set; alone: seconds of the
    search by itself, where the program tells; seconds and megabytes: of the whole process, reading included. All seconds
    are of processor time, in which a crowded machine shows less."""

    def __init__(self, pairs=None, faces=None, kinds=None, alone=None):
        self.pairs, self.kinds, self.alone = pairs, kinds, alone
        self.faces = faces if pairs is None else {t for pair in pairs for t in pair}
        self.seconds = self.megabytes = None


def last_words(log, status):
    lines = [line.strip() for line in open(log, encoding="utf-8", errors="replace") if line.strip()]
    assertion = re.search(r"Assertion `(.*)' failed", lines[-1]) if lines else None
    if assertion:
        return f"ends with a failed assertion (`{assertion.group(1)}`)"
    return f"says: {lines[-1]}" if lines else f"ends with status {status}"


def measured(command, folder, limit, log, before=()):
    """Runs a command with its output in a file; returns seconds of processor time and megabytes at most."""
    figures = os.path.join(folder, "figures.txt")
    timed = [*before, TIMER, "-f", "%U %S %M", "-o", figures, "timeout", str(limit), *command]
    with open(log, "w", encoding="utf-8") as out:
        status = subprocess.run(timed, cwd=folder, stdout=out, stderr=out, stdin=subprocess.DEVNULL, check=False).returncode
    if status == 124:
        raise Failed(f"no answer in {limit} s")
    if status != 0:
        raise Failed(last_words(log, status))
    user, system, kilobytes = open(figures, encoding="utf-8").read().split()[-3:]
    return float(user) + float(system), float(kilobytes) / 1024


def ordered(a, b):
    return (a, b) if a < b else (b, a)


def read_lines(path):
    with open(path, encoding="utf-8") as lines:
        return [line.split() for line in lines]


class Lister:
    """A program that is built here: MESH PAIRS.txt, with its times as JSON on the standard output."""

    def __init__(self, name, program, words=(), advice="run make benchmarks"):
        self.name, self.program, self.words, self.advice = name, program, words, advice

    def missing(self):
        return None if os.access(self.program, os.X_OK) else f"{self.program} is not there; {self.advice}"

    def reason(self, case, a, b, mesh):
        """Why a pair that meets is not listed, by the program's definition; None: there is no reason."""
        return "it lists no pairs of triangles without area, but each of these with itself" if case == "no area" else None

    def run(self, mesh, folder, limit):
        pairs_path, log = mesh[:-4] + f".{self.name}.txt", mesh[:-4] + f".{self.name}.log"
        figures = measured([self.program, *self.words, mesh, pairs_path], folder, limit, log)
        rows = read_lines(pairs_path)
        kinds = {ordered(int(r[0]), int(r[1])): r[2] for r in rows if len(r) > 2}
        alone = json.loads(open(log, encoding="utf-8").read())["find_s"]
        answer = Answer({ordered(int(r[0]), int(r[1])) for r in rows}, kinds=kinds, alone=alone)
        answer.seconds, answer.megabytes = figures
        return answer


class Tetgen:
    name = "tetgen"
    tolerance = 1e-8  # of the extent; its option -T

    def reason(self, case, a, b, mesh):
        corners = [mesh.vertices[v] for v in {*mesh.triangles[a], *mesh.triangles[b]}]
        near = min(math.dist(p, q) for i, p in enumerate(corners) for q in corners[:i])
        if near > self.tolerance * mesh.diagonal():
            return None
        return "it makes one of vertices that are closer than 1e-8 of the mesh's extent"

    def missing(self):
        return None if shutil.which("tetgen") else "tetgen is not installed (Debian: tetgen)"

    def run(self, mesh, folder, limit):
        log = mesh[:-4] + ".tetgen.log"
        figures = measured(["tetgen", "-d", mesh], folder, limit, log)
        text = open(log, encoding="utf-8").read()
        found = re.findall(r"Facet #(\d+) (?:intersects|duplicates) facet #(\d+) at", text)
        if "No faces are intersecting" not in text and "faces are intersecting" not in text:
            raise Failed(text.strip().splitlines()[-1])
        answer = Answer({ordered(int(a) - 1, int(b) - 1) for a, b in found})
        alone = re.search(r"Self-intersection seconds:\s+(\S+)", text)
        answer.alone = float(alone.group(1)) if alone else None
        answer.seconds, answer.megabytes = figures
        return answer


class Meshlab:
    name = "MeshLab"

    def reason(self, case, a, b, mesh):
        if case != "crossing":
            return "it names no triangles that only touch or lie in one plane"
        single = lambda x: struct.unpack("f", struct.pack("f", x))[0]
        rounded = {v: tuple(map(single, mesh.vertices[v])) for v in {*mesh.triangles[a], *mesh.triangles[b]}}
        if case_of(mesh.triangles[a], mesh.triangles[b], rounded) == "crossing":
            return None
        return "it keeps coordinates in single precision"

    def missing(self):
        wanted = {"meshlabserver": "meshlab", "xvfb-run": "xvfb", "xauth": "xauth"}
        lacking = [package for program, package in wanted.items() if not shutil.which(program)]
        return f"MeshLab cannot be run (Debian: {' '.join(lacking)})" if lacking else None

    def run(self, mesh, folder, limit):
        script, out = os.path.join(folder, "select.mlx"), mesh[:-4] + ".meshlab.ply"
        with open(script, "w", encoding="utf-8") as file:
            file.write(SCRIPT)
        if os.path.exists(out):
            os.remove(out)
        figures = measured(["meshlabserver", "-i", mesh, "-o", out, "-m", "ff", "sa", "-s", script], folder, limit,
                           mesh[:-4] + ".meshlab.log", before=["xvfb-run", "-a"])
        answer = Answer(faces=self.read_selection(out))
        answer.seconds, answer.megabytes = figures
        return answer

    @staticmethod
    def read_selection(path):
        if not os.path.exists(path):
            raise Failed("writes no mesh")
        rows = read_lines(path)
        header = rows.index(["end_header"])
        counts = {r[1]: int(r[2]) for r in rows[:header] if r[0] == "element"}
        faces = rows[header + 1 + counts["vertex"]:]
        return {i for i, row in enumerate(faces) if int(row[4]) & SELECTED}


def all_programs(build):
    cgal = os.path.join(build, "benchmarks/cgal_pairs")
    return [Lister("CGAL", cgal, advice="run make referee (Debian: libcgal-dev)"), Tetgen(), Meshlab()]


def ours(build):
    return Lister("cscd", os.path.join(build, "benchmarks/referee"), ["pairs"])
