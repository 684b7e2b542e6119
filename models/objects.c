/* Records several closed objects that touch and part, for the sensors between objects: one model and its
 * frames. */
#include "models/objects/objects.h"
#include "models/common/scene_program.h"
#include "models/softbody/softbody.h"

#include <stdio.h>

/* A scene in which objects move by formula or, when stage.scene is NULL, the soft bodies. */
typedef struct object_recording {
    const char *name, *text;
    uint32_t frame_count;
    object_stage stage;
    tumble bodies;
    const body *shape;
    const double *frame;
} object_recording;

static bool open_recording(uint32_t index, cscd_context *context, object_recording *r, io_error *error) {
    if (index < object_scene_count) {
        const object_scene *s = &object_scenes[index];
        if (!object_stage_open(s, &r->stage, error)) return false;
        r->name = s->name;
        r->text = s->text;
        r->frame_count = s->frame_count;
        r->shape = &r->stage.placed;
        r->frame = r->stage.placed.positions;
        return true;
    }
    if (!tumble_open(context, &r->bodies, error)) return false;
    r->name = tumble_name;
    r->text = tumble_text;
    r->frame_count = TUMBLE_FRAMES;
    r->shape = &r->bodies.shape;
    r->frame = r->bodies.frame;
    return true;
}

static void close_recording(object_recording *r) {
    if (r->stage.scene != NULL)
        object_stage_close(&r->stage);
    else
        tumble_close(&r->bodies);
}

static bool go_to_frame(object_recording *r, uint32_t frame, io_error *error) {
    if (r->stage.scene == NULL) return frame == 0 || tumble_advance(&r->bodies, error);
    object_stage_go(&r->stage, frame);
    return true;
}

static bool write_scenery(const object_recording *r, const char *folder, io_error *error) {
    body scenery = {0};
    if (r->stage.scene != NULL) return true;
    bool good = scenery_make(&r->bodies.around, &scenery, error) &&
                recording_write_model(folder, r->name, "-scenery.obj", &scenery, error);
    body_free(&scenery);
    return good;
}

static bool record_frames(object_recording *r, point_cache_writer *frames, census *c, cscd_context *context,
                          io_error *error) {
    bool good = true;
    for (uint32_t frame = 0; good && frame < r->frame_count; frame++) {
        scene_program_show(r->name, frame, r->frame_count);
        good = go_to_frame(r, frame, error);
        cscd_status status = good ? census_add(c, r->frame) : CSCD_OK;
        if (status != CSCD_OK)
            good = io_fail(error, "%s: frame %u: %s: %s", r->name, frame, cscd_status_string(status),
                           cscd_context_detail(context));
        good = good && point_cache_writer_write(frames, r->frame, error);
    }
    scene_program_show(r->name, r->frame_count, r->frame_count);
    return good;
}

static void print_summary(const object_recording *r, const census *c, double milliseconds) {
    printf("%s: %s\n", r->name, r->text);
    printf("  %u frames of %u objects, %u triangles; %.1f s\n", c->frame_count, c->object_count,
           r->shape->triangle_count, 1e-3 * milliseconds);
    printf("  contacts between objects in %u of %u intervals, of %u pairs of objects; within objects in %u\n",
           c->between_intervals, c->frame_count - 1, census_pair_count(c), c->within_intervals);
    printf("  %llu contacts, intersections in %u of %u frames\n", (unsigned long long)c->contacts,
           c->intersecting_frames, c->frame_count);
    printf("  mean edge %.3g; motion: at most %.1f of it from frame to frame\n", c->edge_length,
           c->largest_motion);
}

static bool record_census(object_recording *r, census *c, cscd_context *context, const char *folder,
                          io_error *error) {
    point_cache_writer *frames = NULL;
    double start = clock_now_ms();
    bool good = recording_write_model(folder, r->name, ".obj", r->shape, error) &&
                write_scenery(r, folder, error) &&
                recording_open_frames(folder, r->name, ".pc2", r->shape->vertex_count, r->frame_count,
                                      &frames, error) &&
                record_frames(r, frames, c, context, error);
    io_error closing;
    bool complete = frames == NULL || point_cache_writer_close(frames, &closing);
    if (good && !complete) *error = closing;
    if (good && complete) print_summary(r, c, clock_now_ms() - start);
    return good && complete;
}

static bool record_opened(object_recording *r, cscd_context *context, const char *folder, io_error *error) {
    const cscd_object_desc desc =
        cscd_object_of_triangles(r->shape->vertex_count, r->shape->triangle_count, r->shape->triangles);
    cscd_mesh *mesh = NULL;
    census c;
    cscd_status status = cscd_mesh_create(context, &desc, 1, &mesh);
    if (status == CSCD_OK) status = census_begin(mesh, &c);
    bool good = status == CSCD_OK ? record_census(r, &c, context, folder, error)
                                  : io_fail(error, "%s: %s", r->name, cscd_context_detail(context));
    if (status == CSCD_OK) census_free(&c);
    cscd_mesh_destroy(mesh);
    return good;
}

static bool record_scene(void *user, uint32_t index, const char *folder, io_error *error) {
    object_recording r = {.name = NULL};
    cscd_context *context = NULL;
    (void)user;
    cscd_status status = cscd_context_create(NULL, &context);
    if (status != CSCD_OK) return io_fail(error, "objects: %s", cscd_status_string(status));
    bool good = open_recording(index, context, &r, error);
    if (good) {
        good = record_opened(&r, context, folder, error);
        close_recording(&r);
    }
    cscd_context_destroy(context);
    return good;
}

static const char *scene_name(uint32_t index) {
    return index < object_scene_count ? object_scenes[index].name : tumble_name;
}

static const char *scene_text(uint32_t index) {
    return index < object_scene_count ? object_scenes[index].text : tumble_text;
}

int main(int argument_count, char **arguments) {
    const scene_program program = {
        .name = "objects",
        .help =
            "usage: objects SCENE... FOLDER\n"
            "\n"
            "Moves several closed objects so that they touch and part, and writes, for each scene,\n"
            "FOLDER/SCENE.obj and SCENE.pc2, and where bodies fall into a tray, that as SCENE-scenery.obj.\n"
            "The folder must exist. `all` stands for all scenes:\n"
            "\n",
        .scene_count = object_scene_count + 1,
        .scene_name = scene_name,
        .scene_text = scene_text,
        .record = record_scene};
    return scene_program_run(&program, argument_count, arguments);
}
