/* Reads a mesh and finds which of its triangles intersect. */
#include "src/tool/jobs/mesh_job.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

void mesh_answer_free(mesh_answer *answer) {
    free(answer->error);
    free(answer->unread);
    *answer = (mesh_answer){0};
}

/* How many triangles are in a pair that crosses. */
static bool count_crossing_faces(const cscd_intersection_pairs *found, mesh_answer *out, io_error *error) {
    if (found->crossing == 0) return true;
    unsigned char *crosses = calloc(out->triangle_count, 1);
    if (crosses == NULL) return io_fail(error, "out of memory for %u triangles", out->triangle_count);
    for (size_t i = 0; i < found->count; i++)
        if (found->items[i].kind == CSCD_INTERSECTION_CROSSING)
            crosses[found->items[i].a] = crosses[found->items[i].b] = 1;
    for (uint32_t t = 0; t < out->triangle_count; t++) out->crossing_faces += crosses[t];
    out->crossing_share = (double)out->crossing_faces / out->triangle_count;
    free(crosses);
    return true;
}

/* What was asked ends with a status; CANCELLED is no fault of the mesh. */
static bool call_succeeded(cscd_status status, const recording *r, bool *cancelled, io_error *error) {
    *cancelled = status == CSCD_CANCELLED;
    return status == CSCD_OK || io_fail(error, "%s", cscd_context_detail(r->context));
}

static bool find_pairs(recording *r, cscd_detector *detector, const double *positions, mesh_answer *out,
                       bool *cancelled, io_error *error) {
    cscd_intersection_pairs found;
    const cscd_view *view = CSCD_DOUBLES(positions, out->vertex_count);
    if (!call_succeeded(cscd_detector_find_intersections(detector, view, NULL, &found), r, cancelled, error))
        return false;
    out->crossing = found.crossing;
    out->coplanar = found.coplanar;
    out->folded = found.folded;
    out->duplicate = found.duplicate;
    out->touching = found.touching;
    out->zero_area_triangles = found.zero_area_triangles;
    return count_crossing_faces(&found, out, error);
}

static bool check_mesh(const mesh_job *job, recording *r, mesh_answer *out, bool *cancelled,
                       io_error *error) {
    ignore_pairs ignored = {.mesh = NULL};
    cscd_detector *detector = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    double *positions = malloc((size_t)out->vertex_count * 3 * sizeof *positions);
    bool good = positions != NULL || io_fail(error, "out of memory for %u vertices", out->vertex_count);
    good = good && recorded_object_read(&r->objects[0], 0, positions, error);
    if (ignore_options_any(job->ignored)) {
        good = good && ignore_pairs_prepare(job->ignored, r, &ignored, error);
        if (good) ignore_pairs_choose(&ignored, &options);
    }
    good = good && call_succeeded(cscd_detector_create(r->context, r->mesh, NULL, &options, &detector), r,
                                  cancelled, error);
    good = good && find_pairs(r, detector, positions, out, cancelled, error);
    cscd_detector_destroy(detector);
    ignore_pairs_free(&ignored);
    free(positions);
    return good;
}

const char *mesh_answer_reason(const mesh_answer *answer) {
    return answer->error != NULL ? answer->error : "out of memory";
}

bool mesh_job_run(const mesh_job *job, cscd_context *context, mesh_answer *out) {
    const recording_options source = {.model_path = job->path, .weld = job->weld, .context = context};
    mesh_answer answer = {.checked = false};
    io_error error = {""};
    recording r;
    bool cancelled = false;
    const double start = now_ms();
    const bool opened = recording_open(&source, &r, &error);
    answer.read_ms = now_ms() - start;
    if (opened) {
        answer.triangle_count = cscd_mesh_triangle_count(r.mesh);
        answer.vertex_count = cscd_mesh_vertex_count(r.mesh);
        answer.repairs = r.objects[0].file.repairs;
        answer.unread = r.objects[0].file.unread;
        r.objects[0].file.unread = NULL;
        answer.checked = check_mesh(job, &r, &answer, &cancelled, &error);
        answer.check_ms = now_ms() - start - answer.read_ms;
        recording_close(&r);
    }
    if (answer.checked) {
        *out = answer;
        return true;
    }
    mesh_answer_free(&answer);
    if (!cancelled) *out = (mesh_answer){.error = strdup(error.text)};
    return !cancelled;
}
