/* Does method auto find out where culling pays? Beside none and single, on closed scenes, in contact and clear of it. */
#include "benchmarks/lib/made_scenes.h"
#include "benchmarks/lib/options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char help[] =
    "usage: choice [options]\n"
    "\n"
    "Intervals of closed scenes by the methods none, single and auto, which take turns: processor time in ms of all\n"
    "intervals but the first eight, in which auto may learn, and so do trees; the sums of the least time of each\n"
    "interval over the rounds. In 'again' each interval begins at the same place, as in a line search, and in 'on' where\n"
    "the last one has ended. 'still' moves nothing but a hair; 'swell' by a hundredth of the body. Contacts are those of\n"
    "single. --intervals N are measured in each of 5 rounds, 20 by default.\n";

enum { METHODS = 3, ROUNDS = 5, LEARNING = 8, INTERVALS = 20 };

static const cscd_method methods[METHODS] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_AUTO};

/* ---- motions --------------------------------------------------------------------------------------------- */

/* Positions of all objects, at rest and at the other end of the motion. */
typedef struct scene_motion {
    uint32_t vertex_count, triangle_count, object_count;
    cscd_object_desc descriptions[CROSSING_OBJECTS_MAX];
    double *ends[2];
    double *positions[2]; /* of one interval */
} scene_motion;

static void swell_object(const body *b, double share, double *out) {
    double middle[3] = {0, 0, 0};
    for (uint32_t i = 0; i < b->vertex_count * 3; i++) middle[i % 3] += b->positions[i] / b->vertex_count;
    for (uint32_t i = 0; i < b->vertex_count * 3; i++)
        out[i] = b->positions[i] + share * (b->positions[i] - middle[i % 3]);
}

static void make_motion(const crossing_scene *s, double share, scene_motion *m) {
    *m = (scene_motion){.object_count = s->object_count};
    for (uint32_t i = 0; i < s->object_count; i++) {
        const body *b = &s->objects[i];
        m->descriptions[i] = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
        m->vertex_count += b->vertex_count;
        m->triangle_count += b->triangle_count;
    }
    for (int i = 0; i < 2; i++) {
        m->ends[i] = body_allocate(m->vertex_count, sizeof(double[3]));
        m->positions[i] = body_allocate(m->vertex_count, sizeof(double[3]));
    }
    size_t at = 0;
    for (uint32_t i = 0; i < s->object_count; i++) {
        const body *b = &s->objects[i];
        memcpy(m->ends[0] + at, b->positions, b->vertex_count * sizeof(double[3]));
        swell_object(b, share, m->ends[1] + at);
        at += (size_t)b->vertex_count * 3;
    }
}

static void free_motion(scene_motion *m) {
    for (int i = 0; i < 2; i++) {
        free(m->ends[i]);
        free(m->positions[i]);
    }
}

/* Interval i leads to and fro in steps of an eighth; or always from one end to an eighth. */
static void place_interval(const scene_motion *m, uint32_t i, bool again) {
    for (int e = 0; e < 2; e++) {
        uint32_t place = again ? (uint32_t)e : (i + (uint32_t)e) % 16;
        double share = 0.125 * (place <= 8 ? place : 16 - place);
        for (uint32_t k = 0; k < m->vertex_count * 3; k++)
            m->positions[e][k] = m->ends[0][k] + share * (m->ends[1][k] - m->ends[0][k]);
    }
}

/* ---- rounds ---------------------------------------------------------------------------------------------- */

typedef struct choice_times {
    double least[METHODS][INTERVALS_MAX]; /* ms */
    size_t contacts;                      /* of all intervals */
    uint64_t culled;                      /* intervals in which auto has oriented triangles */
} choice_times;

static double processor_ms(void) {
    return (double)clock() * (1e3 / CLOCKS_PER_SEC);
}

static cscd_status run_method(cscd_detector *d, int method, const scene_motion *m, uint32_t intervals,
                              bool again, choice_times *out) {
    cscd_status status = CSCD_OK;
    size_t contacts = 0;
    out->culled = 0;
    for (uint32_t i = 0; status == CSCD_OK && i < intervals + LEARNING; i++) {
        cscd_contacts found;
        place_interval(m, i, again);
        double since = processor_ms();
        status = cscd_detector_step(d, CSCD_DOUBLES(m->positions[0], m->vertex_count),
                                    CSCD_DOUBLES(m->positions[1], m->vertex_count), &found);
        double spent = processor_ms() - since;
        if (status != CSCD_OK || i < LEARNING) continue;
        double *least = &out->least[method][i - LEARNING];
        *least = fmin(*least, spent);
        contacts += found.count;
        out->culled += cscd_detector_counters(d).plus > 0;
    }
    out->contacts = contacts;
    return status;
}

static cscd_status run_rounds(cscd_context *context, const scene_motion *m, uint32_t intervals, bool again,
                              choice_times *out) {
    cscd_mesh *mesh = NULL;
    cscd_status status = cscd_mesh_create(context, m->descriptions, m->object_count, &mesh);
    for (int k = 0; k < METHODS; k++)
        for (uint32_t i = 0; i < intervals; i++) out->least[k][i] = HUGE_VAL;
    for (int i = 0; status == CSCD_OK && i < ROUNDS * METHODS; i++) {
        cscd_detector *detector = NULL;
        cscd_detector_options options = cscd_detector_defaults();
        options.method = methods[i % METHODS];
        status = cscd_detector_create(context, mesh, NULL, &options, &detector);
        if (status == CSCD_OK) status = run_method(detector, i % METHODS, m, intervals, again, out);
        cscd_detector_destroy(detector);
    }
    cscd_mesh_destroy(mesh);
    return status;
}

/* ---- rows ------------------------------------------------------------------------------------------------ */

static void report_row(const char *scene, const char *motion, const scene_motion *m, uint32_t intervals,
                       const choice_times *t, json *out) {
    double ms[METHODS] = {0, 0, 0};
    for (int k = 0; k < METHODS; k++)
        for (uint32_t i = 0; i < intervals; i++) ms[k] += t->least[k][i] / intervals;
    double ratio = ms[2] / fmin(ms[0], ms[1]);
    printf("  %-9s %-11s %9u %10.1f %9.3f %9.3f %9.3f %10.0f %% %8.2f\n", scene, motion, m->triangle_count,
           (double)t->contacts / intervals, ms[0], ms[1], ms[2], 100.0 * (double)t->culled / intervals,
           ratio);
    fflush(stdout);
    if (out->file == NULL) return;
    json_begin_object(out, NULL);
    json_string(out, "scene", scene);
    json_string(out, "motion", motion);
    json_integer(out, "triangles", m->triangle_count);
    json_integer(out, "contacts", t->contacts);
    for (int k = 0; k < METHODS; k++) json_number(out, cscd_method_name(methods[k]), ms[k]);
    json_number(out, "ratio", ratio);
    json_end_object(out);
}

static bool measure_scene(cscd_context *context, crossing_kind kind, uint32_t triangle_count,
                          const bench_options *o, json *out, io_error *error) {
    static const struct {
        const char *name;
        double share;
        bool again;
    } motions[] = {{"still on", 1e-6, false}, {"swell on", 0.01, false}, {"swell again", 0.01, true}};
    uint32_t intervals = o->interval_count > 0 ? o->interval_count : INTERVALS;
    crossing_scene s;
    cscd_status status = CSCD_OK;
    if (!crossing_scene_make(kind, triangle_count, &s, error)) return false;
    for (size_t i = 0; status == CSCD_OK && i < sizeof motions / sizeof *motions; i++) {
        scene_motion m;
        choice_times times;
        make_motion(&s, motions[i].share, &m);
        status = run_rounds(context, &m, intervals, motions[i].again, &times);
        if (status == CSCD_OK) report_row(s.name, motions[i].name, &m, intervals, &times, out);
        free_motion(&m);
    }
    crossing_scene_free(&s);
    return status == CSCD_OK || io_fail(error, "%s", cscd_context_detail(context));
}

static bool run_scenes(const bench_options *o, json *out, io_error *error) {
    static const crossing_kind kinds[] = {CROSSING_CLEAN, CROSSING_FIGURE, CROSSING_KNOT, CROSSING_SPHERES,
                                          CROSSING_SCAN};
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = o->thread_count;
    options.simd = o->simd;
    if (cscd_context_create(&options, &context) != CSCD_OK) return io_fail(error, "out of memory");
    printf("  %-9s %-11s %9s %10s %9s %9s %9s %12s %8s\n", "scene", "motion", "triangles", "contacts", "none",
           "single", "auto", "auto culls", "auto/best");
    bool good = true;
    for (size_t i = 0; good && i < sizeof kinds / sizeof *kinds; i++) {
        for (uint32_t k = 0; good && k < o->size_count; k++)
            good = measure_scene(context, kinds[i], o->sizes[k], o, out, error);
    }
    cscd_context_destroy(context);
    return good;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {20000, 100000};
    static const bench_program program = {"choice", help, sizes, 2, 1, run_scenes};
    return bench_main(&program, argument_count, arguments);
}
