"""Checks a file without a window, as on a farm:

    blender -b shot.blend --python-expr "import cscd_blender.farm as farm; farm.main()" -- --json found.json

prints a sentence, writes JSON, and ends with 0 (nothing crosses), 3 (something does) or 1 (it could not be checked).
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from typing import Any, Dict, List, Optional, Sequence, Tuple

import bpy
import numpy as np

import cscd

from .checking import KINDS, Findings, FoundEvent, FoundFrame, Request, run_to_end
from .scene import SceneError

CLEAN, FAILED, FOUND = 0, 1, 3


def _pair_of(text: str) -> Tuple[str, str]:
    first, comma, second = text.partition(",")
    return first, second if comma else first


def parse_arguments(arguments: Sequence[str]) -> argparse.Namespace:
    """The options behind ``--`` on the command line of Blender."""
    parser = argparse.ArgumentParser(prog="cscd_blender.farm", description="Finds where the objects of a Blender file go "
                                     "through each other and themselves. Ends with 0: clean, 3: something crosses, "
                                     "1: it could not be checked.")
    parser.add_argument("--json", metavar="FILE", help="where the findings are written")
    parser.add_argument("--object", action="append", default=[], metavar="NAME", help="check this object (several times); "
                        "without objects and collections all visible ones")
    parser.add_argument("--collection", action="append", default=[], metavar="NAME", help="check what is in this collection")
    parser.add_argument("--frames", metavar="FIRST:LAST", help="by default those of the scene")
    parser.add_argument("--step", type=int, default=1, metavar="N", help="every N-th frame")
    parser.add_argument("--whole-objects", action="store_true", help="objects are the parts, not their vertex groups")
    parser.add_argument("--ignore", action="append", default=[], type=_pair_of, metavar="A,B", help="leave out these two "
                        "parts, or one with itself; OBJECT stands for all of OBJECT/GROUP (several times)")
    parser.add_argument("--ignore-rest", choices=("pairs", "parts"), help="leave out what meets in the first frame")
    parser.add_argument("--no-depths", action="store_true", help="do not look how deep")
    parser.add_argument("--threads", type=int, default=0, metavar="N", help="0: one per processor")
    return parser.parse_args(arguments)


def request_of(options: argparse.Namespace) -> Request:
    """The request that the options make."""
    first = last = None
    if options.frames is not None:
        try:
            first, last = (int(part) for part in options.frames.split(":"))
        except ValueError:
            raise SceneError(f"--frames {options.frames}: expected two numbers, as in 1:24") from None
    return Request(tuple(options.object), tuple(options.collection), first, last, options.step,
                   not options.whole_objects, tuple(options.ignore), options.ignore_rest, not options.no_depths,
                   options.threads)


def _frame_object(found: FoundFrame) -> Dict[str, Any]:
    counts = np.bincount(found.kinds, minlength=len(KINDS)).tolist()
    return {"frame": found.frame, **{name: counts[i] for i, name in enumerate(KINDS)}, "contacts": found.contact_count,
            "depth": None if found.depth is None else float(found.depth.max(initial=0.0)), "collapsed": list(found.hidden)}


def _event_object(event: FoundEvent) -> Dict[str, Any]:
    return {"a": event.a, "b": event.b, "first": event.first, "last": event.last, "worst": event.worst,
            "kinds": list(event.kinds), "pairs": event.pairs, "contacts": event.contacts, "depth": event.depth,
            "point": None if event.place is None else list(event.place)}


def describe(findings: Findings) -> Dict[str, Any]:
    """The findings as JSON has them; docs/artist/blender.md names the members."""
    checked = findings.checked
    faces = [{target.name: [] for target in checked.targets} for _ in findings.frames]
    for places, found in zip(faces, findings.frames.values()):
        for face in np.unique(found.faces).tolist():
            name, number = checked.place_of(face)
            places[name].append(number)
    return {"file": bpy.data.filepath, "cscd": cscd.__version__,
            "objects": [{"name": target.name, "vertices": target.vertex_count, "faces": target.face_count}
                        for target in checked.targets],
            "parts": findings.parts.names,
            "frames": [{**_frame_object(found), "faces": {name: numbers for name, numbers in places.items() if numbers}}
                       for places, found in zip(faces, findings.frames.values())],
            "events": [_event_object(event) for event in findings.events]}


def _ranges(frames: Sequence[int]) -> str:
    """As in "frame 3", or "frames 1, 3 to 5"."""
    spans: List[List[int]] = []
    for frame in frames:
        if spans and frame == spans[-1][1] + 1:
            spans[-1][1] = frame
        else:
            spans.append([frame, frame])
    said = [f"{first} to {last}" if last > first else f"{first}" for first, last in spans[:6]]
    return f"frame{'s' if len(frames) > 1 else ''} {', '.join(said)}{' and others' if len(spans) > 6 else ''}"


def _without_surface(findings: Findings) -> str:
    """What had no surface, and when, behind a blank; "" if everything had one."""
    frames = list(findings.frames.values())
    empty = [found.frame for found in frames if found.is_empty]
    said = [f" No face has an area in {_ranges(empty)}, so nothing was looked at there."] if empty else []
    hidden = {name: [found.frame for found in frames if name in found.hidden] for name in findings.parts.names}
    more = [name for name, places in hidden.items() if len(places) > len(empty)]
    said += [f" {name} has no surface in {_ranges(hidden[name])}, and was not looked at there." for name in more[:5]]
    if len(more) > 5:
        said.append(f" So it is with {len(more) - 5} other part{'s' if len(more) > 6 else ''}.")
    return "".join(said)


def _left_out(findings: Findings) -> str:
    """What was left out because somebody asked for that, as the tool says it."""
    parts, request = findings.parts, findings.request
    pairs = {(min(a, b), max(a, b)) for first, second in request.ignored for a in parts.find(first) for b in parts.find(second)}
    total = len(parts.names) * (len(parts.names) + 1) // 2
    said = []
    if pairs:
        said.append(f" As asked, {len(pairs)} of {total} pair{'s' if total > 1 else ''} of parts "
                    f"{'was' if len(pairs) == 1 else 'were'} not looked at.")
    if request.ignore_rest is not None:
        what = "parts" if request.ignore_rest == "parts" else "triangles"
        said.append(f" As asked, pairs of {what} that meet in the first frame were not looked at.")
    return "".join(said)


def summarise(findings: Findings) -> str:
    """What was found, as a sentence, and what was not looked at."""
    inside = "" if findings.request.depths else " What lies inside was not looked at."
    return f"{_summarise_events(findings)}{inside}{_left_out(findings)}{_without_surface(findings)}"


def _summarise_events(findings: Findings) -> str:
    total = sum(not found.is_empty for found in findings.frames.values())
    crossing = [found.frame for found in findings.frames.values() if (found.kinds == 0).any()]
    left = " Instances are not checked: make them real (Object > Apply > Make Instances Real)." if findings.left_instances else ""
    if not findings.events:
        return f"Nothing crosses or touches in {total} frame{'' if total == 1 else 's'}.{left}"
    worst = findings.events[0]
    deep = (f", {worst.depth:.3g} deep at frame {worst.worst}" if worst.depth > 0.0
            else ", one solid twice" if "same_solid" in worst.kinds else "")
    when = f"frames {worst.first} to {worst.last}" if worst.last > worst.first else f"frame {worst.first}"
    events = f"{len(findings.events)} event{'s' if len(findings.events) > 1 else ''}"
    return f"{len(crossing)} of {total} frames cross. {events}, worst: {worst.a} x {worst.b}, {when}{deep}.{left}"


def _write_json(path: str, found: Dict[str, Any]) -> None:
    """The file takes the place of an older one when it is whole."""
    beside = f"{path}.{os.getpid()}.part"
    try:
        with open(beside, "w", encoding="utf-8") as file:
            json.dump(found, file, indent=1)
            file.write("\n")
        os.replace(beside, path)
    except OSError:
        if os.path.exists(beside):
            os.remove(beside)
        raise


def check_file(arguments: Sequence[str]) -> int:
    """Checks the file that is open, and returns the exit code."""
    options = parse_arguments(arguments)
    if bpy.context.mode != "OBJECT" and bpy.context.active_object is not None:
        bpy.ops.object.mode_set(mode="OBJECT")  # in edit mode, objects are not as they are rendered
    try:
        findings = run_to_end(bpy.context, request_of(options))
        if options.json is not None:
            _write_json(options.json, describe(findings))
    except (SceneError, OSError, MemoryError, ValueError, cscd.Error) as problem:
        print(f"cscd: {bpy.data.filepath or 'the scene'}: {problem}", file=sys.stderr)
        return FAILED
    print(summarise(findings))
    if findings.events:
        return FOUND
    return FAILED if any(found.is_empty for found in findings.frames.values()) else CLEAN


def main(arguments: Optional[List[str]] = None) -> None:
    """Checks the open file by the options behind ``--``, and ends Blender with the exit code."""
    if arguments is None:
        arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    try:
        code = check_file(arguments)
    except SystemExit as end:  # argparse: 0 for --help, 2 for wrong options
        code = int(end.code or 0) and FAILED
    sys.exit(code)
