/* The growth of time, work and memory on shapes that tempt a search to compare everything with everything: a
 * table, with exponents. */
#include "cscd/cscd.h"
#include "models/shapes/extreme_shapes.h"
#include "src/core/system.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char help[] =
    "usage: extremes [--sizes N,N,...] [--limit SECONDS] [--only COMMAND] [SHAPE...]\n"
    "\n"
    "Makes shapes of very many triangles at one vertex or edge, needles, and sheets that almost touch, in three sizes\n"
    "(default 4,000, 16,000 and 64,000 triangles), and runs four commands on each: a plan by charge, a check, a step\n"
    "and a largest step. Of each it prints seconds of processor time, the most memory that was held at a time beside\n"
    "the mesh, what was found (intersections, contacts), and the work of a step: pairs of volumes that were compared,\n"
    "and pairs of features that were tested. Below stand exponents, from the first size to the last: 1 if the number\n"
    "grows with triangles and what was found, 2 with their square. Memory and work are the same in every run.\n"
    "\n"
    "  --sizes N,N,...  two to eight sizes, ascending\n"
    "  --limit SECONDS  larger sizes are left out once a command took so long (default 20)\n"
    "  --only COMMAND   plan, check, step or max_step\n"
    "  SHAPE            fan, cylinder, bipyramid, comb, needles, book, slivers, spire, sheets, pile\n";

enum { SIZES_MOST = 8, ROUNDS = 2 };

typedef enum extreme_command { PLAN, CHECK, STEP, MAX_STEP, COMMANDS } extreme_command;

static const char *const command_names[COMMANDS] = {"plan", "check", "step", "max_step"};

typedef struct extremes_options {
    uint32_t sizes[SIZES_MOST], size_count;
    double limit; /* seconds */
    bool commands[COMMANDS], kinds[EXTREME_KINDS];
} extremes_options;

/* The cost of a command on one shape. */
typedef struct extreme_cost {
    double triangles, found;
    double seconds, bytes;
    double boxes, tests; /* of steps */
} extreme_cost;

/* ---- memory ---------------------------------------------------------------------------------------------- */

typedef struct byte_count {
    size_t now, most;
} byte_count;

static void *allocate_counted(void *user, size_t size, size_t alignment) {
    byte_count *bytes = user;
    void *block = system_memory(size, alignment);
    if (block != NULL) bytes->now += size;
    if (bytes->now > bytes->most) bytes->most = bytes->now;
    return block;
}

static void release_counted(void *user, void *block, size_t size) {
    byte_count *bytes = user;
    bytes->now -= size;
    system_memory_free(block);
}

/* ---- commands -------------------------------------------------------------------------------------------- */

typedef struct extreme_subject {
    const extreme_shape *shape;
    cscd_context *context;
    cscd_mesh *mesh;
    byte_count bytes;
} extreme_subject;

static cscd_status run_plan(const extreme_subject *s) {
    cscd_plan *plan = NULL;
    const cscd_status status = cscd_plan_create(
        s->context, s->mesh, CSCD_DOUBLES(s->shape->x0, s->shape->vertex_count), NULL, &plan);
    cscd_plan_destroy(plan);
    return status;
}

/* A largest step from a start that touches is refused, which takes the search all the same. */
static cscd_status ask_detector(const extreme_subject *s, extreme_command c, cscd_detector *detector,
                                extreme_cost *out) {
    const uint32_t count = s->shape->vertex_count;
    cscd_intersections crossings = {.count = 0};
    cscd_contacts contacts = {.count = 0};
    cscd_free_step step;
    cscd_status status;
    if (c == CHECK)
        status = cscd_detector_check(detector, CSCD_DOUBLES(s->shape->x0, count), &crossings);
    else if (c == STEP)
        status = cscd_detector_step(detector, CSCD_DOUBLES(s->shape->x0, count),
                                    CSCD_DOUBLES(s->shape->x1, count), &contacts);
    else
        status = cscd_detector_max_step(detector, CSCD_DOUBLES(s->shape->x0, count),
                                        CSCD_DOUBLES(s->shape->x1, count), NULL, &step);
    out->found = (double)(crossings.count + contacts.count);
    const cscd_counters counters = cscd_detector_counters(detector);
    out->boxes = (double)counters.boxes_tested;
    out->tests = (double)counters.tests;
    return c == MAX_STEP && status == CSCD_IN_CONTACT ? CSCD_OK : status;
}

static cscd_status run_detector(const extreme_subject *s, extreme_command c, extreme_cost *out) {
    cscd_detector *detector = NULL;
    cscd_status status = cscd_detector_create(s->context, s->mesh, NULL, NULL, &detector);
    if (status == CSCD_OK) status = ask_detector(s, c, detector, out);
    cscd_detector_destroy(detector);
    return status;
}

static cscd_status run_command(extreme_subject *s, extreme_command c, extreme_cost *out) {
    cscd_status status = CSCD_OK;
    out->triangles = s->shape->triangle_count;
    out->seconds = INFINITY;
    for (int round = 0; status == CSCD_OK && round < ROUNDS; round++) {
        const size_t before = s->bytes.most = s->bytes.now;
        const clock_t begin = clock();
        status = c == PLAN ? run_plan(s) : run_detector(s, c, out);
        out->seconds = fmin(out->seconds, (double)(clock() - begin) / CLOCKS_PER_SEC);
        out->bytes = (double)(s->bytes.most - before);
        if (out->seconds > 2.0) break; /* it is not noise */
    }
    if (status != CSCD_OK)
        fprintf(stderr, "extremes: %s: %s\n", command_names[c], cscd_context_detail(s->context));
    return status;
}

static cscd_status measure_shape(const extreme_shape *shape, extreme_command c, extreme_cost *out) {
    extreme_subject s = {.shape = shape};
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = 1;
    options.allocator = (cscd_allocator){allocate_counted, release_counted, &s.bytes};
    cscd_status status = cscd_context_create(&options, &s.context);
    const cscd_object_desc object =
        cscd_object_of_triangles(shape->vertex_count, shape->triangle_count, shape->triangles);
    if (status == CSCD_OK) status = cscd_mesh_create(s.context, &object, 1, &s.mesh);
    if (status == CSCD_OK) status = run_command(&s, c, out);
    cscd_mesh_destroy(s.mesh);
    cscd_context_destroy(s.context);
    return status;
}

/* ---- the table ------------------------------------------------------------------------------------------- */

static void print_row(const char *kind, const char *name, const extreme_cost *c) {
    printf("  %-10s %-9s %9.0f %8.0f %9.3f %9.1f %12.0f %12.0f\n", kind, name, c->triangles, c->found,
           c->seconds, c->bytes / 1e6, c->boxes, c->tests);
    fflush(stdout);
}

static double exponent_of(double first, double last, double growth) {
    return first > 0.0 && last > 0.0 ? log(last / first) / log(growth) : 0.0;
}

static void print_exponents(const char *kind, const char *name, const extreme_cost *first,
                            const extreme_cost *last) {
    const double growth = (last->triangles + last->found) / (first->triangles + first->found);
    printf("  %-10s %-9s %9s %8s %9.2f %9.2f %12.2f %12.2f\n", kind, name, "exponent", "",
           exponent_of(first->seconds, last->seconds, growth), exponent_of(first->bytes, last->bytes, growth),
           exponent_of(first->boxes, last->boxes, growth), exponent_of(first->tests, last->tests, growth));
}

static bool measure_kind(const extremes_options *o, extreme_kind kind, extreme_command c) {
    extreme_cost costs[SIZES_MOST];
    const char *kind_name = extreme_kind_name(kind), *name = command_names[c];
    uint32_t count = 0;
    cscd_status status = CSCD_OK;
    while (status == CSCD_OK && count < o->size_count &&
           (count == 0 || costs[count - 1].seconds < o->limit)) {
        extreme_shape shape = extreme_shape_make(kind, o->sizes[count]);
        costs[count] = (extreme_cost){0};
        status = measure_shape(&shape, c, &costs[count]);
        if (status == CSCD_OK) print_row(kind_name, name, &costs[count++]);
        extreme_shape_free(&shape);
    }
    if (count > 1) print_exponents(kind_name, name, &costs[0], &costs[count - 1]);
    return status == CSCD_OK;
}

/* ---- options --------------------------------------------------------------------------------------------- */

static bool parse_sizes(const char *text, extremes_options *o) {
    for (o->size_count = 0; o->size_count < SIZES_MOST; text++) {
        char *end;
        const unsigned long size = strtoul(text, &end, 10);
        if (end == text || size < 100 || size > 10000000) return false;
        if (o->size_count > 0 && size <= o->sizes[o->size_count - 1]) return false;
        o->sizes[o->size_count++] = (uint32_t)size;
        text = end;
        if (*text == '\0') return true;
        if (*text != ',') return false;
    }
    return false;
}

static bool parse_only(const char *text, extremes_options *o) {
    bool known = false;
    for (int c = 0; c < COMMANDS; c++) known |= o->commands[c] = strcmp(text, command_names[c]) == 0;
    return known;
}

static bool parse_options(int count, char **arguments, extremes_options *o) {
    static const extremes_options usual = {{4000, 16000, 64000}, 3, 20.0, {true, true, true, true}, {false}};
    bool all = true;
    *o = usual;
    for (int i = 1; i < count; i++) {
        const char *value = i + 1 < count ? arguments[i + 1] : "";
        extreme_kind kind;
        if (extreme_kind_from_name(arguments[i], &kind)) {
            o->kinds[kind] = true;
            all = false;
            continue;
        }
        if (strcmp(arguments[i], "--sizes") == 0 ? !parse_sizes(value, o)
            : strcmp(arguments[i], "--only") == 0
                ? !parse_only(value, o)
                : strcmp(arguments[i], "--limit") != 0 || !((o->limit = atof(value)) > 0.0))
            return false;
        i++;
    }
    for (int kind = 0; all && kind < EXTREME_KINDS; kind++) o->kinds[kind] = true;
    return true;
}

int main(int argument_count, char **arguments) {
    extremes_options o;
    bool good = true;
    if (argument_count > 1 && strcmp(arguments[1], "--help") == 0) {
        fputs(help, stdout);
        return 0;
    }
    if (!parse_options(argument_count, arguments, &o)) {
        fputs(help, stderr);
        return 2;
    }
    printf("  %-10s %-9s %9s %8s %9s %9s %12s %12s\n", "shape", "command", "triangles", "found", "seconds",
           "MB", "boxes", "tests");
    for (int kind = 0; kind < EXTREME_KINDS; kind++)
        for (int c = 0; o.kinds[kind] && c < COMMANDS; c++)
            if (o.commands[c]) good = measure_kind(&o, (extreme_kind)kind, (extreme_command)c) && good;
    return good ? 0 : 1;
}
