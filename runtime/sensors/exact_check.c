/* The exact check: the features of two areas, paired by sweep and prune, given to the elementary tests. */
#include "runtime/sensors/exact_check.h"

#include "src/core/sort.h"

#include <string.h>

enum { SIDE_A = 1, SIDE_B = 2, SIDE_BOTH = 3 };

static cscd_status create_list(cscd_context *context, uint32_t count, area_list *list) {
    list->sides = context_allocate(context, count, sizeof *list->sides);
    list->members = context_allocate(context, count, sizeof *list->members);
    return list->sides == NULL || list->members == NULL ? CSCD_OUT_OF_MEMORY : CSCD_OK;
}

cscd_status sensor_areas_create(const cscd_mesh *mesh, sensor_areas *out) {
    cscd_context *context = mesh->context;
    sensor_areas areas = {.mesh = mesh};
    areas.lane = context_allocate(context, 1, sizeof *areas.lane);
    if (areas.lane == NULL || create_list(context, mesh->vertex_count, &areas.vertices) != CSCD_OK ||
        create_list(context, mesh->edge_count, &areas.edges) != CSCD_OK ||
        create_list(context, mesh->triangle_count, &areas.triangles) != CSCD_OK) {
        sensor_areas_destroy(&areas);
        return context_out_of_memory(context);
    }
    *out = areas;
    return CSCD_OK;
}

static void destroy_list(cscd_context *context, area_list *list) {
    context_free(context, list->sides);
    context_free(context, list->members);
}

static void destroy_items(cscd_context *context, area_items *items) {
    context_free(context, items->items);
    context_free(context, items->scratch);
    context_free(context, items->boxes);
}

void sensor_areas_destroy(sensor_areas *areas) {
    if (areas->mesh == NULL) return;
    cscd_context *context = areas->mesh->context;
    destroy_list(context, &areas->vertices);
    destroy_list(context, &areas->edges);
    destroy_list(context, &areas->triangles);
    destroy_items(context, &areas->first);
    destroy_items(context, &areas->second);
    if (areas->lane != NULL) context_free(context, areas->lane->contacts);
    context_free(context, areas->lane);
    *areas = (sensor_areas){0};
}

/* ---- the features of the two sides --------------------------------------------------------------------- */

/* Returns whether the feature was not of this side before. */
static bool add_to_side(area_list *list, uint32_t feature, uint8_t side) {
    if ((list->sides[feature] & side) != 0) return false;
    if (list->sides[feature] == 0) list->members[list->count++] = feature;
    list->sides[feature] |= side;
    return true;
}

static void add_cell(sensor_areas *areas, const cscd_partition *partition, uint32_t cell, uint8_t side) {
    const cscd_mesh *mesh = areas->mesh;
    for (uint32_t i = partition->cell_offsets[cell]; i < partition->cell_offsets[cell + 1]; i++) {
        uint32_t vertex = partition->cell_vertices[i];
        for (uint32_t s = mesh->vertex_star_offsets[vertex]; s < mesh->vertex_star_offsets[vertex + 1]; s++) {
            uint32_t triangle = mesh->vertex_stars[s];
            if (!add_to_side(&areas->triangles, triangle, side)) continue;
            for (int k = 0; k < 3; k++) {
                add_to_side(&areas->vertices, mesh->triangles[triangle][k], side);
                add_to_side(&areas->edges, mesh->triangle_edges[triangle][k], side);
            }
        }
    }
}

static void forget(area_list *list) {
    for (uint32_t i = 0; i < list->count; i++) list->sides[list->members[i]] = 0;
    list->count = 0;
}

/* Where both sides reach: whatever touches does so there. Empty when low is beyond high. Boxes of linear
 * motions are exact, as rounding plays no part in a minimum. */
static swept_box common_region(const sensor_areas *areas, const swept_interval *interval) {
    swept_box sides[2] = {swept_box_of(interval, NULL, 0), swept_box_of(interval, NULL, 0)};
    const area_list *vertices = &areas->vertices;
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

/* What one sweep is about. */
typedef struct sweep {
    const swept_interval *interval;
    const swept_box *region;
    int axis;
    uint64_t tests;
} sweep;

/* Unsigned, in the order of the doubles. */
static uint64_t key_of(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits >> 63 != 0 ? ~bits : bits | (uint64_t)1 << 63;
}

static cscd_status reserve(cscd_context *context, area_items *items, uint32_t count) {
    if (count <= items->capacity) return CSCD_OK;
    size_t capacity = (size_t)count + count / 2;
    if (capacity > UINT32_MAX) capacity = UINT32_MAX;
    destroy_items(context, items);
    *items = (area_items){
        .items = context_allocate(context, capacity, sizeof *items->items),
        .scratch = context_allocate(context, capacity, sizeof *items->scratch),
        .boxes = context_allocate(context, capacity, sizeof *items->boxes),
    };
    if (items->items == NULL || items->scratch == NULL || items->boxes == NULL)
        return context_out_of_memory(context);
    items->capacity = (uint32_t)capacity;
    return CSCD_OK;
}

/* The corners of a feature: 1 for a vertex, 2 for an edge, 3 for a triangle. */
static const uint32_t *corners_of(const cscd_mesh *mesh, const uint32_t *feature, int corner_count) {
    if (corner_count == 1) return feature;
    return corner_count == 2 ? mesh->edges[*feature] : mesh->triangles[*feature];
}

static cscd_status gather(const sweep *s, const area_list *list, uint8_t side, int corner_count,
                          area_items *out) {
    const cscd_mesh *mesh = s->interval->mesh;
    cscd_status status = reserve(mesh->context, out, list->count);
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
typedef bool pair_test(sensor_areas *areas, const swept_interval *interval, uint32_t a, uint32_t b);

static bool of_both(const area_list *list, uint32_t feature) {
    return list->sides[feature] == SIDE_BOTH;
}

static bool test_vertex_face(sensor_areas *areas, const swept_interval *interval, uint32_t vertex,
                             uint32_t triangle) {
    if (triangle_contains(areas->mesh->triangles[triangle], vertex)) return false;
    narrow_phase_test_vf(interval, vertex, triangle, areas->lane);
    return true;
}

/* The sweep with the vertices of the other side comes second, and leaves out what both sweeps meet. */
static bool test_vertex_face_once(sensor_areas *areas, const swept_interval *interval, uint32_t vertex,
                                  uint32_t triangle) {
    if (of_both(&areas->vertices, vertex) && of_both(&areas->triangles, triangle)) return false;
    return test_vertex_face(areas, interval, vertex, triangle);
}

/* Two edges of both sides are met twice. */
static bool test_edges(sensor_areas *areas, const swept_interval *interval, uint32_t a, uint32_t b) {
    if (edges_share_vertex(areas->mesh->edges[a], areas->mesh->edges[b])) return false;
    if (a > b && of_both(&areas->edges, a) && of_both(&areas->edges, b)) return false;
    narrow_phase_test_ee(interval, a, b, areas->lane);
    return true;
}

/* All items of `others` from `next` on that begin before the pivot's end. */
static void test_pivot(sensor_areas *areas, sweep *s, const area_items *pivots, uint32_t pivot,
                       const area_items *others, uint32_t next, bool swapped, pair_test *test) {
    const swept_box *box = &pivots->boxes[pivots->items[pivot].box];
    uint32_t feature = pivots->items[pivot].feature;
    for (; next < others->count; next++) {
        const swept_box *other = &others->boxes[others->items[next].box];
        if (other->low[s->axis] > box->high[s->axis]) break;
        if (!swept_boxes_within(box, other, 0.0)) continue;
        uint32_t partner = others->items[next].feature;
        bool tested =
            swapped ? test(areas, s->interval, partner, feature) : test(areas, s->interval, feature, partner);
        s->tests += tested;
    }
}

/* Whichever of two boxes begins first is the pivot that meets the other one. */
static void sweep_items(sensor_areas *areas, sweep *s, pair_test *test) {
    const area_items *first = &areas->first, *second = &areas->second;
    uint32_t i = 0, j = 0;
    while (i < first->count && j < second->count && !areas->lane->out_of_memory) {
        if (first->items[i].key <= second->items[j].key) {
            test_pivot(areas, s, first, i, second, j, false, test);
            i++;
        } else {
            test_pivot(areas, s, second, j, first, i, true, test);
            j++;
        }
    }
}

static cscd_status sweep_pairs(sensor_areas *areas, sweep *s, uint8_t side, const area_list *firsts,
                               const area_list *seconds, pair_test *test) {
    bool edges = firsts == seconds;
    cscd_status status = gather(s, firsts, side, edges ? 2 : 1, &areas->first);
    if (status == CSCD_OK) status = gather(s, seconds, SIDE_BOTH - side, edges ? 2 : 3, &areas->second);
    if (status == CSCD_OK) sweep_items(areas, s, test);
    return status;
}

static cscd_status test_all(sensor_areas *areas, sweep *s) {
    const area_list *vertices = &areas->vertices, *edges = &areas->edges, *triangles = &areas->triangles;
    cscd_status status = sweep_pairs(areas, s, SIDE_A, vertices, triangles, test_vertex_face);
    if (status == CSCD_OK) status = sweep_pairs(areas, s, SIDE_B, vertices, triangles, test_vertex_face_once);
    if (status == CSCD_OK) status = sweep_pairs(areas, s, SIDE_A, edges, edges, test_edges);
    if (status != CSCD_OK) return status;
    narrow_phase_finish(s->interval, areas->lane);
    return areas->lane->out_of_memory ? context_out_of_memory(areas->mesh->context) : CSCD_OK;
}

/* ---- the check ----------------------------------------------------------------------------------------- */

static area_verdict verdict_of(const contact_lane *lane, uint64_t tests) {
    area_verdict verdict = {.contact = lane->count > 0, .tests = tests};
    for (size_t i = 0; i < lane->count; i++) {
        double toi = lane->contacts[i].toi;
        if (i == 0 || toi < verdict.toi) verdict.toi = toi;
    }
    return verdict;
}

cscd_status sensor_areas_check(sensor_areas *areas, const cscd_partition *partition, const area_query *query,
                               area_verdict *out) {
    swept_interval interval = {.mesh = areas->mesh, .x0 = query->start, .x1 = query->end};
    cscd_status status = CSCD_OK;
    contact_lane_reset(areas->lane);
    for (uint32_t i = 0; i < query->count_a; i++) add_cell(areas, partition, query->cells_a[i], SIDE_A);
    for (uint32_t i = 0; i < query->count_b; i++) add_cell(areas, partition, query->cells_b[i], SIDE_B);
    swept_box region = common_region(areas, &interval);
    sweep s = {.interval = &interval, .region = &region, .axis = longest_axis(&region)};
    bool meet =
        region.low[0] <= region.high[0] && region.low[1] <= region.high[1] && region.low[2] <= region.high[2];
    if (meet) status = test_all(areas, &s);
    forget(&areas->vertices);
    forget(&areas->edges);
    forget(&areas->triangles);
    if (status == CSCD_OK) *out = verdict_of(areas->lane, s.tests);
    return status;
}
