/* The calls of the library that may take long, each in its host: without Python's lock; and those that return a struct. All other
 * functions Python calls as cscd/cscd.h has them. Structs have the sizes of this build, whose layouts.c tells Python of them. */
#include "cscd/cscd.h"

#include "python/native/host.h"

#define CALL_OF(name, arguments, call)                                                                       \
    PYTHON_API cscd_status cscdpy_##name arguments {                                                         \
        if (!host_begin(h)) return CSCD_BUSY;                                                                \
        cscd_status status = call;                                                                           \
        host_end(h);                                                                                         \
        return status;                                                                                       \
    }

/* ---- what is created ----------------------------------------------------------------------------------- */

CALL_OF(mesh_create, (host * h, const cscd_object_desc *objects, uint32_t object_count, cscd_mesh **out),
        cscd_mesh_create(h->context, objects, object_count, out))
CALL_OF(tet_surface_create,
        (host * h, const uint32_t *tetrahedra, size_t tetrahedron_count, uint32_t vertex_count,
         cscd_tet_surface **out),
        cscd_tet_surface_create(h->context, tetrahedra, tetrahedron_count, vertex_count, out))
CALL_OF(plan_create,
        (host * h, const cscd_mesh *mesh, const cscd_view *positions, const cscd_plan_options *options,
         cscd_plan **out),
        cscd_plan_create(h->context, mesh, positions, options, out))
CALL_OF(plan_create_from_parts,
        (host * h, const cscd_mesh *mesh, const cscd_view *positions, const cscd_plan_parts *parts,
         cscd_plan **out),
        cscd_plan_create_from_parts(h->context, mesh, positions, parts, out))
CALL_OF(detector_create,
        (host * h, const cscd_mesh *mesh, const cscd_plan *plan, const cscd_detector_options *options,
         cscd_detector **out),
        cscd_detector_create(h->context, mesh, plan, options, out))
CALL_OF(tracker_create,
        (host * h, const cscd_mesh *mesh, const cscd_event_options *options, cscd_event_tracker **out),
        cscd_event_tracker_create(h->context, mesh, options, out))

/* ---- a detector ---------------------------------------------------------------------------------------- */

CALL_OF(detector_step,
        (host * h, cscd_detector *detector, const cscd_view *x0, const cscd_view *x1, cscd_contacts *out),
        cscd_detector_step(detector, x0, x1, out))
CALL_OF(detector_find_intersections,
        (host * h, cscd_detector *detector, const cscd_view *positions,
         const cscd_intersection_options *options, cscd_intersections *out),
        cscd_detector_find_intersections(detector, positions, options, out))
CALL_OF(detector_overlap_volumes,
        (host * h, cscd_detector *detector, const cscd_view *positions,
         const cscd_intersection_options *options, cscd_measures *out),
        cscd_detector_overlap_volumes(detector, positions, options, out))
CALL_OF(detector_curve_lengths,
        (host * h, cscd_detector *detector, const cscd_view *positions,
         const cscd_intersection_options *options, cscd_measures *out),
        cscd_detector_curve_lengths(detector, positions, options, out))
CALL_OF(detector_find_near,
        (host * h, cscd_detector *detector, const cscd_view *positions, double distance, uint32_t form,
         cscd_proximities *out),
        cscd_detector_find_near(detector, positions, distance, (cscd_near_form)form, out))
CALL_OF(detector_max_step,
        (host * h, cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
         const cscd_mutable_view *reached, cscd_free_step *out),
        cscd_detector_max_step(detector, x0, x1, reached, out))
CALL_OF(detector_displacement_bounds,
        (host * h, cscd_detector *detector, const cscd_view *x0, double search_radius, uint32_t scalar,
         void *bounds, size_t size, cscd_displacement_bounds *out),
        cscd_detector_displacement_bounds(detector, x0, search_radius, (cscd_scalar)scalar, bounds, size,
                                          out))
CALL_OF(detector_truncate,
        (host * h, cscd_detector *detector, const cscd_view *x0, const cscd_view *x1, double search_radius,
         const cscd_mutable_view *reached, cscd_truncation *out),
        cscd_detector_truncate(detector, x0, x1, search_radius, reached, out))
CALL_OF(detector_make_safe,
        (host * h, cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
         const cscd_response_options *options, const cscd_mutable_view *reached, cscd_safe_motion *out),
        cscd_detector_make_safe(detector, x0, x1, options, reached, out))
CALL_OF(detector_find_lenses,
        (host * h, cscd_detector *detector, const cscd_view *positions,
         const cscd_intersection_options *options, cscd_lenses *out),
        cscd_detector_find_lenses(detector, positions, options, out))
CALL_OF(detector_untangle,
        (host * h, cscd_detector *detector, const cscd_view *positions, const cscd_untangle_options *options,
         const cscd_mutable_view *reached, cscd_untangled *out),
        cscd_detector_untangle(detector, positions, options, reached, out))
CALL_OF(detector_contact_parts,
        (host * h, cscd_detector *detector, const cscd_contact *contacts, size_t contact_count,
         cscd_contact_part_pairs *out),
        cscd_detector_contact_parts(detector, contacts, contact_count, out))
CALL_OF(detector_set_rest, (host * h, cscd_detector *detector, const cscd_view *rest),
        cscd_detector_set_rest(detector, rest))

/* ---- a line search ------------------------------------------------------------------------------------- */

CALL_OF(line_search_begin,
        (host * h, cscd_line_search *search, const cscd_view *x0, const cscd_view *x1, double reach),
        cscd_line_search_begin(search, x0, x1, reach))
CALL_OF(line_search_candidates, (host * h, cscd_line_search *search, cscd_candidates *out),
        cscd_line_search_candidates(search, out))
CALL_OF(line_search_positions,
        (host * h, cscd_line_search *search, double fraction, const cscd_mutable_view *positions),
        cscd_line_search_positions(search, fraction, positions))
CALL_OF(line_search_max_step,
        (host * h, cscd_line_search *search, double longest, const cscd_mutable_view *reached,
         cscd_free_step *out),
        cscd_line_search_max_step(search, longest, reached, out))
CALL_OF(line_search_find_near,
        (host * h, cscd_line_search *search, double fraction, double distance, uint32_t form,
         cscd_proximities *out),
        cscd_line_search_find_near(search, fraction, distance, (cscd_near_form)form, out))

/* ---- energies ------------------------------------------------------------------------------------------ */

CALL_OF(energy_create, (host * h, const cscd_mesh *mesh, cscd_energy **out),
        cscd_energy_create(h->context, mesh, out))
CALL_OF(energy_make_pattern,
        (host * h, cscd_energy *energy, const cscd_proximities *items, const cscd_energy_pattern *others,
         cscd_energy_pattern *out),
        cscd_energy_make_pattern(energy, items, others, out))
CALL_OF(energy_evaluate,
        (host * h, cscd_energy *energy, const cscd_proximities *items, const cscd_view *positions,
         const cscd_energy_options *options, const cscd_energy_targets *targets, cscd_energy_sum *out),
        cscd_energy_evaluate(energy, items, positions, options, targets, out))
CALL_OF(energy_freeze_friction,
        (host * h, cscd_energy *energy, const cscd_proximities *items, const cscd_view *positions,
         const cscd_energy_options *options),
        cscd_energy_freeze_friction(energy, items, positions, options))
CALL_OF(energy_evaluate_friction,
        (host * h, cscd_energy *energy, const cscd_view *x0, const cscd_view *x1,
         const cscd_energy_targets *targets, cscd_energy_sum *out),
        cscd_energy_evaluate_friction(energy, x0, x1, targets, out))

/* ---- structs that the library returns: how each is passed is left to the compiler ---------------------- */

#define RESULT_OF(name, arguments, call)                                                                     \
    PYTHON_API void cscdpy_##name arguments {                                                                \
        *out = call;                                                                                         \
    }

RESULT_OF(mesh_component, (const cscd_mesh *mesh, uint32_t component, cscd_component *out),
          cscd_mesh_component(mesh, component))
RESULT_OF(tet_surface_get, (const cscd_tet_surface *surface, cscd_tet_surface_arrays *out),
          cscd_tet_surface_get(surface))
RESULT_OF(plan_describe, (const cscd_plan *plan, cscd_plan_info *out), cscd_plan_describe(plan))
RESULT_OF(plan_compared, (const cscd_plan *plan, uint32_t place, cscd_compared_plan *out),
          cscd_plan_compared(plan, place))
RESULT_OF(plan_region, (const cscd_plan *plan, uint32_t region, cscd_region *out),
          cscd_plan_region(plan, region))
RESULT_OF(detector_guarantee, (const cscd_detector *detector, uint32_t component, cscd_guarantee *out),
          cscd_detector_guarantee(detector, component))
RESULT_OF(detector_timings, (const cscd_detector *detector, cscd_timings *out),
          cscd_detector_timings(detector))
RESULT_OF(detector_counters, (const cscd_detector *detector, cscd_counters *out),
          cscd_detector_counters(detector))

/* ---- single pairs, and events -------------------------------------------------------------------------- */

CALL_OF(pairs_step,
        (host * h, const cscd_pairs *pairs, const cscd_view *x0, const cscd_view *x1, double min_separation,
         double tolerance, cscd_pair_contact *out),
        cscd_pairs_step(h->context, pairs, x0, x1, min_separation, tolerance, out))
CALL_OF(pairs_find_near,
        (host * h, const cscd_pairs *pairs, const cscd_view *positions, double distance,
         cscd_pair_distance *out),
        cscd_pairs_find_near(h->context, pairs, positions, distance, out))
CALL_OF(tracker_add_contacts,
        (host * h, cscd_event_tracker *tracker, const cscd_contact *contacts, size_t contact_count),
        cscd_event_tracker_add_contacts(tracker, contacts, contact_count))
CALL_OF(tracker_add_frame,
        (host * h, cscd_event_tracker *tracker, uint64_t frame, const cscd_intersections *found),
        cscd_event_tracker_add_frame(tracker, frame, found))
CALL_OF(tracker_take, (host * h, cscd_event_tracker *tracker, cscd_events *out),
        cscd_event_tracker_take(tracker, out))
CALL_OF(tracker_finish, (host * h, cscd_event_tracker *tracker, cscd_events *out),
        cscd_event_tracker_finish(tracker, out))
