/* The particle sensors of the public API: options, and one interval through its stages. */
#include "sensors/sensors.h"

#include "src/core/floating.h"
#include "src/core/least_sizes.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* When attractions are added, particles nearer than this share of a typical edge pull no harder. */
static const double closest_share = 1e-3;

static const double normal_weight_max = 1e6;

static const cscd_sensor_options default_options = {.cells_max = 64,
                                                    .normal_weight = 1.0,
                                                    .epsilon = 1e-3,
                                                    .step_limit = 256,
                                                    .exact = true,
                                                    .area_factor = 2.0,
                                                    .particles = 5,
                                                    .seed = 1};

void cscd_sensor_defaults_sized(cscd_sensor_options *out, size_t size) {
    struct_give_options(out, size, &default_options, sizeof default_options);
}

/* ---- options ------------------------------------------------------------------------------------------ */

static cscd_status check_length(cscd_context *context, const char *name, double x) {
    if (is_length(x)) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "%s is %g, expected 0 (the default) or a length from 2^-300 to 2^300", name, x);
}

static cscd_status check_lengths(cscd_context *context, const cscd_sensor_options *options) {
    double mu = options->collision_distance, radius = options->effective_radius;
    cscd_status status = check_length(context, "collision_distance", mu);
    if (status == CSCD_OK) status = check_length(context, "effective_radius", radius);
    if (status == CSCD_OK && radius > 0.0 && radius < mu)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "effective_radius is %g, but particles must feel each other within the "
                            "collision_distance, %g",
                            radius, mu);
    return status;
}

static cscd_status check_cells(cscd_context *context, const cscd_sensor_options *options) {
    if (options->cells_max == 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cells_max is 0, expected 1 or more");
    if (!(options->normal_weight >= 0.0 && options->normal_weight <= normal_weight_max))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "normal_weight is %g, expected a number from 0 to %g", options->normal_weight,
                            normal_weight_max);
    if (!(options->epsilon >= 0.0 && options->epsilon < 1.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "epsilon is %g, expected a share of the distortion in [0,1)", options->epsilon);
    return CSCD_OK;
}

static cscd_status check_options(cscd_context *context, const cscd_sensor_options *options) {
    if ((unsigned)options->method > CSCD_SENSORS_RANDOM)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown sensor method %d", (int)options->method);
    if (options->step_limit == 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "step_limit is 0, expected 1 or more");
    if (!(options->area_factor >= 1.0 && options->area_factor <= LENGTH_MAX))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "area_factor is %g, expected a number from 1 to 2^300", options->area_factor);
    if (options->particles == 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "particles is 0, expected 1 or more");
    cscd_status status = check_cells(context, options);
    return status == CSCD_OK ? check_lengths(context, options) : status;
}

/* ---- creation ----------------------------------------------------------------------------------------- */

static array_list list_arrays(cscd_sensors *s) {
    size_t cells_most = s->mesh->vertex_count;
    return (array_list){{ARRAY(s->renewals, s->partition.part_count), ARRAY(s->cells_a, cells_most),
                         ARRAY(s->cells_b, cells_most), ARRAY(s->cell_checks, cells_most)}};
}

static cscd_status create_random(cscd_sensors *s) {
    cscd_status status = random_particles_create(&s->partition, &s->random);
    if (status != CSCD_OK) return status;
    s->particles.rule = PARTICLE_POTENTIAL;
    s->particles.steps = (vertex_steps){s->random.neighbour_offsets, s->random.neighbours};
    return random_particles_place(&s->random, &s->partition, s->options.particles, s->options.seed,
                                  &s->particles);
}

static cscd_status create_parts(cscd_sensors *s) {
    cscd_status status = context_allocate_all(s->context, list_arrays(s)) ? CSCD_OK : CSCD_OUT_OF_MEMORY;
    s->particles.rule = PARTICLE_STRONGEST;
    s->particles.steps = (vertex_steps){s->partition.neighbour_offsets, s->partition.neighbours};
    if (status == CSCD_OK)
        status = sensor_reach_create(&s->partition, s->options.collision_distance, &s->reach);
    if (status == CSCD_OK && s->options.method == CSCD_SENSORS_RANDOM) status = create_random(s);
    if (status == CSCD_OK) status = exact_check_create(s->mesh, &s->exact);
    if (status == CSCD_OK) status = sensor_renewal_create(&s->partition, &s->renewal);
    return status;
}

static void free_memory(cscd_sensors *s) {
    cscd_context *context = s->context;
    context_free(context, s->unpacked[0]);
    context_free(context, s->unpacked[1]);
    particles_free(&s->particles);
    random_particles_free(context, &s->random);
    sensor_reach_free(context, &s->reach);
    particle_pairs_free(context, &s->pairs);
    exact_check_destroy(&s->exact);
    sensor_renewal_destroy(&s->renewal);
    context_free_all(context, list_arrays(s));
    context_free(context, s->before);
    context_free(context, s->warnings);
    partition_end(&s->partition);
    context_free(context, s);
}

static void free_sensors(reference_count *references) {
    cscd_sensors *s = (cscd_sensors *)references;
    cscd_context *context = s->context;
    free_memory(s);
    context_release(context);
}

static const char *validate_listed(const reference_count *object) {
    const cscd_sensors *s = (const cscd_sensors *)object;
    for (uint32_t i = 0; i < s->particles.count; i++) {
        if (s->particles.vertices[i] >= s->mesh->vertex_count)
            return "a particle is at a vertex that there is not";
    }
    if (s->generation > s->partition.generation) return "sensors are ahead of their partition";
    return partition_validate(&s->partition);
}

static cscd_status check_plan(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan) {
    if (plan == NULL || plan->mesh_hash == cscd_mesh_hash(mesh)) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "the plan was made for another mesh (hash %016llx, this one has %016llx)",
                        (unsigned long long)plan->mesh_hash, (unsigned long long)cscd_mesh_hash(mesh));
}

static cscd_status create_at(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                             const double *positions, const cscd_sensor_options *options,
                             cscd_sensors **out) {
    cscd_status status = positions_check(context, positions, mesh->vertex_count, "positions");
    if (status != CSCD_OK) return status;
    cscd_sensors *s = context_allocate(context, 1, sizeof *s);
    if (s == NULL) return context_out_of_memory(context);
    s->context = context;
    s->options = *options;
    s->particles.context = context;
    partition_begin(&s->partition, context, mesh, &s->options);
    s->mesh = s->partition.mesh;
    context_add_object(context, &s->references, free_sensors);
    status = partition_divide(&s->partition, plan, positions);
    if (status == CSCD_OK && create_parts(s) != CSCD_OK) status = context_out_of_memory(context);
    if (status != CSCD_OK) {
        cscd_sensors_destroy(s);
        return status;
    }
    context_list_object(context, &s->references, validate_listed);
    *out = s;
    return CSCD_OK;
}

static cscd_status create_sensors(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                  const cscd_view *positions, const cscd_sensor_options *options,
                                  cscd_sensors **out) {
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_sensors_create: out is NULL");
    cscd_sensor_options chosen = default_options;
    double *buffer = NULL;
    const double *x = NULL;
    cscd_status status = CSCD_OK;
    if (options != NULL)
        status = struct_take_options(context, &chosen, sizeof chosen, LEAST_SIZE(cscd_sensor_options),
                                     options, "cscd_sensor_defaults");
    if (status == CSCD_OK) status = check_options(context, &chosen);
    if (status == CSCD_OK && mesh_has_loose_objects(mesh))
        status =
            context_fail(context, CSCD_INVALID_MESH,
                         "sensors are of triangles alone, but the mesh has wires, points or half-spaces");
    if (status == CSCD_OK) status = check_plan(context, mesh, plan);
    if (status == CSCD_OK) status = views_read(context, mesh, positions, "positions", &buffer, &x);
    if (status == CSCD_OK) status = create_at(context, mesh, plan, x, &chosen, out);
    context_free(context, buffer);
    return status;
}

cscd_status cscd_sensors_create(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                const cscd_view *positions, const cscd_sensor_options *options,
                                cscd_sensors **out) {
    if (context == NULL || mesh == NULL) return context_lacks(context, "cscd_sensors_create", "mesh");
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, create_sensors(context, mesh, plan, positions, options, out));
}

void cscd_sensors_destroy(cscd_sensors *s) {
    if (s != NULL) context_destroy_object(s->context, &s->references);
}

/* ---- cells -------------------------------------------------------------------------------------------- */

static cscd_status renew_cells(cscd_sensors *s, const cscd_view *positions, uint32_t part) {
    cscd_context *context = s->context;
    if (part != UINT32_MAX && part >= s->partition.part_count)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "part is %u, but there are %u: expected one of them, or UINT32_MAX for all", part,
                            s->partition.part_count);
    double *buffer = NULL;
    const double *x = NULL;
    cscd_status status = views_read(context, s->mesh, positions, "positions", &buffer, &x);
    if (status == CSCD_OK) status = positions_check(context, x, s->mesh->vertex_count, "positions");
    if (status == CSCD_OK) status = partition_renew(&s->partition, x, part);
    context_free(context, buffer);
    return status;
}

cscd_status cscd_sensors_renew(cscd_sensors *sensors, const cscd_view *positions, uint32_t part) {
    if (sensors == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(sensors, &entry)) return entry.status;
    return context_leave(&entry, renew_cells(sensors, positions, part));
}

cscd_sensor_info cscd_sensors_describe(const cscd_sensors *sensors) {
    return (cscd_sensor_info){.part_count = sensors->partition.part_count,
                              .cell_count = sensors->partition.cell_count,
                              .particle_count = sensors->particles.count};
}

cscd_sensor_part cscd_sensors_part(const cscd_sensors *sensors, uint32_t part) {
    assert(part < sensors->partition.part_count);
    return sensors->partition.parts[part];
}

uint32_t cscd_sensors_vertex_cell(const cscd_sensors *sensors, uint32_t vertex) {
    assert(vertex < sensors->mesh->vertex_count);
    return sensors->partition.vertex_cells[vertex];
}

/* ---- one interval ------------------------------------------------------------------------------------- */

/* A step that fails puts its particles back to their previous vertices, so that a repetition does the
 * same. */
static cscd_status remember_vertices(cscd_sensors *s) {
    uint32_t count = s->particles.count;
    if (count > s->before_capacity) {
        uint32_t *before = context_allocate(s->context, count, sizeof *before);
        if (before == NULL) return CSCD_OUT_OF_MEMORY;
        context_free(s->context, s->before);
        s->before = before;
        s->before_capacity = count;
    }
    memcpy(s->before, s->particles.vertices, count * sizeof *s->before);
    return CSCD_OK;
}

static walk_areas areas_of(const cscd_sensors *s) {
    const sensor_partition *partition = &s->partition;
    if (s->options.method == CSCD_SENSORS_RANDOM)
        return (walk_areas){s->random.object_offsets, s->random.object_vertices, s->random.object_count};
    return (walk_areas){partition->cell_offsets, partition->cell_vertices, partition->cell_count};
}

/* Places particles in new cells, and measures the interval. */
static cscd_status begin_step(cscd_sensors *s, const double *start, const double *end) {
    cscd_status status = CSCD_OK;
    if (s->options.method == CSCD_SENSORS_CELLS)
        status = cell_particles_place(&s->particles, &s->partition, &s->generation, start);
    if (status == CSCD_OK) status = remember_vertices(s);
    if (status != CSCD_OK) return status;
    sensor_renewal_follow(&s->renewal, &s->partition, start);
    walk_areas areas = areas_of(s);
    sensor_reach_measure(&s->reach, &s->partition, &areas, start, end, s->options.effective_radius);
    s->particles.radius = s->reach.radius;
    bool inside = s->options.method == CSCD_SENSORS_CELLS;
    s->particles.longest_step = inside ? s->reach.longest_inside : s->reach.longest_edge;
    s->particles.closest = s->reach.typical_edge * closest_share;
    s->particles.counters = (particle_counters){0};
    s->pairs.count = 0;
    return CSCD_OK;
}

/* Lets particles walk at one moment, and gathers those that are near each other: in a cycle of states, in all
 * of them. The particles stay in the state in which two were nearest. */
static cscd_status watch_moment(cscd_sensors *s, const double *x, uint32_t moment,
                                cscd_sensor_timings *timings, cscd_sensor_counters *counters) {
    particles *p = &s->particles;
    double since = timer_now_ms(), least = INFINITY, closest;
    particles_begin(p);
    uint32_t states = particles_settle(p, x, s->options.step_limit);
    if (states > 0) counters->cycles++;
    do {
        timer_lap(&since, &timings->walk_ms);
        cscd_status status =
            particle_pairs_gather(&s->pairs, p, &s->partition, &s->reach, x, moment, &closest);
        if (status != CSCD_OK) return status;
        if (least == INFINITY || closest < least) particles_keep(p);
        least = fmin(least, closest);
        timer_lap(&since, &timings->verdict_ms);
        if (states <= 1 || p->rounds >= s->options.step_limit) break;
        particles_round(p, x);
    } while (--states > 0);
    particles_return(p);
    return CSCD_OK;
}

/* Notes why each part is due for new cells, and returns how many are. */
static uint32_t check_renewals(cscd_sensors *s, const double *end) {
    const uint32_t *at = s->options.method == CSCD_SENSORS_CELLS ? s->particles.vertices : NULL;
    renewal_limits limits = {s->options.area_factor, s->options.collision_distance};
    return sensor_renewal_check(&s->renewal, &s->partition, end, at, &limits, s->renewals);
}

static cscd_status run_step(cscd_sensors *s, const double *start, const double *end,
                            cscd_sensor_timings *timings, cscd_sensor_counters *counters,
                            cscd_warnings *found) {
    double since = timer_now_ms();
    cscd_status status = begin_step(s, start, end);
    timer_lap(&since, &timings->walk_ms);
    if (status != CSCD_OK) return status;
    status = watch_moment(s, start, 0, timings, counters);
    if (status == CSCD_OK) status = watch_moment(s, end, 1, timings, counters);
    if (status == CSCD_OK) status = sensor_verdict(s, start, end, &found->count, timings, counters);
    if (status != CSCD_OK) {
        memcpy(s->particles.vertices, s->before, s->particles.count * sizeof *s->before);
        return status;
    }
    since = timer_now_ms();
    found->items = s->warnings;
    found->renewals_due = check_renewals(s, end);
    timer_lap(&since, &timings->renewal_ms);
    return CSCD_OK;
}

static cscd_status step_between(cscd_sensors *s, const double *x0, const double *x1, cscd_warnings *out) {
    double since = timer_now_ms();
    uint32_t vertices = s->mesh->vertex_count;
    cscd_status status = positions_check(s->context, x0, vertices, "x0");
    if (status == CSCD_OK) status = positions_check(s->context, x1, vertices, "x1");
    if (status != CSCD_OK) return status;

    cscd_sensor_timings timings = {0};
    cscd_sensor_counters counters = {0};
    cscd_warnings found = {0};
    status = run_step(s, x0, x1, &timings, &counters, &found);
    if (status != CSCD_OK) return context_explain(s->context, status);
    const particle_counters *walked = &s->particles.counters;
    counters.rounds = walked->rounds;
    counters.vertices = walked->vertices;
    counters.particle_pairs = walked->pairs;
    timer_lap(&since, &timings.total_ms);
    s->timings = timings;
    s->counters = counters;
    *out = found;
    return CSCD_OK;
}

static cscd_status step_views(cscd_sensors *sensors, const cscd_view *x0, const cscd_view *x1,
                              cscd_warnings *out) {
    cscd_context *context = sensors->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_sensors_step: out is NULL");
    const double *from = NULL, *to = NULL;
    cscd_warnings found;
    cscd_status status = views_read(context, sensors->mesh, x0, "x0", &sensors->unpacked[0], &from);
    if (status == CSCD_OK) status = views_read(context, sensors->mesh, x1, "x1", &sensors->unpacked[1], &to);
    if (status == CSCD_OK) status = step_between(sensors, from, to, &found);
    if (status == CSCD_OK) *out = found;
    return status;
}

cscd_status cscd_sensors_step(cscd_sensors *sensors, const cscd_view *x0, const cscd_view *x1,
                              cscd_warnings *out) {
    if (sensors == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(sensors, &entry)) return entry.status;
    return context_leave(&entry, step_views(sensors, x0, x1, out));
}

/* ---- results of the last step ------------------------------------------------------------------------- */

cscd_renewal cscd_sensors_renewal(const cscd_sensors *sensors, uint32_t part) {
    return sensors->renewals[part];
}

uint32_t cscd_sensors_particle(const cscd_sensors *sensors, uint32_t particle) {
    return sensors->particles.vertices[particle];
}

cscd_sensor_timings cscd_sensors_timings(const cscd_sensors *sensors) {
    return sensors->timings;
}

cscd_sensor_counters cscd_sensors_counters(const cscd_sensors *sensors) {
    return sensors->counters;
}
