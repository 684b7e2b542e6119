/* K-means regions: vertices in k clusters, triangles by the fewest edges to a cluster's centre. */
#include "preprocess/regions/tiles.h"

#include "src/core/vec3.h"

#include <string.h>

/* ---- Lloyd's iteration --------------------------------------------------------------------------------- */

enum { POINTS_PER_LOOK = 1024 };

/* splitmix64 */
static uint64_t next_random(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Begins with the first k points of a random order. */
static void choose_centroids(const lloyd *l, uint64_t seed) {
    uint64_t state = seed;
    memcpy(l->scratch, l->points, l->point_count * sizeof *l->scratch);
    for (uint32_t i = 0; i < l->k; i++) {
        uint32_t j = i + (uint32_t)(next_random(&state) % (l->point_count - i)), chosen = l->scratch[j];
        l->scratch[j] = l->scratch[i];
        l->scratch[i] = chosen;
        memcpy(l->centroids + (size_t)i * 3, l->positions + (size_t)chosen * 3, 3 * sizeof(double));
    }
}

static uint32_t nearest_centroid(const lloyd *l, const double p[3]) {
    uint32_t nearest = 0;
    double least = 0.0;
    for (uint32_t i = 0; i < l->k; i++) {
        const double *c = l->centroids + (size_t)i * 3;
        double squared = vec3_squared_distance(p, c);
        if (i > 0 && squared >= least) continue;
        least = squared;
        nearest = i;
    }
    return nearest;
}

static bool assign_points(const lloyd *l, int round) {
    bool changed = round == 0;
    for (uint32_t i = 0; i < l->point_count; i++) {
        double share = (round + (double)i / l->point_count) / LLOYD_ROUNDS_MAX;
        if (i % POINTS_PER_LOOK == 0 && !progress_go_on(&l->context->progress, share)) return false;
        uint32_t v = l->points[i], nearest = nearest_centroid(l, l->positions + (size_t)v * 3);
        changed = changed || nearest != l->clusters[v];
        l->clusters[v] = nearest;
    }
    return changed;
}

static void move_centroids(const lloyd *l) {
    memset(l->counts, 0, l->k * sizeof *l->counts);
    for (uint32_t i = 0; i < l->point_count; i++) {
        uint32_t v = l->points[i];
        double *c = l->centroids + (size_t)l->clusters[v] * 3;
        bool first = l->counts[l->clusters[v]]++ == 0;
        for (int k = 0; k < 3; k++) c[k] = (first ? 0.0 : c[k]) + l->positions[(size_t)v * 3 + (size_t)k];
    }
    for (uint32_t i = 0; i < l->k; i++) {
        for (int k = 0; k < 3 && l->counts[i] > 0; k++)
            l->centroids[i * 3 + (uint32_t)k] /= (double)l->counts[i];
    }
}

cscd_status lloyd_run(const lloyd *l, uint64_t seed) {
    choose_centroids(l, seed);
    for (int round = 0; round < LLOYD_ROUNDS_MAX && assign_points(l, round); round++) move_centroids(l);
    return context_progress_status(l->context);
}

/* ---- regions ------------------------------------------------------------------------------------------- */

enum { NONE = UINT32_MAX };

typedef struct kmeans_work {
    const cscd_mesh *mesh;
    const double *positions;
    dual_graph graph;
    uint32_t capacity;             /* the most regions that there can be */
    uint32_t *used, *used_offsets; /* vertices with triangles, by component */
    uint32_t *shares, *firsts;     /* centroids by component: how many, and the first */
    uint32_t centroid_count;
    double *centroids;
    uint64_t *counts;
    uint32_t *labels;    /* centroid of each vertex */
    uint32_t *distances; /* of vertices, in edges */
    uint32_t *queue;
    uint32_t *regions, *pieces, *scratch; /* of triangles */
    uint32_t *piece_sizes;
    uint32_t *best; /* per centroid: a vertex, a piece or a number, by the step */
} kmeans_work;

uint32_t kmeans_capacity(const cscd_mesh *mesh, uint32_t k) {
    uint32_t useful = k < mesh->vertex_count ? k : mesh->vertex_count;
    return useful > mesh->component_count ? useful : mesh->component_count;
}

static array_list list_arrays(kmeans_work *w) {
    size_t vertices = w->mesh->vertex_count, triangles = w->mesh->triangle_count;
    size_t components = w->mesh->component_count, capacity = w->capacity;
    return (array_list){
        {ARRAY(w->used, vertices), ARRAY(w->used_offsets, components + 2), ARRAY(w->shares, components),
         ARRAY(w->firsts, components), ARRAY(w->centroids, capacity * 3), ARRAY(w->counts, capacity),
         ARRAY(w->labels, vertices), ARRAY(w->distances, vertices),
         ARRAY(w->queue, vertices > triangles ? vertices : triangles), ARRAY(w->regions, triangles),
         ARRAY(w->pieces, triangles), ARRAY(w->scratch, triangles), ARRAY(w->best, capacity),
         ARRAY(w->piece_sizes, triangles)}};
}

static void free_work(kmeans_work *w) {
    context_free_all(w->mesh->context, list_arrays(w));
    dual_graph_free(w->mesh, &w->graph);
}

static bool is_used(const cscd_mesh *mesh, uint32_t vertex) {
    return mesh->vertex_star_offsets[vertex] < mesh->vertex_star_offsets[vertex + 1];
}

static uint32_t vertex_component(const cscd_mesh *mesh, uint32_t vertex) {
    return mesh->triangle_components[mesh->vertex_stars[mesh->vertex_star_offsets[vertex]]];
}

static void list_vertices(kmeans_work *w) {
    const cscd_mesh *mesh = w->mesh;
    uint32_t *ends = w->used_offsets + 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (is_used(mesh, v)) ends[vertex_component(mesh, v) + 1]++;
    }
    for (uint32_t c = 0; c < mesh->component_count; c++) ends[c + 1] += ends[c];
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (is_used(mesh, v)) w->used[ends[vertex_component(mesh, v)]++] = v;
    }
}

static uint32_t vertices_of(const kmeans_work *w, uint32_t component) {
    return w->used_offsets[component + 1] - w->used_offsets[component];
}

/* Gives one centroid to each component, and the others one by one to that with most vertices per centroid. */
static void share_out(kmeans_work *w, uint32_t k) {
    uint32_t component_count = w->mesh->component_count, given = component_count;
    for (uint32_t c = 0; c < component_count; c++) w->shares[c] = 1;
    for (; given < k; given++) {
        uint32_t best = NONE;
        for (uint32_t c = 0; c < component_count; c++) {
            if (w->shares[c] == vertices_of(w, c)) continue;
            if (best == NONE ||
                (uint64_t)vertices_of(w, c) * w->shares[best] > (uint64_t)vertices_of(w, best) * w->shares[c])
                best = c;
        }
        if (best == NONE) break;
        w->shares[best]++;
    }
    w->centroid_count = given;
    for (uint32_t c = 1; c < component_count; c++) w->firsts[c] = w->firsts[c - 1] + w->shares[c - 1];
}

/* Finds the centroids of each component, and numbers labels over all components. */
static cscd_status find_centroids(kmeans_work *w, uint32_t seed) {
    for (uint32_t c = 0; c < w->mesh->component_count; c++) {
        lloyd l = {w->mesh->context,  w->positions, w->used + w->used_offsets[c],
                   vertices_of(w, c), w->shares[c], w->centroids + (size_t)w->firsts[c] * 3,
                   w->labels,         w->counts,    w->queue};
        double used = w->used_offsets[w->mesh->component_count];
        progress_stage(&w->mesh->context->progress, "k-means", 0.8 * w->used_offsets[c] / used,
                       0.8 * w->used_offsets[c + 1] / used);
        cscd_status status = lloyd_run(&l, (uint64_t)seed << 32 | c);
        if (status != CSCD_OK) return status;
        for (uint32_t i = 0; i < l.point_count; i++) w->labels[l.points[i]] += w->firsts[c];
    }
    return CSCD_OK;
}

/* best[i] = the vertex of cluster i that is nearest to its centroid; NONE in an empty cluster. */
static void find_anchors(kmeans_work *w) {
    uint32_t used_count = w->used_offsets[w->mesh->component_count];
    for (uint32_t i = 0; i < w->centroid_count; i++) w->best[i] = NONE;
    for (uint32_t i = 0; i < used_count; i++) {
        uint32_t v = w->used[i], label = w->labels[v], best = w->best[label];
        const double *centroid = w->centroids + (size_t)label * 3;
        if (best == NONE || vec3_squared_distance(w->positions + (size_t)v * 3, centroid) <
                                vec3_squared_distance(w->positions + (size_t)best * 3, centroid))
            w->best[label] = v;
    }
}

/* Measures distances in edges, breadth first from all anchors at once; the queue keeps labels of one distance
 * in order. */
static void measure_edges(kmeans_work *w) {
    const cscd_mesh *mesh = w->mesh;
    uint32_t end = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) w->distances[v] = NONE;
    for (uint32_t i = 0; i < w->centroid_count; i++) {
        if (w->best[i] == NONE) continue;
        w->distances[w->best[i]] = 0;
        w->labels[w->best[i]] = i;
        w->queue[end++] = w->best[i];
    }
    for (uint32_t next = 0; next < end; next++) {
        uint32_t v = w->queue[next];
        for (uint32_t i = mesh->vertex_star_offsets[v]; i < mesh->vertex_star_offsets[v + 1]; i++) {
            for (int corner = 0; corner < 3; corner++) {
                uint32_t neighbour = mesh->triangles[mesh->vertex_stars[i]][corner];
                if (w->distances[neighbour] != NONE) continue;
                w->distances[neighbour] = w->distances[v] + 1;
                w->labels[neighbour] = w->labels[v];
                w->queue[end++] = neighbour;
            }
        }
    }
}

static void assign_triangles(kmeans_work *w) {
    for (uint32_t t = 0; t < w->mesh->triangle_count; t++) {
        const uint32_t *v = w->mesh->triangles[t];
        uint32_t nearest = v[0];
        for (int corner = 1; corner < 3; corner++) {
            uint32_t x = v[corner];
            if (w->distances[x] < w->distances[nearest] ||
                (w->distances[x] == w->distances[nearest] && w->labels[x] < w->labels[nearest]))
                nearest = x;
        }
        w->regions[t] = w->labels[nearest];
    }
}

/* Keeps the largest piece of each region; its neighbours take over the other pieces, ring by ring. */
static void join_strays(kmeans_work *w) {
    uint32_t n = w->mesh->triangle_count, end = 0;
    for (uint32_t t = 0; t < n; t++) w->queue[t] = t;
    dual_graph_pieces(&w->graph, w->queue, n, w->regions, w->pieces, w->scratch);
    for (uint32_t t = 0; t < n; t++) w->piece_sizes[w->pieces[t]]++;
    for (uint32_t i = 0; i < w->centroid_count; i++) w->best[i] = NONE;
    for (uint32_t t = 0; t < n; t++) {
        uint32_t *best = &w->best[w->regions[t]];
        if (*best == NONE || w->piece_sizes[w->pieces[t]] > w->piece_sizes[*best]) *best = w->pieces[t];
    }
    for (uint32_t t = 0; t < n; t++) {
        if (w->best[w->regions[t]] == w->pieces[t])
            w->queue[end++] = t;
        else
            w->pieces[t] = NONE;
    }
    for (uint32_t next = 0; next < end; next++) {
        uint32_t t = w->queue[next];
        for (uint32_t i = w->graph.offsets[t]; i < w->graph.offsets[t + 1]; i++) {
            uint32_t neighbour = w->graph.neighbours[i];
            if (w->pieces[neighbour] != NONE) continue;
            w->pieces[neighbour] = w->pieces[t];
            w->regions[neighbour] = w->regions[t];
            w->queue[end++] = neighbour;
        }
    }
}

/* Numbers the regions that have triangles, and puts their centroids in that order. */
static void write_result(kmeans_work *w, uint32_t *region_of_triangle, uint32_t *region_count,
                         double *points) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < w->centroid_count; i++) w->best[i] = NONE;
    for (uint32_t t = 0; t < w->mesh->triangle_count; t++) {
        uint32_t label = w->regions[t];
        if (w->best[label] == NONE) {
            w->best[label] = count;
            memcpy(points + (size_t)count++ * 3, w->centroids + (size_t)label * 3, 3 * sizeof *points);
        }
        region_of_triangle[t] = w->best[label];
    }
    *region_count = count;
}

cscd_status regions_kmeans(const cscd_mesh *mesh, const double *positions, uint32_t k, uint32_t seed,
                           uint32_t *region_of_triangle, uint32_t *region_count, double *detector_points) {
    if (k == 0) return context_fail(mesh->context, CSCD_INVALID_ARGUMENT, "k-means wants one region or more");
    kmeans_work w = {.mesh = mesh, .positions = positions, .capacity = kmeans_capacity(mesh, k)};
    if (!context_allocate_all(mesh->context, list_arrays(&w))) return context_out_of_memory(mesh->context);
    cscd_status status = CSCD_OK;
    if (status == CSCD_OK) status = dual_graph_build(mesh, &w.graph);
    if (status == CSCD_OK) {
        list_vertices(&w);
        share_out(&w, k);
        status = find_centroids(&w, seed);
    }
    if (status == CSCD_OK) {
        find_anchors(&w);
        measure_edges(&w);
        assign_triangles(&w);
        join_strays(&w);
        write_result(&w, region_of_triangle, region_count, detector_points);
    }
    free_work(&w);
    return status;
}
