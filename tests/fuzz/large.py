#!/usr/bin/env python3
"""Writes a large file of each kind that a reader could take far too long, or too much memory, for: large.py FOLDER."""
import json
import os
import sys

COUNT = 30000


def polygon(points):
    rows = ["v %.9g %.9g %.9g" % point for point in points]
    return "\n".join(rows + ["f " + " ".join(str(i + 1) for i in range(len(points)))]) + "\n"


def obj_files():
    triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
    yield "names", triangle + "".join(f"o n{i}\nf 1 2 3\n" for i in range(3 * COUNT))
    yield "groups", triangle + "".join(f"g n{i}\n" for i in range(2 * COUNT)) + "f 1 2 3\n"
    yield "corners", triangle + "f" + " 1 2 3" * COUNT + "\n"
    yield "lines", triangle + "f 1 2 " + "\\\n" * (10 * COUNT) + "3\n"
    yield "number", triangle + "v 0 0 " + "1" * (10 * COUNT) + "\nf 1 2 3\n"
    yield "comb", polygon([(i, 100 * (i % 2), 0) for i in range(COUNT)] + [(COUNT, -1, 0), (0, -1, 0)])
    yield "point", polygon([(1, 1, 1)] * COUNT)
    yield "scattered", polygon([(i * 7919 % 1009, i * 104729 % 1013, i * 1299709 % 1019) for i in range(COUNT)])


def ply_files():
    head = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face {}\nproperty list uchar int vertex_indices\n")
    vertices = "end_header\n0 0 0\n1 0 0\n0 1 0\n"
    labelled = "".join(f"3 0 1 2 {i}\n" for i in range(3 * COUNT))
    yield "labels", head.format(3 * COUNT) + "property int part\n" + vertices + labelled
    yield "properties", head.format(1) + "property int label\n" * COUNT + vertices + "3 0 1 2" + " 1" * COUNT + "\n"
    yield "elements", head.format(1) + "element a 1\n" * COUNT + vertices + "3 0 1 2\n"


def gltf_files():
    def file(**members):
        return json.dumps({"asset": {"version": "2.0"}, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                           "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"}], **members}, separators=(",", ":"))
    chain = [{"children": [i + 1]} for i in range(2 * COUNT - 1)] + [{"mesh": 0}]
    for name, step in (("chain", 1), ("chain back", -1)):
        yield name, file(nodes=chain, scenes=[{"nodes": list(range(2 * COUNT))[::step]}])
    yield "objects", file(nodes=[{}] * (5 * COUNT) + [{"mesh": 0}])
    yield "same names", file(nodes=[{"mesh": 0, "name": "a"}] * COUNT)
    yield "zeros", file(nodes=[{"mesh": 0}], accessors=[{"componentType": 5126, "count": 2100000000, "type": "VEC3"}])


def gifti_files():
    yield "deep", "<GIFTI>" + "<a>" * (5 * COUNT)
    yield "attributes", "<GIFTI><a " + " ".join(f'a{i}=""' for i in range(COUNT)) + "/></GIFTI>"


def job_files():
    yield "blank", "\n" * (30 * COUNT) + '{"model":"a.obj"}\n'
    yield "options", json.dumps({"model": "a.obj", "options": {f"k{i}": 1 for i in range(COUNT)}}) + "\n"


def result_files():
    def line(jobs, job, more=""):
        return '{"list":"%016x","jobs":%d,"job":%d,"result":"clean","found":false,"name":"a"%s}\n' % (1, jobs, job, more)
    yield "lines", "".join(line(COUNT, i + 1) for i in range(COUNT // 3))
    yield "jobs", line(10000000, 1)
    yield "objects", line(1, 1, ',"x":[' + ",".join(["{}"] * COUNT) + "]")


def main(folder):
    formats = {"obj": obj_files, "ply": ply_files, "gltf": gltf_files, "gifti": gifti_files, "jobs": job_files, "results": result_files}
    for name, files in formats.items():
        os.makedirs(os.path.join(folder, name))
        for title, text in files():
            with open(os.path.join(folder, name, title), "w", encoding="ascii", newline="\n") as file:
                file.write(text)


if __name__ == "__main__":
    main(*sys.argv[1:])
