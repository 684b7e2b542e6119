/* From triangle pairs to contacts: representatives, feature volumes, elementary tests. */
#include "runtime/narrow_phase.h"

#include "runtime/representatives.h"

#include <string.h>

void contact_lane_reset(contact_lane *lane) {
    lane->count = 0;
    lane->feature_pairs = 0;
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) lane->decided[i] = 0;
    lane->separations = 0;
    lane->out_of_memory = false;
    lane->queue.vf.count = lane->queue.ee.count = 0;
}

static bool make_room(cscd_context *context, contact_lane *lane) {
    if (lane->count < lane->capacity) return true;
    size_t capacity = lane->capacity == 0 ? 256 : lane->capacity * 2;
    cscd_contact *grown =
        context_grow(context, lane->contacts, lane->count, capacity, sizeof *lane->contacts);
    if (grown == NULL) {
        lane->out_of_memory = true;
        return false;
    }
    lane->contacts = grown;
    lane->capacity = capacity;
    return true;
}

void contact_lane_add(cscd_context *context, contact_lane *lane, cscd_contact_kind kind, uint32_t a,
                      uint32_t b, const elementary_hit *hit, bool bounded) {
    if (!make_room(context, lane)) return;
    cscd_contact *contact = &lane->contacts[lane->count++];
    memset(contact, 0, sizeof *contact); /* padding too: lists are compared bit for bit */
    contact->kind = kind;
    contact->a = a;
    contact->b = b;
    contact->toi = hit->toi;
    contact->u = hit->u;
    contact->v = hit->v;
    memcpy(contact->point, hit->point, sizeof contact->point);
    memcpy(contact->normal, hit->normal, sizeof contact->normal);
    contact->bounded = bounded;
}

static void load_point(const swept_interval *interval, uint32_t vertex, elementary_query *query, int i) {
    memcpy(query->x0[i], interval->x0 + (size_t)vertex * 3, sizeof query->x0[i]);
    memcpy(query->x1[i], interval->x1 + (size_t)vertex * 3, sizeof query->x1[i]);
}

void narrow_phase_load(const swept_interval *interval, cscd_contact_kind kind, uint32_t a, uint32_t b,
                       elementary_query *query) {
    const cscd_mesh *mesh = interval->mesh;
    if (kind == CSCD_CONTACT_VF) {
        load_point(interval, a, query, 0);
        for (int i = 0; i < 3; i++) load_point(interval, mesh->triangles[b][i], query, 1 + i);
    } else {
        for (int i = 0; i < 4; i++) load_point(interval, mesh->edges[i < 2 ? a : b][i % 2], query, i);
    }
}

void narrow_phase_test_vf(const swept_interval *interval, uint32_t vertex, uint32_t triangle,
                          contact_lane *lane) {
    feature_list *list = &lane->queue.vf;
    if (feature_list_full(list)) feature_queue_decide_vf(interval, lane);
    list->count = feature_list_put(list, list->count, vertex, triangle, 1);
}

static uint32_t smaller_of(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

static uint32_t larger_of(uint32_t a, uint32_t b) {
    return a < b ? b : a;
}

/* Feature a is the edge of the smaller number, whichever way the pair was found: the test's rounding, and so
 * its result, never depends on the traversal. */
void narrow_phase_test_ee(const swept_interval *interval, uint32_t a, uint32_t b, contact_lane *lane) {
    feature_list *list = &lane->queue.ee;
    if (feature_list_full(list)) feature_queue_decide_ee(interval, lane);
    list->count = feature_list_put(list, list->count, smaller_of(a, b), larger_of(a, b), 1);
}

void narrow_phase_finish(const swept_interval *interval, contact_lane *lane) {
    feature_queue_decide_vf(interval, lane);
    feature_queue_decide_ee(interval, lane);
}

/* ---- which triangle pair answers for a pair of features --------------------------------------------- */

/* Without culling: that of the first triangles of both stars. With it: the first pair, in the order of the
 * stars, that the flags leave (then it is reached, for its volumes contain the features'); and among the
 * culled pairs that of the first triangles, where the flags leave none. */
static bool first_kept_vertex(const swept_interval *interval, uint32_t of, uint32_t vertex,
                              uint32_t against) {
    const cscd_mesh *mesh = interval->mesh;
    uint32_t begin = mesh->vertex_star_offsets[vertex], end = mesh->vertex_star_offsets[vertex + 1];
    for (uint32_t i = begin; i < end; i++) {
        if (culling_keeps(interval->culling, mesh->vertex_stars[i], against))
            return !interval->culled_pairs && mesh->vertex_stars[i] == of;
    }
    return interval->culled_pairs && mesh->vertex_stars[begin] == of;
}

static bool answers_for_vertex(const swept_interval *interval, uint32_t of, int i, uint32_t against) {
    if (interval->culling == NULL) return represents_vertex(interval->representatives[of], i);
    return first_kept_vertex(interval, of, interval->mesh->triangles[of][i], against);
}

/* pair.a contains the edge of the smaller number. */
static bool first_kept_edges(const swept_interval *interval, triangle_pair pair, uint32_t a, uint32_t b) {
    const cscd_mesh *mesh = interval->mesh;
    uint32_t begin_a = mesh->edge_star_offsets[a], end_a = mesh->edge_star_offsets[a + 1];
    uint32_t begin_b = mesh->edge_star_offsets[b], end_b = mesh->edge_star_offsets[b + 1];
    for (uint32_t i = begin_a; i < end_a; i++) {
        for (uint32_t j = begin_b; j < end_b; j++) {
            uint32_t s = mesh->edge_stars[i], t = mesh->edge_stars[j];
            if (culling_keeps(interval->culling, s, t))
                return !interval->culled_pairs && s == pair.a && t == pair.b;
        }
    }
    return interval->culled_pairs && mesh->edge_stars[begin_a] == pair.a &&
           mesh->edge_stars[begin_b] == pair.b;
}

static bool answers_for_edges(const swept_interval *interval, triangle_pair pair, int i, int j) {
    if (interval->culling == NULL)
        return represents_edge(interval->representatives[pair.a], i) &&
               represents_edge(interval->representatives[pair.b], j);
    uint32_t a = interval->mesh->triangle_edges[pair.a][i], b = interval->mesh->triangle_edges[pair.b][j];
    if (a < b) return first_kept_edges(interval, pair, a, b);
    return first_kept_edges(interval, (triangle_pair){pair.b, pair.a}, b, a);
}

/* ---- from a pair of triangles to the queue ----------------------------------------------------------- */

/* Sets of features: bit i of vertices_a is vertex i of pair.a against the face pair.b, and so on; bit 3 i + j
 * of edges is edge i of pair.a against edge j of pair.b. */
typedef struct feature_sets {
    uint32_t vertices_a, vertices_b, edges;
} feature_sets;

/* Branches cost more here than what they would save. */
static feature_sets represented(uint8_t a, uint8_t b) {
    uint32_t edges_a = a >> 3 & 7u, edges_b = b >> 3 & 7u;
    uint32_t each = (edges_a & 1u) | (edges_a & 2u) << 2 | (edges_a & 4u) << 4;
    return (feature_sets){a & 7u, b & 7u, each * edges_b};
}

static __attribute__((noinline)) feature_sets answered_after_culling(const swept_interval *interval,
                                                                     triangle_pair pair) {
    feature_sets sets = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        sets.vertices_a |= (uint32_t)answers_for_vertex(interval, pair.a, i, pair.b) << i;
        sets.vertices_b |= (uint32_t)answers_for_vertex(interval, pair.b, i, pair.a) << i;
        for (int j = 0; j < 3; j++)
            sets.edges |= (uint32_t)answers_for_edges(interval, pair, i, j) << (3 * i + j);
    }
    return sets;
}

static inline feature_sets answered(const swept_interval *interval, triangle_pair pair) {
    if (interval->culling != NULL) return answered_after_culling(interval, pair);
    return represented(interval->representatives[pair.a], interval->representatives[pair.b]);
}

static bool triangles_share_vertex(const uint32_t a[3], const uint32_t b[3]) {
    return triangle_contains(a, b[0]) || triangle_contains(a, b[1]) || triangle_contains(a, b[2]);
}

/* Out of the way of the common case, as is answered_after_culling. */
static __attribute__((noinline)) void leave_out_adjacent(const uint32_t a[3], const uint32_t b[3],
                                                         feature_sets *sets) {
    for (int i = 0; i < 3; i++) {
        if (triangle_contains(b, a[i])) sets->vertices_a &= ~(1u << i);
        if (triangle_contains(a, b[i])) sets->vertices_b &= ~(1u << i);
        for (int j = 0; j < 3; j++) {
            const uint32_t edge_a[2] = {a[i], a[(i + 1) % 3]}, edge_b[2] = {b[j], b[(j + 1) % 3]};
            if (edges_share_vertex(edge_a, edge_b)) sets->edges &= ~(1u << (3 * i + j));
        }
    }
}

/* Counts are kept in registers: in memory each step would wait for the one before. */
static void add_vertices(feature_list *list, uint32_t vertices, const uint32_t of[3], uint32_t against) {
    uint32_t count = list->count;
    for (int i = 0; i < 3; i++) count = feature_list_put(list, count, of[i], against, vertices >> i & 1);
    list->count = count;
}

static void add_edges(feature_list *list, uint32_t edges, const uint32_t a[3], const uint32_t b[3]) {
    uint32_t count = list->count;
    for (int i = 0; i < 9; i++) {
        uint32_t first = a[i / 3], second = b[i % 3];
        count = feature_list_put(list, count, smaller_of(first, second), larger_of(first, second),
                                 edges >> i & 1);
    }
    list->count = count;
}

void narrow_phase_test(const swept_interval *interval, triangle_pair slots, contact_lane *lane) {
    triangle_pair pair = {forest_triangle(interval->forest, slots.a),
                          forest_triangle(interval->forest, slots.b)};
    const uint32_t *a = interval->mesh->triangles[pair.a], *b = interval->mesh->triangles[pair.b];
    feature_queue *queue = &lane->queue;
    bool adjacent = triangles_share_vertex(a, b);
    if (adjacent && interval->skip_adjacent) return;
    feature_sets sets = answered(interval, pair);
    if (adjacent) leave_out_adjacent(a, b, &sets);
    if (feature_list_full(&queue->vf)) feature_queue_decide_vf(interval, lane);
    if (feature_list_full(&queue->ee)) feature_queue_decide_ee(interval, lane);
    uint32_t before = queue->vf.count + queue->ee.count;
    add_vertices(&queue->vf, sets.vertices_a, a, pair.b);
    add_vertices(&queue->vf, sets.vertices_b, b, pair.a);
    if (sets.edges != 0)
        add_edges(&queue->ee, sets.edges, interval->mesh->triangle_edges[pair.a],
                  interval->mesh->triangle_edges[pair.b]);
    lane->feature_pairs += queue->vf.count + queue->ee.count - before;
}
