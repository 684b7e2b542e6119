/* All features of a new mesh that came from each feature of the old one. */
#pragma once

#include "src/mesh/mesh_change.h"

/* Most features have one heir, which the map says. The others, of objects that have changed, are sorted: the old number
 * in the upper half, the new one in the lower one. */
typedef struct mesh_heirs {
    const number_map *map;
    uint64_t *others;
    size_t other_count;
} mesh_heirs;

/* The heirs of one old feature. */
typedef struct heir_list {
    uint32_t first;
    const uint64_t *others;
    size_t count; /* with the first */
} heir_list;

/* map: one of the change's. On failure *out holds nothing. */
cscd_status mesh_heirs_find(cscd_context *context, const cscd_mesh_change *change, const number_map *map,
                            mesh_heirs *out);
void mesh_heirs_free(cscd_context *context, mesh_heirs *h);

heir_list mesh_heirs_of(const mesh_heirs *h, uint32_t old);

/* In ascending order. */
static inline uint32_t heir_at(const heir_list *list, size_t i) {
    return i == 0 ? list->first : (uint32_t)list->others[i - 1];
}
