/* Finds all pairs of triangles that intersect at one moment, by exact predicates. */
#include "runtime/intersections/static_check.h"

#include "runtime/intersections/intersection_kernels.h"
#include "runtime/intersections/pair_kind.h"
#include "src/mesh/predicates.h"
#include "src/mesh/triangle_intersection.h"

#include <assert.h>
#include <string.h>

static array_list list_arrays(static_check *c) {
    return (array_list){{ARRAY(c->unproven, c->mesh->triangle_count),
                         ARRAY(c->crossing, c->mesh->triangle_count), ARRAY(c->lanes, c->lane_count)}};
}

cscd_status static_check_create(const cscd_mesh *mesh, uint32_t lane_count, static_check *out) {
    static_check c = {.mesh = mesh, .lane_count = lane_count, .limit = SIZE_MAX};
    if (!context_allocate_all(mesh->context, list_arrays(&c))) return CSCD_OUT_OF_MEMORY;
    *out = c;
    return CSCD_OK;
}

void static_check_destroy(static_check *c) {
    if (c->mesh == NULL) return;
    cscd_context *context = c->mesh->context;
    for (uint32_t i = 0; i < c->lane_count; i++) {
        context_free(context, c->lanes[i].items);
        context_free(context, c->lanes[i].notes);
    }
    context_free_all(context, list_arrays(c));
    *c = (static_check){0};
}

/* ---- one check ------------------------------------------------------------------------------------------ */

static const uint32_t (*triangles_of(const check_work *work))[3] {
    return (const uint32_t(*)[3])work->check->mesh->triangles;
}

enum { ROOM_LEAST = 256, EVEN_ROOM_MOST = 1 << 16 };

static bool grow_items(cscd_context *context, intersection_lane *lane, size_t capacity) {
    found_pair *grown = context_grow(context, lane->items, lane->count, capacity, sizeof *lane->items);
    if (grown == NULL) return false;
    lane->items = grown;
    lane->capacity = capacity;
    return true;
}

static bool make_room(cscd_context *context, intersection_lane *lane) {
    return grow_items(context, lane, lane->capacity == 0 ? ROOM_LEAST : 2 * lane->capacity);
}

static bool make_room_for_notes(cscd_context *context, intersection_lane *lane) {
    pair_note *grown = context_grow(context, lane->notes, lane->count, lane->capacity, sizeof *lane->notes);
    if (grown == NULL) return false;
    lane->notes = grown;
    lane->note_capacity = lane->capacity;
    return true;
}

static void add_pair(cscd_context *context, intersection_lane *lane, triangle_pair t) {
    if (lane->count == lane->capacity && !make_room(context, lane))
        lane->out_of_memory = true;
    else
        lane->items[lane->count++] = (found_pair){t.a < t.b ? t.a : t.b, t.a < t.b ? t.b : t.a};
}

static void add_noted_pair(cscd_context *context, intersection_lane *lane, triangle_pair t, pair_note note) {
    bool room = lane->count < lane->capacity || make_room(context, lane);
    if (room && lane->note_capacity < lane->capacity) room = make_room_for_notes(context, lane);
    if (room) lane->notes[lane->count] = note;
    if (room)
        add_pair(context, lane, t);
    else
        lane->out_of_memory = true;
}

/* Which lane finds what depends on when threads come for work, so that a lane might need more room in any call. Once a call
 * has found its pairs, each lane has room for all of them or, if they are very many, for as many as any lane. */
static bool even_out_room(static_check *c) {
    size_t total = 0, room = ROOM_LEAST;
    for (uint32_t i = 0; i < c->lane_count; i++) total += c->lanes[i].count;
    for (uint32_t i = 0; i < c->lane_count && total > EVEN_ROOM_MOST; i++)
        room = c->lanes[i].capacity > room ? c->lanes[i].capacity : room;
    while (room < total && total <= EVEN_ROOM_MOST) room *= 2;
    for (uint32_t i = 0; i < c->lane_count && total > 0; i++) {
        intersection_lane *lane = &c->lanes[i];
        if (lane->capacity < room && !grow_items(c->mesh->context, lane, room)) return false;
        if (c->kinds && lane->note_capacity < lane->capacity && !make_room_for_notes(c->mesh->context, lane))
            return false;
    }
    return true;
}

static bool same_triangle(const uint32_t a[3], const uint32_t b[3]) {
    return triangle_contains(a, b[0]) && triangle_contains(a, b[1]) && triangle_contains(a, b[2]);
}

static void test_kind(const check_work *work, intersection_lane *lane, triangle_pair t) {
    const uint32_t(*triangles)[3] = triangles_of(work);
    const uint32_t *a = triangles[t.a], *b = triangles[t.b];
    pair_kind found;
    if (!pair_kind_find(a, b, work->names, work->positions, &found)) return;
    const pair_note note = {(uint8_t)found.kind, (uint8_t)found.shared,
                            found.kind == CSCD_INTERSECTION_DUPLICATE && same_triangle(a, b)};
    add_noted_pair(work->check->mesh->context, lane, t, note);
}

static bool pair_counts(const check_work *work, uint32_t a, uint32_t b) {
    const static_check *c = work->check;
    if (work->own_component_only && a != b) return false;
    if (c->objects == NULL || !work->bvh->trees_mix_objects) return true;
    return object_sets_may_meet(&c->objects[c->component_objects[a]], &c->objects[c->component_objects[b]]);
}

/* Replaces the slots of a batch by triangles, and drops the pairs that do not count. */
static void name_triangles(const check_work *work, traversal_lane *batch) {
    const uint32_t *components = work->check->mesh->triangle_components;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < batch->pair_count; i++) {
        triangle_pair slots = batch->pairs[i];
        triangle_pair pair = {bvh_triangle(work->bvh, slots.a), bvh_triangle(work->bvh, slots.b)};
        batch->pairs[kept] = pair;
        kept += pair_counts(work, components[pair.a], components[pair.b]);
    }
    batch->pair_count = kept;
}

void static_check_test_batch(const check_work *work, uint32_t index) {
    cscd_context *context = work->check->mesh->context;
    traversal_lane *batch = &work->traversal->lanes[index];
    intersection_lane *lane = &work->check->lanes[index];
    const uint32_t(*triangles)[3] = triangles_of(work);
    bool kinds = work->check->kinds;
    name_triangles(work, batch);
    uint32_t undecided = intersection_kernels_of(context)->reject_disjoint(
        triangles, work->positions, batch->pairs, batch->pair_count, kinds);
    for (uint32_t i = 0; i < undecided; i++) {
        triangle_pair t = batch->pairs[i];
        if (kinds)
            test_kind(work, lane, t);
        else if (triangles_intersect(triangles[t.a], triangles[t.b], work->positions))
            add_pair(context, lane, t);
    }
}

static void test_batch(void *data, uint32_t index) {
    static_check_test_batch(data, index);
}

/* ---- triangles without area ----------------------------------------------------------------------------- */

static bool has_no_area(const check_work *work, uint32_t triangle) {
    const double *corners[3];
    for (int i = 0; i < 3; i++)
        corners[i] = work->positions + (size_t)work->check->mesh->triangles[triangle][i] * 3;
    return collinear(corners[0], corners[1], corners[2]);
}

enum { AREA_BATCH = 512 };

/* Marks those of the unproven triangles begin to end - 1, at most AREA_BATCH, that have no area. */
static void mark_zero_area(const check_work *work, intersection_lane *lane, uint32_t begin, uint32_t end) {
    const static_check *check = work->check;
    uint32_t list[AREA_BATCH], count = 0;
    assert(end - begin <= AREA_BATCH);
    for (uint32_t t = begin; t < end; t++) {
        list[count] = t;
        count += check->unproven[t];
    }
    memset(check->crossing + begin, false, (end - begin) * sizeof *check->crossing);
    count = intersection_kernels_of(check->mesh->context)
                ->reject_with_area(triangles_of(work), work->positions, list, count);
    for (uint32_t i = 0; i < count; i++) {
        if (!has_no_area(work, list[i])) continue;
        check->crossing[list[i]] = true;
        if (lane->zero_area_triangles++ == 0) lane->first_zero_area = list[i];
    }
}

/* Empties a lane, and looks for triangles without area in its share of the mesh. */
static void count_zero_area(void *data, uint32_t index) {
    const check_work *work = data;
    const static_check *check = work->check;
    intersection_lane *lane = &check->lanes[index];
    uint64_t count = check->mesh->triangle_count, lanes = check->lane_count;
    uint32_t begin = (uint32_t)(count * index / lanes), end = (uint32_t)(count * (index + 1) / lanes);
    *lane = (intersection_lane){.items = lane->items,
                                .notes = lane->notes,
                                .capacity = lane->capacity,
                                .note_capacity = lane->note_capacity,
                                .first_zero_area = UINT32_MAX};
    for (uint32_t t = begin; t < end; t += AREA_BATCH)
        mark_zero_area(work, lane, t, end - t < AREA_BATCH ? end : t + AREA_BATCH);
}

/* ---- all of it ------------------------------------------------------------------------------------------ */

static void mark_crossing(static_check *c) {
    const uint32_t *components = c->mesh->triangle_components;
    for (uint32_t i = 0; i < c->lane_count; i++) {
        const intersection_lane *lane = &c->lanes[i];
        for (size_t j = 0; j < lane->count; j++) {
            found_pair pair = lane->items[j];
            if (components[pair.a] != components[pair.b] || (c->kinds && lane->notes[j].unlisted)) continue;
            c->crossing[pair.a] = c->crossing[pair.b] = true;
        }
    }
}

static void spill_pairs(static_check *c) {
    bool full = false;
    for (uint32_t i = 0; i < c->lane_count; i++) full |= c->lanes[i].count - c->lanes[i].settled >= c->limit;
    if (!full) return;
    mark_crossing(c);
    if (c->spill != NULL) c->spill(c->spill_data);
    for (uint32_t i = 0; c->spill == NULL && i < c->lane_count; i++) c->lanes[i].count = 0;
}

void static_check_begin(check_work *work) {
    parallel_run(work->check->mesh->context->threads, work->check->lane_count, count_zero_area, work);
}

static cscd_status compare_triangles(check_work *work, bvh *f, traversal_pass pass) {
    static_check *check = work->check;
    cscd_context *context = check->mesh->context;
    traversal *t = work->traversal;
    assert(check->lane_count == t->lane_count);
    static_check_begin(work);
    if (check->mesh->triangle_count == 0) return CSCD_OK;
    bvh_skip_adjacent(f, NULL);
    traversal_begin(t, f, pass);
    for (bool more = true; more;) {
        if (!progress_go_on(&context->progress, traversal_done(t))) break;
        cscd_status status = traversal_round(t, &more);
        if (status != CSCD_OK) return status;
        parallel_run(context->threads, check->lane_count, test_batch, work);
        for (uint32_t i = 0; i < check->lane_count; i++) {
            if (check->lanes[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
        }
        spill_pairs(check);
    }
    if (!even_out_room(check)) return CSCD_OUT_OF_MEMORY;
    return context_progress_status(context); /* before the caller believes that nothing more was found */
}

cscd_status static_check_unproven(static_check *c, traversal *t, bvh *f, const double *positions) {
    check_work work = {
        .check = c, .traversal = t, .bvh = f, .positions = positions, .own_component_only = true};
    bvh_mark_unproven(f, c->unproven);
    cscd_status status = compare_triangles(&work, f, TRAVERSAL_UNPROVEN);
    if (status == CSCD_OK) mark_crossing(c);
    return status;
}

static cscd_status compare_all(check_work *work, bvh *f) {
    static_check *c = work->check;
    memset(c->unproven, true, c->mesh->triangle_count * sizeof *c->unproven);
    cscd_status status = compare_triangles(work, f, TRAVERSAL_KEPT);
    if (status == CSCD_OK) mark_crossing(c);
    return status;
}

cscd_status static_check_all(static_check *c, traversal *t, bvh *f, const double *positions) {
    check_work work = {.check = c, .traversal = t, .bvh = f, .positions = positions};
    return compare_all(&work, f);
}

cscd_status static_check_kinds(static_check *c, traversal *t, bvh *f, const double *positions,
                               const uint32_t *names) {
    check_work work = {.check = c, .traversal = t, .bvh = f, .positions = positions, .names = names};
    c->kinds = true;
    cscd_status status = compare_all(&work, f);
    c->kinds = false;
    return status;
}
