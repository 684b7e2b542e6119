/* The interval that is searched: the mesh, its positions at both ends, and which pairs count. */
#include "runtime/narrow_phase/swept_interval.h"

#include <string.h>

static void load_point(const swept_interval *interval, uint32_t vertex, elementary_query *query, int i) {
    memcpy(query->x0[i], interval->x0 + (size_t)vertex * 3, sizeof query->x0[i]);
    memcpy(query->x1[i], interval->x1 + (size_t)vertex * 3, sizeof query->x1[i]);
}

void swept_interval_load(const swept_interval *interval, cscd_contact_kind kind, uint32_t a, uint32_t b,
                         elementary_query *query) {
    const cscd_mesh *mesh = interval->mesh;
    if (kind == CSCD_CONTACT_VF) {
        load_point(interval, a, query, 0);
        for (int i = 0; i < 3; i++) load_point(interval, mesh->triangles[b][i], query, 1 + i);
    } else {
        for (int i = 0; i < 4; i++) load_point(interval, mesh->edges[i < 2 ? a : b][i % 2], query, i);
    }
}
