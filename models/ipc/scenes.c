/* The scenes of the IPC solver: bodies, their materials, and obstacles. */
#include "models/ipc/ipc.h"
#include "models/shapes/bodies.h"
#include "models/shapes/rings.h"

#include <math.h>
#include <string.h>

enum { LINKS = 6, PLATE_DIVISIONS = 4 };

static const double link_radius = 1.0, link_thickness = 0.22, link_spacing = 1.4;

/* Places a point on the tube of an upright ring, whose axis is y. */
static void place_upright(double radius, double height, double angle, double point[3]) {
    point[0] = radius * cos(angle);
    point[1] = -height;
    point[2] = radius * sin(angle);
}

static void scale_and_move(body *b, const double scale[3], const double offset[3]) {
    for (uint32_t i = 0; i < b->vertex_count * 3; i++)
        b->positions[i] = scale[i % 3] * b->positions[i] + offset[i % 3];
    body_round(b);
}

/* Makes a chain along x: every second ring stands upright, it is a tenth longer than taut, and its first
 * ring does not move. */
static uint32_t make_rings(uint32_t triangle_count, ipc_object objects[IPC_OBJECTS_MAX]) {
    outline o = {.closed = true, .end = {link_radius + link_thickness, 0.0}};
    outline_arc(&o, link_radius, 0.0, link_thickness, 0.0, 360.0);
    for (uint32_t i = 0; i < LINKS; i++) {
        objects[i] = (ipc_object){.obstacle = i == 0};
        body_add_rings(&objects[i].shape, &o, triangle_count / LINKS / 2 * 2,
                       i % 2 == 0 ? place_upright : NULL);
        scale_and_move(&objects[i].shape, (double[3]){1.0, 1.0, 1.0},
                       (double[3]){link_spacing * i, 0.0, 0.0});
    }
    return LINKS;
}

static ipc_object make_plate(double height, double travel) {
    ipc_object plate = {.obstacle = true, .travel = {0.0, 0.0, travel}};
    add_cube(&plate.shape, PLATE_DIVISIONS);
    scale_and_move(&plate.shape, (double[3]){2.0, 2.0, 0.1}, (double[3]){0.0, 0.0, height});
    return plate;
}

/* Makes a coil between two plates; the upper one comes down. */
static uint32_t make_press(uint32_t triangle_count, ipc_object objects[IPC_OBJECTS_MAX]) {
    const uint32_t plates = 2 * 12 * PLATE_DIVISIONS * PLATE_DIVISIONS;
    objects[0] = (ipc_object){.obstacle = false};
    add_coil(&objects[0].shape, (triangle_count > plates + 1000 ? triangle_count - plates : 1000) / 2 * 2);
    body_round(&objects[0].shape);
    double low = 0.0, high = 0.0;
    for (uint32_t v = 0; v < objects[0].shape.vertex_count; v++) {
        low = fmin(low, objects[0].shape.positions[v * 3 + 2]);
        high = fmax(high, objects[0].shape.positions[v * 3 + 2]);
    }
    objects[1] = make_plate(low - 0.13, 0.0);
    objects[2] = make_plate(high + 0.13, -2.1);
    return 3;
}

const ipc_scene ipc_scenes[] = {
    {
        .name = "rings",
        .text = "a chain of linked rings hangs from the first one and swings",
        .triangle_count = 3600,
        .make = make_rings,
        .stuff = {.density = 1.0, .membrane = 800.0, .solid = 4000.0},
        .gravity = 10.0,
        .barrier = {.reach = 0.02, .stiffness = 400.0},
        .min_separation = 2e-5,
        .travel_seconds = 1.0,
        .step_seconds = 1.0 / 60.0,
        .steps = 1,
        .frame_count = 180,
    },
    {
        .name = "press",
        .text = "a coil is pressed between two plates, turn onto turn, and let go",
        .triangle_count = 5000,
        .make = make_press,
        .stuff = {.density = 1.0, .membrane = 3000.0, .solid = 15000.0},
        .gravity = 1.0,
        .barrier = {.reach = 0.02, .stiffness = 2000.0},
        .min_separation = 2e-5,
        .travel_seconds = 2.5,
        .step_seconds = 1.0 / 60.0,
        .steps = 1,
        .frame_count = 180,
    },
};

const uint32_t ipc_scene_count = sizeof ipc_scenes / sizeof *ipc_scenes;

const ipc_scene *ipc_scene_find(const char *name) {
    for (uint32_t i = 0; i < ipc_scene_count; i++) {
        if (strcmp(ipc_scenes[i].name, name) == 0) return &ipc_scenes[i];
    }
    return NULL;
}

double ipc_scene_travelled(const ipc_scene *s, double seconds) {
    double phase = 2.0 * fmod(seconds / s->travel_seconds, 1.0), share = phase < 1.0 ? phase : 2.0 - phase;
    return share * share * (3.0 - 2.0 * share);
}
