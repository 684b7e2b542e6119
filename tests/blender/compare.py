#!/usr/bin/env python3
"""Compares the vertices of glTF files, as the tool reads them, with those that Blender evaluated: compare.py PROGRAM FOLDER.

The parts must be called as Blender's objects are. An exporter splits vertices and renumbers them, so a vertex of ours is compared
with the one of the same object that it lies on in the first frame, in that frame and in all others. Every vertex of Blender's
must have one of ours. The largest distance must be at most 1e-5 of the size of the scene.
"""
import glob
import json
import math
import os
import subprocess
import sys

TOLERANCE = 1e-5


def read_frames(program, path, fps):
    """The objects of the vertices, and a list of (number, vertices)."""
    lines = subprocess.run([program, path, str(fps)], check=True, capture_output=True, text=True).stdout.split('\n')
    vertex_count, part_count, frame_count = map(int, lines[0].split())
    names = lines[1:1 + part_count]
    objects = [names[int(part)] for part in lines[1 + part_count].split()]
    assert len(objects) == vertex_count
    frames = []
    for line in lines[2 + part_count:2 + part_count + frame_count]:
        number, *coordinates = line.split()
        values = list(map(float, coordinates))
        assert len(values) == 3 * vertex_count
        frames.append((int(number), list(zip(values[0::3], values[1::3], values[2::3]))))
    return objects, frames


def blender_frames(path):
    """Frames a second, the objects of the vertices, and a list of (number, vertices)."""
    truth = json.load(open(path))
    names = sorted(truth['frames'][0]['objects'])
    objects = [name for name in names for _ in truth['frames'][0]['objects'][name]]
    return truth['fps'], objects, [(f['frame'], [tuple(v) for name in names for v in f['objects'][name]])
                                   for f in truth['frames']]


def find_partners(ours, our_objects, theirs, their_objects):
    """For each vertex of ours, the nearest one of theirs of the same object."""
    candidates = {name: [j for j, other in enumerate(their_objects) if other == name] for name in set(their_objects)}
    return [min(candidates[name], key=lambda j: math.dist(theirs[j], v)) for v, name in zip(ours, our_objects)]


def compare(program, path, truth_path):
    """The largest distance in units of the size."""
    fps, their_objects, truth = blender_frames(truth_path)
    our_objects, frames = read_frames(program, path, fps)
    assert set(our_objects) == set(their_objects), f'{path}: parts {set(our_objects)}'
    assert [n for n, _ in frames] == [n for n, _ in truth], f'{path}: frames {[n for n, _ in frames]}'
    first = truth[0][1]
    size = max(max(v[axis] for v in first) - min(v[axis] for v in first) for axis in range(3))
    partner = find_partners(frames[0][1], our_objects, first, their_objects)
    assert set(partner) == set(range(len(first))), f'{path}: vertices of Blender without one of ours'
    moved = max(math.dist(a, b) for a, b in zip(first, truth[len(truth) // 2][1])) / size
    assert moved > 0.01, f'{path}: nothing moves'
    return max(math.dist(v, theirs[j]) / size
               for (_, ours), (_, theirs) in zip(frames, truth) for v, j in zip(ours, partner))


def main():
    program, folder = sys.argv[1:]
    worst, compared = 0, 0
    for truth in sorted(glob.glob(os.path.join(folder, '*.json'))):
        for ending in ('.glb', '.gltf', '.embedded.gltf'):
            path = truth[:-len('.json')] + ending
            distance = compare(program, path, truth)
            print(f'{os.path.basename(path):24} {distance:.2e} of the size')
            worst, compared = max(worst, distance), compared + 1
    good = compared > 0 and worst <= TOLERANCE
    print(f'{compared} files, the largest distance is {worst:.2e} of the size: {"passed" if good else "FAILED"}')
    sys.exit(not good)


main()
