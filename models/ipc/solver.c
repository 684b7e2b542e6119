/* Time steps of implicit Euler as minimisations by Newton's method, along lines without contact. */
#include "models/ipc/ipc.h"

#include "models/common/scene_program.h"
#include "models/common/vec3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- making a solver: one mesh of all objects, masses, springs, the detector and its line search ------- */

static cscd_status open_detector(const ipc_object *objects, uint32_t count, cscd_context *context,
                                 ipc_solver *p) {
    cscd_object_desc descs[IPC_OBJECTS_MAX];
    for (uint32_t i = 0; i < count; i++) {
        const body *b = &objects[i].shape;
        descs[i] = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
        descs[i].obstacle = objects[i].obstacle;
    }
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = p->scene->min_separation;
    cscd_status status = cscd_mesh_create(context, descs, count, &p->mesh);
    if (status == CSCD_OK) status = cscd_detector_create(context, p->mesh, NULL, &options, &p->detector);
    if (status == CSCD_OK)
        status = cscd_detector_set_rest(p->detector, CSCD_DOUBLES(p->shape.positions, p->shape.vertex_count));
    if (status == CSCD_OK) status = cscd_line_search_create(p->detector, &p->line);
    if (status == CSCD_OK) status = cscd_energy_create(context, p->mesh, &p->barrier);
    return status;
}

static void add_object(ipc_solver *p, const ipc_object *object, uint32_t first_vertex) {
    const ipc_stuff *stuff = &p->scene->stuff;
    const body *b = &object->shape;
    for (uint32_t v = 0; object->obstacle && v < b->vertex_count; v++)
        memcpy(p->travels + (size_t)(first_vertex + v) * 3, object->travel, sizeof object->travel);
    if (object->obstacle) return;
    double *areas = body_allocate(b->vertex_count, sizeof *areas), area = 0.0;
    double mass = stuff->density * body_volume(b), step = p->scene->step_seconds;
    ipc_vertex_areas(b, areas);
    for (uint32_t v = 0; v < b->vertex_count; v++) area += areas[v];
    for (uint32_t v = 0; v < b->vertex_count; v++)
        p->inertia[first_vertex + v] = mass * areas[v] / area / (step * step);
    free(areas);
    ipc_springs_add_body(&p->springs, b, first_vertex, stuff);
}

static void allocate_arrays(ipc_solver *p) {
    double **arrays[] = {&p->positions, &p->velocities, &p->travels, &p->before, &p->predicted,
                         &p->gradient,  &p->direction,  &p->end,     &p->trial};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        *arrays[i] = body_allocate(p->shape.vertex_count, 3 * sizeof(double));
    p->inertia = body_allocate(p->shape.vertex_count, sizeof *p->inertia);
}

cscd_status ipc_solver_barrier(const ipc_solver *p, const double *positions, const cscd_proximities *near,
                               const cscd_energy_targets *targets, cscd_energy_sum *out) {
    cscd_energy_options options = cscd_energy_defaults();
    options.reach = p->scene->barrier.reach;
    options.stiffness = p->scene->barrier.stiffness;
    options.by_count = true;
    return cscd_energy_evaluate(p->barrier, near, CSCD_DOUBLES(positions, p->shape.vertex_count), &options,
                                targets, out);
}

/* Finds the first contacts; the line search finds the later ones. */
static cscd_status find_first_contacts(ipc_solver *p) {
    cscd_status status =
        cscd_detector_find_near(p->detector, CSCD_DOUBLES(p->positions, p->shape.vertex_count),
                                p->scene->barrier.reach, CSCD_NEAR_UNIQUE, &p->near);
    return status == CSCD_OK ? ipc_solver_barrier(p, p->positions, &p->near, NULL, &p->contacts) : status;
}

cscd_status ipc_solver_make(const ipc_scene *scene, uint32_t triangle_count, cscd_context *context,
                            ipc_solver *out) {
    ipc_solver p = {.scene = scene, .statistics.least_distance = INFINITY};
    ipc_object objects[IPC_OBJECTS_MAX] = {{.obstacle = false}};
    uint32_t count = scene->make(triangle_count > 0 ? triangle_count : scene->triangle_count, objects);
    for (uint32_t i = 0; i < count; i++) body_append(&p.shape, &objects[i].shape, (double[3]){0.0, 0.0, 0.0});
    allocate_arrays(&p);
    memcpy(p.positions, p.shape.positions, (size_t)p.shape.vertex_count * 3 * sizeof *p.positions);
    uint32_t first_vertex = 0;
    for (uint32_t i = 0; i < count; i++) {
        add_object(&p, &objects[i], first_vertex);
        first_vertex += objects[i].shape.vertex_count;
    }
    cscd_status status = open_detector(objects, count, context, &p);
    if (status == CSCD_OK) status = find_first_contacts(&p);
    for (uint32_t i = 0; i < count; i++) body_free(&objects[i].shape);
    if (status != CSCD_OK) {
        ipc_solver_free(&p);
        return status;
    }
    p.system = ipc_system_make(p.shape.vertex_count, p.inertia, &p.springs);
    *out = p;
    return CSCD_OK;
}

cscd_status ipc_solver_start(ipc_solver *p, const double *positions, bool *clean) {
    const size_t size = (size_t)p->shape.vertex_count * 3 * sizeof *positions;
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.answer = CSCD_ANSWER_COUNT;
    cscd_status status = cscd_detector_find_intersections(
        p->detector, CSCD_DOUBLES(positions, p->shape.vertex_count), &options, &found);
    if (status != CSCD_OK) return status;
    *clean = found.count == 0;
    if (!*clean) return CSCD_OK;
    memcpy(p->positions, positions, size);
    memset(p->velocities, 0, size);
    return find_first_contacts(p);
}

void ipc_solver_free(ipc_solver *p) {
    cscd_energy_destroy(p->barrier);
    cscd_line_search_destroy(p->line);
    cscd_detector_destroy(p->detector);
    cscd_mesh_destroy(p->mesh);
    ipc_system_free(&p->system);
    ipc_springs_free(&p->springs);
    double *arrays[] = {p->positions, p->velocities, p->travels, p->before,  p->predicted, p->gradient,
                        p->direction, p->end,        p->trial,   p->inertia, p->hessian};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    body_free(&p->shape);
    *p = (ipc_solver){0};
}

/* ---- time steps ---------------------------------------------------------------------------------------- */

enum { NEWTON_MOST = 60, GRADIENTS_MOST = 400, HALVINGS_MOST = 40 };

/* The residual of the linear system; the share of the slope that a step must gain (Armijo); and the end of
 * a minimisation: no vertex would move farther than this share of the barrier's reach. */
static const double solve_tolerance = 3e-2, least_gain = 1e-4, done_share = 0.05;

/* Adds the time in cscd since `since` to a stage and to the total. */
static void add_detection(ipc_solver *p, double since, double *stage) {
    double spent = clock_now_ms() - since;
    *stage += spent;
    p->statistics.detect_ms += spent;
}

double ipc_solver_energy(const ipc_solver *p, const double *positions, const cscd_energy_sum *contacts) {
    double inertia = 0.0;
    for (uint32_t v = 0; v < p->shape.vertex_count; v++) {
        double away[3];
        vec3_subtract(positions + (size_t)v * 3, p->predicted + (size_t)v * 3, away);
        inertia += 0.5 * p->inertia[v] * vec3_dot(away, away);
    }
    return inertia + ipc_springs_energy(&p->springs, positions) + contacts->value;
}

/* Returns where coordinate i of an obstacle is at the end of the time step. */
static double goal_of(const ipc_solver *p, uint32_t i) {
    return p->shape.positions[i] + p->to_travel * p->travels[i];
}

/* Sets the direction of obstacles to the rest of their way. */
static void aim_obstacles(ipc_solver *p) {
    p->arrived = true;
    for (uint32_t i = 0; i < p->shape.vertex_count * 3; i++) {
        if (p->inertia[i / 3] > 0.0) continue;
        p->direction[i] = goal_of(p, i) - p->positions[i];
        p->arrived = p->arrived && p->direction[i] == 0.0;
    }
}

/* Adds the barrier to the gradient, and gives its Hessian to the linear system. */
static cscd_status add_barrier(ipc_solver *p) {
    cscd_energy_pattern pattern;
    cscd_status status = cscd_energy_make_pattern(p->barrier, &p->near, NULL, &pattern);
    if (status != CSCD_OK) return status;
    if (pattern.block_count > p->hessian_capacity) {
        free(p->hessian);
        p->hessian_capacity = 2 * pattern.block_count;
        p->hessian = body_allocate(p->hessian_capacity, 9 * sizeof *p->hessian);
    }
    const cscd_energy_targets targets = {
        .gradient = p->gradient, .matrix = p->hessian, .pattern = &pattern, .project = true, .add = true};
    memset(p->hessian, 0, pattern.block_count * 9 * sizeof *p->hessian);
    status = ipc_solver_barrier(p, p->positions, &p->near, &targets, &p->contacts);
    if (status == CSCD_OK) ipc_system_set(&p->system, p->positions, &pattern, p->hessian);
    return status;
}

/* Finds Newton's direction. The Hessian of the barrier makes bodies follow the obstacles that press them. *slope becomes that
 * of the energy along the direction. */
static cscd_status find_direction(ipc_solver *p, double *slope) {
    for (uint32_t i = 0; i < p->shape.vertex_count * 3; i++)
        p->gradient[i] = p->inertia[i / 3] * (p->positions[i] - p->predicted[i]);
    ipc_springs_add_gradient(&p->springs, p->positions, p->gradient);
    cscd_status status = add_barrier(p);
    if (status != CSCD_OK) return status;
    aim_obstacles(p);
    p->statistics.conjugate_gradients +=
        ipc_system_solve(&p->system, p->gradient, solve_tolerance, GRADIENTS_MOST, p->direction);
    *slope = 0.0;
    for (uint32_t i = 0; i < p->shape.vertex_count * 3; i++) *slope += p->gradient[i] * p->direction[i];
    return CSCD_OK;
}

/* Computes the energy at the trial point, `length` along the line. */
static cscd_status evaluate_trial(ipc_solver *p, double length, double *energy) {
    double since = clock_now_ms();
    cscd_status status =
        cscd_line_search_find_near(p->line, length, p->scene->barrier.reach, CSCD_NEAR_UNIQUE, &p->near);
    add_detection(p, since, &p->statistics.near_ms);
    if (status == CSCD_OK) status = ipc_solver_barrier(p, p->trial, &p->near, NULL, &p->of_trial);
    if (status != CSCD_OK) return status;
    p->statistics.near += p->near.count;
    p->statistics.trials++;
    *energy = ipc_solver_energy(p, p->trial, &p->of_trial);
    return CSCD_OK;
}

/* Steps along the line by at most `longest`; p->trial is the point that the library has verified. */
static cscd_status step_along_line(ipc_solver *p, double longest, cscd_free_step *step) {
    double since = clock_now_ms();
    cscd_status status = cscd_line_search_max_step(
        p->line, longest, CSCD_MUTABLE_DOUBLES(p->trial, cscd_mesh_vertex_count(p->mesh)), step);
    add_detection(p, since, &p->statistics.certify_ms);
    return status;
}

static cscd_status begin_line(ipc_solver *p) {
    for (uint32_t i = 0; i < p->shape.vertex_count * 3; i++)
        p->end[i] = p->inertia[i / 3] > 0.0 ? p->positions[i] + p->direction[i] : goal_of(p, i);
    double since = clock_now_ms();
    cscd_status status = cscd_line_search_begin(
        p->line, CSCD_DOUBLES(p->positions, cscd_mesh_vertex_count(p->mesh)),
        CSCD_DOUBLES(p->end, cscd_mesh_vertex_count(p->mesh)), p->scene->barrier.reach);
    add_detection(p, since, &p->statistics.begin_ms);
    if (status == CSCD_OK) p->statistics.candidates += cscd_line_search_candidate_count(p->line);
    return status;
}

/* Starts with the longest step without contact and shortens it until the energy has fallen by enough
 * (Armijo's rule). While obstacles move, which may do work, it takes the longest. Only points that the
 * library has verified are evaluated. *found is false when no step leads down. */
static cscd_status search_line(ipc_solver *p, double slope, bool *found) {
    double longest = 1.0;
    cscd_status status = begin_line(p);
    for (int i = 0; status == CSCD_OK && !*found && i < HALVINGS_MOST; i++) {
        cscd_free_step step;
        double energy = INFINITY;
        status = step_along_line(p, longest, &step);
        if (status == CSCD_OK) status = evaluate_trial(p, step.fraction, &energy);
        if (status != CSCD_OK) return status;
        p->statistics.cut += i == 0 && step.limited;
        *found = !p->arrived || energy <= p->energy + least_gain * step.fraction * slope;
        if (*found) p->energy = energy;
        longest = 0.5 * step.fraction;
    }
    return status;
}

/* Moves the vertices to the trial point. */
static void accept_trial(ipc_solver *p) {
    double *positions = p->positions;
    p->positions = p->trial;
    p->contacts = p->of_trial;
    p->trial = positions;
    p->statistics.least_distance = fmin(p->statistics.least_distance, p->contacts.least);
}

static double farthest_move(const ipc_solver *p) {
    double most = 0.0;
    for (uint32_t v = 0; v < p->shape.vertex_count; v++)
        most = fmax(most, vec3_norm(p->direction + (size_t)v * 3));
    return most;
}

cscd_status ipc_solver_iterate(ipc_solver *p, bool *done) {
    bool found = false;
    double slope;
    cscd_status status = find_direction(p, &slope);
    if (status == CSCD_OK) status = search_line(p, slope, &found);
    if (status == CSCD_OK && !found) /* the list is again that at the positions */
        status =
            cscd_line_search_find_near(p->line, 0.0, p->scene->barrier.reach, CSCD_NEAR_UNIQUE, &p->near);
    if (status != CSCD_OK) return status;
    p->statistics.newton++;
    p->statistics.driven += !p->arrived;
    p->statistics.unfinished += !found;
    if (found) accept_trial(p);
    *done = p->arrived && (!found || farthest_move(p) < done_share * p->scene->barrier.reach);
    return CSCD_OK;
}

void ipc_solver_begin_step(ipc_solver *p) {
    double step = p->scene->step_seconds;
    p->to_travel = ipc_scene_travelled(p->scene, p->time + step);
    memcpy(p->before, p->positions, (size_t)p->shape.vertex_count * 3 * sizeof *p->before);
    for (uint32_t i = 0; i < p->shape.vertex_count * 3; i++)
        p->predicted[i] =
            p->positions[i] + step * p->velocities[i] - (i % 3 == 2 ? step * step * p->scene->gravity : 0.0);
    p->energy = ipc_solver_energy(p, p->positions, &p->contacts);
}

void ipc_solver_end_step(ipc_solver *p) {
    double step = p->scene->step_seconds;
    p->time += step;
    p->statistics.steps++;
    for (uint32_t i = 0; i < p->shape.vertex_count * 3; i++)
        p->velocities[i] = p->inertia[i / 3] > 0.0 ? (p->positions[i] - p->before[i]) / step : 0.0;
}

cscd_status ipc_solver_advance(ipc_solver *p) {
    double since = clock_now_ms();
    bool done = false;
    cscd_status status = CSCD_OK;
    ipc_solver_begin_step(p);
    for (int i = 0; i < NEWTON_MOST && status == CSCD_OK && !done; i++) status = ipc_solver_iterate(p, &done);
    if (status != CSCD_OK) return status;
    p->statistics.unfinished += !done;
    ipc_solver_end_step(p);
    p->statistics.total_ms += clock_now_ms() - since;
    return CSCD_OK;
}
