/* Untangles scenes, class by class: how many become clean, how fast, and how good the results are. */
#include "benchmarks/lib/options.h"
#include "benchmarks/untangle/untangle_tables.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { QUICK_FRAMES = 1, NUMBER_MAX = 1000000 };

static const char help[] =
    "usage: untangle [options]\n"
    "\n"
    "Untangles scenes whose surfaces are in each other by cscd_detector_untangle, and prints a line for each case, a\n"
    "summary by class beside what is wanted, and the failures. Each frame with pairs of triangles that intersect is a\n"
    "case by itself (single), and one that is followed from the last clean frame before it, or backwards from the\n"
    "first one after it (followed). Each result is judged by the exact check of a detector of its own. Seconds are\n"
    "processor time, with --threads wall time. Recordings of ours are read from build/models (`make models`), others\n"
    "from CSCD_DATA. Ctrl-C ends the run after the case at hand, and the tables follow.\n"
    "\n"
    "  --class NAME     limbs, folds, bodies, rods, cloth, flush or heavy\n"
    "  --scene NAME     the scenes whose names begin so\n"
    "  --frames A:B     the frames from A to B\n"
    "  --every N        each Nth crossing frame of a scene by itself\n"
    "  --way NAME       single or followed; default: both\n"
    "  --size NAME      small (about 10,000 triangles, and recordings) or large (100,000); default: both\n"
    "  --half NAME      tuned or held-out scenes; default: both\n"
    "  --time S         seconds of wall time after which a case ends (default 60, of large scenes 120, with --quick 2)\n"
    "  --gap G          min_separation, in mean lengths of an edge (default 0)\n"
    "  --steady S       how strongly followed frames are drawn to the frame before (default 0)\n"
    "  --floats         positions are given and stored as floats\n"
    "  --threads N      default 1\n"
    "  --quick          a frame of some small scenes of each class, by itself and followed\n"
    "  --list           what each scene has to untangle; nothing is untangled\n"
    "  --write FOLDER   writes input and result of each failure as OBJ files; with --all of each case\n"
    "  --models FOLDER  of our recordings (default: build/models)\n"
    "  --json OUT.json  the cases and the summary, and where they come from\n";

typedef struct untangle_choices {
    const char *class, *scene, *way, *size, *half, *folder, *models, *json_path;
    uint32_t first, last, every, thread_count;
    double max_seconds; /* 0: by size */
    double gap, steady;
    bool floats, quick, list, write_all;
} untangle_choices;

typedef struct corpus_run {
    const untangle_choices *choices;
    cscd_context *context;
    untangle_cases cases;
    json out;
} corpus_run;

/* ---- cases --------------------------------------------------------------------------------------------- */

static bool report_case(corpus_run *r, const untangle_trial *t, const untangle_case *c, io_error *error) {
    const untangle_choices *o = r->choices;
    print_case(c);
    write_case(&r->out, c);
    untangle_cases_add(&r->cases, c);
    const bool written = o->folder != NULL && (o->write_all || untangle_case_failed(c));
    return !written || untangle_trial_write(t, c, o->folder, error);
}

static bool is_wanted_frame(const untangle_choices *o, uint32_t frame) {
    return frame >= o->first && frame <= o->last;
}

static bool run_single(corpus_run *r, untangle_trial *t, io_error *error) {
    const untangle_choices *o = r->choices;
    uint32_t crossing = 0, run = 0;
    untangle_case c;
    for (uint32_t f = 0; f < t->scene.frame_count && !interrupted(); f++) {
        if (!t->tangled[f] || !is_wanted_frame(o, f) || crossing++ % o->every != 0) continue;
        if (o->quick && run++ == QUICK_FRAMES) break;
        if (!untangle_trial_run(t, f, false, &c, error) || !report_case(r, t, &c, error)) return false;
    }
    return true;
}

/* The result and the input of a frame become the start of the next one. */
static void keep_start(untangle_trial *t, const double *result, uint32_t frame) {
    const size_t size = (size_t)t->scene.vertex_count * 3 * sizeof(double);
    memcpy(t->start, result, size);
    memcpy(t->start_input, tangle_scene_frame(&t->scene, frame), size);
}

/* Follows crossing frames from one end, where the frame before it is clean, to the other or until one is not clean. */
static bool follow_frames(corpus_run *r, untangle_trial *t, uint32_t from, uint32_t to, io_error *error) {
    const untangle_choices *o = r->choices;
    const int way = to >= from ? 1 : -1;
    const uint32_t clean = from - (uint32_t)way;
    uint32_t run = 0;
    untangle_case c = {.clean = true};
    keep_start(t, tangle_scene_frame(&t->scene, clean), clean);
    for (uint32_t f = from; c.clean && !interrupted() && f != to + (uint32_t)way; f += (uint32_t)way) {
        if (way > 0 ? f > o->last : f < o->first) break;
        if (o->quick && run++ == QUICK_FRAMES) break;
        if (!untangle_trial_run(t, f, true, &c, error)) return false;
        if (is_wanted_frame(o, f) && !report_case(r, t, &c, error)) return false;
        keep_start(t, t->reached, f);
    }
    return true;
}

static bool run_followed(corpus_run *r, untangle_trial *t, io_error *error) {
    const uint32_t count = t->scene.frame_count;
    for (uint32_t f = 0, end; f < count && !interrupted(); f = end + 1) {
        end = f;
        if (!t->tangled[f]) continue;
        while (end + 1 < count && t->tangled[end + 1]) end++;
        if (f == 0 && end + 1 == count) return true;
        if (f > r->choices->last || end < r->choices->first) continue;
        if (!(f > 0 ? follow_frames(r, t, f, end, error) : follow_frames(r, t, end, f, error))) return false;
        if (r->choices->quick) break;
    }
    return true;
}

static void list_scene(const untangle_trial *t) {
    const corpus_entry *e = t->entry;
    size_t least = SIZE_MAX, most = 0;
    uint32_t crossing = 0, first = 0;
    for (uint32_t f = t->scene.frame_count; f-- > 0;) {
        if (t->pairs[f] == 0) continue;
        crossing++;
        first = f;
        if (t->pairs[f] < least) least = t->pairs[f];
        if (t->pairs[f] > most) most = t->pairs[f];
    }
    printf("%-6s %-24s %9u %7u %9u %6u %8zu %8zu%s\n", tangle_class_name(e->class), e->name,
           t->scene.triangle_count, t->scene.frame_count, crossing, first, crossing > 0 ? least : 0, most,
           e->held_out ? "  held out" : "");
}

static bool run_entry(corpus_run *r, const corpus_entry *e, io_error *error) {
    const untangle_choices *o = r->choices;
    untangle_trial t;
    if (!untangle_trial_open(e, r->context, o->gap, &t, error)) return false;
    t.floats = o->floats;
    t.steady = o->steady;
    t.wall_time = o->thread_count > 1;
    t.max_seconds = o->max_seconds > 0.0 ? o->max_seconds : o->quick ? 2.0 : e->large ? 120.0 : 60.0;
    bool good = true;
    if (o->list)
        list_scene(&t);
    else
        good = ((o->way != NULL && strcmp(o->way, "followed") == 0) || run_single(r, &t, error)) &&
               ((o->way != NULL && strcmp(o->way, "single") == 0) || run_followed(r, &t, error));
    untangle_trial_close(&t);
    return good;
}

static bool is_wanted(const untangle_choices *o, const corpus_entry *e) {
    return (o->class == NULL || strcmp(o->class, tangle_class_name(e->class)) == 0) &&
           (o->scene == NULL || strncmp(e->name, o->scene, strlen(o->scene)) == 0) &&
           (o->size == NULL || (strcmp(o->size, "large") == 0) == e->large) &&
           (o->half == NULL || (strcmp(o->half, "held-out") == 0) == e->held_out) &&
           (!o->quick || (e->quick && !e->large));
}

static bool run_corpus(corpus_run *r, const corpus *all, io_error *error) {
    bool good = true;
    if (r->choices->list)
        printf("class  scene                    triangles  frames  crossing  first    least     most\n");
    else
        print_case_heading();
    for (uint32_t i = 0; good && !interrupted() && i < all->count; i++)
        if (is_wanted(r->choices, &all->entries[i])) good = run_entry(r, &all->entries[i], error);
    if (r->choices->list) return good;
    print_summary(&r->cases);
    print_failures(&r->cases);
    write_summary(&r->out, &r->cases);
    return good;
}

/* ---- options ------------------------------------------------------------------------------------------- */

static bool refuse_argument(const char *argument, const char *why) {
    fprintf(stderr, "untangle: %s %s\n", argument, why);
    return false;
}

static bool parse_count(const char *text, uint32_t *out) {
    char *end;
    const unsigned long value = strtoul(text, &end, 10);
    *out = (uint32_t)value;
    return *text >= '0' && *text <= '9' && *end == '\0' && value <= NUMBER_MAX;
}

static bool parse_range(const char *text, untangle_choices *o) {
    char copy[32], *colon;
    if (strlen(text) >= sizeof copy) return false;
    strcpy(copy, text);
    colon = strchr(copy, ':');
    if (colon == NULL) return parse_count(copy, &o->first) && parse_count(copy, &o->last);
    *colon = '\0';
    return parse_count(copy, &o->first) && parse_count(colon + 1, &o->last) && o->first <= o->last;
}

static bool is_one_of(const char *text, const char *first, const char *second) {
    return strcmp(text, first) == 0 || strcmp(text, second) == 0;
}

static bool parse_value(const char *name, const char *value, untangle_choices *o, bool *known) {
    tangle_class class;
    *known = true;
    if (strcmp(name, "--class") == 0) return tangle_class_from_name(o->class = value, &class);
    if (strcmp(name, "--frames") == 0) return parse_range(value, o);
    if (strcmp(name, "--every") == 0) return parse_count(value, &o->every) && o->every > 0;
    if (strcmp(name, "--threads") == 0) return parse_count(value, &o->thread_count) && o->thread_count > 0;
    if (strcmp(name, "--time") == 0) return (o->max_seconds = atof(value)) > 0.0;
    if (strcmp(name, "--gap") == 0) return (o->gap = atof(value)) > 0.0;
    if (strcmp(name, "--steady") == 0) return (o->steady = atof(value)) >= 0.0 && o->steady < 1.0;
    if (strcmp(name, "--way") == 0) return is_one_of(o->way = value, "single", "followed");
    if (strcmp(name, "--size") == 0) return is_one_of(o->size = value, "small", "large");
    if (strcmp(name, "--half") == 0) return is_one_of(o->half = value, "tuned", "held-out");
    const char **text = strcmp(name, "--scene") == 0    ? &o->scene
                        : strcmp(name, "--write") == 0  ? &o->folder
                        : strcmp(name, "--models") == 0 ? &o->models
                        : strcmp(name, "--json") == 0   ? &o->json_path
                                                        : NULL;
    *known = text != NULL;
    if (*known) *text = value;
    return true;
}

static bool parse_arguments(int count, char **arguments, untangle_choices *o) {
    for (int i = 1; i < count; i++) {
        const char *name = arguments[i], *value = i + 1 < count ? arguments[i + 1] : "";
        bool known, *flag = strcmp(name, "--quick") == 0    ? &o->quick
                            : strcmp(name, "--floats") == 0 ? &o->floats
                            : strcmp(name, "--list") == 0   ? &o->list
                            : strcmp(name, "--all") == 0    ? &o->write_all
                                                            : NULL;
        if (flag != NULL) {
            *flag = true;
            continue;
        }
        const bool good = parse_value(name, value, o, &known);
        if (!known) return refuse_argument(name, "is no option");
        if (i + 1 == count) return refuse_argument(name, "wants a value");
        if (!good) return refuse_argument(value, "is no value for that option");
        i++;
    }
    return true;
}

static bool run_program(const untangle_choices *o, int argument_count, char **arguments, io_error *error) {
    corpus_run r = {.choices = o};
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = o->thread_count;
    if (!row_file_open(o->json_path, &r.out, error)) return false;
    if (cscd_context_create(&options, &r.context) != CSCD_OK) return io_fail(error, "no context");
    corpus all = corpus_list(o->models, getenv("CSCD_DATA"));
    row_file_begin(&r.out);
    const bool good = run_corpus(&r, &all, error) &&
                      row_file_close(o->json_path, argument_count, arguments, o->thread_count, &r.out, error);
    untangle_cases_free(&r.cases);
    corpus_free(&all);
    cscd_context_destroy(r.context);
    return good;
}

int main(int argument_count, char **arguments) {
    untangle_choices o = {.models = "build/models", .last = NUMBER_MAX, .every = 1, .thread_count = 1};
    io_error error;
    setvbuf(stdout, NULL, _IOLBF, 0);
    interrupt_catch();
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) {
        fputs(help, stdout);
        return 0;
    }
    if (!parse_arguments(argument_count, arguments, &o)) return 2;
    if (run_program(&o, argument_count, arguments, &error)) return 0;
    fprintf(stderr, "untangle: %s\n", error.text);
    return 1;
}
