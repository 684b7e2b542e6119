"""The first line of an answer about what was untangled, as the command `cscd untangle` says it. It needs no Blender."""

from __future__ import annotations

from typing import Any, Sequence


def _plural(count: int, one: str, many: str) -> str:
    return f"{count} {one if count == 1 else many}"


def _pairs(pairs: int, near: int) -> str:
    return _plural(pairs, "pair", "pairs") + (f" and {near} that are too near" if near > 0 else "")


def _moves(found: Any) -> str:
    deep = f" (the parts were {found.thickness:.3g} in each other)" if found.thickness > 0.0 else ""
    return f"{_plural(found.moved_vertices, 'vertex', 'vertices')} moved, at most {found.displacement:.3g}{deep}"


def _of_one(found: Any) -> str:
    before = _pairs(found.pairs_before, found.near_before)
    if found.clean and not found.moved:
        return "Clean: no two triangles cross or touch; nothing was moved."
    if not found.moved:
        return f"Not clean: {before} before and after; nothing better was found, so nothing was moved."
    after = "none" if found.clean else _pairs(found.pairs_after, found.near_after)
    return f"{'Clean' if found.clean else 'Not clean'}: {before} before, {after} after; {_moves(found)}."


def _of_frames(crossed: int, left: int) -> str:
    if left > 0:
        return f"Not clean: {left} of {crossed} frames that crossed or touched"
    if crossed == 1:
        return "Clean: the one frame that crossed or touched"
    return f"Clean: all {crossed} frames that crossed or touched"


def say_untangled(numbers: Sequence[int], results: Sequence[Any]) -> str:
    """What has become of the frames of these numbers: results as of ``cscd.untangle``, one each."""
    if len(results) == 1:
        return _of_one(results[0])
    span = f"of frames {numbers[0]} to {numbers[-1]}"
    crossed = sum(found.moved or not found.clean for found in results)
    if crossed == 0:
        return f"Clean: {span} none crosses or touches; nothing was moved."
    worst = max(range(len(results)), key=lambda i: float(results[i].displacement))
    what = f"{_of_frames(crossed, sum(not found.clean for found in results))}, {span}"
    if not results[worst].moved:
        return f"{what}; nothing was moved."
    return f"{what}; {_moves(results[worst])} in frame {numbers[worst]}."
