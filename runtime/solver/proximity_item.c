/* One item of a list of proximities: vertices, weights and nearest points of a pair. */
#include "runtime/solver/proximity_item.h"

#include "runtime/ccd/ccd.h"
#include "src/core/vec3.h"

#include <string.h>

/* Returns how many of the four vertices of a stencil belong to the first feature. */
static int vertices_of_first(cscd_contact_kind kind) {
    return points_of_first(stencil_points(kind));
}

static const double *position_of(const proximity_scene *scene, uint32_t vertex) {
    return scene->positions + (size_t)vertex * 3;
}

/* Writes the vector from b's nearest point to a's. */
static void connect_points(const proximity_scene *scene, const cscd_proximity *p, double apart[3]) {
    const double *x[4];
    for (int i = 0; i < 4; i++) x[i] = position_of(scene, p->vertices[i]);
    connection_between(x, p->weights, vertices_of_first(p->kind), apart);
}

/* Written in place, because a copy need not keep the padding. */
static void begin_item(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b, double u,
                       double v, cscd_proximity *p) {
    cscd_stencil s = mesh_stencil(mesh, kind, a, b, u, v);
    memset(p, 0, sizeof *p); /* lists are compared bit for bit */
    p->kind = kind;
    p->a = a;
    p->b = b;
    p->u = u;
    p->v = v;
    memcpy(p->vertices, s.vertices, sizeof p->vertices);
    memcpy(p->weights, s.weights, sizeof p->weights);
}

void proximity_describe(const proximity_scene *scene, const cscd_contact *found, cscd_proximity *out) {
    double apart[3];
    begin_item(scene->mesh, found->kind, found->a, found->b, found->u, found->v, out);
    connect_points(scene, out, apart);
    bool vf = found->kind == CSCD_CONTACT_VF, ee = found->kind == CSCD_CONTACT_EE;
    out->distance =
        found->kind == CSCD_CONTACT_VH ? vec3_dot(apart, found->normal) : connection_length(apart);
    out->count = 1;
    out->vf_count = vf;
    out->ee_count = ee;
    out->threshold = ee ? edge_rest_threshold(scene->rest, found->a, found->b) : 0.0;
    memcpy(out->point, found->point, sizeof out->point);
    memcpy(out->normal, found->normal, sizeof out->normal);
}

/* Returns the parameter of the point of an edge that is nearest to a vertex. Squares of differences of coordinates,
 * which are at most 2^301, do not overflow; nor do they underflow, for doubles of 2^-300 and more differ by 2^-352 at
 * the least. */
static double nearest_on_edge(const proximity_scene *scene, uint32_t edge, uint32_t vertex) {
    const uint32_t *ends = scene->mesh->edges[edge];
    double along[3], offset[3];
    vec3_subtract(position_of(scene, ends[1]), position_of(scene, ends[0]), along);
    vec3_subtract(position_of(scene, vertex), position_of(scene, ends[0]), offset);
    double squared = vec3_dot(along, along);
    return squared > 0.0 ? max_of(0.0, min_of(vec3_dot(offset, along) / squared, 1.0)) : 0.0;
}

void proximity_describe_parts(const proximity_scene *scene, cscd_contact_kind kind, uint32_t a, uint32_t b,
                              cscd_proximity *out) {
    double apart[3], u = kind == CSCD_CONTACT_EV ? nearest_on_edge(scene, a, b) : 0.0;
    begin_item(scene->mesh, kind, a, b, u, 0.0, out);
    connect_points(scene, out, apart);
    out->distance = connection_length(apart);
    const double *from = position_of(scene, b);
    for (int k = 0; k < 3; k++) {
        out->point[k] = from[k] + 0.5 * apart[k];
        out->normal[k] = out->distance > 0.0 ? apart[k] / out->distance : 0.0;
    }
}

/* The squared length of the cross product of the edges' vectors. */
static double crossing_of(const proximity_scene *scene, uint32_t a, uint32_t b) {
    const uint32_t *ends_a = scene->mesh->edges[a], *ends_b = scene->mesh->edges[b];
    double along_a[3], along_b[3], across[3];
    vec3_subtract(position_of(scene, ends_a[1]), position_of(scene, ends_a[0]), along_a);
    vec3_subtract(position_of(scene, ends_b[1]), position_of(scene, ends_b[0]), along_b);
    vec3_cross(along_a, along_b, across);
    return vec3_dot(across, across);
}

/* A crossing that overflows is above every threshold; one that underflows is below every threshold that is not 0. */
bool edges_mollified(const proximity_scene *scene, uint32_t a, uint32_t b) {
    double threshold = edge_rest_threshold(scene->rest, a, b);
    return threshold > 0.0 && crossing_of(scene, a, b) < threshold;
}
