/* Records cloth that falls, drapes and folds without ever passing through anything: a model, its frames, and
 * what it falls onto. */
#include "models/cloth/cloth_simulation.h"
#include "models/common/allocation_count.h"
#include "models/common/recording_files.h"
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

static void print_summary(const cloth_simulation *c, uint64_t late_allocations) {
    const cloth_scene *s = c->scene;
    const cloth_statistics *t = &c->statistics;
    double frames = t->frames;
    printf("%s: %s\n", s->name, s->text);
    printf("  %u frames of %u triangles, %g s each; thickness %.2g, certified %.2g\n", t->frames + 1,
           c->garment.triangle_count, s->frame_seconds, cloth_thickness(c), cloth_separation(c));
    printf(
        "  near: %.0f pairs a frame; %llu of %u motions were cut, for %llu contacts, in up to %llu rounds\n",
        (double)t->near_pairs / frames, (unsigned long long)t->motion.cut, t->frames,
        (unsigned long long)t->motion.contacts, (unsigned long long)t->most_rounds);
    printf(
        "  %llu motions began pressed together; %llu were shortened as a whole, obstacles waited %.2f frames\n",
        (unsigned long long)t->motion.tight, (unsigned long long)t->motion.fallbacks, t->waited);
    printf(
        "  %.2f ms a frame: solver %.2f, near %.2f, %.1f detector steps %.2f; %llu allocations in the last half\n",
        t->total_ms / frames, (t->total_ms - t->near_ms - t->step_ms) / frames, t->near_ms / frames,
        (double)t->motion.steps / frames, t->step_ms / frames, (unsigned long long)late_allocations);
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

/* Records one scene. user points to the resolution; 0 is the scene's own. */
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
            "a bag 45.\n"
            "`all` stands for all scenes:\n"
            "\n",
        .scene_count = cloth_scene_count,
        .scene_name = scene_name,
        .scene_text = scene_text,
        .record = record_scene,
        .user = &resolution};
    if (argument_count > 2 && strcmp(arguments[1], "--resolution") == 0) {
        if (!parse_resolution(arguments[2], &resolution)) return 2;
        arguments[2] = arguments[0];
        arguments += 2;
        argument_count -= 2;
    }
    return scene_program_run(&program, argument_count, arguments);
}
