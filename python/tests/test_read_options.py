"""cscd.read has the tool's options: welding, animations, several objects, parts."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict

import numpy as np
import pytest

import cscd

# A square of two triangles, whose corners along the diagonal differ by 2e-6.
SPLIT = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nv 0 0 0.000002\nv 1 1 0.000002\nv 0 1 0\nf 4 5 6\n"


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text)
    return path


def write_triangle(folder: Path, name: str, height: float, part: str = "T") -> Path:
    return write(folder, name, f"o {part}\nv 0 0 {height}\nv 4 0 {height}\nv 0 4 {height}\nf 1 2 3\n")


@pytest.mark.parametrize("weld, count", [(None, 6), ("none", 6), ("exact", 6), (1e-5, 4), ("1e-5", 4), (1e-7, 6)])
def test_weld(tmp_path: Path, weld: Any, count: int) -> None:
    assert cscd.read(write(tmp_path, "split.obj", SPLIT), weld=weld).mesh.vertex_count == count


def test_several_objects(tmp_path: Path) -> None:
    shirt = write_triangle(tmp_path, "shirt.obj", 1)
    floor = write_triangle(tmp_path, "floor.obj", 5)
    for frame in range(3):
        write_triangle(tmp_path, f"s_{frame}.obj", 1 + 2 * frame)
    body = write(tmp_path, "body.obj", "o B\nv 1 1 0\nv 2 1 2\nv 1 2 2\nv 1 1 9\nf 1 2 3\nf 1 3 4\n")
    read = cscd.read(body, objects={"shirt": (shirt, tmp_path / "s_%d.obj"), "floor": floor}, obstacles=["floor"])
    assert isinstance(read.mesh, cscd.Scene) and read.mesh.vertex_counts == [4, 3, 3]
    assert read.object_names == ["body", "shirt", "floor"] and read.mesh.face_count == 4
    assert read.mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3], [4, 5, 6], [7, 8, 9]]
    assert read.file_vertices.tolist() == [0, 1, 2, 3, 0, 1, 2, 0, 1, 2]
    assert [frame[4, 2] for frame in read.frames] == [1, 3, 5] and [frame[7, 2] for frame in read.frames] == [5] * 3
    assert read.part_names == ["body/B", "body", "shirt/T", "shirt", "floor/T", "floor"]
    assert read.part_labels.tolist() == [0, 0, 2, 4]
    assert len(cscd.self_intersections(read.frames[0], read.mesh).pairs) > 0


def test_parts(tmp_path: Path) -> None:
    table = write(tmp_path, "parts.csv", "face,name\n0,Left Arm\n1,Right#2\n")
    read = cscd.read(write(tmp_path, "split.obj", SPLIT), parts=table)
    assert read.part_names == ["Left Arm", "Right#2"] and read.part_labels.tolist() == [0, 1]


def write_boxes(folder: Path) -> Path:
    """A crate that has sunk 0.25 into a slab. Both are of steel, but for the side above of the crate."""
    quads = ((1, 3, 4, 2), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6), (5, 6, 8, 7))
    text = ""
    for name, first, low, high, above in (("slab", 0, (0, 0, 0), (2, 2, 1), "Brushed Steel"),
                                          ("crate", 8, (0.5, 0.5, 0.75), (1.5, 1.5, 2), "Glass")):
        corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
        text += f"o {name}\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "usemtl Brushed Steel\n"
        for quad in quads:
            text += f"usemtl {above}\n" if quad[0] == 5 else ""
            text += "f " + " ".join(str(first + corner) for corner in quad) + "\n"
    return write(folder, "boxes.obj", text)


def test_parts_by(tmp_path: Path) -> None:
    path = write_boxes(tmp_path)
    plain, material = cscd.read(path), cscd.read(path, parts_by="material")
    assert plain.part_names == cscd.read(path, parts_by="object").part_names == ["slab", "crate"]
    assert material.part_names == ["Brushed Steel", "Glass"]
    assert material.part_labels.tolist() == [0] * 22 + [1] * 2
    assert plain.body_labels is None and material.body_labels is not None
    assert material.body_labels.tolist() == plain.part_labels.tolist()
    found = cscd.self_intersections(material.vertices, material.mesh)
    by_object = found.by_parts(plain.part_labels)
    by_material = found.by_parts(material.part_labels, bodies=material.body_labels)
    assert by_object.depth.max() == pytest.approx(0.25) and by_material.depth.max() == by_object.depth.max()
    assert (by_material.a.tolist(), by_material.b.tolist()) == ([0], [0])
    assert found.by_parts(material.part_labels).depth.max() > 0.3  # one body: the slab's side above is within it
    assert found.by_parts(plain.part_labels).depth.tolist() == by_object.depth.tolist()
    run = cscd.replay([material.vertices], material.mesh, parts=material.part_labels, bodies=material.body_labels)
    assert [frame.intersections.part_pairs.depth.max() for frame in run] == [by_object.depth.max()]
    with pytest.raises(ValueError, match="no line 'g' names a group of its faces"):
        cscd.read(path, parts_by="group")


def test_gaps(tmp_path: Path) -> None:
    model = write_triangle(tmp_path, "f_1.obj", 0)
    for number in (2, 4):
        write_triangle(tmp_path, f"f_{number}.obj", number)
    pattern = tmp_path / "f_%d.obj"
    with pytest.raises(ValueError, match="f_3.obj"):
        cscd.read(model, pattern)
    assert cscd.read(model, pattern, allow_gaps=True).frame_numbers == [1, 2, 4]


@pytest.mark.parametrize("options, text", [
    ({"weld": "x"}, "weld: expected 'exact', 'none' or a distance above 0, got 'x'"),
    ({"weld": -1.0}, "weld: "),
    ({"weld": np.nan}, "weld: "),
    ({"parts_by": "node"}, "parts_by: expected 'object', 'group' or 'material', got 'node'"),
    ({"parts_by": "material"}, "no line 'usemtl' names a material of its faces"),
    ({"parts_by": "object", "parts": "split.obj"}, "parts and parts_by both say what the parts are"),
    ({"obstacles": ["floor"]}, "obstacles: 'floor' is no object"),
    ({"objects": {"a:b": "split.obj"}}, "objects: a name has"),
    ({"objects": {"": "split.obj"}}, "objects: a name has"),
    ({"objects": {"x" * 64: "split.obj"}}, "objects: a name has"),
    ({"objects": {"split": "split.obj"}}, "two objects are called split"),
    ({"objects": {"a": ("split.obj", None, 1)}}, "a path, or a path and frames"),
    ({"animation": "Walk", "frames": "split.obj"}, ""),
])
def test_wrong_options(tmp_path: Path, monkeypatch: Any, options: Dict[str, Any], text: str) -> None:
    monkeypatch.chdir(tmp_path)
    write(tmp_path, "split.obj", SPLIT)
    if not text:
        assert len(cscd.read("split.obj", **options).frames) == 1  # of a glTF file alone
        return
    with pytest.raises(ValueError) as raised:
        cscd.read("split.obj", **options)
    assert text in str(raised.value)


def test_missing_files(tmp_path: Path) -> None:
    model = write(tmp_path, "split.obj", SPLIT)
    with pytest.raises(FileNotFoundError):
        cscd.read(model, objects={"a": tmp_path / "nowhere.obj"})
    with pytest.raises(ValueError, match="nowhere.csv"):
        cscd.read(model, parts=tmp_path / "nowhere.csv")
