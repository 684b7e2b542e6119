/* Records cloth that falls, drapes and folds without ever passing through anything: a model, its frames, and
 * what it falls onto. */
#include "models/cloth/cloth.h"
#include "models/common/scene_program.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The files of a recording, written side by side. */
typedef struct cloth_files {
    point_cache_writer *frames, *scenery_frames;
} cloth_files;

static bool obstacles_move(const cloth_scene *s) {
    bool move = false;
    for (uint32_t i = 0; i < s->obstacle_count; i++) move = move || s->obstacles[i].seconds > 0.0;
    return move;
}

/* Makes one body of all obstacles in their first positions. */
static body make_scenery(const cloth_simulation *c) {
    body scenery = {0};
    for (uint32_t i = 0; i < c->scene->obstacle_count; i++)
        body_append(&scenery, &c->obstacles[i], (double[3]){0.0, 0.0, 0.0});
    memcpy(scenery.positions, c->positions + c->garment.vertex_count * 3,
           (size_t)scenery.vertex_count * 3 * sizeof *scenery.positions);
    return scenery;
}

static bool open_outputs(const char *folder, const cloth_simulation *c, cloth_files *out, io_error *error) {
    const cloth_scene *s = c->scene;
    body scenery = make_scenery(c);
    bool good = recording_write_model(folder, s->name, ".obj", &c->garment, error) &&
                recording_write_model(folder, s->name, "-scenery.obj", &scenery, error) &&
                recording_open_frames(folder, s->name, ".pc2", c->garment.vertex_count, s->frame_count,
                                      &out->frames, error);
    if (good && obstacles_move(s))
        good = recording_open_frames(folder, s->name, "-scenery.pc2", scenery.vertex_count, s->frame_count,
                                     &out->scenery_frames, error);
    body_free(&scenery);
    return good;
}

static bool write_frame(const cloth_simulation *c, const cloth_files *out, io_error *error) {
    return point_cache_writer_write(out->frames, c->positions, error) &&
           (out->scenery_frames == NULL ||
            point_cache_writer_write(out->scenery_frames, c->positions + c->garment.vertex_count * 3, error));
}

/* Closes the files; false when one of them is not complete. */
static bool close_outputs(cloth_files *out, io_error *error) {
    bool good = out->frames == NULL || point_cache_writer_close(out->frames, error);
    if (out->scenery_frames != NULL) good = point_cache_writer_close(out->scenery_frames, error) && good;
    return good;
}

/* Prints the part of the summary that the response alone has. */
static void print_response(const cloth_statistics *t) {
    printf("  %llu of %u motions were changed, by %.0f contacts each; %.2f %% of vertices were stopped, "
           "%.2f %% truncated\n",
           (unsigned long long)t->cut, t->frames, t->cut > 0 ? (double)t->pushed / (double)t->cut : 0.0,
           100.0 * t->shares[CSCD_RESPONSE_STOPPED] / t->frames,
           100.0 * t->shares[CSCD_RESPONSE_TRUNCATED] / t->frames);
}

static void print_summary(const cloth_simulation *c, uint64_t late_allocations) {
    const cloth_scene *s = c->scene;
    const cloth_statistics *t = &c->statistics;
    double frames = t->frames;
    printf("%s: %s\n", s->name, s->text);
    printf("  %u frames of %u triangles, %g s each; certified %.2g; obstacles waited %.2f frames\n",
           t->frames + 1, c->garment.triangle_count, s->frame_seconds, cloth_separation(c), t->waited);
    print_response(t);
    printf(
        "  %.2f ms a frame: solver %.2f, %.1f rounds %.2f (up to %llu); %llu allocations in the last half\n",
        t->total_ms / frames, (t->total_ms - t->safe_ms) / frames, (double)t->rounds / frames,
        t->safe_ms / frames, (unsigned long long)t->most_rounds, (unsigned long long)late_allocations);
}

static bool record_frames(cloth_simulation *c, const char *folder, const uint64_t *allocations,
                          io_error *error) {
    cloth_files out = {NULL, NULL};
    uint64_t early = 0;
    const cloth_scene *s = c->scene;
    bool good = open_outputs(folder, c, &out, error);
    for (uint32_t frame = 0; good && frame < s->frame_count; frame++) {
        scene_program_show(s->name, frame, s->frame_count);
        if (frame == s->frame_count / 2) early = *allocations;
        good = (frame == 0 || cloth_advance(c, error)) && write_frame(c, &out, error);
    }
    scene_program_show(s->name, s->frame_count, s->frame_count);
    io_error closing;
    bool complete = close_outputs(&out, &closing);
    if (good && !complete) *error = closing;
    if (good && complete) print_summary(c, *allocations - early);
    return good && complete;
}

/* Records one scene. user points to the resolution; 0: the scene's own. */
static bool record_scene(void *user, uint32_t index, const char *folder, io_error *error) {
    const cloth_scene *s = &cloth_scenes[index];
    const uint32_t *resolution = user;
    uint64_t allocations = 0;
    cscd_context *context;
    cscd_context_options options = cscd_context_defaults();
    options.allocator = allocation_count_interface(&allocations);
    cscd_status status = cscd_context_create(&options, &context);
    if (status != CSCD_OK) return io_fail(error, "%s: %s", s->name, cscd_status_string(status));
    cloth_simulation c;
    bool good = cloth_open(s, *resolution, context, &c, error);
    if (good) {
        good = record_frames(&c, folder, &allocations, error);
        cloth_close(&c);
    }
    cscd_context_destroy(context);
    return good;
}

static bool parse_resolution(const char *text, uint32_t *out) {
    char *end;
    errno = 0;
    unsigned long value = strtoul(text, &end, 10);
    if (errno != 0 || *end != '\0' || value < CLOTH_RESOLUTION_MIN || value > CLOTH_RESOLUTION_MAX) {
        fprintf(stderr, "cloth: --resolution '%s': a number from %u to %u is wanted\n", text,
                CLOTH_RESOLUTION_MIN, CLOTH_RESOLUTION_MAX);
        return false;
    }
    *out = (uint32_t)value;
    return true;
}

/* Reads the options before the scenes; *first is what follows them. */
static bool parse_options(int count, char **arguments, uint32_t *resolution, int *first) {
    for (*first = 1; *first + 1 < count && strcmp(arguments[*first], "--resolution") == 0; *first += 2) {
        if (!parse_resolution(arguments[*first + 1], resolution)) return false;
    }
    return true;
}

static const char *scene_name(uint32_t index) {
    return cloth_scenes[index].name;
}

static const char *scene_text(uint32_t index) {
    return cloth_scenes[index].text;
}

int main(int argument_count, char **arguments) {
    uint32_t resolution = 0;
    const scene_program program = {
        .name = "cloth",
        .help =
            "usage: cloth [--resolution N] SCENE... FOLDER\n"
            "\n"
            "Simulates cloth and writes, for each scene, FOLDER/SCENE.obj and SCENE.pc2, and what the cloth\n"
            "falls onto as SCENE-scenery.obj and, if it moves, SCENE-scenery.pc2. The folder must exist.\n"
            "N, 12 to 500, is the number of vertices along a side or around a tube; the default is 60, of "
            "a bag 45. `all` stands for all scenes:\n"
            "\n",
        .scene_count = cloth_scene_count,
        .scene_name = scene_name,
        .scene_text = scene_text,
        .record = record_scene,
        .user = &resolution};
    int first;
    if (!parse_options(argument_count, arguments, &resolution, &first)) return 2;
    arguments[first - 1] = arguments[0];
    return scene_program_run(&program, argument_count - first + 1, arguments + first - 1);
}
