/* The cost of answers about intersections, compared with the plain check: curves, patches, overlaps, depths, what is
 * cut off, events. */
#include "benchmarks/lib/made_scenes.h"
#include "benchmarks/lib/options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { REPEATS = 7, ROWS_MAX = 16 };

static const char help[] =
    "usage: intersections [options]\n"
    "\n"
    "What cscd_detector_find_intersections takes at one moment by default (check), then with curves, with patches,\n"
    "too, with overlaps, with depths, and with all of these. The scenes are made here, except cloth. Milliseconds of\n"
    "processor time of all threads, in which a crowded machine shows less; each is the least of some rounds, in\n"
    "which all take turns; trees and buffers exist. x: all, as a multiple of the check. grown: how often these\n"
    "rounds have allocated.\n"
    "The second table: with patches and what is cut off; and a frame of a cscd_event_tracker that is given all\n"
    "answers.\n"
    "--intervals: the rounds (default 7, with --quick 3). --sizes, --body and --shuffled mean nothing here.\n"
    "\n";

typedef enum question {
    ASK_CHECK,
    ASK_CURVES,
    ASK_PATCHES,
    ASK_OVERLAPS,
    ASK_DEPTHS,
    ASK_ALL,
    ASK_CUT_OFFS,
    QUESTION_COUNT,
    FIRST_TABLE_COUNT = ASK_ALL + 1
} question;

static const char *const question_names[QUESTION_COUNT] = {"check",  "curves", "patches", "overlaps",
                                                           "depths", "all",    "cut_offs"};

typedef struct moment {
    const char *name;
    const cscd_object_desc *objects;
    uint32_t object_count, vertex_count, triangle_count;
    const double *positions;
} moment;

typedef struct answer_times {
    double ms[QUESTION_COUNT];
    cscd_intersections found; /* of all */
    size_t buried;            /* vertices */
    size_t grown;
    double tracker_ms;
} answer_times;

/* A row of the second table, which is printed behind the first one. */
typedef struct later_row {
    const char *name;
    uint32_t triangle_count;
    answer_times times;
} later_row;

typedef struct row_list {
    later_row items[ROWS_MAX];
    size_t count;
} row_list;

/* ---- measuring ----------------------------------------------------------------------------------------- */

static void *count_allocate(void *user, size_t size, size_t alignment) {
    size_t *count = user;
    (*count)++;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release_block(void *user, void *block, size_t size) {
    (void)user;
    (void)size;
    free(block);
}

static double processor_ms(void) {
    return (double)clock() * (1e3 / CLOCKS_PER_SEC);
}

static cscd_status ask_question(cscd_detector *d, const moment *m, question q, double *ms,
                                cscd_intersections *found) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.curves = q >= ASK_CURVES;
    options.patches = q >= ASK_PATCHES;
    options.overlaps = q == ASK_OVERLAPS || q == ASK_ALL;
    options.depths = q == ASK_DEPTHS || q == ASK_ALL;
    options.cut_offs = q == ASK_CUT_OFFS;
    double since = processor_ms();
    cscd_status status =
        cscd_detector_find_intersections(d, CSCD_DOUBLES(m->positions, m->vertex_count), &options, found);
    *ms = processor_ms() - since;
    return status;
}

static size_t count_buried(const cscd_depths *depths) {
    size_t count = 0;
    for (size_t i = 0; i < depths->vertex_count; i++)
        count += i == 0 || depths->items[i].vertex != depths->items[i - 1].vertex;
    return count;
}

/* The first round, in which trees are built and buffers grow, does not count. */
static cscd_status run_rounds(cscd_detector *d, const moment *m, uint32_t rounds, const size_t *allocations,
                              answer_times *out) {
    cscd_status status = CSCD_OK;
    for (int q = 0; q < QUESTION_COUNT; q++) out->ms[q] = HUGE_VAL;
    for (uint32_t i = 0; status == CSCD_OK && i <= rounds; i++) {
        size_t before = *allocations;
        for (int q = 0; status == CSCD_OK && q < QUESTION_COUNT; q++) {
            double ms = 0.0;
            status = ask_question(d, m, (question)q, &ms, &out->found);
            if (i > 0) out->ms[q] = fmin(out->ms[q], ms);
        }
        if (i > 0) out->grown += *allocations - before;
    }
    return status;
}

/* One round of what comes behind the answers: a frame for the tracker. */
static cscd_status run_later_round(cscd_detector *d, const moment *m, cscd_event_tracker *tracker,
                                   uint64_t frame, answer_times *out) {
    cscd_events events;
    double ms;
    cscd_status status = ask_question(d, m, ASK_ALL, &ms, &out->found);
    if (status == CSCD_OK) out->buried = count_buried(out->found.depths);
    const double since = processor_ms();
    if (status == CSCD_OK) status = cscd_event_tracker_add_frame(tracker, frame, &out->found);
    if (status == CSCD_OK) status = cscd_event_tracker_take(tracker, &events);
    out->tracker_ms = fmin(out->tracker_ms, processor_ms() - since);
    return status;
}

static cscd_status run_later_rounds(cscd_detector *d, const moment *m, cscd_event_tracker *tracker,
                                    uint32_t rounds, answer_times *out) {
    cscd_status status = CSCD_OK;
    out->tracker_ms = HUGE_VAL;
    for (uint32_t i = 0; status == CSCD_OK && i <= rounds; i++)
        status = run_later_round(d, m, tracker, i, out);
    return status;
}

/* ---- rows ---------------------------------------------------------------------------------------------- */

static void print_heading(const bench_options *o) {
    printf("%u thread%s, simd %s; ms\n  %-13s %8s %7s %8s %7s %7s %7s %7s", o->thread_count,
           o->thread_count == 1 ? "" : "s", cscd_name(CSCD_SIMDS, o->simd), "scene", "triangles", "pairs",
           "crossing", "curves", "pieces", "patches", "buried");
    for (int q = 0; q < FIRST_TABLE_COUNT; q++) printf(" %8s", question_names[q]);
    printf(" %6s %5s\n", "x", "grown");
}

static void print_row(const moment *m, const answer_times *t) {
    const cscd_intersections *f = &t->found;
    printf("  %-13s %8u %8zu %8zu %7zu %7zu %7zu %7zu", m->name, m->triangle_count, f->count, f->crossing,
           f->curves->count, f->curves->piece_count, f->patches->count, t->buried);
    for (int q = 0; q < FIRST_TABLE_COUNT; q++) printf(" %8.2f", t->ms[q]);
    printf(" %6.2f %5zu\n", t->ms[ASK_ALL] / t->ms[ASK_CHECK], t->grown);
    fflush(stdout);
}

static void print_later_rows(const row_list *rows) {
    printf("\n  %-13s %8s %8s %8s %8s\n", "scene", "triangles", "check", "cut_offs", "tracker");
    for (size_t i = 0; i < rows->count; i++) {
        const later_row *row = &rows->items[i];
        const answer_times *t = &row->times;
        printf("  %-13s %8u %8.2f %8.2f %8.2f\n", row->name, row->triangle_count, t->ms[ASK_CHECK],
               t->ms[ASK_CUT_OFFS], t->tracker_ms);
    }
}

static void write_row(json *out, const moment *m, const answer_times *t) {
    const cscd_intersections *f = &t->found;
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "scene", m->name);
    json_integer(out, "triangles", m->triangle_count);
    json_integer(out, "pairs", f->count);
    json_integer(out, "crossing", f->crossing);
    json_integer(out, "curves", f->curves->count);
    json_integer(out, "pieces", f->curves->piece_count);
    json_integer(out, "patches", f->patches->count);
    json_integer(out, "buried", t->buried);
    json_begin_object(out, "ms");
    for (int q = 0; q < QUESTION_COUNT; q++) json_number(out, question_names[q], t->ms[q]);
    json_number(out, "tracker", t->tracker_ms);
    json_end_object(out);
    json_integer(out, "grown", t->grown);
    json_end_object(out);
}

/* Returns the status of the last call. */
static cscd_status measure_in(cscd_context *context, const moment *m, const bench_options *o,
                              const size_t *allocations, answer_times *out) {
    cscd_mesh *mesh = NULL;
    cscd_detector *d = NULL;
    cscd_event_tracker *tracker = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_NONE;
    options.volume = o->volume;
    uint32_t rounds = o->interval_count > 0 ? o->interval_count : o->quick ? 3 : REPEATS;
    cscd_status status = cscd_mesh_create(context, m->objects, m->object_count, &mesh);
    if (status == CSCD_OK) status = cscd_detector_create(context, mesh, NULL, &options, &d);
    if (status == CSCD_OK) status = run_rounds(d, m, rounds, allocations, out);
    if (status == CSCD_OK) status = cscd_event_tracker_create(context, mesh, NULL, &tracker);
    if (status == CSCD_OK) status = run_later_rounds(d, m, tracker, rounds, out);
    if (status == CSCD_OK) print_row(m, out);
    cscd_event_tracker_destroy(tracker);
    cscd_detector_destroy(d);
    cscd_mesh_destroy(mesh);
    return status;
}

static bool measure_moment(const moment *m, const bench_options *o, row_list *rows, json *out,
                           io_error *error) {
    size_t allocations = 0;
    answer_times times = {.grown = 0};
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = o->thread_count;
    options.simd = o->simd;
    options.allocator = (cscd_allocator){count_allocate, release_block, &allocations};
    cscd_status status = cscd_context_create(&options, &context);
    if (status == CSCD_OK) status = measure_in(context, m, o, &allocations, &times);
    bool good = status == CSCD_OK || io_fail(error, "%s: %s", m->name, cscd_status_string(status));
    if (good) write_row(out, m, &times);
    if (good && rows->count < ROWS_MAX)
        rows->items[rows->count++] = (later_row){m->name, m->triangle_count, times};
    cscd_context_destroy(context);
    return good;
}

/* ---- the program --------------------------------------------------------------------------------------- */

static bool measure_scene(crossing_kind kind, uint32_t triangle_count, const bench_options *o, row_list *rows,
                          json *out, io_error *error) {
    crossing_scene s;
    if (!crossing_scene_make(kind, triangle_count, &s, error)) return false;
    cscd_object_desc descs[CROSSING_OBJECTS_MAX];
    moment m = {.name = s.name, .objects = descs, .object_count = s.object_count};
    for (uint32_t i = 0; i < s.object_count; i++) {
        const body *b = &s.objects[i];
        descs[i] = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
        m.vertex_count += b->vertex_count;
        m.triangle_count += b->triangle_count;
    }
    double *positions = body_allocate(m.vertex_count, sizeof(double[3]));
    for (uint32_t i = 0, first = 0; i < s.object_count; first += s.objects[i++].vertex_count) {
        const body *b = &s.objects[i];
        memcpy(positions + (size_t)first * 3, b->positions, b->vertex_count * sizeof(double[3]));
    }
    m.positions = positions;
    bool good = measure_moment(&m, o, rows, out, error);
    free(positions);
    crossing_scene_free(&s);
    return good;
}

static bool measure_cloth(const bench_options *o, row_list *rows, json *out, io_error *error) {
    deforming_body b;
    if (!bench_has_data(o, "cloth_ball")) return true;
    if (!deforming_body_read(o->data, "cloth_ball", 92, &b, error)) return false;
    cscd_object_desc desc = cscd_object_of_triangles(b.vertex_count, b.triangle_count, b.triangles);
    moment m = {"cloth_ball 92", &desc, 1, b.vertex_count, b.triangle_count, b.rest};
    bool good = measure_moment(&m, o, rows, out, error);
    m.name = "cloth_ball 93";
    m.positions = b.last;
    good = good && measure_moment(&m, o, rows, out, error);
    deforming_body_free(&b);
    return good;
}

static bool run_scenes(const bench_options *o, json *out, io_error *error) {
    static const struct {
        crossing_kind kind;
        uint32_t triangle_count;
        bool large;
    } scenes[] = {{CROSSING_FIGURE, 20000, false},  {CROSSING_KNOT, 20000, false},
                  {CROSSING_SPHERES, 27000, false}, {CROSSING_FIGURE, 100000, true},
                  {CROSSING_KNOT, 100000, true},    {CROSSING_CLEAN, 100000, false},
                  {CROSSING_SCAN, 1000000, true}};
    row_list rows = {.count = 0};
    print_heading(o);
    bool good = measure_cloth(o, &rows, out, error);
    for (size_t i = 0; good && i < sizeof scenes / sizeof *scenes; i++) {
        if (scenes[i].large && o->quick) continue;
        good = measure_scene(scenes[i].kind, scenes[i].triangle_count, o, &rows, out, error);
    }
    if (good) print_later_rows(&rows);
    return good;
}

int main(int argument_count, char **arguments) {
    static const bench_program program = {"intersections", help, NULL, 0, 0, run_scenes};
    return bench_main(&program, argument_count, arguments);
}
