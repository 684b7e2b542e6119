/* Frames of cloth simulations with heavy contact: time and contacts of one interval each. */
#include "benchmarks/lib/options.h"
#include "benchmarks/lib/stages.h"

#include <stdlib.h>

enum { REPEATS = 7 };

static const char help[] =
    "usage: cloth [options]\n"
    "\n"
    "Two pairs of frames of published cloth simulations, mode all, method auto (without a plan: none). The\n"
    "same interval again and again; medians, the first, which builds trees, left out. --sizes, --body and\n"
    "--shuffled mean nothing here.\n"
    "\n";

typedef struct cloth_pair {
    const char *name;
    int first; /* the pair is this frame and the next */
} cloth_pair;

static void count_kinds(const cscd_contacts *found, size_t *vf, size_t *ee) {
    *vf = 0;
    for (size_t i = 0; i < found->count; i++) *vf += found->items[i].kind == CSCD_CONTACT_VF;
    *ee = found->count - *vf;
}

static void print_row(const char *name, const deforming_body *b, const subject *s, size_t vf, size_t ee,
                      json *out) {
    printf("  %-14s %9u", name, b->triangle_count);
    for (int i = 0; i < STAGE_COUNT; i++) printf(" %8.2f", stage_median(&s->samples, i));
    printf(" %10.0f %10.0f %8zu %8zu\n", s->samples.pcp / s->samples.count,
           s->samples.tests / s->samples.count, vf, ee);
    fflush(stdout);
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "frames", name);
    json_integer(out, "triangles", b->triangle_count);
    json_begin_object(out, "ms");
    for (int i = 0; i < STAGE_COUNT; i++) json_number(out, stage_name(i), stage_median(&s->samples, i));
    json_end_object(out);
    json_number(out, "pcp", s->samples.pcp / s->samples.count);
    json_number(out, "tests", s->samples.tests / s->samples.count);
    json_integer(out, "vf", vf);
    json_integer(out, "ee", ee);
    json_end_object(out);
}

static bool measure_pair(const cloth_pair *p, const deforming_body *b, const bench_options *o, json *out,
                         io_error *error) {
    subject_options options = {CSCD_METHOD_AUTO, CSCD_MODE_ALL, o->thread_count, o->simd, o->volume};
    subject *s = subject_make(b, &options, error);
    if (s == NULL) return false;
    size_t size = (size_t)b->vertex_count * 3, vf = 0, ee = 0;
    double *ends = body_allocate(2 * size, sizeof *ends);
    uint32_t repeats = o->interval_count > 0 ? o->interval_count : o->quick ? 3 : REPEATS;
    bool good = true;
    deforming_body_interval(b, 0, 0.0, ends, ends + size);
    for (uint32_t i = 0; good && i <= repeats; i++) {
        cscd_contacts found;
        good = subject_step(s, ends, ends + size, i > 0, &found, error);
        if (good) count_kinds(&found, &vf, &ee);
    }
    if (good) print_row(p->name, b, s, vf, ee, out);
    free(ends);
    subject_destroy(s);
    return good;
}

static bool run_pairs(const bench_options *o, json *out, io_error *error) {
    static const cloth_pair pairs[] = {{"cloth_ball", 92}, {"cloth_funnel", 227}};
    printf("mode all, %u thread%s, simd %s; milliseconds\n  %-14s %9s", o->thread_count,
           o->thread_count == 1 ? "" : "s", cscd_name(CSCD_SIMDS, o->simd), "frames", "triangles");
    for (int i = 0; i < STAGE_COUNT; i++) printf(" %8s", stage_name(i));
    printf(" %10s %10s %8s %8s\n", "#PCPs", "tests", "VF", "EE");
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        deforming_body b;
        if (!bench_has_data(o, pairs[i].name)) continue;
        if (!deforming_body_read(o->data, pairs[i].name, pairs[i].first, &b, error)) return false;
        bool good = measure_pair(&pairs[i], &b, o, out, error);
        deforming_body_free(&b);
        if (!good) return false;
    }
    return true;
}

int main(int argument_count, char **arguments) {
    static const bench_program program = {"cloth", help, NULL, 0, 0, run_pairs};
    return bench_main(&program, argument_count, arguments);
}
