/* All features of a new mesh that came from each feature of the old one. */
#include "src/mesh/mesh_heirs.h"

#include "src/core/sort.h"

/* Features of objects that have changed, of the kind of the map. */
static number_run described_numbers(const cscd_mesh_change *change, const number_map *map, uint32_t i) {
    const object_range *range = &change->described[i];
    if (map == &change->vertices) return (number_run){0, range->vertex, range->vertex_count};
    if (map == &change->edges) return (number_run){0, range->edge, range->edge_count};
    return (number_run){0, range->triangle, range->triangle_count};
}

static bool is_another(const number_map *map, uint32_t now) {
    return map->to_old[now] != UINT32_MAX && map->to_new[map->to_old[now]] != now;
}

/* Lists them where there is room for them, and returns how many there are. Objects have one heir. */
static size_t list_others(const cscd_mesh_change *change, const number_map *map, uint64_t *out) {
    size_t count = 0;
    for (uint32_t i = 0; map != &change->objects && i < change->described_count; i++) {
        number_run run = described_numbers(change, map, i);
        for (uint32_t now = run.to; now < run.to + run.count; now++) {
            if (!is_another(map, now)) continue;
            if (out != NULL) out[count] = (uint64_t)map->to_old[now] << 32 | now;
            count++;
        }
    }
    return count;
}

cscd_status mesh_heirs_find(cscd_context *context, const cscd_mesh_change *change, const number_map *map,
                            mesh_heirs *out) {
    mesh_heirs h = {.map = map, .other_count = list_others(change, map, NULL)};
    uint64_t *spare;
    array_list list = {{ARRAY(h.others, h.other_count), ARRAY(spare, h.other_count)}};
    *out = (mesh_heirs){.map = NULL};
    if (!context_allocate_all(context, list)) return CSCD_OUT_OF_MEMORY;
    list_others(change, map, h.others);
    sort_by_number(h.others, spare, h.other_count, sizeof *h.others);
    context_free(context, spare);
    *out = h;
    return CSCD_OK;
}

void mesh_heirs_free(cscd_context *context, mesh_heirs *h) {
    context_free(context, h->others);
    *h = (mesh_heirs){.map = NULL};
}

static size_t first_other(const mesh_heirs *h, uint64_t least) {
    size_t low = 0, high = h->other_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (h->others[middle] < least)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

heir_list mesh_heirs_of(const mesh_heirs *h, uint32_t old) {
    heir_list list = {.first = number_map_to_new(h->map, old)};
    if (list.first == UINT32_MAX) return list;
    size_t begin = first_other(h, (uint64_t)old << 32);
    list.others = h->others + begin;
    for (size_t i = begin; i < h->other_count && h->others[i] >> 32 == old; i++) list.count++;
    list.count++;
    return list;
}
