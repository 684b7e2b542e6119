/* Culling on recordings: pairs and time per stage, by method, for intervals with and without a proven
 * start. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tool/io/animation.h"
#include "tool/io/mesh_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: culling MODEL FRAMES [METHOD...]\n"
    "\n"
    "Replays the recording once per method, one thread: none, single, kmeans:K, charge, published; default none,\n"
    "single, kmeans:4, charge. Mode all; earliest after a '+'. Means per interval, proven: the mesh's only\n"
    "component, or all of them, began embedded for certain.\n";

typedef struct culled_recording {
    cscd_context *context;
    cscd_mesh *mesh;
    mesh_file model;
    animation *frames;
    double *positions[2];
} culled_recording;

/* Sums over the intervals of one kind: with a proven start, or without. */
typedef struct interval_sums {
    double update, orientation, traversal, contact, proof, total;
    double pairs, contacts, lit; /* lit: triangles that are S+ or S- */
    uint32_t intervals, checks;
} interval_sums;

static bool print_failure(const char *text) {
    fprintf(stderr, "culling: %s\n", text);
    return false;
}

static void add_interval(interval_sums *t, const cscd_timings *ms, const cscd_counters *n, size_t contacts) {
    t->update += ms->update_ms;
    t->orientation += ms->orientation_ms;
    t->traversal += ms->traversal_ms;
    t->contact += ms->contact_ms;
    t->proof += ms->proof_ms;
    t->total += ms->total_ms;
    t->pairs += (double)n->pcp;
    t->lit += (double)(n->plus + n->minus);
    t->contacts += (double)contacts;
    t->checks += (uint32_t)n->static_checks;
    t->intervals++;
}

static void print_tally(const char *name, const char *kind, const interval_sums *t, uint32_t triangles) {
    if (t->intervals == 0) return;
    double n = t->intervals;
    printf("%-11s %-8s %9u %9.0f %5.1f %9.1f %7.2f %7.2f %7.2f %7.2f %7.2f %7.2f %6u\n", name, kind,
           t->intervals, t->pairs / n, 100.0 * t->lit / n / triangles, t->contacts / n, t->update / n,
           t->orientation / n, t->traversal / n, t->contact / n, t->proof / n, t->total / n, t->checks);
}

static bool all_proven(const culled_recording *r, const cscd_detector *detector) {
    for (uint32_t c = 0; c < cscd_mesh_component_count(r->mesh); c++) {
        if (!cscd_detector_guarantee(detector, c).start_embedded) return false;
    }
    return true;
}

static bool replay_method(culled_recording *r, cscd_detector *detector, const char *name) {
    interval_sums sums[2] = {{.intervals = 0}, {.intervals = 0}};
    io_error error;
    uint32_t count = animation_frame_count(r->frames);
    for (uint32_t i = 0; i < count; i++) {
        double *start = r->positions[(i + 1) % 2], *end = r->positions[i % 2];
        cscd_contacts found;
        if (!animation_read(r->frames, i, end, &error)) return print_failure(error.text);
        if (i == 0) continue;
        if (cscd_detector_step(detector, CSCD_DOUBLES(start, cscd_mesh_vertex_count(r->mesh)),
                               CSCD_DOUBLES(end, cscd_mesh_vertex_count(r->mesh)), &found) != CSCD_OK)
            return print_failure(cscd_context_detail(r->context));
        cscd_timings ms = cscd_detector_timings(detector);
        cscd_counters n = cscd_detector_counters(detector);
        add_interval(&sums[all_proven(r, detector)], &ms, &n, found.count);
    }
    uint32_t triangles = cscd_mesh_triangle_count(r->mesh);
    print_tally(name, "proven", &sums[1], triangles);
    print_tally(name, "unproven", &sums[0], triangles);
    fflush(stdout);
    return true;
}

/* Parses a name such as "kmeans:4+": method, number of regions, mode earliest. */
static bool parse_method(const char *name, cscd_plan_options *plan, cscd_detector_options *detector) {
    char method[32];
    size_t length = strcspn(name, ":+");
    if (length >= sizeof method) return false;
    memcpy(method, name, length);
    method[length] = '\0';
    if (name[length] == ':') plan->k = (uint32_t)strtoul(name + length + 1, NULL, 10);
    if (strchr(name, '+') != NULL) detector->mode = CSCD_MODE_EARLIEST;
    return cscd_from_name(CSCD_METHODS, method, (uint32_t *)&detector->method);
}

static bool run_method(culled_recording *r, const char *name) {
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    cscd_plan_options plan_options = cscd_plan_defaults();
    cscd_detector_options options = cscd_detector_defaults();
    if (!parse_method(name, &plan_options, &options)) return print_failure("unknown method");
    plan_options.method = options.method == CSCD_METHOD_PUBLISHED ? CSCD_METHOD_SINGLE : options.method;
    cscd_status status = CSCD_OK;
    if (options.method != CSCD_METHOD_NONE)
        status = cscd_plan_create(r->context, r->mesh,
                                  CSCD_DOUBLES(r->model.positions, cscd_mesh_vertex_count(r->mesh)),
                                  &plan_options, &plan);
    if (status == CSCD_OK) status = cscd_detector_create(r->context, r->mesh, plan, &options, &detector);
    bool ran =
        status == CSCD_OK ? replay_method(r, detector, name) : print_failure(cscd_context_detail(r->context));
    cscd_detector_destroy(detector);
    cscd_plan_destroy(plan);
    return ran;
}

static bool open_recording(const char *model, const char *frames, culled_recording *out) {
    io_error error;
    culled_recording r = {0};
    if (!mesh_file_read(model, &r.model, &error)) return print_failure(error.text);
    cscd_object_desc desc =
        cscd_object_of_triangles(r.model.vertex_count, r.model.triangle_count, r.model.triangles);
    bool opened = animation_open(&frames, 1, r.model.vertex_count, NULL, &r.frames, &error) ||
                  print_failure(error.text);
    if (opened && (cscd_context_create(NULL, &r.context) != CSCD_OK ||
                   cscd_mesh_create(r.context, &desc, 1, &r.mesh) != CSCD_OK))
        opened = print_failure("the mesh could not be made");
    for (int i = 0; opened && i < 2; i++) {
        r.positions[i] = malloc((size_t)r.model.vertex_count * sizeof(double[3]));
        opened = r.positions[i] != NULL || print_failure("out of memory");
    }
    *out = r;
    return opened;
}

static void close_recording(culled_recording *r) {
    free(r->positions[0]);
    free(r->positions[1]);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    if (r->frames != NULL) animation_close(r->frames);
    mesh_file_free(&r->model);
}

int main(int argument_count, char **arguments) {
    static const char *const defaults[] = {"none", "single", "kmeans:4", "charge"};
    culled_recording r = {0};
    if (argument_count < 3) {
        fputs(help, stderr);
        return 2;
    }
    bool good = open_recording(arguments[1], arguments[2], &r);
    if (good) {
        printf("%s: %u triangles, %u frames; ms\n", arguments[1], r.model.triangle_count,
               animation_frame_count(r.frames));
        printf("%-11s %-8s %9s %9s %5s %9s %7s %7s %7s %7s %7s %7s %6s\n", "method", "start", "intervals",
               "pairs", "S+- %", "contacts", "update", "orient", "travers", "contact", "proof", "total",
               "checks");
    }
    for (int i = 3; good && i < argument_count; i++) good = run_method(&r, arguments[i]);
    for (int i = 0; good && argument_count == 3 && i < 4; i++) good = run_method(&r, defaults[i]);
    close_recording(&r);
    return good ? 0 : 1;
}
