/* Runs every call of the API that may take long, one after the other, and computes a digest of each
 * result. */
#include "tests/support/workload.h"
#include "tests/support/calls.h"

#include "src/core/names.h"

#include <math.h>
#include <string.h>

void workload_tube(sequence *out, int rings, int segments, uint32_t frame_count) {
    scene_clear(&out->shape);
    scene_add_capsule(&out->shape, 6.0, 0.5, rings, segments);
    out->frame_count = frame_count;
    for (uint32_t f = 0; f < frame_count; f++) {
        double time = 0.3 * f;
        for (uint32_t v = 0; v < out->shape.vertex_count; v++) {
            const double *rest = out->shape.x0 + (size_t)v * 3;
            double bend = 1.2 * time * rest[2], *x = out->frames[f] + (size_t)v * 3;
            x[0] = rest[0] * cos(bend) + (1.0 - cos(bend)) * 1.5;
            x[1] = rest[1];
            x[2] = rest[2] + sin(bend) * (1.5 - rest[0]) - 0.8 * time * rest[2];
        }
    }
}

typedef struct workload_state {
    const workload *w;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_detector *detector;
    cscd_line_search *line;
    workload_result result;
} workload_state;

/* Adds the bytes to the digest by FNV-1a. */
static void add_digest(workload_state *r, const void *data, size_t size) {
    const unsigned char *bytes = data;
    uint64_t *hash = &r->result.digests[r->result.call_count];
    for (size_t i = 0; i < size; i++) *hash = (*hash ^ bytes[i]) * 0x100000001b3u;
}

/* Adds the counters except the number of rebuilds: a failed call may have rebuilt trees already, so that
 * its repetition does not. */
static void digest_counters(workload_state *r) {
    cscd_counters counters = cscd_detector_counters(r->detector);
    r->result.rebuilds += counters.rebuilds;
    r->result.culled += counters.plus + counters.minus;
    counters.rebuilds = 0;
    add_digest(r, &counters, sizeof counters);
}

static bool call_again(workload_state *r, cscd_status status) {
    return r->w->again != NULL && r->w->again(r->w->user, r->context, status);
}

static void end_call(workload_state *r, cscd_status status) {
    add_digest(r, &status, sizeof status);
    r->result.failed |= status != CSCD_OK && status != CSCD_IN_CONTACT;
    if (r->result.call_count + 1 < WORKLOAD_CALLS_MAX) r->result.call_count++;
}

static void make_plan(workload_state *r) {
    cscd_plan_options options = cscd_plan_defaults();
    options.method = r->w->plan;
    cscd_status status;
    do {
        status = plan_create_packed(r->mesh, r->w->sequence->shape.x0, &options, &r->plan);
    } while (call_again(r, status));
    for (uint32_t t = 0; status == CSCD_OK && t < r->w->sequence->shape.triangle_count; t++) {
        double charge = cscd_plan_triangle_charge(r->plan, t);
        uint32_t region = cscd_plan_triangle_region(r->plan, t);
        add_digest(r, &charge, sizeof charge);
        add_digest(r, &region, sizeof region);
    }
    end_call(r, status);
}

static void run_step(workload_state *r, const double *x0, const double *x1) {
    cscd_contacts found = {.count = 0};
    cscd_status status;
    do {
        status = step_packed(r->detector, x0, x1, &found);
    } while (call_again(r, status));
    add_digest(r, found.items, found.count * sizeof *found.items);
    digest_counters(r);
    for (uint32_t c = 0; c < cscd_mesh_component_count(r->mesh); c++) {
        cscd_guarantee g = cscd_detector_guarantee(r->detector, c);
        add_digest(r, &g.complete, sizeof g.complete);
        add_digest(r, &g.reason, sizeof g.reason);
    }
    r->result.contacts += found.count;
    end_call(r, status);
}

static void run_check(workload_state *r, const double *x) {
    cscd_intersections found = {.count = 0};
    cscd_status status;
    do {
        status = check_packed(r->detector, x, &found);
    } while (call_again(r, status));
    add_digest(r, found.items, found.count * sizeof *found.items);
    add_digest(r, &found.zero_area_triangles, sizeof found.zero_area_triangles);
    end_call(r, status);
}

static void run_near(workload_state *r, const double *x) {
    cscd_proximities found = {.count = 0};
    cscd_status status;
    do {
        status = find_near_packed(r->detector, x, 0.05, &found);
    } while (call_again(r, status));
    add_digest(r, found.items, found.count * sizeof *found.items);
    end_call(r, status);
}

static void max_step(workload_state *r, const double *x0, const double *x1) {
    static _Thread_local double end[SCENE_VERTICES_MAX * 3];
    cscd_free_step found = {.fraction = 0.0};
    cscd_status status;
    if (method_traits_of(r->w->options.method)->loses_contacts) return; /* it refuses to certify steps */
    do {
        status = max_step_packed(r->detector, x0, x1, end, &found);
    } while (call_again(r, status));
    add_digest(r, &found.fraction, sizeof found.fraction);
    if (status == CSCD_OK) {
        digest_counters(r);
        add_digest(r, end, (size_t)r->w->sequence->shape.vertex_count * sizeof(double[3]));
    }
    end_call(r, status);
}

static void begin_line(workload_state *r, const double *x0, const double *x1) {
    cscd_status status;
    do {
        status = line_begin_packed(r->line, x0, x1, 0.05);
    } while (call_again(r, status));
    size_t count = cscd_line_search_candidate_count(r->line);
    add_digest(r, &count, sizeof count);
    end_call(r, status);
}

/* Asks for two lengths and two moments on the line search that was begun last. */
static void ask_line(workload_state *r) {
    static _Thread_local double end[SCENE_VERTICES_MAX * 3];
    for (int i = 0; i < 2; i++) {
        cscd_free_step step = {.fraction = 0.0};
        cscd_proximities found = {.count = 0};
        cscd_status status;
        do {
            status = line_max_step_packed(r->line, i == 0 ? 1.0 : 0.3, end, &step);
        } while (call_again(r, status));
        add_digest(r, &step.fraction, sizeof step.fraction);
        if (status == CSCD_OK)
            add_digest(r, end, (size_t)r->w->sequence->shape.vertex_count * sizeof(double[3]));
        end_call(r, status);
        do {
            status = cscd_line_search_find_near(r->line, 0.6 * i, 0.05, CSCD_NEAR_PAIRS, &found);
        } while (call_again(r, status));
        add_digest(r, found.items, found.count * sizeof *found.items);
        end_call(r, status);
    }
}

static void run_intervals(workload_state *r) {
    const sequence *q = r->w->sequence;
    for (uint32_t i = 0; i + 1 < q->frame_count; i++) {
        const double *x0 = q->frames[i], *x1 = q->frames[i + 1];
        if (i % 4 == 3) max_step(r, x0, x1);
        run_step(r, x0, x1);
        if (i % 3 == 1) run_check(r, x1);
        if (i % 5 == 2) run_near(r, x1);
        if (i % 5 == 3) {
            begin_line(r, x0, x1);
            ask_line(r);
        }
    }
}

workload_result workload_run(cscd_context *context, const workload *w) {
    workload_state r = {.w = w, .context = context};
    const scene *shape = &w->sequence->shape;
    cscd_object_desc desc =
        cscd_object_of_triangles(shape->vertex_count, shape->triangle_count, shape->triangles);
    r.result.failed = cscd_mesh_create(context, &desc, 1, &r.mesh) != CSCD_OK;
    if (!r.result.failed && w->plan != CSCD_METHOD_AUTO) make_plan(&r);
    if (!r.result.failed)
        r.result.failed = detector_create_here(r.mesh, r.plan, &w->options, &r.detector) != CSCD_OK ||
                          cscd_line_search_create(r.detector, &r.line) != CSCD_OK;
    if (!r.result.failed) run_intervals(&r);
    cscd_line_search_destroy(r.line);
    cscd_detector_destroy(r.detector);
    cscd_plan_destroy(r.plan);
    cscd_mesh_destroy(r.mesh);
    return r.result;
}
