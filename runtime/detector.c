/* The detector of the public API: one interval through the stages of the pipeline. */
#include "runtime/detector.h"

#include "runtime/brute_force.h"
#include "runtime/contact_list.h"
#include "runtime/representatives.h"
#include "src/positions.h"
#include "src/timer.h"

cscd_detector_options cscd_detector_defaults(void) {
    return (cscd_detector_options){
        .struct_size = sizeof(cscd_detector_options), .method = CSCD_METHOD_NONE, .mode = CSCD_MODE_ALL};
}

/* Lengths are 0 or in the range of positions. */
static bool is_length(double x) {
    return x == 0.0 || (x >= 0x1p-300 && x <= 0x1p300); /* false for NaN */
}

static cscd_status check_separation(cscd_context *context, const cscd_detector_options *options) {
    if (!is_length(options->min_separation))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "min_separation is %g, expected 0 or a length from 2^-300 to 2^300",
                            options->min_separation);
    if (!is_length(options->tolerance))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "tolerance is %g, expected 0 (the default) or a length from 2^-300 to 2^300",
                            options->tolerance);
    if (options->tolerance > 0.0 && options->min_separation == 0.0)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "tolerance is %g, but without min_separation there is none; leave it at 0",
                            options->tolerance);
    return CSCD_OK;
}

static cscd_status check_options(cscd_context *context, const cscd_detector_options *options) {
    if (options->struct_size != sizeof *options)
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "detector options were not made by cscd_detector_defaults (struct_size %u, expected %zu)",
            options->struct_size, sizeof *options);
    if (options->method != CSCD_METHOD_NONE && options->method != CSCD_METHOD_BRUTE)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown method %d", (int)options->method);
    if (options->mode != CSCD_MODE_ALL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown mode %d", (int)options->mode);
    return check_separation(context, options);
}

static cscd_status allocate_parts(cscd_detector *d) {
    cscd_context *context = d->context;
    cscd_status status = traversal_create(context, &d->traversal);
    if (status != CSCD_OK) return status;
    d->vertex_volumes = context_allocate(context, d->mesh->vertex_count, sizeof *d->vertex_volumes);
    d->representatives = representatives_create(d->mesh);
    d->contact_lanes = context_allocate(context, d->traversal.lane_count, sizeof *d->contact_lanes);
    d->intersection_lanes = context_allocate(context, d->traversal.lane_count, sizeof *d->intersection_lanes);
    bool allocated = d->vertex_volumes != NULL && d->representatives != NULL && d->contact_lanes != NULL &&
                     d->intersection_lanes != NULL;
    return allocated ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

cscd_status cscd_detector_create(const cscd_mesh *mesh, const cscd_detector_options *options,
                                 cscd_detector **out) {
    if (mesh == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = mesh->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_create: out is NULL");
    cscd_detector_options chosen = options != NULL ? *options : cscd_detector_defaults();
    cscd_status status = check_options(context, &chosen);
    if (status != CSCD_OK) return status;

    cscd_detector *d = context_allocate(context, 1, sizeof *d);
    if (d == NULL) return context_out_of_memory(context);
    d->context = context;
    d->mesh = mesh;
    d->options = chosen;
    d->limit.distance = chosen.min_separation;
    d->limit.tolerance = chosen.tolerance > 0.0 ? chosen.tolerance : 1e-6 * chosen.min_separation;
    status = allocate_parts(d);
    if (status != CSCD_OK) {
        cscd_detector_destroy(d);
        return context_out_of_memory(context);
    }
    *out = d;
    return CSCD_OK;
}

static void free_lanes(cscd_detector *d) {
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        if (d->contact_lanes != NULL) context_free(d->context, d->contact_lanes[i].contacts);
        if (d->intersection_lanes != NULL) context_free(d->context, d->intersection_lanes[i].items);
    }
    context_free(d->context, d->contact_lanes);
    context_free(d->context, d->intersection_lanes);
}

void cscd_detector_destroy(cscd_detector *d) {
    if (d == NULL) return;
    cscd_context *context = d->context;
    free_lanes(d);
    if (d->traversal.lanes != NULL) traversal_destroy(&d->traversal);
    bvh_free(context, &d->tree);
    void *blocks[] = {d->vertex_volumes,
                      d->representatives,
                      d->contacts.items,
                      d->contacts.scratch,
                      d->intersections.items,
                      d->intersections.scratch,
                      d};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(context, blocks[i]);
}

cscd_status result_buffer_reserve(cscd_context *context, result_buffer *buffer, size_t count, size_t size) {
    if (count <= buffer->capacity) return CSCD_OK;
    size_t capacity = count + count / 2;
    void *items = context_allocate(context, capacity, size);
    void *scratch = context_allocate(context, capacity, size);
    if (items == NULL || scratch == NULL) {
        context_free(context, items);
        context_free(context, scratch);
        return CSCD_OUT_OF_MEMORY;
    }
    context_free(context, buffer->items);
    context_free(context, buffer->scratch);
    *buffer = (result_buffer){items, scratch, capacity};
    return CSCD_OK;
}

/* ---- BVH update ------------------------------------------------------------------------------------ */

typedef struct sweep {
    cscd_detector *detector;
    const double *x0, *x1;
    double distance;
} sweep;

static void sweep_vertices(void *data, uint32_t index) {
    const sweep *s = data;
    size_t count = s->detector->mesh->vertex_count, lanes = s->detector->traversal.lane_count;
    for (size_t v = count * index / lanes; v < count * (index + 1) / lanes; v++) {
        kdop_exact start, end;
        kdop_point(s->x0 + v * 3, &start);
        kdop_point(s->x1 + v * 3, &end);
        kdop_exact_add(&start, &end);
        if (s->distance > 0.0) kdop_exact_widen(&start, s->distance);
        s->detector->vertex_volumes[v] = kdop_round(&start);
    }
}

/* The volumes of features that come within distance of each other overlap. */
static cscd_status update_volumes(cscd_detector *d, const double *x0, const double *x1, double distance) {
    if (d->tree.nodes == NULL) {
        bvh_regions components = {d->mesh->triangle_components, d->mesh->component_count};
        cscd_status status = bvh_build(d->mesh, components, x0, &d->tree);
        if (status != CSCD_OK) return status;
    }
    sweep s = {d, x0, x1, distance};
    parallel_run(d->context->threads, d->traversal.lane_count, sweep_vertices, &s);
    bvh_refit(&d->tree, d->mesh, d->vertex_volumes);
    return CSCD_OK;
}

cscd_status detector_update(cscd_detector *d, const double *x0, const double *x1) {
    return update_volumes(d, x0, x1, 0.0);
}

/* ---- one interval ---------------------------------------------------------------------------------- */

typedef struct step_work {
    cscd_detector *detector;
    swept_interval interval;
} step_work;

static void test_batch(void *data, uint32_t index) {
    step_work *work = data;
    const traversal_lane *batch = &work->detector->traversal.lanes[index];
    contact_lane *lane = &work->detector->contact_lanes[index];
    for (uint32_t i = 0; i < batch->pair_count && !lane->out_of_memory; i++)
        narrow_phase_test(&work->interval, batch->pairs[i], lane);
}

static void test_share(void *data, uint32_t index) {
    step_work *work = data;
    brute_force_test(&work->interval, index, work->detector->traversal.lane_count,
                     &work->detector->contact_lanes[index]);
}

static cscd_status lanes_status(const cscd_detector *d) {
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        if (d->contact_lanes[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
    }
    return CSCD_OK;
}

static cscd_status find_by_trees(step_work *work, cscd_timings *timings, cscd_counters *counters) {
    cscd_detector *d = work->detector;
    double since = timer_now_ms();
    cscd_status status = update_volumes(d, work->interval.x0, work->interval.x1, d->limit.distance);
    timer_lap(&since, &timings->update_ms);
    if (status != CSCD_OK) return status;
    traversal_begin(&d->traversal, &d->tree, false);
    for (bool more = true; more && status == CSCD_OK;) {
        status = traversal_round(&d->traversal, &more);
        timer_lap(&since, &timings->traversal_ms);
        if (status != CSCD_OK) return status;
        for (uint32_t i = 0; i < d->traversal.lane_count; i++)
            counters->pcp += d->traversal.lanes[i].pair_count;
        parallel_run(d->context->threads, d->traversal.lane_count, test_batch, work);
        status = lanes_status(d);
        timer_lap(&since, &timings->contact_ms);
    }
    counters->boxes_tested = traversal_boxes_tested(&d->traversal);
    return status;
}

static cscd_status find_by_brute_force(step_work *work, cscd_timings *timings) {
    cscd_detector *d = work->detector;
    double since = timer_now_ms();
    parallel_run(d->context->threads, d->traversal.lane_count, test_share, work);
    timer_lap(&since, &timings->contact_ms);
    return lanes_status(d);
}

static cscd_status step(step_work *work, cscd_timings *timings, cscd_counters *counters,
                        cscd_contacts *contacts) {
    cscd_detector *d = work->detector;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) contact_lane_reset(&d->contact_lanes[i]);
    cscd_status status = d->options.method == CSCD_METHOD_BRUTE ? find_by_brute_force(work, timings)
                                                                : find_by_trees(work, timings, counters);
    if (status != CSCD_OK) return status;
    double since = timer_now_ms();
    status = contact_list_collect(d, counters, contacts);
    timer_lap(&since, &timings->contact_ms);
    return status;
}

cscd_status cscd_detector_step(cscd_detector *detector, const double *start, const double *end,
                               cscd_contacts *out) {
    if (detector == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = detector->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_step: out is NULL");
    double since = timer_now_ms();
    cscd_status status = positions_check(context, start, detector->mesh->vertex_count, "start");
    if (status == CSCD_OK) status = positions_check(context, end, detector->mesh->vertex_count, "end");
    if (status != CSCD_OK) return status;

    cscd_timings timings = {.check_ms = detector->timings.check_ms};
    cscd_counters counters = {0};
    cscd_contacts contacts;
    step_work work = {
        detector,
        {detector->mesh, start, end, detector->vertex_volumes, detector->representatives, detector->limit}};
    status = step(&work, &timings, &counters, &contacts);
    if (status != CSCD_OK) return context_out_of_memory(context);
    timer_lap(&since, &timings.total_ms);
    detector->timings = timings;
    detector->counters = counters;
    *out = contacts;
    return CSCD_OK;
}

cscd_timings cscd_detector_timings(const cscd_detector *detector) {
    return detector->timings;
}

cscd_counters cscd_detector_counters(const cscd_detector *detector) {
    return detector->counters;
}
