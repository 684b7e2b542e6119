/* The cost of each stage per triangle, from small meshes to large ones, where nothing touches. */
#include "benchmarks/lib/options.h"
#include "benchmarks/lib/stages.h"
#include "cscd/research.h"

#include <stdlib.h>

enum { ROWS_MAX = SIZES_MAX * 10, CHARGE_TRIANGLES_MAX = 6000, COMPARED_SIZE = 20000 };

static const char help[] =
    "usage: scaling [options]\n"
    "\n"
    "Milliseconds per interval and stage, and nanoseconds per triangle, of bodies that deform by about one\n"
    "edge length an interval and never touch themselves: medians over consecutive intervals, the first,\n"
    "which builds trees, left out. Loop: what a fixed loop of arithmetic took meanwhile, which is how fast\n"
    "the machine was. Peak: bytes per triangle of all that the library held.\n"
    "\n";

typedef struct scaling_row {
    uint32_t triangles;
    cscd_method method;
    cscd_mode mode;
    double ms[STAGE_COUNT], boxes, pcp, features, tests, contacts, peak; /* per interval; peak in bytes */
    double loop;                                                         /* ms */
} scaling_row;

typedef struct table {
    scaling_row rows[ROWS_MAX];
    uint32_t count;
} table;

/* ---- measuring --------------------------------------------------------------------------------------- */

static bool replay_body(const deforming_body *b, subject *s, uint32_t intervals, double *loop,
                        io_error *error) {
    double loops[INTERVALS_MAX + 1];
    size_t size = (size_t)b->vertex_count * 3;
    double *ends = body_allocate(2 * size, sizeof *ends);
    bool good = true;
    for (uint32_t i = 0; good && i <= intervals; i++) {
        cscd_contacts found;
        deforming_body_interval(b, i, 0.0, ends, ends + size);
        loops[i] = fixed_arithmetic_ms();
        good = subject_step(s, ends, ends + size, i > 0, &found, error);
    }
    *loop = median(loops, intervals);
    free(ends);
    return good;
}

static bool measure_row(const deforming_body *b, const subject_options *options, uint32_t intervals,
                        scaling_row *out, io_error *error) {
    subject *s = subject_make(b, options, error);
    if (s == NULL) return false;
    double loop;
    bool good = replay_body(b, s, intervals, &loop, error);
    scaling_row r = {.triangles = b->triangle_count,
                     .method = options->method,
                     .mode = options->mode,
                     .loop = loop,
                     .peak = (double)s->peak,
                     .boxes = s->samples.boxes / intervals,
                     .pcp = s->samples.pcp / intervals,
                     .features = s->samples.features / intervals,
                     .tests = s->samples.tests / intervals,
                     .contacts = s->samples.contacts / intervals};
    for (int i = 0; i < STAGE_COUNT; i++) r.ms[i] = stage_median(&s->samples, i);
    subject_destroy(s);
    *out = r;
    return good;
}

/* ---- tables ------------------------------------------------------------------------------------------ */

static void print_title(const char *unit) {
    printf("\n%s\n  %9s %-7s %-8s", unit, "triangles", "method", "mode");
    for (int i = 0; i < STAGE_COUNT; i++) printf(" %8s", stage_name(i));
}

static void print_stages(const scaling_row *r, double scale) {
    printf("  %9u %-7s %-8s", r->triangles, cscd_method_name(r->method), cscd_name(CSCD_MODES, r->mode));
    for (int i = 0; i < STAGE_COUNT; i++) printf(" %8.*f", scale == 1.0 ? 3 : 1, r->ms[i] * scale);
}

static void print_row(const scaling_row *r) {
    double n = r->triangles;
    print_stages(r, 1.0);
    printf(" %8.1f %9.0f %9.0f %9.0f %9.0f %8.0f %8.0f %6.2f\n", r->ms[STAGE_TOTAL] * 1e6 / n, r->boxes,
           r->pcp, r->features, r->tests, r->contacts, r->peak / n, r->loop);
    fflush(stdout);
}

static void print_per_triangle(const table *t) {
    print_title("nanoseconds per triangle");
    putchar('\n');
    for (uint32_t i = 0; i < t->count; i++) {
        print_stages(&t->rows[i], 1e6 / t->rows[i].triangles);
        putchar('\n');
    }
}

/* Returns the row of this method that is nearest in size to `triangles`, or NULL when the method took no
 * part. */
static const scaling_row *nearest_row(const table *t, const scaling_row *like, uint32_t triangles) {
    const scaling_row *best = NULL;
    for (uint32_t i = 0; i < t->count; i++) {
        const scaling_row *r = &t->rows[i];
        if (r->method != like->method || r->mode != like->mode) continue;
        if (best == NULL ||
            abs((int)r->triangles - (int)triangles) < abs((int)best->triangles - (int)triangles))
            best = r;
    }
    return best;
}

static void print_growth(const table *t) {
    const scaling_row *last = &t->rows[t->count - 1];
    printf("\ncost per triangle at %u over that at %u\n", last->triangles,
           nearest_row(t, last, COMPARED_SIZE)->triangles);
    for (uint32_t i = 0; i < t->count; i++) {
        const scaling_row *r = &t->rows[i];
        if (r->triangles != last->triangles) continue;
        const scaling_row *small = nearest_row(t, r, COMPARED_SIZE);
        double scale = (double)small->triangles / r->triangles;
        printf("  %-7s %-8s", cscd_method_name(r->method), cscd_name(CSCD_MODES, r->mode));
        for (int k = 0; k < STAGE_COUNT; k++) {
            if (k != stage_named("proof") && small->ms[k] > 0.0)
                printf(" %s %.2f", stage_name(k), r->ms[k] / small->ms[k] * scale);
        }
        printf(" (loop %.2f)\n", r->loop / small->loop);
    }
}

static void write_row(json *out, const scaling_row *r, const bench_options *o) {
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "body", body_kind_name(o->kind));
    json_integer(out, "triangles", r->triangles);
    json_string(out, "method", cscd_method_name(r->method));
    json_string(out, "mode", cscd_name(CSCD_MODES, r->mode));
    json_string(out, "simd", cscd_name(CSCD_SIMDS, o->simd));
    json_string(out, "volume", cscd_name(CSCD_VOLUMES, o->volume));
    json_integer(out, "threads", o->thread_count);
    json_begin_object(out, "ms");
    for (int i = 0; i < STAGE_COUNT; i++) json_number(out, stage_name(i), r->ms[i]);
    json_end_object(out);
    json_number(out, "ns_per_triangle", r->ms[STAGE_TOTAL] * 1e6 / r->triangles);
    json_number(out, "boxes", r->boxes);
    json_number(out, "pcp", r->pcp);
    json_number(out, "feature_pairs", r->features);
    json_number(out, "tests", r->tests);
    json_number(out, "contacts", r->contacts);
    json_number(out, "peak_bytes", r->peak);
    json_number(out, "loop_ms", r->loop);
    json_end_object(out);
}

/* ---- the program ------------------------------------------------------------------------------------- */

static bool run_size(const bench_options *o, uint32_t size, table *t, json *out, terminal_progress *shown,
                     io_error *error) {
    deforming_body b;
    terminal_progress_say(shown, "making a body");
    if (!deforming_body_make(o->kind, size, DEFORM_WAVE, o->shuffled, &b, error)) return false;
    const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_ICCD, CSCD_METHOD_CONES, CSCD_METHOD_SINGLE,
                                   size <= CHARGE_TRIANGLES_MAX ? CSCD_METHOD_CHARGE : CSCD_METHOD_KMEANS};
    uint32_t intervals = bench_intervals(o, b.triangle_count);
    bool good = true;
    for (uint32_t i = 0; good && i < 10; i++) {
        char text[96];
        scaling_row *r = &t->rows[t->count];
        subject_options options = {methods[i / 2], i % 2 == 0 ? CSCD_MODE_ALL : CSCD_MODE_EARLIEST,
                                   o->thread_count, o->simd, o->volume};
        snprintf(text, sizeof text, "%u triangles, %s", b.triangle_count, cscd_method_name(options.method));
        terminal_progress_say(shown, text);
        good = measure_row(&b, &options, intervals, r, error);
        if (!good) break;
        t->count++;
        if (shown->shown) fputs("\r\033[K", stderr);
        print_row(r);
        write_row(out, r, o);
    }
    if (good)
        printf("  %9s %u intervals; vertices move by %.2f edge lengths (root mean square)\n", "", intervals,
               deforming_body_speed(&b));
    deforming_body_free(&b);
    return good;
}

static bool run_table(const bench_options *o, json *out, io_error *error) {
    static table t;
    terminal_progress shown;
    double contacts = 0.0;
    terminal_progress_begin(&shown, false);
    printf("%s, %u thread%s, simd %s, volume %s\n", body_kind_name(o->kind), o->thread_count,
           o->thread_count == 1 ? "" : "s", cscd_name(CSCD_SIMDS, o->simd),
           cscd_name(CSCD_VOLUMES, o->volume));
    print_title("milliseconds per interval");
    printf(" %8s %9s %9s %9s %9s %8s %8s %6s\n", "ns/tri", "boxes", "#PCPs", "features", "tests", "contacts",
           "peak B/t", "loop");
    bool good = true;
    for (uint32_t i = 0; good && i < o->size_count; i++)
        good = run_size(o, o->sizes[i], &t, out, &shown, error);
    terminal_progress_end(&shown);
    if (!good) return false;
    for (uint32_t i = 0; i < t.count; i++) contacts += t.rows[i].contacts;
    print_per_triangle(&t);
    print_growth(&t);
    if (contacts > 0.0)
        printf("\nthere are contacts, so this is not what it costs to find that there are none\n");
    else
        printf("\nno contact in any interval\n");
    return true;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {2000, 5000, 20000, 100000, 300000, 1300000};
    static const bench_program program = {"scaling", help, sizes, 6, 3, run_table};
    return bench_main(&program, argument_count, arguments);
}
