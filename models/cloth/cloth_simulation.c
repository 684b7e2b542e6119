/* Cloth that nothing passes through: a solver for cloth on the public API of cscd alone, frame by frame. */
#include "models/cloth/cloth.h"
#include "models/common/scene_program.h"
#include "models/common/vec3.h"

#include <stdlib.h>
#include <string.h>

/* In spacings of the vertices. In flat cloth, features that share no vertex are at least 0.7 apart. */
static const double thickness = 0.3, separation = 0.03, reach = 0.45;

/* Shares of the missing distance that a small step adds. Layers that are pushed apart press on the lowest
 * one, which must not give way to an obstacle. */
static const double healing[2] = {0.05, 0.3};

double cloth_thickness(const cloth_simulation *c) {
    return thickness * c->spacing;
}

double cloth_separation(const cloth_simulation *c) {
    return ldexp(c->safe.separation, -2 * (int)c->safe.counts.tightest);
}

static bool explain_status(const cloth_simulation *c, cscd_status status, io_error *error) {
    if (status == CSCD_OK) return true;
    return io_fail(error, "%s: %s: %s", c->scene->name, cscd_status_string(status),
                   cscd_context_detail(c->context));
}

static cscd_object_desc describe_body(const body *b, bool obstacle) {
    cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    desc.obstacle = obstacle;
    return desc;
}

/* Creates a scene of the garment, which the detector tests, and of the obstacles, which have given
 * motions. */
static cscd_status open_mesh(cloth_simulation *c) {
    cscd_object_desc objects[1 + CLOTH_OBSTACLES_MAX] = {describe_body(&c->garment, false)};
    uint32_t count = c->scene->obstacle_count;
    for (uint32_t i = 0; i < count; i++) objects[1 + i] = describe_body(&c->obstacles[i], true);
    return cscd_mesh_create(c->context, objects, 1 + count, &c->mesh);
}

static void place_obstacles(const cloth_simulation *c, double time, double *positions) {
    double *next = positions + c->garment.vertex_count * 3;
    for (uint32_t i = 0; i < c->scene->obstacle_count; i++) {
        cloth_obstacle_place(&c->scene->obstacles[i], &c->obstacles[i], time, next);
        next += c->obstacles[i].vertex_count * 3;
    }
}

static cscd_status make_state(cloth_simulation *c) {
    size_t vertices = cscd_mesh_vertex_count(c->mesh), garment = c->garment.vertex_count;
    double **arrays[] = {&c->positions, &c->start, &c->target, &c->previous, &c->velocities};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        *arrays[i] = body_allocate(vertices * 3, sizeof **arrays[i]);
    c->inverse_masses = body_allocate(vertices, sizeof *c->inverse_masses);
    c->cloth = fabric_make(&c->garment, &c->scene->stuff);
    memcpy(c->inverse_masses, c->cloth.inverse_masses, garment * sizeof *c->inverse_masses);
    memcpy(c->positions, c->garment.positions, garment * 3 * sizeof *c->positions);
    place_obstacles(c, 0.0, c->positions);
    memcpy(c->start, c->positions, vertices * 3 * sizeof *c->start);
    c->pairs.thickness = cloth_thickness(c);
    memcpy(c->pairs.healing, healing, sizeof healing);
    c->pairs.friction = c->scene->friction;
    return safe_motion_open(c->mesh, separation * c->spacing, c->inverse_masses, c->seams, c->seam_count,
                            &c->safe);
}

bool cloth_open(const cloth_scene *s, uint32_t resolution, motion_driver driver, cscd_context *context,
                cloth_simulation *out, io_error *error) {
    cloth_simulation c = {.scene = s, .context = context};
    if (resolution == 0) resolution = s->resolution;
    c.spacing = cloth_scene_spacing(s, resolution);
    c.garment = cloth_scene_garment(s, resolution);
    c.seams = cloth_scene_seams(s, resolution, &c.seam_count);
    bool good = true;
    for (uint32_t i = 0; good && i < s->obstacle_count; i++)
        good = cloth_obstacle_make(&s->obstacles[i], &c.obstacles[i], error);
    if (good) good = explain_status(&c, open_mesh(&c), error) && explain_status(&c, make_state(&c), error);
    if (!good) {
        cloth_close(&c);
        return false;
    }
    if (driver != DRIVER_STEPS)
        bounded_motion_open(c.safe.detector, c.mesh, driver, reach * c.spacing, c.garment.vertex_count,
                            &c.bounded);
    *out = c;
    return true;
}

void cloth_close(cloth_simulation *c) {
    bounded_motion_close(&c->bounded);
    safe_motion_close(&c->safe);
    apart_free(&c->pairs);
    fabric_free(&c->cloth);
    cscd_mesh_destroy(c->mesh);
    body_free(&c->garment);
    for (uint32_t i = 0; i < CLOTH_OBSTACLES_MAX; i++) body_free(&c->obstacles[i]);
    free(c->seams);
    double *arrays[] = {c->positions, c->start, c->target, c->previous, c->velocities, c->inverse_masses};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    *c = (cloth_simulation){0};
}

/* Takes one small step. Obstacles move evenly from the start of the frame to `goal`. */
static void small_step(cloth_simulation *c, const double *goal, uint32_t which) {
    uint32_t steps = c->scene->small_steps, free_count = c->garment.vertex_count;
    double step = c->scene->frame_seconds / steps, kept = 1.0 / (1.0 + c->cloth.drag * step);
    size_t size = (size_t)cscd_mesh_vertex_count(c->mesh) * 3, free_size = (size_t)free_count * 3;
    double *x = c->target;
    memcpy(c->previous, x, size * sizeof *x);
    for (uint32_t v = 0; v < free_count; v++) {
        c->velocities[v * 3 + 2] -= c->scene->gravity * step;
        for (uint32_t i = v * 3; i < v * 3 + 3; i++) x[i] += step * (c->velocities[i] *= kept);
    }
    for (size_t i = free_size; i < size; i++)
        x[i] = c->start[i] + (double)(which + 1) / steps * (goal[i] - c->start[i]);
    fabric_solve(&c->cloth, step, c->previous, x);
    apart_solve(&c->pairs, c->inverse_masses, c->previous, x);
    safe_motion_sew(&c->safe, c->previous);
    safe_motion_sew(&c->safe, x);
    for (size_t i = 0; i < free_size; i++) c->velocities[i] = (x[i] - c->previous[i]) / step;
}

/* Finds where the solver would move the cloth if nothing were in its way; the result is c->target. */
static void find_target(cloth_simulation *c) {
    size_t size = (size_t)cscd_mesh_vertex_count(c->mesh) * 3;
    double *goal = c->positions; /* needed only at the start of the frame, and then at its end */
    memcpy(c->target, c->start, size * sizeof *goal);
    place_obstacles(c, c->clock + c->scene->frame_seconds, goal);
    for (uint32_t i = 0; i < c->scene->small_steps; i++) small_step(c, goal, i);
    memcpy(goal, c->target, size * sizeof *goal);
}

/* The sum of what the garment's vertices are apart. */
static double garment_distance(const cloth_simulation *c, const double *a, const double *b) {
    double sum = 0.0;
    for (size_t v = 0; v < c->garment.vertex_count; v++) {
        double squared = 0.0;
        for (size_t i = 3 * v; i < 3 * v + 3; i++) squared += (a[i] - b[i]) * (a[i] - b[i]);
        sum += sqrt(squared);
    }
    return sum;
}

/* Makes the motion from start to positions free of contact, and counts what it costs. */
static cscd_status find_motion(cloth_simulation *c, double *length) {
    cloth_statistics *s = &c->statistics;
    double begin = clock_now_ms();
    bool bounded = c->bounded.detector != NULL;
    uint64_t before = bounded ? c->bounded.rounds : c->safe.counts.steps;
    cscd_status status = bounded ? bounded_motion_find(&c->bounded, c->start, c->positions, length)
                                 : safe_motion_find(&c->safe, c->start, c->positions, length);
    uint64_t rounds = (bounded ? c->bounded.rounds : c->safe.counts.steps) - before;
    s->step_ms += clock_now_ms() - begin;
    s->rounds += rounds;
    if (rounds > s->most_rounds) s->most_rounds = rounds;
    s->wanted += garment_distance(c, c->target, c->start);
    s->lost += garment_distance(c, c->target, c->positions);
    return status;
}

bool cloth_advance(cloth_simulation *c, io_error *error) {
    size_t size = (size_t)cscd_mesh_vertex_count(c->mesh) * 3,
           free_size = (size_t)c->garment.vertex_count * 3;
    cloth_statistics *s = &c->statistics;
    double begin = clock_now_ms(), length;
    memcpy(c->start, c->positions, size * sizeof *c->start);
    cscd_proximities near;
    cscd_status status =
        cscd_detector_find_near(c->safe.detector, CSCD_DOUBLES(c->start, cscd_mesh_vertex_count(c->mesh)),
                                reach * c->spacing, CSCD_NEAR_PAIRS, &near);
    s->near_ms += clock_now_ms() - begin;
    if (!explain_status(c, status, error)) return false;
    apart_take(&c->pairs, c->mesh, &near);
    find_target(c);

    status = find_motion(c, &length);
    if (!explain_status(c, status, error)) return false;
    for (size_t i = 0; i < free_size; i++)
        c->velocities[i] += (c->positions[i] - c->target[i]) / c->scene->frame_seconds;
    c->clock += length * c->scene->frame_seconds;

    s->frames++;
    s->near_pairs += near.count;
    s->motion = c->safe.counts;
    s->waited += 1.0 - length;
    s->total_ms += clock_now_ms() - begin;
    return true;
}
