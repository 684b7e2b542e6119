/* Calls of the API for tests: with packed positions, with refusals that say why, and with an allocator that counts. */
#include "tests/support/calls.h"

#include "src/core/system.h"
#include "src/mesh/mesh.h"

#include <stdio.h>
#include <stdlib.h>

static const cscd_view *view_of(const cscd_mesh *mesh, const double *x, cscd_view *view) {
    *view = cscd_view_doubles(x, mesh != NULL ? mesh->vertex_count : 0);
    return x != NULL ? view : NULL;
}

static const cscd_mutable_view *mutable_view_of(const cscd_mesh *mesh, double *x, cscd_mutable_view *view) {
    *view = cscd_mutable_view_doubles(x, mesh != NULL ? mesh->vertex_count : 0);
    return x != NULL ? view : NULL;
}

static cscd_context *own_context(const cscd_mesh *mesh) {
    return mesh != NULL ? mesh->context : NULL;
}

static const cscd_mesh *mesh_of(const cscd_detector *detector) {
    return detector != NULL ? cscd_detector_mesh(detector) : NULL;
}

/* A line search does not tell its mesh: its views claim more vertices than any test has, in a size that 32 bits hold. */
enum { MORE_THAN_ALL = 1 << 24 };

static const cscd_view *line_view_of(const double *x, cscd_view *view) {
    *view = cscd_view_doubles(x, MORE_THAN_ALL);
    return x != NULL ? view : NULL;
}

static const cscd_mutable_view *mutable_line_view_of(double *x, cscd_mutable_view *view) {
    *view = cscd_mutable_view_doubles(x, MORE_THAN_ALL);
    return x != NULL ? view : NULL;
}

cscd_status plan_create_packed(const cscd_mesh *mesh, const double *positions,
                               const cscd_plan_options *options, cscd_plan **out) {
    cscd_view x;
    return cscd_plan_create(own_context(mesh), mesh, view_of(mesh, positions, &x), options, out);
}

cscd_status plan_from_parts_packed(const cscd_mesh *mesh, const double *positions,
                                   const cscd_plan_parts *parts, cscd_plan **out) {
    cscd_view x;
    return cscd_plan_create_from_parts(own_context(mesh), mesh, view_of(mesh, positions, &x), parts, out);
}

cscd_status detector_create_here(const cscd_mesh *mesh, const cscd_plan *plan,
                                 const cscd_detector_options *options, cscd_detector **out) {
    return cscd_detector_create(own_context(mesh), mesh, plan, options, out);
}

cscd_status step_packed(cscd_detector *detector, const double *x0, const double *x1, cscd_contacts *out) {
    const cscd_mesh *mesh = mesh_of(detector);
    cscd_view from, to;
    return cscd_detector_step(detector, view_of(mesh, x0, &from), view_of(mesh, x1, &to), out);
}

cscd_status check_packed(cscd_detector *detector, const double *positions, cscd_intersections *out) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.kinds = ~cscd_intersection_set(CSCD_INTERSECTION_DUPLICATE);
    return find_intersections_packed(detector, positions, &options, out);
}

cscd_status find_intersections_packed(cscd_detector *detector, const double *positions,
                                      const cscd_intersection_options *options, cscd_intersections *out) {
    cscd_view x;
    return cscd_detector_find_intersections(detector, view_of(mesh_of(detector), positions, &x), options,
                                            out);
}

cscd_status find_near_packed(cscd_detector *detector, const double *positions, double distance,
                             cscd_proximities *out) {
    cscd_view x;
    return cscd_detector_find_near(detector, view_of(mesh_of(detector), positions, &x), distance,
                                   CSCD_NEAR_PAIRS, out);
}

cscd_status find_unique_packed(cscd_detector *detector, const double *positions, double distance,
                               cscd_proximities *out) {
    cscd_view x;
    return cscd_detector_find_near(detector, view_of(mesh_of(detector), positions, &x), distance,
                                   CSCD_NEAR_UNIQUE, out);
}

cscd_status set_rest_packed(cscd_detector *detector, const double *rest) {
    cscd_view x;
    return cscd_detector_set_rest(detector, view_of(mesh_of(detector), rest, &x));
}

cscd_status max_step_packed(cscd_detector *detector, const double *x0, const double *x1, double *reached,
                            cscd_free_step *out) {
    const cscd_mesh *mesh = mesh_of(detector);
    cscd_view from, to;
    cscd_mutable_view end;
    return cscd_detector_max_step(detector, view_of(mesh, x0, &from), view_of(mesh, x1, &to),
                                  mutable_view_of(mesh, reached, &end), out);
}

cscd_status displacement_bounds_packed(cscd_detector *detector, const double *x0, double search_radius,
                                       double *bounds, cscd_displacement_bounds *out) {
    const cscd_mesh *mesh = mesh_of(detector);
    cscd_view from;
    return cscd_detector_displacement_bounds(detector, view_of(mesh, x0, &from), search_radius,
                                             CSCD_SCALAR_DOUBLE, bounds,
                                             mesh != NULL ? mesh->vertex_count * sizeof *bounds : 0, out);
}

cscd_status truncate_packed(cscd_detector *detector, const double *x0, const double *x1, double search_radius,
                            double *reached, cscd_truncation *out) {
    const cscd_mesh *mesh = mesh_of(detector);
    cscd_view from, to;
    cscd_mutable_view end;
    return cscd_detector_truncate(detector, view_of(mesh, x0, &from), view_of(mesh, x1, &to), search_radius,
                                  mutable_view_of(mesh, reached, &end), out);
}

cscd_status make_safe_packed(cscd_detector *detector, const double *x0, const double *x1,
                             const cscd_response_options *options, double *reached, cscd_safe_motion *out) {
    const cscd_mesh *mesh = mesh_of(detector);
    cscd_view from, to;
    cscd_mutable_view end;
    return cscd_detector_make_safe(detector, view_of(mesh, x0, &from), view_of(mesh, x1, &to), options,
                                   mutable_view_of(mesh, reached, &end), out);
}

cscd_status line_begin_packed(cscd_line_search *line, const double *x0, const double *x1, double reach) {
    cscd_view from, to;
    return cscd_line_search_begin(line, line_view_of(x0, &from), line_view_of(x1, &to), reach);
}

cscd_status line_positions_packed(cscd_line_search *line, double fraction, double *positions) {
    cscd_mutable_view x;
    return cscd_line_search_positions(line, fraction, mutable_line_view_of(positions, &x));
}

cscd_status line_max_step_packed(cscd_line_search *line, double longest, double *reached,
                                 cscd_free_step *out) {
    cscd_mutable_view end;
    return cscd_line_search_max_step(line, longest, mutable_line_view_of(reached, &end), out);
}

/* All points as packed doubles; NULL goes on as NULL. */
static const cscd_view *view_points(const cscd_pairs *pairs, const double *points, cscd_view *view) {
    if (points == NULL) return NULL;
    *view = cscd_view_doubles(points, pairs != NULL ? pairs->point_count : 0);
    return view;
}

cscd_status pairs_step_packed(cscd_context *context, const cscd_pairs *pairs, const double *start,
                              const double *end, double min_separation, double tolerance,
                              cscd_pair_contact *out) {
    cscd_view from, to;
    return cscd_pairs_step(context, pairs, view_points(pairs, start, &from), view_points(pairs, end, &to),
                           min_separation, tolerance, out);
}

cscd_status pairs_near_packed(cscd_context *context, const cscd_pairs *pairs, const double *positions,
                              double distance, cscd_pair_distance *out) {
    cscd_view view;
    return cscd_pairs_find_near(context, pairs, view_points(pairs, positions, &view), distance, out);
}

/* ---- an allocator -------------------------------------------------------------------------------------- */

enum { GUARD_SIZE = 256, GUARD_BYTE = 0xdd }; /* behind each block */

counting_allocator counting_allocator_start(void) {
    return (counting_allocator){.fail_at = SIZE_MAX};
}

static void *count_and_allocate(void *user, size_t size, size_t alignment) {
    counting_allocator *counter = user;
    if (counter->calls++ == counter->fail_at) return NULL;
    unsigned char *block = system_memory(size + GUARD_SIZE, alignment);
    if (block == NULL) return NULL;
    memset(block + size, GUARD_BYTE, GUARD_SIZE);
    counter->live++;
    counter->bytes += size;
    if (counter->bytes > counter->peak) counter->peak = counter->bytes;
    return block;
}

/* Ends the program: a test that has written there has shown nothing. */
static void check_guard(const unsigned char *guard, size_t size) {
    for (size_t i = 0; i < GUARD_SIZE; i++) {
        if (guard[i] == GUARD_BYTE) continue;
        fprintf(stderr, "counting_allocator: byte %zu behind a block of %zu was written\n", i, size);
        abort();
    }
}

static void count_and_release(void *user, void *block, size_t size) {
    counting_allocator *counter = user;
    check_guard((const unsigned char *)block + size, size);
    counter->live--;
    counter->bytes -= size;
    memset(block, GUARD_BYTE, size); /* so that what is read after its release is noticed */
    __asm__ volatile("" : : "r"(block) : "memory");
    system_memory_free(block);
}

cscd_allocator counting_allocator_interface(counting_allocator *counter) {
    return (cscd_allocator){count_and_allocate, count_and_release, counter};
}
