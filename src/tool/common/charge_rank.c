/* Charge equalized: each triangle's rank in its component, which pictures and reports show as a colour. */
#include "src/tool/common/charge_rank.h"

#include "src/io/growable.h"

#include <stdlib.h>

typedef struct charged {
    uint32_t component, triangle;
    double charge;
} charged;

static int compare(const void *left, const void *right) {
    const charged *l = left, *r = right;
    if (l->component != r->component) return l->component < r->component ? -1 : 1;
    if (l->charge != r->charge) return l->charge < r->charge ? -1 : 1;
    return l->triangle < r->triangle ? -1 : l->triangle > r->triangle;
}

double *charge_ranks(const cscd_plan *plan, const cscd_mesh *mesh) {
    uint32_t count = cscd_mesh_triangle_count(mesh);
    charged *order = io_realloc(NULL, (size_t)count * sizeof *order);
    double *ranks = io_realloc(NULL, (size_t)count * sizeof *ranks);
    if (order == NULL || ranks == NULL) {
        free(order);
        free(ranks);
        return NULL;
    }
    for (uint32_t t = 0; t < count; t++)
        order[t] = (charged){cscd_mesh_triangle_component(mesh, t), t, cscd_plan_triangle_charge(plan, t)};
    qsort(order, count, sizeof *order, compare);
    for (uint32_t i = 0, first = 0, rank = 0; i < count; i++) {
        if (order[i].component != order[first].component) first = rank = i;
        if (order[i].charge != order[rank].charge) rank = i;
        uint32_t others = cscd_mesh_component(mesh, order[i].component).triangle_count - 1;
        ranks[order[i].triangle] = others > 0 ? (double)(rank - first) / others : 0.0;
    }
    free(order);
    return ranks;
}
