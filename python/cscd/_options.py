"""The options of a detector, from Python's names to the struct of the library."""

from __future__ import annotations

import ctypes
from typing import Any, Dict, List, Optional

import numpy as np

from ._arrays import as_floats, as_indices, count_of, number_of
from ._host import DETECTOR_STEPS, Handle, Host, code_of, ours_of
from ._library import address_of, library, new_struct, structs
from .mesh import Mesh

__all__ = ["DetectorOptions", "in_python", "matrix_of", "rules_of"]

Array = Any

_STARTS = {"prove": 0, "vouched": 1, "unknown": 2}
_COHERENCES = {"auto": 0, "off": 1}
_DEFAULT_RULE = {"category": 1, "mask": 2**64 - 1, "thickness": 0.0, "thickness_class": 0, "self": True,
                 "obstacle_pairs": False}


class DetectorOptions:
    """The struct, and the arrays that it points to."""

    def __init__(self, mesh: Mesh, inputs: Dict[str, Any], host: Host, has_ignore: bool,
                 left_out: Optional[Handle]) -> None:
        self._struct = new_struct("detector_options")
        self._kept: List[Array] = []
        library.cscd_detector_defaults_sized(address_of(self._struct), self._struct.nbytes)
        for name in ("method", "mode", "volume"):
            self._struct[name] = code_of(name, inputs[name])
        if inputs["start"] not in _STARTS:
            raise ValueError(f"start: expected one of {', '.join(_STARTS)}; got {inputs['start']!r}")
        self._struct["start"] = _STARTS[inputs["start"]]
        if inputs["coherence"] not in _COHERENCES:
            raise ValueError(f"coherence: expected one of {', '.join(_COHERENCES)}; got {inputs['coherence']!r}")
        self._struct["coherence"] = _COHERENCES[inputs["coherence"]]
        self._struct["ours"] = ours_of(inputs["ours"], DETECTOR_STEPS)
        for name in ("min_separation", "tolerance", "step_factor", "floor_ratio", "seam_reach", "longest_list"):
            self._set_number(name, inputs[name])
        self._set_pairs("seams", "seam_count", inputs["seams"], mesh.vertex_count, "vertices")
        self._set_pairs("ignored", "ignored_count", inputs["ignored"], mesh.triangle_count, "triangles")
        self._set_rules(mesh, inputs["rules"], inputs["thickness_matrix"])
        if has_ignore:
            self._struct["ignore"] = ctypes.cast(library.cscdpy_ignore, ctypes.c_void_p).value
            self._struct["ignore_user"] = host.handle
        if left_out is not None:
            library.cscdpy_left_out_choose(left_out.pointer, self.address)

    @property
    def address(self) -> int:
        return address_of(self._struct)

    def _keep(self, member: str, array: Array) -> None:
        self._kept.append(array)
        self._struct[member] = address_of(array)

    def _set_number(self, name: str, value: Any) -> None:
        self._struct[name] = count_of(name, value) if name == "longest_list" else number_of(name, value)

    def _set_pairs(self, member: str, count: str, values: Any, limit: int, of_what: str) -> None:
        if values is None:
            return
        array = as_indices(member, values, 2, limit, of_what)
        if len(array):
            self._keep(member, array)
            self._struct[count] = len(array)

    def _set_rules(self, mesh: Mesh, rules: Any, matrix: Any) -> None:
        if rules is not None:
            self._keep("rules", rules_of(mesh, rules))
            self._struct["rule_count"] = mesh.object_count
        if matrix is not None:
            lengths = matrix_of(matrix)
            self._keep("thickness_matrix", lengths)
            self._struct["thickness_class_count"] = len(lengths)


#: The names that sentences of the library have for things that have other names here.
_PYTHON_NAMES = (("call cscd_detector_set_longest_list", "call set_longest_list"), ("cscd_detector_", ""),
                 ("cscd_line_search_", ""))


def in_python(sentence: str, positions: str) -> str:
    """A sentence of the library, with the names of Python; ``positions``: what the caller calls these."""
    if sentence.startswith("positions: "):
        sentence = positions + sentence[len("positions"):]
    for c_name, name in _PYTHON_NAMES:
        sentence = sentence.replace(c_name, name)
    return sentence


def flag_of(name: str, value: Any) -> bool:
    """True or false."""
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name}: expected True or False, got {value!r}")
    return bool(value)


def matrix_of(matrix: Any) -> Array:
    """A thickness matrix, packed."""
    lengths = np.ascontiguousarray(as_floats("thickness_matrix", matrix, "a square array of lengths"), np.float64)
    if lengths.ndim != 2 or lengths.shape[0] != lengths.shape[1]:
        raise ValueError(f"thickness_matrix: expected a square array of lengths, got shape {lengths.shape}")
    return lengths


def rules_of(mesh: Mesh, rules: Any) -> Array:
    """One record of rules for each object."""
    if len(rules) != mesh.object_count:
        raise ValueError(f"rules: expected one for each of {mesh.object_count} objects, got {len(rules)}")
    found = new_struct("object_rule", len(rules))
    for i, rule in enumerate(rules):
        unknown = set(rule) - set(_DEFAULT_RULE)
        if unknown:
            raise ValueError(f"rules[{i}]: {sorted(unknown)[0]!r} is none of {', '.join(_DEFAULT_RULE)}")
        for name, value in {**_DEFAULT_RULE, **rule}.items():
            member = structs["object_rule"][name]
            called = f"rules[{i}]: {name}"
            if member.kind == "f":
                found[i][name] = number_of(called, value)
            elif member.kind == "b":
                found[i][name] = flag_of(called, value)
            else:
                found[i][name] = count_of(called, value, int(np.iinfo(member).max))
    return found
