/* Which pieces of intersection curves go on in each other: ends at one event. An event is an edge and a triangle, so that
 * joining compares numbers. Edges whose vertices seams unite are one edge as long as they lie at one place. */
#include "runtime/intersections/curve_links.h"

#include "src/core/sort.h"

#include <string.h>

/* What the ends of a call are at. */
typedef struct link_work {
    const named_surface *surface;
    const curve_piece *pieces;
    uint32_t *links;
} link_work;

static surface_event event_of(const link_work *work, uint64_t end) {
    return work->pieces[end / 2].ends[end % 2];
}

/* The names of an edge's vertices, the smaller one in the upper half. */
static uint64_t name_edge(const named_surface *s, uint32_t edge) {
    const uint32_t *v = s->mesh->edges[edge];
    uint32_t a = surface_name(s, v[0]), b = surface_name(s, v[1]);
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

/* The position of an edge's vertex with the smaller name, or with the larger one. */
static const double *place_of(const named_surface *s, uint32_t edge, int larger) {
    const uint32_t *v = s->mesh->edges[edge];
    int swapped = surface_name(s, v[0]) > surface_name(s, v[1]);
    return s->positions + (size_t)v[larger != swapped] * 3;
}

static bool edges_are_one(const named_surface *s, uint32_t a, uint32_t b) {
    if (a == b) return true;
    for (int i = 0; i < 2; i++) {
        const double *p = place_of(s, a, i), *q = place_of(s, b, i);
        if (p[0] != q[0] || p[1] != q[1] || p[2] != q[2]) return false;
    }
    return true;
}

/* The triangles of all edges that are one with that of an end, as far as ends of the group have them. The edges of a group
 * are few, mostly one. */
static uint32_t count_triangles(const link_work *work, const curve_key *keys, size_t count, uint32_t edge) {
    uint32_t triangles = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t other = event_of(work, keys[i].end).edge;
        bool again = !edges_are_one(work->surface, edge, other);
        for (size_t j = 0; j < i && !again; j++) again = event_of(work, keys[j].end).edge == other;
        if (!again) triangles += edge_star_size(work->surface->mesh, other);
    }
    return triangles;
}

static uint32_t link_of_lonely(uint32_t triangles) {
    return triangles <= 1 ? LINK_TO_BORDER : triangles == 2 ? LINK_TO_LEFT_OUT : LINK_TO_JUNCTION;
}

/* Joins the ends of one triangle and one pair of names. */
static void link_group(link_work *work, const curve_key *keys, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t edge = event_of(work, keys[i].end).edge, partner = 0, partners = 0;
        for (size_t j = 0; j < count; j++) {
            if (j == i || !edges_are_one(work->surface, edge, event_of(work, keys[j].end).edge)) continue;
            partner = (uint32_t)keys[j].end;
            partners++;
        }
        uint32_t triangles = count_triangles(work, keys, count, edge);
        bool joined = partners == 1 && triangles == 2;
        work->links[keys[i].end] = joined ? partner : link_of_lonely(triangles);
    }
}

/* Sorts the ends by triangle, and within a triangle by the names of the edge. */
static size_t sort_ends(link_work *work, size_t piece_count, curve_key *keys, curve_key *spare_keys) {
    size_t count = 0;
    for (uint64_t end = 0; end < 2 * piece_count; end++) {
        surface_event event = event_of(work, end);
        if (event.edge == NO_EDGE)
            work->links[end] = LINK_TO_VERTEX;
        else
            keys[count++] = (curve_key){event.triangle, end};
    }
    sort_by_number(keys, spare_keys, count, sizeof *keys);
    for (size_t i = 0; i < count; i++)
        keys[i].number = name_edge(work->surface, event_of(work, keys[i].end).edge);
    for (size_t i = 0, begin = 0; i < count; i++) { /* a run has the ends of one triangle, mostly a handful */
        if (i + 1 < count && event_of(work, keys[i + 1].end).triangle == event_of(work, keys[i].end).triangle)
            continue;
        sort_by_number(keys + begin, spare_keys, i + 1 - begin, sizeof *keys);
        begin = i + 1;
    }
    return count;
}

void curve_links_find(const named_surface *s, const curve_piece *pieces, size_t piece_count, curve_key *keys,
                      curve_key *spare_keys, uint32_t *links) {
    link_work work = {s, pieces, links};
    size_t count = sort_ends(&work, piece_count, keys, spare_keys), begin = 0;
    for (size_t i = 0; i < count; i++) {
        bool last = i + 1 == count || keys[i + 1].number != keys[i].number ||
                    event_of(&work, keys[i + 1].end).triangle != event_of(&work, keys[i].end).triangle;
        if (!last) continue;
        link_group(&work, keys + begin, i + 1 - begin);
        begin = i + 1;
    }
}
