/* Particles: what the grid finds, where forces lead, and how walks end. */
#include "cscd/cscd.h"
#include "sensors/particles.h"
#include "src/core/vec3.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>

enum { POINTS = 400 };

static cscd_context *context;
static double points[POINTS][3];
static uint32_t identity[POINTS], groups[POINTS];

static int create_context(void **state) {
    (void)state;
    for (uint32_t i = 0; i < POINTS; i++) identity[i] = i;
    return cscd_context_create(NULL, &context) == CSCD_OK ? 0 : -1;
}

static int destroy_context(void **state) {
    (void)state;
    cscd_context_destroy(context);
    return 0;
}

static void scatter_points(const double centre[3], double spread) {
    for (uint32_t i = 0; i < POINTS; i++) {
        for (int k = 0; k < 3; k++) points[i][k] = centre[k] + spread * random_unit();
        groups[i] = i % 7;
    }
}

static double point_distance(const double a[3], const double b[3]) {
    double d[3];
    vec3_subtract(a, b, d);
    return sqrt(vec3_dot(d, d));
}

/* ---- the grid ----------------------------------------------------------------------------------------- */

static void expect_all_found(particle_grid *grid, double radius) {
    particle_grid_build(grid, points[0], identity, groups, POINTS, radius);
    for (uint32_t i = 0; i < POINTS; i++) {
        uint8_t times[POINTS] = {0};
        grid_search search = particle_grid_around(grid, points[i]);
        for (const grid_entry *e; (e = grid_search_next(&search)) != NULL;) {
            assert_int_equal(e->group, groups[e->particle]);
            assert_memory_equal(e->x, points[e->particle], sizeof e->x);
            times[e->particle]++;
        }
        for (uint32_t j = 0; j < POINTS; j++) {
            assert_true(times[j] <= 1);
            if (point_distance(points[i], points[j]) < radius) assert_int_equal(times[j], 1);
        }
    }
}

TEST(the_grid_finds_each_neighbour_once) {
    static const double places[][3] = {{0, 0, 0}, {-3, 8, 1e3}, {1e9, -1e9, 1e9}, {1e60, 0, -1e-60}};
    static const double radii[] = {1e-3, 0.07, 0.3, 1.0, 5.0, 1e9};
    particle_grid grid = {0};
    random_seed(1);
    assert_int_equal(particle_grid_reserve(context, &grid, POINTS), CSCD_OK);
    for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
        scatter_points(places[p], 1.0);
        for (size_t r = 0; r < sizeof radii / sizeof *radii; r++) expect_all_found(&grid, radii[r]);
    }
    scatter_points(places[0], 1e-90);
    expect_all_found(&grid, 1e-91);
    scatter_points(places[0], 1e90); /* more cells than numbers: they are larger */
    expect_all_found(&grid, 1e-9);
    expect_all_found(&grid, 1e89);
    particle_grid_free(context, &grid);
}

/* ---- forces ------------------------------------------------------------------------------------------- */

/* A walk's world: particles on some points, and steps from every point to a few others, of the same number
 * modulo `worlds`. */
enum { WAYS = 5, WALKERS = POINTS / 4 };
static uint32_t step_offsets[POINTS + 1], step_targets[POINTS * WAYS];

static int by_number(const void *a, const void *b) {
    uint32_t i = *(const uint32_t *)a, j = *(const uint32_t *)b;
    return (i > j) - (i < j);
}

static particles random_world(particle_rule rule, double radius, int worlds) {
    particles p = {.context = context, .rule = rule, .steps = {step_offsets, step_targets}};
    for (uint32_t i = 0; i < POINTS; i++) {
        step_offsets[i + 1] = (i + 1) * WAYS;
        for (uint32_t k = 0; k < WAYS; k++)
            step_targets[i * WAYS + k] =
                (uint32_t)(random_integer(0, POINTS / worlds - 1) * worlds) + i % (uint32_t)worlds;
        qsort(step_targets + (size_t)i * WAYS, WAYS, sizeof *step_targets, by_number);
    }
    assert_int_equal(particles_reserve(&p, WALKERS), CSCD_OK);
    p.count = WALKERS;
    for (uint32_t i = 0; i < WALKERS; i++) {
        p.vertices[i] = (uint32_t)random_integer(0, POINTS - 1);
        p.groups[i] = p.objects[i] = i % 5;
    }
    p.radius = radius;
    p.longest_step = 4.0;
    p.closest = 1e-3;
    return p;
}

/* An independent version: the vertex where the sum over all pairs is best for particle i. */
static double plain_worth(const particles *p, const uint32_t *vertices, uint32_t i, uint32_t at) {
    double vector[3] = {0, 0, 0}, scalar = 0.0, strongest = 0.0, potential = 0.0;
    for (uint32_t j = 0; j < p->count; j++) {
        double d[3], r = point_distance(points[vertices[j]], points[at]);
        if (j == i || r >= p->radius) continue;
        vec3_subtract(points[vertices[j]], points[at], d);
        double s = fmax(r, p->closest), own = p->objects[j] == p->objects[i];
        potential += (own > 0 ? 1 : -1) * (1 / s - 1 / p->radius);
        if (own > 0) continue;
        scalar += 1 / (s * s);
        strongest = fmax(strongest, 1 / (s * s));
        if (r > 0)
            vec3_add_scaled(vector, 1 / (s * s * r), d, vector);
        else
            vector[0] += 1 / (s * s);
    }
    return p->rule == PARTICLE_POTENTIAL   ? -potential
           : p->rule == PARTICLE_SCALAR    ? scalar
           : p->rule == PARTICLE_STRONGEST ? strongest
                                           : sqrt(vec3_dot(vector, vector));
}

static void expect_best(const particles *p, const uint32_t *before, uint32_t i) {
    double chosen = plain_worth(p, before, i, p->vertices[i]);
    double slack = 1e-9 * fmax(1.0, fabs(chosen));
    assert_true(chosen >= plain_worth(p, before, i, before[i]) - slack);
    bool there = p->vertices[i] == before[i];
    for (uint32_t k = 0; k < WAYS; k++) {
        uint32_t target = step_targets[before[i] * WAYS + k];
        there |= target == p->vertices[i];
        assert_true(chosen >= plain_worth(p, before, i, target) - slack);
    }
    assert_true(there);
}

TEST(every_particle_takes_the_best_way) {
    static const double centre[3] = {1e6, 0, -5};
    uint32_t before[WALKERS];
    random_seed(2);
    for (int round = 0; round < 30; round++) {
        scatter_points(centre, 1.0);
        particles p = random_world((particle_rule)(round % 4), round % 3 ? 0.4 : 1.5, 1);
        memcpy(before, p.vertices, sizeof before);
        particles_begin(&p);
        uint32_t moved = particles_round(&p, points[0]), expected = 0;
        for (uint32_t i = 0; i < p.count; i++) {
            expect_best(&p, before, i);
            expected += p.vertices[i] != before[i];
        }
        assert_int_equal(moved, expected);
        assert_true(moved > 0);
        particles_free(&p);
    }
}

static uint64_t plain_pairs(const particles *p) {
    uint64_t pairs = 0;
    for (uint32_t i = 0; i < p->count; i++)
        for (uint32_t j = 0; j < i; j++)
            pairs += p->groups[i] != p->groups[j] &&
                     point_distance(points[p->vertices[i]], points[p->vertices[j]]) < p->radius;
    return pairs;
}

TEST(counters_count) {
    static const double centre[3] = {0, 0, 0};
    random_seed(3);
    scatter_points(centre, 1.0);
    particles p = random_world(PARTICLE_ATTRACTION, 0.5, 1);
    uint64_t pairs = plain_pairs(&p);
    particles_begin(&p);
    particles_round(&p, points[0]);
    assert_int_equal(p.counters.pairs, pairs);
    assert_int_equal(p.counters.vertices, WALKERS * (WAYS + 1));
    assert_int_equal(p.counters.rounds, 1);
    particles_free(&p);
}

/* ---- how walks end ------------------------------------------------------------------------------------ */

/* A particle of group i / 2 on a path of its own with `length` points from first on. */
static void lay_paths(particles *p, uint32_t paths, uint32_t length) {
    *p = (particles){.context = context,
                     .steps = {step_offsets, step_targets},
                     .radius = 100.0,
                     .longest_step = 2.0,
                     .closest = 1e-3};
    uint32_t steps = 0;
    for (uint32_t v = 0; v < paths * length; v++) {
        step_offsets[v] = steps;
        if (v % length > 0) step_targets[steps++] = v - 1;
        if (v % length < length - 1) step_targets[steps++] = v + 1;
    }
    step_offsets[paths * length] = steps;
    assert_int_equal(particles_reserve(p, paths), CSCD_OK);
    p->count = paths;
    for (uint32_t i = 0; i < paths; i++) p->groups[i] = p->objects[i] = i;
}

static void put_point(uint32_t point, double x, double y) {
    points[point][0] = x;
    points[point][1] = y;
    points[point][2] = 0.0;
}

/* Two lines that cross at an angle: the walk ends where they are nearest. */
TEST(a_walk_rests_at_the_nearest_points) {
    enum { LENGTH = 30 };
    particles p;
    lay_paths(&p, 2, LENGTH);
    for (uint32_t i = 0; i < LENGTH; i++) {
        put_point(i, i, 0.0);
        put_point(LENGTH + i, 20.0 + 0.1 * i, 1.0 + i);
    }
    p.vertices[0] = 0;
    p.vertices[1] = 2 * LENGTH - 1;
    particles_begin(&p);
    assert_int_equal(particles_settle(&p, points[0], 1000), 0);
    assert_int_equal(p.vertices[0], 20);
    assert_int_equal(p.vertices[1], LENGTH);
    assert_true(p.rounds > LENGTH - 2 && p.rounds < LENGTH + 3);
    p.vertices[0] = 0;
    particles_begin(&p);
    assert_int_equal(particles_settle(&p, points[0], 4), 0); /* a limit on the rounds ends the walk, too */
    assert_int_equal(p.rounds, 4);
    assert_int_equal(p.vertices[0], 4);
    particles_free(&p);
}

/* Each particle wants to be opposite to the place where the other one is. */
TEST(swapping_for_ever_is_noticed) {
    particles p;
    lay_paths(&p, 2, 2);
    put_point(0, 0, 0), put_point(1, 1, 0), put_point(2, 0, 1), put_point(3, 1, 1);
    p.vertices[0] = 0;
    p.vertices[1] = 3;
    particles_begin(&p);
    assert_int_equal(particles_settle(&p, points[0], 1000), 2);
    assert_int_equal(p.rounds, 2);
    assert_int_equal(p.vertices[0], 0);
    assert_int_equal(p.vertices[1], 3);
    particles_free(&p);
}

/* Worlds beside each other, whose cycles are of different lengths, come back together after more rounds than
 * are remembered one by one. */
TEST(cycles_are_as_long_as_they_say) {
    enum { WORLDS = 8 };
    static const double centre[3] = {0, 0, 0};
    uint32_t start[WALKERS], longest = 0;
    random_seed(5);
    for (int i = 0; i < 100; i++) {
        scatter_points(centre, 1.0);
        for (uint32_t v = 0; v < POINTS; v++) points[v][0] += 100.0 * (v % WORLDS);
        particles p = random_world((particle_rule)(i % 4), 1.0, WORLDS);
        particles_begin(&p);
        uint32_t length = particles_settle(&p, points[0], 2000);
        assert_true(p.rounds < 2000);
        memcpy(start, p.vertices, sizeof start);
        for (uint32_t k = 1; k <= length; k++) {
            particles_round(&p, points[0]);
            bool same = memcmp(start, p.vertices, sizeof start) == 0;
            assert_int_equal(same, k == length);
        }
        longest = length > longest ? length : longest;
        particles_free(&p);
    }
    assert_true(longest > PARTICLES_RECENT);
}

/* Two particles of one object on a ring flee until neither gains by going on. */
TEST(repulsion_spreads) {
    enum { RING = 24 };
    particles p = {.context = context,
                   .rule = PARTICLE_POTENTIAL,
                   .steps = {step_offsets, step_targets},
                   .radius = 1e3,
                   .longest_step = 1.0,
                   .closest = 1e-3};
    assert_int_equal(particles_reserve(&p, 2), CSCD_OK);
    p.count = 2;
    for (uint32_t v = 0; v < RING; v++) {
        double angle = 2.0 * 3.14159265358979 * v / RING;
        put_point(v, cos(angle), sin(angle));
        step_offsets[v] = 2 * v;
        step_targets[2 * v] = (v + RING - 1) % RING;
        step_targets[2 * v + 1] = (v + 1) % RING;
    }
    step_offsets[RING] = 2 * RING;
    for (uint32_t i = 0; i < 2; i++) p.groups[i] = p.objects[i] = 0;
    p.vertices[0] = 0;
    p.vertices[1] = 1;
    particles_begin(&p);
    particles_settle(&p, points[0], 1000);
    assert_true(point_distance(points[p.vertices[0]], points[p.vertices[1]]) > 1.9);
    particles_free(&p);
}

/* Twice as many groups of particles, far from each other, take twice the work. */
static uint64_t distances_of(uint32_t clusters, uint64_t *vertices) {
    enum { EACH = 4 };
    particles p;
    lay_paths(&p, clusters * EACH, 2);
    p.radius = 1.0;
    for (uint32_t c = 0; c < clusters; c++)
        for (uint32_t i = 0; i < EACH * 2; i++) {
            put_point(c * EACH * 2 + i, 1000.0 * c + 0.4 * random_unit(), 0.4 * random_unit());
            points[c * EACH * 2 + i][2] = 17.0 * (c % 3);
        }
    for (uint32_t i = 0; i < p.count; i++) p.vertices[i] = 2 * i;
    particles_begin(&p);
    for (int round = 0; round < 5; round++) particles_round(&p, points[0]);
    uint64_t distances = p.counters.distances;
    *vertices = p.counters.vertices;
    particles_free(&p);
    return distances;
}

TEST(work_grows_with_the_scene) {
    random_seed(4);
    uint64_t few, many;
    uint64_t distances_few = distances_of(12, &few), distances_many = distances_of(48, &many);
    assert_int_equal(many, 4 * few);
    assert_true(distances_many < 5 * distances_few && distances_many > 3 * distances_few);
}

AROUND_ALL(create_context, destroy_context)
