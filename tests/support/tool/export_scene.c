/* A small recording of two objects, and a run of the library over it that exports each frame. */
#include "tests/support/tool/export_scene.h"

#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A cuboid of six quads, counter-clockwise from outside; polygon 3 is where x is largest. */
static int print_cuboid(char *text, size_t room, const char *name, int first, const double low[3],
                        const double high[3]) {
    static const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 4, 6, 2},
                                    {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}};
    int used = snprintf(text, room, "o %s\n", name);
    for (int v = 0; v < 8; v++)
        used += snprintf(text + used, room - (size_t)used, "v %.17g %.17g %.17g\n", (v & 1 ? high : low)[0],
                         (v & 2 ? high : low)[1], (v & 4 ? high : low)[2]);
    for (int q = 0; q < 6; q++)
        used += snprintf(text + used, room - (size_t)used, "f %d %d %d %d\n", first + quads[q][0],
                         first + quads[q][1], first + quads[q][2], first + quads[q][3]);
    return used;
}

static temp_path write_wall(const temp_folder *folder) {
    char text[4096];
    int used = print_cuboid(text, sizeof text, "Box", 1, (double[]){-1, -1, -1}, (double[]){1, 1, 1});
    used += print_cuboid(text + used, sizeof text - (size_t)used, "Seed", 9, (double[]){-0.1, -0.1, -0.1},
                         (double[]){0.1, 0.1, 0.1});
    return temp_file_write(folder, "wall.obj", text, (size_t)used);
}

/* Returns the first of the bar's frames. */
static temp_path write_bar(const temp_folder *folder) {
    static const double reach[FRAMES] = {0.5, 1.5, 0.75};
    temp_path paths[FRAMES];
    for (int i = 0; i < FRAMES; i++) {
        char name[32], text[2048];
        snprintf(name, sizeof name, "bar_%04d.obj", FIRST_FRAME + i);
        const int used = print_cuboid(text, sizeof text, "Rod", 1, (double[]){reach[i], -0.2, -0.125},
                                      (double[]){3, 0.125, 0.2});
        paths[i] = temp_file_write(folder, name, text, (size_t)used);
    }
    return paths[0];
}

static void open_recording(export_scene *s) {
    io_error error;
    recording_options *options = &s->options;
    s->bar_path = write_bar(&s->folder);
    s->bar_pattern = temp_file_path(&s->folder, "bar_%04d.obj");
    s->wall_path = write_wall(&s->folder);
    options->objects.count = 2;
    options->objects.items[0] = (named_path){.name = "wall", .path = s->wall_path.text};
    options->objects.items[1] = (named_path){.name = "bar", .path = s->bar_path.text};
    options->frames_of.count = 1;
    options->frames_of.items[0] = (named_path){.name = "bar", .path = s->bar_pattern.text};
    if (!recording_open(options, &s->recording, &error)) fail_msg("%s", error.text);
}

void export_scene_open(export_scene *s, const temp_folder *folder, bool plan) {
    io_error error;
    *s = (export_scene){.folder = *folder};
    open_recording(s);
    assert_true(part_names_find(&s->recording, NULL, &s->parts, &error));
    const uint32_t count = cscd_mesh_vertex_count(s->recording.mesh);
    s->x0 = malloc(3 * count * sizeof *s->x0);
    s->x1 = malloc(3 * count * sizeof *s->x1);
    recording_rest(&s->recording, s->x0);
    cscd_context *context = s->recording.context;
    const cscd_view *rest = CSCD_DOUBLES(s->x0, count);
    if (plan) assert_int_equal(cscd_plan_create(context, s->recording.mesh, rest, NULL, &s->plan), CSCD_OK);
    assert_int_equal(cscd_detector_create(context, s->recording.mesh, s->plan, NULL, &s->detector), CSCD_OK);
}

void export_scene_close(export_scene *s) {
    io_error error;
    if (!exports_close(&s->exports, &error)) fail_msg("%s", error.text);
    cscd_detector_destroy(s->detector);
    cscd_plan_destroy(s->plan);
    part_names_free(&s->parts);
    recording_close(&s->recording);
    free(s->contacts);
    free(s->x0);
    free(s->x1);
}

void export_scene_start(export_scene *s, const export_request *request) {
    io_error error;
    if (!exports_open(request, &s->recording, &s->parts, s->plan, &s->exports, &error))
        fail_msg("%s", error.text);
}

/* Contacts live until the detector's next call, so they are copied. */
static void step_to(export_scene *s, uint32_t count) {
    cscd_contacts contacts;
    const cscd_view *x0 = CSCD_DOUBLES(s->x0, count), *x1 = CSCD_DOUBLES(s->x1, count);
    assert_int_equal(cscd_detector_step(s->detector, x0, x1, &contacts), CSCD_OK);
    exports_add_contacts(&s->exports, &contacts);
    s->contacts = malloc((contacts.count + 1) * sizeof *s->contacts);
    s->contact_count = contacts.count;
    if (contacts.count > 0) memcpy(s->contacts, contacts.items, contacts.count * sizeof *s->contacts);
}

void export_scene_add_frame(export_scene *s, uint32_t frame) {
    io_error error;
    cscd_intersection_options options = cscd_intersection_defaults();
    options.curves = options.patches = options.depths = true;
    const uint32_t count = cscd_mesh_vertex_count(s->recording.mesh);
    double *swap = s->x0;
    s->x0 = s->x1;
    s->x1 = swap;
    if (!recording_read(&s->recording, frame, s->x1, &error)) fail_msg("%s", error.text);
    free(s->contacts);
    s->contacts = NULL;
    s->contact_count = 0;
    if (frame > 0) step_to(s, count);
    const cscd_view *positions = CSCD_DOUBLES(s->x1, count);
    assert_int_equal(cscd_detector_find_intersections(s->detector, positions, &options, &s->found), CSCD_OK);
    if (!exports_add_frame(&s->exports, frame, s->x1, &s->found, &error)) fail_msg("%s", error.text);
}
