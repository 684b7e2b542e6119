/* Clips ears, the shortest diagonal first (Meisters 1975; O'Rourke, Computational Geometry in C, 1.4).
 *
 * A corner v with neighbours u and w is an ear if u, v, w turn left, the diagonal u w leaves into the polygon at both of its
 * ends, and no other corner lies in the closed triangle, except at the places of its corners. Of a chain that enters the
 * triangle through the diagonal the corner that comes nearest to v does not turn left, so only such corners are looked
 * at. Corners at the place of u or w cannot be in the way either: at one place the inner angles of a weakly simple
 * polygon are disjoint, and the diagonal leaves within the angle of u. */
#include "tool/io/polygon/ear_clipping.h"

#include "tool/io/growable.h"
#include "tool/io/polygon/corner_tree.h"
#include "tool/io/polygon/orientation.h"

#include <stdlib.h>

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

/* ---- heap -------------------------------------------------------------------------------------------- */

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

/* The candidates that wait for a corner may be ears once it is clipped, and not before: a corner in the way stays there, even
 * when it has become convex. */
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

/* The corner that keeps a candidate from being an ear: a neighbour from which the diagonal leaves outwards, or one in the
 * way. The candidate turns left, so the diagonal lies to the left of its side at either end, and leaves outwards only where an
 * angle of less than 180 degrees ends before it. */
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
