/* Measures how far trees have moved since a moment. */
#include "runtime/bvh/bvh_parts.h"

#include "src/core/floating.h"

#include <math.h>
#include <string.h>

enum { CHUNK_RECORDS = 1024, SAMPLE_COUNT = 64, SAMPLED_LEAVES = 32 };

/* ---- frames ----------------------------------------------------------------------------------------------- */

/* The mean of a few vertices. Any point will do. */
static void place_origin(const uint32_t *vertices, uint32_t count, const double *x, double origin[3]) {
    uint32_t step = count / SAMPLE_COUNT + 1, samples = 0;
    double sum[3] = {0.0};
    const double *first = x + (size_t)vertices[0] * 3;
    for (uint32_t i = 0; i < count; i += step, samples++) {
        for (size_t k = 0; k < 3; k++) sum[k] += x[(size_t)vertices[i] * 3 + k] - first[k];
    }
    for (int k = 0; k < 3; k++) origin[k] = first[k] + sum[k] / samples;
}

static void place_ends(bvh_skin *s, const double *x0, const double *x1) {
    for (uint32_t i = 0; i < s->tree_count; i++) {
        skin_tree *tree = &s->trees[i];
        const uint32_t *vertices = s->vertices + tree->first_record;
        place_origin(vertices, tree->record_count, x0, tree->ends[0]);
        place_origin(vertices, tree->record_count, x1, tree->ends[1]);
    }
}

/* Returns how far a tree's frame has moved against that of the first tree, rounded up, as a length. */
static double shift_between(const double before[3], const double now[3], const double first_before[3],
                            const double first_now[3]) {
    double sum = 0.0, size = 0.0;
    for (int k = 0; k < 3; k++) {
        double shift = (now[k] - before[k]) - (first_now[k] - first_before[k]);
        sum += shift * shift;
        size += fabs(now[k]) + fabs(before[k]) + fabs(first_now[k]) + fabs(first_before[k]);
    }
    return sqrt(sum) * (1.0 + 0x1p-40) + size * 0x1p-48;
}

/* Adds the corners of one leaf. */
static void add_leaf(const bvh *hierarchy, uint32_t leaf, const double *x0, const double *x1,
                     const double by[3], skin_motion *greatest) {
    double low[3], high[3], farthest = 0.0, extent = 0.0;
    for (int i = 0; i < 3 * LANES; i++) {
        size_t at =
            (size_t)hierarchy->record_vertices[hierarchy->leaves[leaf].corners[i / LANES][i % LANES]] * 3;
        double sum = 0.0;
        for (size_t k = 0; k < 3; k++) {
            double off = (x1[at + k] - x0[at + k]) - by[k];
            low[k] = i == 0 ? off : fmin(low[k], off);
            high[k] = i == 0 ? off : fmax(high[k], off);
            sum += off * off;
        }
        farthest = fmax(farthest, sum);
    }
    for (int k = 0; k < 3; k++) extent += (high[k] - low[k]) * (high[k] - low[k]);
    greatest->distance = fmax(greatest->distance, sqrt(farthest));
    greatest->stretch = fmax(greatest->stretch, sqrt(extent));
}

skin_motion bvh_skin_estimate(const bvh *hierarchy, const double *x0, const double *x1) {
    double first[2][3];
    skin_motion greatest = {0.0, 0.0};
    for (uint32_t t = 0; t < hierarchy->tree_count; t++) {
        const bvh_tree *tree = &hierarchy->trees[t];
        const uint32_t *vertices = hierarchy->record_vertices + tree->first_record;
        uint32_t step = tree->leaf_count / SAMPLED_LEAVES + 1, end = tree->first_leaf + tree->leaf_count;
        double origin[2][3], by[3];
        skin_motion of_tree = {0.0, 0.0};
        place_origin(vertices, tree->record_count, x0, origin[0]);
        place_origin(vertices, tree->record_count, x1, origin[1]);
        if (t == 0) memcpy(first, origin, sizeof first);
        for (int k = 0; k < 3; k++) by[k] = origin[1][k] - origin[0][k];
        for (uint32_t i = tree->first_leaf; i < end; i += step) add_leaf(hierarchy, i, x0, x1, by, &of_tree);
        if (t > 0) of_tree.distance += shift_between(origin[0], origin[1], first[0], first[1]);
        greatest.distance = fmax(greatest.distance, of_tree.distance);
        greatest.stretch = fmax(greatest.stretch, of_tree.stretch);
    }
    return greatest;
}

/* ---- the reference ------------------------------------------------------------------------------------------ */

static uint32_t leaf_task_count(const bvh_skin *s) {
    return (s->leaf_count + SKIN_LEAVES - 1) / SKIN_LEAVES;
}

static array_list skin_arrays(bvh_skin *s) {
    return (array_list){{ARRAY(s->trees, s->tree_count), ARRAY(s->vertices, s->record_count),
                         ARRAY(s->items, s->record_count), ARRAY(s->leaves, s->leaf_count),
                         ARRAY(s->chunks, s->chunk_count), ARRAY(s->stretches, s->leaf_count),
                         ARRAY(s->stray_at_start, s->leaf_count), ARRAY(s->stray_at_end, s->leaf_count),
                         ARRAY(s->within, leaf_task_count(s))}};
}

static uint32_t count_chunks(const bvh *hierarchy) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < hierarchy->tree_count; i++)
        count += (hierarchy->trees[i].record_count + CHUNK_RECORDS - 1) / CHUNK_RECORDS;
    return count;
}

bool bvh_skin_reserve(bvh_skin *s, const bvh *hierarchy) {
    bvh_skin wanted = {.context = hierarchy->mesh->context,
                       .kernels = hierarchy->kernels,
                       .tree_count = hierarchy->tree_count,
                       .record_count = hierarchy->record_count,
                       .leaf_count = hierarchy->leaf_count,
                       .chunk_count = count_chunks(hierarchy)};
    if (s->context != NULL && s->tree_count == wanted.tree_count && s->record_count == wanted.record_count &&
        s->leaf_count == wanted.leaf_count && s->chunk_count == wanted.chunk_count)
        return true;
    bvh_skin_free(s);
    if (!context_allocate_all(wanted.context, skin_arrays(&wanted))) return false;
    *s = wanted;
    return true;
}

static void take_tree(bvh_skin *s, const bvh *hierarchy, uint32_t index, uint32_t *chunk) {
    const bvh_tree *tree = &hierarchy->trees[index];
    uint32_t end = tree->first_record + tree->record_count;
    skin_tree *to = &s->trees[index];
    *to = (skin_tree){.region = tree->region,
                      .first_record = tree->first_record,
                      .record_count = tree->record_count,
                      .reach = (double)tree->reach};
    memcpy(to->origin, tree->origin[0], sizeof to->origin);
    memcpy(to->detector, tree->detector[0], sizeof to->detector);
    for (uint32_t begin = tree->first_record; begin < end; begin += CHUNK_RECORDS) {
        uint32_t stop = end - begin < CHUNK_RECORDS ? end : begin + CHUNK_RECORDS;
        s->chunks[(*chunk)++] = (skin_chunk){index, begin, stop, INFINITY};
    }
}

static void take_leaf(bvh_skin *s, const bvh *hierarchy, uint32_t index) {
    skin_leaf *to = &s->leaves[index];
    memcpy(to->corners, hierarchy->leaves[index].corners, sizeof to->corners);
    to->tree = hierarchy->leaf_trees[index];
    to->plus = hierarchy->leaf_flags[index].plus;
    to->minus = hierarchy->leaf_flags[index].minus;
}

orientation_lasting bvh_skin_lasting(const bvh_skin *s, const bvh *hierarchy, double distance,
                                     double least_stretch) {
    return (orientation_lasting){float_above(distance * hierarchy->scale),
                                 float_above(least_stretch * hierarchy->scale), s->stretches};
}

/* Floats are off by 2^-24 of what a record is off by, which is at most the distance. The square of what is smaller than
 * 2^-40 may underflow: that much is not allowed then. Where nothing is oriented, anything is. */
static float squared_stretch(float stretch, float distance) {
    double least = ((double)stretch * (1.0 - 0x1p-20) - (double)distance * 0x1p-20);
    return least < 0x1p-40 ? 0.0f : least < 0x1p40 ? (float)(least * least * (1.0 - 0x1p-20)) : INFINITY;
}

void bvh_skin_set(bvh_skin *s, const bvh *hierarchy, double distance) {
    float scaled = float_above(distance * hierarchy->scale);
    uint32_t chunk = 0;
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) take_tree(s, hierarchy, i, &chunk);
    memcpy(s->vertices, hierarchy->record_vertices, s->record_count * sizeof *s->vertices);
    memcpy(s->items, hierarchy->records, s->record_count * sizeof *s->items);
    for (uint32_t i = 0; i < s->leaf_count; i++) {
        take_leaf(s, hierarchy, i);
        bool any =
            (s->leaves[i].plus | s->leaves[i].minus) != 0; /* otherwise it may not have been oriented */
        s->stretches[i] = any ? squared_stretch(s->stretches[i], scaled) : INFINITY;
    }
    memset(s->stray_at_start, 0, s->leaf_count * sizeof *s->stray_at_start);
    s->scale = hierarchy->scale;
    s->distance = distance;
}

void bvh_skin_free(bvh_skin *s) {
    if (s->context != NULL) context_free_all(s->context, skin_arrays(s));
    *s = (bvh_skin){.context = NULL};
}

/* ---- an interval ---------------------------------------------------------------------------------------------- */

typedef struct skin_look {
    bvh_skin *skin;
    const double *x0, *x1;
} skin_look;

static void move_chunk(void *data, uint32_t index) {
    const skin_look *look = data;
    bvh_skin *s = look->skin;
    skin_chunk *c = &s->chunks[index];
    c->farthest = s->kernels->skin_move(s, c->begin, c->end, look->x1, s->trees[c->tree].ends[1]);
}

static void stretch_leaves(void *data, uint32_t index) {
    const skin_look *look = data;
    bvh_skin *s = look->skin;
    uint32_t begin = index * SKIN_LEAVES, rest = s->leaf_count - begin;
    uint32_t end = begin + (rest < SKIN_LEAVES ? rest : SKIN_LEAVES);
    s->within[index] = s->kernels->skin_signs(s, begin, end, look->x0, look->x1);
}

/* The distance that is left to the records of a tree, scaled: without the shift of its frame, and without what rounding may
 * hide. A place in the frame is off by less than 2^-50 of the reach. */
static double distance_left(const bvh_skin *s, const skin_tree *tree) {
    double left = s->distance;
    if (tree != s->trees)
        left -= shift_between(tree->origin, tree->ends[1], s->trees->origin, s->trees->ends[1]);
    return left * s->scale * (1.0 - 0x1p-20) - tree->reach * 0x1p-48;
}

static bool is_near(bvh_skin *s, skin_look *look) {
    double left = 0.0;
    for (uint32_t i = 0; i < s->chunk_count; i++) s->chunks[i].farthest = INFINITY;
    parallel_run(s->context->threads, s->chunk_count, move_chunk, look);
    for (uint32_t i = 0; i < s->chunk_count; i++) {
        const skin_chunk *c = &s->chunks[i];
        if (i == 0 || c->tree != c[-1].tree) left = distance_left(s, &s->trees[c->tree]);
        if (!(left > 0.0 && c->farthest < left * left)) return false;
    }
    return true;
}

static bool keeps_signs(bvh_skin *s, skin_look *look) {
    uint32_t tasks = leaf_task_count(s);
    memset(s->within, 0, tasks * sizeof *s->within);
    parallel_run(s->context->threads, tasks, stretch_leaves, look);
    for (uint32_t i = 0; i < tasks; i++) {
        if (!s->within[i]) return false;
    }
    return true;
}

bool bvh_skin_holds(bvh_skin *s, const double *x0, const double *x1) {
    skin_look look = {s, x0, x1};
    place_ends(s, x0, x1);
    return is_near(s, &look) && keeps_signs(s, &look);
}

void bvh_skin_take(bvh_skin *s) {
    bool *stray_at_end = s->stray_at_end;
    s->stray_at_end = s->stray_at_start;
    s->stray_at_start = stray_at_end;
}

void bvh_skin_points(const bvh_skin *s, double (*points)[2][3]) {
    for (uint32_t i = 0; i < s->tree_count; i++) {
        const skin_tree *tree = &s->trees[i];
        for (int k = 0; k < 6; k++)
            points[tree->region][k / 3][k % 3] =
                tree->ends[k / 3][k % 3] + (double)tree->detector[k % 3] / s->scale;
    }
}
