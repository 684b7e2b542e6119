/* Depths of what is looked at with each other: the library's without those of pairs that are left out. */
#include "src/tool/answers/shown_depths.h"

shown_depths shown_depths_of(const ignore_pairs *ignored) {
    return (shown_depths){.ignored = ignored,
                          .items = growable_of(sizeof(cscd_depth)),
                          .patches = growable_of(sizeof(cscd_patch_depth))};
}

void shown_depths_free(shown_depths *s) {
    growable_free(&s->items);
    growable_free(&s->patches);
}

static bool is_shown(const shown_depths *s, const cscd_depth *depth) {
    return depth->vertex != UINT32_MAX
               ? !ignore_pairs_separate_vertex(s->ignored, depth->vertex, depth->triangle)
               : !ignore_pairs_separate_edge(s->ignored, depth->edge, depth->triangle);
}

/* Patches come with their deepest vertices, which may have new places. */
static bool keep_patch(shown_depths *s, const cscd_depths *all, const cscd_patch_depth *patch) {
    const cscd_depth *deepest = &all->items[patch->deepest], *items = s->items.data;
    if (!is_shown(s, deepest)) return true;
    cscd_patch_depth *kept = growable_push(&s->patches);
    if (kept == NULL) return false;
    *kept = *patch;
    size_t low = 0, high = s->list.vertex_count; /* sorted by (vertex, object) */
    while (low + 1 < high) {
        const size_t middle = low + (high - low) / 2;
        const bool behind = items[middle].vertex != deepest->vertex ? items[middle].vertex > deepest->vertex
                                                                    : items[middle].object > deepest->object;
        if (behind)
            high = middle;
        else
            low = middle;
    }
    kept->deepest = low;
    return true;
}

bool shown_depths_choose(shown_depths *s, cscd_intersection_pairs *found) {
    const cscd_depths *all = found->depths;
    if (all == NULL || !ignore_pairs_any(s->ignored)) return true;
    s->items.count = s->patches.count = 0;
    s->list = (cscd_depths){0};
    s->all = all;
    for (size_t i = 0; i < all->count; i++) {
        if (!is_shown(s, &all->items[i])) continue;
        cscd_depth *kept = growable_push(&s->items);
        if (kept == NULL) return false;
        *kept = all->items[i];
        s->list.vertex_count += i < all->vertex_count;
    }
    for (size_t i = 0; i < all->patch_count; i++)
        if (!keep_patch(s, all, &all->patches[i])) return false;
    s->list.items = s->items.data;
    s->list.count = s->items.count;
    s->list.patches = s->patches.data;
    s->list.patch_count = s->patches.count;
    found->depths = &s->list;
    return true;
}

static uint32_t part_of(const shown_depths *s, const cscd_depth *depth) {
    const cscd_mesh *mesh = s->ignored->mesh;
    uint32_t count;
    const uint32_t *triangles = depth->vertex != UINT32_MAX
                                    ? cscd_mesh_vertex_triangles(mesh, depth->vertex, &count)
                                    : cscd_mesh_edge_triangles(mesh, depth->edge, &count);
    return s->ignored->parts.labels[triangles[0]]; /* as the library counts: that of the first triangle */
}

/* A pair of parts comes with the deepest of all its depths. If that one is left out, another one may still be there: of a vertex
 * between two parts, only one of which is left out. */
double shown_depths_of_parts(const shown_depths *s, const cscd_intersection_pairs *found,
                             const cscd_part_pair *pair) {
    if (found->depths != &s->list || pair->deepest == SIZE_MAX) return pair->depth;
    if (is_shown(s, &s->all->items[pair->deepest])) return pair->depth;
    double greatest = 0.0;
    for (size_t i = 0; i < s->list.count; i++) {
        const cscd_depth *depth = &s->list.items[i];
        const uint32_t part = part_of(s, depth), burier = s->ignored->parts.labels[depth->triangle];
        const bool of_pair = (part == pair->a && burier == pair->b) || (part == pair->b && burier == pair->a);
        if (of_pair && depth->depth > greatest) greatest = depth->depth;
    }
    return greatest;
}
