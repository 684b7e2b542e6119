/* Orphan pairs where each edge has two triangles, by the few features that can be one.
 *
 * Let a and b be edges without a common vertex, p and p' the corners opposite a, q and q' those opposite b. They are an orphan
 * pair if each triangle at a shares a vertex with each one at b: for every choice of one of p, p' and one of q, q' the first
 * lies in b, or the second in a, or they are the same. With p != p' and q != q' this leaves three cases:
 * - p and p' are the ends of b;
 * - q and q' are the ends of a;
 * - else one of p, p' is not in b, say p', and one of q, q' is not in a, say q'. So p' = q'. By p and q', p lies in b; by p' and
 *   q, q lies in a. So b is an edge at p of a triangle (p, q, x) that follows the triangle (a, p) across its edge (p, q), and
 *   the other corner opposite b is p'.
 *
 * A triangle f that shares a vertex with every triangle at a vertex v, and has not v itself, has a vertex on each of them. Each
 * vertex of f lies on at most two triangles at v, so v has at most six. */
#include "runtime/narrow_phase/orphan_edges.h"

#include <string.h>

enum { NO_EDGE = UINT32_MAX, TRIANGLES_AT_MOST = 6 };

/* ---- which edges are even ------------------------------------------------------------------------------- */

static bool has_two_triangles(const uint32_t opposites[2]) {
    return opposites[0] < MANY_CORNERS && opposites[1] < MANY_CORNERS && opposites[0] != opposites[1];
}

static void mark_corners(const uint32_t triangle[3], bool *vertices) {
    for (int i = 0; i < 3; i++) vertices[triangle[i]] = true;
}

/* Marks the corners of triangles one of whose edges is not in the set. */
static void mark_beside(const cscd_mesh *mesh, const bool *edges, bool *vertices) {
    memset(vertices, 0, mesh->vertex_count * sizeof *vertices);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *e = mesh->triangle_edges[t];
        if (!edges[e[0]] || !edges[e[1]] || !edges[e[2]]) mark_corners(mesh->triangles[t], vertices);
    }
}

/* An edge is even if it and all edges of the triangles at its ends have two triangles each. */
void orphan_edges_mark(const orphan_search *f, bool *uneven) {
    const cscd_mesh *mesh = f->mesh;
    for (uint32_t e = 0; e < mesh->edge_count; e++) f->even[e] = has_two_triangles(f->opposites[e]);
    mark_beside(mesh, f->even, uneven);
    for (uint32_t e = 0; e < mesh->edge_count; e++)
        f->even[e] = f->even[e] && !uneven[mesh->edges[e][0]] && !uneven[mesh->edges[e][1]];
    mark_beside(mesh, f->even, uneven);
}

/* ---- edges ------------------------------------------------------------------------------------------------ */

/* Returns the edge of a triangle that joins two of its corners. */
static uint32_t edge_in(const cscd_mesh *mesh, uint32_t triangle, uint32_t v, uint32_t w) {
    for (int i = 0; i < 3; i++) {
        const uint32_t *ends = mesh->edges[mesh->triangle_edges[triangle][i]];
        if ((ends[0] == v && ends[1] == w) || (ends[0] == w && ends[1] == v))
            return mesh->triangle_edges[triangle][i];
    }
    return NO_EDGE;
}

static uint32_t edge_between(const cscd_mesh *mesh, uint32_t v, uint32_t w) {
    for (uint32_t i = mesh->vertex_star_offsets[v]; i < mesh->vertex_star_offsets[v + 1]; i++) {
        uint32_t triangle = mesh->vertex_stars[i];
        if (triangle_contains(mesh->triangles[triangle], w)) return edge_in(mesh, triangle, v, w);
    }
    return NO_EDGE;
}

static uint32_t star_size_of(const cscd_mesh *mesh, uint32_t v) {
    return mesh->vertex_star_offsets[v + 1] - mesh->vertex_star_offsets[v];
}

static uint32_t other_of(const uint32_t two[2], uint32_t one) {
    return two[0] == one ? two[1] : two[0];
}

static void add_edges(orphan_search *f, uint32_t a, uint32_t b) {
    orphan_search_add(f, &f->ee, a < b ? a : b, a < b ? b : a);
}

/* The corners opposite a are the ends of b. Where it is so the other way as well, the pair is found twice. */
static void find_across(orphan_search *f, uint32_t a) {
    const uint32_t *ends = f->mesh->edges[a], *p = f->opposites[a];
    orphan_search_look(f, star_size_of(f->mesh, p[0]));
    uint32_t b = edge_between(f->mesh, p[0], p[1]);
    if (b == NO_EDGE || !f->even[b]) return;
    const uint32_t *q = f->opposites[b];
    bool both = (q[0] == ends[0] && q[1] == ends[1]) || (q[0] == ends[1] && q[1] == ends[0]);
    if (!both || a < b) add_edges(f, a, b);
}

/* The third case, for one corner p opposite a, in this triangle, and one end q of a. Each pair is found from both edges. */
static void find_beside(orphan_search *f, uint32_t a, uint32_t triangle, uint32_t p, uint32_t q) {
    const cscd_mesh *mesh = f->mesh;
    uint32_t shared = edge_in(mesh, triangle, p, q);
    uint32_t next = other_of(mesh->edge_stars + mesh->edge_star_offsets[shared], triangle);
    uint32_t x = other_of(f->opposites[shared], other_of(mesh->edges[a], q));
    uint32_t b = edge_in(mesh, next, p, x);
    if (a < b && f->even[b] && other_of(f->opposites[b], q) == other_of(f->opposites[a], p))
        add_edges(f, a, b);
}

static void find_pairs_of(orphan_search *f, uint32_t a) {
    const cscd_mesh *mesh = f->mesh;
    const uint32_t *triangles = mesh->edge_stars + mesh->edge_star_offsets[a];
    find_across(f, a);
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 2; k++) find_beside(f, a, triangles[i], f->opposites[a][i], mesh->edges[a][k]);
    }
}

void orphan_edges_of(orphan_search *f, uint32_t t) {
    for (int i = 0; i < 3; i++) {
        uint32_t edge = f->mesh->triangle_edges[t][i];
        if ((f->features[t] >> (3 + i) & 1) != 0 && f->even[edge]) find_pairs_of(f, edge);
    }
}

/* ---- vertices --------------------------------------------------------------------------------------------- */

/* Looks at the triangles at one corner of a triangle at v that have neither v nor the other corner, if there is one. */
static void find_faces_at(orphan_search *f, uint32_t v, uint32_t corner, uint32_t other) {
    const cscd_mesh *mesh = f->mesh;
    orphan_search_look(f, star_size_of(mesh, corner));
    for (uint32_t i = mesh->vertex_star_offsets[corner]; i < mesh->vertex_star_offsets[corner + 1]; i++) {
        uint32_t u = mesh->vertex_stars[i];
        const uint32_t *corners = mesh->triangles[u];
        if (!triangle_contains(corners, v) && !triangle_contains(corners, other) &&
            orphan_search_says_vertex(mesh, v, u))
            orphan_search_add(f, &f->vf, v, u);
    }
}

/* A triangle of an orphan pair shares a vertex with the first triangle at v, so one of its other two corners. */
void orphan_edges_vertices(orphan_search *f, uint32_t t) {
    const cscd_mesh *mesh = f->mesh;
    for (int i = 0; i < 3; i++) {
        uint32_t v = mesh->triangles[t][i];
        if ((f->features[t] >> i & 1) == 0) continue;
        if (mesh->vertex_star_offsets[v + 1] - mesh->vertex_star_offsets[v] > TRIANGLES_AT_MOST) continue;
        uint32_t p = mesh->triangles[t][(i + 1) % 3], q = mesh->triangles[t][(i + 2) % 3];
        find_faces_at(f, v, p, UINT32_MAX);
        find_faces_at(f, v, q, p);
    }
}
