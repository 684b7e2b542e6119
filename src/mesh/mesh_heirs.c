/* All features of a new mesh that came from each feature of the old one. */
#include "src/mesh/mesh_heirs.h"

/* A counting sort. While it runs, offsets are one place ahead. */
static void sort_by_origin(const number_map *map, mesh_heirs *h) {
    for (uint32_t i = 0; i < map->new_count; i++) {
        if (map->to_old[i] != UINT32_MAX) h->offsets[map->to_old[i] + 2]++;
    }
    for (uint32_t i = 0; i < map->old_count; i++) h->offsets[i + 1] += h->offsets[i];
    for (uint32_t i = 0; i < map->new_count; i++) {
        if (map->to_old[i] != UINT32_MAX) h->items[h->offsets[map->to_old[i] + 1]++] = i;
    }
}

cscd_status mesh_heirs_find(cscd_context *context, const number_map *map, mesh_heirs *out) {
    mesh_heirs h;
    array_list list = {{ARRAY(h.offsets, (size_t)map->old_count + 2), ARRAY(h.items, map->new_count)}};
    *out = (mesh_heirs){NULL, NULL};
    if (!context_allocate_all(context, list)) return CSCD_OUT_OF_MEMORY;
    sort_by_origin(map, &h);
    *out = h;
    return CSCD_OK;
}

void mesh_heirs_free(cscd_context *context, mesh_heirs *h) {
    context_free(context, h->offsets);
    context_free(context, h->items);
    *h = (mesh_heirs){NULL, NULL};
}
