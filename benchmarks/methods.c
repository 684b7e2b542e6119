/* The methods side by side on recordings: the tables of the thesis, and what each method loses. */
#include "benchmarks/lib/methods_report.h"
#include "benchmarks/lib/options.h"
#include "benchmarks/lib/row_file.h"
#include "benchmarks/lib/thesis_numbers.h"
#include "cscd/research.h"
#include "src/core/timer.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { SCENES_MAX = 64, KMEANS_RUNS = 5, REPEATS = 3 };

static const char help[] =
    "usage: methods [--quick] [--json OUT.json] [--threads N] [--cache FOLDER] [--data FOLDER] [SCENE...]\n"
    "\n"
    "Replays recordings with every method and prints the thesis's columns, what each method loses of the\n"
    "contacts that method none finds, and ratios. A contact list that breaks its method's guarantee is an\n"
    "error. '+' behind a method: mode earliest. 'kdop14': trees of 14-DOPs, not boxes. What is missing is "
    "made first, and not counted.\n"
    "\n"
    "  --quick          pawn-drop, dumbbell-stairs and figure-balls, one thread, fewer repeats\n"
    "  --json OUT.json  all rows, and where they come from\n"
    "  --threads N      default 1\n"
    "  --cache FOLDER   recordings and plans (default build/models)\n"
    "  --data FOLDER    more recordings, NAME.obj with NAME.pc2 (default: sequences/ in\n"
    "                   CSCD_DATA, if that is set)\n";

typedef struct methods_options {
    bool quick;
    const char *json_path, *cache, *data;
    uint32_t thread_count;
    const char *scenes[SCENES_MAX];
    uint32_t scene_count;
} methods_options;

static bool print_failure(const char *text) {
    fprintf(stderr, "methods: %s\n", text);
    return false;
}

static bool refuse_argument(const char *argument, const char *why) {
    fprintf(stderr, "methods: %s %s\n", argument, why);
    return false;
}

/* ---- what takes part --------------------------------------------------------------------------------- */

static bool enter_contest(methods_report *r, const entrant *e, uint32_t repeats, io_error *error) {
    if (!contest_run(r->truth, e, repeats, &r->results[r->count], error)) return false;
    r->count++;
    return true;
}

/* Enters a method, except one by regions when nothing is closed, for then there are none. */
static bool enter_method(methods_report *r, cscd_method method, cscd_mode mode, uint32_t repeats,
                         io_error *error) {
    if (method == CSCD_METHOD_CHARGE && r->truth->recording->charge == NULL) return true;
    entrant e = {.method = method, .mode = mode};
    snprintf(e.name, sizeof e.name, "%s%s", cscd_method_name(method), mode == CSCD_MODE_EARLIEST ? "+" : "");
    return enter_contest(r, &e, repeats, error);
}

/* Enters a method with trees of 14-DOPs, to measure whether they pay. */
static bool enter_kdop14(methods_report *r, cscd_method method, uint32_t repeats, io_error *error) {
    if (method == CSCD_METHOD_CHARGE && r->truth->recording->charge == NULL) return true;
    entrant e = {.method = method, .mode = CSCD_MODE_ALL, .volume = CSCD_VOLUME_KDOP14};
    snprintf(e.name, sizeof e.name, "%s kdop14", cscd_method_name(method));
    return enter_contest(r, &e, repeats, error);
}

/* Enters k-means with five seeded runs, as in the thesis. */
static bool enter_kmeans(methods_report *r, uint32_t k, cscd_mode mode, io_error *error) {
    if (r->truth->recording->charge == NULL) return true;
    entrant e = {.method = CSCD_METHOD_KMEANS, .mode = mode, .k = k, .seed = 1};
    snprintf(e.name, sizeof e.name, "kmeans:%u%s", k, mode == CSCD_MODE_EARLIEST ? "+" : "");
    return enter_contest(r, &e, KMEANS_RUNS, error);
}

static bool enter_all(methods_report *r, bool every_k, uint32_t repeats, io_error *error) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_ICCD, CSCD_METHOD_SINGLE,
                                          CSCD_METHOD_CHARGE};
    uint32_t n = r->regions, from = every_k ? (n > 3 ? n - 2 : 1) : n, to = every_k ? n + 2 : n;
    bool good = true;
    for (int i = 0; good && i < 4; i++) good = enter_method(r, methods[i], CSCD_MODE_ALL, repeats, error);
    for (uint32_t k = from; good && k <= to; k++) good = enter_kmeans(r, k, CSCD_MODE_ALL, error);
    for (int i = 2; good && i < 4; i++)
        good = enter_method(r, methods[i], CSCD_MODE_EARLIEST, repeats, error);
    for (uint32_t k = from; good && k <= to; k++) good = enter_kmeans(r, k, CSCD_MODE_EARLIEST, error);
    good = good && enter_kdop14(r, CSCD_METHOD_NONE, repeats, error) &&
           enter_kdop14(r, CSCD_METHOD_CHARGE, repeats, error);
    return good && enter_method(r, CSCD_METHOD_PUBLISHED, CSCD_MODE_ALL, repeats, error) &&
           enter_method(r, CSCD_METHOD_ICCD_PUBLISHED, CSCD_MODE_ALL, repeats, error);
}

/* ---- scenes ------------------------------------------------------------------------------------------ */

static const char *const own_scenes[] = {"pawn-drop",       "pawn-drop-free",
                                         "dumbbell-stairs", "dumbbell-stairs-free",
                                         "figure-balls",    "figure-balls-free"};

static bool is_own(const char *scene) {
    for (size_t i = 0; i < sizeof own_scenes / sizeof *own_scenes; i++) {
        if (strcmp(scene, own_scenes[i]) == 0) return true;
    }
    return false;
}

static int compare_names(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Adds the recordings in the data folder, sorted by name. When a folder is given, it must have some. */
static bool list_data(methods_options *o) {
    uint32_t first = o->scene_count;
    if (o->data == NULL) {
        printf("neither --data nor CSCD_DATA names a folder with recordings, so only our own\n");
        return true;
    }
    DIR *folder = opendir(o->data);
    for (struct dirent *entry; folder != NULL && (entry = readdir(folder)) != NULL;) {
        char *ending = strrchr(entry->d_name, '.');
        if (ending == NULL || strcmp(ending, ".pc2") != 0) continue;
        if (o->scene_count == SCENES_MAX) {
            printf("%s: %s and what follows are left out: too many recordings\n", o->data, entry->d_name);
            break;
        }
        char *name = strndup(entry->d_name, (size_t)(ending - entry->d_name));
        if (name != NULL) o->scenes[o->scene_count++] = name;
    }
    if (folder != NULL) closedir(folder);
    if (o->scene_count == first) return refuse_argument(o->data, "has no recordings");
    qsort(o->scenes + first, o->scene_count - first, sizeof *o->scenes, compare_names);
    return true;
}

static bool choose_scenes(methods_options *o) {
    if (o->scene_count > 0) return true;
    for (size_t i = 0; i < sizeof own_scenes / sizeof *own_scenes; i += o->quick ? 2 : 1)
        o->scenes[o->scene_count++] = own_scenes[i];
    return o->quick || list_data(o);
}

static bool run_scene(const methods_options *o, const char *scene, json *out, io_error *error) {
    recording_data data;
    truth known;
    methods_report r = {.count = 0};
    bool own = is_own(scene);
    if (!own && o->data == NULL)
        return io_fail(error, "%s: neither --data nor CSCD_DATA names a folder with this recording", scene);
    if (!recording_data_open(own ? o->cache : o->data, scene, o->cache, o->thread_count, &data, error))
        return false;
    if (data.made_ms > 1000.0)
        printf("\n%s: recording and plan made in %.1f s\n", scene, data.made_ms * 1e-3);
    bool good = truth_find(&data, &known, error);
    if (good) {
        r.truth = &known;
        r.regions = data.charge != NULL ? cscd_plan_region_count(data.charge) : 1;
        good = enter_all(&r, own && !o->quick, own && !o->quick ? REPEATS : 1, error);
        if (good) methods_report_print(&r);
        if (good) thesis_numbers_print(scene);
        if (good && out != NULL) methods_report_write(&r, out, o->thread_count);
        truth_free(&known);
    }
    fflush(stdout);
    recording_data_close(&data);
    return good;
}

/* ---- the program ------------------------------------------------------------------------------------- */

static bool run_scenes(const methods_options *o, json *out, io_error *error) {
    bool good = true;
    double since = timer_now_ms(), spent = 0.0;
    row_file_begin(out);
    for (uint32_t i = 0; good && i < o->scene_count; i++)
        good = run_scene(o, o->scenes[i], out->file != NULL ? out : NULL, error);
    timer_lap(&since, &spent);
    if (good) printf("\n%u recordings in %.0f s\n", o->scene_count, spent * 1e-3);
    return good;
}

static bool run_all(const methods_options *o, int argument_count, char **arguments) {
    json out;
    io_error error;
    return (row_file_open(o->json_path, &out, &error) && run_scenes(o, &out, &error) &&
            row_file_close(o->json_path, argument_count, arguments, o->thread_count, &out, &error)) ||
           print_failure(error.text);
}

/* Parses a whole number from 1 to 999. */
static bool parse_threads(const char *text, uint32_t *out) {
    size_t digits = strspn(text, "0123456789");
    *out = digits < 4 && text[digits] == '\0' ? (uint32_t)strtoul(text, NULL, 10) : 0;
    return *out > 0;
}

static bool parse_arguments(int count, char **arguments, methods_options *o) {
    for (int i = 1; i < count; i++) {
        const char *name = arguments[i], *value = i + 1 < count ? arguments[i + 1] : NULL;
        const char **text = strcmp(name, "--json") == 0    ? &o->json_path
                            : strcmp(name, "--cache") == 0 ? &o->cache
                            : strcmp(name, "--data") == 0  ? &o->data
                                                           : NULL;
        bool threads = strcmp(name, "--threads") == 0;
        if ((text != NULL || threads) && (value == NULL || value[0] == '-'))
            return refuse_argument(name, "wants a value");
        if (strcmp(name, "--quick") == 0) {
            o->quick = true;
        } else if (text != NULL) {
            *text = arguments[++i];
        } else if (threads) {
            if (!parse_threads(arguments[++i], &o->thread_count))
                return refuse_argument(value, "is no number of threads");
        } else if (name[0] == '-') {
            return refuse_argument(name, "is no option");
        } else if (o->scene_count == SCENES_MAX) {
            return refuse_argument(name, "is one scene too many");
        } else {
            o->scenes[o->scene_count++] = name;
        }
    }
    if (o->quick) o->thread_count = 1;
    return true;
}

int main(int argument_count, char **arguments) {
    methods_options o = {.cache = "build/models", .thread_count = 1};
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) {
        fputs(help, stdout);
        return 0;
    }
    if (!parse_arguments(argument_count, arguments, &o)) {
        fputs(help, stderr);
        return 2;
    }
    mkdir("build", 0777);
    mkdir(o.cache, 0777);
    char *data = bench_data_folder("sequences");
    if (o.data == NULL) o.data = data;
    bool good = choose_scenes(&o) && run_all(&o, argument_count, arguments);
    free(data);
    return good ? 0 : 1;
}
