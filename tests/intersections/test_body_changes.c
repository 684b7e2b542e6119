/* Changes of curves through the public API: bodies in general positions, whose curves at both ends say what comes and
 * goes, for any method and number of threads; what is refused; memory. */
#include "tests/support/counting_allocator.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/packed.h"
#include "tests/support/refusal.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static body_rig rig; /* large; one test at a time */

/* A body that swallows its tail, a ball that goes through it, and one beside both that stays. */
static void open_scene(counting_allocator *counter, const cscd_detector_options *options,
                       uint32_t thread_count) {
    static const double centres[2][3] = {{0.9, 0.2, 0.1}, {5.0, 0.0, 0.0}};
    body_rig_begin(&rig);
    body_rig_add_snake(&rig);
    body_rig_end_body(&rig);
    for (int i = 0; i < 2; i++) {
        scene_add_sphere(&rig.all, centres[i], 0.6, 9, 14);
        body_rig_end_body(&rig);
    }
    rig.counter = counter;
    body_rig_create(&rig, options, thread_count);
    memcpy(rig.all.x1, rig.all.x0, sizeof rig.all.x0);
    for (uint32_t i = 0; i < rig.bodies[2].first_vertex * 3; i++)
        rig.all.x1[i] += i < rig.bodies[1].first_vertex * 3 ? 0.03 * (i % 5) : 0.1 * (i % 3) + 0.05;
}

static cscd_contacts step_scene(void) {
    cscd_contacts found;
    expect_ok(step_packed(rig.detector, rig.all.x0, rig.all.x1, &found));
    return found;
}

static cscd_status try_changes(const cscd_contact *contacts, size_t count, cscd_curve_changes *out) {
    return cscd_detector_curve_changes(rig.detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count),
                                       CSCD_DOUBLES(rig.all.x1, rig.all.vertex_count), contacts, count, out);
}

/* ---- what curves say ------------------------------------------------------------------------------------ */

static int compare_numbers(const void *a, const void *b) {
    uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return (p > q) - (p < q);
}

/* The points of the curves at one moment but those at vertices, by edge and triangle, sorted; malloc'ed. */
static size_t find_points(const double *positions, uint64_t **out) {
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersection_pairs found;
    size_t count = 0;
    options.curves = true;
    expect_ok(find_intersections_packed(rig.detector, positions, &options, &found));
    const cscd_curves *curves = found.curves;
    *out = malloc((curves->point_count + 1) * sizeof **out);
    assert_non_null(*out);
    for (size_t i = 0; i < curves->point_count; i++) {
        if (curves->points[i].edge != UINT32_MAX)
            (*out)[count++] = (uint64_t)curves->points[i].edge << 32 | curves->points[i].triangle;
    }
    qsort(*out, count, sizeof **out, compare_numbers);
    return count;
}

/* The list has what is in one of the two sorted lists of points only. */
static void compare_with_points(const cscd_curve_changes *changes, const uint64_t *before,
                                size_t before_count, const uint64_t *after, size_t after_count) {
    size_t i = 0, j = 0, next = 0;
    while (i < before_count || j < after_count) {
        bool goes = j == after_count || (i < before_count && before[i] < after[j]);
        bool comes = i == before_count || (j < after_count && after[j] < before[i]);
        uint64_t point = goes ? before[i] : after[j];
        i += !comes;
        j += !goes;
        if (!goes && !comes) continue;
        assert_true(next < changes->count);
        const cscd_curve_change *change = &changes->items[next++];
        assert_true(((uint64_t)change->edge << 32 | change->triangle) == point);
        assert_true(change->comes == comes);
    }
    assert_int_equal(next, changes->count);
}

TEST(changes_are_those_of_curves) {
    const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_ICCD};
    cscd_curve_change *first = NULL;
    size_t count = 0;
    for (uint32_t i = 0; i < 6; i++) {
        cscd_detector_options options = cscd_detector_defaults();
        cscd_curve_changes changes;
        uint64_t *before, *after;
        options.method = methods[i % 3];
        options.min_separation = i < 3 ? 0.0 : 0.01; /* near misses are contacts, too */
        open_scene(NULL, &options, 1 + i % 4);
        size_t before_count = find_points(rig.all.x0, &before), after_count = find_points(rig.all.x1, &after);
        cscd_contacts contacts = step_scene();
        expect_ok(try_changes(contacts.items, contacts.count, &changes));
        compare_with_points(&changes, before, before_count, after, after_count);
        assert_true(changes.count > 300 && changes.cause_count > changes.count);
        if (first == NULL) {
            count = changes.count;
            first = malloc(count * sizeof *first);
            memcpy(first, changes.items, count * sizeof *first);
        } else if (i < 3) {
            assert_int_equal(changes.count, count);
            assert_memory_equal(changes.items, first, count * sizeof *first);
        }
        free(before);
        free(after);
    }
    free(first);
}

/* ---- calls ----------------------------------------------------------------------------------------------- */

/* Half of the contacts, in reverse order, give the changes that these are causes of; the step's list stays. */
TEST(any_selection_of_contacts) {
    cscd_curve_changes changes;
    open_scene(NULL, NULL, 2);
    cscd_contacts contacts = step_scene();
    size_t half = contacts.count / 2, listed = 0;
    cscd_contact *copy = malloc(contacts.count * sizeof *copy);
    memcpy(copy, contacts.items, contacts.count * sizeof *copy);
    expect_ok(try_changes(contacts.items, contacts.count, &changes));
    assert_memory_equal(copy, contacts.items, contacts.count * sizeof *copy);
    size_t all = changes.count, expected = changes.contact_first[half];
    for (size_t i = 0; i < half; i++) copy[i] = contacts.items[half - 1 - i];
    expect_ok(try_changes(copy, half, &changes));
    assert_int_equal(changes.cause_count, expected);
    assert_true(changes.count < all && changes.count > 0);
    for (size_t i = 0; i < changes.count; i++) {
        const size_t *causes = changes.causes + changes.items[i].first_cause;
        listed += changes.items[i].cause_count;
        for (size_t k = 1; k < changes.items[i].cause_count; k++)
            assert_true(copy[causes[k - 1]].toi <= copy[causes[k]].toi);
    }
    assert_int_equal(listed, expected);
    expect_ok(try_changes(NULL, 0, &changes));
    assert_true(changes.count == 0 && changes.cause_count == 0 && changes.contact_first[0] == 0);
    free(copy);
}

/* A wire falls through a triangle and onto the ground: no curve has an edge that has no triangle. */
TEST(wires_change_nothing) {
    static const uint32_t triangle[3] = {0, 1, 2}, wire[2] = {0, 1};
    static const double up[3] = {0, 0, 1};
    static const double x0[18] = {0, 0, 1, 4, 0, 1, 0, 4, 1, 1, 1, 2, -3, 1, 3, 9, 9, 0};
    static const double x1[18] = {0, 0, 1, 4, 0, 1, 0, 4, 1, 1, 1, -3, -3, 1, -2, 9, 9, 0};
    const cscd_object_desc objects[3] = {cscd_object_of_triangles(3, 1, triangle),
                                         cscd_object_of_wires(2, 1, wire), cscd_object_half_space(up)};
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    cscd_contacts contacts;
    cscd_curve_changes changes;
    expect_ok(cscd_context_create(NULL, &context));
    expect_ok(cscd_mesh_create(context, objects, 3, &mesh));
    expect_ok(cscd_detector_create(context, mesh, NULL, NULL, &detector));
    expect_ok(step_packed(detector, x0, x1, &contacts));
    assert_true(contacts.count >=
                4); /* of the wire's end and of the wire with the triangle, and with the ground */
    expect_ok(cscd_detector_curve_changes(detector, CSCD_DOUBLES(x0, 6), CSCD_DOUBLES(x1, 6), contacts.items,
                                          contacts.count, &changes));
    assert_int_equal(changes.count, 0);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* A seam unites two corners, at one place, of a triangle that falls through another one. Then it has two vertices and no
 * curves, and so no changes. */
TEST(triangles_of_two_vertices_change_nothing) {
    static const uint32_t triangle[3] = {0, 1, 2}, seam[2] = {4, 5};
    static const double x0[18] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 3, 2, 1, 1, 2, 1, 1};
    static const double x1[18] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, 2, 1, -1, 2, 1, -1};
    const cscd_object_desc objects[2] = {cscd_object_of_triangles(3, 1, triangle),
                                         cscd_object_of_triangles(3, 1, triangle)};
    cscd_detector_options options = cscd_detector_defaults();
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    expect_ok(cscd_context_create(NULL, &context));
    expect_ok(cscd_mesh_create(context, objects, 2, &mesh));
    options.seams = seam;
    options.seam_reach = INFINITY;
    for (options.seam_count = 0; options.seam_count < 2; options.seam_count++) {
        cscd_detector *detector = NULL;
        cscd_contacts contacts;
        cscd_curve_changes changes;
        expect_ok(cscd_detector_create(context, mesh, NULL, &options, &detector));
        expect_ok(step_packed(detector, x0, x1, &contacts));
        assert_true(contacts.count > 1);
        expect_ok(cscd_detector_curve_changes(detector, CSCD_DOUBLES(x0, 6), CSCD_DOUBLES(x1, 6),
                                              contacts.items, contacts.count, &changes));
        assert_int_equal(changes.count, options.seam_count == 0 ? 2 : 0);
        cscd_detector_destroy(detector);
    }
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* Two sewn triangles and one that they fall through; then there are 300 more vertices, with the seam at other numbers. */
TEST(changes_after_a_change_of_the_mesh) {
    enum { MORE = 300 };
    static const uint32_t triangle[3] = {0, 1, 2}, seam[2] = {4, 7};
    static const double x0[27] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 3, 1, 2,
                                  3, 2, 1, 3, 3, 1, 3, 1, 2, 3, 2, 2, 3};
    static double more0[(9 + MORE) * 3], more1[(9 + MORE) * 3];
    const cscd_object_desc one = cscd_object_of_triangles(3, 1, triangle);
    const cscd_object_desc objects[3] = {one, one, one},
                           many = cscd_object_of_triangles(3 + MORE, 1, triangle);
    const cscd_object_change larger = {.object = 0, .desc = &many};
    cscd_detector_options options = cscd_detector_defaults();
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_mesh_change *change = NULL;
    cscd_detector *detector = NULL;
    options.seams = seam;
    options.seam_count = 1;
    expect_ok(cscd_context_create(NULL, &context));
    expect_ok(cscd_mesh_create(context, objects, 3, &mesh));
    expect_ok(cscd_mesh_change_create(context, mesh, &larger, 1, &change));
    expect_ok(cscd_detector_create(context, mesh, NULL, &options, &detector));
    for (uint32_t extra = 0; extra <= MORE; extra += MORE) {
        uint32_t n = 9 + extra;
        cscd_contacts contacts;
        cscd_curve_changes changes;
        memcpy(more0, x0, 9 * sizeof *x0);
        memcpy(more0 + (3 + extra) * 3, x0 + 9, 18 * sizeof *x0);
        memcpy(more1, more0, sizeof more0);
        for (uint32_t v = 3 + extra; v < n; v++) more1[v * 3 + 2] = v % 2 == 0 ? -1.0 : 1.0;
        if (extra > 0) expect_ok(cscd_detector_change_mesh(detector, change));
        expect_ok(step_packed(detector, more0, more1, &contacts));
        expect_ok(cscd_detector_curve_changes(detector, CSCD_DOUBLES(more0, n), CSCD_DOUBLES(more1, n),
                                              contacts.items, contacts.count, &changes));
        assert_true(contacts.count > 0 && changes.count > 0);
    }
    cscd_detector_destroy(detector);
    cscd_mesh_change_destroy(change);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

TEST(what_is_refused) {
    cscd_curve_changes changes;
    open_scene(NULL, NULL, 1);
    cscd_contacts contacts = step_scene();
    const cscd_view x = *CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count);
    const cscd_contact wrong = {.kind = CSCD_CONTACT_VF, .a = rig.all.vertex_count};
    assert_int_equal(cscd_detector_curve_changes(NULL, &x, &x, NULL, 0, &changes), CSCD_NULL_OBJECT);
    assert_int_equal(try_changes(NULL, 1, &changes), CSCD_INVALID_ARGUMENT);
    assert_int_equal(try_changes(contacts.items, contacts.count, NULL), CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_detector_curve_changes(rig.detector, &x, NULL, NULL, 0, &changes),
                     CSCD_INVALID_ARGUMENT);
    expect_invalid(rig.context, try_changes(&wrong, 1, &changes), "contact 0 (kind ");
    rig.all.x1[4] = NAN;
    expect_invalid(rig.context, try_changes(contacts.items, contacts.count, &changes), "x1");
}

AROUND_EACH(NULL, body_rigs_free)
