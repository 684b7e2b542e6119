/* Single pairs of the public API: points are gathered pair by pair, and a task decides as many pairs as one
 * call of the queue takes. */
#include "cscd/solver.h"

#include "runtime/ccd/ccd.h"
#include "runtime/narrow_phase/narrow_phase.h"
#include "src/core/floating.h"
#include "src/mesh/positions.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* ---- pairs without a mesh: four points each, decided by the queue and the kernels of a step ------------ */

/* VF: a vertex and the three of a triangle. EE: the two ends of each edge. */
typedef struct point_pairs {
    cscd_contact_kind kind;
    size_t count;
    const double *x0, *x1; /* four points of three coordinates for each pair, one pair after the other */
} point_pairs;

/* A function that is told of each pair that comes into contact, by the pair's number and in no certain
 * order. The contact's own numbers mean nothing. */
typedef void point_pair_found(void *user, size_t pair, const cscd_contact *contact);

/* The pairs that one call of point_pairs_test takes at most. */
enum { POINT_PAIRS_MAX = 128 };

/* The features of POINT_PAIRS_MAX pairs: triangle i and the edges 2 i and 2 i + 1 belong to pair i, as do
 * the points from 4 i on. */
typedef struct pair_features {
    uint32_t triangles[POINT_PAIRS_MAX][3], edges[2 * POINT_PAIRS_MAX][2];
} pair_features;

static void name_features(uint32_t count, pair_features *out) {
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < 3; k++) out->triangles[i][k] = 4 * i + 1 + k;
        for (uint32_t k = 0; k < 4; k++) out->edges[2 * i + k / 2][k % 2] = 4 * i + k;
    }
}

static void queue_pairs(const swept_interval *interval, cscd_contact_kind kind, uint32_t count,
                        contact_worker *worker) {
    for (uint32_t i = 0; i < count; i++) {
        if (kind == CSCD_CONTACT_VF)
            narrow_phase_test_vf(interval, 4 * i, i, worker);
        else
            narrow_phase_test_ee(interval, 2 * i, 2 * i + 1, worker);
    }
    narrow_phase_finish(interval, worker);
}

/* The worker has room for a contact of each pair, so it never asks the allocator for more. */
_Static_assert((int)POINT_PAIRS_MAX <= (int)WORKER_FIRST_BLOCK,
               "the contacts of all pairs are one block of a worker");
/* Tests up to POINT_PAIRS_MAX pairs on the calling thread, without an allocation: for contact or, with a
 * distance above 0, for coming within it. Every bit is that of a step over a mesh that holds these features. */
static void point_pairs_test(cscd_context *context, const point_pairs *pairs, separation limit,
                             point_pair_found *found, void *user) {
    pair_features features;
    cscd_contact contacts[POINT_PAIRS_MAX];
    contact_worker worker;
    uint32_t count = (uint32_t)pairs->count;
    assert(pairs->count <= POINT_PAIRS_MAX);
    name_features(count, &features);
    worker.blocks[0] = contacts;
    worker.block_count = 1;
    contact_worker_reset(&worker);
    cscd_mesh mesh = {.context = context, .triangles = features.triangles, .edges = features.edges};
    swept_interval interval = {.mesh = &mesh, .x0 = pairs->x0, .x1 = pairs->x1, .limit = limit};
    queue_pairs(&interval, pairs->kind, count, &worker);
    for (size_t i = 0; i < worker.count; i++)
        found(user, contacts[i].a / (pairs->kind == CSCD_CONTACT_VF ? 4 : 2), &contacts[i]);
}

/* Returns the distance between the points that u and v name on the features of these four points. */
static double point_pair_distance(cscd_contact_kind kind, const double (*x)[3], double u, double v) {
    const double *points[4] = {x[0], x[1], x[2], x[3]};
    double weights[4], apart[3];
    cscd_stencil_weights(kind, u, v, weights);
    connection_between(points, weights, points_of_first(kind), apart);
    return connection_length(apart);
}

/* ---- a task -------------------------------------------------------------------------------------------- */

/* The pairs of a call, which wants one kind of result. */
typedef struct pair_call {
    cscd_context *context;
    cscd_pairs desc;
    const double *x0, *x1; /* of points */
    double *unpacked[2];   /* where they are not packed doubles */
    separation limit;
    cscd_pair_contact *contacts;
    cscd_pair_distance *distances;
} pair_call;

/* The pairs of one task, and their points at both ends. */
typedef struct pair_batch {
    const pair_call *call;
    size_t first, count;
    double x0[POINT_PAIRS_MAX * 4][3], x1[POINT_PAIRS_MAX * 4][3];
} pair_batch;

static void gather_points(const pair_batch *b, const double *positions, double (*out)[3]) {
    const uint32_t *points = b->call->desc.points;
    for (size_t i = 0; i < 4 * b->count; i++) {
        size_t place = 4 * b->first + i, point = points != NULL ? points[place] : place;
        memcpy(out[i], positions + 3 * point, sizeof out[i]);
    }
}

static void take_contact(void *user, size_t pair, const cscd_contact *found) {
    const pair_batch *b = user;
    cscd_pair_contact *out = &b->call->contacts[b->first + pair];
    out->toi = found->toi;
    out->contact = true;
    out->bounded = found->bounded;
    out->u = found->u;
    out->v = found->v;
    memcpy(out->point, found->point, sizeof out->point);
    memcpy(out->normal, found->normal, sizeof out->normal);
}

static void take_distance(void *user, size_t pair, const cscd_contact *found) {
    const pair_batch *b = user;
    cscd_pair_distance *out = &b->call->distances[b->first + pair];
    const double(*x)[3] = (const double(*)[3])b->x0 + 4 * pair;
    *out = (cscd_pair_distance){.u = found->u, .v = found->v};
    out->distance = point_pair_distance(b->call->desc.kind, x, found->u, found->v);
    memcpy(out->point, found->point, sizeof out->point);
    memcpy(out->normal, found->normal, sizeof out->normal);
}

/* Padding is cleared, too: results are compared bit for bit. */
static void clear_results(const pair_batch *b) {
    cscd_pair_contact *contacts = b->call->contacts;
    cscd_pair_distance *distances = b->call->distances;
    if (contacts != NULL) memset(contacts + b->first, 0, b->count * sizeof *contacts);
    if (distances != NULL) memset(distances + b->first, 0, b->count * sizeof *distances);
    for (size_t i = b->first; i < b->first + b->count; i++) {
        if (contacts != NULL) contacts[i].toi = INFINITY;
        if (distances != NULL) distances[i].distance = INFINITY;
    }
}

static void test_batch(void *data, uint32_t task) {
    const pair_call *call = data;
    pair_batch b;
    b.call = call;
    b.first = (size_t)task * POINT_PAIRS_MAX;
    b.count = call->desc.pair_count - b.first;
    if (b.count > POINT_PAIRS_MAX) b.count = POINT_PAIRS_MAX;
    gather_points(&b, call->x0, b.x0);
    gather_points(&b, call->x1, b.x1);
    clear_results(&b);
    point_pairs pairs = {call->desc.kind, b.count, b.x0[0], b.x1[0]};
    point_pairs_test(call->context, &pairs, call->limit,
                     call->contacts != NULL ? take_contact : take_distance, &b);
}

/* ---- the calls ----------------------------------------------------------------------------------------- */

static cscd_status check_pairs(cscd_context *context, const cscd_pairs *desc) {
    if (desc->point_count == 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "point_count is 0, expected 1 or more");
    if (desc->kind != CSCD_CONTACT_VF && desc->kind != CSCD_CONTACT_EE)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "pairs are of kind %d, expected VF or EE",
                            (int)desc->kind);
    if (desc->pair_count > (size_t)UINT32_MAX * POINT_PAIRS_MAX)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "there are %zu pairs, expected at most 2^39 - 2^7", desc->pair_count);
    if (desc->points == NULL && desc->point_count / 4 < desc->pair_count)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%zu pairs need four points each, but there are %u points", desc->pair_count,
                            desc->point_count);
    for (size_t i = 0; desc->points != NULL && i < 4 * desc->pair_count; i++) {
        if (desc->points[i] < desc->point_count) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT, "pair %zu names point %u, but there are %u",
                            i / 4, desc->points[i], desc->point_count);
    }
    return CSCD_OK;
}

/* Takes what every call has. */
static cscd_status begin_call(cscd_context *context, const cscd_pairs *pairs, const void *out,
                              const char *function, pair_call *call) {
    *call = (pair_call){.context = context};
    if (pairs == NULL || out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%s: %s is NULL", function,
                            pairs == NULL ? "pairs" : "out");
    call->desc = *pairs;
    return check_pairs(context, pairs);
}

/* Reads the points of one end, as the vertices of a mesh of one object. */
static cscd_status read_points(pair_call *call, const cscd_view *view, const char *name, int end,
                               const double **out) {
    cscd_object points = {.vertex_count = call->desc.point_count};
    const cscd_mesh mesh = {.vertex_count = points.vertex_count, .object_count = 1, .objects = &points};
    cscd_status status = views_read(call->context, &mesh, view, name, &call->unpacked[end], out);
    return status == CSCD_OK ? positions_check(call->context, *out, points.vertex_count, name) : status;
}

/* Ends the call, after having tested its pairs unless something is wrong. */
static cscd_status finish_call(pair_call *call, cscd_status status) {
    size_t tasks = (call->desc.pair_count + POINT_PAIRS_MAX - 1) / POINT_PAIRS_MAX;
    if (status == CSCD_OK) {
        parallel_run(call->context->threads, (uint32_t)tasks, test_batch, call);
        status = context_loop_status(call->context);
    }
    for (int end = 0; end < 2; end++) context_free(call->context, call->unpacked[end]);
    return status;
}

static cscd_status step_pairs(cscd_context *context, const cscd_pairs *pairs, const cscd_view *x0,
                              const cscd_view *x1, const double limit[2], cscd_pair_contact *out) {
    pair_call call;
    cscd_status status = begin_call(context, pairs, out, "cscd_pairs_step", &call);
    if (status == CSCD_OK) status = separation_check(context, limit[0], limit[1]);
    if (status == CSCD_OK) status = read_points(&call, x0, "x0", 0, &call.x0);
    call.x1 = call.x0;
    if (status == CSCD_OK && x1 != NULL) status = read_points(&call, x1, "x1", 1, &call.x1);
    call.limit = separation_limit(limit[0], limit[1]);
    call.contacts = out;
    return finish_call(&call, status);
}

cscd_status cscd_pairs_step(cscd_context *context, const cscd_pairs *pairs, const cscd_view *x0,
                            const cscd_view *x1, double min_separation, double tolerance,
                            cscd_pair_contact *out) {
    if (context == NULL) return CSCD_NULL_OBJECT;
    const double limit[2] = {min_separation, tolerance};
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, step_pairs(context, pairs, x0, x1, limit, out));
}

/* No two points are farther apart. */
static const double farthest = 0x1p302;

static cscd_status check_distance(cscd_context *context, double distance) {
    if (is_positive_length(distance) || distance == INFINITY) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "distance is %g, expected a length from 2^-300 to 2^300, or INFINITY", distance);
}

static cscd_status measure_pairs(cscd_context *context, const cscd_pairs *pairs, const cscd_view *positions,
                                 double distance, cscd_pair_distance *out) {
    pair_call call;
    cscd_status status = begin_call(context, pairs, out, "cscd_pairs_find_near", &call);
    if (status == CSCD_OK) status = check_distance(context, distance);
    if (status == CSCD_OK) status = read_points(&call, positions, "positions", 0, &call.x0);
    call.x1 = call.x0;
    call.limit = proximity_limit(distance == INFINITY ? farthest : distance);
    call.distances = out;
    return finish_call(&call, status);
}

cscd_status cscd_pairs_find_near(cscd_context *context, const cscd_pairs *pairs, const cscd_view *positions,
                                 double distance, cscd_pair_distance *out) {
    if (context == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, measure_pairs(context, pairs, positions, distance, out));
}
