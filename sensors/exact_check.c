/* The exact check: pairs the features of two areas by sweep and prune, and gives them to the elementary
 * tests. */
#include "sensors/exact_check.h"

#include "src/core/sort.h"

#include <string.h>

enum { SIDE_A = 1, SIDE_B = 2, SIDE_BOTH = 3 };

static array_list list_arrays(exact_check *check) {
    const cscd_mesh *mesh = check->mesh;
    area_list *vertices = &check->vertices, *edges = &check->edges, *triangles = &check->triangles;
    return (array_list){{ARRAY(check->worker, 1), ARRAY(vertices->sides, mesh->vertex_count),
                         ARRAY(vertices->members, mesh->vertex_count), ARRAY(edges->sides, mesh->edge_count),
                         ARRAY(edges->members, mesh->edge_count),
                         ARRAY(triangles->sides, mesh->triangle_count),
                         ARRAY(triangles->members, mesh->triangle_count)}};
}

static array_list list_item_arrays(area_items *items, size_t capacity) {
    return (array_list){
        {ARRAY(items->items, capacity), ARRAY(items->scratch, capacity), ARRAY(items->boxes, capacity)}};
}

cscd_status exact_check_create(const cscd_mesh *mesh, exact_check *out) {
    exact_check check = {.mesh = mesh};
    if (!context_allocate_all(mesh->context, list_arrays(&check)))
        return context_out_of_memory(mesh->context);
    *out = check;
    return CSCD_OK;
}

void exact_check_destroy(exact_check *check) {
    if (check->mesh == NULL) return;
    cscd_context *context = check->mesh->context;
    context_free_all(context, list_item_arrays(&check->first, 0));
    context_free_all(context, list_item_arrays(&check->second, 0));
    if (check->worker != NULL) contact_worker_free(context, check->worker);
    context_free_all(context, list_arrays(check));
    *check = (exact_check){0};
}

/* ---- the features of the two sides --------------------------------------------------------------------- */

/* Returns whether the feature is new on this side. */
static bool add_to_side(area_list *list, uint32_t feature, uint8_t side) {
    if ((list->sides[feature] & side) != 0) return false;
    if (list->sides[feature] == 0) list->members[list->count++] = feature;
    list->sides[feature] |= side;
    return true;
}

static void add_cell(exact_check *check, const sensor_partition *partition, uint32_t cell, uint8_t side) {
    const cscd_mesh *mesh = check->mesh;
    for (uint32_t i = partition->cell_offsets[cell]; i < partition->cell_offsets[cell + 1]; i++) {
        uint32_t vertex = partition->cell_vertices[i];
        for (uint32_t s = mesh->vertex_star_offsets[vertex]; s < mesh->vertex_star_offsets[vertex + 1]; s++) {
            uint32_t triangle = mesh->vertex_stars[s];
            if (!add_to_side(&check->triangles, triangle, side)) continue;
            for (int k = 0; k < 3; k++) {
                add_to_side(&check->vertices, mesh->triangles[triangle][k], side);
                add_to_side(&check->edges, mesh->triangle_edges[triangle][k], side);
            }
        }
    }
}

static void clear_sides(area_list *list) {
    for (uint32_t i = 0; i < list->count; i++) list->sides[list->members[i]] = 0;
    list->count = 0;
}

/* The box that both sides reach, in which all their contacts lie; it is empty when low is beyond high. Boxes
 * of linear motions are exact, since a minimum is not rounded. */
static swept_box common_region(const exact_check *check, const swept_interval *interval) {
    swept_box sides[2] = {swept_box_of(interval, NULL, 0), swept_box_of(interval, NULL, 0)};
    const area_list *vertices = &check->vertices;
    for (uint32_t i = 0; i < vertices->count; i++) {
        uint32_t vertex = vertices->members[i];
        if ((vertices->sides[vertex] & SIDE_A) != 0) swept_box_add(interval, vertex, &sides[0]);
        if ((vertices->sides[vertex] & SIDE_B) != 0) swept_box_add(interval, vertex, &sides[1]);
    }
    swept_box region;
    for (int k = 0; k < 3; k++) {
        region.low[k] = sides[0].low[k] > sides[1].low[k] ? sides[0].low[k] : sides[1].low[k];
        region.high[k] = sides[0].high[k] < sides[1].high[k] ? sides[0].high[k] : sides[1].high[k];
    }
    return region;
}

static int longest_axis(const swept_box *region) {
    int longest = 0;
    for (int k = 1; k < 3; k++) {
        if (region->high[k] - region->low[k] > region->high[longest] - region->low[longest]) longest = k;
    }
    return longest;
}

/* ---- sweep and prune ----------------------------------------------------------------------------------- */

/* One sweep along an axis. */
typedef struct sweep {
    const swept_interval *interval;
    const swept_box *region;
    int axis;
    uint64_t tests;
} sweep;

/* Maps doubles to unsigned integers of the same order. */
static uint64_t key_of(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits >> 63 != 0 ? ~bits : bits | (uint64_t)1 << 63;
}

static cscd_status reserve_items(cscd_context *context, area_items *items, uint32_t count) {
    if (count <= items->capacity) return CSCD_OK;
    size_t capacity = (size_t)count + count / 2;
    if (capacity > UINT32_MAX) capacity = UINT32_MAX;
    context_free_all(context, list_item_arrays(items, 0));
    items->capacity = 0;
    if (!context_allocate_all(context, list_item_arrays(items, capacity)))
        return context_out_of_memory(context);
    items->capacity = (uint32_t)capacity;
    return CSCD_OK;
}

/* The corners of a feature: 1 for a vertex, 2 for an edge, 3 for a triangle. */
static const uint32_t *corners_of(const cscd_mesh *mesh, const uint32_t *feature, int corner_count) {
    if (corner_count == 1) return feature;
    return corner_count == 2 ? mesh->edges[*feature] : mesh->triangles[*feature];
}

static cscd_status gather_items(const sweep *s, const area_list *list, uint8_t side, int corner_count,
                                area_items *out) {
    const cscd_mesh *mesh = s->interval->mesh;
    cscd_status status = reserve_items(mesh->context, out, list->count);
    if (status != CSCD_OK) return status;
    out->count = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        uint32_t feature = list->members[i];
        if ((list->sides[feature] & side) == 0) continue;
        swept_box box = swept_box_of(s->interval, corners_of(mesh, &feature, corner_count), corner_count);
        if (!swept_boxes_within(&box, s->region, 0.0)) continue;
        out->boxes[out->count] = box;
        out->items[out->count] = (area_item){key_of(box.low[s->axis]), feature, out->count};
        out->count++;
    }
    sort_by_number(out->items, out->scratch, out->count, sizeof *out->items);
    return CSCD_OK;
}

/* Tests a pair unless it shares a vertex; returns whether it was tested. */
typedef bool pair_test(exact_check *check, const swept_interval *interval, uint32_t a, uint32_t b);

static bool on_both_sides(const area_list *list, uint32_t feature) {
    return list->sides[feature] == SIDE_BOTH;
}

static bool test_vertex_face(exact_check *check, const swept_interval *interval, uint32_t vertex,
                             uint32_t triangle) {
    if (triangle_contains(check->mesh->triangles[triangle], vertex)) return false;
    narrow_phase_test_vf(interval, vertex, triangle, check->worker);
    return true;
}

/* The second sweep, with the vertices of the other side, leaves out the pairs that both sweeps find. */
static bool test_vertex_face_once(exact_check *check, const swept_interval *interval, uint32_t vertex,
                                  uint32_t triangle) {
    if (on_both_sides(&check->vertices, vertex) && on_both_sides(&check->triangles, triangle)) return false;
    return test_vertex_face(check, interval, vertex, triangle);
}

/* A pair of edges that both lie on both sides is found twice; the second time it is left out. */
static bool test_edges(exact_check *check, const swept_interval *interval, uint32_t a, uint32_t b) {
    if (edges_share_vertex(check->mesh->edges[a], check->mesh->edges[b])) return false;
    if (a > b && on_both_sides(&check->edges, a) && on_both_sides(&check->edges, b)) return false;
    narrow_phase_test_ee(interval, a, b, check->worker);
    return true;
}

/* Tests the pivot with all items of `others` from `next` on that begin before its end. */
static void test_pivot(exact_check *check, sweep *s, const area_items *pivots, uint32_t pivot,
                       const area_items *others, uint32_t next, bool swapped, pair_test *test) {
    const swept_box *box = &pivots->boxes[pivots->items[pivot].box];
    uint32_t feature = pivots->items[pivot].feature;
    for (; next < others->count; next++) {
        const swept_box *other = &others->boxes[others->items[next].box];
        if (other->low[s->axis] > box->high[s->axis]) break;
        if (!swept_boxes_within(box, other, 0.0)) continue;
        uint32_t partner = others->items[next].feature;
        bool tested =
            swapped ? test(check, s->interval, partner, feature) : test(check, s->interval, feature, partner);
        s->tests += tested;
    }
}

/* The pivot of two boxes that overlap is the one that begins first. */
static void sweep_items(exact_check *check, sweep *s, pair_test *test) {
    const area_items *first = &check->first, *second = &check->second;
    uint32_t i = 0, j = 0;
    while (i < first->count && j < second->count && !check->worker->out_of_memory) {
        if (first->items[i].key <= second->items[j].key) {
            test_pivot(check, s, first, i, second, j, false, test);
            i++;
        } else {
            test_pivot(check, s, second, j, first, i, true, test);
            j++;
        }
    }
}

static cscd_status sweep_pairs(exact_check *check, sweep *s, uint8_t side, const area_list *firsts,
                               const area_list *seconds, pair_test *test) {
    bool edges = firsts == seconds;
    cscd_status status = gather_items(s, firsts, side, edges ? 2 : 1, &check->first);
    if (status == CSCD_OK) status = gather_items(s, seconds, SIDE_BOTH - side, edges ? 2 : 3, &check->second);
    if (status == CSCD_OK) sweep_items(check, s, test);
    return status;
}

static cscd_status test_all(exact_check *check, sweep *s) {
    const area_list *vertices = &check->vertices, *edges = &check->edges, *triangles = &check->triangles;
    cscd_status status = sweep_pairs(check, s, SIDE_A, vertices, triangles, test_vertex_face);
    if (status == CSCD_OK) status = sweep_pairs(check, s, SIDE_B, vertices, triangles, test_vertex_face_once);
    if (status == CSCD_OK) status = sweep_pairs(check, s, SIDE_A, edges, edges, test_edges);
    if (status != CSCD_OK) return status;
    narrow_phase_finish(s->interval, check->worker);
    return check->worker->out_of_memory ? context_out_of_memory(check->mesh->context) : CSCD_OK;
}

/* ---- the check ----------------------------------------------------------------------------------------- */

static area_verdict verdict_of(const contact_worker *worker, uint64_t tests) {
    area_verdict verdict = {.contact = worker->count > 0, .tests = tests};
    for (size_t i = 0; i < worker->count; i++) {
        double toi = contact_worker_at(worker, i)->toi;
        if (i == 0 || toi < verdict.toi) verdict.toi = toi;
    }
    return verdict;
}

cscd_status exact_check_run(exact_check *check, const sensor_partition *partition, const area_query *query,
                            area_verdict *out) {
    swept_interval interval = {.mesh = check->mesh, .x0 = query->start, .x1 = query->end};
    cscd_status status = CSCD_OK;
    contact_worker_reset(check->worker);
    for (uint32_t i = 0; i < query->count_a; i++) add_cell(check, partition, query->cells_a[i], SIDE_A);
    for (uint32_t i = 0; i < query->count_b; i++) add_cell(check, partition, query->cells_b[i], SIDE_B);
    swept_box region = common_region(check, &interval);
    sweep s = {.interval = &interval, .region = &region, .axis = longest_axis(&region)};
    bool overlap =
        region.low[0] <= region.high[0] && region.low[1] <= region.high[1] && region.low[2] <= region.high[2];
    if (overlap) status = test_all(check, &s);
    clear_sides(&check->vertices);
    clear_sides(&check->edges);
    clear_sides(&check->triangles);
    if (status == CSCD_OK) *out = verdict_of(check->worker, s.tests);
    return status;
}
