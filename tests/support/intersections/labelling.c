/* Labels of triangles, and sums by pair of parts that look at every list anew for every pair of parts. */
#include "tests/support/intersections/labelling.h"

#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { DEPTHS_MAX = 20000 };

static uint32_t point_labels[DEPTHS_MAX]; /* of the points that have depths */

/* ---- labels ---------------------------------------------------------------------------------------------- */

void labelling_of_objects(labelling *l, const body_rig *r) {
    l->count = r->body_count;
    for (uint32_t i = 0; i < r->body_count; i++) {
        for (uint32_t t = 0; t < r->bodies[i].triangle_count; t++)
            l->items[r->bodies[i].first_triangle + t] = i;
    }
}

void labelling_draw(labelling *l, const body_rig *r, uint32_t count, uint64_t seed) {
    random_seed(seed);
    l->count = count;
    for (uint32_t t = 0; t < r->all.triangle_count; t++)
        l->items[t] = random_integer(0, 19) == 0 ? UINT32_MAX : (uint32_t)random_integer(0, (int)count - 1);
}

void labelling_set(const labelling *l, const body_rig *r) {
    expect_ok(cscd_detector_set_parts(r->detector, l->items, l->count));
}

/* ---- scenes ---------------------------------------------------------------------------------------------- */

void labelled_scene_open(body_rig *r, const cscd_detector_options *options, uint32_t thread_count) {
    static const double origin[3] = {0, 0, 0}, centre[3] = {0.9, 0.2, 0.1};
    body_rig_begin(r);
    body_rig_add_snake(r);
    body_rig_end_body(r);
    scene_add_sphere(&r->all, centre, 0.6, 9, 14);
    scene_add_sphere(&r->all, origin, 0.7, 5, 8); /* two components */
    body_rig_end_body(r);
    scene_add_torus(&r->all, origin, 1.0, 0.35, 24, 12, true);
    body_rig_end_body(r);
    body_rig_create(r, options, thread_count);
}

cscd_status labelled_scene_try(body_rig *r, cscd_intersection_options options) {
    options.parts = true;
    return find_intersections_packed(r->detector, r->all.x0, &options, &r->found);
}

void labelled_scene_find(body_rig *r) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.depths = true;
    expect_ok(labelled_scene_try(r, options));
}

/* ---- the brute force -------------------------------------------------------------------------------------- */

/* The label of the first triangle that has both vertices. */
static uint32_t label_at(const labelling *l, const body_rig *r, uint32_t v, uint32_t w) {
    for (uint32_t t = 0; t < r->all.triangle_count; t++) {
        const uint32_t *c = r->all.triangles + (size_t)t * 3;
        bool has_v = c[0] == v || c[1] == v || c[2] == v, has_w = c[0] == w || c[1] == w || c[2] == w;
        if (has_v && has_w) return l->items[t];
    }
    return UINT32_MAX;
}

static uint32_t label_of_point(const labelling *l, const body_rig *r, const cscd_depth *depth) {
    uint32_t ends[2] = {depth->vertex, depth->vertex};
    if (depth->vertex == UINT32_MAX && depth->edge == UINT32_MAX) return l->items[depth->face];
    if (depth->vertex == UINT32_MAX) cscd_mesh_edge(r->mesh, depth->edge, ends);
    return label_at(l, r, ends[0], ends[1]);
}

static bool are_the_two(uint32_t p, uint32_t q, uint32_t a, uint32_t b) {
    return (p == a && q == b) || (p == b && q == a);
}

static size_t count_label(const labelling *l, const body_rig *r, uint32_t label) {
    size_t count = 0;
    for (uint32_t t = 0; t < r->all.triangle_count; t++) count += l->items[t] == label;
    return count;
}

static size_t count_faces(const labelling *l, const body_rig *r, uint32_t a, uint32_t b, uint32_t side) {
    static bool seen[SCENE_TRIANGLES_MAX];
    size_t count = 0;
    memset(seen, 0, sizeof seen);
    for (size_t i = 0; i < r->found.count; i++) {
        const cscd_intersection *pair = &r->found.items[i];
        if (are_the_two(l->items[pair->a], l->items[pair->b], a, b)) seen[pair->a] = seen[pair->b] = true;
    }
    for (uint32_t t = 0; t < r->all.triangle_count; t++) count += seen[t] && l->items[t] == side;
    return count;
}

static size_t expect_triangles(const labelling *l, const body_rig *r, uint32_t a, uint32_t b,
                               cscd_part_pair *out) {
    size_t count = 0;
    for (size_t i = 0; i < r->found.count; i++) {
        const cscd_intersection *pair = &r->found.items[i];
        if (!are_the_two(l->items[pair->a], l->items[pair->b], a, b)) continue;
        out->crossing += pair->kind == CSCD_INTERSECTION_CROSSING;
        out->coplanar += pair->kind == CSCD_INTERSECTION_COPLANAR;
        out->folded += pair->kind == CSCD_INTERSECTION_FOLDED;
        out->duplicate += pair->kind == CSCD_INTERSECTION_DUPLICATE;
        out->touching += pair->kind == CSCD_INTERSECTION_TOUCHING;
        count++;
    }
    for (int k = 0; k < 2; k++) {
        uint32_t side = k == 0 ? a : b;
        size_t all = count_label(l, r, side);
        out->faces[k] = count_faces(l, r, a, b, side);
        out->shares[k] = all > 0 ? (double)out->faces[k] / (double)all : 0.0;
    }
    return count;
}

static size_t expect_curves(const labelling *l, const body_rig *r, uint32_t a, uint32_t b,
                            cscd_part_pair *out) {
    const cscd_curves *curves = r->found.curves;
    size_t count = 0;
    for (size_t i = 0; curves != NULL && i < curves->count; i++) {
        const cscd_curve *curve = &curves->items[i];
        size_t here = 0;
        for (size_t k = 0; k < curve->piece_count; k++) {
            const cscd_curve_piece *piece = &curves->pieces[curve->first_piece + k];
            size_t next = k + 1 < curve->point_count ? k + 1 : 0;
            const double *p = curves->points[curve->first_point + k].x,
                         *q = curves->points[curve->first_point + next].x;
            if (!are_the_two(l->items[piece->a], l->items[piece->b], a, b)) continue;
            out->length += sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                                (p[2] - q[2]) * (p[2] - q[2]));
            here++;
        }
        out->curves += here > 0;
        out->touching_curves += here > 0 && curve->touching;
        count += here;
    }
    return count;
}

/* Objects are the bodies. */
static uint32_t object_of_triangle(const body_rig *r, uint32_t triangle) {
    uint32_t corners[3];
    cscd_mesh_triangle(r->mesh, triangle, corners);
    return cscd_mesh_vertex_object(r->mesh, corners[0]);
}

static size_t expect_depths(const labelling *l, const body_rig *r, uint32_t a, uint32_t b,
                            cscd_part_pair *out) {
    const cscd_depths *depths = r->found.depths;
    size_t count = 0;
    out->deepest = SIZE_MAX;
    for (size_t i = 0; depths != NULL && i < depths->count; i++) {
        const cscd_depth *depth = &depths->items[i];
        if (!are_the_two(point_labels[i], l->items[depth->triangle], a, b)) continue;
        if (depth->bound > out->bound) out->bound = depth->bound;
        if (a == b && depth->patch != UINT32_MAX && depth->body != object_of_triangle(r, depth->face))
            out->in_other_body = true;
        if (count++ > 0 && depth->depth <= out->depth) continue;
        out->deepest = i;
        out->depth = depth->depth;
    }
    return count;
}

static void compare_pairs(const cscd_part_pair *found, const cscd_part_pair *expected) {
    cscd_part_pair same = *found;
    assert_true(fabs(found->length - expected->length) <= 1e-12 * expected->length);
    same.length = expected->length;
    assert_memory_equal(&same, expected, sizeof same);
}

static size_t count_listed_faces(const body_rig *r) {
    static bool seen[SCENE_TRIANGLES_MAX];
    size_t count = 0;
    memset(seen, 0, sizeof seen);
    for (size_t i = 0; i < r->found.count; i++) seen[r->found.items[i].a] = seen[r->found.items[i].b] = true;
    for (uint32_t t = 0; t < r->all.triangle_count; t++) count += seen[t];
    return count;
}

size_t labelling_compare(const labelling *l, const body_rig *r) {
    const cscd_part_pairs *found = r->found.parts;
    size_t next = 0, depths = r->found.depths != NULL ? r->found.depths->count : 0;
    assert_true(depths <= DEPTHS_MAX);
    for (size_t i = 0; i < depths; i++) point_labels[i] = label_of_point(l, r, &r->found.depths->items[i]);
    for (uint32_t i = 0; i <= l->count; i++) {
        for (uint32_t k = i; k <= l->count; k++) {
            uint32_t a = i == l->count ? UINT32_MAX : i, b = k == l->count ? UINT32_MAX : k;
            cscd_part_pair expected = {.a = a, .b = b};
            size_t count = expect_triangles(l, r, a, b, &expected);
            count += expect_curves(l, r, a, b, &expected);
            count += expect_depths(l, r, a, b, &expected);
            if (count == 0) continue;
            assert_true(next < found->count);
            compare_pairs(&found->items[next++], &expected);
        }
    }
    assert_int_equal(next, found->count);
    assert_int_equal(found->faces, count_listed_faces(r));
    assert_true(found->share == (double)found->faces / r->all.triangle_count);
    return next;
}
