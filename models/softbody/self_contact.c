/* The response to contacts of a body with itself: each pair that cscd reports is kept on its side, gently. It is not
 * cscd_detector_make_safe, because recordings are made for detectors: after that there would be nothing to find. */
#include "models/common/vec3.h"
#include "models/shapes/body.h"
#include "models/softbody/softbody.h"

#include <stdlib.h>
#include <string.h>

/* A point of the surface, as weighted vertices. */
typedef struct surface_point {
    int count;
    uint32_t vertices[3];
    double weights[3];
} surface_point;

self_contacts self_contacts_make(const cscd_mesh *mesh, const double *rest, double near) {
    self_contacts s = {.mesh = mesh,
                       .near = near,
                       .gap = near / 40.0,
                       .depth = 0.75 * near,
                       .healing = near / 200.0,
                       .friction = 0.5};
    size_t bytes = (size_t)cscd_mesh_vertex_count(mesh) * 3 * sizeof *rest;
    s.rest = memcpy(body_allocate(bytes, 1), rest, bytes);
    return s;
}

void self_contacts_free(self_contacts *s) {
    free(s->rest);
    free(s->pairs);
    *s = (self_contacts){0};
}

/* Returns the two triangles at an edge, which exist since the body is closed. */
static const uint32_t *triangles_at(const self_contacts *s, uint32_t edge) {
    uint32_t count;
    return cscd_mesh_edge_triangles(s->mesh, edge, &count);
}

/* The normal is as long as twice the area. */
static void triangle_normal(const cscd_mesh *mesh, const double *positions, uint32_t triangle,
                            double out[3]) {
    uint32_t v[3];
    double first[3], second[3];
    cscd_mesh_triangle(mesh, triangle, v);
    vec3_subtract(positions + v[1] * 3, positions + v[0] * 3, first);
    vec3_subtract(positions + v[2] * 3, positions + v[0] * 3, second);
    vec3_cross(first, second, out);
}

/* Finds the normal that points outwards from b, across both features; false where they do not clearly face
 * each other. */
static bool outward_normal(const self_contacts *s, const double *positions, const held_pair *pair,
                           double out[3]) {
    if (pair->kind == CSCD_CONTACT_VF) {
        triangle_normal(s->mesh, positions, pair->b, out);
        return vec3_normalize(out);
    }
    uint32_t a[2], b[2];
    double along_a[3], along_b[3], facing[3] = {0.0, 0.0, 0.0};
    cscd_mesh_edge(s->mesh, pair->a, a);
    cscd_mesh_edge(s->mesh, pair->b, b);
    vec3_subtract(positions + a[1] * 3, positions + a[0] * 3, along_a);
    vec3_subtract(positions + b[1] * 3, positions + b[0] * 3, along_b);
    vec3_cross(along_a, along_b, out);
    for (int i = 0; i < 4; i++) {
        double normal[3];
        triangle_normal(s->mesh, positions, triangles_at(s, i < 2 ? pair->a : pair->b)[i % 2], normal);
        if (vec3_normalize(normal)) vec3_add_scaled(facing, i < 2 ? -0.25 : 0.25, normal);
    }
    if (vec3_norm(out) < 0.1 * vec3_norm(along_a) * vec3_norm(along_b) || !vec3_normalize(out)) return false;
    double side = vec3_dot(out, facing);
    for (int k = 0; k < 3; k++) out[k] = side < 0.0 ? -out[k] : out[k];
    return fabs(side) > 0.2;
}

static surface_point point_on_edge(const cscd_mesh *mesh, uint32_t edge, double along) {
    surface_point p = {.count = 2, .weights = {1.0 - along, along}};
    cscd_mesh_edge(mesh, edge, p.vertices);
    return p;
}

static surface_point point_on_triangle(const cscd_mesh *mesh, uint32_t triangle, double u, double v) {
    surface_point p = {.count = 3, .weights = {1.0 - u - v, u, v}};
    cscd_mesh_triangle(mesh, triangle, p.vertices);
    return p;
}

static void place_point(const surface_point *p, const double *positions, double out[3]) {
    out[0] = out[1] = out[2] = 0.0;
    for (int i = 0; i < p->count; i++) vec3_add_scaled(out, p->weights[i], positions + p->vertices[i] * 3);
}

/* Whether a comes from another part of the body, and from the outside of b. */
static bool runs_into_surface(const self_contacts *s, const cscd_contact *c, const double *start,
                              const double *end) {
    bool vf = c->kind == CSCD_CONTACT_VF;
    const held_pair pair = {c->kind, c->a, c->b};
    surface_point a = vf ? (surface_point){1, {c->a}, {1.0}} : point_on_edge(s->mesh, c->a, c->u);
    surface_point b = vf ? point_on_triangle(s->mesh, c->b, c->u, c->v) : point_on_edge(s->mesh, c->b, c->v);
    double normal[3], a_start[3], a_end[3], b_start[3], b_end[3];
    place_point(&a, s->rest, a_start);
    place_point(&b, s->rest, b_start);
    vec3_subtract(a_start, b_start, normal);
    if (vec3_norm(normal) < s->near || !outward_normal(s, start, &pair, normal)) return false;
    place_point(&a, start, a_start);
    place_point(&a, end, a_end);
    place_point(&b, start, b_start);
    place_point(&b, end, b_end);
    return vec3_dot(a_end, normal) - vec3_dot(a_start, normal) <
           vec3_dot(b_end, normal) - vec3_dot(b_start, normal);
}

static int compare_pairs(const void *left, const void *right) {
    const held_pair *a = left, *b = right;
    if (a->kind != b->kind) return a->kind < b->kind ? -1 : 1;
    if (a->a != b->a) return a->a < b->a ? -1 : 1;
    return (a->b > b->b) - (a->b < b->b);
}

void self_contacts_add(self_contacts *s, const cscd_contacts *found, const double *start, const double *end) {
    if (s->count + found->count > s->capacity) {
        held_pair *grown = body_allocate(2 * (s->count + found->count), sizeof *grown);
        if (s->count > 0) memcpy(grown, s->pairs, s->count * sizeof *grown);
        free(s->pairs);
        s->pairs = grown;
        s->capacity = 2 * (s->count + found->count);
    }
    for (size_t i = 0; i < found->count; i++) {
        const cscd_contact *c = &found->items[i];
        if (runs_into_surface(s, c, start, end)) s->pairs[s->count++] = (held_pair){c->kind, c->a, c->b};
    }
    if (s->count == 0) return;
    qsort(s->pairs, s->count, sizeof *s->pairs, compare_pairs);
    size_t kept = 1;
    for (size_t i = 1; i < s->count; i++) {
        if (compare_pairs(&s->pairs[i], &s->pairs[kept - 1]) != 0) s->pairs[kept++] = s->pairs[i];
    }
    s->count = kept;
}

/* Finds the point of the triangle below the vertex. When the vertex has slid over an edge, the pair gets
 * the next triangle; false when the vertex belongs to that one. */
static bool find_below(const self_contacts *s, const double *positions, held_pair *pair,
                       surface_point *below) {
    double normal[3], least = 0.0;
    int over = -1;
    *below = point_on_triangle(s->mesh, pair->b, 0.0, 0.0);
    triangle_normal(s->mesh, positions, pair->b, normal);
    for (int i = 0; i < 3; i++) { /* the part of the triangle that lies opposite corner i */
        const double *from = positions + below->vertices[(i + 1) % 3] * 3;
        double along[3], to_vertex[3], across[3];
        vec3_subtract(positions + below->vertices[(i + 2) % 3] * 3, from, along);
        vec3_subtract(positions + pair->a * 3, from, to_vertex);
        vec3_cross(along, to_vertex, across);
        below->weights[i] = vec3_dot(across, normal) / vec3_dot(normal, normal);
        if (below->weights[i] < least) {
            least = below->weights[i];
            over = i;
        }
    }
    if (over < 0) return true;
    double sum = 0.0;
    for (int i = 0; i < 3; i++) sum += below->weights[i] = fmax(below->weights[i], 0.0);
    for (int i = 0; i < 3; i++) below->weights[i] /= sum;
    uint32_t edges[3], v[3];
    cscd_mesh_triangle_edges(s->mesh, pair->b, edges);
    const uint32_t *beside = triangles_at(s, edges[(over + 1) % 3]);
    uint32_t next = beside[0] == pair->b ? beside[1] : beside[0];
    cscd_mesh_triangle(s->mesh, next, v);
    pair->b = next;
    return v[0] != pair->a && v[1] != pair->a && v[2] != pair->a;
}

/* Finds the nearest points of the lines of two edges; false when they lie outside of the edges. */
static bool find_nearest_points(const self_contacts *s, const double *positions, const held_pair *pair,
                                surface_point *a, surface_point *b) {
    double along_a[3], along_b[3], between[3];
    *a = point_on_edge(s->mesh, pair->a, 0.0);
    *b = point_on_edge(s->mesh, pair->b, 0.0);
    vec3_subtract(positions + a->vertices[1] * 3, positions + a->vertices[0] * 3, along_a);
    vec3_subtract(positions + b->vertices[1] * 3, positions + b->vertices[0] * 3, along_b);
    vec3_subtract(positions + b->vertices[0] * 3, positions + a->vertices[0] * 3, between);
    double aa = vec3_dot(along_a, along_a), bb = vec3_dot(along_b, along_b), ab = vec3_dot(along_a, along_b);
    double area = aa * bb - ab * ab, da = vec3_dot(along_a, between), db = vec3_dot(along_b, between);
    if (!(area > 0.0)) return false;
    double u = (da * bb - db * ab) / area, v = (da * ab - db * aa) / area;
    *a = point_on_edge(s->mesh, pair->a, u);
    *b = point_on_edge(s->mesh, pair->b, v);
    return u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0;
}

/* Returns how far the point moves for a momentum that its vertices share by their weights. */
static double point_mobility(const soft_body *soft, const surface_point *p) {
    double sum = 0.0;
    for (int i = 0; i < p->count; i++) sum += p->weights[i] * soft->vertex_mobilities[p->vertices[i]];
    return sum;
}

/* Moves the points apart by `change` in all: a gets a momentum, b its opposite. */
static void push_apart(const soft_body *soft, double *nodes, const surface_point *a, const surface_point *b,
                       const double change[3]) {
    const surface_point *const sides[2] = {a, b};
    double per_change = 1.0 / (point_mobility(soft, a) + point_mobility(soft, b));
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < sides[side]->count; i++) {
            uint32_t vertex = sides[side]->vertices[i];
            double momentum = (side == 0 ? per_change : -per_change) * sides[side]->weights[i], share[3];
            for (int k = 0; k < 3; k++) share[k] = momentum * soft->vertex_mobilities[vertex] * change[k];
            soft_body_push(soft, nodes, vertex, share);
        }
    }
}

/* Computes how the two points have moved relative to each other since the small step began. */
static void relative_motion(const soft_body *soft, const double *positions, const surface_point *a,
                            const surface_point *b, double out[3]) {
    const surface_point *const sides[2] = {a, b};
    out[0] = out[1] = out[2] = 0.0;
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < sides[side]->count; i++) {
            double before[3], weight = (side == 0 ? 1.0 : -1.0) * sides[side]->weights[i];
            lattice_place_vertex(&soft->frame, soft->previous, sides[side]->vertices[i], before);
            vec3_add_scaled(out, weight, positions + sides[side]->vertices[i] * 3);
            vec3_add_scaled(out, -weight, before);
        }
    }
}

/* Places the vertices of a pair again, since earlier pairs of the pass have moved the lattice. */
static void refresh_vertices(const self_contacts *s, soft_body *soft, const held_pair *pair) {
    uint32_t vertices[4] = {pair->a};
    if (pair->kind == CSCD_CONTACT_VF) {
        cscd_mesh_triangle(s->mesh, pair->b, vertices + 1);
    } else {
        cscd_mesh_edge(s->mesh, pair->a, vertices);
        cscd_mesh_edge(s->mesh, pair->b, vertices + 2);
    }
    for (int i = 0; i < 4; i++)
        lattice_place_vertex(&soft->frame, soft->nodes, vertices[i], soft->vertices + vertices[i] * 3);
}

/* Stops the approach of a pair. A pair that is too near parts slowly and without gaining speed, so that
 * contacts only ever take kinetic energy. Returns false when the pair has parted or is lost. */
static bool solve_pair(self_contacts *s, soft_body *soft, held_pair *pair) {
    const double *positions = soft->vertices;
    surface_point a = {1, {pair->a}, {1.0}}, b;
    double normal[3], place_a[3], place_b[3], slid[3], change[3] = {0.0, 0.0, 0.0};
    refresh_vertices(s, soft, pair);
    if (!outward_normal(s, positions, pair, normal)) return false;
    if (pair->kind == CSCD_CONTACT_VF ? !find_below(s, positions, pair, &b)
                                      : !find_nearest_points(s, positions, pair, &a, &b))
        return false;
    place_point(&a, positions, place_a);
    place_point(&b, positions, place_b);
    double distance = vec3_dot(place_a, normal) - vec3_dot(place_b, normal);
    if (distance > 2.0 * s->gap || distance < -s->depth) return false;
    double depth = s->gap - distance;
    if (depth <= 0.0) return true;
    relative_motion(soft, positions, &a, &b, slid);
    double approach = -vec3_dot(slid, normal), stopped = fmin(depth, fmax(approach, 0.0)), sliding;
    vec3_add_scaled(slid, approach, normal);
    sliding = vec3_norm(slid);
    vec3_add_scaled(change, stopped, normal);
    if (sliding > 0.0) vec3_add_scaled(change, -fmin(s->friction * stopped, sliding) / sliding, slid);
    push_apart(soft, soft->nodes, &a, &b, change);
    double healed = fmin(depth - stopped, s->healing);
    for (int k = 0; k < 3; k++) change[k] = healed * normal[k];
    push_apart(soft, soft->nodes, &a, &b, change);
    push_apart(soft, soft->previous, &a, &b, change);
    return true;
}

void self_contacts_solve(self_contacts *s, soft_body *soft) {
    size_t kept = 0;
    if (s->count == 0) return;
    lattice_place_vertices(&soft->frame, soft->nodes, soft->vertices);
    for (size_t i = 0; i < s->count; i++) {
        held_pair pair = s->pairs[i];
        if (solve_pair(s, soft, &pair)) s->pairs[kept++] = pair;
    }
    s->count = kept;
}
