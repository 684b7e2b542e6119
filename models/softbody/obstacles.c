/* The obstacles of a soft body: ground, stairs, balls. z is up. */
#include "models/softbody/obstacles.h"
#include "models/common/vec3.h"

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
