/* Is the surface embedded at one moment? All meeting triangle pairs, by exact predicates. */
#include "runtime/intersections/static_check.h"

#include "runtime/bvh/bvh_rebuild.h"
#include "runtime/detector/detector.h"
#include "runtime/intersections/intersection_kernels.h"
#include "src/core/sort.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"
#include "src/mesh/predicates.h"
#include "src/mesh/triangle_intersection.h"

#include <string.h>

/* One check: what its lanes share. */
typedef struct moment {
    cscd_detector *detector;
    const double *positions;
    traversal_pass pass; /* KEPT: every pair; SUSPECTS: those of the detector's suspects within a component */
} moment;

static void add_intersection(cscd_context *context, intersection_lane *lane, uint32_t a, uint32_t b) {
    if (lane->count == lane->capacity) {
        size_t capacity = lane->capacity == 0 ? 256 : lane->capacity * 2;
        cscd_intersection *grown =
            context_grow(context, lane->items, lane->count, capacity, sizeof *lane->items);
        if (grown == NULL) {
            lane->out_of_memory = true;
            return;
        }
        lane->items = grown;
        lane->capacity = capacity;
    }
    lane->items[lane->count++] = a < b ? (cscd_intersection){a, b} : (cscd_intersection){b, a};
}

/* The batch, which is consumed, becomes one of triangles, those of different components left out where these
 * do not count. */
static void name_triangles(const moment *now, traversal_lane *batch) {
    const bvh *f = &now->detector->bvh;
    const uint32_t *components = now->detector->mesh->triangle_components;
    bool within = now->pass == TRAVERSAL_SUSPECTS;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < batch->pair_count; i++) {
        triangle_pair pair = {bvh_triangle(f, batch->pairs[i].a), bvh_triangle(f, batch->pairs[i].b)};
        batch->pairs[kept] = pair;
        kept += !within || components[pair.a] == components[pair.b];
    }
    batch->pair_count = kept;
}

static void test_batch(void *data, uint32_t index) {
    const moment *now = data;
    cscd_detector *d = now->detector;
    traversal_lane *batch = &d->traversal.lanes[index];
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])d->mesh->triangles;
    name_triangles(now, batch);
    uint32_t open = intersection_kernels_of(d->context)
                        ->reject_disjoint(triangles, now->positions, batch->pairs, batch->pair_count);
    for (uint32_t i = 0; i < open; i++) {
        triangle_pair pair = batch->pairs[i];
        if (triangles_intersect(triangles[pair.a], triangles[pair.b], now->positions))
            add_intersection(d->context, &d->intersection_lanes[index], pair.a, pair.b);
    }
}

static bool has_no_area(const moment *now, uint32_t triangle) {
    const double *corners[3];
    for (int i = 0; i < 3; i++)
        corners[i] = now->positions + (size_t)now->detector->mesh->triangles[triangle][i] * 3;
    return collinear(corners[0], corners[1], corners[2]);
}

enum { AREA_BATCH = 512 };

/* Of the suspects among triangles begin to end - 1, at most AREA_BATCH. */
static void mark_zero_area(const moment *now, intersection_lane *lane, uint32_t begin, uint32_t end) {
    cscd_detector *d = now->detector;
    uint32_t list[AREA_BATCH], count = 0;
    for (uint32_t t = begin; t < end; t++) {
        list[count] = t;
        count += d->suspects[t];
    }
    memset(d->crossing + begin, false, (end - begin) * sizeof *d->crossing);
    count = intersection_kernels_of(d->context)
                ->reject_with_area((const uint32_t(*)[3])d->mesh->triangles, now->positions, list, count);
    for (uint32_t i = 0; i < count; i++) {
        if (!has_no_area(now, list[i])) continue;
        d->crossing[list[i]] = true;
        if (lane->zero_area_triangles++ == 0) lane->first_zero_area = list[i];
    }
}

/* Of a lane's share of the triangles. */
static void count_zero_area(void *data, uint32_t index) {
    const moment *now = data;
    cscd_detector *d = now->detector;
    intersection_lane *lane = &d->intersection_lanes[index];
    uint64_t count = d->mesh->triangle_count, lanes = d->traversal.lane_count;
    uint32_t begin = (uint32_t)(count * index / lanes), end = (uint32_t)(count * (index + 1) / lanes);
    *lane = (intersection_lane){lane->items, 0, lane->capacity, 0, UINT32_MAX, false};
    for (uint32_t t = begin; t < end; t += AREA_BATCH)
        mark_zero_area(now, lane, t, end - t < AREA_BATCH ? end : t + AREA_BATCH);
}

/* By a, then by b: in place as numbers, and back. */
static void sort_intersections(cscd_intersection *items, void *scratch, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint64_t number = (uint64_t)items[i].a << 32 | items[i].b;
        memcpy(&items[i], &number, sizeof number);
    }
    sort_by_number(items, scratch, count, sizeof *items);
    for (size_t i = 0; i < count; i++) {
        uint64_t number;
        memcpy(&number, &items[i], sizeof number);
        items[i] = (cscd_intersection){(uint32_t)(number >> 32), (uint32_t)number};
    }
}

static bool left_out(const exclusions *e, cscd_intersection pair, const double *positions) {
    return exclusions_any(e) && exclusions_cover_triangles(e, pair.a, pair.b, positions);
}

/* Joins the lanes' lists, leaves out what is to be ignored, sorts. */
static cscd_status collect(cscd_detector *d, const double *positions, cscd_intersections *out) {
    size_t found = 0, kept = 0;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) found += d->intersection_lanes[i].count;
    cscd_status status =
        result_buffer_reserve(d->context, &d->intersections, found, sizeof(cscd_intersection));
    if (status != CSCD_OK) return status;

    cscd_intersection *items = d->intersections.items;
    cscd_intersections result = {items, 0, 0, UINT32_MAX};
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        const intersection_lane *lane = &d->intersection_lanes[i];
        for (size_t j = 0; j < lane->count; j++) {
            if (!left_out(&d->exclusions, lane->items[j], positions)) items[kept++] = lane->items[j];
        }
        result.zero_area_triangles += lane->zero_area_triangles;
        if (lane->first_zero_area < result.first_zero_area) result.first_zero_area = lane->first_zero_area;
    }
    sort_intersections(items, d->intersections.scratch, kept);
    result.count = kept;
    *out = result;
    return CSCD_OK;
}

static cscd_status find_intersections(moment *now) {
    cscd_detector *d = now->detector;
    parallel_run(d->context->threads, d->traversal.lane_count, count_zero_area, now);
    bvh_skip_adjacent(&d->bvh, NULL);
    traversal_begin(&d->traversal, &d->bvh, now->pass);
    for (bool more = true; more;) {
        if (!progress_go_on(&d->context->progress, traversal_done(&d->traversal))) break;
        cscd_status status = traversal_round(&d->traversal, &more);
        if (status != CSCD_OK) return status;
        parallel_run(d->context->threads, d->traversal.lane_count, test_batch, now);
        for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
            if (d->intersection_lanes[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
        }
    }
    return context_progress_status(d->context); /* before anybody believes that nothing more was found */
}

/* What the lanes hold, ignored pairs among it, is what triangles are judged by. */
static void record_starts(const moment *now) {
    cscd_detector *d = now->detector;
    const uint32_t *components = d->mesh->triangle_components;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        const intersection_lane *lane = &d->intersection_lanes[i];
        for (size_t j = 0; j < lane->count; j++) {
            cscd_intersection pair = lane->items[j];
            if (components[pair.a] == components[pair.b]) d->crossing[pair.a] = d->crossing[pair.b] = true;
        }
    }
    start_states_checked(&d->starts, d->suspects, d->crossing);
}

cscd_status static_check_suspects(cscd_detector *detector, const double *positions) {
    moment now = {detector, positions, TRAVERSAL_SUSPECTS};
    progress_stage(&detector->context->progress, "start", 0.0, 0.3);
    bvh_mark_suspects(&detector->bvh, detector->suspects);
    cscd_status status = find_intersections(&now);
    if (status == CSCD_OK) record_starts(&now);
    return status;
}

/* Nothing is recorded before nothing can fail any more: states and the positions that they are of go
 * together.
 */
static cscd_status check_moment(moment *now, cscd_intersections *out) {
    cscd_detector *d = now->detector;
    cscd_status status = upkeep_move_to(d, now->positions, 0.0);
    if (status != CSCD_OK) return status;
    memset(d->suspects, true, d->mesh->triangle_count * sizeof *d->suspects);
    status = find_intersections(now);
    if (status == CSCD_OK) status = collect(d, now->positions, out);
    if (status != CSCD_OK) return status;
    if (!start_states_hold(&d->starts, now->positions)) start_states_begin(&d->starts, now->positions);
    record_starts(now);
    return CSCD_OK;
}

cscd_status cscd_detector_check(cscd_detector *detector, const double *positions, cscd_intersections *out) {
    if (detector == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = detector->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_check: out is NULL");
    double since = timer_now_ms(), spent = 0.0;
    cscd_status status = positions_check(context, positions, detector->mesh->vertex_count, "positions");
    if (status != CSCD_OK) return status;

    moment now = {detector, positions, TRAVERSAL_KEPT};
    cscd_intersections result;
    call_begin(detector);
    progress_stage(&context->progress, "static check", 0.0, 1.0);
    status = check_moment(&now, &result);
    if (status != CSCD_OK) return call_fail(detector, status);
    timer_lap(&since, &spent);
    detector->timings.check_ms = spent;
    *out = result;
    return CSCD_OK;
}
