/* A k-d tree whose nodes halve their points along the longer side of their box, and count the active ones. */
#include "src/io/polygon/corner_tree.h"

#include "src/io/growable.h"
#include "src/io/polygon/orientation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAF_SIZE = 8, DEPTH_MAX = 64 };

/* ---- building ---------------------------------------------------------------------------------------- */

static void find_box(const corner_tree *tree, corner_node *node) {
    for (int k = 0; k < 2; k++) {
        node->low[k] = INFINITY;
        node->high[k] = -INFINITY;
        for (uint32_t i = node->first; i < node->end; i++) {
            const double x = tree->points[tree->order[i]][k];
            node->low[k] = fmin(node->low[k], x);
            node->high[k] = fmax(node->high[k], x);
        }
    }
}

static void swap_points(uint32_t *a, uint32_t *b) {
    const uint32_t kept = *a;
    *a = *b;
    *b = kept;
}

/* Puts the middle point of a range in its place along an axis, smaller ones before it and larger ones behind it: quickselect
 * that parts in three, so that equal coordinates cost nothing, around pivots of a fixed random sequence. */
static void select_middle(corner_tree *tree, uint32_t first, uint32_t end, uint32_t middle, int axis) {
    uint32_t *order = tree->order, random = 1;
    while (end - first > 1) {
        random = random * 1664525u + 1013904223u;
        const uint32_t at = first + (uint32_t)((uint64_t)random * (end - first) >> 32);
        const double pivot = tree->points[order[at]][axis];
        uint32_t smaller = first, larger = end;
        for (uint32_t i = first; i < larger;) {
            const double x = tree->points[order[i]][axis];
            if (x < pivot)
                swap_points(&order[smaller++], &order[i++]);
            else if (x > pivot)
                swap_points(&order[--larger], &order[i]);
            else
                i++;
        }
        if (middle < smaller)
            end = smaller;
        else if (middle >= larger)
            first = larger;
        else
            return;
    }
}

static void split_nodes(corner_tree *tree) {
    for (uint32_t n = 0; n < tree->node_count; n++) {
        corner_node *node = &tree->nodes[n];
        find_box(tree, node);
        if (node->end - node->first <= LEAF_SIZE) {
            for (uint32_t i = node->first; i < node->end; i++) tree->node_of[tree->order[i]] = n;
            continue;
        }
        const int axis = node->high[1] - node->low[1] > node->high[0] - node->low[0];
        const uint32_t middle = node->first + (node->end - node->first) / 2;
        select_middle(tree, node->first, node->end, middle, axis);
        node->child = tree->node_count;
        tree->nodes[tree->node_count++] = (corner_node){.first = node->first, .end = middle, .parent = n};
        tree->nodes[tree->node_count++] = (corner_node){.first = middle, .end = node->end, .parent = n};
    }
}

bool corner_tree_create(const double (*points)[2], uint32_t count, corner_tree *out) {
    /* Halves of more than LEAF_SIZE points have half of these at least, so there are fewer leaves than this. */
    const size_t leaf_limit = 2 * (size_t)count / LEAF_SIZE + 1;
    corner_tree tree = {.points = points,
                        .order = io_realloc(NULL, (size_t)count * sizeof *tree.order),
                        .node_of = io_realloc(NULL, (size_t)count * sizeof *tree.node_of),
                        .active = io_realloc(NULL, (size_t)count * sizeof *tree.active),
                        .nodes = io_realloc(NULL, 2 * leaf_limit * sizeof *tree.nodes)};
    if (tree.order == NULL || tree.node_of == NULL || tree.active == NULL || tree.nodes == NULL) {
        corner_tree_free(&tree);
        return false;
    }
    for (uint32_t i = 0; i < count; i++) tree.order[i] = i;
    memset(tree.active, 0, (size_t)count * sizeof *tree.active);
    tree.nodes[0] = (corner_node){.end = count, .parent = UINT32_MAX};
    tree.node_count = 1;
    split_nodes(&tree);
    *out = tree;
    return true;
}

void corner_tree_free(corner_tree *tree) {
    free(tree->order);
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

/* Is the whole box outside of the triangle's box, or to the right of one of its sides? */
static bool box_is_outside(const corner_node *node, const searched_triangle *t) {
    for (int k = 0; k < 2; k++)
        if (node->low[k] > t->high[k] || node->high[k] < t->low[k]) return true;
    for (int i = 0; i < 3; i++) {
        const double *a = t->corners[i], *b = t->corners[(i + 1) % 3];
        /* The corner of the box that lies farthest to the left of a b. */
        const double corner[2] = {b[1] > a[1] ? node->low[0] : node->high[0],
                                  b[0] > a[0] ? node->high[1] : node->low[1]};
        if (orientation_is_right(a, b, corner)) return true;
    }
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
        if (tree->active[tree->order[i]] && contains_point(t, tree->points[tree->order[i]]))
            return tree->order[i];
    return UINT32_MAX;
}

uint32_t corner_tree_find(const corner_tree *tree, const uint32_t triangle[3]) {
    const searched_triangle t = take_triangle(tree, triangle);
    uint32_t stack[DEPTH_MAX], depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const corner_node *node = &tree->nodes[stack[--depth]];
        if (node->active_count == 0 || box_is_outside(node, &t)) continue;
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
