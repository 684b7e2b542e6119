/* A picture of cells, particles and the vertices that these have visited. */
#include "sensors/tool/sense.h"

#include "tool/picture/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const uint8_t particle_colour[4] = {255, 255, 255, 255};
static const uint8_t warning_colour[4] = {220, 50, 32, 255};
static const uint8_t path_colour[4] = {40, 40, 40, 255};

/* ---- where they have been ---------------------------------------------------------------------------- */

sense_paths sense_paths_none(void) {
    return (sense_paths){.steps = growable_of(sizeof(uint32_t[2]))};
}

void sense_paths_free(sense_paths *p) {
    free(p->places);
    growable_free(&p->steps);
}

void sense_paths_break(sense_paths *p) {
    p->particle_count = 0;
}

static bool add_step(sense_paths *p, uint32_t from, uint32_t to) {
    if (from == to) return true;
    uint32_t *step = growable_push(&p->steps);
    if (step == NULL) return false;
    step[0] = from;
    step[1] = to;
    return true;
}

bool sense_paths_follow(sense_paths *p, const cscd_sensors *sensors) {
    uint32_t count = cscd_sensors_particle_count(sensors);
    uint32_t *places = calloc((size_t)count + 1, sizeof *places);
    bool good = places != NULL;
    for (uint32_t i = 0; good && i < count; i++) {
        places[i] = cscd_sensors_particle(sensors, i);
        if (p->particle_count == count) good = add_step(p, p->places[i], places[i]);
    }
    free(p->places);
    p->places = places;
    p->particle_count = good ? count : 0;
    return good;
}

/* ---- the picture ------------------------------------------------------------------------------------- */

/* A scene and its arrays. */
typedef struct canvas {
    picture_scene scene;
    uint32_t *triangles;
    uint8_t *colours;
    growable markers; /* of picture_marker */
    picture_legend legend[3];
    char caption[160];
} canvas;

/* Each triangle has the colour of the cell that two of its vertices are in, or else of its first one's. */
static bool colour_cells(canvas *c, const sense_view *view) {
    const cscd_mesh *mesh = view->recording->mesh;
    size_t count = cscd_mesh_triangle_count(mesh);
    c->triangles = malloc(count * 3 * sizeof *c->triangles);
    c->colours = malloc(count * 3);
    if (c->triangles == NULL || c->colours == NULL) return false;
    for (uint32_t t = 0; t < count; t++) {
        uint32_t *v = c->triangles + (size_t)t * 3, cells[3];
        cscd_mesh_triangle(mesh, t, v);
        for (int i = 0; i < 3; i++) cells[i] = cscd_sensors_vertex_cell(view->sensors, v[i]);
        picture_colour_category(cells[1] == cells[2] ? cells[1] : cells[0], c->colours + (size_t)t * 3);
    }
    return true;
}

static bool add_marker(canvas *c, const double position[3], float radius, const uint8_t colour[4]) {
    picture_marker *marker = growable_push(&c->markers);
    if (marker == NULL) return false;
    memcpy(marker->position, position, sizeof marker->position);
    memcpy(marker->colour, colour, sizeof marker->colour);
    marker->radius_pixels = radius;
    return true;
}

static double extent_of(const sense_view *view) {
    double extent = 0.0;
    for (size_t i = 0; i < (size_t)cscd_mesh_vertex_count(view->recording->mesh) * 3; i++)
        extent = fmax(extent, fabs(view->positions[i] - view->positions[i % 3]));
    return extent;
}

/* Dots along the straight line from vertex to vertex. */
static bool mark_step(canvas *c, const sense_view *view, const uint32_t step[2], double spacing) {
    const double *p = view->positions + (size_t)step[0] * 3, *q = view->positions + (size_t)step[1] * 3;
    double length =
        sqrt((q[0] - p[0]) * (q[0] - p[0]) + (q[1] - p[1]) * (q[1] - p[1]) + (q[2] - p[2]) * (q[2] - p[2]));
    uint32_t count = spacing > 0.0 && length < 1e3 * spacing ? (uint32_t)(length / spacing) + 1 : 1;
    for (uint32_t i = 0; i <= count; i++) {
        double s = (double)i / count, at[3];
        for (int k = 0; k < 3; k++) at[k] = p[k] + s * (q[k] - p[k]);
        if (!add_marker(c, at, 1.5f, path_colour)) return false;
    }
    return true;
}

static bool mark_paths(canvas *c, const sense_view *view) {
    double spacing = extent_of(view) / 200.0;
    const uint32_t(*steps)[2] = view->paths->steps.data;
    for (size_t i = 0; i < view->paths->steps.count; i++)
        if (!mark_step(c, view, steps[i], spacing)) return false;
    return true;
}

static bool mark_particles(canvas *c, const sense_view *view) {
    const cscd_warnings none = {.count = 0}, *warnings = view->warnings != NULL ? view->warnings : &none;
    for (uint32_t i = 0; i < cscd_sensors_particle_count(view->sensors); i++) {
        size_t v = cscd_sensors_particle(view->sensors, i);
        if (!add_marker(c, view->positions + v * 3, 5.0f, particle_colour)) return false;
    }
    for (size_t i = 0; i < warnings->count; i++) {
        size_t v[2] = {warnings->items[i].vertex_a, warnings->items[i].vertex_b};
        for (int k = 0; k < 2; k++)
            if (!add_marker(c, view->positions + v[k] * 3, 7.0f, warning_colour)) return false;
    }
    return true;
}

static void set_texts(canvas *c, const sense_view *view) {
    static const char *const texts[3] = {"particle", "nearest particles of a warning",
                                         "where particles have been"};
    const uint8_t *const colours[3] = {particle_colour, warning_colour, path_colour};
    for (int i = 0; i < 3; i++) {
        memcpy(c->legend[i].colour, colours[i], 3);
        c->legend[i].text = texts[i];
    }
    int used = snprintf(c->caption, sizeof c->caption, "frame %d: %u cells", view->frame,
                        cscd_sensors_cell_count(view->sensors));
    if (view->warnings != NULL)
        snprintf(c->caption + used, sizeof c->caption - (size_t)used, ", %zu warning%s",
                 view->warnings->count, view->warnings->count == 1 ? "" : "s");
}

bool sense_picture_draw(const sense_view *view, const sense_options *options, io_error *error) {
    canvas c = {.markers = growable_of(sizeof(picture_marker))};
    bool made = colour_cells(&c, view) && mark_paths(&c, view) && mark_particles(&c, view);
    set_texts(&c, view);
    c.scene = (picture_scene){.vertex_count = cscd_mesh_vertex_count(view->recording->mesh),
                              .triangle_count = cscd_mesh_triangle_count(view->recording->mesh),
                              .positions = view->positions,
                              .triangles = c.triangles,
                              .triangle_colours = c.colours,
                              .markers = c.markers.data,
                              .marker_count = c.markers.count,
                              .caption = c.caption,
                              .legend = c.legend,
                              .legend_count = 3};
    bool drawn = made ? picture_render(&c.scene, &options->picture, options->picture_path, error)
                      : io_fail(error, "out of memory");
    free(c.triangles);
    free(c.colours);
    growable_free(&c.markers);
    return drawn;
}
