#!/usr/bin/env python3
"""Every command of the tool when the world fails it, once at each place: run.py BUILD SHIM [SHARE SEED].

Memory: each allocation is refused once (failing_memory.c). Writes: files may not grow beyond each size in turn, as when a disk is
full. Reads: each input ends after each of its bytes. Whatever happens, the command ends by itself. It did all of its work, and its
outputs are those of an undisturbed run; or it says in lines that begin with its name what was wrong, ends with a status of its own,
and leaves no output that is not whole. SHARE: only every SHARE-th place, from one that SEED, a hexadecimal number, chooses.
The last line is `N passed, M failed`, a command and a kind of fault each.
"""
import json
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

STATUSES = {0, 1, 2, 3, 4}
FAULTS_SHOWN = 5
SECONDS_MAX = 120

# A command, and the files that it writes.
COMMANDS = [
    (["info", "body.obj", "--json", "out.json"], ["out.json"]),
    (["preprocess", "body.obj", "--method", "kmeans:3", "-o", "out.ply", "--report", "out.html"], ["out.ply", "out.html"]),
    (["preprocess", "body.obj", "-o", "out.ply"], ["out.ply"]),
    (["preprocess", "body.obj", "-o", "out.ply", "--charge", "dense"], ["out.ply"]),
    (["check", "body.obj", "body.pc2", "--json", "out.json", "--csv", "out.csv", "--events", "out.events", "--junit", "out.xml",
      "--select", "out.select"], ["out.json", "out.csv", "out.events", "out.xml", "out.select"]),
    (["check", "--list", "body.jobs.jsonl", "--results", "out.jsonl", "--reproducible"], []),
    (["replay", "body.obj", "body.pc2", "--reproducible", "--json", "out.json", "--contacts", "out.csv", "--report", "out.html",
      "--plan", "body.plan.ply"], ["out.json", "out.csv", "out.html"]),
    (["replay", "body.obj", "body.pc2", "--method", "iccd", "--vtk", "out"], ["out.pvd"]),
    (["report", "body.summary.json", "-o", "out.html"], ["out.html"]),
    (["report", "body.results.jsonl", "-o", "out.html"], ["out.html"]),
    (["untangle", "two.obj", "-o", "out.obj", "--gap", "0.01", "--json", "out.json"], ["out.obj", "out.json"]),
    (["untangle", "two.obj", "two.pc2", "-o", "out.pc2", "--json", "out.json"], ["out.pc2", "out.json"]),
    (["merge", "body.results.jsonl", "-o", "out.jsonl"], ["out.jsonl"]),
    (["render", "body.obj", "body.pc2", "--frame", "1", "--size", "64x64", "-o", "out.png"], ["out.png"]),
    (["sense", "mannequin.glb", "mannequin.glb", "--frames", "0:2", "--json", "out.json"], ["out.json"]),
]

# Inputs that are cut, and the command that reads them.
INPUTS = [("body.obj", ["info"]), ("polygons.obj", ["info"]), ("body.off", ["info"]), ("body.stl", ["info"]), ("text.stl", ["info"]),
          ("big.ply", ["info"]), ("text.ply", ["info"]), ("body.plan.ply", ["info"]), ("base64.surf.gii", ["info"]),
          ("gzip.surf.gii", ["info"]), ("text.surf.gii", ["info"]), ("body.pc2", ["check", "body.obj"]),
          ("body.mdd", ["check", "body.obj"]), ("body.plan.ply", ["replay", "body.obj", "body.pc2", "--plan"]),
          ("body.summary.json", ["report", "-o", "out.html"]), ("body.results.jsonl", ["report", "-o", "out.html"]),
          ("body.jobs.jsonl", ["check", "--results", "out.jsonl", "--list"]), ("mannequin.glb", ["info"]), ("mannequin.gltf", ["info"])]


class Rig:
    """A folder with the corpus, and a tool to run in it."""

    def __init__(self, build, shim, share, seed):
        self.tool = os.path.join(os.path.abspath(build), "cscd")
        self.shim, self.share, self.seed = os.path.abspath(shim), share, seed
        self.corpus = tempfile.mkdtemp(prefix="cscd-faults-")
        subprocess.run([os.path.join(os.path.dirname(__file__), "..", "fuzz", "corpus.sh"), build, self.corpus], check=True)
        self.write_two_bodies()

    def write_two_bodies(self):
        """The body twice: in itself, and in a recording whose second frame is the clean one."""
        with open(os.path.join(self.corpus, "body.obj"), encoding="ascii") as file:
            rows = [line.split() for line in file]
        points = [tuple(map(float, row[1:4])) for row in rows if row[:1] == ["v"]]
        faces = [[int(corner.split("/")[0]) for corner in row[1:]] for row in rows if row[:1] == ["f"]]
        size = max(x for x, _, _ in points) - min(x for x, _, _ in points)
        frames = [points + [(x + share * size, y + 0.03 * size, z) for x, y, z in points] for share in (0.8, 1.1, 0.9)]
        faces += [[corner + len(points) for corner in face] for face in faces]
        with open(os.path.join(self.corpus, "two.obj"), "w", encoding="ascii") as file:
            file.writelines(f"v {x} {y} {z}\n" for x, y, z in frames[0])
            file.writelines(f"f {' '.join(map(str, face))}\n" for face in faces)
        with open(os.path.join(self.corpus, "two.pc2"), "wb") as file:
            file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(frames[0]), 0.0, 1.0, len(frames)))
            file.write(b"".join(struct.pack("<3f", *point) for frame in frames for point in frame))

    def places(self, first, count, step=1):
        """Every SHARE-th of the places first, first + step, ..."""
        every = list(range(first, first + count, step))
        return every[self.seed % self.share::self.share] if self.share > 1 else every

    def run(self, folder, arguments, environment=None, limit=None):
        """Status, standard output, standard error; the status is that of a signal, negative, if one ended the tool."""
        def set_limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        options = ["--threads", "1"] if arguments[0] in ("replay", "check", "sense", "untangle") else []
        done = subprocess.run([self.tool, *arguments, *options], cwd=folder, capture_output=True, text=True, errors="replace",
                              env={**os.environ, "OPENBLAS_NUM_THREADS": "1", **kernels(), **(environment or {})},
                              preexec_fn=set_limit if limit is not None else None, timeout=SECONDS_MAX, check=False)
        return done.returncode, done.stdout, done.stderr

    def fresh_folder(self):
        folder = tempfile.mkdtemp(prefix="cscd-fault-")
        for name in os.listdir(self.corpus):
            os.symlink(os.path.join(self.corpus, name), os.path.join(folder, name))
        return folder


def kernels():
    """The kernels of OpenBLAS. It does not know every processor, and when memory runs out the tool does not choose better ones for it,
    whose sums have other bits."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return {"OPENBLAS_CORETYPE": "Haswell"} if " avx2 " in file.read() else {}


def contents(folder, names):
    found = {}
    for name in names:
        path = os.path.join(folder, name)
        if os.path.exists(path) and not os.path.islink(path):
            with open(path, "rb") as file:
                found[name] = file.read()
    return found


def is_whole(name, data, expected):
    """Whether an output is what an undisturbed run writes, times aside, or says itself how far it came."""
    def timeless(text):
        return re.sub(rb'time="[0-9.]+"', b"", text)
    if timeless(data) == timeless(expected):
        return True
    ending = name.rpartition(".")[2]
    if ending == "pc2":
        points, samples = struct.unpack("<i", data[16:20])[0], struct.unpack("<i", data[28:32])[0]
        return len(data) == 32 + points * samples * 12
    try:
        if ending in ("json", "select"):
            json.loads(data)
            return True
        if ending in ("xml", "pvd"):
            xml.etree.ElementTree.fromstring(data)
            return True
    except (ValueError, xml.etree.ElementTree.ParseError):
        return False
    if ending in ("csv", "events", "jsonl"):
        return expected.startswith(data) and data.endswith(b"\n")
    return ending == "html" and data.rstrip().endswith(b"</html>")


def complaint(status, errors, left, expected):
    """What is wrong with how a command ended; None when nothing is."""
    if status < 0:
        return f"ended by signal {-status}"
    if status not in STATUSES:
        return f"status {status}"
    if "Sanitizer" in errors or "Assertion" in errors:
        return errors
    torn = [name for name in left if not is_whole(name, left[name], expected.get(name, b""))]
    if torn:
        return f"left {torn} torn"
    if status == 0:
        return f"ended well without {sorted(set(expected) - set(left))}" if set(left) != set(expected) else None
    lines = errors.splitlines()
    if status != 3 and not any(line.startswith("cscd") for line in lines):
        return f"status {status} without a word: {errors!r}"
    doubled = [line for line in lines if lines.count(line) > 1]
    return f"said twice: {doubled[0]}" if doubled else None


class Tally:
    """Counts commands by kind of fault, and shows the first faults."""

    def __init__(self):
        self.passed = self.failed = 0

    def add(self, title, places, faults):
        for place, what in faults[:FAULTS_SHOWN]:
            print(f"  {title}: at {place}: {what}")
        print(f"{title}: {places} places, {len(faults)} faults", flush=True)
        self.failed += bool(faults)
        self.passed += not faults


def try_places(rig, arguments, names, expected, places, **how):
    """Runs a command once for each place; how: place to environment, or to limit."""
    faults = []
    for place in places:
        folder = rig.fresh_folder()
        try:
            status, _, errors = rig.run(folder, arguments, **{key: value(place) for key, value in how.items()})
            left = contents(folder, names)
            what = complaint(status, errors, left, expected)
        except subprocess.TimeoutExpired:
            what = f"took more than {SECONDS_MAX} s"
        if what is not None:
            faults.append((place, what))
        shutil.rmtree(folder)
    return faults


def try_command(rig, arguments, names, tally):
    title = "cscd " + " ".join(arguments)
    folder = rig.fresh_folder()
    count = os.path.join(folder, "count")
    status, _, errors = rig.run(folder, arguments, {"LD_PRELOAD": rig.shim, "COUNT_ALLOCATIONS": count})
    if status != 0:
        tally.add(title, 1, [("no place", f"status {status}: {errors}")])
        return
    expected = contents(folder, names)
    with open(count, encoding="ascii") as file:
        requests = int(file.read())
    longest = max((len(data) for data in expected.values()), default=0)
    shutil.rmtree(folder)
    places = rig.places(1, requests)
    faults = try_places(rig, arguments, names, expected, places,
                        environment=lambda n: {"LD_PRELOAD": rig.shim, "FAIL_ALLOCATION": str(n)})
    tally.add(f"memory: {title}", len(places), faults)
    # A buffer of stdio is 4 KiB, so that more sizes than these fail no other write.
    places = rig.places(0, longest, max(1, longest // 64))
    if places:
        faults = try_places(rig, arguments, names, expected, places, limit=lambda size: size)
        tally.add(f"writes: {title}", len(places), faults)


def try_input(rig, name, command, tally):
    with open(os.path.join(rig.corpus, name), "rb") as file:
        whole = file.read()
    faults = []
    step = max(1, len(whole) // 4000)
    places = rig.places(0, len(whole), step)
    for size in places:
        folder = rig.fresh_folder()
        os.remove(os.path.join(folder, name))
        with open(os.path.join(folder, name), "wb") as file:
            file.write(whole[:size])
        status, _, errors = rig.run(folder, [*command, name])
        if status != 0:
            what = complaint(status, errors, {}, {})
            if what is not None:
                faults.append((size, what))
        shutil.rmtree(folder)
    tally.add(f"cut: cscd {' '.join(command)} {name}", len(places), faults)


def main(build, shim, share="1", seed="0"):
    rig, tally = Rig(build, shim, int(share), int(seed, 16)), Tally()
    try:
        for arguments, names in COMMANDS:
            try_command(rig, arguments, names, tally)
        for name, command in INPUTS:
            try_input(rig, name, command, tally)
    finally:
        shutil.rmtree(rig.corpus)
    print(f"{tally.passed} passed, {tally.failed} failed")
    return tally.failed > 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
