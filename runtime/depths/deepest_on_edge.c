/* The deepest point of a part of an edge: docs/theory/curves.md, Lemma 8. */
#include "runtime/depths/deepest_on_edge.h"

#include "src/core/floating.h"

#include <math.h>

/* deepest: at places that are no deeper than this, scaled, the depth may be less than what is set; -1: it is none of those. */
static edge_place place_at(const edge_search *e, double s, const outer_point *near, double deepest) {
    edge_place at = {.s = s};
    for (int k = 0; k < 3; k++) at.x[k] = e->ends[0][k] + s * (e->ends[1][k] - e->ends[0][k]);
    at.nearest = outer_surface_search(e->outer, e->found, e->bvh, e->body, at.x, near, deepest);
    at.distance = sqrt(at.nearest.squared);
    return at;
}

/* No point in between is deeper. The depth changes by no more than the way; and it is no more than the distance from one
 * convex part, which is largest at an end. */
static double bound_between(const edge_search *e, const edge_place *a, const edge_place *b) {
    double by_way = 0.5 * (a->distance + b->distance + (b->s - a->s) * e->length);
    const outer_surface *outer = e->outer;
    double by_first = max_of(a->distance, outer_part_reach(outer, b->x, &a->nearest.part));
    double by_last = max_of(b->distance, outer_part_reach(outer, a->x, &b->nearest.part));
    return min_of(by_way, min_of(by_first, by_last));
}

enum { HALVINGS_MAX = 64 };

/* Halves what may be deeper by more than a millionth of the edge. */
edge_place edge_search_run(const edge_search *e) {
    edge_place ends[HALVINGS_MAX + 1], at = place_at(e, e->s[0], e->near, -1.0), deepest = at;
    int count = 0;
    ends[count++] = place_at(e, e->s[1], &at.nearest, deepest.distance);
    if (ends[0].distance > deepest.distance) deepest = ends[0];
    while (count > 0) { /* from at to the last one of ends */
        edge_place *end = &ends[count - 1];
        bool halve = count < HALVINGS_MAX && bound_between(e, &at, end) > deepest.distance + 1e-6 * e->length;
        if (!halve) {
            at = *end;
            count--;
            continue;
        }
        ends[count] = place_at(e, at.s + 0.5 * (end->s - at.s), &at.nearest, deepest.distance);
        if (ends[count].distance > deepest.distance) deepest = ends[count];
        count++;
    }
    return deepest;
}
