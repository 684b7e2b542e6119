/* All features of a new mesh that came from each feature of the old one. */
#pragma once

#include "src/mesh/mesh_change.h"

/* Those of x are items[offsets[x] .. offsets[x + 1]), ascending. */
typedef struct mesh_heirs {
    uint32_t *offsets, *items;
} mesh_heirs;

/* On failure *out holds nothing. */
cscd_status mesh_heirs_find(cscd_context *context, const number_map *map, mesh_heirs *out);
void mesh_heirs_free(cscd_context *context, mesh_heirs *h);

static inline uint32_t mesh_heirs_count(const mesh_heirs *h, uint32_t old) {
    return h->offsets[old + 1] - h->offsets[old];
}
