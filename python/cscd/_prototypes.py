"""The functions of python/native that Python calls, with their types. Those of the public headers are in ``_api``."""

from __future__ import annotations

from ctypes import (POINTER, c_bool, c_char, c_char_p, c_double, c_int, c_size_t, c_uint32, c_uint64, c_void_p, py_object)
from typing import Any, Dict, List, Tuple

__all__ = ["PROTOTYPES"]

_p, _u32, _u64, _size, _f64, _status = c_void_p, c_uint32, c_uint64, c_size_t, c_double, c_uint32

_LAYER: Dict[str, Tuple[Any, List[Any]]] = {
    "cscdpy_set_interpreter": (c_bool, [_p, _size]),
    "cscdpy_copy": (None, [_p, _p, _size]),
    "cscdpy_struct": (c_char_p, [_size, POINTER(c_size_t), POINTER(c_size_t)]),
    "cscdpy_member": (c_char_p, [_size, _size, POINTER(c_size_t), POINTER(c_char)]),
    "cscdpy_host_create": (_status, [_u32, _u32, _p, _p, _p, _size, POINTER(c_void_p)]),
    "cscdpy_host_release": (None, [_p]),
    "cscdpy_host_lose": (None, [_p]),
    "cscdpy_keep": (py_object, [_p, _p, POINTER(c_void_p)]),
    "cscdpy_host_detail": (c_char_p, [_p]),
    "cscdpy_host_cancel": (None, [_p]),
    "cscdpy_host_bytes": (_size, [_p]),
    "cscdpy_host_thread_count": (_u32, [_p]),
    "cscdpy_host_is_busy": (c_bool, [_p]),
    "cscdpy_ignore": (c_bool, [_p, _u32, _u32, _u32]),
    "cscdpy_polygons_cut": (c_bool, [_p, _u32, _p, _p, _size, POINTER(c_void_p), _p]),
    "cscdpy_polygons_count": (_u32, [_p]),
    "cscdpy_polygons_copy": (None, [_p, _p, _p]),
    "cscdpy_polygons_free": (None, [_p]),
    "cscdpy_left_out_create": (c_bool, [_p, _p, _u32, POINTER(c_void_p), _p]),
    "cscdpy_left_out_destroy": (None, [_p]),
    "cscdpy_left_out_add_parts": (c_bool, [_p, _u32, _u32]),
    "cscdpy_left_out_add_rest": (c_bool, [_p, _p, c_bool]),
    "cscdpy_left_out_choose": (None, [_p, _p]),
    "cscdpy_left_out_show": (c_bool, [_p, _p]),
    "cscdpy_choose_events": (c_bool, [_p, _p]),
    "cscdpy_recording_open": (c_bool, [_p, POINTER(c_void_p), _p]),
    "cscdpy_recording_close": (None, [_p]),
    "cscdpy_recording_mesh": (_p, [_p]),
    "cscdpy_recording_frame_count": (_u32, [_p]),
    "cscdpy_recording_fps": (_f64, [_p]),
    "cscdpy_recording_copy": (None, [_p, _p, _p, _p, _p]),
    "cscdpy_recording_copy_bodies": (c_bool, [_p, _p]),
    "cscdpy_recording_object_count": (_u32, [_p]),
    "cscdpy_recording_object": (c_char_p, [_p, _u32, _p]),
    "cscdpy_recording_part_count": (_u32, [_p]),
    "cscdpy_recording_part_name": (c_char_p, [_p, _u32]),
    "cscdpy_recording_read": (c_bool, [_p, _u32, _p, _p]),
    "cscdpy_plan_read": (c_bool, [c_char_p, _p, POINTER(c_void_p), _p]),
    "cscdpy_plan_write": (c_bool, [c_char_p, _p, _p, _p, _p]),
    "cscdpy_mesh_read": (c_bool, [c_char_p, POINTER(c_void_p), _p]),
    "cscdpy_mesh_vertex_count": (_u32, [_p]),
    "cscdpy_mesh_copy_positions": (None, [_p, _p]),
    "cscdpy_run_tool": (c_int, [c_int, _p]),
    "cscdpy_mesh_component": (None, [_p, _u32, _p]),
    "cscdpy_tet_surface_get": (None, [_p, _p]),
    "cscdpy_plan_describe": (None, [_p, _p]),
    "cscdpy_plan_compared": (None, [_p, _u32, _p]),
    "cscdpy_plan_region": (None, [_p, _u32, _p]),
    "cscdpy_detector_guarantee": (None, [_p, _u32, _p]),
    "cscdpy_detector_timings": (None, [_p, _p]),
    "cscdpy_detector_counters": (None, [_p, _p]),
}

# All of these end with a status, and begin with a host.
_CALLS: Dict[str, List[Any]] = {
    "mesh_create": [_p, _u32, POINTER(c_void_p)],
    "tet_surface_create": [_p, _size, _u32, POINTER(c_void_p)],
    "plan_create": [_p, _p, _p, POINTER(c_void_p)],
    "plan_create_from_parts": [_p, _p, _p, POINTER(c_void_p)],
    "detector_create": [_p, _p, _p, POINTER(c_void_p)],
    "tracker_create": [_p, _p, POINTER(c_void_p)],
    "detector_step": [_p, _p, _p, _p],
    "detector_find_intersections": [_p, _p, _p, _p],
    "detector_overlap_volumes": [_p, _p, _p, _p],
    "detector_curve_lengths": [_p, _p, _p, _p],
    "detector_find_near": [_p, _p, _f64, _u32, _p],
    "detector_max_step": [_p, _p, _p, _p, _p],
    "detector_displacement_bounds": [_p, _p, _f64, _u32, _p, _size, _p],
    "detector_truncate": [_p, _p, _p, _f64, _p, _p],
    "detector_make_safe": [_p, _p, _p, _p, _p, _p],
    "detector_find_lenses": [_p, _p, _p, _p],
    "detector_untangle": [_p, _p, _p, _p, _p],
    "detector_contact_parts": [_p, _p, _size, _p],
    "detector_set_rest": [_p, _p],
    "line_search_begin": [_p, _p, _p, _f64],
    "line_search_candidates": [_p, _p],
    "line_search_positions": [_p, _f64, _p],
    "line_search_max_step": [_p, _f64, _p, _p],
    "line_search_find_near": [_p, _f64, _f64, _u32, _p],
    "energy_create": [_p, POINTER(c_void_p)],
    "energy_make_pattern": [_p, _p, _p, _p],
    "energy_evaluate": [_p, _p, _p, _p, _p, _p],
    "energy_freeze_friction": [_p, _p, _p, _p],
    "energy_evaluate_friction": [_p, _p, _p, _p, _p],
    "pairs_step": [_p, _p, _p, _f64, _f64, _p],
    "pairs_find_near": [_p, _p, _f64, _p],
    "tracker_add_contacts": [_p, _p, _size],
    "tracker_add_frame": [_p, _u64, _p],
    "tracker_take": [_p, _p],
    "tracker_finish": [_p, _p],
}

#: By name: the type of the result, and those of the arguments.
PROTOTYPES: Dict[str, Tuple[Any, List[Any]]] = {
    **_LAYER, **{f"cscdpy_{name}": (_status, [_p, *arguments]) for name, arguments in _CALLS.items()}}
