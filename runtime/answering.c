/* Which triangle pair answers for a pair of features, so that each is tested once. */
#include "runtime/answering.h"

/* Features of two triangles that each represents. Branches cost more here than what they would save. */
static uint32_t represented(uint8_t a, uint8_t b) {
    uint32_t edges_a = a >> 3 & 7u, edges_b = b >> 3 & 7u;
    uint32_t each = (edges_a & 1u) | (edges_a & 2u) << 2 | (edges_a & 4u) << 4;
    return (a & 7u) | (b & 7u) << FEATURE_VERTEX_B | (each * edges_b) << FEATURE_EDGES;
}

/* ---- pairs of adjacent triangles are left out -------------------------------------------------------- */

/* The first pair of the stars that is not adjacent answers: that of the representatives, or, where these are
 * adjacent, one of the next. */

/* Whether no triangle before `of` in the star is a stranger to the face. */
static bool first_at_vertex(const cscd_mesh *mesh, uint32_t of, uint32_t vertex, const uint32_t face[3]) {
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        uint32_t s = mesh->vertex_stars[i];
        if (s == of) return true;
        if (!triangles_share_vertex(mesh->triangles[s], face)) return false;
    }
    return false;
}

/* pair.a contains the edge of the smaller number. */
static bool first_at_edges(const cscd_mesh *mesh, triangle_pair pair, uint32_t a, uint32_t b) {
    for (uint32_t i = mesh->edge_star_offsets[a]; i < mesh->edge_star_offsets[a + 1]; i++) {
        for (uint32_t j = mesh->edge_star_offsets[b]; j < mesh->edge_star_offsets[b + 1]; j++) {
            uint32_t s = mesh->edge_stars[i], t = mesh->edge_stars[j];
            if (s == pair.a && t == pair.b) return true;
            if (!triangles_share_vertex(mesh->triangles[s], mesh->triangles[t])) return false;
        }
    }
    return false;
}

static bool first_stranger(const swept_interval *interval, uint32_t of, int i, uint32_t against) {
    const cscd_mesh *mesh = interval->mesh;
    uint32_t vertex = mesh->triangles[of][i];
    const uint32_t *others = interval->representatives->others[vertex], *face = mesh->triangles[against];
    bool adjacent = triangle_contains(face, others[0]) || triangle_contains(face, others[1]);
    return adjacent && first_at_vertex(mesh, of, vertex, face);
}

/* Vertices of the representatives of a triangle's edges that are not the edges'. */
static void opposite_vertices(const swept_interval *interval, uint32_t triangle, uint32_t out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = interval->representatives->opposite[interval->mesh->triangle_edges[triangle][i]];
}

/* Of a triangle's edges, those that contain one of a set of its corners. */
static uint32_t edges_at(uint32_t corners) {
    return corners | corners >> 1 | (corners & 1u) << 2;
}

static uint32_t equal_to(uint32_t x, const uint32_t of[3]) {
    return (uint32_t)(x == of[0]) | (uint32_t)(x == of[1]) << 1 | (uint32_t)(x == of[2]) << 2;
}

/* The pairs of edges, bits from 0 on, whose representatives share a vertex, if the edges share none. All nine
 * at once: branches cost more here than what they would save. */
static uint32_t adjacent_edges(const uint32_t over_a[3], const uint32_t over_b[3],
                               const uint32_t corners_a[3], const uint32_t corners_b[3]) {
    uint32_t pairs = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t of_b = edges_at(equal_to(over_a[i], corners_b)) | equal_to(over_a[i], over_b);
        uint32_t of_a = edges_at(equal_to(over_b[i], corners_a));
        pairs |= of_b << (3 * i) | ((of_a & 1u) | (of_a & 2u) << 2 | (of_a & 4u) << 4) << i;
    }
    return pairs;
}

static uint32_t first_stranger_edges(const swept_interval *interval, triangle_pair pair, uint32_t edges) {
    const cscd_mesh *mesh = interval->mesh;
    uint32_t over_a[3], over_b[3], kept = 0;
    opposite_vertices(interval, pair.a, over_a);
    opposite_vertices(interval, pair.b, over_b);
    edges &= adjacent_edges(over_a, over_b, mesh->triangles[pair.a], mesh->triangles[pair.b]);
    for (; edges != 0; edges &= edges - 1) {
        int bit = __builtin_ctz(edges);
        uint32_t a = mesh->triangle_edges[pair.a][bit / 3], b = mesh->triangle_edges[pair.b][bit % 3];
        bool first = a < b ? first_at_edges(mesh, pair, a, b)
                           : first_at_edges(mesh, (triangle_pair){pair.b, pair.a}, b, a);
        kept |= (uint32_t)first << bit;
    }
    return kept;
}

/* Of features of which not both triangles are the representatives. */
static uint32_t first_strangers(const swept_interval *interval, triangle_pair pair, uint32_t features) {
    uint32_t kept = 0, edges = features >> FEATURE_EDGES;
    for (uint32_t rest = features & ((1u << FEATURE_EDGES) - 1); rest != 0; rest &= rest - 1) {
        int bit = __builtin_ctz(rest), i = bit - FEATURE_VERTEX_B;
        bool first = i >= 0 ? first_stranger(interval, pair.b, i, pair.a)
                            : first_stranger(interval, pair.a, bit, pair.b);
        kept |= (uint32_t)first << bit;
    }
    return edges == 0 ? kept : kept | first_stranger_edges(interval, pair, edges) << FEATURE_EDGES;
}

/* ---- with culling -------------------------------------------------------------------------------------- */

/* The first pair, in the order of the stars, that the flags leave answers (then it is reached, for its
 * volumes contain the features'); in a closing pass none, if the earlier flags left one: then these features
 * are tested already. */
static bool first_kept_vertex(const swept_interval *interval, uint32_t of, int corner, uint32_t against) {
    const cscd_mesh *mesh = interval->mesh;
    uint32_t vertex = mesh->triangles[of][corner], first = UINT32_MAX;
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        uint32_t s = mesh->vertex_stars[i];
        if (first == UINT32_MAX && culling_keeps(interval->culling, s, against)) {
            first = s;
            if (first != of || !interval->closing) break;
        }
        if (interval->closing && culling_kept(interval->culling, s, against)) return false;
    }
    return first == of;
}

/* pair.a contains the edge of the smaller number. */
static bool first_kept_edges(const swept_interval *interval, triangle_pair pair, uint32_t a, uint32_t b) {
    const cscd_mesh *mesh = interval->mesh;
    uint32_t begin_a = mesh->edge_star_offsets[a], end_a = mesh->edge_star_offsets[a + 1];
    uint32_t begin_b = mesh->edge_star_offsets[b], end_b = mesh->edge_star_offsets[b + 1];
    bool found = false;
    for (uint32_t i = begin_a; i < end_a; i++) {
        for (uint32_t j = begin_b; j < end_b; j++) {
            uint32_t s = mesh->edge_stars[i], t = mesh->edge_stars[j];
            if (!found && culling_keeps(interval->culling, s, t)) {
                if (s != pair.a || t != pair.b) return false;
                if (!interval->closing) return true;
                found = true;
            }
            if (interval->closing && culling_kept(interval->culling, s, t)) return false;
        }
    }
    return found;
}

static bool first_kept(const swept_interval *interval, triangle_pair pair, int bit) {
    if (bit < FEATURE_VERTEX_B) return first_kept_vertex(interval, pair.a, bit, pair.b);
    if (bit < FEATURE_EDGES) return first_kept_vertex(interval, pair.b, bit - FEATURE_VERTEX_B, pair.a);
    int i = (bit - FEATURE_EDGES) / 3, j = (bit - FEATURE_EDGES) % 3;
    uint32_t a = interval->mesh->triangle_edges[pair.a][i], b = interval->mesh->triangle_edges[pair.b][j];
    if (a < b) return first_kept_edges(interval, pair, a, b);
    return first_kept_edges(interval, (triangle_pair){pair.b, pair.a}, b, a);
}

/* ---- all of them --------------------------------------------------------------------------------------- */

uint32_t answering_select(const swept_interval *interval, triangle_pair pair, uint32_t features) {
    uint32_t kept = 0;
    if (interval->culling != NULL) {
        for (uint32_t rest = features; rest != 0; rest &= rest - 1) {
            int bit = __builtin_ctz(rest);
            kept |= (uint32_t)first_kept(interval, pair, bit) << bit;
        }
        return kept;
    }
    const uint8_t *owned = interval->representatives->owned;
    uint32_t both = represented(owned[pair.a], owned[pair.b]);
    kept = features & both;
    if (!interval->strangers || kept == features) return kept;
    return kept | first_strangers(interval, pair, features & ~both);
}
