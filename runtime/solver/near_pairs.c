/* Pairs that are near each other where a motion starts: what they must keep, the planes that divide the space between them, and
 * how far each vertex may go towards these. */
#include "runtime/solver/near_pairs.h"

#include "runtime/ccd/ccd.h"
#include "src/core/vec3.h"

#include <string.h>

double near_separation(const near_rules *r, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (!config_is_thick(r->config)) return r->config->limit.distance;
    const swept_interval rules = {.mesh = r->mesh,
                                  .filter = {r->mesh, &r->config->pair_rules, NULL, NULL},
                                  .limit = r->config->limit,
                                  .thick = true};
    return pair_separation(&rules, kind, a, b).distance;
}

double near_pair_gap(const near_rules *r, const cscd_proximity *pair, const double points[4][3]) {
    if (pair->kind == CSCD_CONTACT_VH)
        return half_space_gap(points, r->mesh->loose.normals[pair->b], pair->separation);
    return pair_gap(stencil_points(pair->kind), points, pair->separation);
}

void near_pair_load(const double *x, const uint32_t vertices[4], double points[4][3]) {
    for (int i = 0; i < 4; i++) memcpy(points[i], x + (size_t)vertices[i] * 3, sizeof points[i]);
}

/* ---- planes -------------------------------------------------------------------------------------------- */

/* The two sides of a plane together get this share (lemma 4). */
static const double planes_share = 1.0 - 0x1p-20;

/* An obstacle needs this much more, so that rounding does not stop it just before its end. */
static const double rounded_up = 1.0 + 0x1p-40;

typedef struct division_work {
    const near_rules *rules;
    const division_quest *quest;
    division_plane *planes;
} division_work;

/* The ways that the two sides want to go beyond where they are, and may go for all other pairs. */
typedef struct approach {
    double a, b;
} approach;

static double height_above_side(const pair_plane *plane, const division_plane *out, int i) {
    return division_sign(out, i) < 0.0 ? plane->height[i] - plane->low_a : plane->high_b - plane->height[i];
}

static approach approach_of(const division_work *w, const pair_plane *plane, const division_plane *out) {
    approach wanted = {0.0, 0.0};
    for (int i = 0; i < 4; i++) {
        const double *x0 = w->quest->x0 + (size_t)out->vertices[i] * 3,
                     *x1 = w->quest->x1 + (size_t)out->vertices[i] * 3;
        double motion[3], sign = division_sign(out, i);
        vec3_subtract(x1, x0, motion);
        double length = sqrt(vec3_dot(motion, motion)),
               share = length > w->quest->farthest ? w->quest->farthest / length : 1.0;
        double towards = sign * share * vec3_dot(plane->normal, motion) - height_above_side(plane, out, i);
        double *side = sign < 0.0 ? &wanted.a : &wanted.b;
        *side = max_of(*side, towards);
    }
    return wanted;
}

static bool vertex_of_obstacle(const cscd_mesh *mesh, uint32_t vertex) {
    const cscd_object *of = &mesh->objects[cscd_mesh_vertex_object(mesh, vertex)];
    return of->obstacle || of->kind == CSCD_OBJECT_HALF_SPACE;
}

/* Returns what a gets of a room that both sides share. */
static double share_of_a(const cscd_mesh *mesh, const division_plane *plane, const approach *wanted,
                         double room) {
    double sum = wanted->a + wanted->b;
    if (sum <= room) return wanted->a + 0.5 * (room - sum);
    if (vertex_of_obstacle(mesh, plane->vertices[0])) return min_of(wanted->a * rounded_up, room);
    if (vertex_of_obstacle(mesh, plane->vertices[3])) return room - min_of(wanted->b * rounded_up, room);
    return room * (wanted->a / sum);
}

/* Finds the plane between the features of a pair. Returns how long its normal is, at the most. */
static double find_plane(const cscd_mesh *mesh, const cscd_proximity *pair, const double points[4][3],
                         pair_plane *out) {
    if (pair->kind == CSCD_CONTACT_VH) return half_space_plane(points, mesh->loose.normals[pair->b], out);
    const cscd_contact_kind points_of = stencil_points(pair->kind);
    if (!pair_plane_along(points_of, points, pair->weights, pair->normal, out))
        pair_plane_find(points_of, points, out);
    return 1.0;
}

/* The vertices of a pair without a plane stay where they are. A pair within its separation has a plane and no room, so
 * that its sides may part. */
static void divide_pair(const division_work *w, const cscd_proximity *pair, division_plane *out) {
    const cscd_mesh *mesh = w->rules->mesh;
    double points[4][3];
    pair_plane plane;
    near_pair_load(w->quest->x0, pair->vertices, points);
    double length = find_plane(mesh, pair, (const double(*)[3])points, &plane);
    *out = (division_plane){.kind = pair->kind, .room = {-1.0, -1.0, -1.0, -1.0}};
    memcpy(out->vertices, pair->vertices, sizeof out->vertices);
    if (!(plane.gap > 0.0)) return;
    double room = max_of(plane.gap - pair->separation * length, 0.0) * planes_share;
    approach wanted = approach_of(w, &plane, out);
    double for_a = share_of_a(mesh, out, &wanted, room), for_b = max_of(room - for_a, 0.0);
    memcpy(out->normal, plane.normal, sizeof out->normal);
    for (int i = 0; i < 4; i++)
        out->room[i] = (division_sign(out, i) < 0.0 ? for_a : for_b) + height_above_side(&plane, out, i);
}

static void divide_share(void *data, uint32_t index) {
    const division_work *w = data;
    size_t begin = (size_t)index * NEAR_PAIRS_PER_SHARE, end = begin + NEAR_PAIRS_PER_SHARE;
    for (size_t i = begin; i < end && i < w->quest->near->count; i++)
        divide_pair(w, &w->quest->near->items[i], &w->planes[i]);
}

/* Lists the limits of each vertex in the order of the pairs. */
static void link_limits(division_planes *p, uint32_t vertex_count) {
    for (uint32_t v = 0; v < vertex_count; v++) p->first[v] = DIVISION_NONE;
    for (size_t i = p->count; i-- > 0;) {
        division_plane *plane = &p->planes[i];
        for (int j = 4; j-- > 0;) {
            plane->next[j] = p->first[plane->vertices[j]];
            p->first[plane->vertices[j]] = 4 * i + (size_t)j;
        }
    }
}

void division_planes_find(const near_rules *rules, const division_quest *quest, division_planes *out) {
    division_work work = {rules, quest, out->planes};
    out->count = quest->near->count;
    uint32_t shares = (uint32_t)((out->count + NEAR_PAIRS_PER_SHARE - 1) / NEAR_PAIRS_PER_SHARE);
    parallel_run(rules->mesh->context->threads, shares, divide_share, &work);
    link_limits(out, rules->mesh->vertex_count);
}
