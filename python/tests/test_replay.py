"""cscd.replay on the figure of models/mannequin finds what the tool writes of the same files with the same options."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any, Dict, Iterator, List, Tuple

import numpy as np
import pytest

import cscd
import oracle

Found = Tuple[Dict[str, Any], Dict[str, Any], List[Dict[str, Any]]]
# Options of the tool, and the same of cscd.replay.
OPTIONS: Dict[str, Tuple[List[str], Dict[str, Any]]] = {
    "all": ([], {}),
    "rest pairs": (["--ignore-rest"], {"ignore_rest": "pairs"}),
    "rest parts": (["--ignore-rest=parts"], {"ignore_rest": "parts"}),
    "some parts": (["--ignore-parts=Trunk,Arm.L", "--ignore-parts=Head,Eye.R"],
                   {"ignore_parts": [("Trunk", "Arm.L"), ("Head", "Eye.R")]}),
}


@pytest.fixture(scope="module")
def figure(tmp_path_factory: Any) -> Iterator[Path]:
    """The folder of the figure: mannequin.obj, mannequin.pc2, mannequin.glb."""
    folder = tmp_path_factory.mktemp("figure")
    program = os.path.join(oracle.BUILD, "models", "mannequin")
    subprocess.run([program, folder, "cache", "skin"], check=True, stdout=subprocess.DEVNULL)
    yield folder


def run_tool(folder: Path, model: str, frames: List[str], options: List[str]) -> Found:
    """The JSON of check and of replay, and the list of contacts."""
    def run(command: str, *outputs: str) -> Dict[str, Any]:
        words = [command, model, *frames, *options, "--quiet", "--json", "found.json", *outputs]
        package = os.path.dirname(os.path.dirname(cscd.__file__))
        done = subprocess.run([sys.executable, "-m", "cscd", *words], cwd=folder, env={**os.environ, "PYTHONPATH": package})
        assert done.returncode == 0
        found: Dict[str, Any] = json.loads((folder / "found.json").read_text())
        return found

    checked, replayed = run("check"), run("replay", "--contacts", "contacts.jsonl")
    lines = (folder / "contacts.jsonl").read_text().splitlines()
    return checked, replayed, [json.loads(line) for line in lines]


def compare_event(event: Any, kinds: Tuple[str, ...], known: Dict[str, Any], names: List[str]) -> None:
    """An event is the same as the tool has it."""
    assert [names[event.a], names[event.b]] == [known["a"], known["b"]] and list(kinds) == known["kinds"]
    assert [event.first_frame, event.last_frame, event.worst_frame] == [known["first"], known["last"], known["worst"]]
    assert [event.pairs, event.contacts, event.triangle] == [known["pairs"], known["contacts"], known["triangle"]]
    assert event.depth == (known["depth"] or 0.0) and event.length == (known["length"] or 0.0)
    assert known["point"] is None or event.x.tolist() == known["point"]


def corners_of(mesh: cscd.Mesh, kind: int, feature: int, is_a: bool) -> List[int]:
    """The vertices of a feature of a contact, ascending."""
    if kind == 1:
        return sorted(mesh.edges[feature].tolist())
    return [feature] if is_a else sorted(mesh.triangles[feature].tolist())


def compare_contacts(mesh: cscd.Mesh, found: List[Any], known: List[Dict[str, Any]]) -> None:
    """The contacts of all intervals are the same, in the same order."""
    assert len(found) == len(known) > 0
    for (frame, contact), line in zip(found, known):
        assert [frame, cscd.CONTACT_KINDS[contact.kind]] == [line["frame"], line["kind"]]
        assert corners_of(mesh, contact.kind, contact.a, True) == sorted(line["a"])
        assert corners_of(mesh, contact.kind, contact.b, False) == sorted(line["b"])
        assert [contact.toi, contact.u, contact.v] == [line["toi"], line["u"], line["v"]]
        assert contact.point.tolist() == line["point"] and contact.normal.tolist() == line["normal"]


@pytest.mark.parametrize("options", OPTIONS)
@pytest.mark.parametrize("model", ["mannequin.obj", "mannequin.glb"])
def test_replay_equals_the_tool(figure: Path, model: str, options: str) -> None:
    """Events, pairs and their kinds, contacts and depths, frame by frame, to the last bit."""
    words, ours = OPTIONS[options]
    files = ["mannequin.pc2" if model.endswith("obj") else model]
    checked, replayed, lines = run_tool(figure, model, files, words)
    recording = cscd.read(figure / model, *(figure / name for name in files))
    names, mesh = recording.part_names, recording.mesh
    ours = {key: [[names.index(a), names.index(b)] for a, b in value] if key == "ignore_parts" else value
            for key, value in ours.items()}
    run = cscd.replay(recording.frames, mesh, parts=recording.part_labels, **ours)
    contacts = []
    for frame, of_check, of_replay in zip(run, checked["frames"], replayed["frames"]):
        found = frame.intersections
        assert frame.number == of_check["frame"] == of_replay["frame"]
        assert found.pairs.tolist() == of_check["pairs"]
        assert found.kind_names() == of_check["kinds"]
        assert found.max_depth == of_check["depth"] == of_replay["depth"]
        contacts += [(frame.number - 1, contact) for contact in frame.contacts]
    assert next(run, None) is None and len(checked["frames"]) == len(recording.frames) == 48
    compare_contacts(mesh, contacts, lines)
    assert len(run.events) == len(replayed["events"]) > 1
    for event, kinds, known in zip(run.events, run.events.kind_names(), replayed["events"]):
        compare_event(event, kinds, known, names)


def test_scene_of_meshes_has_the_same_events(figure: Path) -> None:
    """The parts as objects of a scene: its triangles are numbered object by object, and the events are the same."""
    recording = cscd.read(figure / "mannequin.obj", figure / "mannequin.pc2")
    labels, whole = recording.part_labels, recording.mesh
    part_count = len(recording.part_names)
    meshes, corners = [], []
    for part in range(part_count):
        vertices, local = np.unique(whole.triangles[labels == part], return_inverse=True)
        corners.append(vertices)
        meshes.append(cscd.Mesh(local.reshape(-1, 3), len(vertices)))
    scene = cscd.Scene(meshes)
    first = np.cumsum([0] + [mesh.triangle_count for mesh in meshes])
    number = np.concatenate([np.flatnonzero(labels == part) for part in range(part_count)])
    for part, mesh in enumerate(meshes):
        moved = mesh.triangles + sum(map(len, corners[:part]))
        assert np.array_equal(scene.triangles[first[part]:first[part + 1]], moved)
    assert np.array_equal(scene.triangle_objects, labels[number])

    frames = recording.frames[15:26]
    ours = cscd.replay(([x[vertices] for vertices in corners] for x in frames), scene)
    theirs = cscd.replay(frames, whole, parts=labels)
    found = 0
    for a, b in zip(ours, theirs):
        pairs = np.sort(number[a.intersections.pairs], axis=1)
        assert np.array_equal(pairs[np.lexsort(pairs.T[::-1])], b.intersections.pairs)
        assert len(a.contacts) == len(b.contacts)
        found += len(pairs)
    assert found > 100 and next(ours, None) is None and next(theirs, None) is None
    for name in ("a", "b", "first_frame", "last_frame", "kinds", "pairs", "contacts"):  # depths are those within an object
        assert np.array_equal(np.sort(ours.events[name]), np.sort(theirs.events[name])), name


def test_too_many_parts() -> None:
    """The sentence says how many there are, and how many there may be."""
    count = 8193
    V = np.tile([[0., 0, 0], [1, 0, 0], [0, 1, 0]], (count, 1)) + np.repeat(np.arange(count) * 2., 3)[:, None]
    F = np.arange(3 * count).reshape(-1, 3)
    for options in ({"ignore_parts": [(0, 1)]}, {"ignore_rest": "parts"}):
        replay = cscd.replay([np.concatenate([V[:3], V[:-3]]) if "ignore_rest" in options else V], F,
                             parts=np.arange(count), depths=False, **options)
        with pytest.raises(ValueError, match="ignore_[a-z]*: expected at most 8192 parts, got 8193"):
            list(replay)


def test_report_calls_frames_by_their_numbers(tmp_path: Path) -> None:
    """A plate that comes down on another one, in frames that are called -3, 2 and 9."""
    square, F = np.array([[0., 0, 0], [1, 0, 0], [0, 1, 0]]), [[0, 1, 2], [3, 4, 5]]
    frames = [np.concatenate([square, square[:, [2, 0, 1]] + [0.2, 0.2, z]]) for z in (3., 2., -0.5)]
    page = tmp_path / "page.html"
    assert "Frame 9 crosses (1 of 3)" in cscd.write_report(page, frames, F, frame_numbers=[-3, 2, 9])
    assert "Frame 2 crosses (1 of 3)" in cscd.write_report(page, frames, F)
    for wrong in ([0, 1], [0, 1, 2, 3], [], [2, 1, 0], [1, 1, 2]):
        with pytest.raises(ValueError, match="frame_numbers: expected"):
            cscd.write_report(page, frames, F, frame_numbers=wrong)


def test_report_of_a_program_that_embeds_python(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Its executable is no Python, or nobody knows it."""
    V, F = [[0., 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
    for executable in ("", "/bin/false"):
        monkeypatch.setattr(sys, "executable", executable)
        assert "No frame crosses" in cscd.write_report(tmp_path / "page.html", [V, V], F)
        assert (tmp_path / "page.html").stat().st_size > 10**5
    with pytest.raises(ValueError, match="frames: expected two at least, got 1"):
        cscd.write_report(tmp_path / "page.html", [V], F)


# ---- misuse -----------------------------------------------------------------------------------------------------------

BELOW = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
FALLING = [np.array(BELOW + [[1, 1, z], [1, 1, z + 1], [2, 1, z + 1]]) for z in (0.5, -0.5, -0.25, -2.0)]
TWO = np.array([[0, 1, 2], [3, 4, 5]])


def sheets(count: int) -> Tuple[List[Any], Any]:
    """Frames of a rough sheet that moves through another one, whose search takes some ten milliseconds each."""
    corner = np.arange(100 * 100).reshape(100, 100)
    faces = np.concatenate([np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:]], -1).reshape(-1, 3),
                            np.stack([corner[:-1, :-1], corner[1:, 1:], corner[:-1, 1:]], -1).reshape(-1, 3)])
    grid = np.stack(np.meshgrid(np.arange(100.0), np.arange(100.0), indexing="ij"), -1).reshape(-1, 2)
    height = np.random.default_rng(1).uniform(-0.3, 0.3, (2, len(grid)))
    frames = [np.concatenate([np.column_stack([grid, height[0]]), np.column_stack([grid, height[1] + 0.2 * i])])
              for i in range(count)]
    return frames, np.concatenate([faces, faces + corner.size])


def test_sums_of_a_frame_change_nothing() -> None:
    """by_parts of a frame, by other labels, leaves the parts of the replay as they are."""
    def run(asks: bool) -> Any:
        replay = cscd.replay(FALLING, TWO, parts=[0, 1])
        sums = []
        for frame in replay:
            if asks:
                frame.intersections.by_parts([0, 0])
            sums.append(frame.intersections.part_pairs)
        return [[sum.a.tolist(), sum.b.tolist(), sum.crossing.tolist()] for sum in sums], replay.events.tobytes()

    assert run(True) == run(False) and run(True)[0][1] == [[0], [1], [1]]
    detector = cscd.Detector(TWO)
    detector.set_parts([1, 0])
    found = detector.find_intersections(FALLING[1])
    assert found.by_parts([0, 0]).b.tolist() == [0]
    assert detector._labels is not None and detector._labels[0].tolist() == [1, 0]
    with pytest.raises(ValueError, match="^labels: "):
        found.by_parts([0])


def test_replay_from_its_own_callback() -> None:
    """The next frame cannot be asked for in the middle of one; nothing is lost by the attempt."""
    frames, faces = sheets(3)
    refused = []

    def progress(stage: str, fraction: float) -> None:
        with pytest.raises(cscd.Error, match="middle of a frame"):
            next(replay)
        refused.append(stage)

    replay = cscd.replay(frames, faces, progress=progress)
    assert [frame.number for frame in replay] == [0, 1, 2] and refused


@pytest.mark.parametrize("raised", [KeyError, KeyboardInterrupt, StopIteration])
def test_replay_after_an_exception(raised: Any) -> None:
    """It has ended, and says so, where it gave the frames after the lost one the numbers of those before."""
    frames, faces = sheets(4)
    calls = []

    def progress(stage: str, fraction: float) -> None:
        calls.append(stage)
        if len(found) == 1:
            raise raised("stop")

    found: List[int] = []
    replay = cscd.replay(frames, faces, progress=progress)
    with pytest.raises(RuntimeError if raised is StopIteration else raised):
        while True:
            found.append(next(replay).number)
    assert found == [0] and calls
    for _ in range(2):
        with pytest.raises(cscd.Error, match=rf"ended in frames\[1\], by {raised.__name__}"):
            next(replay)


def test_replay_from_several_threads() -> None:
    """Each frame goes to one of them, and frames answer meanwhile."""
    frames, faces = sheets(6)
    replay = cscd.replay(frames, faces, depths=False)
    truth = [len(frame.intersections.curves) for frame in cscd.replay(frames, faces, depths=False)]
    found: Dict[int, int] = {}

    def take() -> None:
        for frame in replay:
            found[frame.number] = len(frame.intersections.curves)

    threads = [threading.Thread(target=take) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [found[i] for i in sorted(found)] == truth and max(truth) > 0


def test_what_a_replay_refuses() -> None:
    """The sentence names the option, or the frame."""
    wrong: Dict[str, List[Any]] = {
        "rings": [-1, 1.7, "x", None, True, 2**40], "gap": [-1, 1.5], "parts": [[0], [0, "a"], [0, -2]],
        "frame_numbers": [[3, 1, 4, 5], [0, 0, 1, 2], [0.5, 1.5, 2.5, 3.5], ["a"], [2**70] * 4, [0]],
        "ignore_parts": [[0.5, 1], [0, 1, 2], [[0, 7]], "ab", [[0, 1, 2]]]}
    for name, values in wrong.items():
        for value in values:
            with pytest.raises(ValueError, match=f"^{name}: "):
                list(cscd.replay(FALLING, TWO, **{"parts": [0, 1], name: value}))
    for frame in (None, [[1.0, 2.0]], FALLING[0] * np.nan):
        for at in (0, 1):
            with pytest.raises(ValueError, match=rf"^frames\[{at}\]: "):
                list(cscd.replay(FALLING[:at] + [frame] + FALLING[at:], TWO))  # type: ignore[list-item]
    for pairs in (iter([(0, 1)]), [0, 1], np.array([[0, 1]], np.uint8)):
        replay = cscd.replay(FALLING, TWO, parts=[0, 1], ignore_parts=pairs, frame_numbers=iter([-3, 2, 5, 7]))
        assert [(frame.number, len(frame.intersections)) for frame in replay] == [(-3, 0), (2, 0), (5, 0), (7, 0)]
