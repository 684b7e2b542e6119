/* Cloth that nothing passes through: a solver for cloth on the public API of cscd alone, frame by frame. */
#include "models/cloth/cloth.h"
#include "models/common/scene_program.h"
#include "models/common/vec3.h"

#include <stdlib.h>
#include <string.h>

/* In spacings of the vertices. In flat cloth, features that share no vertex are at least 0.7 apart. */
static const double separation = 0.1;

double cloth_separation(const cloth_simulation *c) {
    return separation * c->spacing;
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
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = cloth_separation(c);
    options.seams = c->seams;
    options.seam_count = c->seam_count;
    return cscd_detector_create(c->context, c->mesh, NULL, &options, &c->detector);
}

bool cloth_open(const cloth_scene *s, uint32_t resolution, cscd_context *context, cloth_simulation *out,
                io_error *error) {
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
    *out = c;
    return true;
}

void cloth_close(cloth_simulation *c) {
    cscd_detector_destroy(c->detector);
    fabric_free(&c->cloth);
    cscd_mesh_destroy(c->mesh);
    body_free(&c->garment);
    for (uint32_t i = 0; i < CLOTH_OBSTACLES_MAX; i++) body_free(&c->obstacles[i]);
    free(c->seams);
    double *arrays[] = {c->positions, c->start, c->target, c->previous, c->velocities, c->inverse_masses};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    *c = (cloth_simulation){0};
}

/* Moves both vertices of each seam to their common centre of mass. */
static void sew_seams(const cloth_simulation *c, double *positions) {
    for (uint32_t i = 0; i < c->seam_count; i++) {
        uint32_t a = c->seams[2 * i], b = c->seams[2 * i + 1];
        double wa = c->inverse_masses[a], wb = c->inverse_masses[b];
        for (uint32_t k = 0; k < 3; k++) {
            double *x = &positions[a * 3 + k], *y = &positions[b * 3 + k];
            if (*x != *y) *x = *y = (wb * *x + wa * *y) / (wa + wb);
        }
    }
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
    sew_seams(c, c->previous);
    sew_seams(c, x);
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

/* Makes the motion from start to positions free of contact, and counts what it costs. */
static cscd_status make_safe(cloth_simulation *c, double *length) {
    uint32_t count = cscd_mesh_vertex_count(c->mesh);
    cscd_response_options options = cscd_response_defaults();
    double friction[1 + CLOTH_OBSTACLES_MAX];
    for (int i = 0; i < 1 + CLOTH_OBSTACLES_MAX; i++) friction[i] = c->scene->friction;
    options.inverse_masses = c->inverse_masses;
    options.friction = friction;
    cscd_safe_motion safe;
    double begin = clock_now_ms();
    cscd_status status =
        cscd_detector_make_safe(c->detector, CSCD_DOUBLES(c->start, count), CSCD_DOUBLES(c->positions, count),
                                &options, CSCD_MUTABLE_DOUBLES(c->positions, count), &safe);
    if (status != CSCD_OK) return status;
    cloth_statistics *s = &c->statistics;
    s->safe_ms += clock_now_ms() - begin;
    s->cut += safe.rounds > 1;
    s->pushed += safe.pushed;
    s->rounds += safe.rounds;
    if (safe.rounds > s->most_rounds) s->most_rounds = safe.rounds;
    for (int i = 0; i < CSCD_RESPONSE_COUNT; i++) s->shares[i] += (double)safe.response_counts[i] / count;
    *length = safe.obstacle_share;
    return CSCD_OK;
}

bool cloth_advance(cloth_simulation *c, io_error *error) {
    size_t size = (size_t)cscd_mesh_vertex_count(c->mesh) * 3,
           free_size = (size_t)c->garment.vertex_count * 3;
    cloth_statistics *s = &c->statistics;
    double begin = clock_now_ms(), length;
    memcpy(c->start, c->positions, size * sizeof *c->start);
    find_target(c);
    cscd_status status = make_safe(c, &length);
    if (!explain_status(c, status, error)) return false;
    for (size_t i = 0; i < free_size; i++)
        c->velocities[i] += (c->positions[i] - c->target[i]) / c->scene->frame_seconds;
    c->clock += length * c->scene->frame_seconds;

    s->frames++;
    s->waited += 1.0 - length;
    s->total_ms += clock_now_ms() - begin;
    return true;
}
