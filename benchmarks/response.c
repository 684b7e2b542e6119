/* What is left of the motion that a solver wants, and what it costs, by each way to keep it free of contact. */
#include "benchmarks/lib/options.h"
#include "benchmarks/lib/response_scenes.h"
#include "models/common/scene_program.h"
#include "models/common/vec3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { FRAMES = 180 };

typedef enum driver {
    DRIVE_NONE,
    DRIVE_MAX_STEP,
    DRIVE_RESPOND,
    DRIVE_TRUNCATE,
    DRIVE_SAFE,
    DRIVER_COUNT
} driver;

static const char *const driver_names[DRIVER_COUNT] = {"none", "max_step", "respond", "truncate",
                                                       "make_safe"};

static const char help[] =
    "usage: response [options]\n"
    "\n"
    "Moves each scene, and the first one in further sizes but for truncate, by each driver for 180 frames: none; max_step;\n"
    "four rounds in which contacts are pushed apart, then max_step; cscd_detector_truncate; cscd_detector_make_safe.\n"
    "Crossing: frames in which something touches. Frozen: frames in which vertices made less than a hundredth of their\n"
    "ways in the mean. Late: frames by which what has a given motion is behind. Share: the mean of what vertices made of\n"
    "their ways, along them.\n"
    "\n";

typedef struct response_trial {
    response_scene *scene;
    cscd_mesh *mesh;
    cscd_detector *detector, *judge;
    double *reached;
    double separation;
} response_trial;

typedef struct driver_tally {
    double ms, worst_ms, shares, least, response[CSCD_RESPONSE_COUNT];
    uint32_t crossing, frozen, frames;
    uint64_t pushed, rounds;
    double late; /* frames by which what has a given motion is late */
} driver_tally;

/* The time of this process: others beside it do not count. */
static double cpu_now_ms(void) {
    return 1e3 * (double)clock() / CLOCKS_PER_SEC;
}

static double surviving_share(const response_scene *s, const double *reached, double *least) {
    double sum = 0.0;
    uint32_t count = 0;
    *least = 1.0;
    for (size_t v = 0; v < s->free_count; v++) {
        double wanted[3], made[3];
        vec3_subtract(s->target + 3 * v, s->x + 3 * v, wanted);
        vec3_subtract(reached + 3 * v, s->x + 3 * v, made);
        double squared = vec3_dot(wanted, wanted);
        if (!(squared > 0.0)) continue;
        double share = fmax(0.0, fmin(vec3_dot(made, wanted) / squared, 1.0));
        sum += share;
        count++;
        *least = fmin(*least, share);
    }
    return count > 0 ? sum / count : 1.0;
}

static double longest_motion(const response_scene *s) {
    double longest = 0.0;
    for (size_t v = 0; v < s->vertex_count; v++) {
        double way[3];
        vec3_subtract(s->target + 3 * v, s->x + 3 * v, way);
        longest = fmax(longest, vec3_norm(way));
    }
    return longest;
}

/* The response of docs/solver/first-contact.md as it was before cscd_detector_make_safe. */
static void push_apart(const response_trial *t, const cscd_contact *c, double *x) {
    double weights[4], gap = 0.0, mobility = 0.0;
    cscd_stencil_weights(c->kind, c->u, c->v, weights);
    for (int i = 0; i < 4; i++) {
        gap += weights[i] * vec3_dot(c->normal, x + 3 * (size_t)c->vertices[i]);
        mobility += t->scene->inverse_masses[c->vertices[i]] * weights[i] * weights[i];
    }
    double push = mobility > 0.0 && gap < 2.0 * t->separation ? (2.0 * t->separation - gap) / mobility : 0.0;
    for (int i = 0; i < 4; i++)
        vec3_add_scaled(x + 3 * (size_t)c->vertices[i],
                        push * weights[i] * t->scene->inverse_masses[c->vertices[i]], c->normal);
}

/* Four rounds of pushing, and the longest step from there. */
static cscd_status respond_and_step(response_trial *t, int rounds, double *obstacle_share) {
    response_scene *s = t->scene;
    const cscd_view *x0 = CSCD_DOUBLES(s->x, s->vertex_count),
                    *x1 = CSCD_DOUBLES(t->reached, s->vertex_count);
    cscd_free_step step = {.fraction = 1.0};
    for (int round = 0; round < rounds; round++) {
        cscd_contacts found;
        cscd_status status = cscd_detector_step(t->detector, x0, x1, &found);
        if (status != CSCD_OK) return status;
        if (found.count == 0) break;
        for (size_t i = 0; i < found.count; i++) push_apart(t, &found.items[i], t->reached);
    }
    cscd_status status =
        cscd_detector_max_step(t->detector, x0, x1, CSCD_MUTABLE_DOUBLES(t->reached, s->vertex_count), &step);
    *obstacle_share = step.fraction;
    return status;
}

static cscd_status truncate_to(response_trial *t, double radius, double *obstacle_share) {
    response_scene *s = t->scene;
    cscd_truncation cut;
    cscd_status status = cscd_detector_truncate(t->detector, CSCD_DOUBLES(s->x, s->vertex_count),
                                                CSCD_DOUBLES(t->reached, s->vertex_count), radius,
                                                CSCD_MUTABLE_DOUBLES(t->reached, s->vertex_count), &cut);
    if (status == CSCD_OK) *obstacle_share = cut.obstacle_fraction;
    return status;
}

/* Obstacles that cannot get through go back as a whole, and all others have their way once more. */
static cscd_status truncate_motion(response_trial *t, double *obstacle_share) {
    response_scene *s = t->scene;
    size_t size = 3 * (size_t)s->vertex_count;
    double radius = 2.0001 * longest_motion(s);
    if (radius == 0.0) return CSCD_OK;
    cscd_status status = truncate_to(t, radius, obstacle_share);
    if (status != CSCD_OK || *obstacle_share == 1.0) return status;
    const double share = *obstacle_share * (1.0 - 1e-9);
    memcpy(t->reached, s->target, size * sizeof *t->reached);
    for (size_t i = 3 * (size_t)s->free_count; i < size; i++)
        t->reached[i] = s->x[i] + share * (s->target[i] - s->x[i]);
    status = truncate_to(t, radius, obstacle_share);
    *obstacle_share = share;
    return status;
}

static cscd_status make_safe(response_trial *t, double *obstacle_share, driver_tally *sum) {
    response_scene *s = t->scene;
    double friction[RESPONSE_OBJECTS_MAX];
    for (int i = 0; i < RESPONSE_OBJECTS_MAX; i++) friction[i] = s->friction;
    cscd_response_options options = cscd_response_defaults();
    options.inverse_masses = s->inverse_masses;
    options.friction = friction;
    cscd_safe_motion safe;
    cscd_status status = cscd_detector_make_safe(t->detector, CSCD_DOUBLES(s->x, s->vertex_count),
                                                 CSCD_DOUBLES(s->target, s->vertex_count), &options,
                                                 CSCD_MUTABLE_DOUBLES(t->reached, s->vertex_count), &safe);
    if (status != CSCD_OK) return status;
    *obstacle_share = safe.obstacle_share;
    sum->pushed += safe.pushed;
    sum->rounds += safe.rounds;
    for (int i = 0; i < CSCD_RESPONSE_COUNT; i++)
        sum->response[i] += (double)safe.response_counts[i] / s->vertex_count;
    return CSCD_OK;
}

static cscd_status drive_motion(response_trial *t, driver by, double *obstacle_share, driver_tally *sum) {
    *obstacle_share = 1.0;
    memcpy(t->reached, t->scene->target, 3 * (size_t)t->scene->vertex_count * sizeof(double));
    switch (by) {
    case DRIVE_MAX_STEP:
        return respond_and_step(t, 0, obstacle_share);
    case DRIVE_RESPOND:
        return respond_and_step(t, 4, obstacle_share);
    case DRIVE_TRUNCATE:
        return truncate_motion(t, obstacle_share);
    case DRIVE_SAFE:
        return make_safe(t, obstacle_share, sum);
    default:
        return CSCD_OK;
    }
}

static cscd_status run_frame(response_trial *t, driver by, driver_tally *sum) {
    response_scene *s = t->scene;
    double obstacle_share, least, begin;
    cscd_contacts found;
    response_scene_aim(s);
    begin = cpu_now_ms();
    cscd_status status = drive_motion(t, by, &obstacle_share, sum);
    double ms = cpu_now_ms() - begin;
    if (status != CSCD_OK) return status;
    sum->ms += ms;
    sum->worst_ms = fmax(sum->worst_ms, ms);
    double share = surviving_share(s, t->reached, &least);
    sum->shares += share;
    sum->least = fmin(sum->least, share);
    sum->frozen += share < 0.01;
    sum->late += 1.0 - obstacle_share;
    status = cscd_detector_step(t->judge, CSCD_DOUBLES(s->x, s->vertex_count),
                                CSCD_DOUBLES(t->reached, s->vertex_count), &found);
    if (status != CSCD_OK) return status;
    sum->crossing += found.count > 0;
    sum->frames++;
    response_scene_take(s, t->reached, obstacle_share);
    return CSCD_OK;
}

static cscd_status open_trial(response_scene *s, cscd_context *context, response_trial *t) {
    cscd_object_desc objects[RESPONSE_OBJECTS_MAX];
    *t = (response_trial){.scene = s, .separation = 0.05 * s->spacing};
    for (uint32_t o = 0; o < s->object_count; o++) {
        objects[o] = cscd_object_of_triangles(s->objects[o].vertex_count, s->objects[o].triangle_count,
                                              s->objects[o].triangles);
        objects[o].obstacle = o >= s->free_object_count;
    }
    cscd_status status = cscd_mesh_create(context, objects, s->object_count, &t->mesh);
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = s->seams;
    options.seam_count = s->seam_count;
    if (status == CSCD_OK) status = cscd_detector_create(context, t->mesh, NULL, &options, &t->judge);
    options.min_separation = t->separation;
    if (status == CSCD_OK) status = cscd_detector_create(context, t->mesh, NULL, &options, &t->detector);
    t->reached = body_allocate(3 * (size_t)s->vertex_count, sizeof(double));
    return status;
}

static void close_trial(response_trial *t) {
    free(t->reached);
    cscd_detector_destroy(t->detector);
    cscd_detector_destroy(t->judge);
    cscd_mesh_destroy(t->mesh);
}

/* The shares of vertices by what they needed. */
static void report_responses(const driver_tally *sum, json *out) {
    static const char *const names[CSCD_RESPONSE_COUNT] = {"free", "stopped", "truncated", "held"};
    for (int i = 0; i < CSCD_RESPONSE_COUNT; i++) json_number(out, names[i], sum->response[i] / FRAMES);
    json_number(out, "pushed", (double)sum->pushed / FRAMES);
    json_number(out, "rounds", (double)sum->rounds / FRAMES);
}

static void report_trial(response_kind kind, const response_scene *s, driver by, const driver_tally *sum,
                         json *out) {
    printf("%-8s %9u %-10s %8u %7u %7.3f %7.3f %6.1f %9.2f %9.2f\n", response_kind_name(kind),
           s->triangle_count, driver_names[by], sum->crossing, sum->frozen, sum->shares / FRAMES, sum->least,
           sum->late, sum->ms / FRAMES, sum->worst_ms);
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "scene", response_kind_name(kind));
    json_integer(out, "triangles", s->triangle_count);
    json_string(out, "driver", driver_names[by]);
    json_integer(out, "frames", FRAMES);
    json_integer(out, "crossing", sum->crossing);
    json_integer(out, "frozen", sum->frozen);
    json_number(out, "mean_share", sum->shares / FRAMES);
    json_number(out, "least_share", sum->least);
    json_number(out, "late", sum->late);
    json_number(out, "ms", sum->ms / FRAMES);
    json_number(out, "worst_ms", sum->worst_ms);
    if (by == DRIVE_SAFE) report_responses(sum, out);
    json_end_object(out);
}

static bool run_trial(response_kind kind, uint32_t triangle_count, driver by, cscd_context *context,
                      json *out, io_error *error) {
    response_scene scene;
    response_trial t;
    driver_tally sum = {.least = 1.0};
    if (!response_scene_make(kind, triangle_count, &scene, error)) return false;
    cscd_status status = open_trial(&scene, context, &t);
    for (int frame = 0; status == CSCD_OK && frame < FRAMES; frame++) status = run_frame(&t, by, &sum);
    bool good = status == CSCD_OK;
    if (good)
        report_trial(kind, &scene, by, &sum, out);
    else
        io_fail(error, "%s by %s, frame %u: %s: %s", response_kind_name(kind), driver_names[by], sum.frames,
                cscd_status_string(status), cscd_context_detail(context));
    close_trial(&t);
    response_scene_free(&scene);
    return good;
}

static bool run_all(const bench_options *o, json *out, io_error *error) {
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = o->thread_count;
    cscd_context *context = NULL;
    if (cscd_context_create(&options, &context) != CSCD_OK) return io_fail(error, "no context");
    printf("scene   triangles driver     crossing  frozen   share   least   late        ms     worst\n");
    bool good = true;
    for (uint32_t i = 0; good && i < o->size_count * RESPONSE_KIND_COUNT * DRIVER_COUNT; i++) {
        uint32_t size = i / DRIVER_COUNT / RESPONSE_KIND_COUNT;
        uint32_t kind = i / DRIVER_COUNT % RESPONSE_KIND_COUNT, by = i % DRIVER_COUNT;
        if (size > 0 && (kind != RESPONSE_TWIST || by == DRIVE_TRUNCATE)) continue;
        good = run_trial((response_kind)kind, o->sizes[size], (driver)by, context, out, error);
    }
    cscd_context_destroy(context);
    return good;
}

int main(int argument_count, char **arguments) {
    setvbuf(stdout, NULL, _IOLBF, 0);
    static const uint32_t sizes[] = {3042, 100352};
    static const bench_program program = {"response", help, sizes, 2, 1, run_all};
    return bench_main(&program, argument_count, arguments);
}
