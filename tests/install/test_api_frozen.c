/* Version 1 of the API keeps its numbers: values of enumerators, sizes of structs and places of their
 * members. The file does not compile if one differs; a change needs a new major version. The sensors are
 * in test_api_frozen_sensors.c. */
#include "cscd/cscd.h"
#include "tests/support/shell.h"
#include "tests/support/test.h"

#include <stdlib.h>

#define VALUE(name, value) _Static_assert((int)(name) == (value), #name)

VALUE(CSCD_OK, 0);
VALUE(CSCD_OUT_OF_MEMORY, 1);
VALUE(CSCD_INVALID_ARGUMENT, 2);
VALUE(CSCD_INVALID_MESH, 3);
VALUE(CSCD_SYSTEM_ERROR, 4);
VALUE(CSCD_CANCELLED, 5);
VALUE(CSCD_IN_CONTACT, 6);

VALUE(CSCD_SIMD_AUTO, 0);
VALUE(CSCD_SIMD_SCALAR, 1);
VALUE(CSCD_SIMD_AVX2, 2);
VALUE(CSCD_SIMD_AVX512, 3);

VALUE(CSCD_SCALAR_DOUBLE, 0);
VALUE(CSCD_SCALAR_FLOAT, 1);

VALUE(CSCD_METHOD_AUTO, 0);
VALUE(CSCD_METHOD_NONE, 1);
VALUE(CSCD_METHOD_BRUTE, 2);
VALUE(CSCD_METHOD_SINGLE, 3);
VALUE(CSCD_METHOD_KMEANS, 4);
VALUE(CSCD_METHOD_CHARGE, 5);
VALUE(CSCD_METHOD_PUBLISHED, 6);
VALUE(CSCD_METHOD_ICCD, 7);
VALUE(CSCD_METHOD_ICCD_PUBLISHED, 8);

VALUE(CSCD_MODE_ALL, 0);
VALUE(CSCD_MODE_EARLIEST, 1);

VALUE(CSCD_START_PROVE, 0);
VALUE(CSCD_START_VOUCHED, 1);
VALUE(CSCD_START_UNKNOWN, 2);

VALUE(CSCD_VOLUME_BOX, 0);
VALUE(CSCD_VOLUME_KDOP14, 1);

VALUE(CSCD_CONTACT_VF, 0);
VALUE(CSCD_CONTACT_EE, 1);

VALUE(CSCD_REASON_METHOD, 0);
VALUE(CSCD_REASON_SURFACE, 1);
VALUE(CSCD_REASON_CROSSING, 2);
VALUE(CSCD_REASON_UNPROVEN, 3);
VALUE(CSCD_REASON_CLEAN, 4);
VALUE(CSCD_REASON_FINISHED, 5);
VALUE(CSCD_REASON_PUBLISHED, 6);
VALUE(CSCD_REASON_CONTOUR, 7);
VALUE(CSCD_REASON_EARLIEST, 8);
VALUE(CSCD_REASON_OBSTACLE, 9);

_Static_assert(CSCD_VERSION_MAJOR == 1, "another major version may change all of this");

/* Sizes and places, for processors with 64-bit pointers and longs (x86-64, aarch64). */
#if defined(__LP64__) && (defined(__x86_64__) || defined(__aarch64__))

#define SIZE(type, size)            _Static_assert(sizeof(type) == (size), #type)
#define PLACE(type, member, offset) _Static_assert(offsetof(type, member) == (offset), #type "." #member)

SIZE(cscd_allocator, 24);
PLACE(cscd_allocator, allocate, 0);
PLACE(cscd_allocator, release, 8);
PLACE(cscd_allocator, user, 16);

SIZE(cscd_parallel_for, 16);
PLACE(cscd_parallel_for, run, 0);
PLACE(cscd_parallel_for, user, 8);

SIZE(cscd_progress, 16);
PLACE(cscd_progress, report, 0);
PLACE(cscd_progress, user, 8);

SIZE(cscd_context_options, 72);
PLACE(cscd_context_options, struct_size, 0);
PLACE(cscd_context_options, thread_count, 4);
PLACE(cscd_context_options, simd, 8);
PLACE(cscd_context_options, allocator, 16);
PLACE(cscd_context_options, parallel_for, 40);
PLACE(cscd_context_options, progress, 56);

SIZE(cscd_mesh_desc, 16);
PLACE(cscd_mesh_desc, vertex_count, 0);
PLACE(cscd_mesh_desc, triangle_count, 4);
PLACE(cscd_mesh_desc, triangles, 8);

SIZE(cscd_object_desc, 24);
PLACE(cscd_object_desc, mesh, 0);
PLACE(cscd_object_desc, obstacle, 16);

SIZE(cscd_object, 28);
PLACE(cscd_object, first_vertex, 0);
PLACE(cscd_object, vertex_count, 4);
PLACE(cscd_object, first_edge, 8);
PLACE(cscd_object, edge_count, 12);
PLACE(cscd_object, first_triangle, 16);
PLACE(cscd_object, triangle_count, 20);
PLACE(cscd_object, obstacle, 24);

SIZE(cscd_component, 64);
PLACE(cscd_component, vertex_count, 0);
PLACE(cscd_component, edge_count, 4);
PLACE(cscd_component, triangle_count, 8);
PLACE(cscd_component, open_edges, 12);
PLACE(cscd_component, non_manifold_edges, 16);
PLACE(cscd_component, non_manifold_vertices, 20);
PLACE(cscd_component, inconsistent_edges, 24);
PLACE(cscd_component, first_open_edge, 28);
PLACE(cscd_component, first_non_manifold_edge, 32);
PLACE(cscd_component, first_non_manifold_vertex, 36);
PLACE(cscd_component, first_inconsistent_edge, 40);
PLACE(cscd_component, euler_characteristic, 48);
PLACE(cscd_component, closed_manifold, 56);

SIZE(cscd_view, 32);
PLACE(cscd_view, data, 0);
PLACE(cscd_view, scalar, 8);
PLACE(cscd_view, stride, 16);
PLACE(cscd_view, coordinate_stride, 24);

SIZE(cscd_plan_options, 40);
PLACE(cscd_plan_options, struct_size, 0);
PLACE(cscd_plan_options, method, 4);
PLACE(cscd_plan_options, k, 8);
PLACE(cscd_plan_options, seed, 12);
PLACE(cscd_plan_options, threshold, 16);
PLACE(cscd_plan_options, published, 24);
PLACE(cscd_plan_options, memory_limit, 32);

SIZE(cscd_region, 48);
PLACE(cscd_region, component, 0);
PLACE(cscd_region, triangle_count, 4);
PLACE(cscd_region, area, 8);
PLACE(cscd_region, visible_share, 16);
PLACE(cscd_region, detector_point, 24);

SIZE(cscd_plan_parts, 40);
PLACE(cscd_plan_parts, method, 0);
PLACE(cscd_plan_parts, region_count, 4);
PLACE(cscd_plan_parts, triangle_regions, 8);
PLACE(cscd_plan_parts, detector_points, 16);
PLACE(cscd_plan_parts, charges, 24);
PLACE(cscd_plan_parts, capacitances, 32);

SIZE(cscd_preprocess_timings, 32);
PLACE(cscd_preprocess_timings, assembly_ms, 0);
PLACE(cscd_preprocess_timings, solve_ms, 8);
PLACE(cscd_preprocess_timings, regions_ms, 16);
PLACE(cscd_preprocess_timings, total_ms, 24);

SIZE(cscd_detector_options, 96);
PLACE(cscd_detector_options, struct_size, 0);
PLACE(cscd_detector_options, method, 4);
PLACE(cscd_detector_options, mode, 8);
PLACE(cscd_detector_options, start, 12);
PLACE(cscd_detector_options, volume, 16);
PLACE(cscd_detector_options, ignore, 24);
PLACE(cscd_detector_options, ignore_user, 32);
PLACE(cscd_detector_options, ignored, 40);
PLACE(cscd_detector_options, ignored_count, 48);
PLACE(cscd_detector_options, seams, 56);
PLACE(cscd_detector_options, seam_count, 64);
PLACE(cscd_detector_options, min_separation, 72);
PLACE(cscd_detector_options, tolerance, 80);
PLACE(cscd_detector_options, step_factor, 88);

SIZE(cscd_contact, 96);
PLACE(cscd_contact, kind, 0);
PLACE(cscd_contact, a, 4);
PLACE(cscd_contact, b, 8);
PLACE(cscd_contact, toi, 16);
PLACE(cscd_contact, u, 24);
PLACE(cscd_contact, v, 32);
PLACE(cscd_contact, point, 40);
PLACE(cscd_contact, normal, 64);
PLACE(cscd_contact, bounded, 88);

SIZE(cscd_contacts, 16);
PLACE(cscd_contacts, items, 0);
PLACE(cscd_contacts, count, 8);

SIZE(cscd_intersection, 8);
PLACE(cscd_intersection, a, 0);
PLACE(cscd_intersection, b, 4);

SIZE(cscd_intersections, 24);
PLACE(cscd_intersections, items, 0);
PLACE(cscd_intersections, count, 8);
PLACE(cscd_intersections, zero_area_triangles, 16);
PLACE(cscd_intersections, first_zero_area, 20);

SIZE(cscd_guarantee, 8);
PLACE(cscd_guarantee, complete, 0);
PLACE(cscd_guarantee, start_embedded, 1);
PLACE(cscd_guarantee, reason, 4);

SIZE(cscd_timings, 64);
PLACE(cscd_timings, update_ms, 0);
PLACE(cscd_timings, orientation_ms, 8);
PLACE(cscd_timings, contour_ms, 16);
PLACE(cscd_timings, traversal_ms, 24);
PLACE(cscd_timings, contact_ms, 32);
PLACE(cscd_timings, total_ms, 40);
PLACE(cscd_timings, proof_ms, 48);
PLACE(cscd_timings, check_ms, 56);

SIZE(cscd_counters, 152);
PLACE(cscd_counters, static_checks, 0);
PLACE(cscd_counters, clean, 8);
PLACE(cscd_counters, rebuilds, 16);
PLACE(cscd_counters, passes, 24);
PLACE(cscd_counters, plus, 32);
PLACE(cscd_counters, minus, 40);
PLACE(cscd_counters, contours, 48);
PLACE(cscd_counters, sealed, 56);
PLACE(cscd_counters, boxes_tested, 64);
PLACE(cscd_counters, pcp, 72);
PLACE(cscd_counters, adjacent, 80);
PLACE(cscd_counters, feature_pairs, 88);
PLACE(cscd_counters, tests, 96);
PLACE(cscd_counters, by_signs, 104);
PLACE(cscd_counters, by_roots, 112);
PLACE(cscd_counters, by_exact, 120);
PLACE(cscd_counters, vf, 128);
PLACE(cscd_counters, ee, 136);
PLACE(cscd_counters, bounded, 144);

SIZE(cscd_stencil, 48);
PLACE(cscd_stencil, vertices, 0);
PLACE(cscd_stencil, weights, 16);

SIZE(cscd_proximity, 88);
PLACE(cscd_proximity, kind, 0);
PLACE(cscd_proximity, a, 4);
PLACE(cscd_proximity, b, 8);
PLACE(cscd_proximity, distance, 16);
PLACE(cscd_proximity, u, 24);
PLACE(cscd_proximity, v, 32);
PLACE(cscd_proximity, point, 40);
PLACE(cscd_proximity, normal, 64);

SIZE(cscd_proximities, 16);
PLACE(cscd_proximities, items, 0);
PLACE(cscd_proximities, count, 8);

SIZE(cscd_free_step, 112);
PLACE(cscd_free_step, length, 0);
PLACE(cscd_free_step, limited, 8);
PLACE(cscd_free_step, limit, 16);

#endif

/* The functions are declared again: other parameters or results would not compile. */

const char *cscd_status_string(cscd_status status);
const char *cscd_simd_name(cscd_simd simd);
bool cscd_simd_from_name(const char *name, cscd_simd *out);
cscd_context_options cscd_context_defaults(void);
cscd_status cscd_context_create(const cscd_context_options *options, cscd_context **out);
void cscd_context_destroy(cscd_context *context);
const char *cscd_context_detail(const cscd_context *context);
uint32_t cscd_context_thread_count(const cscd_context *context);
cscd_simd cscd_context_simd(const cscd_context *context);
size_t cscd_context_bytes(const cscd_context *context);

cscd_status cscd_mesh_create(cscd_context *context, const cscd_mesh_desc *desc, cscd_mesh **out);
void cscd_mesh_destroy(cscd_mesh *mesh);
cscd_status cscd_mesh_create_scene(cscd_context *context, const cscd_object_desc *objects,
                                   uint32_t object_count, cscd_mesh **out);
uint32_t cscd_mesh_object_count(const cscd_mesh *mesh);
cscd_object cscd_mesh_object(const cscd_mesh *mesh, uint32_t object);
uint32_t cscd_mesh_vertex_object(const cscd_mesh *mesh, uint32_t vertex);
uint32_t cscd_mesh_vertex_count(const cscd_mesh *mesh);
uint32_t cscd_mesh_triangle_count(const cscd_mesh *mesh);
void cscd_mesh_triangle(const cscd_mesh *mesh, uint32_t triangle, uint32_t vertices[3]);
uint32_t cscd_mesh_edge_count(const cscd_mesh *mesh);
void cscd_mesh_edge(const cscd_mesh *mesh, uint32_t edge, uint32_t vertices[2]);
void cscd_mesh_triangle_edges(const cscd_mesh *mesh, uint32_t triangle, uint32_t edges[3]);
const uint32_t *cscd_mesh_vertex_triangles(const cscd_mesh *mesh, uint32_t vertex, uint32_t *count);
const uint32_t *cscd_mesh_edge_triangles(const cscd_mesh *mesh, uint32_t edge, uint32_t *count);
uint32_t cscd_mesh_component_count(const cscd_mesh *mesh);
cscd_component cscd_mesh_component(const cscd_mesh *mesh, uint32_t component);
uint32_t cscd_mesh_triangle_component(const cscd_mesh *mesh, uint32_t triangle);
uint64_t cscd_mesh_hash(const cscd_mesh *mesh);
cscd_status cscd_mesh_pack(const cscd_mesh *mesh, const cscd_view *views, double *positions);

const char *cscd_method_name(cscd_method method);
bool cscd_method_from_name(const char *name, cscd_method *out);
cscd_plan_options cscd_plan_defaults(void);
cscd_status cscd_plan_create(const cscd_mesh *mesh, const double *positions, const cscd_plan_options *options,
                             cscd_plan **out);
void cscd_plan_destroy(cscd_plan *plan);
cscd_status cscd_plan_create_from_parts(const cscd_mesh *mesh, const double *positions,
                                        const cscd_plan_parts *parts, cscd_plan **out);
cscd_method cscd_plan_method(const cscd_plan *plan);
uint32_t cscd_plan_region_count(const cscd_plan *plan);
cscd_region cscd_plan_region(const cscd_plan *plan, uint32_t region);
uint32_t cscd_plan_triangle_region(const cscd_plan *plan, uint32_t triangle);
double cscd_plan_triangle_charge(const cscd_plan *plan, uint32_t triangle);
double cscd_plan_capacitance(const cscd_plan *plan, uint32_t component);
cscd_preprocess_timings cscd_plan_timings(const cscd_plan *plan);

const char *cscd_mode_name(cscd_mode mode);
bool cscd_mode_from_name(const char *name, cscd_mode *out);
const char *cscd_volume_name(cscd_volume volume);
bool cscd_volume_from_name(const char *name, cscd_volume *out);
cscd_detector_options cscd_detector_defaults(void);
cscd_status cscd_detector_create(const cscd_mesh *mesh, const cscd_plan *plan,
                                 const cscd_detector_options *options, cscd_detector **out);
void cscd_detector_destroy(cscd_detector *detector);
const char *cscd_contact_kind_name(cscd_contact_kind kind);
cscd_status cscd_detector_set_separation(cscd_detector *detector, double min_separation, double tolerance);
cscd_status cscd_detector_step(cscd_detector *detector, const double *start, const double *end,
                               cscd_contacts *out);
cscd_status cscd_detector_check(cscd_detector *detector, const double *positions, cscd_intersections *out);
const char *cscd_reason_text(cscd_reason reason);
cscd_guarantee cscd_detector_guarantee(const cscd_detector *detector, uint32_t component);
int cscd_detector_orientation(const cscd_detector *detector, uint32_t triangle);
uint32_t cscd_detector_region_count(const cscd_detector *detector);
void cscd_detector_region_point(const cscd_detector *detector, uint32_t region, double start[3],
                                double end[3]);
cscd_timings cscd_detector_timings(const cscd_detector *detector);
cscd_counters cscd_detector_counters(const cscd_detector *detector);

cscd_stencil cscd_mesh_stencil(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b,
                               double u, double v);
cscd_status cscd_detector_near(cscd_detector *detector, const double *positions, double distance,
                               cscd_proximities *out);
cscd_status cscd_detector_max_step(cscd_detector *detector, const double *x0, const double *x1, double *end,
                                   cscd_free_step *out);
cscd_status cscd_line_create(cscd_detector *detector, cscd_line **out);
void cscd_line_destroy(cscd_line *line);
cscd_status cscd_line_begin(cscd_line *line, const double *x0, const double *x1, double reach);
size_t cscd_line_candidate_count(const cscd_line *line);
cscd_status cscd_line_positions(const cscd_line *line, double length, double *positions);
cscd_status cscd_line_max_step(cscd_line *line, double longest, double *end, cscd_free_step *out);
cscd_status cscd_line_near(cscd_line *line, double length, double distance, cscd_proximities *out);

const char *cscd_version_string(void);

/* The headers without comments. */
#define HEADERS "${CC:-cc} -E -P -Iinclude include/cscd/cscd.h"

static void expect_none(const char *what, char *missing) {
    if (missing[0] != '\0')
        fail_msg("%s that are not in tests/install/test_api_frozen*.c:\n%s", what, missing);
    free(missing);
}

static void nothing_public_is_missing_here(void **state) {
    (void)state;
    expect_none(
        "enumerators",
        shell_output(0, HEADERS
                     " | sed -n '/^typedef enum cscd_/,/}/p' | grep -oE 'CSCD_[A-Z_0-9]+' | "
                     "while read -r name; do grep -q \"VALUE($name, \" tests/install/test_api_frozen*.c || "
                     "echo $name; done"));
    /* Prints "TYPE" or "TYPE, MEMBER" on each line; a pointer to a function is named in its first
     * parentheses. */
    expect_none(
        "structures and members",
        shell_output(
            0, HEADERS
            " | sed -n '/^typedef struct cscd_.*{/,/^}/p' | "
            "sed 's/(\\*\\([a-z_]*\\))(.*/\\1;/' | "
            "awk '/^typedef/ { type = $3; print \"SIZE(\" type } /^ / { gsub(/[*;]|\\[[^]]*\\]/, \"\"); "
            "n = split($0, names, \",\"); for (i = 1; i <= n; i++) { "
            "m = split(names[i], words, \" \"); print \"PLACE(\" type \", \" words[m] } }' | "
            "while read -r name; do grep -qF \"$name, \" "
            "tests/install/test_api_frozen*.c || echo \"$name\"; done"));
    expect_none("functions",
                shell_output(0, HEADERS
                             " | tr '\\n' ' ' | grep -oE '\\bcscd_[a-z_0-9]+\\(' | "
                             "while read -r name; do grep -qF \"$name\" tests/install/test_api_frozen*.c || "
                             "echo $name; done"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_public_is_missing_here),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
