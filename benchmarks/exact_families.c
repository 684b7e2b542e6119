/* The number of elementary tests that reach exact arithmetic when motions have a structure, and of those that
 * had to. */
#include "benchmarks/lib/options.h"
#include "models/shapes/body.h"
#include "runtime/ccd/ccd.h"
#include "runtime/detector/detector.h"
#include "src/core/timer.h"
#include "src/mesh/predicates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: exact_families [options]\n"
    "\n"
    "Two bodies that pass into each other by motions with a structure: even, along axes, rigid, scaled, mirrored, on\n"
    "grids. Counts the elementary tests of steps by method none, and those that reach exact arithmetic: of features that\n"
    "touch, of features that stay in one plane, whose cubic is 0, and the rest, for which an approximation could have\n"
    "sufficed. ms: of a step, in the mean; the trees are known. --sizes: triangles of a body. --intervals N: scenes of each\n"
    "family, 4 by default.\n";

enum { SCENES = 4, POINTS = 4 };

/* ---- families -------------------------------------------------------------------------------------------- */

typedef enum family_shape { SHAPE_SPHERE, SHAPE_SHEET, SHAPE_BOX } family_shape;

typedef enum family_motion {
    MOTION_STILL,
    MOTION_UP,      /* along z */
    MOTION_ACROSS,  /* along no axis */
    MOTION_TURN_Z,  /* about z */
    MOTION_TURN,    /* about no axis */
    MOTION_GROW,    /* to 1.2 times the size */
    MOTION_SQUASH,  /* z alone */
    MOTION_WAVES,   /* along z, by a function of z: rings that are level stay so */
    MOTION_MIRRORED /* as the other body, in the mirror x = 0 */
} family_motion;

typedef struct motion_family {
    const char *name;
    family_shape shapes[2];
    family_motion motions[2];
    double offset[3]; /* of the second body */
    bool mirrored;    /* the second body is the first one in the mirror x = 0, without the offset along x */
} motion_family;

static const motion_family families[] = {
    {"rings move evenly", {SHAPE_SPHERE, SHAPE_SPHERE}, {MOTION_WAVES, MOTION_UP}, {0.3, 0.2, 1.9}, false},
    {"rings, squashed", {SHAPE_SPHERE, SHAPE_SPHERE}, {MOTION_SQUASH, MOTION_SQUASH}, {0.3, 0.2, 1.7}, false},
    {"along an axis", {SHAPE_SPHERE, SHAPE_SPHERE}, {MOTION_STILL, MOTION_UP}, {0.1, 0.2, 2.1}, false},
    {"along no axis", {SHAPE_SPHERE, SHAPE_SPHERE}, {MOTION_STILL, MOTION_ACROSS}, {1.4, 1.2, 0.9}, false},
    {"both alike", {SHAPE_SPHERE, SHAPE_SPHERE}, {MOTION_UP, MOTION_UP}, {0.2, 0.1, 1.9}, false},
    {"turn about an axis",
     {SHAPE_SPHERE, SHAPE_SPHERE},
     {MOTION_STILL, MOTION_TURN_Z},
     {0.2, 0.1, 1.8},
     false},
    {"turn about none", {SHAPE_SPHERE, SHAPE_SPHERE}, {MOTION_TURN, MOTION_TURN}, {0.2, 0.1, 1.8}, false},
    {"grow", {SHAPE_SPHERE, SHAPE_SPHERE}, {MOTION_GROW, MOTION_GROW}, {0.2, 0.1, 2.1}, false},
    {"nothing moves", {SHAPE_SPHERE, SHAPE_SPHERE}, {MOTION_STILL, MOTION_STILL}, {0.2, 0.1, 1.8}, false},
    {"sheet rests on sheet",
     {SHAPE_SHEET, SHAPE_SHEET},
     {MOTION_STILL, MOTION_STILL},
     {0.0, 0.0, 0.0},
     false},
    {"box rests on box", {SHAPE_BOX, SHAPE_BOX}, {MOTION_STILL, MOTION_STILL}, {0.25, 0.25, 1.0}, false},
    {"copies, displaced", {SHAPE_SPHERE, SHAPE_SPHERE}, {MOTION_STILL, MOTION_UP}, {0.0, 0.0, 2.1}, false},
    {"mirror images", {SHAPE_SPHERE, SHAPE_SPHERE}, {MOTION_ACROSS, MOTION_MIRRORED}, {0.0, 0.0, 0.0}, true},
    {"grid on grid", {SHAPE_SHEET, SHAPE_SHEET}, {MOTION_STILL, MOTION_UP}, {0.0, 0.0, 0.1}, false},
    {"grid on grid, shifted",
     {SHAPE_SHEET, SHAPE_SHEET},
     {MOTION_STILL, MOTION_UP},
     {0.01, 0.02, 0.1},
     false},
    {"sheet on a ball", {SHAPE_SPHERE, SHAPE_SHEET}, {MOTION_STILL, MOTION_UP}, {-0.9, -0.9, 1.05}, false},
    {"box on box", {SHAPE_BOX, SHAPE_BOX}, {MOTION_STILL, MOTION_UP}, {0.25, 0.25, 1.05}, false},
    {"box slides on box", {SHAPE_BOX, SHAPE_BOX}, {MOTION_STILL, MOTION_ACROSS}, {0.1, 0.1, 1.05}, false},
    {"box in box, turning", {SHAPE_BOX, SHAPE_BOX}, {MOTION_TURN_Z, MOTION_STILL}, {0.4, 0.3, 0.5}, false},
};

/* A sphere of level rings about the origin. */
static void make_sphere(uint32_t triangle_count, body *out) {
    uint32_t rings = (uint32_t)sqrt(triangle_count / 4.0), columns = 2 * rings;
    double turn = 6.283185307179586;
    uint32_t top = body_add_vertex(out, 0.0, 0.0, 1.0);
    for (uint32_t i = 1; i < rings; i++) {
        double a = 0.5 * turn * i / rings;
        for (uint32_t j = 0; j < columns; j++)
            body_add_vertex(out, sin(a) * cos(turn * j / columns), sin(a) * sin(turn * j / columns), cos(a));
    }
    uint32_t bottom = body_add_vertex(out, 0.0, 0.0, -1.0);
    for (uint32_t j = 0; j < columns; j++) {
        uint32_t next = (j + 1) % columns, last = top + 1 + (rings - 2) * columns;
        body_add_triangle(out, top, top + 1 + j, top + 1 + next);
        body_add_triangle(out, bottom, last + next, last + j);
        for (uint32_t i = 0; i + 2 < rings; i++) {
            uint32_t upper = top + 1 + i * columns, lower = upper + columns;
            body_add_triangle(out, upper + j, lower + j, upper + next);
            body_add_triangle(out, upper + next, lower + j, lower + next);
        }
    }
}

/* Adds a square grid from a corner along two axes; sides of 2^-4 or so are exact. */
static void add_grid(body *out, uint32_t columns, const double from[3], int along, int across, double size) {
    uint32_t first = out->vertex_count;
    for (uint32_t i = 0; i <= columns; i++) {
        for (uint32_t j = 0; j <= columns; j++) {
            double p[3] = {from[0], from[1], from[2]};
            p[along] += size * i / columns;
            p[across] += size * j / columns;
            body_add_vertex(out, p[0], p[1], p[2]);
        }
    }
    for (uint32_t i = 0; i < columns; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            uint32_t at = first + i * (columns + 1) + j, next = at + columns + 1;
            body_add_triangle(out, at, next, next + 1);
            body_add_triangle(out, at, next + 1, at + 1);
        }
    }
}

static uint32_t power_of_two_below(double x) {
    return 1u << (int)floor(log2(x > 1.0 ? x : 1.0));
}

static void make_shape(family_shape shape, uint32_t triangle_count, body *out) {
    static const double origin[3] = {0, 0, 0};
    if (shape == SHAPE_SPHERE) make_sphere(triangle_count, out);
    if (shape == SHAPE_SHEET)
        add_grid(out, power_of_two_below(sqrt(triangle_count / 2.0)), origin, 0, 1, 2.0);
    for (int k = 0; shape == SHAPE_BOX && k < 3; k++) {
        uint32_t columns = power_of_two_below(sqrt(triangle_count / 12.0));
        double far[3] = {0, 0, 0};
        far[k] = 1.0;
        add_grid(out, columns, far, (k + 1) % 3, (k + 2) % 3, 1.0);
        add_grid(out, columns, origin, (k + 2) % 3, (k + 1) % 3, 1.0);
    }
}

/* ---- motions --------------------------------------------------------------------------------------------- */

static void turn_by(double angle, const double axis[3], double p[3]) {
    double c = cos(angle), s = sin(angle), q[3], along = 0.0;
    for (int k = 0; k < 3; k++) along += axis[k] * p[k];
    for (int k = 0; k < 3; k++) {
        int x = (k + 1) % 3, y = (k + 2) % 3;
        q[k] = c * p[k] + s * (axis[x] * p[y] - axis[y] * p[x]) + (1.0 - c) * along * axis[k];
    }
    memcpy(p, q, sizeof q);
}

/* The length of a motion differs from scene to scene. */
static void move_point(family_motion motion, double far, double p[3]) {
    static const double z[3] = {0, 0, 1}, slant[3] = {2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0};
    double turn = motion == MOTION_TURN ? 0.2 * far : 0.3 * far;
    if (motion == MOTION_UP) p[2] -= 0.4 * far;
    for (int k = 0; motion == MOTION_ACROSS && k < 3; k++) p[k] -= 0.4 * far * slant[k];
    if (motion == MOTION_TURN_Z || motion == MOTION_TURN) turn_by(turn, motion == MOTION_TURN ? slant : z, p);
    for (int k = 0; motion == MOTION_GROW && k < 3; k++) p[k] *= 1.0 + 0.2 * far;
    if (motion == MOTION_SQUASH) p[2] *= 1.0 - 0.3 * far;
    if (motion == MOTION_WAVES) p[2] += 0.3 * far * sin(3.0 * p[2]);
}

/* Multiples of 2^-26, so that 2 x0 - x1 and 2 x1 - x0 are exact, by which is_always_flat knows the cubic. */
static double round_coordinate(double x) {
    return nearbyint(x * 0x1p26) * 0x1p-26;
}

/* Both bodies in one mesh. */
typedef struct family_scene {
    body whole;
    double *ends[2];
} family_scene;

static void place_vertex(const motion_family *f, int object, double far, const double at[3], double *start,
                         double *end) {
    bool mirrored = object == 1 && f->mirrored;
    double p[3] = {at[0], at[1], at[2]};
    if (f->mirrored) p[0] += 1.05;
    for (int k = 0; object == 1 && !mirrored && k < 3; k++) p[k] += f->offset[k];
    double q[3] = {p[0], p[1], p[2]};
    move_point(mirrored ? f->motions[0] : f->motions[object], far, q);
    for (int k = 0; k < 3; k++) {
        double sign = mirrored && k == 0 ? -1.0 : 1.0;
        start[k] = sign * round_coordinate(p[k]);
        end[k] = sign * round_coordinate(q[k]);
    }
}

static void make_scene(const motion_family *f, uint32_t triangle_count, double far, family_scene *out) {
    static const double nowhere[3] = {0, 0, 0};
    *out = (family_scene){.ends = {NULL, NULL}};
    uint32_t first[3] = {0, 0, 0};
    for (int i = 0; i < 2; i++) {
        body b = {0};
        make_shape(f->shapes[i], triangle_count, &b);
        body_append(&out->whole, &b, nowhere);
        body_free(&b);
        first[i + 1] = out->whole.vertex_count;
    }
    for (int e = 0; e < 2; e++) out->ends[e] = body_allocate(out->whole.vertex_count, sizeof(double[3]));
    for (int i = 0; i < 2; i++) {
        for (uint32_t v = first[i]; v < first[i + 1]; v++)
            place_vertex(f, i, far, out->whole.positions + (size_t)v * 3, out->ends[0] + (size_t)v * 3,
                         out->ends[1] + (size_t)v * 3);
    }
}

static void free_scene(family_scene *s) {
    body_free(&s->whole);
    for (int e = 0; e < 2; e++) free(s->ends[e]);
}

/* ---- counting -------------------------------------------------------------------------------------------- */

typedef struct exact_tally {
    uint64_t tests, exact;         /* of steps */
    uint64_t touching, flat, rest; /* of those that reach exact arithmetic */
    double ms;                     /* of all steps */
} exact_tally;

/* Is the cubic, which has degree 3, 0 at four moments? */
static bool is_always_flat(const elementary_query *q) {
    static const double moments[POINTS][2] = {{1, 0}, {0, 1}, {2, -1}, {-1, 2}};
    for (int m = 0; m < POINTS; m++) {
        double x[POINTS][3];
        for (int i = 0; i < POINTS; i++)
            for (int k = 0; k < 3; k++) x[i][k] = moments[m][0] * q->x0[i][k] + moments[m][1] * q->x1[i][k];
        if (orient3d(x[0], x[1], x[2], x[3]) != 0) return false;
    }
    return true;
}

/* Decides one pair again, which the step has decided before. */
static void count_pair(const family_scene *s, const cscd_mesh *mesh, cscd_contact_kind kind,
                       const uint32_t pair[2], exact_tally *sum) {
    elementary_query query;
    elementary_contact contact;
    uint32_t vertices[POINTS];
    bool vf = kind == CSCD_CONTACT_VF;
    if (vf) {
        vertices[0] = pair[0];
        cscd_mesh_triangle(mesh, pair[1], vertices + 1);
    } else {
        cscd_mesh_edge(mesh, pair[0], vertices);
        cscd_mesh_edge(mesh, pair[1], vertices + 2);
    }
    for (int i = 0; i < POINTS; i++) {
        memcpy(query.x0[i], s->ends[0] + (size_t)vertices[i] * 3, sizeof query.x0[i]);
        memcpy(query.x1[i], s->ends[1] + (size_t)vertices[i] * 3, sizeof query.x1[i]);
    }
    elementary_verdict verdict = elementary_after_signs(&query, kind, &contact);
    if (verdict.level != ELEMENTARY_EXACT) return;
    sum->touching += verdict.touching;
    sum->flat += !verdict.touching && is_always_flat(&query);
    sum->rest += !verdict.touching && !is_always_flat(&query);
}

static cscd_status count_scene(cscd_context *context, const family_scene *s, exact_tally *sum) {
    const body *b = &s->whole;
    const cscd_object_desc object =
        cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_NONE;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    cscd_contacts contacts;
    candidates found = {{{NULL, 0, 0}, {NULL, 0, 0}}};
    cscd_status status = cscd_mesh_create(context, &object, 1, &mesh);
    if (status == CSCD_OK) status = cscd_detector_create(context, mesh, NULL, &options, &detector);
    for (int turn = 0; status == CSCD_OK && turn < 2; turn++) { /* the first one builds the trees */
        double now = timer_now_ms(), took = 0.0;
        status = cscd_detector_step(detector, CSCD_DOUBLES(s->ends[0], b->vertex_count),
                                    CSCD_DOUBLES(s->ends[1], b->vertex_count), &contacts);
        timer_lap(&now, &took);
        sum->ms += turn == 1 ? took : 0.0;
    }
    if (status == CSCD_OK) {
        cscd_counters counters = cscd_detector_counters(detector);
        sum->tests += counters.tests;
        sum->exact += counters.by_exact;
        const candidate_quest quest = {&detector->space, &detector->rebuild, config_growth(&detector->config),
                                       0.0, 0.0};
        status = candidates_collect(&quest, s->ends[0], s->ends[1], &found);
    }
    for (int kind = 0; status == CSCD_OK && kind < 2; kind++) {
        for (size_t i = 0; i < found.lists[kind].count; i++)
            count_pair(s, mesh, (cscd_contact_kind)kind, found.lists[kind].pairs[i], sum);
    }
    candidates_free(context, &found);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    return status;
}

/* ---- rows ------------------------------------------------------------------------------------------------ */

static void report_family(const motion_family *f, uint32_t triangle_count, double ms, const exact_tally *t,
                          json *out) {
    double share = t->tests > 0 ? 100.0 * (double)t->rest / (double)t->tests : 0.0;
    printf("  %-22s %9u %10llu %8llu %9llu %8llu %8llu %9.3f %% %8.2f\n", f->name, triangle_count,
           (unsigned long long)t->tests, (unsigned long long)t->exact, (unsigned long long)t->touching,
           (unsigned long long)t->flat, (unsigned long long)t->rest, share, ms);
    fflush(stdout);
    if (out->file == NULL) return;
    json_begin_object(out, NULL);
    json_string(out, "family", f->name);
    json_integer(out, "triangles", triangle_count);
    json_integer(out, "tests", t->tests);
    json_integer(out, "exact", t->exact);
    json_integer(out, "touching", t->touching);
    json_integer(out, "flat", t->flat);
    json_integer(out, "rest", t->rest);
    json_number(out, "ms", ms);
    json_end_object(out);
}

static bool run_families(const bench_options *o, json *out, io_error *error) {
    uint32_t scenes = o->interval_count > 0 ? o->interval_count : SCENES;
    cscd_context *context = NULL;
    if (cscd_context_create(NULL, &context) != CSCD_OK) return io_fail(error, "out of memory");
    cscd_status status = CSCD_OK;
    printf("  %-22s %9s %10s %8s %9s %8s %8s %11s %8s\n", "family", "triangles", "tests", "exact", "touching",
           "flat", "rest", "rest/tests", "ms");
    for (uint32_t k = 0; k < o->size_count; k++) {
        for (size_t i = 0; status == CSCD_OK && i < sizeof families / sizeof *families; i++) {
            exact_tally sum = {0};
            uint32_t triangles = 0;
            for (uint32_t n = 0; status == CSCD_OK && n < scenes; n++) {
                family_scene s;
                make_scene(&families[i], o->sizes[k], (n + 1.0) / scenes, &s);
                triangles = s.whole.triangle_count;
                status = count_scene(context, &s, &sum);
                free_scene(&s);
            }
            if (status == CSCD_OK) report_family(&families[i], triangles, sum.ms / scenes, &sum, out);
        }
    }
    if (status != CSCD_OK) io_fail(error, "%s", cscd_context_detail(context));
    cscd_context_destroy(context);
    return status == CSCD_OK;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {4000, 60000};
    static const bench_program program = {"exact_families", help, sizes, 2, 1, run_families};
    return bench_main(&program, argument_count, arguments);
}
