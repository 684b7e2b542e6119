/* Triangles of a polygon in a plane, by clipping ears: exact orientations, and a tree in which the corners
 * within an ear are found. */
#include "tool/io/polygon.h"

#include "tool/io/io.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* ---- orientation --------------------------------------------------------------------------------------- */

/* The computed determinant is wrong by at most (3 + 16 e) e times the sum of its two products'
 * magnitudes, e = 2^-53 (Shewchuk, ccwerrboundA); products that underflow are smaller than 2^-600 here
 * only if they are 0. */
static const double error_bound = (3.0 + 16.0 * 0x1p-53) * 0x1p-53;

/* Adds a number to an expansion of `count` components, which grow in magnitude; the sum has one component
 * more. */
static void grow_expansion(double *expansion, size_t count, double number) {
    double sum = number;
    for (size_t i = 0; i < count; i++) {
        const double part = expansion[i], rounded = sum + part, back = rounded - sum;
        expansion[i] = (sum - (rounded - back)) + (part - back);
        sum = rounded;
    }
    expansion[count] = sum;
}

typedef struct split_number {
    double high, low; /* of 26 bits each */
} split_number;

static split_number split_double(double a) {
    const double scaled = 0x8000001p0 * a, high = scaled - (scaled - a);
    return (split_number){high, a - high};
}

/* The error of the rounded product a b (Dekker 1971). Not by fma(), which some C libraries compute in two
 * roundings, as that of mingw-w64 does. */
static double missing_in_product(double a, double b, double product) {
    const split_number x = split_double(a), y = split_double(b);
    return x.low * y.low - (((product - x.high * y.high) - x.low * y.high) - x.high * y.low);
}

/* The sign of ax by - ay bx + bx cy - by cx + cx ay - cy ax, each product as a sum of two doubles. */
static int exact_sign(const double a[2], const double b[2], const double c[2]) {
    const double *const points[4] = {a, b, c, a};
    double expansion[12];
    size_t count = 0;
    for (int i = 0; i < 3; i++) {
        const double *p = points[i], *q = points[i + 1];
        const double forward = p[0] * q[1], backward = -p[1] * q[0];
        grow_expansion(expansion, count++, missing_in_product(p[0], q[1], forward));
        grow_expansion(expansion, count++, forward);
        grow_expansion(expansion, count++, missing_in_product(-p[1], q[0], backward));
        grow_expansion(expansion, count++, backward);
    }
    /* The components do not overlap, so the largest that is not 0 has the sign of the sum. */
    while (count > 0 && expansion[count - 1] == 0.0) count--;
    return count == 0 ? 0 : expansion[count - 1] > 0.0 ? 1 : -1;
}

/* The determinant, and a bound of its error. */
static double find_determinant(const double a[2], const double b[2], const double c[2], double *bound) {
    const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
    *bound = error_bound * (fabs(left) + fabs(right));
    return left - right;
}

int orientation_of(const double a[2], const double b[2], const double c[2]) {
    double bound;
    const double determinant = find_determinant(a, b, c, &bound);
    if (determinant > bound) return 1;
    if (determinant < -bound) return -1;
    return exact_sign(a, b, c);
}

/* ---- the tree of corners ------------------------------------------------------------------------------- */

enum { LEAF_SIZE = 8, DEPTH_MAX = 64 };

/* ---- building the tree --------------------------------------------------------------------------------- */

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

/* Any direction will do for a box, so all that rounding can spoil are the projections: both those here and
 * those of triangles, each by less than 3 * 2^-53 times twice the largest coordinate. */
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
    /* Halves of more than LEAF_SIZE points have half of these at least, so there are fewer leaves than
     * this. */
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

/* ---- searching the tree -------------------------------------------------------------------------------- */

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

/* Does the whole box lie to the right of a b? Both ends may be off by the slack, and so may the box; what
 * rounds here is less than that. */
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

/* ---- corners of the polygon ---------------------------------------------------------------------------- */

#define NO_CORNER UINT32_MAX

/* A convex corner that may be an ear; it is out of date once the corner has been changed. */
typedef struct ear_candidate {
    double length; /* of the diagonal, squared */
    uint32_t corner, version;
} ear_candidate;

typedef struct clipped_corner {
    uint32_t previous, next;
    uint32_t version;
    bool convex, clipped;
    /* A candidate that some corner stands in the way of waits in that corner's list. */
    uint32_t first_waiting, next_waiting, previous_waiting, waits_for;
} clipped_corner;

typedef struct ear_clipper {
    const double (*points)[2];
    uint32_t count, left; /* corners; not yet clipped */
    clipped_corner *corners;
    growable heap; /* of ear_candidate, the shortest first */
    bool out_of_memory;
    corner_tree tree; /* those that do not turn left are active */
} ear_clipper;

/* ---- the heap of ears ---------------------------------------------------------------------------------- */

static bool comes_before(const ear_candidate *a, const ear_candidate *b) {
    return a->length < b->length || (a->length == b->length && a->corner < b->corner);
}

static void push_candidate(ear_clipper *c, uint32_t corner) {
    const clipped_corner *v = &c->corners[corner];
    const double *u = c->points[v->previous], *w = c->points[v->next];
    const double x = u[0] - w[0], y = u[1] - w[1];
    const ear_candidate candidate = {x * x + y * y, corner, v->version};
    if (growable_push(&c->heap) == NULL) {
        c->out_of_memory = true;
        return;
    }
    ear_candidate *heap = c->heap.data;
    size_t at = c->heap.count - 1;
    for (; at > 0 && comes_before(&candidate, &heap[(at - 1) / 2]); at = (at - 1) / 2)
        heap[at] = heap[(at - 1) / 2];
    heap[at] = candidate;
}

static ear_candidate pop_candidate(ear_clipper *c) {
    ear_candidate *heap = c->heap.data;
    const ear_candidate first = heap[0], last = heap[--c->heap.count];
    const size_t count = c->heap.count;
    size_t at = 0;
    for (size_t child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && comes_before(&heap[child + 1], &heap[child])) child++;
        if (!comes_before(&heap[child], &last)) break;
        heap[at] = heap[child];
    }
    if (count > 0) heap[at] = last;
    return first;
}

/* ---- ears -------------------------------------------------------------------------------------------- */

static int turn_at(const ear_clipper *c, uint32_t a, uint32_t b, uint32_t d) {
    return orientation_of(c->points[a], c->points[b], c->points[d]);
}

/* The candidates that wait for a corner may be ears once it is clipped, and not before: a corner in the way
 * stays there, even when it has become convex. */
static void release_waiting(ear_clipper *c, uint32_t corner) {
    uint32_t waiting = c->corners[corner].first_waiting;
    c->corners[corner].first_waiting = NO_CORNER;
    while (waiting != NO_CORNER) {
        clipped_corner *v = &c->corners[waiting];
        const uint32_t next = v->next_waiting;
        v->waits_for = NO_CORNER;
        if (!v->clipped && v->convex) push_candidate(c, waiting);
        waiting = next;
    }
}

static void let_wait(ear_clipper *c, uint32_t corner, uint32_t in_way) {
    clipped_corner *v = &c->corners[corner], *z = &c->corners[in_way];
    v->waits_for = in_way;
    v->next_waiting = z->first_waiting;
    v->previous_waiting = NO_CORNER;
    if (z->first_waiting != NO_CORNER) c->corners[z->first_waiting].previous_waiting = corner;
    z->first_waiting = corner;
}

static void stop_waiting(ear_clipper *c, uint32_t corner) {
    clipped_corner *v = &c->corners[corner];
    if (v->waits_for == NO_CORNER) return;
    if (v->previous_waiting != NO_CORNER)
        c->corners[v->previous_waiting].next_waiting = v->next_waiting;
    else
        c->corners[v->waits_for].first_waiting = v->next_waiting;
    if (v->next_waiting != NO_CORNER) c->corners[v->next_waiting].previous_waiting = v->previous_waiting;
    v->waits_for = NO_CORNER;
}

/* A neighbour that waits for a corner's angle may be an ear once the angle has changed. */
static void retry_neighbour(ear_clipper *c, uint32_t corner, uint32_t neighbour) {
    if (c->corners[neighbour].waits_for != corner) return;
    stop_waiting(c, neighbour);
    if (c->corners[neighbour].convex) push_candidate(c, neighbour);
}

/* A corner has another neighbour than before. */
static void renew_corner(ear_clipper *c, uint32_t corner) {
    clipped_corner *v = &c->corners[corner];
    v->version++;
    stop_waiting(c, corner);
    v->convex = turn_at(c, v->previous, corner, v->next) > 0;
    corner_tree_set_active(&c->tree, corner, !v->convex);
    if (v->convex) push_candidate(c, corner);
    retry_neighbour(c, corner, v->previous);
    retry_neighbour(c, corner, v->next);
}

static void clip_ear(ear_clipper *c, uint32_t corner, uint32_t triangle[3]) {
    clipped_corner *v = &c->corners[corner];
    const uint32_t u = v->previous, w = v->next;
    triangle[0] = u;
    triangle[1] = corner;
    triangle[2] = w;
    v->clipped = true;
    corner_tree_set_active(&c->tree, corner, false);
    c->left--;
    c->corners[u].next = w;
    c->corners[w].previous = u;
    stop_waiting(c, corner);
    release_waiting(c, corner);
    renew_corner(c, u);
    renew_corner(c, w);
}

/* The corner that keeps a candidate from being an ear: a neighbour from which the diagonal leaves outwards,
 * or one in the way. The candidate turns left, so the diagonal lies to the left of its side at either end,
 * and leaves outwards only where an angle of less than 180 degrees ends before it. */
static uint32_t find_obstacle(ear_clipper *c, uint32_t corner) {
    const uint32_t u = c->corners[corner].previous, w = c->corners[corner].next;
    if (c->corners[u].convex && turn_at(c, u, w, c->corners[u].previous) <= 0) return u;
    if (c->corners[w].convex && turn_at(c, u, w, c->corners[w].next) <= 0) return w;
    return corner_tree_find(&c->tree, (const uint32_t[3]){u, corner, w});
}

static bool start_clipping(ear_clipper *c) {
    c->corners = io_realloc(NULL, (size_t)c->count * sizeof *c->corners);
    if (c->corners == NULL || !corner_tree_create(c->points, c->count, &c->tree)) return false;
    for (uint32_t i = 0; i < c->count; i++)
        c->corners[i] = (clipped_corner){.previous = i > 0 ? i - 1 : c->count - 1,
                                         .next = i + 1 < c->count ? i + 1 : 0,
                                         .first_waiting = NO_CORNER,
                                         .waits_for = NO_CORNER};
    for (uint32_t i = 0; i < c->count; i++) {
        clipped_corner *v = &c->corners[i];
        v->convex = turn_at(c, v->previous, i, v->next) > 0;
        corner_tree_set_active(&c->tree, i, !v->convex);
        if (v->convex) push_candidate(c, i);
    }
    return !c->out_of_memory;
}

bool ear_clipping_fill(const double (*points)[2], uint32_t corner_count, uint32_t (*triangles)[3],
                       bool *out_of_memory) {
    ear_clipper c = {.points = points,
                     .count = corner_count,
                     .left = corner_count,
                     .heap = growable_of(sizeof(ear_candidate))};
    c.out_of_memory = !start_clipping(&c);
    uint32_t filled = 0;
    while (!c.out_of_memory && c.left > 2 && c.heap.count > 0) {
        const ear_candidate candidate = pop_candidate(&c);
        const clipped_corner *v = &c.corners[candidate.corner];
        if (v->clipped || v->version != candidate.version || v->waits_for != NO_CORNER) continue;
        const uint32_t obstacle = c.left > 3 ? find_obstacle(&c, candidate.corner) : NO_CORNER;
        if (obstacle != NO_CORNER)
            let_wait(&c, candidate.corner, obstacle);
        else
            clip_ear(&c, candidate.corner, triangles[filled++]);
    }
    free(c.corners);
    corner_tree_free(&c.tree);
    growable_free(&c.heap);
    *out_of_memory = c.out_of_memory;
    return !c.out_of_memory && c.left == 2;
}
