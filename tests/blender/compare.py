#!/usr/bin/env python3
"""Compares the vertices of glTF files, as the tool reads them, with those that Blender evaluated: compare.py PROGRAM FOLDER.

An exporter splits vertices and renumbers them, so a vertex of ours is compared with the one of Blender's that it lies on in
the first frame, in that frame and in all others. Every vertex of Blender's must have one of ours. The largest distance
must be at most 1e-5 of the size of the scene.
"""
import glob
import json
import math
import os
import subprocess
import sys

TOLERANCE = 1e-5


def read_frames(program, path, fps):
    """A list of (number, vertices)."""
    lines = subprocess.run([program, path, str(fps)], check=True, capture_output=True, text=True).stdout.split('\n')
    vertex_count, frame_count = map(int, lines[0].split())
    frames = []
    for line in lines[1:1 + frame_count]:
        number, *coordinates = line.split()
        values = list(map(float, coordinates))
        assert len(values) == 3 * vertex_count
        frames.append((int(number), list(zip(values[0::3], values[1::3], values[2::3]))))
    return frames


def blender_frames(path):
    truth = json.load(open(path))
    return truth['fps'], [(f['frame'], [tuple(v) for name in sorted(f['objects']) for v in f['objects'][name]])
                          for f in truth['frames']]


def compare(program, path, truth_path):
    """The largest distance in units of the size."""
    fps, truth = blender_frames(truth_path)
    frames = read_frames(program, path, fps)
    assert [n for n, _ in frames] == [n for n, _ in truth], f'{path}: frames {[n for n, _ in frames]}'
    size = max(max(v[axis] for v in truth[0][1]) - min(v[axis] for v in truth[0][1]) for axis in range(3))
    partner = [min(range(len(truth[0][1])), key=lambda j: math.dist(truth[0][1][j], v)) for v in frames[0][1]]
    assert set(partner) == set(range(len(truth[0][1]))), f'{path}: vertices of Blender without one of ours'
    moved = max(math.dist(a, b) for a, b in zip(truth[0][1], truth[len(truth) // 2][1])) / size
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
