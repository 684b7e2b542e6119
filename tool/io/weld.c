/* Joins vertices that lie on each other, as exporters split them along texture seams. */
#include "tool/io/weld.h"

#include <math.h>
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

/* The first vertex, in file order, that lies farther than epsilon from the one that stands for it, or UINT32_MAX. */
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
