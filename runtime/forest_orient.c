/* The forest's flags: what faces the detector points, and what has lost its flag. */
#include "runtime/forest.h"

enum { LEAVES_PER_TASK = 256 };

typedef struct orienting {
    const forest *forest;
    const forest_view *view;
    uint8_t *orientations;
} orienting;

/* A point in a part's frame is where it is there by definition: rounding only moves the detector point. */
static void place_detector(const forest *f, forest_part *p, const forest_view *view) {
    for (int e = 0; e < 2; e++) {
        for (int k = 0; k < 3; k++) {
            double offset = view->detector_offsets[p->region][k];
            p->detector[e][k] = (float)(p->weighted[e][k] + offset * f->scale);
            if (view->still && e == 1)
                p->detector[1][k] =
                    (float)((double)p->detector[0][k] + (p->origin[0][k] - p->origin[1][k]) * f->scale);
        }
    }
}

static uint32_t component_of(const forest *f, const forest_part *p) {
    return f->mesh->triangle_components[f->leaves[p->first_leaf].triangles[0]];
}

static uint32_t part_of_leaf(const forest *f, uint32_t index) {
    uint32_t first = 0, last = f->part_count - 1;
    while (first < last) {
        uint32_t middle = first + (last - first + 1) / 2;
        if (f->parts[middle].first_leaf <= index)
            first = middle;
        else
            last = middle - 1;
    }
    return first;
}

static void orient_task(void *data, uint32_t index) {
    const orienting *now = data;
    const forest *f = now->forest;
    uint32_t begin = index * LEAVES_PER_TASK, end = begin + LEAVES_PER_TASK;
    end = end < f->leaf_count ? end : f->leaf_count;
    for (uint32_t i = part_of_leaf(f, begin); i < f->part_count && f->parts[i].first_leaf < end; i++) {
        const forest_part *p = &f->parts[i];
        if (!now->view->culled[component_of(f, p)]) continue;
        uint32_t stop = p->first_leaf + p->leaf_count;
        f->kernels->orient(f, p, begin > p->first_leaf ? begin : p->first_leaf, end < stop ? end : stop,
                           now->view->states, now->orientations);
    }
}

static void mark_level(const forest *f, int index) {
    const forest_level *level = &f->levels[index];
    for (uint32_t b = 0; b < level->block_count; b++) {
        lane_flags *flags = &level->flags[b];
        uint32_t plus = 0, minus = 0, fresh = 0;
        const lane_flags *children =
            (index == 0 ? f->leaf_flags : f->levels[index - 1].flags) + level->first_children[b];
        for (uint32_t i = 0; i < FOREST_LANES && (flags->used >> i & 1) != 0; i++) {
            plus |= (uint32_t)(children[i].plus == children[i].used) << i;
            minus |= (uint32_t)(children[i].minus == children[i].used) << i;
            fresh |= (uint32_t)(children[i].fresh != 0) << i;
        }
        bool one_part = index < f->part_level;
        flags->plus = (uint8_t)(one_part ? plus : 0);
        flags->minus = (uint8_t)(one_part ? minus : 0);
        flags->fresh = (uint8_t)fresh;
    }
}

static void mark_blocks(const forest *f) {
    for (int i = 0; i < f->level_count; i++) mark_level(f, i);
}

static lane_flags flags_of(const forest *f, uint32_t index, const uint8_t *orientations) {
    lane_flags flags = {.used = f->leaf_flags[index].used};
    for (uint32_t lane = 0; lane < FOREST_LANES && (flags.used >> lane & 1) != 0; lane++) {
        uint8_t flag = orientations[f->leaves[index].triangles[lane]];
        flags.plus |= (uint8_t)((flag == ORIENTATION_PLUS) << lane);
        flags.minus |= (uint8_t)((flag == ORIENTATION_MINUS) << lane);
    }
    return flags;
}

void forest_mark_fresh(forest *f, const uint8_t *before, const uint8_t *now) {
    for (uint32_t i = 0; i < f->leaf_count; i++) {
        lane_flags earlier = flags_of(f, i, before), flags = flags_of(f, i, now);
        flags.fresh = (uint8_t)((earlier.plus | earlier.minus) & ~(flags.plus | flags.minus));
        f->flags_before[i] = earlier;
        f->leaf_flags[i] = flags;
    }
    mark_blocks(f);
}

void forest_mark_suspects(forest *f, const bool *suspects) {
    for (uint32_t i = 0; i < f->leaf_count; i++) {
        lane_flags flags = {.used = f->leaf_flags[i].used};
        for (uint32_t lane = 0; lane < FOREST_LANES && (flags.used >> lane & 1) != 0; lane++)
            flags.fresh |= (uint8_t)(suspects[f->leaves[i].triangles[lane]] << lane);
        f->leaf_flags[i] = flags;
    }
    mark_blocks(f);
}

void forest_orient(forest *f, const forest_view *view, uint8_t *orientations) {
    orienting now = {f, view, orientations};
    for (uint32_t i = 0; i < f->part_count; i++) place_detector(f, &f->parts[i], view);
    parallel_run(f->mesh->context->threads, (f->leaf_count + LEAVES_PER_TASK - 1) / LEAVES_PER_TASK,
                 orient_task, &now);
    mark_blocks(f);
}
