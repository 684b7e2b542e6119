/* The particle sensors of the public API: options, and one interval through its stages. */
#include "sensors/sensors.h"

#include "sensors/cell_particles.h"
#include "src/core/check.h"
#include "src/core/struct_size.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"
#include "src/mesh/views.h"

#include <math.h>
#include <string.h>

/* When attractions are added, particles nearer than this share of a typical edge pull no harder. */
static const double closest_share = 1e-3;

static const cscd_sensor_options default_options = {
    .step_limit = 256, .exact = true, .area_factor = 2.0, .particles = 5, .seed = 1};

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
    return check_lengths(context, options);
}

/* ---- creation ----------------------------------------------------------------------------------------- */

static array_list list_arrays(cscd_sensors *s) {
    size_t cells_most = s->mesh->vertex_count;
    return (array_list){{ARRAY(s->renewals, s->partition->part_count), ARRAY(s->cells_a, cells_most),
                         ARRAY(s->cells_b, cells_most), ARRAY(s->cell_checks, cells_most)}};
}

static cscd_status create_random(cscd_sensors *s) {
    cscd_status status = random_particles_create(s->partition, &s->random);
    if (status != CSCD_OK) return status;
    s->particles.rule = PARTICLE_POTENTIAL;
    s->particles.steps = (vertex_steps){s->random.neighbour_offsets, s->random.neighbours};
    return random_particles_place(&s->random, s->partition, s->options.particles, s->options.seed,
                                  &s->particles);
}

static cscd_status create_parts(cscd_sensors *s) {
    cscd_status status = context_allocate_all(s->context, list_arrays(s)) ? CSCD_OK : CSCD_OUT_OF_MEMORY;
    s->particles.context = s->context;
    s->particles.rule = PARTICLE_STRONGEST;
    s->particles.steps = (vertex_steps){s->partition->neighbour_offsets, s->partition->neighbours};
    if (status == CSCD_OK)
        status = sensor_reach_create(s->partition, s->options.collision_distance, &s->reach);
    if (status == CSCD_OK && s->options.method == CSCD_SENSORS_RANDOM) status = create_random(s);
    if (status == CSCD_OK) status = exact_check_create(s->mesh, &s->exact);
    if (status == CSCD_OK) status = sensor_renewal_create(s->partition, &s->renewal);
    if (status == CSCD_OK) status = sensor_bounds_create(s->partition, &s->bounds);
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
    sensor_bounds_destroy(&s->bounds);
    context_free_all(context, list_arrays(s));
    context_free(context, s->before);
    context_free(context, s->warnings);
    context_free(context, s);
}

static void free_sensors(reference_count *references) {
    cscd_sensors *s = (cscd_sensors *)references;
    cscd_context *context = s->context;
    cscd_partition *partition = s->partition;
    free_memory(s);
    partition_release(partition);
    context_release(context);
}

static const char *validate_listed(const reference_count *object) {
    const cscd_sensors *s = (const cscd_sensors *)object;
    if (s->partition->references.alive != REFERENCE_ALIVE) return "the partition of sensors was freed";
    for (uint32_t i = 0; i < s->particles.count; i++) {
        if (s->particles.vertices[i] >= s->mesh->vertex_count)
            return "a particle is at a vertex that there is not";
    }
    return s->generation <= s->partition->generation ? NULL : "sensors are ahead of their partition";
}

static cscd_status create_sensors(cscd_context *context, const cscd_mesh *mesh, cscd_partition *partition,
                                  const cscd_sensor_options *options, cscd_sensors **out) {
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_sensors_create: out is NULL");
    if (!mesh_is_same(partition->mesh, mesh))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "the partition was made for another mesh");
    if (partition->context != context)
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "the partition was made in another context: sensors and their partition belong to "
            "one, because its cells may be made anew");
    cscd_sensor_options chosen = default_options;
    cscd_status status = CSCD_OK;
    if (options != NULL)
        status = struct_take_options(context, &chosen, sizeof chosen, LEAST_SIZE(cscd_sensor_options),
                                     options, "cscd_sensor_defaults");
    if (status == CSCD_OK) status = check_options(context, &chosen);
    if (status != CSCD_OK) return status;

    cscd_sensors *s = context_allocate(context, 1, sizeof *s);
    if (s == NULL) return context_out_of_memory(context);
    partition_hold(partition);
    s->context = context;
    s->mesh = partition->mesh;
    s->partition = partition;
    s->options = chosen;
    context_add_object(context, &s->references, free_sensors);
    if (create_parts(s) != CSCD_OK) {
        cscd_sensors_destroy(s);
        return context_out_of_memory(context);
    }
    context_list_object(context, &s->references, validate_listed);
    *out = s;
    return CSCD_OK;
}

cscd_status cscd_sensors_create(cscd_context *context, const cscd_mesh *mesh, cscd_partition *partition,
                                const cscd_sensor_options *options, cscd_sensors **out) {
    if (context == NULL || mesh == NULL || partition == NULL)
        return context_lacks(context, "cscd_sensors_create", mesh == NULL ? "mesh" : "partition");
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, create_sensors(context, mesh, partition, options, out));
}

void cscd_sensors_destroy(cscd_sensors *s) {
    if (s != NULL) context_destroy_object(s->context, &s->references);
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
    const cscd_partition *partition = s->partition;
    if (s->options.method == CSCD_SENSORS_RANDOM)
        return (walk_areas){s->random.object_offsets, s->random.object_vertices, s->random.object_count};
    return (walk_areas){partition->cell_offsets, partition->cell_vertices, partition->cell_count};
}

/* Places particles in new cells, and measures the interval. */
static cscd_status begin_step(cscd_sensors *s, const double *start, const double *end) {
    cscd_status status = CSCD_OK;
    if (s->options.method == CSCD_SENSORS_CELLS)
        status = cell_particles_place(&s->particles, s->partition, &s->generation, start);
    if (status == CSCD_OK) status = remember_vertices(s);
    if (status != CSCD_OK) return status;
    sensor_renewal_follow(&s->renewal, s->partition, start);
    walk_areas areas = areas_of(s);
    sensor_reach_measure(&s->reach, s->partition, &areas, start, end, s->options.effective_radius);
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
            particle_pairs_gather(&s->pairs, p, s->partition, &s->reach, x, moment, &closest);
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

/* Updates which cells are due for renewal, and the bounds behind cscd_sensors_apart. */
static uint32_t update_certificates(cscd_sensors *s, const double *start, const double *end) {
    const uint32_t *at = s->options.method == CSCD_SENSORS_CELLS ? s->particles.vertices : NULL;
    renewal_limits limits = {s->options.area_factor, s->options.collision_distance};
    uint32_t due = sensor_renewal_check(&s->renewal, s->partition, end, at, &limits, s->renewals);
    sensor_bounds_update(&s->bounds, s->partition, start, end, NULL);
    sensor_bounds_update_boxes(&s->bounds, s->partition, start, end);
    return due;
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
    found->renewals_due = update_certificates(s, start, end);
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

/* After a renewal the balls still belong to the previous cells. Boxes are asked first: they separate more pairs, and
 * answer at once. */
__attribute__((noinline)) static bool parts_apart(const cscd_sensors *sensors, uint32_t part_a,
                                                  uint32_t part_b) {
    const cscd_partition *partition = sensors->partition;
    if (part_a == part_b || sensors->bounds.generation != partition->generation) return false;
    return sensor_bounds_boxes_apart(&sensors->bounds, part_a, part_b) ||
           sensor_bounds_apart(&sensors->bounds, partition, part_a, part_b);
}

bool cscd_sensors_apart(const cscd_sensors *sensors, uint32_t part_a, uint32_t part_b) {
    float_environment host = float_environment_begin();
    bool apart = parts_apart(sensors, part_a, part_b);
    float_environment_set(host);
    return apart;
}

uint32_t cscd_sensors_particle_count(const cscd_sensors *sensors) {
    return sensors->particles.count;
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
