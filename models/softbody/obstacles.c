/* The obstacles of a soft body: ground, stairs, balls; and their mesh for pictures. z is up. */
#include "models/softbody/softbody.h"

#include "models/common/vec3.h"
#include "models/shapes/catalogue.h"

#include <string.h>

double obstacles_height(const obstacles *o, double x) {
    if (o->step_count == 0) return 0.0;
    double step = fmax(floor((x - o->start) / o->tread), 0.0);
    return step >= o->step_count ? 0.0 : (o->step_count - step) * o->riser;
}

/* Finds the way out of the ground: through the top, or forwards through the riser when that is nearer. */
static bool hit_ground(const obstacles *o, const double point[3], obstacle_hit *out) {
    double depth = obstacles_height(o, point[0]) - point[2];
    if (depth <= 0.0) return false;
    *out = (obstacle_hit){{0.0, 0.0, 1.0}, depth, NULL};
    if (o->step_count == 0 || point[2] <= 0.0) return true;
    double steps_below = ceil(o->step_count - point[2] / o->riser);
    double forwards = o->start + steps_below * o->tread - point[0];
    if (forwards > 0.0 && forwards < depth) *out = (obstacle_hit){{1.0, 0.0, 0.0}, forwards, NULL};
    return true;
}

/* Chooses between ground and walls the one that the point is deepest in. */
bool obstacles_hit_terrain(const obstacles *o, const double point[3], obstacle_hit *out) {
    bool hit = hit_ground(o, point, out);
    for (int k = 0; k < 2 && o->tray > 0.0; k++) {
        double depth = fabs(point[k]) - o->tray;
        if (depth <= (hit ? out->depth : 0.0)) continue;
        *out = (obstacle_hit){{0.0, 0.0, 0.0}, depth, NULL};
        out->normal[k] = point[k] > 0.0 ? -1.0 : 1.0;
        hit = true;
    }
    return hit;
}

bool obstacles_hit_ball(obstacles *o, uint32_t which, const double point[3], obstacle_hit *out) {
    ball *b = &o->balls[which];
    double away[3];
    vec3_subtract(point, b->centre, away);
    double distance = vec3_norm(away);
    if (distance >= b->radius || !vec3_normalize(away)) return false;
    *out = (obstacle_hit){{away[0], away[1], away[2]}, b->radius - distance, b};
    return true;
}

void obstacles_begin(obstacles *o, double step) {
    for (uint32_t i = 0; i < o->ball_count; i++) {
        ball *b = &o->balls[i];
        memcpy(b->previous, b->centre, sizeof b->previous);
        b->velocity[2] -= o->gravity * step;
        vec3_add_scaled(b->centre, step, b->velocity);
    }
}

static void keep_off_ball(ball *a, ball *b) {
    double away[3];
    vec3_subtract(a->centre, b->centre, away);
    double depth = a->radius + b->radius - vec3_norm(away);
    if (depth <= 0.0 || !vec3_normalize(away)) return;
    double share = b->mass / (a->mass + b->mass);
    vec3_add_scaled(a->centre, depth * share, away);
    vec3_add_scaled(b->centre, -depth * (1.0 - share), away);
}

void obstacles_end(obstacles *o, double step) {
    for (uint32_t i = 0; i < o->ball_count; i++) {
        ball *b = &o->balls[i];
        for (uint32_t j = 0; j < i; j++) keep_off_ball(b, &o->balls[j]);
        b->centre[2] = fmax(b->centre[2], obstacles_height(o, b->centre[0]) + b->radius);
    }
    for (uint32_t i = 0; i < o->ball_count; i++) {
        ball *b = &o->balls[i];
        for (int k = 0; k < 3; k++) b->velocity[k] = (b->centre[k] - b->previous[k]) / step;
    }
}

double obstacles_energy(const obstacles *o) {
    double energy = 0.0;
    for (uint32_t i = 0; i < o->ball_count; i++) {
        const ball *b = &o->balls[i];
        energy += b->mass * (0.5 * vec3_dot(b->velocity, b->velocity) + o->gravity * b->centre[2]);
    }
    return energy;
}

/* ---- the mesh for pictures ----------------------------------------------------------------------------- */

enum { BALL_TRIANGLES = 1280 };

/* The extent of ground and steps to all sides, and of the ground downwards. */
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
