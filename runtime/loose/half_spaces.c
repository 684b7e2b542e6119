/* Half-spaces: every vertex that takes part in contacts against every one of them. */
#include "runtime/loose/loose.h"

#include "runtime/ccd/ccd.h"

#include <string.h>

/* A thread takes this number of vertices at a time. */
enum { VERTICES_AT_ONCE = 1024 };

static void load_pair(const swept_interval *interval, uint32_t vertex, uint32_t object, half_space_query *q) {
    const cscd_mesh *mesh = interval->mesh;
    const uint32_t points[2] = {vertex, mesh->objects[object].first_vertex};
    for (int i = 0; i < 2; i++) {
        memcpy(q->x0[i], interval->x0 + (size_t)points[i] * 3, sizeof q->x0[i]);
        memcpy(q->x1[i], interval->x1 + (size_t)points[i] * 3, sizeof q->x1[i]);
    }
    memcpy(q->normal, mesh->loose.normals[object], sizeof q->normal);
}

/* Above the plane by more than the distance at both ends, it is so in between. */
static bool parted_by_plane(const half_space_query *q, double distance) {
    plane_height start = half_space_height(q->x0, q->normal), end = half_space_height(q->x1, q->normal);
    return start.value - start.error > distance && end.value - end.error > distance;
}

/* Returns whether there is a contact. */
static bool test_touch(const half_space_query *q, elementary_contact *contact, contact_worker *worker) {
    elementary_verdict verdict = half_space_touch(q, contact);
    worker->decided[verdict.level]++;
    return verdict.touching;
}

static bool test_distance(const swept_interval *interval, const half_space_query *q, const separation *limit,
                          elementary_contact *contact, contact_worker *worker) {
    if (interval->floor_ratio > 0.0) {
        floor_ladder ladder = {limit->distance, interval->floor_ratio, limit->tolerance / limit->distance};
        floor_verdict verdict = half_space_floor_test(q, &ladder, contact);
        if (verdict == FLOOR_NONE) return test_touch(q, contact, worker);
        worker->separations++;
        return verdict == FLOOR_BROKEN;
    }
    worker->separations++;
    return half_space_within(q, limit->distance, contact);
}

void half_spaces_test_vertex(const swept_interval *interval, uint32_t vertex, uint32_t object,
                             contact_worker *worker) {
    half_space_query query;
    elementary_contact contact;
    separation limit = pair_separation(interval, CSCD_CONTACT_VH, vertex, object);
    load_pair(interval, vertex, object, &query);
    if (parted_by_plane(&query, limit.distance + interval->beyond)) return;
    worker->feature_pairs++;
    bool found = limit.distance > 0.0 ? test_distance(interval, &query, &limit, &contact, worker)
                                      : test_touch(&query, &contact, worker);
    if (found)
        contact_worker_add(interval->mesh->context, worker, CSCD_CONTACT_VH, vertex, object, &contact, false);
}

/* A vertex without a triangle, a wire, and a point there takes no part. */
static bool takes_part(const cscd_mesh *mesh, const cscd_object *object, uint32_t vertex) {
    if (object->kind == CSCD_OBJECT_POINTS) return true;
    if (object->kind == CSCD_OBJECT_WIRES) return wires_at_vertex(mesh, vertex) > 0;
    return object->kind == CSCD_OBJECT_TRIANGLES && !vertex_has_no_triangle(mesh, vertex);
}

static void test_object(const swept_interval *interval, uint32_t object, uint32_t half_space, uint32_t begin,
                        uint32_t end, contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    if (mesh->objects[object].kind == CSCD_OBJECT_HALF_SPACE ||
        !pair_filter_admits_objects(&interval->filter, object, half_space))
        return;
    for (uint32_t v = begin; v < end && !worker->out_of_memory; v++) {
        if (takes_part(mesh, &mesh->objects[object], v) &&
            pair_filter_admits_features(&interval->filter, CSCD_CONTACT_VH, v, half_space))
            half_spaces_test_vertex(interval, v, half_space, worker);
    }
}

/* The vertices begin to end - 1 against one half-space, object by object. */
static void test_range(const swept_interval *interval, uint32_t half_space, uint32_t begin, uint32_t end,
                       contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    for (uint32_t object = cscd_mesh_vertex_object(mesh, begin); begin < end; object++) {
        uint32_t last = mesh->objects[object].first_vertex + mesh->objects[object].vertex_count;
        if (last > end) last = end;
        test_object(interval, object, half_space, begin, last, worker);
        begin = last;
    }
}

void half_spaces_test(const swept_interval *interval, uint32_t worker_index, uint32_t worker_count,
                      contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    uint64_t count = mesh->vertex_count, stride = (uint64_t)worker_count * VERTICES_AT_ONCE;
    if (mesh->loose.half_space_count == 0 || interval->collecting) return;
    for (uint64_t begin = (uint64_t)worker_index * VERTICES_AT_ONCE + worker->cursor * stride; begin < count;
         begin += stride) {
        uint64_t end = begin + VERTICES_AT_ONCE < count ? begin + VERTICES_AT_ONCE : count;
        if (worker->out_of_memory || !progress_go_on(&mesh->context->progress, (double)begin / (double)count))
            return;
        for (uint32_t i = 0; i < mesh->object_count; i++) {
            if (mesh->objects[i].kind == CSCD_OBJECT_HALF_SPACE)
                test_range(interval, i, (uint32_t)begin, (uint32_t)end, worker);
        }
        if (contact_worker_suspend(worker, worker->cursor + 1)) return;
    }
}
