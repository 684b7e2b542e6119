/* Finds the points that see the most of sets of tiles. */
#include "preprocess/regions/tiles.h"

#include "src/core/vec3.h"

#include <string.h>

/* The cost of a point as far from the centroid as the tiles are in the mean, as a share of their area. */
static const double drift_price = 0.1;

double tiles_unseen(const tile_set *set, const sight_point *point) {
    double unseen = 0.0;
    for (uint32_t i = 0; i < set->count; i++) {
        const uint32_t t = set->members[i];
        unseen += set->g->items[t].area * tile_blindness(set->g, t, point);
    }
    return unseen;
}

uint32_t tiles_nearest(const tile_set *set, const double point[3]) {
    uint32_t nearest = set->members[0];
    for (uint32_t i = 1; i < set->count; i++) {
        const uint32_t t = set->members[i];
        if (vec3_squared_distance(set->g->items[t].centroid, point) <
            vec3_squared_distance(set->g->items[nearest].centroid, point))
            nearest = t;
    }
    return nearest;
}

/* The mean of the tiles' centroids, of their areas at rest, in the frame whose tiles are given. */
static void frame_centroid(const tile_set *set, const tile *items, double out[3]) {
    double area = 0.0;
    for (int k = 0; k < 3; k++) out[k] = 0.0;
    for (uint32_t i = 0; i < set->count; i++) {
        const uint32_t t = set->members[i];
        const double weight = set->g->items[t].area;
        area += weight;
        for (int k = 0; k < 3; k++) out[k] += weight * items[t].centroid[k];
    }
    for (int k = 0; k < 3; k++) out[k] /= area > 0.0 ? area : 1.0;
}

void tiles_centroid(const tile_set *set, sight_point *out) {
    const tile_graph *g = set->g;
    frame_centroid(set, g->items, out->rest);
    for (uint32_t f = 0; f < g->frame_count; f++)
        frame_centroid(set, g->moved + (size_t)f * g->count, out->moved[f]);
}

typedef struct point_search {
    const tile_set *set;
    sight_point middle;
    double drift; /* the price of a square distance */
    double size;  /* root of the mean square distance from the middle */
} point_search;

static point_search begin_search(const tile_set *set) {
    point_search s = {.set = set};
    double area = 0.0, squares = 0.0;
    tiles_centroid(set, &s.middle);
    for (uint32_t i = 0; i < set->count; i++) {
        const tile *t = &set->g->items[set->members[i]];
        area += t->area;
        squares += t->area * vec3_squared_distance(t->centroid, s.middle.rest);
    }
    s.size = area > 0.0 ? sqrt(squares / area) : 0.0;
    s.drift = squares > 0.0 ? drift_price * area * area / squares : 0.0;
    return s;
}

/* Moves the point at rest, and in all frames with it. */
static void place_point(const point_search *s, const double rest[3], sight_point *point) {
    for (int k = 0; k < 3; k++) {
        const double offset = rest[k] - s->middle.rest[k];
        point->rest[k] = rest[k];
        for (uint32_t f = 0; f < s->set->g->frame_count; f++)
            point->moved[f][k] = s->middle.moved[f][k] + offset;
    }
}

static double point_cost(const point_search *s, const sight_point *point) {
    return tiles_unseen(s->set, point) + s->drift * vec3_squared_distance(point->rest, s->middle.rest);
}

/* Goes one step along an axis if that pays. */
static bool step_along(const point_search *s, int direction, double step, sight_point *point, double *cost) {
    double rest[3] = {point->rest[0], point->rest[1], point->rest[2]};
    sight_point next;
    rest[direction / 2] += direction % 2 ? step : -step;
    place_point(s, rest, &next);
    const double found = point_cost(s, &next);
    if (found >= *cost * (1.0 - 1e-3)) return false;
    *cost = found;
    *point = next;
    return true;
}

double tiles_best_point(const tile_set *set, sight_point *point) {
    enum { HALVINGS = 5 };
    const point_search s = begin_search(set);
    place_point(&s, point->rest, point);
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
