/* Lloyd's iteration: k centroids of a set of points. */
#include "preprocess/regions/lloyd.h"
#include "src/core/vec3.h"

#include <string.h>

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
