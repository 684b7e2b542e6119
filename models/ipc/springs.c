/* Elasticity of closed bodies by springs: along the edges of the surface, and as struts across the inside. */
#include "models/common/vec3.h"
#include "models/ipc/newton_system.h"

#include <stdlib.h>
#include <string.h>

enum { STRUTS = 5 };

/* The tangent of the angle between tilted struts and the normal. */
static const double tilt = 0.7;

static const double *corner_of(const body *b, uint32_t triangle, uint32_t corner) {
    return b->positions + (size_t)b->triangles[triangle * 3 + corner] * 3;
}

/* The normal is as long as twice the area. */
static void triangle_normal(const body *b, uint32_t triangle, double out[3]) {
    double along[3], aside[3];
    vec3_subtract(corner_of(b, triangle, 1), corner_of(b, triangle, 0), along);
    vec3_subtract(corner_of(b, triangle, 2), corner_of(b, triangle, 0), aside);
    vec3_cross(along, aside, out);
}

void ipc_vertex_areas(const body *b, double *areas) {
    memset(areas, 0, b->vertex_count * sizeof *areas);
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        double normal[3];
        triangle_normal(b, t, normal);
        for (uint32_t k = 0; k < 3; k++) areas[b->triangles[t * 3 + k]] += vec3_norm(normal) / 6.0;
    }
}

/* Returns where a ray leaves the body through the triangle (Moeller and Trumbore), as a multiple of the
 * direction, or INFINITY where it misses. */
static double ray_length(const body *b, uint32_t triangle, const double from[3], const double direction[3]) {
    double along[3], aside[3], offset[3], p[3], q[3];
    const double *origin = corner_of(b, triangle, 0);
    vec3_subtract(corner_of(b, triangle, 1), origin, along);
    vec3_subtract(corner_of(b, triangle, 2), origin, aside);
    vec3_subtract(from, origin, offset);
    vec3_cross(direction, aside, p);
    vec3_cross(offset, along, q);
    double volume = vec3_dot(along, p), u = vec3_dot(offset, p) / volume, v = vec3_dot(direction, q) / volume;
    double length = vec3_dot(aside, q) / volume;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && length > 0.0 ? length : INFINITY;
}

/* Spheres around the triangles; a ray misses most of them. */
typedef struct sphere {
    double centre[3], squared_radius;
} sphere;

static sphere *triangle_spheres(const body *b) {
    sphere *spheres = body_allocate(b->triangle_count, sizeof *spheres);
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        for (uint32_t k = 0; k < 3; k++) vec3_add_scaled(spheres[t].centre, 1.0 / 3.0, corner_of(b, t, k));
        for (uint32_t k = 0; k < 3; k++) {
            double away[3];
            vec3_subtract(corner_of(b, t, k), spheres[t].centre, away);
            spheres[t].squared_radius = fmax(spheres[t].squared_radius, 1.0001 * vec3_dot(away, away));
        }
    }
    return spheres;
}

static bool passes_by(const sphere *s, const double from[3], const double direction[3]) {
    double offset[3];
    vec3_subtract(s->centre, from, offset);
    double along = vec3_dot(offset, direction), squared = vec3_dot(direction, direction);
    return (vec3_dot(offset, offset) - s->squared_radius) * squared > along * along;
}

/* Returns the vertex next to where the ray from a vertex comes to the surface again, or the vertex itself
 * when it does not. */
static uint32_t opposite_vertex(const body *b, const sphere *spheres, uint32_t vertex,
                                const double direction[3]) {
    const double *from = b->positions + (size_t)vertex * 3;
    uint32_t hit = UINT32_MAX, nearest = vertex;
    double least = INFINITY, end[3] = {from[0], from[1], from[2]};
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const uint32_t *v = b->triangles + (size_t)t * 3;
        if (passes_by(&spheres[t], from, direction)) continue;
        if (v[0] == vertex || v[1] == vertex || v[2] == vertex) continue;
        double length = ray_length(b, t, from, direction);
        if (!(length < least)) continue;
        least = length;
        hit = t;
    }
    if (hit == UINT32_MAX) return vertex;
    vec3_add_scaled(end, least, direction);
    least = INFINITY;
    for (uint32_t k = 0; k < 3; k++) {
        double away[3];
        vec3_subtract(corner_of(b, hit, k), end, away);
        if (!(vec3_norm(away) < least)) continue;
        least = vec3_norm(away);
        nearest = b->triangles[hit * 3 + k];
    }
    return nearest;
}

/* Adds a spring between two vertices in the numbers of the body. A strut's stiffness is divided by its
 * length. */
static void add_spring(ipc_springs *springs, const body *b, uint32_t v, uint32_t w, double stiffness,
                       double per_length) {
    double along[3];
    if (springs->count == springs->capacity) {
        springs->capacity = springs->capacity > 0 ? 2 * springs->capacity : 1024;
        ipc_spring *grown = body_allocate(springs->capacity, sizeof *grown);
        if (springs->count > 0) memcpy(grown, springs->items, springs->count * sizeof *grown);
        free(springs->items);
        springs->items = grown;
    }
    vec3_subtract(b->positions + (size_t)w * 3, b->positions + (size_t)v * 3, along);
    double rest = vec3_norm(along);
    springs->items[springs->count++] =
        (ipc_spring){v < w ? v : w, v < w ? w : v, rest, stiffness + per_length / rest};
}

static void add_struts(ipc_springs *springs, const body *b, double solid) {
    double *normals = body_allocate(b->vertex_count, 3 * sizeof *normals);
    double *areas = body_allocate(b->vertex_count, sizeof *areas);
    sphere *spheres = triangle_spheres(b);
    ipc_vertex_areas(b, areas);
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        double normal[3];
        triangle_normal(b, t, normal);
        for (uint32_t k = 0; k < 3; k++)
            vec3_add_scaled(normals + (size_t)b->triangles[t * 3 + k] * 3, 1.0, normal);
    }
    for (uint32_t v = 0; v < b->vertex_count; v++) {
        static const double leans[STRUTS][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
        double *normal = normals + (size_t)v * 3, one[3], other[3];
        if (!vec3_normalize(normal)) continue;
        int flat = fabs(normal[0]) < fabs(normal[1]) ? 0 : 1;
        vec3_cross(normal, (double[3]){flat == 0, flat == 1, 0.0}, one);
        vec3_normalize(one);
        vec3_cross(normal, one, other);
        for (int i = 0; i < STRUTS; i++) {
            double inward[3] = {-normal[0], -normal[1], -normal[2]};
            vec3_add_scaled(inward, tilt * leans[i][0], one);
            vec3_add_scaled(inward, tilt * leans[i][1], other);
            uint32_t w = opposite_vertex(b, spheres, v, inward);
            if (w != v) add_spring(springs, b, v, w, 0.0, solid * areas[v] / STRUTS);
        }
    }
    free(normals);
    free(areas);
    free(spheres);
}

static int by_ends(const void *p, const void *q) {
    const ipc_spring *s = p, *t = q;
    if (s->a != t->a) return s->a < t->a ? -1 : 1;
    if (s->b != t->b) return s->b < t->b ? -1 : 1;
    return (s->stiffness > t->stiffness) - (s->stiffness < t->stiffness);
}

void ipc_springs_add_body(ipc_springs *springs, const body *b, uint32_t first_vertex,
                          const ipc_stuff *stuff) {
    uint32_t before = springs->count, kept = before;
    for (uint32_t t = 0; t < b->triangle_count; t++) { /* closed: every edge is met in both directions */
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = b->triangles[t * 3 + k], w = b->triangles[t * 3 + (k + 1) % 3];
            if (v < w) add_spring(springs, b, v, w, stuff->membrane, 0.0);
        }
    }
    add_struts(springs, b, stuff->solid);
    qsort(springs->items + before, springs->count - before, sizeof *springs->items, by_ends);
    for (uint32_t i = before; i < springs->count; i++) {
        ipc_spring s = springs->items[i], *last = &springs->items[kept - 1];
        s.a += first_vertex;
        s.b += first_vertex;
        if (kept > before && last->a == s.a && last->b == s.b)
            last->stiffness += s.stiffness;
        else
            springs->items[kept++] = s;
    }
    springs->count = kept;
}

void ipc_springs_free(ipc_springs *springs) {
    free(springs->items);
    *springs = (ipc_springs){0};
}

/* Returns the length, and the direction from a to b. */
static double spring_length(const ipc_spring *s, const double *positions, double direction[3]) {
    vec3_subtract(positions + (size_t)s->b * 3, positions + (size_t)s->a * 3, direction);
    double length = vec3_norm(direction);
    vec3_normalize(direction);
    return length;
}

double ipc_springs_energy(const ipc_springs *springs, const double *positions) {
    double sum = 0.0;
    for (uint32_t i = 0; i < springs->count; i++) {
        const ipc_spring *s = &springs->items[i];
        double direction[3], longer = spring_length(s, positions, direction) - s->rest;
        sum += 0.5 * s->stiffness * longer * longer;
    }
    return sum;
}

void ipc_springs_add_gradient(const ipc_springs *springs, const double *positions, double *gradient) {
    for (uint32_t i = 0; i < springs->count; i++) {
        const ipc_spring *s = &springs->items[i];
        double direction[3], force = s->stiffness * (spring_length(s, positions, direction) - s->rest);
        vec3_add_scaled(gradient + (size_t)s->a * 3, -force, direction);
        vec3_add_scaled(gradient + (size_t)s->b * 3, force, direction);
    }
}

void ipc_springs_hessians(const ipc_springs *springs, const double *positions, ipc_spring_hessian *hessians) {
    for (uint32_t i = 0; i < springs->count; i++) {
        const ipc_spring *s = &springs->items[i];
        ipc_spring_hessian *h = &hessians[i];
        double length = spring_length(s, positions, h->n);
        h->aside = length > s->rest ? s->stiffness * (1.0 - s->rest / length) : 0.0;
        h->along = s->stiffness - h->aside;
    }
}

void ipc_springs_add_product(const ipc_springs *springs, const ipc_spring_hessian *hessians, const double *x,
                             double *out) {
    for (uint32_t i = 0; i < springs->count; i++) {
        const ipc_spring_hessian *h = &hessians[i];
        size_t a = (size_t)springs->items[i].a * 3, b = (size_t)springs->items[i].b * 3;
        double apart[3];
        vec3_subtract(x + a, x + b, apart);
        double along = h->along * vec3_dot(h->n, apart);
        for (int k = 0; k < 3; k++) {
            double force = along * h->n[k] + h->aside * apart[k];
            out[a + (size_t)k] += force;
            out[b + (size_t)k] -= force;
        }
    }
}
