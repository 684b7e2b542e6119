/* What a plan looks like: a number or a colour for each triangle, by its charge or its region. */
#include "tool/common/plan_colours.h"

#include "tool/io/growable.h"
#include "tool/picture/picture.h"

#include <math.h>
#include <stdlib.h>

typedef struct charged_triangle {
    uint32_t component, triangle;
    double charge;
} charged_triangle;

static int compare_charges(const void *left, const void *right) {
    const charged_triangle *l = left, *r = right;
    if (l->component != r->component) return l->component < r->component ? -1 : 1;
    if (l->charge != r->charge) return l->charge < r->charge ? -1 : 1;
    return l->triangle < r->triangle ? -1 : l->triangle > r->triangle;
}

double *charge_ranks(const cscd_plan *plan, const cscd_mesh *mesh) {
    uint32_t count = cscd_mesh_triangle_count(mesh);
    charged_triangle *order = io_realloc(NULL, (size_t)count * sizeof *order);
    double *ranks = io_realloc(NULL, (size_t)count * sizeof *ranks);
    if (order == NULL || ranks == NULL) {
        free(order);
        free(ranks);
        return NULL;
    }
    for (uint32_t t = 0; t < count; t++)
        order[t] =
            (charged_triangle){cscd_mesh_triangle_component(mesh, t), t, cscd_plan_triangle_charge(plan, t)};
    qsort(order, count, sizeof *order, compare_charges);
    for (uint32_t i = 0, first = 0, rank = 0; i < count; i++) {
        if (order[i].component != order[first].component) first = rank = i;
        if (order[i].charge != order[rank].charge) rank = i;
        uint32_t others = cscd_mesh_component(mesh, order[i].component).triangle_count - 1;
        ranks[order[i].triangle] = others > 0 ? (double)(rank - first) / others : 0.0;
    }
    free(order);
    return ranks;
}

bool plan_colour_charge(const cscd_plan *plan, const cscd_mesh *mesh, uint8_t *colours) {
    double *ranks = charge_ranks(plan, mesh);
    if (ranks == NULL) return false;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++)
        picture_colour_map(ranks[t], colours + (size_t)t * 3);
    free(ranks);
    return true;
}

bool plan_colour_density(const cscd_plan *plan, const cscd_mesh *mesh, uint8_t *colours) {
    const uint32_t components = cscd_mesh_component_count(mesh), count = cscd_mesh_triangle_count(mesh);
    double(*ends)[2] = io_realloc(NULL, (size_t)components * sizeof *ends);
    if (ends == NULL) return false;
    for (uint32_t c = 0; c < components; c++) {
        ends[c][0] = INFINITY;
        ends[c][1] = -INFINITY;
    }
    for (uint32_t t = 0; t < count; t++) {
        double *end = ends[cscd_mesh_triangle_component(mesh, t)];
        end[0] = fmin(end[0], cscd_plan_triangle_charge(plan, t));
        end[1] = fmax(end[1], cscd_plan_triangle_charge(plan, t));
    }
    for (uint32_t t = 0; t < count; t++) {
        const double *end = ends[cscd_mesh_triangle_component(mesh, t)];
        const double share = (cscd_plan_triangle_charge(plan, t) - end[0]) / (end[1] - end[0]);
        picture_colour_map(end[1] > end[0] ? share : 0.0, colours + (size_t)t * 3);
    }
    free(ends);
    return true;
}

void plan_colour_regions(const cscd_plan *plan, uint32_t triangle_count, uint8_t *colours) {
    for (uint32_t t = 0; t < triangle_count; t++)
        picture_colour_category(cscd_plan_triangle_region(plan, t), colours + (size_t)t * 3);
}
