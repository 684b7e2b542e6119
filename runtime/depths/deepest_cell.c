/* The deepest point of a triangle, or of what is buried of it: docs/theory/curves.md, Lemma 9. */
#include "runtime/depths/deepest_points.h"

#include "src/core/vec3.h"

#include <string.h>

/* 64 halvings of the longest side leave a cell 2^32 times smaller. Each leaves two or three parts in place of one. */
enum { LEVELS_MAX = 64, PARTS_OF_ONE = 3 };

bool depth_search_wants(const depth_search *s, double bound) {
    const double best = s->best.depth > 0.0 ? s->best.depth : 0.0;
    if (bound <= best + s->rounding) return false;
    if (best <= s->limit && bound > s->limit) return true;
    return bound > 1.01 * best && bound > best + DEPTH_RESOLUTION * s->rounding;
}

/* near: triangles that may be near, or UINT32_MAX. A point that is near enough to the surface to be no deeper than the best one
 * is not searched for: then its depth is not known, but no more than what is set. */
static void measure_point(depth_search *s, uint32_t number, const uint32_t near[2], deep_point *p) {
    const double scale = s->outer->scale;
    p->nearest.squared = (double)INFINITY;
    p->nearest.triangle = UINT32_MAX;
    for (int i = 0; i < 2; i++) {
        if (near[i] == UINT32_MAX || (i > 0 && near[i] == near[0])) continue;
        const outer_point at = outer_surface_near(s->outer, s->found, near[i], p->x, s->best.depth);
        if (at.squared < p->nearest.squared) p->nearest = at;
        p->depth = sqrt(p->nearest.squared) / scale;
        if (p->depth <= s->best.depth) return;
    }
    p->nearest = outer_surface_nearest(s->outer, s->found, s->bvh, s->body, p->x, &p->nearest);
    p->depth = p->nearest.triangle != UINT32_MAX ? sqrt(p->nearest.squared) / scale : 0.0;
    if (!(p->depth > s->best.depth)) return;
    s->best = *p;
    s->best_cell = number;
}

static void measure_between(depth_search *s, uint32_t number, const deep_point *a, const deep_point *b,
                            deep_point *p) {
    measure_point(s, number, (const uint32_t[2]){a->nearest.triangle, b->nearest.triangle}, p);
}

/* ---- bounds -------------------------------------------------------------------------------------------- */

/* The distances of the corners of a cell from the parts of the surface that were found near some three
 * points: [corner][part]. */
typedef struct reach_table {
    double from[3][3];
} reach_table;

/* The greatest sum of shares of two columns. */
static double greatest_mean(const reach_table *reach, int j, int k, double share) {
    double greatest = 0.0;
    for (int i = 0; i < 3; i++) {
        const double mean = (1.0 - share) * reach->from[i][j] + share * reach->from[i][k];
        greatest = mean > greatest ? mean : greatest;
    }
    return greatest;
}

static int greatest_of(const reach_table *reach, int j) {
    const double a = reach->from[0][j], b = reach->from[1][j], c = reach->from[2][j];
    return c > a && c > b ? 2 : b > a ? 1 : 0;
}

/* No point is deeper than its distance from a part of the surface. That is a convex function, and so is each mean of several, so
 * in a cell they are greatest at a corner. A mean changes little where one distance grows as another falls. */
static double bound_by_parts(const reach_table *reach) {
    double least = (double)INFINITY;
    for (int j = 0; j < 3; j++) {
        const int k = (j + 1) % 3, a = greatest_of(reach, j), b = greatest_of(reach, k);
        least = min_of(least, reach->from[a][j]);
        /* with these shares, the corners a and b are equally far */
        const double rise = reach->from[a][j] - reach->from[b][j],
                     fall = reach->from[b][k] - reach->from[a][k];
        if (rise > 0.0 && fall > 0.0) least = min_of(least, greatest_mean(reach, j, k, rise / (rise + fall)));
    }
    double greatest = 0.0;
    for (int i = 0; i < 3; i++)
        greatest = max_of(greatest, reach->from[i][0] + reach->from[i][1] + reach->from[i][2]);
    return min_of(least, greatest / 3.0);
}

/* The side from this corner to the next is the longest. */
static int longest_side(const depth_cell *cell) {
    double squared[3];
    for (int i = 0; i < 3; i++)
        squared[i] = vec3_squared_distance(cell->corners[i], cell->corners[(i + 1) % 3]);
    if (squared[0] >= squared[1] && squared[0] >= squared[2]) return 0;
    return squared[1] >= squared[2] ? 1 : 2;
}

static double length_of_side(const depth_cell *cell, int i) {
    return sqrt(vec3_squared_distance(cell->corners[i], cell->corners[(i + 1) % 3]));
}

enum { LOCAL_LEVELS = 2 };

/* The parts of the surface that are near the corners of a cell. */
typedef const outer_part *cell_parts[3];

/* The same bound for smaller and smaller cells, with the parts of the large one: no search is needed. Ends where one of them is
 * wanted all the same. */
static double bound_locally(const depth_search *s, const depth_cell *cell, const reach_table *reach,
                            const cell_parts parts, int levels) {
    const double bound = bound_by_parts(reach);
    if (levels == 0 || !depth_search_wants(s, bound)) return bound;
    const int i = longest_side(cell), j = (i + 1) % 3;
    double middle[3], from[3], greatest = 0.0;
    for (int k = 0; k < 3; k++) middle[k] = 0.5 * (cell->corners[i][k] + cell->corners[j][k]);
    for (int k = 0; k < 3; k++) from[k] = outer_part_reach(s->outer, middle, parts[k]) / s->outer->scale;
    for (int h = 0; h < 2; h++) {
        depth_cell half = *cell;
        reach_table near = *reach;
        memcpy(half.corners[h == 0 ? j : i], middle, sizeof middle);
        memcpy(near.from[h == 0 ? j : i], from, sizeof from);
        greatest = max_of(greatest, bound_locally(s, &half, &near, parts, levels - 1));
        if (depth_search_wants(s, greatest)) return bound;
    }
    return greatest;
}

/* The depth changes by no more than the way, and some corner is no farther from a point than the longest side over the square
 * root of 3. */
static double bound_by_way(const cell_part *c, const depth_cell *cell) {
    const double deepest = max_of(c->corners[0].depth, max_of(c->corners[1].depth, c->corners[2].depth));
    return deepest + length_of_side(cell, longest_side(cell)) * 0.57735026918962584;
}

static depth_cell cell_of(const cell_part *c) {
    depth_cell cell;
    for (int i = 0; i < 3; i++) memcpy(cell.corners[i], c->corners[i].x, sizeof cell.corners[i]);
    return cell;
}

static double reach_of(const depth_search *s, const cell_part *c, int corner, int part) {
    if (corner == part) return c->corners[corner].depth;
    return outer_part_reach(s->outer, c->corners[corner].x, &c->corners[part].nearest.part) / s->outer->scale;
}

static int deepest_corner(const cell_part *c) {
    const double a = c->corners[0].depth, b = c->corners[1].depth;
    if (c->corners[2].depth > a && c->corners[2].depth > b) return 2;
    return b > a ? 1 : 0;
}

/* Most often the part below the deepest corner is enough. */
static void bound_part(const depth_search *s, cell_part *c) {
    const depth_cell cell = cell_of(c);
    const cell_parts parts = {&c->corners[0].nearest.part, &c->corners[1].nearest.part,
                              &c->corners[2].nearest.part};
    const int deepest = deepest_corner(c);
    reach_table reach;
    double greatest = 0.0;
    for (int i = 0; i < 3; i++)
        if (c->corners[i].nearest.triangle == UINT32_MAX) c->above = 0.0; /* the body has no outer surface */
    c->above = min_of(c->above, bound_by_way(c, &cell));
    if (!depth_search_wants(s, c->above)) return;
    for (int i = 0; i < 3; i++) {
        reach.from[i][deepest] = reach_of(s, c, i, deepest);
        greatest = max_of(greatest, reach.from[i][deepest]);
    }
    c->above = min_of(c->above, greatest);
    if (!depth_search_wants(s, c->above)) return;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (j != deepest) reach.from[i][j] = reach_of(s, c, i, j);
    c->above = min_of(c->above, bound_locally(s, &cell, &reach, parts, LOCAL_LEVELS));
}

/* ---- dividing ------------------------------------------------------------------------------------------ */

/* Parts take the place of the cell, and that of up to two behind it. Halves the longest side. */
static int halve_part(depth_search *s, cell_part *c) {
    const depth_cell cell = cell_of(c);
    const int i = longest_side(&cell), j = (i + 1) % 3;
    deep_point middle;
    for (int k = 0; k < 3; k++) middle.x[k] = 0.5 * (c->corners[i].x[k] + c->corners[j].x[k]);
    measure_between(s, c->number, &c->corners[i], &c->corners[j], &middle);
    c[1] = c[0];
    c[0].corners[j] = c[1].corners[i] = middle;
    return 2;
}

/* Upright on a part of the surface, along one of its sides: how far each corner of a cell is outside of it. */
typedef struct side_plane {
    double outside[3];
    double span; /* 0: it does not divide the cell, or hardly */
} side_plane;

static side_plane plane_along(const depth_search *s, const cell_part *c, const outer_part *part, int side) {
    const double(*p)[3] = part->corners;
    const double *a = p[side], *b = p[(side + 1) % 3];
    double ab[3], ac[3], normal[3], outwards[3], most = 0.0, least = 0.0;
    side_plane plane = {.span = 0.0};
    vec3_subtract(b, a, ab);
    vec3_subtract(p[(side + 2) % 3], a, ac);
    vec3_cross(ab, ac, normal);
    vec3_cross(ab, normal, outwards);
    const double norm = sqrt(vec3_dot(outwards, outwards));
    if (!(norm > 0.0)) return plane;
    for (int i = 0; i < 3; i++) {
        double from[3];
        for (int k = 0; k < 3; k++) from[k] = c->corners[i].x[k] * s->outer->scale - a[k];
        plane.outside[i] = vec3_dot(from, outwards) / norm;
        most = max_of(most, plane.outside[i]);
        least = min_of(least, plane.outside[i]);
    }
    const depth_cell cell = cell_of(c);
    const double size = length_of_side(&cell, longest_side(&cell)) * s->outer->scale;
    const double least_piece = 0x1p-40 * size + s->rounding * s->outer->scale;
    plane.span = min_of(most, -least) > least_piece ? most : 0.0;
    return plane;
}

/* The side of a part that the cell reaches farthest beyond. */
static side_plane choose_plane(const depth_search *s, const cell_part *c, const outer_part *part) {
    side_plane chosen = {.span = 0.0};
    for (int side = 0; side < 3; side++) {
        const side_plane plane = plane_along(s, c, part, side);
        if (plane.span > chosen.span) chosen = plane;
    }
    return chosen;
}

static deep_point point_in_plane(depth_search *s, const cell_part *c, const side_plane *plane, int i, int j) {
    const double share = plane->outside[i] / (plane->outside[i] - plane->outside[j]);
    deep_point p;
    for (int k = 0; k < 3; k++)
        p.x[k] = c->corners[i].x[k] + share * (c->corners[j].x[k] - c->corners[i].x[k]);
    measure_between(s, c->number, &c->corners[i], &c->corners[j], &p);
    return p;
}

/* One corner is alone on its side of the plane, or the two others are in the plane or on the other side. */
static int split_part(depth_search *s, cell_part *c, const side_plane *plane) {
    int inside = 0, alone = 0;
    for (int i = 0; i < 3; i++) inside += plane->outside[i] <= 0.0;
    for (int i = 0; i < 3; i++)
        if ((plane->outside[i] <= 0.0) == (inside == 1)) alone = i;
    const int j = (alone + 1) % 3, k = (alone + 2) % 3;
    const deep_point p = point_in_plane(s, c, plane, alone, j);
    const deep_point q = point_in_plane(s, c, plane, alone, k);
    c[2] = c[1] = c[0];
    c[0].corners[j] = p;
    c[0].corners[k] = q;
    c[1].corners[alone] = p;
    c[2].corners[alone] = q;
    c[2].corners[j] = p;
    return 3;
}

/* A cell that is wide compared to its depth reaches over several triangles of the surface, none of which
 * bounds it as a whole: it is split where the one below its middle ends. Returns the number of parts; -1: it
 * is not to be split. */
static int split_wide(depth_search *s, cell_part *c) {
    deep_point middle;
    const int deepest = deepest_corner(c);
    for (int k = 0; k < 3; k++)
        middle.x[k] = (c->corners[0].x[k] + c->corners[1].x[k] + c->corners[2].x[k]) / 3.0;
    measure_between(s, c->number, &c->corners[deepest], &c->corners[(deepest + 1) % 3], &middle);
    if (middle.nearest.triangle == UINT32_MAX) return -1;
    double bound = 0.0;
    for (int i = 0; i < 3; i++)
        bound = max_of(bound, outer_part_reach(s->outer, c->corners[i].x, &middle.nearest.part));
    bound /= s->outer->scale;
    if (!depth_search_wants(s, bound)) {
        s->bound = max_of(s->bound, bound);
        return 0;
    }
    const side_plane plane = choose_plane(s, c, &middle.nearest.part);
    return plane.span > 0.0 ? split_part(s, c, &plane) : -1;
}

/* Writes up to PARTS_OF_ONE parts in place of one, and returns how many. */
static int divide_part(depth_search *s, cell_part *c) {
    const double deepest = max_of(c->corners[0].depth, max_of(c->corners[1].depth, c->corners[2].depth));
    const depth_cell cell = cell_of(c);
    const bool wide = length_of_side(&cell, longest_side(&cell)) > 2.0 * deepest;
    int count = wide ? split_wide(s, c) : -1;
    s->cells_left--;
    if (count < 0) count = halve_part(s, c);
    for (int i = 0; i < count; i++) {
        c[i].level++;
        bound_part(s, &c[i]);
    }
    return count;
}

/* Is the part looked at any further? If not, its bound counts. */
static bool goes_on(depth_search *s, const cell_part *part) {
    if (part->level < LEVELS_MAX && s->cells_left > 0 && depth_search_wants(s, part->above)) return true;
    s->bound = max_of(s->bound, part->above);
    return false;
}

/* Puts a part among some others, so that the one that promises most comes last and is looked at first. */
static void sort_part(cell_part *parts, int count, const cell_part *part) {
    for (; count > 0 && part->above < parts[count - 1].above; count--) parts[count] = parts[count - 1];
    parts[count] = *part;
}

/* Looks at a part to its end, at its own parts one after the other. */
static void finish_part(depth_search *s, const cell_part *whole) {
    cell_part open_parts[(PARTS_OF_ONE - 1) * LEVELS_MAX + 1], parts[PARTS_OF_ONE];
    int count = 1;
    open_parts[0] = *whole;
    while (count > 0) {
        parts[0] = open_parts[--count];
        if (!goes_on(s, &parts[0])) continue;
        const int made = divide_part(s, parts), first = count;
        for (int i = 0; i < made; i++)
            if (goes_on(s, &parts[i])) sort_part(&open_parts[first], count++ - first, &parts[i]);
    }
}

/* ---- the queue ----------------------------------------------------------------------------------------- */

static void add_part(depth_search *s, depth_queue *queue, const cell_part *part) {
    if (!goes_on(s, part)) return;
    if (queue->count == DEPTH_QUEUE_MAX)
        finish_part(s, part);
    else
        queue->parts[queue->count++] = *part;
}

/* Takes out the part that promises most. */
static void take_part(depth_queue *queue, cell_part *out) {
    uint32_t most = 0;
    for (uint32_t i = 1; i < queue->count; i++)
        if (queue->parts[i].above > queue->parts[most].above) most = i;
    *out = queue->parts[most];
    queue->parts[most] = queue->parts[--queue->count];
}

void depth_search_finish(depth_search *s, depth_queue *queue) {
    cell_part parts[PARTS_OF_ONE];
    while (queue->count > 0) {
        take_part(queue, &parts[0]);
        if (!goes_on(s, &parts[0])) continue;
        const int made = divide_part(s, parts);
        for (int i = 0; i < made; i++) add_part(s, queue, &parts[i]);
    }
}

static void measure_corners(depth_search *s, const depth_cell *cell, const cscd_depth *const known[3],
                            cell_part *out) {
    uint32_t near[2] = {cell->near, UINT32_MAX};
    for (int i = 0; i < 3; i++) {
        deep_point *p = &out->corners[i];
        memcpy(p->x, cell->corners[i], sizeof p->x);
        if (known != NULL && known[i] != NULL && known[i]->triangle != UINT32_MAX) {
            p->nearest = outer_surface_near_on(s->outer, s->found, known[i]->triangle, p->x);
            p->depth = known[i]->depth;
        } else {
            measure_point(s, out->number, near, p);
        }
        near[0] = p->nearest.triangle;
        near[1] = cell->near;
    }
}

void depth_search_cell(depth_search *s, depth_queue *queue, const depth_cell *cell, uint32_t number,
                       double above, const cscd_depth *const known[3]) {
    cell_part part = {.above = above, .number = number};
    measure_corners(s, cell, known, &part);
    bound_part(s, &part);
    add_part(s, queue, &part);
}
