/* Which triangle pair answers for a pair of features. */
#include "runtime/answering.h"

#include "runtime/orphan_sets.h"

/* Where pairs of adjacent triangles are left out: the first pair of the stars that is not one. Mostly it is
 * that of the representatives, for which this has been asked before. */

static bool first_stranger_at_vertex(const swept_interval *interval, uint32_t of, uint32_t vertex,
                                     uint32_t against) {
    const cscd_mesh *mesh = interval->mesh;
    const uint32_t *others = interval->representatives->others[vertex], *face = mesh->triangles[against];
    if (!triangle_contains(face, others[0]) && !triangle_contains(face, others[1])) return false;
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        uint32_t s = mesh->vertex_stars[i];
        if (s == of) return true;
        if (!triangles_share_vertex(mesh->triangles[s], face)) return false;
    }
    return false;
}

static bool first_strangers_at_edges(const swept_interval *interval, triangle_pair pair, uint32_t a,
                                     uint32_t b) {
    const cscd_mesh *mesh = interval->mesh;
    const uint32_t *ends_a = mesh->edges[a], *ends_b = mesh->edges[b];
    uint32_t over_a = interval->representatives->opposite[a], over_b = interval->representatives->opposite[b];
    if (over_a != over_b && over_a != ends_b[0] && over_a != ends_b[1] && over_b != ends_a[0] &&
        over_b != ends_a[1])
        return false;
    for (uint32_t i = mesh->edge_star_offsets[a]; i < mesh->edge_star_offsets[a + 1]; i++) {
        for (uint32_t j = mesh->edge_star_offsets[b]; j < mesh->edge_star_offsets[b + 1]; j++) {
            uint32_t s = mesh->edge_stars[i], t = mesh->edge_stars[j];
            if (s == pair.a && t == pair.b) return true;
            if (!triangles_share_vertex(mesh->triangles[s], mesh->triangles[t])) return false;
        }
    }
    return false;
}

/* With culling: the first pair, in the order of the stars, that the flags leave (then it is reached, for its
 * volumes contain the features'); in a closing pass none, if the earlier flags left one: then these features
 * are tested already. */

static bool first_kept_vertex(const swept_interval *interval, uint32_t of, uint32_t vertex,
                              uint32_t against) {
    const cscd_mesh *mesh = interval->mesh;
    uint32_t begin = mesh->vertex_star_offsets[vertex], end = mesh->vertex_star_offsets[vertex + 1];
    uint32_t first = UINT32_MAX;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t s = mesh->vertex_stars[i];
        if (first == UINT32_MAX && culling_keeps(interval->culling, s, against)) {
            first = s;
            if (first != of || !interval->closing) break;
        }
        if (interval->closing && culling_kept(interval->culling, s, against)) return false;
    }
    return first == of;
}

bool answers_for_vertex(const swept_interval *interval, uint32_t of, int i, uint32_t against) {
    uint32_t vertex = interval->mesh->triangles[of][i];
    if (interval->culling == NULL) return first_stranger_at_vertex(interval, of, vertex, against);
    return first_kept_vertex(interval, of, vertex, against);
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

static bool first_pair(const swept_interval *interval, triangle_pair pair, uint32_t a, uint32_t b) {
    return interval->culling == NULL ? first_strangers_at_edges(interval, pair, a, b)
                                     : first_kept_edges(interval, pair, a, b);
}

bool answers_for_edges(const swept_interval *interval, triangle_pair pair, int i, int j) {
    uint32_t a = interval->mesh->triangle_edges[pair.a][i], b = interval->mesh->triangle_edges[pair.b][j];
    if (a < b) return first_pair(interval, pair, a, b);
    return first_pair(interval, (triangle_pair){pair.b, pair.a}, b, a);
}
