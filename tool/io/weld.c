/* Joins vertices that lie on each other, as exporters split them along texture seams; and finds open edges
 * that all but lie on each other. */
#include "tool/io/weld.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The cell of a grid as wide as epsilon that holds a vertex (epsilon 0: the bits of its coordinates). */
typedef struct cell {
    int64_t key[3];
} cell;

/* Chained hash of vertices by cell. */
typedef struct cell_table {
    uint32_t mask;
    uint32_t *first;       /* vertex + 1 of each bucket, 0 when empty */
    uint32_t *next;        /* the same, per vertex */
    const uint32_t *parts; /* of each vertex, which joins none of another part; NULL: all are of one */
} cell_table;

static cell cell_of(const double p[3], double epsilon) {
    cell c;
    for (int k = 0; k < 3; k++) {
        double x = p[k] + 0.0; /* -0 and 0 are one place */
        if (epsilon > 0.0)
            c.key[k] = (int64_t)fmax(-9e18, fmin(9e18, floor(x / epsilon)));
        else
            memcpy(&c.key[k], &x, sizeof x);
    }
    return c;
}

static uint32_t bucket_of(const cell_table *table, cell c) {
    uint64_t hash = 0x9e3779b97f4a7c15u;
    for (int k = 0; k < 3; k++) {
        hash = (hash ^ (uint64_t)c.key[k]) * 0xbf58476d1ce4e5b9u;
        hash ^= hash >> 29;
    }
    return (uint32_t)hash & table->mask;
}

static double distance_between(const double *a, const double *b) {
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Returns the smallest group of one cell whose first vertex is within epsilon of p, or best if that is
 * smaller. */
static uint32_t nearest_group(const cell_table *table, const double *positions, uint32_t vertex, cell c,
                              const weld *w, uint32_t best) {
    const double *p = positions + (size_t)vertex * 3;
    for (uint32_t i = table->first[bucket_of(table, c)]; i != 0; i = table->next[i - 1]) {
        uint32_t group = w->vertex_of_file_vertex[i - 1];
        if (table->parts != NULL && table->parts[i - 1] != table->parts[vertex]) continue;
        if (group < best && distance_between(p, positions + (size_t)(i - 1) * 3) <= w->epsilon) best = group;
    }
    return best;
}

static uint32_t find_group(const cell_table *table, const double *positions, uint32_t vertex, const weld *w) {
    cell home = cell_of(positions + (size_t)vertex * 3, w->epsilon);
    if (w->epsilon == 0.0) return nearest_group(table, positions, vertex, home, w, UINT32_MAX);
    uint32_t best = UINT32_MAX;
    for (int i = 0; i < 27; i++) {
        cell near = {{home.key[0] + i % 3 - 1, home.key[1] + i / 3 % 3 - 1, home.key[2] + i / 9 - 1}};
        best = nearest_group(table, positions, vertex, near, w, best);
    }
    return best;
}

/* Only the first vertex of each group enters the table: every member is then within epsilon of it, and no
 * chain of near neighbours welds what lies far apart. */
static void fill_groups(const cell_table *table, const double *positions, weld *w) {
    w->vertex_count = 0;
    for (uint32_t v = 0; v < w->file_vertex_count; v++) {
        uint32_t group = find_group(table, positions, v, w);
        if (group == UINT32_MAX) {
            uint32_t bucket = bucket_of(table, cell_of(positions + (size_t)v * 3, w->epsilon));
            table->next[v] = table->first[bucket];
            table->first[bucket] = v + 1;
            group = w->vertex_count++;
            w->file_vertex[group] = v;
        }
        w->vertex_of_file_vertex[v] = group;
    }
}

/* Groups the vertices that lie on each other, of each label by itself. */
static bool group_vertices(const double *positions, const uint32_t *labels, weld *w) {
    cell_table table = {.mask = 1, .parts = labels};
    while (table.mask < w->file_vertex_count && table.mask < UINT32_MAX / 2) table.mask = table.mask * 2 + 1;
    table.first = calloc((size_t)table.mask + 1, sizeof *table.first);
    table.next = calloc(w->file_vertex_count, sizeof *table.next);
    const bool allocated = table.first != NULL && table.next != NULL;
    if (allocated) fill_groups(&table, positions, w);
    free(table.first);
    free(table.next);
    return allocated;
}

static bool fail_memory(const weld *w, io_error *error) {
    return io_fail(error, "out of memory while welding %u vertices", w->file_vertex_count);
}

bool weld_begin(const double *positions, uint32_t vertex_count, const uint32_t *parts, double epsilon,
                weld *out, io_error *error) {
    weld w = {.epsilon = epsilon, .file_vertex_count = vertex_count};
    w.vertex_of_file_vertex = calloc(vertex_count, sizeof *w.vertex_of_file_vertex);
    w.file_vertex = calloc(vertex_count, sizeof *w.file_vertex);
    if (w.vertex_of_file_vertex == NULL || w.file_vertex == NULL || !group_vertices(positions, parts, &w)) {
        weld_free(&w);
        return fail_memory(&w, error);
    }
    *out = w;
    return true;
}

/* The first vertex, in file order, that lies farther than epsilon from the one that stands for it, or
 * UINT32_MAX. */
static uint32_t find_parted(const weld *w, const double *positions) {
    for (uint32_t v = 0; v < w->file_vertex_count; v++) {
        const uint32_t first = w->file_vertex[w->vertex_of_file_vertex[v]];
        if (first == v) continue;
        const double *a = positions + (size_t)v * 3, *b = positions + (size_t)first * 3;
        if (memcmp(a, b, 3 * sizeof *a) != 0 && distance_between(a, b) > w->epsilon) return v;
    }
    return UINT32_MAX;
}

bool weld_part(weld *w, const double *positions, uint32_t *parted, io_error *error) {
    *parted = find_parted(w, positions);
    if (*parted == UINT32_MAX) return true;
    const size_t size = (size_t)w->file_vertex_count * sizeof(uint32_t);
    uint32_t *labels = malloc(size);
    if (labels == NULL) return fail_memory(w, error);
    memcpy(labels, w->vertex_of_file_vertex, size);
    const bool grouped = group_vertices(positions, labels, w);
    free(labels);
    return grouped || fail_memory(w, error);
}

static void map_triangles(const uint32_t *triangles, uint32_t triangle_count, weld *w) {
    for (uint32_t t = 0; t < triangle_count; t++) {
        uint32_t *v = w->triangles + (size_t)w->triangle_count * 3;
        for (int i = 0; i < 3; i++) v[i] = w->vertex_of_file_vertex[triangles[(size_t)t * 3 + (size_t)i]];
        bool collapsed = v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
        if (collapsed)
            w->collapsed_triangles++;
        else
            w->file_triangle[w->triangle_count++] = t;
    }
}

bool weld_finish(weld *w, const uint32_t *triangles, uint32_t triangle_count, io_error *error) {
    w->triangles = calloc((size_t)triangle_count * 3, sizeof *w->triangles);
    w->file_triangle = calloc(triangle_count, sizeof *w->file_triangle);
    if (w->triangles == NULL || w->file_triangle == NULL) return fail_memory(w, error);
    map_triangles(triangles, triangle_count, w);
    if (w->triangle_count > 0) return true;
    if (w->epsilon > 0.0)
        return io_fail(error, "--weld %g collapses every triangle; use a smaller distance", w->epsilon);
    return io_fail(
        error, "every triangle has corners in one place, so --weld exact leaves none; give frames in which "
               "they lie apart, or give --weld none");
}

void weld_free(weld *w) {
    free(w->vertex_of_file_vertex);
    free(w->file_vertex);
    free(w->triangles);
    free(w->file_triangle);
    *w = (weld){0};
}

bool weld_positions(const weld *w, const double *file_positions, double *out, io_error *error) {
    for (uint32_t v = 0; v < w->vertex_count; v++)
        memcpy(out + (size_t)v * 3, file_positions + (size_t)w->file_vertex[v] * 3, 3 * sizeof *out);
    for (uint32_t v = 0; v < w->file_vertex_count; v++) {
        uint32_t first = w->file_vertex[w->vertex_of_file_vertex[v]];
        double apart = distance_between(file_positions + (size_t)v * 3, file_positions + (size_t)first * 3);
        if (apart <= w->epsilon) continue;
        return io_fail(error,
                       "vertices %u and %u were welded but lie %g apart, expected at most %g; "
                       "weld with a larger distance, or not at all",
                       first, v, apart, w->epsilon);
    }
    return true;
}

/* ---- near seams ---------------------------------------------------------------------------------------- */

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

/* The place of a vertex of the object among those of the border, to which it is added if it is not there yet.
 * numbers: of each vertex of the object, from 1. */
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

/* Finds the open edges of which two or more have the same ends then. */
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
