/* Some bodies, one object each, what a detector finds where they intersect, and distances from them triangle by triangle. */
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
