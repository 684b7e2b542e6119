/* A tree of boxes around triangles, halved at medians. */
#include "runtime/untangle/triangle_set.h"

#include "runtime/ccd/ccd.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* For fewer questions than this no tree is made. */
enum { FEW_QUESTIONS = 8 };

enum { LEAF_SIZE = 4, DEPTH_MAX = 64 };

typedef struct set_middle {
    double x[3]; /* three times the middle */
    uint32_t triangle;
} set_middle;

typedef struct set_node {
    double low[3], high[3];
    uint32_t first, count; /* items */
    uint32_t child;        /* the first of two children, which follow each other; 0: it is a leaf */
} set_node;

static array_list list_arrays(triangle_set *s, size_t count) {
    return (array_list){{ARRAY(s->items, count), ARRAY(s->middles, count), ARRAY(s->nodes, 2 * count)}};
}

void triangle_set_free(triangle_set *s) {
    context_free_all(s->context, list_arrays(s, 0));
    s->capacity = 0;
}

/* ---- the tree ------------------------------------------------------------------------------------------ */

static const double *corner_of(const triangle_set *s, uint32_t triangle, int corner) {
    return s->x + 3 * (size_t)s->mesh->triangles[triangle][corner];
}

static void bound_node(const triangle_set *s, set_node *node) {
    for (int k = 0; k < 3; k++) {
        node->low[k] = (double)INFINITY;
        node->high[k] = -(double)INFINITY;
    }
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
        for (int c = 0; c < 3; c++) {
            const double *p = corner_of(s, s->middles[i].triangle, c);
            for (int k = 0; k < 3; k++) {
                node->low[k] = min_of(node->low[k], p[k]);
                node->high[k] = max_of(node->high[k], p[k]);
            }
        }
    }
}

static int longest_axis(const set_node *node) {
    int axis = 0;
    for (int k = 1; k < 3; k++) {
        if (node->high[k] - node->low[k] > node->high[axis] - node->low[axis]) axis = k;
    }
    return axis;
}

/* Is the middle of a before that of b? Equal ones are in the order of their numbers. */
static bool comes_before(const set_middle *a, const set_middle *b, int axis) {
    return a->x[axis] < b->x[axis] || (a->x[axis] == b->x[axis] && a->triangle < b->triangle);
}

/* Puts the triangle with this rank in its place, lesser ones before it and others behind it (Hoare's selection). */
static void select_median(set_middle *middles, int axis, uint32_t first, uint32_t end, uint32_t rank) {
    while (end - first > 1) {
        const set_middle pivot = middles[first + (end - first - 1) / 2]; /* never the last one */
        uint32_t low = first, high = end - 1;
        for (;;) {
            while (comes_before(&middles[low], &pivot, axis)) low++;
            while (comes_before(&pivot, &middles[high], axis)) high--;
            if (low >= high) break;
            const set_middle other = middles[low];
            middles[low++] = middles[high];
            middles[high--] = other;
        }
        if (rank <= high)
            end = high + 1;
        else
            first = high + 1;
    }
}

static void divide_node(triangle_set *s, uint32_t number) {
    set_node *node = &s->nodes[number];
    bound_node(s, node);
    if (node->count <= s->leaf_size) return;
    const uint32_t half = node->count / 2;
    select_median(s->middles, longest_axis(node), node->first, node->first + node->count, node->first + half);
    const uint32_t child = s->node_count;
    s->node_count += 2;
    node->child = child;
    s->nodes[child] = (set_node){.first = node->first, .count = half};
    s->nodes[child + 1] = (set_node){.first = node->first + half, .count = node->count - half};
}

static set_middle middle_of(const triangle_set *s, uint32_t triangle) {
    set_middle m = {.triangle = triangle};
    for (int k = 0; k < 3; k++)
        m.x[k] = corner_of(s, triangle, 0)[k] + corner_of(s, triangle, 1)[k] + corner_of(s, triangle, 2)[k];
    return m;
}

bool triangle_set_make(triangle_set *s, const cscd_mesh *mesh, const double *x, const uint32_t *triangles,
                       uint32_t count, size_t questions) {
    s->mesh = mesh;
    s->x = x;
    s->count = s->node_count = 0;
    if (!context_renew_all(s->context, list_arrays(s, room_with_spare(count)), &s->capacity, count))
        return false;
    s->count = count;
    if (count == 0) return true;
    s->leaf_size = questions < FEW_QUESTIONS ? count : LEAF_SIZE;
    for (uint32_t i = 0; i < count; i++) s->middles[i] = middle_of(s, triangles[i]);
    s->node_count = 1;
    s->nodes[0] = (set_node){.count = count};
    for (uint32_t i = 0; i < s->node_count; i++) divide_node(s, i);
    for (uint32_t i = 0; i < count; i++) s->items[i] = s->middles[i].triangle;
    return true;
}

/* ---- nearest points ------------------------------------------------------------------------------------ */

static double squared_distance_from(const set_node *node, const double p[3]) {
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double outside = max_of(max_of(node->low[k] - p[k], p[k] - node->high[k]), 0.0);
        sum += outside * outside;
    }
    return sum;
}

static void look_at_leaf(const triangle_set *s, const set_node *node, const double p[3], double *squared,
                         set_place *best) {
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
        const uint32_t t = s->items[i];
        double u, v;
        const double here =
            closest_point_triangle(p, corner_of(s, t, 0), corner_of(s, t, 1), corner_of(s, t, 2), &u, &v);
        if (here > *squared || (here == *squared && t >= best->triangle)) continue;
        *squared = here;
        *best = (set_place){t, {1.0 - u - v, u, v}, 0.0};
    }
}

set_place triangle_set_nearest(const triangle_set *s, const double point[3]) {
    uint32_t stack[DEPTH_MAX];
    int open = 0;
    double squared = (double)INFINITY;
    set_place best = {.triangle = UINT32_MAX};
    if (s->count > 0) stack[open++] = 0;
    while (open > 0) {
        const set_node *node = &s->nodes[stack[--open]];
        if (squared_distance_from(node, point) > squared) continue;
        if (node->child == 0) {
            look_at_leaf(s, node, point, &squared, &best);
            continue;
        }
        const double first = squared_distance_from(&s->nodes[node->child], point),
                     second = squared_distance_from(&s->nodes[node->child + 1], point);
        stack[open++] = first < second ? node->child + 1 : node->child;
        stack[open++] = first < second ? node->child : node->child + 1;
    }
    best.distance = sqrt(squared);
    return best;
}

/* ---- rays ---------------------------------------------------------------------------------------------- */

/* May the ray meet the box farther away than `least`? */
static bool may_hit_farther(const set_node *node, const double p[3], const double n[3], double least) {
    double from = least, to = (double)INFINITY;
    for (int k = 0; k < 3; k++) {
        if (n[k] == 0.0) {
            if (p[k] < node->low[k] || p[k] > node->high[k]) return false;
            continue;
        }
        const double a = (node->low[k] - p[k]) / n[k], b = (node->high[k] - p[k]) / n[k];
        from = max_of(from, min_of(a, b));
        to = min_of(to, max_of(a, b));
    }
    return from <= to + 1e-9 * fabs(to);
}

/* Moeller and Trumbore 1997. The border counts, and a little beyond it, so that no ray slips through between two triangles. */
static bool hit_triangle(const triangle_set *s, uint32_t t, const double p[3], const double n[3],
                         set_place *out) {
    const double *a = corner_of(s, t, 0);
    double ab[3], ac[3], ap[3], across[3], up[3];
    vec3_subtract(corner_of(s, t, 1), a, ab);
    vec3_subtract(corner_of(s, t, 2), a, ac);
    vec3_subtract(p, a, ap);
    vec3_cross(n, ac, across);
    const double determinant = vec3_dot(ab, across);
    if (determinant == 0.0) return false;
    const double u = vec3_dot(ap, across) / determinant;
    vec3_cross(ap, ab, up);
    const double v = vec3_dot(n, up) / determinant;
    if (!(u >= -1e-9) || !(v >= -1e-9) || !(u + v <= 1.0 + 1e-9)) return false;
    *out = (set_place){t, {1.0 - u - v, u, v}, vec3_dot(ac, up) / determinant};
    return true;
}

set_place triangle_set_farthest_hit(const triangle_set *s, const double point[3], const double direction[3]) {
    uint32_t stack[DEPTH_MAX];
    int open = 0;
    set_place best = {.triangle = UINT32_MAX};
    if (s->count > 0) stack[open++] = 0;
    while (open > 0) {
        const set_node *node = &s->nodes[stack[--open]];
        if (!may_hit_farther(node, point, direction, best.distance)) continue;
        if (node->child > 0) {
            stack[open++] = node->child + 1;
            stack[open++] = node->child;
            continue;
        }
        for (uint32_t i = node->first; i < node->first + node->count; i++) {
            set_place hit;
            if (hit_triangle(s, s->items[i], point, direction, &hit) && hit.distance > best.distance)
                best = hit;
        }
    }
    return best;
}
