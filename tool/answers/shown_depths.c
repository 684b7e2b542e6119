/* Depths of what is looked at with each other: the library's without those of pairs that are left out. */
#include "tool/answers/shown_depths.h"

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
    if (depth->vertex != UINT32_MAX)
        return !ignore_pairs_separate_vertex(s->ignored, depth->vertex, depth->triangle);
    if (depth->edge != UINT32_MAX)
        return !ignore_pairs_separate_edge(s->ignored, depth->edge, depth->triangle);
    return !ignore_pairs_separate_triangles(s->ignored, depth->face, depth->triangle);
}

/* The faces of a patch in one body follow each other. */
static bool keep_patch(shown_depths *s, const cscd_depth *face, size_t place) {
    cscd_patch_depth *last =
        s->patches.count > 0 ? (cscd_patch_depth *)s->patches.data + s->patches.count - 1 : NULL;
    if (face->patch == UINT32_MAX) return true;
    if (last != NULL && last->patch == face->patch && last->body == face->body) {
        const cscd_depth *items = s->items.data;
        if (face->depth > items[last->deepest].depth) last->deepest = place;
        return true;
    }
    cscd_patch_depth *kept = growable_push(&s->patches);
    if (kept != NULL) *kept = (cscd_patch_depth){face->patch, face->body, place};
    return kept != NULL;
}

bool shown_depths_choose(shown_depths *s, cscd_intersection_pairs *found) {
    const cscd_depths *all = found->depths;
    if (all == NULL || !ignore_pairs_any(s->ignored)) return true;
    s->items.count = s->patches.count = 0;
    s->list = (cscd_depths){0};
    s->all = all;
    const size_t points = all->vertex_count + all->edge_count;
    for (size_t i = 0; i < all->count; i++) {
        if (!is_shown(s, &all->items[i])) continue;
        cscd_depth *kept = growable_push(&s->items);
        if (kept == NULL) return false;
        *kept = all->items[i];
        if (i >= points && !keep_patch(s, &all->items[i], s->items.count - 1)) return false;
        s->list.vertex_count += i < all->vertex_count;
        s->list.edge_count += i >= all->vertex_count && i < points;
    }
    s->list.items = s->items.data;
    s->list.count = s->items.count;
    s->list.patches = s->patches.data;
    s->list.patch_count = s->patches.count;
    found->depths = &s->list;
    return true;
}

/* A pair of parts comes with the deepest of all its depths. If some are left out, others may still be there: of a vertex between
 * two parts, only one of which is left out. */
void shown_depths_of_parts(const shown_depths *s, const cscd_intersection_pairs *found,
                           cscd_part_pair *pair) {
    if (found->depths != &s->list || pair->deepest == SIZE_MAX) return;
    pair->depth = pair->bound = 0.0;
    for (size_t i = 0; i < s->list.count; i++) {
        const cscd_depth *depth = &s->list.items[i];
        const uint32_t part = s->ignored->parts.labels[depth->face];
        const uint32_t burier = s->ignored->parts.labels[depth->triangle];
        const bool of_pair = (part == pair->a && burier == pair->b) || (part == pair->b && burier == pair->a);
        if (of_pair && depth->depth > pair->depth) pair->depth = depth->depth;
        if (of_pair && depth->bound > pair->bound) pair->bound = depth->bound;
    }
}
