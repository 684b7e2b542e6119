/* Some bodies, one object each, what a detector finds where they intersect, distances from them, and sums by pair of
 * parts. */
#include "tests/support/intersections/body_rig.h"

#include "runtime/ccd/ccd.h"
#include "src/core/vec3.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { RIGS_MAX = 8 };

static body_rig *rigs[RIGS_MAX]; /* all that have created something */

void body_rig_begin(body_rig *r) {
    scene_clear(&r->all);
    r->counter = NULL;
    r->body_count = 0;
    r->orientation = CSCD_ORIENTATION_BY_OBJECT;
    r->part_bodies = false;
}

void body_rig_end_body(body_rig *r) {
    body_part *body = &r->bodies[r->body_count];
    const body_part *last = r->body_count > 0 ? &r->bodies[r->body_count - 1] : NULL;
    r->body_count++;
    assert_true(r->body_count <= BODIES_MAX);
    body->first_vertex = last != NULL ? last->first_vertex + last->vertex_count : 0;
    body->first_triangle = last != NULL ? last->first_triangle + last->triangle_count : 0;
    body->vertex_count = r->all.vertex_count - body->first_vertex;
    body->triangle_count = r->all.triangle_count - body->first_triangle;
    for (uint32_t i = 0; i < body->triangle_count * 3; i++)
        body->triangles[i] = r->all.triangles[body->first_triangle * 3 + i] - body->first_vertex;
}

void body_rig_add_box(body_rig *r, const double low[3], const double size[3]) {
    scene *s = &r->all;
    uint32_t first = s->vertex_count;
    static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (uint32_t v = 0; v < 8; v++, s->vertex_count++) {
        for (uint32_t k = 0; k < 3; k++) s->x0[(first + v) * 3 + k] = low[k] + (v >> k & 1) * size[k];
    }
    for (int i = 0; i < 6; i++) {
        const uint32_t *q = quads[i], corners[6] = {q[0], q[1], q[2], q[0], q[2], q[3]};
        for (uint32_t k = 0; k < 6; k++) s->triangles[s->triangle_count * 3 + k] = first + corners[k];
        s->triangle_count += 2;
    }
}

void body_rig_box(body_rig *r, const double low[3], const double size[3]) {
    body_rig_add_box(r, low, size);
    body_rig_end_body(r);
}

void body_rig_add_snake(body_rig *r) {
    uint32_t first = r->all.vertex_count;
    scene_add_capsule(&r->all, 7.0, 0.3, 40, 10);
    for (uint32_t v = first; v < r->all.vertex_count; v++) {
        double *x = r->all.x0 + (size_t)v * 3, angle = x[2], radius = 1.0 + x[0];
        x[1] += 0.02 * angle;
        x[0] = radius * cos(angle);
        x[2] = radius * sin(angle);
    }
}

void body_rig_add_sheet(body_rig *r, const double corner[3], const double along[3], const double up[3],
                        uint32_t columns, uint32_t rows, bool hole) {
    scene *s = &r->all;
    uint32_t first = s->vertex_count;
    for (uint32_t i = 0; i <= rows; i++) {
        for (uint32_t j = 0; j <= columns; j++) {
            for (int k = 0; k < 3; k++)
                s->x0[s->vertex_count * 3 + (uint32_t)k] =
                    corner[k] + along[k] * j / (double)columns + up[k] * i / (double)rows;
            s->vertex_count++;
        }
    }
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            if (hole && i == rows / 2 && j == columns / 2) continue;
            uint32_t a = first + i * (columns + 1) + j, b = a + 1, c = a + columns + 1, d = c + 1;
            const uint32_t corners[6] = {a, b, d, a, d, c};
            memcpy(&s->triangles[(size_t)s->triangle_count * 3], corners, sizeof corners);
            s->triangle_count += 2;
        }
    }
}

void body_rig_turn(body_rig *r, uint32_t first, uint32_t count) {
    for (uint32_t t = first; t < first + count; t++) {
        uint32_t *v = r->all.triangles + (size_t)t * 3, middle = v[1];
        v[1] = v[2];
        v[2] = middle;
    }
    for (uint32_t i = 0; i < r->body_count; i++) {
        body_part *body = &r->bodies[i];
        for (uint32_t t = 0; t < body->triangle_count * 3; t++)
            body->triangles[t] = r->all.triangles[body->first_triangle * 3 + t] - body->first_vertex;
    }
}

void body_rig_create(body_rig *r, const cscd_detector_options *options, uint32_t thread_count) {
    cscd_object_desc descs[BODIES_MAX];
    for (uint32_t i = 0; i < r->body_count; i++)
        descs[i] = cscd_object_of_triangles(r->bodies[i].vertex_count, r->bodies[i].triangle_count,
                                            r->bodies[i].triangles);
    body_rig_free(r);
    const rig made =
        rig_of_objects(context_of(thread_count, r->counter), descs, r->body_count, NULL, options);
    r->context = made.context;
    r->mesh = made.mesh;
    r->detector = made.detector;
    for (size_t i = 0; i < RIGS_MAX; i++) {
        if (rigs[i] == NULL || rigs[i] == r) {
            rigs[i] = r;
            return;
        }
    }
    fail_msg("more than %d rigs", RIGS_MAX);
}

cscd_status body_rig_try(body_rig *r) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.overlaps = options.depths = true;
    options.orientation = r->orientation;
    options.part_bodies = r->part_bodies;
    return cscd_detector_find_intersections(r->detector, CSCD_DOUBLES(r->all.x0, r->all.vertex_count),
                                            &options, &r->found);
}

void body_rig_find(body_rig *r) {
    expect_ok(body_rig_try(r));
}

void body_rig_find_all(body_rig *r) {
    body_rig_create(r, NULL, 2);
    body_rig_find(r);
}

void body_rig_free(body_rig *r) {
    cscd_detector_destroy(r->detector);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    r->detector = NULL;
    r->mesh = NULL;
    r->context = NULL;
}

int body_rigs_free(void **state) {
    (void)state;
    for (size_t i = 0; i < RIGS_MAX && rigs[i] != NULL; i++) body_rig_free(rigs[i]);
    return 0;
}

cscd_overlap body_rig_overlap(const body_rig *r, uint32_t a, uint32_t b) {
    for (size_t i = 0; i < r->found.overlaps->count; i++) {
        if (r->found.overlaps->items[i].a == a && r->found.overlaps->items[i].b == b)
            return r->found.overlaps->items[i];
    }
    return (cscd_overlap){a, b, 0.0, 0.0, 0.0};
}

void body_rig_place(body_rig *r, int axis, bool mirrored, double scale) {
    for (uint32_t v = 0; v < r->all.vertex_count; v++) {
        double *x = r->all.x0 + (size_t)v * 3, given[3];
        memcpy(given, x, sizeof given);
        for (int k = 0; k < 3; k++) x[(k + axis) % 3] = scale * (k == 1 && mirrored ? -given[k] : given[k]);
    }
    if (mirrored) body_rig_turn(r, 0, r->all.triangle_count);
}

bool body_rig_is_turned(const body_rig *r, uint32_t component) {
    const bool *turned = r->found.patches->turned;
    return turned != NULL && turned[component];
}

/* ---- distances and winding numbers --------------------------------------------------------------------- */

static const double *corner_of_body(const body_rig *r, uint32_t triangle, uint32_t i) {
    return r->all.x0 + (size_t)r->all.triangles[triangle * 3 + i] * 3;
}

double body_distance(const body_rig *r, uint32_t body, const double x[3]) {
    double least = INFINITY, u, v;
    for (uint32_t i = 0; i < r->bodies[body].triangle_count; i++) {
        uint32_t t = r->bodies[body].first_triangle + i;
        least = fmin(least, closest_point_triangle(x, corner_of_body(r, t, 0), corner_of_body(r, t, 1),
                                                   corner_of_body(r, t, 2), &u, &v));
    }
    return sqrt(least);
}

int body_number(const body_rig *r, uint32_t body, const double x[3]) {
    double sum = 0.0; /* of solid angles: van Oosterom and Strackee 1983 */
    for (uint32_t t = 0; t < r->bodies[body].triangle_count; t++) {
        double p[3][3], length[3], cross[3];
        for (uint32_t i = 0; i < 3; i++) {
            vec3_subtract(corner_of_body(r, r->bodies[body].first_triangle + t, i), x, p[i]);
            length[i] = sqrt(vec3_dot(p[i], p[i]));
        }
        vec3_cross(p[1], p[2], cross);
        double bottom = length[0] * length[1] * length[2] + vec3_dot(p[0], p[1]) * length[2] +
                        vec3_dot(p[1], p[2]) * length[0] + vec3_dot(p[2], p[0]) * length[1];
        sum += 2.0 * atan2(vec3_dot(p[0], cross), bottom);
    }
    return (int)lround(sum / (4.0 * acos(-1.0)));
}

/* ---- tangles ------------------------------------------------------------------------------------------- */

/* Puts the vertices of a body in another order, as a file does that was exported from another mesh. */
static void shuffle_vertices(scene *s, uint32_t first, uint32_t count, uint64_t seed) {
    random_stream random = stream_start(seed);
    for (uint32_t i = count; i > 1; i--) {
        double *a = &s->x0[(size_t)(first + i - 1) * 3],
               *b = &s->x0[(size_t)(first + stream_below(&random, i)) * 3];
        for (int k = 0; k < 3; k++) {
            double x = a[k];
            a[k] = b[k];
            b[k] = x;
        }
    }
}

void tangle_add_shuffled(body_rig *r, int rings, int segments) {
    static const double origin[3] = {0, 0, 0}, beside[3] = {0.5, 0.25, 0.125};
    body_rig_begin(r);
    scene_add_sphere(&r->all, origin, 1.0, rings, segments);
    shuffle_vertices(&r->all, 0, r->all.vertex_count, 1);
    body_rig_end_body(r);
    scene_add_sphere(&r->all, beside, 0.75, 4, 6);
    body_rig_end_body(r);
}

void tangle_add_soup(body_rig *r, uint32_t triangles) {
    random_stream random = stream_start(2);
    body_rig_begin(r);
    for (uint32_t i = 0; i < 3 * triangles; i++) {
        for (int k = 0; k < 3; k++) r->all.x0[3 * i + (uint32_t)k] = stream_between(&random, 0.0, 1.0);
        r->all.triangles[i] = i;
    }
    r->all.vertex_count = 3 * triangles;
    r->all.triangle_count = triangles;
    body_rig_end_body(r);
}

/* ---- labels and sums by pair of parts ------------------------------------------------------------------ */

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
