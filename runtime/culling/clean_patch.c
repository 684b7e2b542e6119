/* Which of the free triangles are clean: have one winding number in common on their outer sides. */
#include "runtime/culling/clean_patch.h"

/* While a patch is gathered; never seen outside. */
enum { TRIANGLE_GATHERED = TRIANGLE_CLEAN + 1 };

/* Appends the free triangles across the edges of one to the queue, in their new state. */
static uint32_t append_neighbours(start_states *s, uint32_t triangle, uint8_t state, uint32_t end) {
    const cscd_mesh *mesh = s->mesh;
    for (int i = 0; i < 3; i++) {
        uint32_t edge = mesh->triangle_edges[triangle][i];
        for (uint32_t j = mesh->edge_star_offsets[edge]; j < mesh->edge_star_offsets[edge + 1]; j++) {
            uint32_t neighbour = mesh->edge_stars[j];
            if (s->triangles[neighbour] != TRIANGLE_FREE) continue;
            s->triangles[neighbour] = state;
            s->queue[end++] = neighbour;
        }
    }
    return end;
}

/* Everything free that can be reached from the queue's triangles begin .. end; returns the new end. */
static uint32_t spread(start_states *s, uint8_t state, uint32_t begin, uint32_t end) {
    while (begin < end) end = append_neighbours(s, s->queue[begin++], state, end);
    return end;
}

static void count_again(start_states *s) {
    s->counted = false;
    start_states_count(s);
}

/* Whether something of the component is not free decides what it takes. */
static void settle_embedded(start_states *s) {
    count_again(s);
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        const component_start *start = &s->of[s->mesh->triangle_components[t]];
        if (start->unknown == 0 && start->crossing == 0) s->triangles[t] = TRIANGLE_CLEAN;
    }
}

static void spread_clean(start_states *s) {
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        bool reached = false;
        for (int i = 0; i < 3 && s->triangles[t] == TRIANGLE_FREE; i++) {
            uint32_t edge = s->mesh->triangle_edges[t][i];
            for (uint32_t j = s->mesh->edge_star_offsets[edge]; j < s->mesh->edge_star_offsets[edge + 1]; j++)
                reached |= s->triangles[s->mesh->edge_stars[j]] == TRIANGLE_CLEAN;
        }
        if (!reached) continue;
        s->triangles[t] = TRIANGLE_CLEAN;
        s->queue[0] = t;
        spread(s, TRIANGLE_CLEAN, 0, 1);
    }
    count_again(s);
}

static bool mostly_clean(const start_states *s, uint32_t component) {
    return s->of[component].clean >= s->mesh->components[component].triangle_count - s->of[component].clean;
}

/* Gathers the patches of free triangles that are not clean, and notes each component's largest, the first of
 * these. */
static void gather_patches(start_states *s) {
    uint32_t end = 0;
    for (uint32_t c = 0; c < s->mesh->component_count; c++) s->largest[c] = (free_patch){0, 0};
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        uint32_t component = s->mesh->triangle_components[t], begin = end;
        if (s->triangles[t] != TRIANGLE_FREE || mostly_clean(s, component)) continue;
        s->triangles[t] = TRIANGLE_GATHERED;
        s->queue[end] = t;
        end = spread(s, TRIANGLE_GATHERED, begin, begin + 1);
        if (end - begin > s->largest[component].count)
            s->largest[component] = (free_patch){begin, end - begin};
    }
}

/* Where the largest patch is larger than what was clean, the two change places. */
static void choose_patches(start_states *s) {
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        uint32_t component = s->mesh->triangle_components[t];
        bool demoted = s->largest[component].count > s->of[component].clean;
        if (s->triangles[t] == TRIANGLE_GATHERED || (demoted && s->triangles[t] == TRIANGLE_CLEAN))
            s->triangles[t] = TRIANGLE_FREE;
    }
    for (uint32_t c = 0; c < s->mesh->component_count; c++) {
        free_patch patch = s->largest[c];
        if (patch.count <= s->of[c].clean) continue;
        for (uint32_t i = 0; i < patch.count; i++) s->triangles[s->queue[patch.begin + i]] = TRIANGLE_CLEAN;
        s->of[c].clean = patch.count;
    }
}

void clean_patches_find(start_states *s) {
    bool all_mostly_clean = true;
    settle_embedded(s);
    spread_clean(s);
    for (uint32_t c = 0; c < s->mesh->component_count; c++) all_mostly_clean &= mostly_clean(s, c);
    if (all_mostly_clean) return;
    gather_patches(s);
    choose_patches(s);
}
