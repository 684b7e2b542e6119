"""The line that the Blender extension says of what it untangled; it is that of `cscd untangle`. No Blender is needed."""
import importlib.util
from pathlib import Path
from types import SimpleNamespace

PATH = Path(__file__).parents[2] / "blender" / "cscd_blender" / "sentences.py"
SPEC = importlib.util.spec_from_file_location("sentences", PATH)
assert SPEC is not None and SPEC.loader is not None
sentences = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(sentences)


def found(before, after, moved=0, most=0.0, deep=0.0, near=(0, 0)):
    return SimpleNamespace(pairs_before=before, pairs_after=after, near_before=near[0], near_after=near[1], moved=moved > 0,
                           moved_vertices=moved, displacement=most, thickness=deep, clean=after + near[1] == 0)


def say(*results, first=1):
    return sentences.say_untangled(range(first, first + len(results)), results)


def test_one_frame():
    assert say(found(0, 0)) == "Clean: no two triangles cross or touch; nothing was moved."
    assert say(found(346, 0, 412, 0.00312, 0.00481)) == (
        "Clean: 346 pairs before, none after; 412 vertices moved, at most 0.00312 (the parts were 0.00481 in each other).")
    assert say(found(1, 0, 1, 0.5)) == "Clean: 1 pair before, none after; 1 vertex moved, at most 0.5."
    assert say(found(9, 4, 7, 0.5)) == "Not clean: 9 pairs before, 4 pairs after; 7 vertices moved, at most 0.5."
    assert say(found(9, 9)) == "Not clean: 9 pairs before and after; nothing better was found, so nothing was moved."
    assert say(found(0, 0, 3, 0.5, near=(12, 0))) == (
        "Clean: 0 pairs and 12 that are too near before, none after; 3 vertices moved, at most 0.5.")


def test_several_frames():
    assert say(found(0, 0), found(0, 0), first=4) == "Clean: of frames 4 to 5 none crosses or touches; nothing was moved."
    assert say(found(0, 0), found(5, 0, 7, 0.1), found(9, 0, 3, 0.25, 0.5)) == (
        "Clean: all 2 frames that crossed or touched, of frames 1 to 3; 3 vertices moved, at most 0.25 "
        "(the parts were 0.5 in each other) in frame 3.")
    assert say(found(5, 5), found(9, 0, 3, 0.25)) == (
        "Not clean: 1 of 2 frames that crossed or touched, of frames 1 to 2; 3 vertices moved, at most 0.25 in frame 2.")
    assert say(found(5, 5), found(0, 0)) == (
        "Not clean: 1 of 1 frames that crossed or touched, of frames 1 to 2; nothing was moved.")


def test_the_only_frame_that_crossed():
    assert say(found(0, 0), found(5, 0, 7, 0.1)) == (
        "Clean: the one frame that crossed or touched, of frames 1 to 2; 7 vertices moved, at most 0.1 in frame 2.")
