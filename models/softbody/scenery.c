/* The obstacles as a mesh for pictures. */
#include "models/softbody/scenery.h"
#include "models/shapes/catalogue.h"

enum { BALL_TRIANGLES = 1280 };

/* How far ground and steps extend to all sides, and the ground downwards. */
static const double reach = 12.0, thickness = 0.5;

/* Walls are drawn this low so that one sees into the tray. */
static const double wall = 0.1, wall_height = 0.3;

/* The bits of a corner's number, 0 to 7, are its x, y and z. */
static void add_box(body *b, const double low[3], const double high[3]) {
    static const uint8_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    uint32_t first = b->vertex_count;
    for (uint32_t i = 0; i < 8; i++)
        body_add_vertex(b, i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
    for (uint32_t i = 0; i < 6; i++) {
        const uint8_t *s = sides[i];
        body_add_triangle(b, first + s[0], first + s[1], first + s[2]);
        body_add_triangle(b, first + s[0], first + s[2], first + s[3]);
    }
}

static void add_walls(body *b, double inner) {
    double outer = inner + wall;
    for (int side = -1; side <= 1; side += 2) {
        double near = side > 0 ? inner : -outer;
        add_box(b, (double[3]){near, -outer, 0.0}, (double[3]){near + wall, outer, wall_height});
        add_box(b, (double[3]){-inner, near, 0.0}, (double[3]){inner, near + wall, wall_height});
    }
}

static void place_ball(const ball *which, const body *sphere, double *positions) {
    for (uint32_t i = 0; i < sphere->vertex_count * 3; i++)
        positions[i] = which->centre[i % 3] + which->radius * sphere->positions[i];
}

/* Makes a ball from the sphere of the catalogue; the balls are the last vertices. */
static bool make_sphere(body *out, io_error *error) {
    return body_make(BODY_SPHERE, body_nearest_count(BODY_SPHERE, BALL_TRIANGLES), out, error);
}

bool scenery_make(const obstacles *o, body *out, io_error *error) {
    body made = {0}, sphere;
    if (!make_sphere(&sphere, error)) return false;
    add_box(&made, (double[3]){-reach, -reach, -thickness}, (double[3]){reach, reach, 0.0});
    if (o->tray > 0.0) add_walls(&made, o->tray);
    for (uint32_t i = 0; i < o->step_count; i++) {
        double end = o->start + (i + 1) * o->tread, begin = i == 0 ? -reach : end - o->tread;
        add_box(&made, (double[3]){begin, -0.5 * reach, 0.0},
                (double[3]){end, 0.5 * reach, (o->step_count - i) * o->riser});
    }
    for (uint32_t i = 0; i < o->ball_count; i++) body_append(&made, &sphere, (double[3]){0.0, 0.0, 0.0});
    body_free(&sphere);
    if (!scenery_follow(o, &made, error)) {
        body_free(&made);
        return false;
    }
    *out = made;
    return true;
}

bool scenery_follow(const obstacles *o, body *scenery, io_error *error) {
    body sphere;
    if (o->ball_count == 0) return true;
    if (!make_sphere(&sphere, error)) return false;
    double *first =
        scenery->positions + (size_t)(scenery->vertex_count - o->ball_count * sphere.vertex_count) * 3;
    for (uint32_t i = 0; i < o->ball_count; i++)
        place_ball(&o->balls[i], &sphere, first + (size_t)i * sphere.vertex_count * 3);
    body_free(&sphere);
    return true;
}
