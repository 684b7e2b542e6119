/* Which pieces of intersection curves go on in each other: ends at one event. An event is an edge and a triangle, so that
 * joining compares numbers. Edges whose vertices have the same names are one edge. */
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

static bool triangle_is_collapsed(const named_surface *s, uint32_t triangle) {
    const uint32_t *v = s->mesh->triangles[triangle];
    uint32_t a = surface_name(s, v[0]), b = surface_name(s, v[1]), c = surface_name(s, v[2]);
    return a == b || b == c || c == a;
}

/* The triangles of an edge, but those of which a seam has made an edge. */
static uint32_t count_triangles(const named_surface *s, uint32_t edge) {
    const cscd_mesh *mesh = s->mesh;
    if (s->names == NULL) return edge_star_size(mesh, edge);
    uint32_t count = 0;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++)
        count += !triangle_is_collapsed(s, mesh->edge_stars[i]);
    return count;
}

static uint32_t link_of_lonely(uint32_t triangles) {
    return triangles <= 1 ? LINK_TO_BORDER : triangles == 2 ? LINK_TO_LEFT_OUT : LINK_TO_JUNCTION;
}

/* Joins the ends of one triangle and one edge, or of edges that seams have made one. Each end has a triangle of the edge of
 * its own, so three are at a junction. */
static void link_group(link_work *work, const curve_key *keys, size_t count) {
    uint32_t first = event_of(work, keys[0].end).edge, last = event_of(work, keys[count - 1].end).edge;
    uint32_t triangles = count_triangles(work->surface, first);
    if (last != first) triangles += count_triangles(work->surface, last);
    if (count > 2) triangles = 3;
    bool joined = count == 2 && triangles == 2;
    for (size_t i = 0; i < count; i++)
        work->links[keys[i].end] = joined ? (uint32_t)keys[1 - i].end : link_of_lonely(triangles);
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

/* ---- edges that seams join ------------------------------------------------------------------------------ */

/* The first key of this number or a larger one. */
static size_t find_key(const curve_key *keys, size_t count, uint64_t number) {
    size_t low = 0;
    while (low < count) {
        size_t middle = low + (count - low) / 2;
        if (keys[middle].number < number)
            low = middle + 1;
        else
            count = middle;
    }
    return low;
}

/* An edge was found that may be joined to those of the ends: they are at no border then. */
static void count_joined_edge(link_work *work, const curve_key *keys, size_t count, uint32_t edge) {
    uint64_t number = name_edge(work->surface, edge);
    uint32_t triangles = count_triangles(work->surface, edge);
    for (size_t i = find_key(keys, count, number); i < count && keys[i].number == number; i++) {
        uint32_t *link = &work->links[keys[i].end];
        if (event_of(work, keys[i].end).edge == edge || triangles == 0) continue;
        *link = *link == LINK_TO_BORDER && triangles == 1 ? LINK_TO_LEFT_OUT : LINK_TO_JUNCTION;
    }
}

/* The triangle on the other side of a seam may have no end here, as its pair is left out. So all
 * edges of the mesh are compared with those of the ends that seem to be at a border. */
static void name_ends_at_seams(link_work *work, size_t piece_count, curve_key *keys, curve_key *spare_keys) {
    const cscd_mesh *mesh = work->surface->mesh;
    size_t count = 0;
    for (uint64_t end = 0; end < 2 * piece_count; end++) {
        if (work->links[end] == LINK_TO_BORDER)
            keys[count++] = (curve_key){name_edge(work->surface, event_of(work, end).edge), end};
    }
    sort_by_number(keys, spare_keys, count, sizeof *keys);
    for (uint32_t edge = 0; edge < mesh->edge_count && count > 0; edge++)
        count_joined_edge(work, keys, count, edge);
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
    if (s->names != NULL) name_ends_at_seams(&work, piece_count, keys, spare_keys);
}
