/* The tables of benchmarks/untangle. */
#include "benchmarks/untangle/untangle_tables.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void untangle_cases_add(untangle_cases *l, const untangle_case *c) {
    if (l->count == l->capacity) {
        l->capacity = 2 * l->capacity + 256;
        untangle_case *grown = body_allocate(l->capacity, sizeof *grown);
        if (l->count > 0) memcpy(grown, l->items, l->count * sizeof *grown);
        free(l->items);
        l->items = grown;
    }
    l->items[l->count++] = *c;
}

void untangle_cases_free(untangle_cases *l) {
    free(l->items);
    *l = (untangle_cases){.count = 0};
}

bool untangle_case_failed(const untangle_case *c) {
    return !c->clean || c->broken != 0;
}

static const char *start_name(cscd_untangle_start start) {
    static const char *const names[] = {"-", "given", "pushed", "shrunk"};
    return (size_t)start < sizeof names / sizeof *names ? names[start] : "?";
}

/* Displacement over the thickness of what was in each other; NAN where that is not known. */
static double depth_ratio(const untangle_case *c) {
    return c->found.thickness > 0.0 ? c->displacement / c->found.thickness : NAN;
}

/* Where surfaces hardly touch, the room that results keep is more than the thickness. */
static bool is_deep(const untangle_case *c) {
    return c->found.thickness > 0.2 * c->edge;
}

static void print_promises(uint32_t broken) {
    static const char *const texts[BROKEN_PROMISES] = {
        "WORSE",     "NOT CLEAN AS SAID",          "COUNTS DIFFER",
        "PIN MOVED", "NOT CLEAN FROM CLEAN START", "SEAM OPEN"};
    for (int i = 0; i < BROKEN_PROMISES; i++)
        if (broken >> i & 1) printf("  %s", texts[i]);
}

void print_case_heading(void) {
    printf(
        "class  way      scene                    frame triangles   before     after              ms disp/thick "
        "least quality   flips  creases from    rounds steps\n");
}

void print_case(const untangle_case *c) {
    printf(
        "%-6s %-8s %-24s %5u %9u %8zu -> %6zu %-7s %9.1f %10.2f %5.3f -> %5.3f %4u (%u) %5u   %-6s %7u %5u",
        tangle_class_name(c->entry->class), c->followed ? "followed" : "single", c->entry->name, c->frame,
        c->triangle_count, c->pairs_before, c->pairs_after,
        c->clean           ? c->pairs_as_floats > 0 ? "doubles" : "clean"
        : c->found.stopped ? "stopped"
                           : "",
        1e3 * c->seconds, depth_ratio(c), c->quality_before, c->quality_after, c->flips, c->smooth_flips,
        c->creases, start_name(c->found.start), c->found.rounds, c->found.steps);
    print_promises(c->broken);
    printf("\n");
}

/* ---- summary ------------------------------------------------------------------------------------------- */

/* What part 24 wants of a class: shares of clean cases and seconds, at about 10,000 and 100,000 triangles; 0: nothing. */
typedef struct wanted_row {
    double clean[2], seconds[2];
} wanted_row;

static const wanted_row wanted_followed = {{1.0, 1.0}, {0.1, 1.5}};
static const wanted_row wanted_rows[TANGLE_CLASS_COUNT] = {
    [TANGLE_LIMBS] = {{0.85, 0.75}, {3.0, 30.0}},  [TANGLE_FOLDS] = {{0.7, 0.6}, {3.0, 0.0}},
    [TANGLE_BODIES] = {{0.95, 0.95}, {1.0, 15.0}}, [TANGLE_RODS] = {{0.9, 0.9}, {0.0, 0.0}},
    [TANGLE_CLOTH] = {{0.9, 0.8}, {2.0, 20.0}},    [TANGLE_FLUSH] = {{0.9, 0.0}, {0.0, 0.0}},
    [TANGLE_HEAVY] = {{0.0, 0.0}, {0.0, 120.0}},
};

/* One line: the cases of a class and size, by themselves or followed. */
typedef struct summary_line {
    tangle_class class;
    bool followed, large;
    uint32_t cases, clean, clean_as_floats, tuned, tuned_clean, held_out, held_out_clean, scenes, broken;
    double scene_share; /* the mean over scenes of the share of clean cases */
    double pairs_gone;
    uint32_t quality_kept; /* clean cases whose least quality is at least half the input's */
    uint32_t smooth_flips;
    double seconds[3], ratios[3],
        flip_shares[3]; /* median, 9th decile, most; the latter two of clean cases */
} summary_line;

static int compare_doubles(const void *a, const void *b) {
    const double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

static void take_quantiles(double *values, uint32_t count, double out[3]) {
    qsort(values, count, sizeof *values, compare_doubles);
    for (int i = 0; i < 3; i++) out[i] = NAN;
    if (count == 0) return;
    out[0] = values[count / 2];
    out[1] = values[count * 9 / 10];
    out[2] = values[count - 1];
}

static bool is_on_line(const summary_line *s, const untangle_case *c) {
    return c->followed == s->followed && c->entry->large == s->large &&
           (s->followed || c->entry->class == s->class);
}

static void count_case(summary_line *s, const untangle_case *c) {
    s->cases++;
    s->clean += c->clean;
    s->clean_as_floats += c->pairs_as_floats == 0;
    s->broken += c->broken != 0;
    s->pairs_gone += 1.0 - fmin(1.0, (double)c->pairs_after / fmax(1.0, (double)c->pairs_before));
    if (c->entry->held_out) {
        s->held_out++;
        s->held_out_clean += c->clean;
    } else {
        s->tuned++;
        s->tuned_clean += c->clean;
    }
    if (!c->clean) return;
    s->quality_kept += c->quality_after >= 0.5 * c->quality_before;
    s->smooth_flips += c->smooth_flips;
}

/* Cases of a scene follow each other. */
static void count_scenes(summary_line *s, const untangle_cases *l) {
    const corpus_entry *last = NULL;
    uint32_t cases = 0, clean = 0;
    for (uint32_t i = 0; i <= l->count; i++) {
        const untangle_case *c = i < l->count ? &l->items[i] : NULL;
        if (c != NULL && !is_on_line(s, c)) continue;
        if (c == NULL || c->entry != last) {
            if (cases > 0) s->scene_share += (double)clean / cases;
            s->scenes += cases > 0;
            cases = clean = 0;
        }
        if (c == NULL) break;
        last = c->entry;
        cases++;
        clean += c->clean;
    }
    if (s->scenes > 0) s->scene_share /= s->scenes;
}

static summary_line sum_up(const untangle_cases *l, tangle_class class, bool followed, bool large) {
    summary_line s = {.class = class, .followed = followed, .large = large};
    double *values = body_allocate(3 * (size_t)l->count + 1, sizeof *values), *ratios = values + l->count,
           *flips = ratios + l->count;
    uint32_t ratio_count = 0;
    for (uint32_t i = 0; i < l->count; i++) {
        const untangle_case *c = &l->items[i];
        if (!is_on_line(&s, c)) continue;
        values[s.cases] = c->seconds;
        if (c->clean) flips[s.clean] = (double)c->flips / c->triangle_count;
        if (c->clean && is_deep(c)) ratios[ratio_count++] = depth_ratio(c);
        count_case(&s, c);
    }
    take_quantiles(values, s.cases, s.seconds);
    take_quantiles(ratios, ratio_count, s.ratios);
    take_quantiles(flips, s.clean, s.flip_shares);
    count_scenes(&s, l);
    free(values);
    return s;
}

static const char *line_title(const summary_line *s) {
    return s->followed ? "recording with a clean frame" : tangle_class_title(s->class);
}

static double share_of(uint32_t part, uint32_t whole) {
    return whole > 0 ? 100.0 * part / whole : NAN;
}

/* Calls back for each line that has cases. */
static void each_line(const untangle_cases *l, void (*visit)(const summary_line *s, void *user), void *user) {
    for (int i = 0; i < 2 * (TANGLE_CLASS_COUNT + 1); i++) {
        const int row = i % (TANGLE_CLASS_COUNT + 1);
        const summary_line s =
            sum_up(l, (tangle_class)(row > 0 ? row - 1 : 0), row == 0, i > TANGLE_CLASS_COUNT);
        if (s.cases > 0) visit(&s, user);
    }
}

static void print_line(const summary_line *s, void *user) {
    (void)user;
    const wanted_row *w = s->followed ? &wanted_followed : &wanted_rows[s->class];
    const double clean = w->clean[s->large], seconds = w->seconds[s->large];
    printf("%-32s %s %5u %6u %6.1f ", line_title(s), s->large ? "100k" : " 10k", s->scenes, s->cases,
           share_of(s->clean, s->cases));
    if (clean > 0.0)
        printf("%5.0f", 100.0 * clean);
    else
        printf("    -");
    printf(" %7.1f %6.1f %6.1f %6.1f %8.2f %8.2f ", 100.0 * s->scene_share,
           share_of(s->tuned_clean, s->tuned), share_of(s->held_out_clean, s->held_out),
           100.0 * s->pairs_gone / s->cases, s->seconds[0], s->seconds[2]);
    if (seconds > 0.0)
        printf("%6.1f", seconds);
    else
        printf("     -");
    printf(" %6.2f %5.2f %8.1f %8.3f %6.3f %6u %7u\n", s->ratios[0], s->ratios[1],
           share_of(s->quality_kept, s->clean), 100.0 * s->flip_shares[0], 100.0 * s->flip_shares[2],
           s->smooth_flips, s->broken);
}

void print_summary(const untangle_cases *l) {
    printf(
        "\nClean, wanted: shares of cases in %%. by scene: the mean of all scenes. tuned, held: of scenes that may be\n"
        "tuned to, and of those that are held out. gone: pairs, in %%. median, worst, wanted: seconds. disp: greatest\n"
        "displacement over thickness, where this is above a fifth of an edge. quality: clean cases whose least triangle\n"
        "quality is at least half the input's, in %%. flips: of all triangles, in %%; smooth: flips of triangles that were\n"
        "within 90 degrees of their neighbours. broken: cases with a broken promise.\n");
    printf("%-37s %5s %6s %6s %5s %7s %6s %6s %6s %8s %8s %6s %6s %5s %8s %8s %6s %6s %7s\n", "", "scenes",
           "cases", "clean", "want", "scenes", "tuned", "held", "gone", "median", "worst", "want", "disp",
           "9/10", "quality", "flips", "most", "smooth", "broken");
    each_line(l, print_line, NULL);
}

void print_failures(const untangle_cases *l) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < l->count; i++) count += untangle_case_failed(&l->items[i]);
    printf("\n%u failures of %u cases\n", count, l->count);
    for (uint32_t i = 0; i < l->count; i++)
        if (untangle_case_failed(&l->items[i])) print_case(&l->items[i]);
}

/* ---- JSON ---------------------------------------------------------------------------------------------- */

void write_case(json *out, const untangle_case *c) {
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "class", tangle_class_name(c->entry->class));
    json_string(out, "scene", c->entry->name);
    json_integer(out, "frame", c->frame);
    json_boolean(out, "followed", c->followed);
    json_boolean(out, "held_out", c->entry->held_out);
    json_integer(out, "triangles", c->triangle_count);
    json_integer(out, "pairs_before", c->pairs_before);
    json_integer(out, "pairs_after", c->pairs_after);
    json_integer(out, "pairs_as_floats", c->pairs_as_floats);
    json_boolean(out, "clean", c->clean);
    json_boolean(out, "stopped", c->found.stopped);
    json_string(out, "start", start_name(c->found.start));
    json_integer(out, "rounds", c->found.rounds);
    json_integer(out, "steps", c->found.steps);
    json_number(out, "seconds", c->seconds);
    json_number(out, "displacement", c->displacement);
    json_number(out, "thickness", c->found.thickness);
    json_number(out, "edge", c->edge);
    if (c->followed) json_number(out, "jitter", c->jitter);
    json_number(out, "quality_before", c->quality_before);
    json_number(out, "quality_after", c->quality_after);
    json_integer(out, "flips", c->flips);
    json_integer(out, "smooth_flips", c->smooth_flips);
    json_integer(out, "creases", c->creases);
    json_integer(out, "broken", c->broken);
    json_end_object(out);
}

static void write_line(const summary_line *s, void *user) {
    json *out = user;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "summary", line_title(s));
    json_boolean(out, "large", s->large);
    json_integer(out, "scenes", s->scenes);
    json_integer(out, "cases", s->cases);
    json_number(out, "clean_percent", share_of(s->clean, s->cases));
    json_number(out, "clean_as_floats_percent", share_of(s->clean_as_floats, s->cases));
    json_number(out, "scene_percent", 100.0 * s->scene_share);
    json_number(out, "tuned_percent", share_of(s->tuned_clean, s->tuned));
    json_number(out, "held_out_percent", share_of(s->held_out_clean, s->held_out));
    json_number(out, "pairs_gone_percent", 100.0 * s->pairs_gone / s->cases);
    json_number(out, "median_seconds", s->seconds[0]);
    json_number(out, "worst_seconds", s->seconds[2]);
    json_number(out, "median_displacement", s->ratios[0]);
    json_number(out, "ninth_decile_displacement", s->ratios[1]);
    json_number(out, "quality_kept_percent", share_of(s->quality_kept, s->clean));
    json_number(out, "median_flips_percent", 100.0 * s->flip_shares[0]);
    json_number(out, "most_flips_percent", 100.0 * s->flip_shares[2]);
    json_integer(out, "smooth_flips", s->smooth_flips);
    json_integer(out, "broken", s->broken);
    json_end_object(out);
}

void write_summary(json *out, const untangle_cases *l) {
    if (out->file != NULL) each_line(l, write_line, out);
}
