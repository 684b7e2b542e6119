/* The share of a step that no further thread takes over. */
#include "benchmarks/lib/serial_share.h"

#include "src/core/timer.h"

#include <stdlib.h>

/* The host whose loop takes the time, and whose allocator counts. */
typedef struct loop_host {
    double ms;
    uint64_t loops, tasks;
    size_t held;
} loop_host;

static void run_in_turn(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index),
                        void *data) {
    loop_host *host = user;
    double since = timer_now_ms();
    for (uint32_t i = 0; i < task_count; i++) task(data, i);
    timer_lap(&since, &host->ms);
    host->loops++;
    host->tasks += task_count;
}

static void *count_block(void *user, size_t size, size_t alignment) {
    loop_host *host = user;
    void *block = aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (block != NULL) host->held += size;
    return block;
}

static void free_block(void *user, void *block, size_t size) {
    loop_host *host = user;
    host->held -= size;
    free(block);
}

typedef struct lone_detector {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
} lone_detector;

static cscd_status open_detector(const deforming_body *b, cscd_method method, uint32_t thread_count,
                                 loop_host *host, lone_detector *out) {
    cscd_context_options options = cscd_context_defaults();
    cscd_detector_options detector = cscd_detector_defaults();
    const cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    options.thread_count = thread_count;
    options.parallel_for = (cscd_parallel_for){run_in_turn, host};
    options.allocator = (cscd_allocator){count_block, free_block, host};
    detector.method = method;
    cscd_status status = cscd_context_create(&options, &out->context);
    if (status == CSCD_OK) status = cscd_mesh_create(out->context, &desc, 1, &out->mesh);
    if (status == CSCD_OK)
        status = cscd_detector_create(out->context, out->mesh, NULL, &detector, &out->detector);
    return status;
}

static void close_detector(lone_detector *l) {
    cscd_detector_destroy(l->detector);
    cscd_mesh_destroy(l->mesh);
    cscd_context_destroy(l->context);
}

/* One round, in which the first interval does not count. Keeps the least total of each interval in `least`. */
static cscd_status run_round(const deforming_body *b, lone_detector *l, loop_host *host, uint32_t intervals,
                             double *ends, serial_share *least) {
    size_t size = (size_t)b->vertex_count * 3;
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; status == CSCD_OK && i <= intervals; i++) {
        cscd_contacts found;
        deforming_body_interval(b, i, 0.0, ends, ends + size);
        host->ms = 0.0;
        host->loops = host->tasks = 0;
        double since = timer_now_ms();
        status = cscd_detector_step(l->detector, CSCD_DOUBLES(ends, b->vertex_count),
                                    CSCD_DOUBLES(ends + size, b->vertex_count), &found);
        double total = timer_now_ms() - since;
        if (least[i].total_ms == 0.0 || total < least[i].total_ms)
            least[i] = (serial_share){total, host->ms, (double)host->loops, (double)host->tasks, 0};
    }
    return status;
}

bool serial_share_measure(const deforming_body *b, cscd_method method, uint32_t thread_count,
                          uint32_t intervals, uint32_t rounds, serial_share *out, io_error *error) {
    loop_host host = {0.0, 0, 0, 0};
    lone_detector l = {NULL, NULL, NULL};
    double *ends = body_allocate((size_t)b->vertex_count * 6, sizeof *ends);
    serial_share *least = body_allocate((size_t)intervals + 1, sizeof *least);
    cscd_status status = open_detector(b, method, thread_count, &host, &l);
    for (uint32_t i = 0; status == CSCD_OK && i < rounds; i++)
        status = run_round(b, &l, &host, intervals, ends, least);
    *out = (serial_share){.held = host.held};
    for (uint32_t i = 1; i <= intervals; i++) {
        out->total_ms += least[i].total_ms / intervals;
        out->loops_ms += least[i].loops_ms / intervals;
        out->loops += least[i].loops / intervals;
        out->tasks += least[i].tasks / intervals;
    }
    close_detector(&l);
    free(least);
    free(ends);
    return status == CSCD_OK || io_fail(error, "%s", cscd_status_string(status));
}

double serial_share_speedup(const serial_share *s, double processors) {
    return s->total_ms / (s->total_ms - s->loops_ms + s->loops_ms / processors);
}
