/* Open edges that all but lie on each other, as rounding leaves them between triangles that bring vertices of their own. */
#include "tool/io/near_seams.h"

#include "tool/io/weld.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The border of an object: its open edges, and the vertices at their ends. */
typedef struct object_border {
    uint32_t edge_count, vertex_count;
    uint32_t (*edges)[2]; /* of vertices of the border */
    double *positions;    /* vertex_count * 3 */
} object_border;

/* The largest side of the box around an object. */
static double size_of(const double *positions, uint32_t vertex_count) {
    double size = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = (size_t)axis; i < 3 * (size_t)vertex_count; i += 3) {
            low = fmin(low, positions[i]);
            high = fmax(high, positions[i]);
        }
        size = fmax(size, high - low);
    }
    return size;
}

static bool edge_is_open(const cscd_mesh *mesh, uint32_t edge) {
    uint32_t count;
    cscd_mesh_edge_triangles(mesh, edge, &count);
    return count == 1;
}

/* The place of a vertex of the object among those of the border, to which it is added if it is not there yet. numbers: of each
 * vertex of the object, from 1. */
static uint32_t place_vertex(object_border *border, uint32_t *numbers, const double *positions,
                             uint32_t vertex) {
    if (numbers[vertex] == 0) {
        memcpy(border->positions + (size_t)border->vertex_count * 3, positions + (size_t)vertex * 3,
               3 * sizeof *positions);
        numbers[vertex] = ++border->vertex_count;
    }
    return numbers[vertex] - 1;
}

static void collect_edges(const cscd_mesh *mesh, const cscd_object *object, const double *positions,
                          uint32_t *numbers, object_border *border) {
    for (uint32_t e = object->first_edge; e < object->first_edge + object->edge_count; e++) {
        uint32_t ends[2];
        if (!edge_is_open(mesh, e)) continue;
        cscd_mesh_edge(mesh, e, ends);
        uint32_t *edge = border->edges[border->edge_count++];
        for (int i = 0; i < 2; i++)
            edge[i] = place_vertex(border, numbers, positions, ends[i] - object->first_vertex);
    }
}

static uint32_t count_open_edges(const cscd_mesh *mesh, const cscd_object *object) {
    uint32_t count = 0;
    for (uint32_t e = object->first_edge; e < object->first_edge + object->edge_count; e++)
        count += edge_is_open(mesh, e);
    return count;
}

static void free_border(object_border *border) {
    free(border->edges);
    free(border->positions);
}

static bool find_border(const cscd_mesh *mesh, const cscd_object *object, const double *positions,
                        object_border *out) {
    const size_t count = count_open_edges(mesh, object);
    object_border border = {.edge_count = 0};
    if (count == 0) return false;
    uint32_t *numbers = calloc(object->vertex_count, sizeof *numbers);
    border.edges = calloc(count, sizeof *border.edges);
    border.positions = calloc(2 * count, 3 * sizeof *border.positions);
    const bool allocated = numbers != NULL && border.edges != NULL && border.positions != NULL;
    if (allocated)
        collect_edges(mesh, object, positions, numbers, &border);
    else
        free_border(&border);
    free(numbers);
    if (allocated) *out = border;
    return allocated;
}

/* ---- joining ------------------------------------------------------------------------------------------- */

/* An open edge, by what its ends are joined to, the smaller one first. */
typedef struct joined_edge {
    uint32_t ends[2], edge;
} joined_edge;

static int compare_edges(const void *left, const void *right) {
    const joined_edge *l = left, *r = right;
    for (int i = 0; i < 2; i++)
        if (l->ends[i] != r->ends[i]) return l->ends[i] < r->ends[i] ? -1 : 1;
    return l->edge < r->edge ? -1 : l->edge > r->edge;
}

static double gap_of_edge(const object_border *border, const weld *w, uint32_t edge) {
    double gap = 0.0;
    for (int i = 0; i < 2; i++) {
        const uint32_t vertex = border->edges[edge][i],
                       first = w->file_vertex[w->vertex_of_file_vertex[vertex]];
        const double *a = border->positions + (size_t)vertex * 3, *b = border->positions + (size_t)first * 3;
        gap = fmax(gap, hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]));
    }
    return gap;
}

static bool same_ends(const joined_edge *a, const joined_edge *b) {
    return a->ends[0] == b->ends[0] && a->ends[1] == b->ends[1];
}

/* Which open edges two or more of have the same ends then. */
static void count_joined(const object_border *border, const weld *w, joined_edge *edges, near_seams *out) {
    uint32_t count = 0;
    for (uint32_t e = 0; e < border->edge_count; e++) {
        const uint32_t a = w->vertex_of_file_vertex[border->edges[e][0]],
                       b = w->vertex_of_file_vertex[border->edges[e][1]];
        if (a != b) edges[count++] = (joined_edge){{a < b ? a : b, a < b ? b : a}, e};
    }
    if (count > 0) qsort(edges, count, sizeof *edges, compare_edges);
    for (uint32_t i = 0; i < count; i++) {
        const bool joined = (i > 0 && same_ends(&edges[i], &edges[i - 1])) ||
                            (i + 1 < count && same_ends(&edges[i], &edges[i + 1]));
        if (!joined) continue;
        out->joined_edges++;
        out->gap = fmax(out->gap, gap_of_edge(border, w, edges[i].edge));
    }
}

static bool join_border(const object_border *border, double distance, near_seams *out) {
    weld w;
    *out = (near_seams){.open_edges = border->edge_count, .distance = distance};
    joined_edge *edges = calloc(border->edge_count, sizeof *edges);
    if (edges == NULL) return false;
    const bool welded = weld_begin(border->positions, border->vertex_count, NULL, distance, &w, NULL);
    if (welded) {
        count_joined(border, &w, edges, out);
        weld_free(&w);
    }
    free(edges);
    return welded;
}

/* A distance as short as it can be said, so that what is counted is what the option does. */
static double sayable_distance(double distance) {
    char text[32];
    snprintf(text, sizeof text, "%.2g", distance);
    return strtod(text, NULL);
}

/* The next power of ten above the gap joins as many edges, most likely, and changes less besides. */
static bool find_distance(const object_border *border, double most, near_seams *out) {
    near_seams widest, closer;
    if (!join_border(border, sayable_distance(most), &widest) || widest.joined_edges == 0) return false;
    *out = widest;
    if (widest.gap == 0.0) return true;
    const double distance = sayable_distance(pow(10.0, ceil(log10(1.25 * widest.gap))));
    if (distance < widest.distance && join_border(border, distance, &closer) &&
        closer.joined_edges == widest.joined_edges)
        *out = closer;
    return true;
}

bool near_seams_find(const cscd_mesh *mesh, uint32_t index, const double *positions, near_seams *out) {
    static const double SHARE_OF_SIZE = 1e-5;
    const cscd_object object = cscd_mesh_object(mesh, index);
    const double most = SHARE_OF_SIZE * size_of(positions, object.vertex_count);
    object_border border;
    if (!(most > 0x1p-300) || !find_border(mesh, &object, positions, &border)) return false;
    const bool found = find_distance(&border, most, out);
    free_border(&border);
    return found;
}
