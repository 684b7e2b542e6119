"""Recordings and their reports, made once by the tool and the programs of models/, each when a scenario first asks for it."""
import json
import math
import os
import subprocess
from array import array

import recording_file

RECORDINGS = ("pawn-drop", "dumbbell-stairs", "figure-balls")
# Names that a careless page or file would not survive; ' and a newline are no better.
HOSTILE = "<img src=x onerror=document.title='owned'>&amp;\"'\n</script><b>.obj"
LARGE_FRAMES, LARGE_TRIANGLES = 161, 100000

TETRAHEDRON = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))
LIMBS = ("Arm", "Leg", "Eye")
LIMB_PLACES = ((1.2, 0.6), (2.2, 0.6), (0.6, 1.9))
OUT = [2.5] * 10
# How far the tip of each limb is from the body, in each frame.
LIMB_WAYS = ({"before": [3, 2, 1, -0.6, -0.9, -0.6, 1, 2, 3, 3], "after": OUT},
             {"before": [3, 3, 2, 2, 1, -0.1, -0.2, -0.15, -0.1, 1], "after": [3, 3, 2, 2, 1, -0.1, -0.5, -0.3, -0.1, 1]},
             {"before": OUT, "after": [3, 3, 3, 2, 2, 2, 1, -0.25, -0.25, 1]})


class Made:
    """The files of one report."""

    def __init__(self, folder, name):
        self.base = os.path.join(folder, name)
        self.model, self.frames = self.base + ".obj", self.base + ".pc2"
        self.page, self.json, self.csv = self.base + ".html", self.base + ".json", self.base + ".csv"
        self.name = os.path.basename(self.model)

    def summary(self):
        with open(self.json, encoding="utf-8") as file:
            return json.load(file)

    def contacts(self):
        return recording_file.read_contacts(self.csv)


class Material:
    """Files that scenarios share, all in one folder."""

    def __init__(self, folder, build):
        self.folder, self.build, self.made, self.recording = folder, build, {}, {}
        os.makedirs(folder, exist_ok=True)

    def run(self, program, *arguments, code=0):
        command = [os.path.join(self.build, program), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
        if done.returncode != code:
            raise AssertionError(f"{command}: exit {done.returncode}: {done.stderr.strip()}")
        return done.stdout

    def begin(self):
        """Starts recording all scenes, side by side."""
        for name in RECORDINGS:
            if os.path.exists(os.path.join(self.folder, name + ".made")):
                continue
            command = [os.path.join(self.build, "models/record"), name, self.folder]
            self.recording[name] = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

    def recorded(self, name):
        """Returns the files of a scene, once its program has ended."""
        process = self.recording.pop(name, None)
        if process is not None:
            error = process.communicate()[1]
            if process.returncode != 0:
                raise AssertionError(f"record {name}: exit {process.returncode}: {error.decode(errors='replace')}")
            with open(os.path.join(self.folder, name + ".made"), "w", encoding="utf-8"):
                pass
        return Made(self.folder, name)

    def once(self, name, make):
        if name not in self.made:
            self.made[name] = make(name)
        return self.made[name]

    def replay(self, name):
        """Returns the report of one of the recordings, with its scenery, its summary and its contacts, from one run."""
        return self.once(name, self._replay)

    def _replay(self, name):
        made = self.recorded(name)
        scenery = ["--scenery", made.base + "-scenery.obj"]
        if os.path.exists(made.base + "-scenery.pc2"):
            scenery += ["--scenery-frames", made.base + "-scenery.pc2"]
        self.replay_files(made, *scenery)
        return made

    def replay_files(self, made, *options):
        up = () if "--up" in options else ("--up", "z")  # these recordings stand on z, as few files of that format do
        self.run("cscd", "replay", made.model, made.frames, "--json", made.json, "--contacts", made.csv, "--report",
                 made.page, "--quiet", *up, *options)

    def preprocess(self):
        """Returns the report of the regions of the dumbbell."""
        return self.once("preprocess", self._preprocess)

    def _preprocess(self, name):
        source = self.recorded("dumbbell-stairs")
        made = Made(self.folder, name)
        self.run("cscd", "preprocess", source.model, "-o", made.base + ".plan.ply", "--up", "z", "--report", made.page)
        return made

    def comparison(self):
        """Returns the report of two methods on the dumbbell, and the files of their summaries."""
        return self.once("comparison", self._comparison)

    def _comparison(self, name):
        source = self.recorded("dumbbell-stairs")
        made = Made(self.folder, name)
        made.summaries = []
        for method in ("none", "single"):
            path = os.path.join(self.folder, method + ".json")
            self.run("cscd", "replay", source.model, source.frames, "--method", method, "--json", path, "--quiet")
            made.summaries.append(path)
        self.run("cscd", "report", *made.summaries, "-o", made.page)
        return made

    def tetrahedra(self, name="tetrahedra", *options):
        """Makes ten frames in which one tetrahedron flies through another; `name` may be any file name."""
        return self.once(name, lambda _: self._tetrahedra(name, options))

    def _tetrahedra(self, name, options):
        made = Made(self.folder, "small")
        made.model = os.path.join(self.folder, name if name.endswith(".obj") else name + ".obj")
        made.page, made.name = os.path.join(self.folder, "small.html"), os.path.basename(made.model)
        still = [(0.0, 0.0, 0.0), (0.0, 4.0, 0.0), (0.0, 0.0, 4.0), (-4.0, 0.0, 0.0)]
        tip = [(3.5, 1.0, 1.0), (5.5, 1.0, 1.0), (5.5, 2.0, 1.0), (5.5, 1.0, 2.0)]
        triangles = [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]
        triangles += [tuple(corner + 4 for corner in triangle) for triangle in triangles]
        frames = [still + [(x - k, y, z) for x, y, z in tip] for k in range(10)]
        recording_file.write_obj(made.model, frames[0], triangles)
        recording_file.write_pc2(made.frames, [recording_file.flat(frame) for frame in frames])
        self.replay_files(made, *options)
        return made

    def untangled(self, name, *options, code=0):
        """Returns the page of untangling the flight of the tetrahedra, or some of its frames."""
        return self.once("untangled-" + name, lambda name: self._untangled(name, options, code))

    def _untangled(self, name, options, code):
        made, source = Made(self.folder, name), self.tetrahedra()
        out = made.base + (".obj" if "--frames" in options else ".pc2")
        self.run("cscd", "untangle", source.model, source.frames, "-o", out, "--json", made.json, "--report", made.page, "--quiet",
                 *options, code=code)
        return made

    def sized(self, name, sizes, apart=9.0, options=()):
        """Makes a frame for each pair of sizes, of two tetrahedra that are so far apart along x, "Puff" and "Rock"."""
        return self.once(name, lambda _: self._sized(name, sizes, apart, options))

    def _sized(self, name, sizes, apart, options):
        made = Made(self.folder, name)
        corners = [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)]
        triangles = [tuple(corner + first for corner in triangle) for first in (0, 4) for triangle in TETRAHEDRON]
        frames = [[(puff * x, puff * y, puff * z) for x, y, z in corners] +
                  [(rock * (x + apart), rock * y, rock * z) for x, y, z in corners] for puff, rock in sizes]
        recording_file.write_obj(made.model, frames[0], triangles, {0: "Puff", 4: "Rock"})
        recording_file.write_pc2(made.frames, [recording_file.flat(frame) for frame in frames])
        self.replay_files(made, *options)
        return made

    def stepped(self):
        """Makes the same flight as mesh files that an artist has numbered, with a gap: frames 1001, 1003 ... 1011, 1017 ...

        The file before them, 999, is not replayed."""
        return self.once("stepped", self._stepped)

    def _stepped(self, name):
        made, source = Made(self.folder, name), self.tetrahedra()
        made.numbers = [1001, 1003, 1005, 1007, 1009, 1011, 1017, 1019, 1021, 1023]
        _, triangles = recording_file.read_obj(source.model)
        files = []
        frames = list(recording_file.read_pc2(source.frames))
        for number, axes in zip([999] + made.numbers, frames[:1] + frames):
            files.append(os.path.join(self.folder, f"stepped.{number}.obj"))
            recording_file.write_obj(files[-1], list(zip(*axes)), triangles)
        made.model = files[0]
        self.run("cscd", "replay", *files, "--allow-gaps", "--frames", "1001:", "--json", made.json, "--contacts", made.csv,
                 "--up", "z", "--fps", "25", "--report", made.page, "--quiet")
        return made

    def limbs(self, name):
        """Makes ten frames of a body that three limbs reach into, each along x: `before` or `after` it was mended."""
        return self.once("limbs-" + name, lambda _: self._limbs(name))

    def _limbs(self, name):
        made = Made(self.folder, "limbs-" + name)
        names, triangles = {}, []
        for part, limb in enumerate(["Body", *LIMBS]):
            names[len(triangles)] = limb
            triangles += [tuple(corner + 4 * part for corner in triangle) for triangle in TETRAHEDRON]
        frames = [limbs_at([ways[name][frame] for ways in LIMB_WAYS]) for frame in range(10)]
        recording_file.write_obj(made.model, frames[0], triangles, names)
        recording_file.write_pc2(made.frames, [recording_file.flat(frame) for frame in frames])
        self.replay_files(made, "--unit", "cm", "--fps", "12")
        return made

    def limbs_compared(self, *others):
        """Returns the page that compares `before` with these summaries."""
        made = Made(self.folder, "limbs")
        self.run("cscd", "report", self.limbs("before").json, *others, "-o", made.page)
        return made

    def large(self):
        """Makes a torus of 100,000 triangles that is bent to and fro: not all of its frames fit in the page."""
        return self.once("large", self._large)

    def _large(self, name):
        made = Made(self.folder, name)
        self.run("models/shape", "torus", "--triangles", str(LARGE_TRIANGLES), made.model)
        positions, _ = recording_file.read_obj(made.model)
        shapes = [bent(positions, 0.02 * k) for k in range(9)]
        there_and_back = shapes + shapes[-2:0:-1]
        recording_file.write_pc2(made.frames, [there_and_back[k % len(there_and_back)] for k in range(LARGE_FRAMES)])
        self.replay_files(made, "--method", "single", "--no-check")
        return made

    def long(self, intervals):
        """Makes a pyramid that goes in and out of a triangle for so many intervals."""
        return self.once(f"long-{intervals}", lambda name: self._long(name, intervals))

    def _long(self, name, intervals):
        made = Made(self.folder, name)
        sheet = [(-9.0, -9.0, 0.0), (9.0, -9.0, 0.0), (0.0, 9.0, 0.0)]
        pyramid = [(-1.0, -1.0, 1.0), (1.0, -1.0, 1.0), (0.0, 1.0, 1.0), (0.0, 0.0, 0.5)]
        heights = [0.6 * math.sin(0.1 * k) - 0.3 for k in range(intervals + 1)]
        frames = [sheet + [(x, y, z + height) for x, y, z in pyramid] for height in heights]
        recording_file.write_obj(made.model, frames[0], [(0, 1, 2), (3, 5, 4), (3, 4, 6), (4, 5, 6), (5, 3, 6)])
        recording_file.write_pc2(made.frames, [recording_file.flat(frame) for frame in frames])
        self.replay_files(made)
        return made


def limbs_at(tips):
    """Returns the positions of the body and of limbs whose tips are at these x."""
    positions = [(0.0, 0.0, 0.0), (0.0, 4.0, 0.0), (0.0, 0.0, 4.0), (-4.0, 0.0, 0.0)]
    for x, (y, z) in zip(tips, LIMB_PLACES):
        positions += [(x, y, z), (x + 2.0, y, z), (x + 2.0, y, z + 0.6), (x + 2.0, y + 0.6, z)]
    return positions


def bent(positions, bend):
    """Shears the body by the square of x, and lengthens it."""
    values = array("f")
    for x, y, z in positions:
        values.extend((x * (1.0 + bend), y, z + bend * x * x * math.copysign(1.0, x)))
    return values
