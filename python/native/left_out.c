/* The pairs that a replay of Python leaves out, by parts and at rest, and the depths and events that it then
 * shows, as the tool does. */
#include "python/native/host.h"

#include "tool/answers/answers.h"

#include <stdlib.h>
#include <string.h>

typedef struct left_out {
    ignore_pairs pairs;
    shown_depths shown;
} left_out;

static bool fill_parts(part_names *parts, const uint32_t *labels, uint32_t triangle_count) {
    parts->labels = malloc((triangle_count + (size_t)1) * sizeof *parts->labels);
    parts->names = calloc(parts->count + (size_t)1, sizeof *parts->names);
    if (parts->labels == NULL || parts->names == NULL) return false;
    memcpy(parts->labels, labels, triangle_count * sizeof *labels);
    for (uint32_t i = 0; i < parts->count; i++)
        if ((parts->names[i] = calloc(1, 1)) == NULL) return false;
    return true;
}

/* labels: the part of each triangle, below part_count or NO_PART. The mesh outlives the result. */
PYTHON_API bool cscdpy_left_out_create(const cscd_mesh *mesh, const uint32_t *labels, uint32_t part_count,
                                       left_out **out, io_error *error) {
    left_out *created = calloc(1, sizeof *created);
    part_names parts = {.count = part_count};
    bool done = (created != NULL && fill_parts(&parts, labels, cscd_mesh_triangle_count(mesh))) ||
                io_fail(error, "out of memory for %u parts", part_count);
    if (!done || !ignore_pairs_of(mesh, &parts, &created->pairs, error)) {
        part_names_free(&parts);
        free(created);
        return false;
    }
    created->shown = shown_depths_of(&created->pairs);
    *out = created;
    return true;
}

PYTHON_API void cscdpy_left_out_destroy(left_out *l) {
    shown_depths_free(&l->shown);
    ignore_pairs_free(&l->pairs);
    free(l);
}

/* Leaves out all pairs of two parts. */
PYTHON_API bool cscdpy_left_out_add_parts(left_out *l, uint32_t a, uint32_t b) {
    return part_rules_ignore(&l->pairs.rules, a, b);
}

/* Leaves out pairs of triangles, or the parts that these are in. */
PYTHON_API bool cscdpy_left_out_add_rest(left_out *l, const cscd_intersections *found, bool by_parts) {
    return ignore_pairs_add_rest(&l->pairs, found, by_parts);
}

PYTHON_API void cscdpy_left_out_choose(left_out *l, cscd_detector_options *options) {
    ignore_pairs_choose(&l->pairs, options);
}

/* Leaves out depths of what a detector has found; the list is ours until the next call. */
PYTHON_API bool cscdpy_left_out_show(left_out *l, cscd_intersections *found) {
    return shown_depths_choose(&l->shown, found);
}

/* Leaves out events that only follow from others; count becomes the number of those left. */
PYTHON_API bool cscdpy_choose_events(cscd_event *events, size_t *count) {
    return consequences_leave_out(events, count);
}
