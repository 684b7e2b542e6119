/* Closed meshes with adjacency: their edges can be flipped, split and collapsed. */
#include "models/shapes/surface.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const uint32_t none = UINT32_MAX;

static void *grow_list(void *block, uint32_t *capacity, uint32_t count, uint32_t room) {
    if (room <= *capacity) return block;
    *capacity = room + room / 2;
    uint32_t *larger = body_allocate(*capacity, sizeof *larger);
    if (count > 0) memcpy(larger, block, count * sizeof *larger);
    free(block);
    return larger;
}

/* Sorts half-edges by their origin; then each finds its twin among those that start at its end. */
static void find_twins(surface *s) {
    const body *b = &s->mesh;
    uint32_t count = b->triangle_count * 3;
    uint32_t *starts = body_allocate(b->vertex_count + 1, sizeof *starts);
    uint32_t *sorted = body_allocate(count, sizeof *sorted);
    for (uint32_t h = 0; h < count; h++) starts[b->triangles[h]]++;
    for (uint32_t v = 0, sum = 0; v <= b->vertex_count; v++)
        starts[v] = sum += v < b->vertex_count ? starts[v] : 0;
    for (uint32_t h = count; h-- > 0;) sorted[--starts[b->triangles[h]]] = h;
    for (uint32_t h = 0; h < count; h++) {
        uint32_t from = half_edge_from(s, h), to = half_edge_to(s, h);
        s->out[from] = h;
        for (uint32_t i = starts[to]; i < starts[to + 1]; i++)
            if (half_edge_to(s, sorted[i]) == from) s->twins[h] = sorted[i];
    }
    free(starts);
    free(sorted);
}

void surface_open(surface *s, body *mesh) {
    *s = (surface){.mesh = *mesh, .live_triangles = mesh->triangle_count};
    *mesh = (body){0};
    s->twins = grow_list(NULL, &s->twin_capacity, 0, s->mesh.triangle_count * 3);
    s->out = grow_list(NULL, &s->out_capacity, 0, s->mesh.vertex_count);
    find_twins(s);
}

void surface_close(surface *s, body *mesh) {
    uint32_t *names = body_allocate(s->mesh.vertex_count, sizeof *names);
    *mesh = (body){0};
    for (uint32_t v = 0; v < s->mesh.vertex_count; v++) {
        const double *p = s->mesh.positions + (size_t)v * 3;
        if (s->out[v] != none) names[v] = body_add_vertex(mesh, p[0], p[1], p[2]);
    }
    for (uint32_t t = 0; t < s->mesh.triangle_count; t++) {
        const uint32_t *v = s->mesh.triangles + (size_t)t * 3;
        if (!triangle_is_dead(s, t)) body_add_triangle(mesh, names[v[0]], names[v[1]], names[v[2]]);
    }
    free(names);
    free(s->twins);
    free(s->out);
    body_free(&s->mesh);
    *s = (surface){0};
}

uint32_t surface_valence(const surface *s, uint32_t vertex) {
    uint32_t count = 0, h = s->out[vertex];
    do {
        h = half_edge_turn(s, h);
        count++;
    } while (h != s->out[vertex]);
    return count;
}

double surface_squared_length(const surface *s, uint32_t h) {
    const double *p = s->mesh.positions + (size_t)half_edge_from(s, h) * 3;
    const double *q = s->mesh.positions + (size_t)half_edge_to(s, h) * 3;
    double x = q[0] - p[0], y = q[1] - p[1], z = q[2] - p[2];
    return x * x + y * y + z * z;
}

static void normal_of(const double *p, const double *q, const double *r, double n[3]) {
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = q[k] - p[k];
        b[k] = r[k] - p[k];
    }
    for (int k = 0; k < 3; k++) n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Whether two normals are more than 60 degrees apart, or one of them is zero. */
static bool turned_over(const double n[3], const double m[3]) {
    double dot = n[0] * m[0] + n[1] * m[1] + n[2] * m[2];
    double nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], mm = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
    return dot <= 0.5 * sqrt(nn * mm);
}

static bool are_neighbours(const surface *s, uint32_t a, uint32_t b) {
    uint32_t h = s->out[a];
    do {
        if (half_edge_to(s, h) == b) return true;
        h = half_edge_turn(s, h);
    } while (h != s->out[a]);
    return false;
}

static void join_twins(surface *s, uint32_t h, uint32_t twin) {
    s->twins[h] = twin;
    s->twins[twin] = h;
}

/* Replaces the triangles (a, b, c) and (b, a, d) by (d, b, c) and (c, a, d). */
bool surface_flip(surface *s, uint32_t h) {
    uint32_t g = s->twins[h], h1 = half_edge_next(h), h2 = half_edge_next(h1), g1 = half_edge_next(g),
             g2 = half_edge_next(g1);
    uint32_t *v = s->mesh.triangles, a = v[h], b = v[g], c = v[h2], d = v[g2];
    const double *x = s->mesh.positions;
    const double *pa = x + (size_t)a * 3, *pb = x + (size_t)b * 3, *pc = x + (size_t)c * 3,
                 *pd = x + (size_t)d * 3;
    double before[2][3], after[2][3];
    if (are_neighbours(s, c, d) || surface_valence(s, a) <= 4 || surface_valence(s, b) <= 4) return false;
    normal_of(pa, pb, pc, before[0]);
    normal_of(pb, pa, pd, before[1]);
    normal_of(pd, pb, pc, after[0]);
    normal_of(pc, pa, pd, after[1]);
    for (int i = 0; i < 4; i++)
        if (turned_over(before[i / 2], after[i % 2])) return false;
    uint32_t beside_c = s->twins[h2], beside_d = s->twins[g2]; /* of c a, and of d b */
    v[h] = d;
    v[g] = c;
    s->out[a] = g1;
    s->out[b] = h1;
    /* h: d b, h1: b c, h2: c d; g: c a, g1: a d, g2: d c */
    join_twins(s, h, beside_d);
    join_twins(s, g, beside_c);
    join_twins(s, h2, g2);
    s->out[c] = g;
    s->out[d] = h;
    return true;
}

/* Whether the two ends have no common neighbours except the two corners opposite the edge. */
static bool is_link(const surface *s, uint32_t h) {
    uint32_t a = half_edge_from(s, h), b = half_edge_to(s, h), common = 0, i = s->out[a];
    do {
        common += are_neighbours(s, b, half_edge_to(s, i));
        i = half_edge_turn(s, i);
    } while (i != s->out[a]);
    uint32_t c = s->mesh.triangles[half_edge_previous(h)];
    uint32_t d = s->mesh.triangles[half_edge_previous(s->twins[h])];
    return common == 2 && surface_valence(s, c) > 4 && surface_valence(s, d) > 4;
}

/* Whether the triangles around vertex v, except the two at the edge to `other`, keep their sides when v
 * moves, or have the side of `normal`, if it is given: the own normal of a sliver says little. */
static bool can_move(const surface *s, uint32_t v, uint32_t other, const double at[3], const double *normal) {
    const double *x = s->mesh.positions;
    uint32_t h = s->out[v];
    do {
        uint32_t to = half_edge_to(s, h), last = s->mesh.triangles[half_edge_previous(h)];
        double before[3], after[3];
        const double *q = x + (size_t)to * 3, *r = x + (size_t)last * 3;
        normal_of(x + (size_t)v * 3, q, r, before);
        normal_of(at, q, r, after);
        bool turned = turned_over(before, after) && (normal == NULL || turned_over(normal, after));
        if (to != other && last != other && turned) return false;
        h = half_edge_turn(s, h);
    } while (h != s->out[v]);
    return true;
}

void surface_normal(const surface *s, uint32_t vertex, double normal[3]) {
    const double *x = s->mesh.positions, *p = x + (size_t)vertex * 3;
    uint32_t h = s->out[vertex];
    double sum[3] = {0.0, 0.0, 0.0}, length = 0.0;
    do {
        double n[3];
        normal_of(p, x + (size_t)half_edge_to(s, h) * 3,
                  x + (size_t)s->mesh.triangles[half_edge_previous(h)] * 3, n);
        for (int k = 0; k < 3; k++) sum[k] += n[k];
        h = half_edge_turn(s, h);
    } while (h != s->out[vertex]);
    for (int k = 0; k < 3; k++) length += sum[k] * sum[k];
    length = sqrt(length);
    for (int k = 0; k < 3; k++) normal[k] = length > 0.0 ? sum[k] / length : 0.0;
}

bool surface_move(surface *s, uint32_t vertex, const double at[3]) {
    double normal[3];
    surface_normal(s, vertex, normal);
    if (!can_move(s, vertex, none, at, normal)) return false;
    memcpy(s->mesh.positions + (size_t)vertex * 3, at, 3 * sizeof *at);
    return true;
}

/* Removes the end b, and with it the triangles (a, b, c) and (b, a, d). */
bool surface_collapse(surface *s, uint32_t h, const double at[3]) {
    uint32_t g = s->twins[h], a = half_edge_from(s, h), b = half_edge_from(s, g);
    if (!is_link(s, h) || !can_move(s, a, b, at, NULL) || !can_move(s, b, a, at, NULL)) return false;
    uint32_t h1 = half_edge_next(h), h2 = half_edge_next(h1), g1 = half_edge_next(g), g2 = half_edge_next(g1);
    uint32_t c = half_edge_from(s, h2), d = half_edge_from(s, g2), *v = s->mesh.triangles;
    for (uint32_t i = half_edge_turn(s, g); i != g; i = half_edge_turn(s, i)) v[i] = a;
    uint32_t bc = s->twins[h1], ca = s->twins[h2], ad = s->twins[g1], db = s->twins[g2];
    join_twins(s, bc, ca);
    join_twins(s, ad, db);
    s->out[a] = ca;
    s->out[b] = none;
    s->out[c] = bc;
    s->out[d] = ad;
    for (uint32_t k = 0; k < 3; k++) v[h / 3 * 3 + k] = v[g / 3 * 3 + k] = none;
    s->live_triangles -= 2;
    memcpy(s->mesh.positions + (size_t)a * 3, at, 3 * sizeof *at);
    return true;
}

/* Replaces (a, b, c) by (a, m, c) and (m, b, c), and (b, a, d) by (b, m, d) and (m, a, d). */
void surface_split(surface *s, uint32_t h, const double at[3]) {
    uint32_t g = s->twins[h], h1 = half_edge_next(h), g1 = half_edge_next(g);
    uint32_t b = half_edge_to(s, h), a = half_edge_to(s, g);
    uint32_t c = half_edge_to(s, h1), d = half_edge_to(s, g1);
    uint32_t m = body_add_vertex(&s->mesh, at[0], at[1], at[2]);
    s->out = grow_list(s->out, &s->out_capacity, m, m + 1);
    uint32_t first = s->mesh.triangle_count * 3;
    body_add_triangle(&s->mesh, m, b, c);
    body_add_triangle(&s->mesh, m, a, d);
    s->twins = grow_list(s->twins, &s->twin_capacity, first, first + 6);
    s->live_triangles += 2;
    join_twins(s, first + 1, s->twins[h1]);
    join_twins(s, first + 4, s->twins[g1]);
    s->mesh.triangles[h1] = m;
    s->mesh.triangles[g1] = m;
    join_twins(s, h1, first + 2);
    join_twins(s, g1, first + 5);
    join_twins(s, h, first + 3);
    join_twins(s, g, first);
    s->out[m] = first;
    s->out[a] = h;
    s->out[b] = g;
    s->out[c] = first + 2;
    s->out[d] = first + 5;
}

void surface_quarter(surface *s) {
    body old = {0}, fine = {0};
    surface_close(s, &old);
    surface_open(s, &old);
    const body *b = &s->mesh;
    uint32_t *middles = body_allocate((size_t)b->triangle_count * 3, sizeof *middles);
    for (uint32_t v = 0; v < b->vertex_count; v++)
        body_add_vertex(&fine, b->positions[v * 3], b->positions[v * 3 + 1], b->positions[v * 3 + 2]);
    for (uint32_t h = 0; h < b->triangle_count * 3; h++) {
        const double *p = b->positions + (size_t)half_edge_from(s, h) * 3;
        const double *q = b->positions + (size_t)half_edge_to(s, h) * 3;
        middles[h] = h < s->twins[h] ? body_add_vertex(&fine, 0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]),
                                                       0.5 * (p[2] + q[2]))
                                     : middles[s->twins[h]];
    }
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const uint32_t *v = b->triangles + (size_t)t * 3, *m = middles + (size_t)t * 3;
        for (uint32_t k = 0; k < 3; k++) body_add_triangle(&fine, v[k], m[k], m[(k + 2) % 3]);
        body_add_triangle(&fine, m[0], m[1], m[2]);
    }
    free(middles);
    surface_close(s, &old);
    body_free(&old);
    surface_open(s, &fine);
}
