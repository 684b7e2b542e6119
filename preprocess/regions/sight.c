/* Finds the points that see the most of sets of tiles. */
#include "preprocess/regions/sight.h"

#include <string.h>

/* The cost of a point as far from the centroid as the tiles are in the mean, as a share of their area. */
static const double drift_price = 0.1;

static double square_distance(const double a[3], const double b[3]) {
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

double tiles_unseen(const tile_set *set, const double point[3]) {
    double unseen = 0.0;
    for (uint32_t i = 0; i < set->count; i++) {
        const tile *t = &set->g->items[set->members[i]];
        unseen += t->area * tile_blindness(t, point);
    }
    return unseen;
}

void tiles_centroid(const tile_set *set, double out[3]) {
    double area = 0.0;
    for (int k = 0; k < 3; k++) out[k] = 0.0;
    for (uint32_t i = 0; i < set->count; i++) {
        const tile *t = &set->g->items[set->members[i]];
        area += t->area;
        for (int k = 0; k < 3; k++) out[k] += t->area * t->centroid[k];
    }
    for (int k = 0; k < 3; k++) out[k] /= area > 0.0 ? area : 1.0;
}

typedef struct point_search {
    const tile_set *set;
    double middle[3], drift; /* the price of a square distance */
    double size;             /* root of the mean square distance from the middle */
} point_search;

static point_search begin_search(const tile_set *set) {
    point_search s = {.set = set};
    double area = 0.0, squares = 0.0;
    tiles_centroid(set, s.middle);
    for (uint32_t i = 0; i < set->count; i++) {
        const tile *t = &set->g->items[set->members[i]];
        area += t->area;
        squares += t->area * square_distance(t->centroid, s.middle);
    }
    s.size = area > 0.0 ? sqrt(squares / area) : 0.0;
    s.drift = squares > 0.0 ? drift_price * area * area / squares : 0.0;
    return s;
}

static double point_cost(const point_search *s, const double point[3]) {
    return tiles_unseen(s->set, point) + s->drift * square_distance(point, s->middle);
}

/* Goes one step along an axis if that pays. */
static bool step_along(const point_search *s, int direction, double step, double point[3], double *cost) {
    double next[3] = {point[0], point[1], point[2]};
    next[direction / 2] += direction % 2 ? step : -step;
    const double found = point_cost(s, next);
    if (found >= *cost * (1.0 - 1e-3)) return false;
    *cost = found;
    memcpy(point, next, sizeof next);
    return true;
}

double tiles_best_point(const tile_set *set, double point[3]) {
    enum { HALVINGS = 5 };
    const point_search s = begin_search(set);
    double cost = point_cost(&s, point), step = 0.5 * s.size;
    for (int halving = 0; halving < HALVINGS && cost > 0.0;) {
        bool moved = false;
        for (int direction = 0; direction < 6; direction++)
            moved |= step_along(&s, direction, step, point, &cost);
        if (moved) continue;
        step *= 0.5;
        halving++;
    }
    return cost;
}
