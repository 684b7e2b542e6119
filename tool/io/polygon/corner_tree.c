/* A tree of boxes around stretches of the outline, each half of the one above, that count their active corners.
 *
 * A box is turned as its stretch runs: of outlines that go to and fro, as stars with long rays do, boxes along the axes lie over
 * each other, and so do the cells of a k-d tree and thin triangles; turned ones do not. */
#include "tool/io/polygon/corner_tree.h"

#include "tool/io/growable.h"
#include "tool/io/polygon/orientation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAF_SIZE = 8, DEPTH_MAX = 64 };

/* ---- building ---------------------------------------------------------------------------------------- */

static void project_point(const corner_node *node, const double p[2], double out[2]) {
    out[0] = node->direction[0] * p[0] + node->direction[1] * p[1];
    out[1] = node->direction[0] * p[1] - node->direction[1] * p[0];
}

/* Turns the box along the line from which its corners lie least far, by squares. */
static void find_direction(const corner_tree *tree, corner_node *node) {
    double mean[2] = {0.0, 0.0}, xx = 0.0, xy = 0.0, yy = 0.0;
    const double count = node->end - node->first;
    for (uint32_t i = node->first; i < node->end; i++)
        for (int k = 0; k < 2; k++) mean[k] += tree->points[i][k] / count;
    for (uint32_t i = node->first; i < node->end; i++) {
        const double x = tree->points[i][0] - mean[0], y = tree->points[i][1] - mean[1];
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    const double angle = 0.5 * atan2(2.0 * xy, xx - yy);
    node->direction[0] = isfinite(angle) ? cos(angle) : 1.0;
    node->direction[1] = isfinite(angle) ? sin(angle) : 0.0;
}

/* Any direction will do for a box, so all that rounding can spoil are the projections: both those here and those of
 * triangles, each by less than 3 * 2^-53 times twice the largest coordinate. */
static void find_box(const corner_tree *tree, corner_node *node) {
    find_direction(tree, node);
    for (int k = 0; k < 2; k++) {
        node->low[k] = INFINITY;
        node->high[k] = -INFINITY;
    }
    for (uint32_t i = node->first; i < node->end; i++) {
        double at[2];
        project_point(node, tree->points[i], at);
        for (int k = 0; k < 2; k++) {
            if (at[k] < node->low[k]) node->low[k] = at[k];
            if (at[k] > node->high[k]) node->high[k] = at[k];
        }
    }
    for (int k = 0; k < 2; k++) {
        node->low[k] -= tree->slack;
        node->high[k] += tree->slack;
    }
}

static void split_nodes(corner_tree *tree) {
    for (uint32_t n = 0; n < tree->node_count; n++) {
        corner_node *node = &tree->nodes[n];
        find_box(tree, node);
        if (node->end - node->first <= LEAF_SIZE) {
            for (uint32_t i = node->first; i < node->end; i++) tree->node_of[i] = n;
            continue;
        }
        const uint32_t middle = node->first + (node->end - node->first) / 2;
        node->child = tree->node_count;
        tree->nodes[tree->node_count++] = (corner_node){.first = node->first, .end = middle, .parent = n};
        tree->nodes[tree->node_count++] = (corner_node){.first = middle, .end = node->end, .parent = n};
    }
}

bool corner_tree_create(const double (*points)[2], uint32_t count, corner_tree *out) {
    /* Halves of more than LEAF_SIZE points have half of these at least, so there are fewer leaves than this. */
    const size_t leaf_limit = 2 * (size_t)count / LEAF_SIZE + 1;
    corner_tree tree = {.points = points,
                        .node_of = io_realloc(NULL, (size_t)count * sizeof *tree.node_of),
                        .active = io_realloc(NULL, (size_t)count * sizeof *tree.active),
                        .nodes = io_realloc(NULL, 2 * leaf_limit * sizeof *tree.nodes)};
    if (tree.node_of == NULL || tree.active == NULL || tree.nodes == NULL) {
        corner_tree_free(&tree);
        return false;
    }
    double largest = 0.0;
    for (uint32_t i = 0; i < count; i++)
        largest = fmax(largest, fmax(fabs(points[i][0]), fabs(points[i][1])));
    memset(tree.active, 0, (size_t)count * sizeof *tree.active);
    tree.nodes[0] = (corner_node){.end = count, .parent = UINT32_MAX};
    tree.node_count = 1;
    tree.slack = 0x1p-48 * largest + 0x1p-1000;
    split_nodes(&tree);
    *out = tree;
    return true;
}

void corner_tree_free(corner_tree *tree) {
    free(tree->node_of);
    free(tree->active);
    free(tree->nodes);
    *tree = (corner_tree){0};
}

void corner_tree_set_active(corner_tree *tree, uint32_t point, bool active) {
    if (tree->active[point] == active) return;
    tree->active[point] = active;
    for (uint32_t n = tree->node_of[point]; n != UINT32_MAX; n = tree->nodes[n].parent) {
        if (active)
            tree->nodes[n].active_count++;
        else
            tree->nodes[n].active_count--;
    }
}

/* ---- searching --------------------------------------------------------------------------------------- */

/* The triangle that is searched, and its box. */
typedef struct searched_triangle {
    const double *corners[3];
    double low[2], high[2];
} searched_triangle;

static searched_triangle take_triangle(const corner_tree *tree, const uint32_t triangle[3]) {
    searched_triangle t;
    for (int i = 0; i < 3; i++) t.corners[i] = tree->points[triangle[i]];
    for (int k = 0; k < 2; k++) {
        const double a = t.corners[0][k], b = t.corners[1][k], c = t.corners[2][k];
        t.low[k] = a < b ? (a < c ? a : c) : (b < c ? b : c);
        t.high[k] = a > b ? (a > c ? a : c) : (b > c ? b : c);
    }
    return t;
}

/* Does the whole box lie to the right of a b? Both ends may be off by the slack, and so may the box; what rounds here is
 * less than that. */
static bool side_has_box_outside(const corner_node *node, const double a[2], const double b[2],
                                 double slack) {
    const double side[2] = {b[0] - a[0], b[1] - a[1]};
    /* To the corner of the box that lies farthest to the left. */
    const double way[2] = {(side[1] > 0.0 ? node->low[0] : node->high[0]) - a[0],
                           (side[0] > 0.0 ? node->high[1] : node->low[1]) - a[1]};
    const double size = node->high[0] - node->low[0] + node->high[1] - node->low[1];
    const double bound = 8.0 * slack * (fabs(side[0]) + fabs(side[1]) + fabs(way[0]) + fabs(way[1]) + size);
    return side[0] * way[1] - side[1] * way[0] < -bound;
}

/* Has a side of the box the whole triangle outside, or one of the triangle the box? */
static bool box_is_outside(const corner_tree *tree, const corner_node *node, const searched_triangle *t) {
    double corners[3][2];
    for (int i = 0; i < 3; i++) project_point(node, t->corners[i], corners[i]);
    for (int k = 0; k < 2; k++) {
        const double a = corners[0][k], b = corners[1][k], c = corners[2][k];
        if (a < node->low[k] && b < node->low[k] && c < node->low[k]) return true;
        if (a > node->high[k] && b > node->high[k] && c > node->high[k]) return true;
    }
    for (int i = 0; i < 3; i++)
        if (side_has_box_outside(node, corners[i], corners[(i + 1) % 3], tree->slack)) return true;
    return false;
}

static bool contains_point(const searched_triangle *t, const double p[2]) {
    for (int k = 0; k < 2; k++)
        if (p[k] < t->low[k] || p[k] > t->high[k]) return false;
    for (int i = 0; i < 3; i++)
        if (p[0] == t->corners[i][0] && p[1] == t->corners[i][1]) return false;
    for (int i = 0; i < 3; i++)
        if (orientation_of(t->corners[i], t->corners[(i + 1) % 3], p) < 0) return false;
    return true;
}

static uint32_t search_leaf(const corner_tree *tree, const corner_node *leaf, const searched_triangle *t) {
    for (uint32_t i = leaf->first; i < leaf->end; i++)
        if (tree->active[i] && contains_point(t, tree->points[i])) return i;
    return UINT32_MAX;
}

uint32_t corner_tree_find(const corner_tree *tree, const uint32_t triangle[3]) {
    const searched_triangle t = take_triangle(tree, triangle);
    uint32_t stack[DEPTH_MAX], depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const corner_node *node = &tree->nodes[stack[--depth]];
        if (node->active_count == 0 || box_is_outside(tree, node, &t)) continue;
        if (node->child != 0) {
            stack[depth++] = node->child;
            stack[depth++] = node->child + 1;
            continue;
        }
        const uint32_t found = search_leaf(tree, node, &t);
        if (found != UINT32_MAX) return found;
    }
    return UINT32_MAX;
}
