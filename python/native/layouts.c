/* Tells Python how the structs of the library lie in memory, so that it reads and writes them as numpy records and
 * nothing is written down twice. */
#include "python/native/host.h"

#include "cscd/cscd.h"

#include <string.h>

/* A member is described by a letter, where it is, and how many bytes it and one of its items have. */
typedef struct member_layout {
    const char *name;
    size_t offset, size, item;
    char type; /* 'u', 'i', 'f', 'b' for bool, 'p' for a pointer, 's' for a struct */
} member_layout;

typedef struct struct_layout {
    const char *name;
    size_t size;
    const member_layout *members;
    size_t member_count;
} struct_layout;

/* Arrays become pointers in _Generic, and those to what is not const are no pointers of our structs. */
#define LETTER_OF(value)                                                                                     \
    _Generic((value),                                                                                        \
        bool: 'b',                                                                                           \
        unsigned char: 'u',                                                                                  \
        unsigned short: 'u',                                                                                 \
        unsigned int: 'u',                                                                                   \
        unsigned long: 'u',                                                                                  \
        unsigned long long: 'u',                                                                             \
        int: 'i',                                                                                            \
        long: 'i',                                                                                           \
        long long: 'i',                                                                                      \
        double: 'f',                                                                                         \
        unsigned int *: 'u',                                                                                 \
        unsigned long *: 'u',                                                                                \
        unsigned long long *: 'u',                                                                           \
        double *: 'f',                                                                                       \
        cscd_contact: 's',                                                                                   \
        default: 'p')
#define ITEM_OF(value)                                                                                       \
    _Generic((value),                                                                                        \
        unsigned int *: sizeof(unsigned int),                                                                \
        unsigned long *: sizeof(unsigned long),                                                              \
        unsigned long long *: sizeof(unsigned long long),                                                    \
        double *: sizeof(double),                                                                            \
        default: sizeof(value))
#define FIELD(type, name)                                                                                    \
    {                                                                                                        \
#name, offsetof(type, name), sizeof(((type *)0)->name), ITEM_OF(((type *)0)->name),                  \
            LETTER_OF(((type *)0)->name)                                                                     \
    }

/* A pointer to what the library writes, which _Generic cannot tell from an array. */
#define WRITTEN_FIELD(type, name)                                                                            \
    { #name, offsetof(type, name), sizeof(((type *)0)->name), sizeof(((type *)0)->name), 'p' }

#define LAYOUT(name)                                                                                         \
    { #name, sizeof(cscd_##name), name##_members, sizeof name##_members / sizeof *name##_members }

#define FIELDS(name, ...) static const member_layout name##_members[] = {__VA_ARGS__};

FIELDS(view, FIELD(cscd_view, data), FIELD(cscd_view, size), FIELD(cscd_view, stride),
       FIELD(cscd_view, coordinate_stride), FIELD(cscd_view, scalar), FIELD(cscd_view, object_count))
FIELDS(mutable_view, FIELD(cscd_mutable_view, data), FIELD(cscd_mutable_view, size),
       FIELD(cscd_mutable_view, stride), FIELD(cscd_mutable_view, coordinate_stride),
       FIELD(cscd_mutable_view, scalar), FIELD(cscd_mutable_view, object_count))
FIELDS(object_desc, FIELD(cscd_object_desc, vertex_count), FIELD(cscd_object_desc, triangle_count),
       FIELD(cscd_object_desc, triangles), FIELD(cscd_object_desc, obstacle), FIELD(cscd_object_desc, kind),
       FIELD(cscd_object_desc, wire_count), FIELD(cscd_object_desc, wires), FIELD(cscd_object_desc, normal))
FIELDS(object, FIELD(cscd_object, obstacle), FIELD(cscd_object, kind), FIELD(cscd_object, first_vertex),
       FIELD(cscd_object, vertex_count), FIELD(cscd_object, first_edge), FIELD(cscd_object, edge_count),
       FIELD(cscd_object, first_triangle), FIELD(cscd_object, triangle_count))
FIELDS(component, FIELD(cscd_component, closed_manifold), FIELD(cscd_component, vertex_count),
       FIELD(cscd_component, edge_count), FIELD(cscd_component, triangle_count),
       FIELD(cscd_component, open_edges), FIELD(cscd_component, non_manifold_edges),
       FIELD(cscd_component, non_manifold_vertices), FIELD(cscd_component, inconsistent_edges),
       FIELD(cscd_component, first_open_edge), FIELD(cscd_component, first_non_manifold_edge),
       FIELD(cscd_component, first_non_manifold_vertex), FIELD(cscd_component, first_inconsistent_edge),
       FIELD(cscd_component, euler_characteristic))
FIELDS(plan_options, FIELD(cscd_plan_options, struct_size), FIELD(cscd_plan_options, method),
       FIELD(cscd_plan_options, k), FIELD(cscd_plan_options, seed), FIELD(cscd_plan_options, threshold),
       FIELD(cscd_plan_options, ours), FIELD(cscd_plan_options, memory_limit),
       FIELD(cscd_plan_options, charge_solver), FIELD(cscd_plan_options, frame_count),
       FIELD(cscd_plan_options, frames), FIELD(cscd_plan_options, stiffness),
       FIELD(cscd_plan_options, growing))
FIELDS(plan_parts, FIELD(cscd_plan_parts, method), FIELD(cscd_plan_parts, region_count),
       FIELD(cscd_plan_parts, triangle_regions), FIELD(cscd_plan_parts, detector_points),
       FIELD(cscd_plan_parts, charges), FIELD(cscd_plan_parts, capacitances), FIELD(cscd_plan_parts, origin))
FIELDS(region, FIELD(cscd_region, component), FIELD(cscd_region, triangle_count), FIELD(cscd_region, area),
       FIELD(cscd_region, visible_share), FIELD(cscd_region, detector_point))
FIELDS(preprocess_timings, FIELD(cscd_preprocess_timings, assembly_ms),
       FIELD(cscd_preprocess_timings, solve_ms), FIELD(cscd_preprocess_timings, regions_ms),
       FIELD(cscd_preprocess_timings, total_ms))
FIELDS(plan_info, FIELD(cscd_plan_info, method), FIELD(cscd_plan_info, region_count),
       FIELD(cscd_plan_info, compared_count), FIELD(cscd_plan_info, charge_kernels),
       FIELD(cscd_plan_info, better_kernels), FIELD(cscd_plan_info, origin))
FIELDS(compared_plan, FIELD(cscd_compared_plan, method), FIELD(cscd_compared_plan, k),
       FIELD(cscd_compared_plan, region_count), FIELD(cscd_compared_plan, kept),
       FIELD(cscd_compared_plan, tested_share), FIELD(cscd_compared_plan, failure))
FIELDS(object_rule, FIELD(cscd_object_rule, category), FIELD(cscd_object_rule, mask),
       FIELD(cscd_object_rule, thickness), FIELD(cscd_object_rule, thickness_class),
       FIELD(cscd_object_rule, self), FIELD(cscd_object_rule, obstacle_pairs))
FIELDS(detector_options, FIELD(cscd_detector_options, struct_size), FIELD(cscd_detector_options, method),
       FIELD(cscd_detector_options, mode), FIELD(cscd_detector_options, start),
       FIELD(cscd_detector_options, volume), FIELD(cscd_detector_options, ignore),
       FIELD(cscd_detector_options, ignore_user), FIELD(cscd_detector_options, ignored),
       FIELD(cscd_detector_options, ignored_count), FIELD(cscd_detector_options, seams),
       FIELD(cscd_detector_options, seam_count), FIELD(cscd_detector_options, min_separation),
       FIELD(cscd_detector_options, tolerance), FIELD(cscd_detector_options, step_factor),
       FIELD(cscd_detector_options, rules), FIELD(cscd_detector_options, thickness_matrix),
       FIELD(cscd_detector_options, rule_count), FIELD(cscd_detector_options, thickness_class_count),
       FIELD(cscd_detector_options, floor_ratio), FIELD(cscd_detector_options, seam_reach),
       FIELD(cscd_detector_options, longest_list), FIELD(cscd_detector_options, coherence),
       FIELD(cscd_detector_options, ours))
FIELDS(contact, FIELD(cscd_contact, kind), FIELD(cscd_contact, a), FIELD(cscd_contact, b),
       FIELD(cscd_contact, bounded), FIELD(cscd_contact, vertices), FIELD(cscd_contact, toi),
       FIELD(cscd_contact, u), FIELD(cscd_contact, v), FIELD(cscd_contact, point),
       FIELD(cscd_contact, normal))
FIELDS(contacts, FIELD(cscd_contacts, items), FIELD(cscd_contacts, count))
FIELDS(guarantee, FIELD(cscd_guarantee, complete), FIELD(cscd_guarantee, start_embedded),
       FIELD(cscd_guarantee, reason))
FIELDS(timings, FIELD(cscd_timings, update_ms), FIELD(cscd_timings, orientation_ms),
       FIELD(cscd_timings, contour_ms), FIELD(cscd_timings, traversal_ms), FIELD(cscd_timings, contact_ms),
       FIELD(cscd_timings, total_ms), FIELD(cscd_timings, proof_ms), FIELD(cscd_timings, check_ms))
FIELDS(counters, FIELD(cscd_counters, static_checks), FIELD(cscd_counters, clean),
       FIELD(cscd_counters, rebuilds), FIELD(cscd_counters, passes), FIELD(cscd_counters, plus),
       FIELD(cscd_counters, minus), FIELD(cscd_counters, contours), FIELD(cscd_counters, sealed),
       FIELD(cscd_counters, boxes_tested), FIELD(cscd_counters, pcp), FIELD(cscd_counters, adjacent),
       FIELD(cscd_counters, feature_pairs), FIELD(cscd_counters, tests), FIELD(cscd_counters, by_signs),
       FIELD(cscd_counters, by_roots), FIELD(cscd_counters, by_exact), FIELD(cscd_counters, vf),
       FIELD(cscd_counters, ee), FIELD(cscd_counters, bounded), FIELD(cscd_counters, loose),
       FIELD(cscd_counters, coherent))
FIELDS(intersection_options, FIELD(cscd_intersection_options, struct_size),
       FIELD(cscd_intersection_options, answer), FIELD(cscd_intersection_options, stop_after),
       FIELD(cscd_intersection_options, kinds), FIELD(cscd_intersection_options, curves),
       FIELD(cscd_intersection_options, patches), FIELD(cscd_intersection_options, overlaps),
       FIELD(cscd_intersection_options, depths), FIELD(cscd_intersection_options, parts),
       FIELD(cscd_intersection_options, cut_offs), FIELD(cscd_intersection_options, part_bodies),
       FIELD(cscd_intersection_options, orientation), FIELD(cscd_intersection_options, depth_limit),
       FIELD(cscd_intersection_options, max_memory), FIELD(cscd_intersection_options, max_work))
FIELDS(intersection, FIELD(cscd_intersection, a), FIELD(cscd_intersection, b), FIELD(cscd_intersection, kind),
       FIELD(cscd_intersection, shared), FIELD(cscd_intersection, components),
       FIELD(cscd_intersection, objects))
FIELDS(intersections, FIELD(cscd_intersections, items), FIELD(cscd_intersections, count),
       FIELD(cscd_intersections, crossing), FIELD(cscd_intersections, coplanar),
       FIELD(cscd_intersections, folded), FIELD(cscd_intersections, duplicate),
       FIELD(cscd_intersections, touching), FIELD(cscd_intersections, zero_area_triangles),
       FIELD(cscd_intersections, first_zero_area), FIELD(cscd_intersections, collapsed),
       FIELD(cscd_intersections, stopped), FIELD(cscd_intersections, curves),
       FIELD(cscd_intersections, patches), FIELD(cscd_intersections, overlaps),
       FIELD(cscd_intersections, depths), FIELD(cscd_intersections, cut_offs),
       FIELD(cscd_intersections, parts), FIELD(cscd_intersections, collapsed_components),
       FIELD(cscd_intersections, left_out), FIELD(cscd_intersections, wanted_memory),
       FIELD(cscd_intersections, wanted_work))
FIELDS(curve, FIELD(cscd_curve, first_point), FIELD(cscd_curve, point_count), FIELD(cscd_curve, first_piece),
       FIELD(cscd_curve, piece_count), FIELD(cscd_curve, start), FIELD(cscd_curve, end),
       FIELD(cscd_curve, components), FIELD(cscd_curve, objects), FIELD(cscd_curve, closed),
       FIELD(cscd_curve, swapped), FIELD(cscd_curve, touching), FIELD(cscd_curve, length))
FIELDS(curve_point, FIELD(cscd_curve_point, edge), FIELD(cscd_curve_point, triangle),
       FIELD(cscd_curve_point, s), FIELD(cscd_curve_point, u), FIELD(cscd_curve_point, v),
       FIELD(cscd_curve_point, x))
FIELDS(curve_piece, FIELD(cscd_curve_piece, a), FIELD(cscd_curve_piece, b))
FIELDS(curves, FIELD(cscd_curves, items), FIELD(cscd_curves, count), FIELD(cscd_curves, points),
       FIELD(cscd_curves, point_count), FIELD(cscd_curves, pieces), FIELD(cscd_curves, piece_count),
       FIELD(cscd_curves, pair_curves), FIELD(cscd_curves, pair_count))
FIELDS(patch, FIELD(cscd_patch, component), FIELD(cscd_patch, object), FIELD(cscd_patch, body),
       FIELD(cscd_patch, triangle), FIELD(cscd_patch, corner), FIELD(cscd_patch, vertex_count),
       FIELD(cscd_patch, triangle_count), FIELD(cscd_patch, first_winding), FIELD(cscd_patch, winding_count),
       FIELD(cscd_patch, own))
FIELDS(winding, FIELD(cscd_winding, body), FIELD(cscd_winding, number))
FIELDS(patches, FIELD(cscd_patches, items), FIELD(cscd_patches, count), FIELD(cscd_patches, windings),
       FIELD(cscd_patches, winding_count), FIELD(cscd_patches, vertex_patches),
       FIELD(cscd_patches, triangle_patches), FIELD(cscd_patches, corner_patches),
       FIELD(cscd_patches, turned))
FIELDS(overlap, FIELD(cscd_overlap, a), FIELD(cscd_overlap, b), FIELD(cscd_overlap, area_a),
       FIELD(cscd_overlap, area_b), FIELD(cscd_overlap, volume))
FIELDS(overlaps, FIELD(cscd_overlaps, items), FIELD(cscd_overlaps, count))
FIELDS(depth, FIELD(cscd_depth, vertex), FIELD(cscd_depth, edge), FIELD(cscd_depth, face),
       FIELD(cscd_depth, patch), FIELD(cscd_depth, body), FIELD(cscd_depth, triangle), FIELD(cscd_depth, s),
       FIELD(cscd_depth, depth), FIELD(cscd_depth, bound), FIELD(cscd_depth, x), FIELD(cscd_depth, direction))
FIELDS(patch_depth, FIELD(cscd_patch_depth, patch), FIELD(cscd_patch_depth, body),
       FIELD(cscd_patch_depth, deepest))
FIELDS(depths, FIELD(cscd_depths, items), FIELD(cscd_depths, count), FIELD(cscd_depths, vertex_count),
       FIELD(cscd_depths, edge_count), FIELD(cscd_depths, patches), FIELD(cscd_depths, patch_count))
FIELDS(cut_off, FIELD(cscd_cut_off, curve), FIELD(cscd_cut_off, trace), FIELD(cscd_cut_off, component),
       FIELD(cscd_cut_off, object), FIELD(cscd_cut_off, area), FIELD(cscd_cut_off, rest),
       FIELD(cscd_cut_off, first_patch), FIELD(cscd_cut_off, patch_count))
FIELDS(cut_offs, FIELD(cscd_cut_offs, items), FIELD(cscd_cut_offs, count), FIELD(cscd_cut_offs, patches),
       FIELD(cscd_cut_offs, patch_count))
FIELDS(part_pair, FIELD(cscd_part_pair, a), FIELD(cscd_part_pair, b), FIELD(cscd_part_pair, crossing),
       FIELD(cscd_part_pair, coplanar), FIELD(cscd_part_pair, folded), FIELD(cscd_part_pair, duplicate),
       FIELD(cscd_part_pair, touching), FIELD(cscd_part_pair, faces), FIELD(cscd_part_pair, shares),
       FIELD(cscd_part_pair, curves), FIELD(cscd_part_pair, touching_curves), FIELD(cscd_part_pair, length),
       FIELD(cscd_part_pair, deepest), FIELD(cscd_part_pair, depth), FIELD(cscd_part_pair, bound),
       FIELD(cscd_part_pair, same_solid), FIELD(cscd_part_pair, in_other_body))
FIELDS(part_pairs, FIELD(cscd_part_pairs, items), FIELD(cscd_part_pairs, count),
       FIELD(cscd_part_pairs, faces), FIELD(cscd_part_pairs, share))
FIELDS(contact_part_pair, FIELD(cscd_contact_part_pair, a), FIELD(cscd_contact_part_pair, b),
       FIELD(cscd_contact_part_pair, count), FIELD(cscd_contact_part_pair, earliest),
       FIELD(cscd_contact_part_pair, toi))
FIELDS(contact_part_pairs, FIELD(cscd_contact_part_pairs, items), FIELD(cscd_contact_part_pairs, count))
FIELDS(stencil, FIELD(cscd_stencil, vertices), FIELD(cscd_stencil, weights))
FIELDS(proximity, FIELD(cscd_proximity, kind), FIELD(cscd_proximity, a), FIELD(cscd_proximity, b),
       FIELD(cscd_proximity, count), FIELD(cscd_proximity, vf_count), FIELD(cscd_proximity, ee_count),
       FIELD(cscd_proximity, vertices), FIELD(cscd_proximity, distance), FIELD(cscd_proximity, weights),
       FIELD(cscd_proximity, normal), FIELD(cscd_proximity, threshold), FIELD(cscd_proximity, weight),
       FIELD(cscd_proximity, separation))
FIELDS(proximities, FIELD(cscd_proximities, items), FIELD(cscd_proximities, count))
FIELDS(candidate, FIELD(cscd_candidate, kind), FIELD(cscd_candidate, a), FIELD(cscd_candidate, b))
FIELDS(candidates, FIELD(cscd_candidates, items), FIELD(cscd_candidates, count))
FIELDS(vertex_gradient, FIELD(cscd_vertex_gradient, vertex), FIELD(cscd_vertex_gradient, gradient))
FIELDS(measure, FIELD(cscd_measure, a), FIELD(cscd_measure, b), FIELD(cscd_measure, value),
       FIELD(cscd_measure, first_gradient), FIELD(cscd_measure, gradient_count))
FIELDS(measures, FIELD(cscd_measures, items), FIELD(cscd_measures, count), FIELD(cscd_measures, gradients),
       FIELD(cscd_measures, gradient_count), FIELD(cscd_measures, sum), FIELD(cscd_measures, unknown))
FIELDS(tet_surface_arrays, FIELD(cscd_tet_surface_arrays, vertex_count),
       FIELD(cscd_tet_surface_arrays, triangle_count), FIELD(cscd_tet_surface_arrays, triangles),
       FIELD(cscd_tet_surface_arrays, vertices), FIELD(cscd_tet_surface_arrays, tetrahedra))
FIELDS(free_step, FIELD(cscd_free_step, fraction), FIELD(cscd_free_step, limited),
       FIELD(cscd_free_step, moved), FIELD(cscd_free_step, limit))
FIELDS(displacement_bounds, FIELD(cscd_displacement_bounds, blocked),
       FIELD(cscd_displacement_bounds, blocked_count), FIELD(cscd_displacement_bounds, near_count),
       FIELD(cscd_displacement_bounds, least), FIELD(cscd_displacement_bounds, vertex),
       FIELD(cscd_displacement_bounds, limited))
FIELDS(truncation, FIELD(cscd_truncation, fraction), FIELD(cscd_truncation, obstacle_fraction),
       FIELD(cscd_truncation, held), FIELD(cscd_truncation, held_count), FIELD(cscd_truncation, near_count),
       FIELD(cscd_truncation, moved), FIELD(cscd_truncation, shortened))
FIELDS(response_options, FIELD(cscd_response_options, struct_size),
       FIELD(cscd_response_options, inverse_masses), FIELD(cscd_response_options, friction))
FIELDS(safe_motion, FIELD(cscd_safe_motion, responses), FIELD(cscd_safe_motion, response_counts),
       FIELD(cscd_safe_motion, rounds), FIELD(cscd_safe_motion, pushed), FIELD(cscd_safe_motion, mean_share),
       FIELD(cscd_safe_motion, truncations), FIELD(cscd_safe_motion, least_share),
       FIELD(cscd_safe_motion, obstacle_share), FIELD(cscd_safe_motion, held),
       FIELD(cscd_safe_motion, held_count), FIELD(cscd_safe_motion, moved))
FIELDS(lens_point, FIELD(cscd_lens_point, vertex), FIELD(cscd_lens_point, edge),
       FIELD(cscd_lens_point, triangle), FIELD(cscd_lens_point, along_normal), FIELD(cscd_lens_point, s),
       FIELD(cscd_lens_point, u), FIELD(cscd_lens_point, v), FIELD(cscd_lens_point, x),
       FIELD(cscd_lens_point, direction), FIELD(cscd_lens_point, thickness))
FIELDS(lens, FIELD(cscd_lens, reason), FIELD(cscd_lens, patch), FIELD(cscd_lens, components),
       FIELD(cscd_lens, objects), FIELD(cscd_lens, parts), FIELD(cscd_lens, fold),
       FIELD(cscd_lens, first_point), FIELD(cscd_lens, point_count), FIELD(cscd_lens, thickest),
       FIELD(cscd_lens, thickness), FIELD(cscd_lens, axis))
FIELDS(lenses, FIELD(cscd_lenses, items), FIELD(cscd_lenses, count), FIELD(cscd_lenses, points),
       FIELD(cscd_lenses, point_count), FIELD(cscd_lenses, thickness), FIELD(cscd_lenses, pairs),
       FIELD(cscd_lenses, undecided))
FIELDS(untangle_options, FIELD(cscd_untangle_options, struct_size), FIELD(cscd_untangle_options, max_rounds),
       FIELD(cscd_untangle_options, max_steps), FIELD(cscd_untangle_options, weights),
       FIELD(cscd_untangle_options, start), FIELD(cscd_untangle_options, start_input),
       FIELD(cscd_untangle_options, steady), FIELD(cscd_untangle_options, spread),
       FIELD(cscd_untangle_options, rest), FIELD(cscd_untangle_options, bending),
       FIELD(cscd_untangle_options, max_seconds))
FIELDS(untangled, FIELD(cscd_untangled, start), FIELD(cscd_untangled, clean), FIELD(cscd_untangled, moved),
       FIELD(cscd_untangled, stopped), FIELD(cscd_untangled, pairs_before),
       FIELD(cscd_untangled, pairs_after), FIELD(cscd_untangled, near_before),
       FIELD(cscd_untangled, near_after), FIELD(cscd_untangled, moved_vertices),
       FIELD(cscd_untangled, farthest), FIELD(cscd_untangled, displacement),
       FIELD(cscd_untangled, mean_displacement), FIELD(cscd_untangled, thickness),
       FIELD(cscd_untangled, rounds), FIELD(cscd_untangled, steps))
FIELDS(pairs, FIELD(cscd_pairs, kind), FIELD(cscd_pairs, point_count), FIELD(cscd_pairs, pair_count),
       FIELD(cscd_pairs, points))
FIELDS(pair_contact, FIELD(cscd_pair_contact, toi), FIELD(cscd_pair_contact, contact),
       FIELD(cscd_pair_contact, bounded), FIELD(cscd_pair_contact, u), FIELD(cscd_pair_contact, v),
       FIELD(cscd_pair_contact, point), FIELD(cscd_pair_contact, normal))
FIELDS(pair_distance, FIELD(cscd_pair_distance, distance), FIELD(cscd_pair_distance, u),
       FIELD(cscd_pair_distance, v), FIELD(cscd_pair_distance, point), FIELD(cscd_pair_distance, normal))
FIELDS(energy_options, FIELD(cscd_energy_options, struct_size), FIELD(cscd_energy_options, law),
       FIELD(cscd_energy_options, reach), FIELD(cscd_energy_options, stiffness),
       FIELD(cscd_energy_options, physical), FIELD(cscd_energy_options, by_count),
       FIELD(cscd_energy_options, beyond), FIELD(cscd_energy_options, friction),
       FIELD(cscd_energy_options, object_friction), FIELD(cscd_energy_options, item_friction),
       FIELD(cscd_energy_options, slip))
FIELDS(energy_pattern, FIELD(cscd_energy_pattern, rows), FIELD(cscd_energy_pattern, columns),
       FIELD(cscd_energy_pattern, block_count))
FIELDS(energy_targets, WRITTEN_FIELD(cscd_energy_targets, gradient),
       WRITTEN_FIELD(cscd_energy_targets, blocks), WRITTEN_FIELD(cscd_energy_targets, matrix),
       FIELD(cscd_energy_targets, pattern), FIELD(cscd_energy_targets, scalar_rows),
       FIELD(cscd_energy_targets, project), FIELD(cscd_energy_targets, add))
FIELDS(energy_sum, FIELD(cscd_energy_sum, value), FIELD(cscd_energy_sum, least),
       FIELD(cscd_energy_sum, active), FIELD(cscd_energy_sum, infinite), FIELD(cscd_energy_sum, first))
FIELDS(event_options, FIELD(cscd_event_options, struct_size), FIELD(cscd_event_options, rings),
       FIELD(cscd_event_options, gap), FIELD(cscd_event_options, part_count),
       FIELD(cscd_event_options, labels), FIELD(cscd_event_options, seams),
       FIELD(cscd_event_options, seam_count), FIELD(cscd_event_options, max_memory))
FIELDS(event, FIELD(cscd_event, a), FIELD(cscd_event, b), FIELD(cscd_event, first_frame),
       FIELD(cscd_event, last_frame), FIELD(cscd_event, worst_frame), FIELD(cscd_event, kinds),
       FIELD(cscd_event, pairs), FIELD(cscd_event, depths), FIELD(cscd_event, contacts),
       FIELD(cscd_event, depth), FIELD(cscd_event, length), FIELD(cscd_event, x), FIELD(cscd_event, triangle),
       FIELD(cscd_event, first_triangle))
FIELDS(events, FIELD(cscd_events, items), FIELD(cscd_events, count), FIELD(cscd_events, open))

static const struct_layout layouts[] = {LAYOUT(view),
                                        LAYOUT(mutable_view),
                                        LAYOUT(object_desc),
                                        LAYOUT(object),
                                        LAYOUT(component),
                                        LAYOUT(plan_options),
                                        LAYOUT(plan_parts),
                                        LAYOUT(region),
                                        LAYOUT(preprocess_timings),
                                        LAYOUT(plan_info),
                                        LAYOUT(compared_plan),
                                        LAYOUT(object_rule),
                                        LAYOUT(detector_options),
                                        LAYOUT(contact),
                                        LAYOUT(contacts),
                                        LAYOUT(intersection),
                                        LAYOUT(intersections),
                                        LAYOUT(guarantee),
                                        LAYOUT(timings),
                                        LAYOUT(counters),
                                        LAYOUT(intersection_options),
                                        LAYOUT(curve),
                                        LAYOUT(curve_point),
                                        LAYOUT(curve_piece),
                                        LAYOUT(curves),
                                        LAYOUT(patch),
                                        LAYOUT(winding),
                                        LAYOUT(patches),
                                        LAYOUT(overlap),
                                        LAYOUT(overlaps),
                                        LAYOUT(depth),
                                        LAYOUT(patch_depth),
                                        LAYOUT(depths),
                                        LAYOUT(cut_off),
                                        LAYOUT(cut_offs),
                                        LAYOUT(part_pair),
                                        LAYOUT(part_pairs),
                                        LAYOUT(contact_part_pair),
                                        LAYOUT(contact_part_pairs),
                                        LAYOUT(stencil),
                                        LAYOUT(proximity),
                                        LAYOUT(proximities),
                                        LAYOUT(candidate),
                                        LAYOUT(candidates),
                                        LAYOUT(vertex_gradient),
                                        LAYOUT(measure),
                                        LAYOUT(measures),
                                        LAYOUT(tet_surface_arrays),
                                        LAYOUT(free_step),
                                        LAYOUT(displacement_bounds),
                                        LAYOUT(truncation),
                                        LAYOUT(response_options),
                                        LAYOUT(safe_motion),
                                        LAYOUT(lens_point),
                                        LAYOUT(lens),
                                        LAYOUT(lenses),
                                        LAYOUT(untangle_options),
                                        LAYOUT(untangled),
                                        LAYOUT(pairs),
                                        LAYOUT(pair_contact),
                                        LAYOUT(pair_distance),
                                        LAYOUT(energy_options),
                                        LAYOUT(energy_pattern),
                                        LAYOUT(energy_targets),
                                        LAYOUT(energy_sum),
                                        LAYOUT(event_options),
                                        LAYOUT(event),
                                        LAYOUT(events)};

/* The layout of struct number `index`, and its size; NULL after the last one. Its members follow by
 * cscdpy_member. */
PYTHON_API const char *cscdpy_struct(size_t index, size_t *size, size_t *member_count) {
    if (index >= sizeof layouts / sizeof *layouts) return NULL;
    *size = layouts[index].size;
    *member_count = layouts[index].member_count;
    return layouts[index].name;
}

PYTHON_API const char *cscdpy_member(size_t index, size_t member, size_t numbers[3], char *type) {
    const member_layout *found = &layouts[index].members[member];
    numbers[0] = found->offset;
    numbers[1] = found->size;
    numbers[2] = found->item;
    *type = found->type;
    return found->name;
}
