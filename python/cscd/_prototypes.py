"""The functions of the compiled library that Python calls, with their types.

Those named ``cscd_...`` are of its public headers (include/cscd), those named ``cscdpy_...`` of python/native.
"""

from __future__ import annotations

from ctypes import (POINTER, c_bool, c_char, c_char_p, c_double, c_int, c_int32, c_size_t, c_uint32, c_uint64, c_void_p,
                    py_object)
from typing import Any, Dict, List, Tuple

__all__ = ["PROTOTYPES"]

_p, _u32, _u64, _size, _f64, _status = c_void_p, c_uint32, c_uint64, c_size_t, c_double, c_uint32

_LAYER: Dict[str, Tuple[Any, List[Any]]] = {
    "cscdpy_set_interpreter": (c_bool, [_p, _size]),
    "cscdpy_copy": (None, [_p, _p, _size]),
    "cscdpy_struct": (c_char_p, [_size, POINTER(c_size_t), POINTER(c_size_t)]),
    "cscdpy_member": (c_char_p, [_size, _size, POINTER(c_size_t), POINTER(c_char)]),
    "cscdpy_host_create": (_status, [_u32, _u32, _p, _p, _p, _size, POINTER(c_void_p)]),
    "cscdpy_host_destroy": (None, [_p]),
    "cscdpy_host_detail": (c_char_p, [_p]),
    "cscdpy_host_cancel": (None, [_p]),
    "cscdpy_host_bytes": (_size, [_p]),
    "cscdpy_host_thread_count": (_u32, [_p]),
    "cscdpy_ignore": (c_bool, [_p, _u32, _u32, _u32]),
    "cscdpy_polygons_cut": (c_bool, [_p, _u32, _p, _p, _size, POINTER(c_void_p), _p]),
    "cscdpy_polygons_count": (_u32, [_p]),
    "cscdpy_polygons_copy": (None, [_p, _p, _p]),
    "cscdpy_polygons_free": (None, [_p]),
}

# All of these end with a status, and begin with a host.
_CALLS: Dict[str, List[Any]] = {
    "mesh_create": [_p, _u32, POINTER(c_void_p)],
    "plan_create": [_p, _p, _p, POINTER(c_void_p)],
    "plan_create_from_parts": [_p, _p, _p, POINTER(c_void_p)],
    "detector_create": [_p, _p, _p, POINTER(c_void_p)],
    "tracker_create": [_p, _p, POINTER(c_void_p)],
    "detector_step": [_p, _p, _p, _p],
    "detector_check": [_p, _p, _p],
    "detector_find_intersections": [_p, _p, _p, _p],
    "detector_find_near": [_p, _p, _f64, _u32, _p],
    "detector_max_step": [_p, _p, _p, _p, _p],
    "detector_displacement_bounds": [_p, _p, _f64, _u32, _p, _size, _p],
    "detector_truncate": [_p, _p, _p, _f64, _p, _p],
    "detector_contact_parts": [_p, _p, _size, _p],
    "detector_set_rest": [_p, _p],
    "line_search_begin": [_p, _p, _p, _f64],
    "line_search_positions": [_p, _f64, _p],
    "line_search_max_step": [_p, _f64, _p, _p],
    "line_search_find_near": [_p, _f64, _f64, _u32, _p],
    "pairs_step": [_p, _p, _p, _f64, _f64, _p],
    "pairs_find_near": [_p, _p, _f64, _p],
    "tracker_add_contacts": [_p, _p, _size],
    "tracker_add_frame": [_p, _u64, _p],
    "tracker_take": [_p, _p],
    "tracker_finish": [_p, _p],
}

_PUBLIC: Dict[str, Tuple[Any, List[Any]]] = {
    "cscd_version_string": (c_char_p, []),
    "cscd_status_string": (c_char_p, [_u32]),
    "cscd_reason_text": (c_char_p, [_u32]),
    "cscd_mesh_destroy": (None, [_p]),
    "cscd_mesh_object_count": (_u32, [_p]),
    "cscd_mesh_object_sized": (None, [_p, _u32, _p, _size]),
    "cscd_mesh_vertex_count": (_u32, [_p]),
    "cscd_mesh_triangle_count": (_u32, [_p]),
    "cscd_mesh_edge_count": (_u32, [_p]),
    "cscd_mesh_all_triangles": (_p, [_p]),
    "cscd_mesh_all_edges": (_p, [_p]),
    "cscd_mesh_all_triangle_edges": (_p, [_p]),
    "cscd_mesh_component_count": (_u32, [_p]),
    "cscd_mesh_component_sized": (None, [_p, _u32, _p, _size]),
    "cscd_mesh_component_labels": (_u32, [_p, _p]),
    "cscd_mesh_hash": (_u64, [_p]),
    "cscd_plan_defaults_sized": (None, [_p, _size]),
    "cscd_plan_destroy": (None, [_p]),
    "cscd_plan_method": (_u32, [_p]),
    "cscd_plan_region_count": (_u32, [_p]),
    "cscd_plan_region_sized": (None, [_p, _u32, _p, _size]),
    "cscd_plan_region_labels": (_u32, [_p, _p]),
    "cscd_plan_triangle_charge": (_f64, [_p, _u32]),
    "cscd_plan_capacitance": (_f64, [_p, _u32]),
    "cscd_method_from_name": (c_bool, [c_char_p, POINTER(c_uint32)]),
    "cscd_method_name": (c_char_p, [_u32]),
    "cscd_mode_from_name": (c_bool, [c_char_p, POINTER(c_uint32)]),
    "cscd_volume_from_name": (c_bool, [c_char_p, POINTER(c_uint32)]),
    "cscd_simd_from_name": (c_bool, [c_char_p, POINTER(c_uint32)]),
    "cscd_contact_kind_name": (c_char_p, [_u32]),
    "cscd_intersection_kind_name": (c_char_p, [_u32]),
    "cscd_curve_end_name": (c_char_p, [_u32]),
    "cscd_detector_defaults_sized": (None, [_p, _size]),
    "cscd_detector_destroy": (None, [_p]),
    "cscd_detector_guarantee_sized": (None, [_p, _u32, _p, _size]),
    "cscd_detector_timings_sized": (None, [_p, _p, _size]),
    "cscd_detector_counters_sized": (None, [_p, _p, _size]),
    "cscd_detector_orientation": (c_int, [_p, _u32]),
    "cscd_detector_set_separation": (_status, [_p, _f64, _f64]),
    "cscd_detector_set_longest_list": (_status, [_p, _size]),
    "cscd_detector_set_seams": (_status, [_p, _p, _size]),
    "cscd_detector_set_ignored": (_status, [_p, _p, _size]),
    "cscd_detector_set_rules": (_status, [_p, _p, _u32, _p, _u32]),
    "cscd_detector_set_active": (_status, [_p, _p, _size]),
    "cscd_detector_set_parts": (_status, [_p, _p, _u32]),
    "cscd_intersection_defaults_sized": (None, [_p, _size]),
    "cscd_contact_stencils": (None, [_p, _size, _p, _p]),
    "cscd_proximity_stencils": (None, [_p, _size, _p, _p]),
    "cscd_line_search_create": (_status, [_p, POINTER(c_void_p)]),
    "cscd_line_search_destroy": (None, [_p]),
    "cscd_line_search_candidate_count": (_size, [_p]),
    "cscd_event_defaults_sized": (None, [_p, _size]),
    "cscd_event_tracker_destroy": (None, [_p]),
}

#: By name: the type of the result, and those of the arguments.
PROTOTYPES: Dict[str, Tuple[Any, List[Any]]] = {
    **_LAYER, **_PUBLIC, **{f"cscdpy_{name}": (_status, [_p, *arguments]) for name, arguments in _CALLS.items()}}
