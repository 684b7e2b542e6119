/* Programs that replay recordings one by one: their options, which recordings there are, and their JSON. */
#include "benchmarks/lib/recording_program.h"

#include "benchmarks/lib/options.h"
#include "src/core/system.h"
#include "src/core/timer.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_LENGTH = 4096 };

static bool print_failure(const recording_program *program, const char *text) {
    fprintf(stderr, "%s: %s\n", program->name, text);
    return false;
}

static bool refuse_argument(const recording_program *program, const char *argument, const char *why) {
    fprintf(stderr, "%s: %s %s\n", program->name, argument, why);
    return false;
}

/* ---- recordings -------------------------------------------------------------------------------------- */

static const char *const own_scenes[] = {"pawn-drop",       "pawn-drop-free",
                                         "dumbbell-stairs", "dumbbell-stairs-free",
                                         "figure-balls",    "figure-balls-free"};

bool recording_is_own(const char *scene) {
    for (size_t i = 0; i < sizeof own_scenes / sizeof *own_scenes; i++) {
        if (strcmp(scene, own_scenes[i]) == 0) return true;
    }
    return false;
}

static int compare_names(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Adds the recordings in the data folder, sorted by name. When a folder is given, it must have some. */
static bool list_data(const recording_program *program, replay_choices *o) {
    uint32_t first = o->scene_count;
    if (o->data == NULL) {
        printf("neither --data nor CSCD_DATA names a folder with recordings, so only our own\n");
        return true;
    }
    DIR *folder = opendir(o->data);
    for (struct dirent *entry; folder != NULL && (entry = readdir(folder)) != NULL;) {
        char *ending = strrchr(entry->d_name, '.');
        if (ending == NULL || strcmp(ending, ".pc2") != 0) continue;
        if (o->scene_count == RECORDINGS_MAX) {
            printf("%s: %s and what follows are left out: too many recordings\n", o->data, entry->d_name);
            break;
        }
        char *name = strndup(entry->d_name, (size_t)(ending - entry->d_name));
        if (name != NULL) o->scenes[o->scene_count++] = name;
    }
    if (folder != NULL) closedir(folder);
    if (o->scene_count == first) return refuse_argument(program, o->data, "has no recordings");
    qsort(o->scenes + first, o->scene_count - first, sizeof *o->scenes, compare_names);
    return true;
}

/* Pairs of frames that follow each other, and are named by the first one. */
static const char *const cloth_frames[][2] = {{"cloth_ball92", "cloth_ball93"},
                                              {"cloth_funnel227", "cloth_funnel228"}};

/* Finds the frames of that name; returns whether there are some. */
static bool find_cloth(const char *scene, char paths[2][PATH_LENGTH]) {
    char *folder = bench_data_folder("frames");
    bool found = false;
    for (size_t i = 0; folder != NULL && i < sizeof cloth_frames / sizeof *cloth_frames; i++) {
        if (strcmp(cloth_frames[i][0], scene) != 0) continue;
        for (int k = 0; k < 2; k++) snprintf(paths[k], PATH_LENGTH, "%s/%s.ply", folder, cloth_frames[i][k]);
        found = access(paths[0], F_OK) == 0;
    }
    free(folder);
    return found;
}

static void list_cloth(replay_choices *o) {
    char paths[2][PATH_LENGTH];
    for (size_t i = 0; i < sizeof cloth_frames / sizeof *cloth_frames; i++) {
        if (o->scene_count < RECORDINGS_MAX && find_cloth(cloth_frames[i][0], paths))
            o->scenes[o->scene_count++] = cloth_frames[i][0];
    }
}

static bool choose_scenes(const recording_program *program, replay_choices *o) {
    if (o->scene_count > 0) return true;
    for (size_t i = 0; i < sizeof own_scenes / sizeof *own_scenes; i += o->quick ? 2 : 1)
        o->scenes[o->scene_count++] = own_scenes[i];
    if (o->quick) return true;
    if (!list_data(program, o)) return false;
    if (program->takes_cloth) list_cloth(o);
    return true;
}

bool recording_program_open(const replay_choices *o, const char *scene, recording_data *out,
                            io_error *error) {
    bool own = recording_is_own(scene);
    char paths[2][PATH_LENGTH];
    if (find_cloth(scene, paths))
        return recording_data_open_frames(scene, paths[0], paths[1], o->thread_count, out, error);
    if (!own && o->data == NULL)
        return io_fail(error, "%s: neither --data nor CSCD_DATA names a folder with this recording", scene);
    if (!recording_data_open(own ? o->cache : o->data, scene, o->thread_count, out, error)) return false;
    if (out->made_ms > 1000.0)
        printf("\n%s: recording and plan made in %.1f s\n", scene, out->made_ms * 1e-3);
    return true;
}

/* ---- the program ------------------------------------------------------------------------------------- */

static bool run_scenes(const recording_program *program, const replay_choices *o, json *out,
                       io_error *error) {
    bool good = true;
    double since = timer_now_ms(), spent = 0.0;
    for (uint32_t i = 0; good && i < o->scene_count; i++) {
        good = program->run(program->state, o, o->scenes[i], out->file != NULL ? out : NULL, error);
        fflush(stdout);
    }
    timer_lap(&since, &spent);
    if (good && program->finish != NULL) program->finish(program->state);
    if (good) printf("\n%u recordings in %.0f s\n", o->scene_count, spent * 1e-3);
    return good;
}

static bool run_all(const recording_program *program, const replay_choices *o, int argument_count,
                    char **arguments) {
    json out;
    io_error error, of_file;
    if (!row_file_open(o->json_path, &out, &error)) return print_failure(program, error.text);
    row_file_begin(&out);
    const bool good = run_scenes(program, o, &out, &error) || print_failure(program, error.text);
    return (row_file_close(o->json_path, argument_count, arguments, o->thread_count, &out, &of_file) ||
            print_failure(program, of_file.text)) &&
           good;
}

/* Parses a whole number from 1 to 999. */
static bool parse_threads(const char *text, uint32_t *out) {
    size_t digits = strspn(text, "0123456789");
    *out = digits < 4 && text[digits] == '\0' ? (uint32_t)strtoul(text, NULL, 10) : 0;
    return *out > 0;
}

static bool has_option(const recording_program *program, const char *name, const char *wanted) {
    if (strcmp(name, wanted) != 0) return false;
    for (const char *const *option = program->options; *option != NULL; option++) {
        if (strcmp(*option, wanted) == 0) return true;
    }
    return false;
}

static bool parse_arguments(const recording_program *program, int count, char **arguments,
                            replay_choices *o) {
    for (int i = 1; i < count; i++) {
        const char *name = arguments[i], *value = i + 1 < count ? arguments[i + 1] : NULL;
        const char **text = strcmp(name, "--json") == 0    ? &o->json_path
                            : strcmp(name, "--cache") == 0 ? &o->cache
                            : strcmp(name, "--data") == 0  ? &o->data
                                                           : NULL;
        bool threads = has_option(program, name, "--threads"), simd = has_option(program, name, "--simd");
        if ((text != NULL || threads || simd) && (value == NULL || value[0] == '-'))
            return refuse_argument(program, name, "wants a value");
        if (strcmp(name, "--quick") == 0) {
            o->quick = true;
        } else if (text != NULL) {
            *text = arguments[++i];
        } else if (threads) {
            if (!parse_threads(arguments[++i], &o->thread_count))
                return refuse_argument(program, value, "is no number of threads");
        } else if (simd) {
            if (!cscd_from_name(CSCD_SIMDS, arguments[++i], (uint32_t *)&o->simd) ||
                (o->simd != CSCD_SIMD_AUTO && !processor_has_simd(o->simd)))
                return refuse_argument(program, value, "is no level of instructions that this processor has");
        } else if (name[0] == '-') {
            return refuse_argument(program, name, "is no option");
        } else if (o->scene_count == RECORDINGS_MAX) {
            return refuse_argument(program, name, "is one scene too many");
        } else {
            o->scenes[o->scene_count++] = name;
        }
    }
    if (o->quick) o->thread_count = 1;
    return true;
}

int recording_program_main(const recording_program *program, int argument_count, char **arguments) {
    replay_choices o = {.cache = "build/models", .thread_count = 1};
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) {
        fputs(program->help, stdout);
        return 0;
    }
    if (!parse_arguments(program, argument_count, arguments, &o)) {
        fputs(program->help, stderr);
        return 2;
    }
    mkdir("build", 0777);
    mkdir(o.cache, 0777);
    char *data = bench_data_folder("sequences");
    if (o.data == NULL) o.data = data;
    bool good = choose_scenes(program, &o) && run_all(program, &o, argument_count, arguments);
    free(data);
    return good ? 0 : 1;
}
