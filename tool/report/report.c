/* Collects a report while the replay runs: chooses the frames that are kept, and fills the arrays. */
#include "tool/report/collected.h"

#include "tool/report/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Lengths in which float32, and so the page, has its squares and their reciprocals without a scale. */
#define SIDE_MIN 0x1p-40
#define SIDE_MAX 0x1p40

static bool out_of_memory(io_error *error) {
    return io_fail(error, "out of memory for the report");
}

/* Chooses the stride so that the positions of all kept frames, the last one included, stay below the
 * limit. */
static uint32_t choose_stride(const report_options *o) {
    uint64_t vertices = cscd_mesh_vertex_count(o->mesh), steps = o->last - o->first;
    if (o->scenery.triangles != NULL && o->scenery.moves) vertices += o->scenery.vertex_count;
    uint64_t frames = REPORT_POSITIONS_MAX / vertices;
    if (frames < 2) frames = 2;
    uint64_t stride = (steps + frames - 2) / (frames - 1);
    return stride > 1 ? (uint32_t)stride : 1;
}

uint32_t report_untangled_frames(uint32_t vertex_count) {
    const uint32_t frames = REPORT_POSITIONS_MAX / 2 / (vertex_count > 0 ? vertex_count : 1);
    return frames > 1 ? frames : 1;
}

static bool prepare_untangled(report *r) {
    r->stride = 1;
    return answer_arrays_create(&r->options, &r->answers);
}

static bool prepare_report(report *r) {
    const report_options *o = &r->options;
    if (o->kind == REPORT_UNTANGLED) return prepare_untangled(r);
    r->stride = choose_stride(o);
    size_t size = cscd_mesh_vertex_count(o->mesh) * sizeof(double[3]);
    if (r->stride > 1 && (r->last_positions = io_realloc(NULL, size)) == NULL) return false;
    if (o->kind != REPORT_REPLAY) return true;
    if (!contact_arrays_create(o, &r->contacts) || !answer_arrays_create(o, &r->answers)) return false;
    uint32_t intervals = o->last - o->first, kept = (intervals + r->stride - 1) / r->stride;
    return !o->oriented ||
           orientation_arrays_create(cscd_mesh_triangle_count(o->mesh), kept, intervals, &r->orientations);
}

bool report_create(const report_options *options, report **out, io_error *error) {
    report *r = io_realloc(NULL, sizeof *r);
    if (r == NULL) return out_of_memory(error);
    *r = (report){.options = *options, .unit = 1.0, .kept = growable_of(sizeof(uint32_t))};
    if (options->mesh != NULL && !prepare_report(r)) {
        report_destroy(r);
        return out_of_memory(error);
    }
    *out = r;
    return true;
}

void report_destroy(report *r) {
    if (r == NULL) return;
    growable_free(&r->kept);
    free(r->last_positions);
    frame_stream_free(&r->frames);
    frame_stream_free(&r->scenery);
    contact_arrays_free(&r->contacts);
    answer_arrays_free(&r->answers);
    event_list_free(&r->events);
    orientation_arrays_free(&r->orientations);
    free(r);
}

/* A power of two near the size of the frame or, for a frame of one point, near its distance from 0; 1 for
 * sizes that need no scale. */
static double choose_unit(const double *positions, uint32_t vertex_count) {
    double side = 0.0, reach = 0.0;
    for (size_t k = 0; k < 3; k++) {
        double low = positions[k], high = positions[k];
        for (size_t v = 1; v < vertex_count; v++) {
            low = fmin(low, positions[v * 3 + k]);
            high = fmax(high, positions[v * 3 + k]);
        }
        side = fmax(side, high - low);
        reach = fmax(reach, fmax(fabs(low), fabs(high)));
    }
    double size = side > 0.0 ? side : reach;
    if (size == 0.0 || (size >= SIDE_MIN && size <= SIDE_MAX)) return 1.0;
    return ldexp(1.0, ilogb(size));
}

static bool keep_interval(report *r, uint32_t frame, const double *positions) {
    uint32_t *kept = growable_push(&r->kept);
    if (kept == NULL) return false;
    *kept = frame;
    return frame_stream_add(&r->frames, positions);
}

static bool is_due(const report *r, uint32_t frame) {
    return (frame - r->options.first) % r->stride == 0;
}

static bool add_frame(report *r, uint32_t frame, const double *positions) {
    r->last = frame;
    r->last_is_kept = is_due(r, frame);
    if (r->last_is_kept) return keep_interval(r, frame, positions);
    memcpy(r->last_positions, positions, r->frames.vertex_count * sizeof(double[3]));
    return true;
}

bool report_begin(report *r, const double *positions, io_error *error) {
    uint32_t vertex_count = cscd_mesh_vertex_count(r->options.mesh);
    r->unit = choose_unit(positions, vertex_count);
    bool begun = frame_stream_create(vertex_count, 1.0 / r->unit, &r->frames) &&
                 add_frame(r, r->options.first, positions);
    return begun || out_of_memory(error);
}

bool report_add_interval(report *r, const orientation_row *orientations, const cscd_contacts *contacts,
                         const double *end, io_error *error) {
    double scale = 1.0 / r->unit;
    bool added = contact_arrays_add(&r->contacts, &r->options, r->last, contacts, scale);
    if (added && r->options.oriented) {
        added = orientation_arrays_add_points(&r->orientations, orientations, scale) &&
                (!is_due(r, r->last) || orientation_arrays_add(&r->orientations, orientations));
    }
    return (added && add_frame(r, r->last + 1, end)) || out_of_memory(error);
}

bool report_add_untangled(report *r, const double *before, const double *after, io_error *error) {
    const uint32_t vertex_count = cscd_mesh_vertex_count(r->options.mesh);
    if (r->kept.count == 0) {
        r->unit = choose_unit(before, vertex_count);
        if (!frame_stream_create(vertex_count, 1.0 / r->unit, &r->frames)) return out_of_memory(error);
    }
    r->last = r->options.first + (uint32_t)r->kept.count;
    r->last_is_kept = true;
    return (keep_interval(r, r->last, before) && frame_stream_add(&r->frames, after)) || out_of_memory(error);
}

bool report_add_answers(report *r, uint32_t frame, const cscd_intersections *found, io_error *error) {
    return answer_arrays_add(&r->answers, &r->options, frame, found, 1.0 / r->unit) || out_of_memory(error);
}

bool report_set_events(report *r, const cscd_event *events, size_t count, report_part_name name, void *user,
                       io_error *error) {
    return event_list_set(&r->events, events, count, name, user) || out_of_memory(error);
}

bool report_keep_last(report *r) {
    if (r->last_is_kept) return true;
    r->last_is_kept = true;
    return keep_interval(r, r->last, r->last_positions);
}

uint32_t report_frame_count(const report *r) {
    return (uint32_t)r->kept.count + (r->last_is_kept ? 0 : 1);
}

uint32_t report_frame(const report *r, uint32_t index) {
    return index < r->kept.count ? ((const uint32_t *)r->kept.data)[index] : r->last;
}

bool report_add_scenery(report *r, const double *positions, io_error *error) {
    bool begun = r->scenery.vertex_count > 0 ||
                 frame_stream_create(r->options.scenery.vertex_count, 1.0 / r->unit, &r->scenery);
    return (begun && frame_stream_add(&r->scenery, positions)) || out_of_memory(error);
}

/* ---- options ------------------------------------------------------------------------------------------- */

bool report_request_agrees(const report_request *r, io_error *error) {
    if (r->path == NULL && (r->scenery_path != NULL || r->scenery_frames_path != NULL))
        return io_fail(error, "--scenery is drawn in a report; say where with --report OUT.html");
    return r->scenery_frames_path == NULL || r->scenery_path != NULL ||
           io_fail(error, "--scenery-frames moves the mesh of --scenery MODEL, which is missing");
}
