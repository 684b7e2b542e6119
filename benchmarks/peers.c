/* Embree's broad phase and CGAL's check compared with ours, on the same frames and in one run. */
#include "benchmarks/lib/options.h"
#include "benchmarks/peers/cgal_peer.h"
#include "benchmarks/peers/peer_scenes.h"
#include "benchmarks/peers/peer_trial.h"

#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: peers [options] [FIRST SECOND]...\n"
    "\n"
    "One thread, milliseconds of processor time; the programs take turns in every round. Each number is the least\n"
    "of the rounds; --json has the medians too. Scenes: each two mesh files with the same triangles; without files,\n"
    "scenes that are made here and, where they are at hand, published frames and recordings.\n"
    "\n"
    "The interval: cscd_detector_step with method none; of that, update and traversal (broad); single, whose start is\n"
    "known from the interval before or must be proven (new). Embree: rtcCollide of a scene with itself, the boxes of\n"
    "the swept triangles as user geometry, after a refit or a rebuild. x: beside Embree's refit; 0.5 is half its\n"
    "time. Pairs: whose bounds overlap. Embree's are boxes and it counts neighbours; cscd compares at both ends and\n"
    "leaves neighbours out, so these numbers differ.\n"
    "The start: cscd_detector_check with trees known; one-shot: with context, mesh, detector and trees. CGAL: making a\n"
    "Surface_mesh (set-up), and that with Polygon_mesh_processing::self_intersections (all). Both define the same\n"
    "pairs, except that CGAL lists triangles without area with themselves and leaves out their other pairs.\n"
    "\n"
    "  --rounds N       default 9\n"
    "  --quick          three rounds, and of the made scenes a tenth of the triangles\n"
    "  --scene NAME     only scenes whose name begins so\n"
    "  --data FOLDER    with frames/ and sequences/ (default: CSCD_DATA, if that is set)\n"
    "  --json OUT.json  the rows, and where they come from\n";

enum { PATH_LENGTH = 4096, FILES_MAX = 64, RESULTS_MAX = 40 };

typedef struct peer_options {
    uint32_t rounds;
    bool quick;
    const char *scene, *data, *json_path;
    const char *files[FILES_MAX];
    uint32_t file_count;
} peer_options;

typedef struct peer_result {
    char name[64];
    uint32_t triangle_count;
    peer_trial trial;
} peer_result;

typedef struct peer_results {
    const peer_options *options;
    peer_result *items;
    uint32_t count;
} peer_results;

/* ---- scenes ------------------------------------------------------------------------------------------ */

static bool wants_scene(const peer_options *o, const char *name) {
    return o->scene == NULL || strncmp(name, o->scene, strlen(o->scene)) == 0;
}

/* Runs a scene and frees it. */
static bool run_scene(peer_results *r, peer_scene *s, io_error *error) {
    bool good = true;
    if (wants_scene(r->options, s->name) && r->count < RESULTS_MAX) {
        peer_result *to = &r->items[r->count++];
        snprintf(to->name, sizeof to->name, "%s", s->name);
        to->triangle_count = s->triangle_count;
        good = peer_trial_run(s, r->options->rounds, &to->trial, error);
    }
    peer_scene_free(s);
    return good;
}

static bool run_files(peer_results *r, io_error *error) {
    bool good = true;
    for (uint32_t i = 0; good && i < r->options->file_count; i += 2) {
        peer_scene s;
        good = peer_scene_read(r->options->files[i], r->options->files[i + 1], &s, error) &&
               run_scene(r, &s, error);
    }
    return good;
}

static bool run_frames(peer_results *r, const char *folder, io_error *error) {
    static const struct {
        const char *name;
        int first;
    } frames[] = {{"cloth_ball", 92}, {"cloth_funnel", 227}};
    bool good = true;
    for (size_t i = 0; good && i < sizeof frames / sizeof *frames; i++) {
        char paths[2][PATH_LENGTH];
        peer_scene s;
        for (int k = 0; k < 2; k++)
            snprintf(paths[k], PATH_LENGTH, "%s/frames/%s%d.ply", folder, frames[i].name,
                     frames[i].first + k);
        good = peer_scene_read(paths[0], paths[1], &s, error) && run_scene(r, &s, error);
    }
    return good;
}

static bool run_recordings(peer_results *r, const char *folder, io_error *error) {
    static const struct {
        const char *name;
        uint32_t frame;
    } recordings[] = {{"hand_fist", 90}, {"coil_compress", 80}, {"elephant_dance", 60}};
    char path[PATH_LENGTH];
    bool good = true;
    snprintf(path, sizeof path, "%s/sequences", folder);
    for (size_t i = 0; good && i < sizeof recordings / sizeof *recordings; i++) {
        peer_scene s;
        good = peer_scene_replay(path, recordings[i].name, recordings[i].frame, &s, error) &&
               run_scene(r, &s, error);
    }
    return good;
}

static bool run_made(peer_results *r, io_error *error) {
    static const struct {
        peer_scene_kind kind;
        uint32_t triangle_count;
    } made[] = {{PEER_BALLS, 96000},
                {PEER_RODS, 98000},
                {PEER_CRUSHED, 80000},
                {PEER_PAWN, 20000},
                {PEER_PAWN, 150000}};
    bool good = true;
    for (size_t i = 0; good && i < sizeof made / sizeof *made; i++) {
        uint32_t count = r->options->quick ? made[i].triangle_count / 10 : made[i].triangle_count;
        peer_scene s;
        good = peer_scene_make(made[i].kind, count, &s, error) && run_scene(r, &s, error);
    }
    return good;
}

static bool run_all(peer_results *r, io_error *error) {
    const peer_options *o = r->options;
    if (o->file_count > 0) return run_files(r, error);
    if (o->data == NULL)
        puts("published frames and recordings: left out, neither --data nor CSCD_DATA names a folder");
    return (o->data == NULL || (run_frames(r, o->data, error) && run_recordings(r, o->data, error))) &&
           run_made(r, error);
}

/* ---- tables ------------------------------------------------------------------------------------------ */

static double ratio_of(const peer_trial *t, peer_turn turn, peer_turn beside) {
    return peer_trial_least(t, turn) / peer_trial_least(t, beside);
}

static void print_intervals(const peer_results *r) {
    printf("The interval, one thread, ms, least of %u; Embree %s\n", r->options->rounds, embree_peer_version);
    printf("%-18s %9s %8s %8s %8s %8s %8s %8s %6s %6s %6s %10s %10s %10s\n", "scene", "triangles", "none",
           "broad", "single", "new", "refit", "rebuild", "none x", "brd. x", "sgl. x", "pairs", "embree's",
           "contacts");
    for (uint32_t i = 0; i < r->count; i++) {
        const peer_trial *t = &r->items[i].trial;
        printf("%-18s %9u", r->items[i].name, r->items[i].triangle_count);
        for (int turn = TURN_NONE; turn <= TURN_EMBREE_REBUILD; turn++)
            printf(" %8.2f", peer_trial_least(t, (peer_turn)turn));
        printf(" %6.2f %6.2f %6.2f %10llu %10llu %10llu\n", ratio_of(t, TURN_NONE, TURN_EMBREE_REFIT),
               ratio_of(t, TURN_BROAD, TURN_EMBREE_REFIT), ratio_of(t, TURN_SINGLE, TURN_EMBREE_REFIT),
               (unsigned long long)t->our_boxes, (unsigned long long)t->embree_boxes,
               (unsigned long long)t->contacts);
    }
}

static void print_moments(const peer_results *r) {
    printf("\nThe start, one thread, ms, least of %u; CGAL %s\n", r->options->rounds, cgal_peer_version);
    printf("%-18s %9s %8s %8s %8s %8s %8s %10s  %s\n", "scene", "check", "one-shot", "set-up", "CGAL all",
           "check x", "once x", "pairs", "CGAL's");
    for (uint32_t i = 0; i < r->count; i++) {
        const peer_trial *t = &r->items[i].trial;
        printf("%-18s %9.2f %8.2f", r->items[i].name, peer_trial_least(t, TURN_CHECK),
               peer_trial_least(t, TURN_ONE_SHOT));
        if (t->cgal_left_out > 0) {
            printf(" a Surface_mesh has no place for %u triangles\n", t->cgal_left_out);
            continue;
        }
        printf(" %8.2f %8.2f %8.2f %8.2f %10llu  ", peer_trial_least(t, TURN_CGAL_SETUP),
               peer_trial_least(t, TURN_CGAL), ratio_of(t, TURN_CGAL, TURN_CHECK),
               ratio_of(t, TURN_CGAL, TURN_ONE_SHOT), (unsigned long long)t->our_pairs);
        if (t->ours_alone + t->cgal_alone == 0)
            puts("the same");
        else
            printf("%llu; %llu here only, %llu there only\n", (unsigned long long)t->cgal_pairs,
                   (unsigned long long)t->ours_alone, (unsigned long long)t->cgal_alone);
    }
}

static void write_row(const peer_result *row, json *out) {
    const peer_trial *t = &row->trial;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "scene", row->name);
    json_integer(out, "triangles", row->triangle_count);
    for (int turn = 0; turn < TURN_COUNT; turn++) {
        if (turn >= TURN_CGAL_SETUP && t->cgal_left_out > 0) continue;
        json_begin_object(out, peer_turn_names[turn]);
        json_number(out, "least_ms", peer_trial_least(t, (peer_turn)turn));
        json_number(out, "median_ms", peer_trial_median(t, (peer_turn)turn));
        json_end_object(out);
    }
    json_integer(out, "contacts", t->contacts);
    json_integer(out, "pairs", t->our_boxes);
    json_integer(out, "embree_pairs", t->embree_boxes);
    json_integer(out, "embree_reported", t->embree_reported);
    json_integer(out, "intersections", t->our_pairs);
    json_integer(out, "cgal_intersections", t->cgal_pairs);
    json_integer(out, "cgal_left_out", t->cgal_left_out);
    json_integer(out, "ours_alone", t->ours_alone);
    json_integer(out, "cgal_alone", t->cgal_alone);
    json_end_object(out);
}

static bool write_results(const peer_results *r, int argument_count, char **arguments, io_error *error) {
    json out;
    if (!row_file_open(r->options->json_path, &out, error)) return false;
    if (out.file == NULL) return true;
    json_string(&out, "embree", embree_peer_version);
    json_string(&out, "cgal", cgal_peer_version);
    json_integer(&out, "rounds", r->options->rounds);
    row_file_begin(&out);
    for (uint32_t i = 0; i < r->count; i++) write_row(&r->items[i], &out);
    return row_file_close(r->options->json_path, argument_count, arguments, 1, &out, error);
}

/* ---- the program ------------------------------------------------------------------------------------- */

static bool read_value(peer_options *o, const char *name, const char *value) {
    const char **text = strcmp(name, "--data") == 0    ? &o->data
                        : strcmp(name, "--json") == 0  ? &o->json_path
                        : strcmp(name, "--scene") == 0 ? &o->scene
                                                       : NULL;
    if (text != NULL) {
        *text = value;
        return true;
    }
    if (strcmp(name, "--rounds") != 0) return false;
    unsigned long rounds = strtoul(value, NULL, 10);
    o->rounds = (uint32_t)rounds;
    return rounds > 0 && rounds <= SAMPLES_MAX;
}

static bool read_arguments(int count, char **arguments, peer_options *o) {
    for (int i = 1; i < count; i++) {
        if (strcmp(arguments[i], "--quick") == 0) {
            o->quick = true;
        } else if (arguments[i][0] == '-') {
            if (i + 1 == count || !read_value(o, arguments[i], arguments[i + 1])) return false;
            i++;
        } else {
            if (o->file_count == FILES_MAX) return false;
            o->files[o->file_count++] = arguments[i];
        }
    }
    if (o->rounds == 0) o->rounds = o->quick ? 3 : 9;
    return o->file_count % 2 == 0;
}

int main(int argument_count, char **arguments) {
    const char *data = getenv("CSCD_DATA");
    peer_options o = {.data = data != NULL && data[0] != '\0' ? data : NULL};
    io_error error = {""};
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) {
        fputs(help, stdout);
        return 0;
    }
    if (!read_arguments(argument_count, arguments, &o)) {
        fputs(help, stderr);
        return 2;
    }
    peer_results r = {.options = &o, .items = body_allocate(RESULTS_MAX, sizeof *r.items)};
    bool good = run_all(&r, &error);
    if (good) {
        print_intervals(&r);
        print_moments(&r);
        good = write_results(&r, argument_count, arguments, &error);
    }
    if (!good) fprintf(stderr, "peers: %s\n", error.text);
    free(r.items);
    return good ? 0 : 1;
}
