/* The cost of a bulk motion: the same deformation with everything moved by many body lengths in an
 * interval. */
#include "benchmarks/lib/options.h"
#include "benchmarks/lib/stages.h"
#include "cscd/research.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LENGTH_COUNT = 4 };

static const double lengths[LENGTH_COUNT] = {0.0, 1.0, 10.0, 100.0};

static const char help[] =
    "usage: motion [options]\n"
    "\n"
    "Every interval is measured four times: as it is, and with everything moved along x by 1, 10 and 100 body\n"
    "lengths from its start to its end, on and on; a body length is the greatest extent rounded down to a\n"
    "power of two, so all sums are exact and the contacts are the same. Cost: median over that without\n"
    "motion. Differing: share of the contacts (kind, a, b) that one of both lists has and the other has not.\n"
    "\n";

typedef struct contact_pairs {
    cscd_contact *items;
    size_t count;
} contact_pairs;

/* ---- contacts as sets -------------------------------------------------------------------------------- */

static int compare_pairs(const void *a, const void *b) {
    const cscd_contact *p = a, *q = b;
    if (p->kind != q->kind) return p->kind < q->kind ? -1 : 1;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    return p->b < q->b ? -1 : p->b > q->b;
}

static contact_pairs sorted_pairs(const cscd_contacts *found) {
    contact_pairs set = {body_allocate(found->count + 1, sizeof *set.items), found->count};
    if (found->count > 0) memcpy(set.items, found->items, found->count * sizeof *set.items);
    qsort(set.items, set.count, sizeof *set.items, compare_pairs);
    return set;
}

/* Counts the pairs in only one of the lists, and the pairs in any. */
static void add_difference(const contact_pairs *a, const contact_pairs *b, double *different, double *all) {
    size_t i = 0, j = 0;
    while (i < a->count || j < b->count) {
        int order = i == a->count ? 1 : j == b->count ? -1 : compare_pairs(&a->items[i], &b->items[j]);
        i += order <= 0;
        j += order >= 0;
        *different += order != 0;
        *all += 1.0;
    }
}

/* ---- measuring --------------------------------------------------------------------------------------- */

typedef struct contest {
    subject *subjects[LENGTH_COUNT];
    double different[LENGTH_COUNT], all[LENGTH_COUNT];
} contest;

static bool run_interval(const deforming_body *b, contest *c, uint32_t i, double *ends, io_error *error) {
    size_t size = (size_t)b->vertex_count * 3;
    contact_pairs still = {NULL, 0};
    bool good = true;
    for (int k = 0; good && k < LENGTH_COUNT; k++) {
        cscd_contacts found;
        deforming_body_interval(b, i, lengths[k] * b->length, ends, ends + size);
        good = subject_step(c->subjects[k], ends, ends + size, i > 0, &found, error);
        if (!good) break;
        contact_pairs moving = sorted_pairs(&found);
        if (k == 0) {
            still = moving;
            continue;
        }
        add_difference(&still, &moving, &c->different[k], &c->all[k]);
        free(moving.items);
    }
    free(still.items);
    return good;
}

static void print_rows(const char *name, const deforming_body *b, const subject_options *options,
                       const contest *c, json *out) {
    double still = stage_median(&c->subjects[0]->samples, STAGE_TOTAL);
    for (int k = 0; k < LENGTH_COUNT; k++) {
        const stage_samples *s = &c->subjects[k]->samples;
        double total = stage_median(s, STAGE_TOTAL),
               share = c->all[k] > 0.0 ? c->different[k] / c->all[k] : 0.0;
        printf("  %-14s %9u %-7s %7.0f %10.3f %7.2f %12.0f %10.0f %9.0f %9.4f\n", name, b->triangle_count,
               cscd_method_name(options->method), lengths[k], total, total / still, s->pcp / s->count,
               s->tests / s->count, s->contacts / s->count, share);
        if (out->file == NULL) continue;
        json_break_line(out);
        json_begin_object(out, NULL);
        json_string(out, "scene", name);
        json_integer(out, "triangles", b->triangle_count);
        json_string(out, "method", cscd_method_name(options->method));
        json_number(out, "lengths", lengths[k]);
        json_number(out, "total_ms", total);
        json_number(out, "cost", total / still);
        json_number(out, "pcp", s->pcp / s->count);
        json_number(out, "contacts", s->contacts / s->count);
        json_number(out, "differing", share);
        json_end_object(out);
    }
    fflush(stdout);
}

static bool run_method(const char *name, const deforming_body *b, const bench_options *o, cscd_method method,
                       json *out, io_error *error) {
    contest c = {{NULL}, {0.0}, {0.0}};
    subject_options options = {method, CSCD_MODE_ALL, o->thread_count, o->simd, o->volume};
    double *ends = body_allocate((size_t)b->vertex_count * 6, sizeof *ends);
    uint32_t intervals = bench_intervals(o, b->triangle_count) / 2 + 1;
    bool good = true;
    for (int k = 0; good && k < LENGTH_COUNT; k++) {
        c.subjects[k] = subject_make(b, &options, error);
        good = c.subjects[k] != NULL;
    }
    for (uint32_t i = 0; good && i <= intervals; i++) good = run_interval(b, &c, i, ends, error);
    if (good) print_rows(name, b, &options, &c, out);
    for (int k = 0; k < LENGTH_COUNT; k++) subject_destroy(c.subjects[k]);
    free(ends);
    return good;
}

static bool run_methods(const char *name, const deforming_body *b, const bench_options *o, json *out,
                        io_error *error) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_ICCD, CSCD_METHOD_SINGLE};
    bool good = true;
    for (int i = 0; good && i < 3; i++) good = run_method(name, b, o, methods[i], out, error);
    return good;
}

/* ---- the program ------------------------------------------------------------------------------------- */

static bool run_made(const bench_options *o, deformation motion, uint32_t size, json *out, io_error *error) {
    deforming_body b;
    body_kind kind = motion == DEFORM_LEGS ? BODY_FIGURE : o->kind;
    if (!deforming_body_make(kind, size, motion, o->shuffled, &b, error)) return false;
    bool good = run_methods(motion == DEFORM_LEGS ? "figure, legs" : body_kind_name(kind), &b, o, out, error);
    deforming_body_free(&b);
    return good;
}

/* Runs the cloth with method none: of the other methods, only iccd culls on open surfaces. */
static bool run_cloth(const bench_options *o, json *out, io_error *error) {
    deforming_body b;
    if (!bench_has_data(o, "cloth funnel")) return true;
    if (!deforming_body_read(o->data, "cloth_funnel", 227, &b, error)) return false;
    bool good = run_method("cloth funnel", &b, o, CSCD_METHOD_NONE, out, error);
    deforming_body_free(&b);
    return good;
}

static bool run_bodies(const bench_options *o, json *out, io_error *error) {
    printf("  %-14s %9s %-7s %7s %10s %7s %12s %10s %9s %9s\n", "scene", "triangles", "method", "lengths",
           "total ms", "cost", "#PCPs", "tests", "contacts", "differing");
    bool good = true;
    for (uint32_t i = 0; good && i < o->size_count; i++)
        good = run_made(o, DEFORM_WAVE, o->sizes[i], out, error);
    return good && run_made(o, DEFORM_LEGS, 6000, out, error) && run_cloth(o, out, error);
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {2000, 5000, 20000, 100000};
    static const bench_program program = {"motion", help, sizes, 4, 2, run_bodies};
    return bench_main(&program, argument_count, arguments);
}
