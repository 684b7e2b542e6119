/* Particles: the forces that they feel on vertices, and how they walk until all rest. */
#include "sensors/particles.h"

#include "src/core/vec3.h"

#include <assert.h>

/* ---- the grid ------------------------------------------------------------------------------------------ */

enum { BUCKETS_LEAST = 8 };

/* Grid cells are numbered from 0 to this, so that the rounding of a quotient stays far below one cell; a
 * larger scene gets larger cells. */
static const double cells_most = 0x1p30;

static uint32_t buckets_for(uint32_t count) {
    uint32_t buckets = BUCKETS_LEAST;
    while (buckets < count && buckets < 0x80000000u) buckets *= 2;
    return buckets;
}

static array_list list_arrays(particle_grid *grid) {
    return (array_list){{ARRAY(grid->first, (size_t)grid->mask + 2), ARRAY(grid->buckets, grid->capacity),
                         ARRAY(grid->entries, grid->capacity)}};
}

cscd_status particle_grid_reserve(cscd_context *context, particle_grid *grid, uint32_t count) {
    if (count <= grid->capacity && grid->first != NULL) return CSCD_OK;
    uint32_t buckets = buckets_for(count);
    particle_grid wider = {.capacity = count, .mask = buckets - 1};
    if (!context_allocate_all(context, list_arrays(&wider))) return CSCD_OUT_OF_MEMORY;
    particle_grid_free(context, grid);
    *grid = wider;
    return CSCD_OK;
}

void particle_grid_free(cscd_context *context, particle_grid *grid) {
    context_free_all(context, list_arrays(grid));
    *grid = (particle_grid){0};
}

/* The number of the cell along one axis; -2 lies before all cells, cells_most + 2 behind all. */
static uint32_t cell_along(const particle_grid *grid, const double x[3], int axis) {
    double cell = floor((x[axis] - grid->origin[axis]) * grid->cells_per_length);
    return (uint32_t)(int64_t)min_of(max_of(cell, -2.0), cells_most + 2.0);
}

/* Two particles nearer than radius lie in the same or in adjoining cells: cells are wider than the radius by
 * far more than the rounding of a cell's number. */
static void fit_grid(particle_grid *grid, const double *x, const uint32_t *vertices, uint32_t count,
                     double radius) {
    double low[3] = {0}, high[3] = {0}, extent = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            double c = x[(size_t)vertices[i] * 3 + (size_t)k];
            low[k] = i == 0 ? c : min_of(low[k], c);
            high[k] = i == 0 ? c : max_of(high[k], c);
        }
    }
    for (int k = 0; k < 3; k++) extent = max_of(extent, high[k] - low[k]);
    memcpy(grid->origin, low, sizeof low);
    grid->cells_per_length = 1.0 / max_of(radius * (1.0 + 0x1p-10), extent / cells_most);
}

void particle_grid_build(particle_grid *grid, const double *x, const uint32_t *vertices,
                         const uint32_t *groups, uint32_t count, double radius) {
    assert(count <= grid->capacity);
    fit_grid(grid, x, vertices, count, radius);
    grid->count = count;
    memset(grid->first, 0, ((size_t)grid->mask + 2) * sizeof *grid->first);
    for (uint32_t i = 0; i < count; i++) {
        const double *at = x + (size_t)vertices[i] * 3;
        uint32_t row = grid_row_bucket(cell_along(grid, at, 1), cell_along(grid, at, 2));
        grid->buckets[i] = (row + cell_along(grid, at, 0)) & grid->mask;
        grid->first[grid->buckets[i] + 1]++;
    }
    for (uint32_t b = 0; b <= grid->mask; b++) grid->first[b + 1] += grid->first[b];
    for (uint32_t i = count; i-- > 0;) { /* first[b + 1] goes down from the bucket's end to its beginning, */
        const double *at = x + (size_t)vertices[i] * 3;
        grid_entry *e = &grid->entries[--grid->first[grid->buckets[i] + 1]];
        memcpy(e->x, at, sizeof e->x);
        e->particle = i;
        e->group = groups[i];
        e->y = cell_along(grid, at, 1);
        e->z = cell_along(grid, at, 2);
    }
    memmove(grid->first, grid->first + 1, ((size_t)grid->mask + 1) * sizeof *grid->first); /* which is here */
    grid->first[grid->mask + 1] = count;
}

grid_search particle_grid_around(const particle_grid *grid, const double x[3]) {
    grid_search s = {.grid = grid};
    s.x = cell_along(grid, x, 0) - 1;
    s.y = cell_along(grid, x, 1) - 1;
    s.z = cell_along(grid, x, 2) - 1;
    grid_search_row(&s);
    grid_search_open(&s);
    return s;
}

/* ---- particles ----------------------------------------------------------------------------------------- */

static bool grow_array(cscd_context *context, uint32_t **block, uint32_t old_count, uint32_t count) {
    uint32_t *grown = context_grow(context, *block, old_count, count, sizeof *grown);
    if (grown != NULL) *block = grown;
    return grown != NULL;
}

cscd_status particles_reserve(particles *p, uint32_t count) {
    cscd_context *context = p->context;
    if (count > p->capacity || p->vertices == NULL) {
        uint32_t **blocks[] = {&p->vertices, &p->groups, &p->objects, &p->targets, &p->kept};
        for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
            if (!grow_array(context, blocks[i], *blocks[i] != NULL ? p->capacity : 0, count))
                return CSCD_OUT_OF_MEMORY;
        double(*near)[3] = context_allocate(context, count, sizeof *near);
        if (near == NULL) return CSCD_OUT_OF_MEMORY;
        context_free(context, p->near);
        p->near = near;
        p->capacity = count;
    }
    return particle_grid_reserve(context, &p->grid, p->capacity);
}

void particles_free(particles *p) {
    void *blocks[] = {p->vertices, p->groups, p->objects, p->targets, p->kept, p->near};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(p->context, blocks[i]);
    particle_grid_free(p->context, &p->grid);
}

/* ---- forces ------------------------------------------------------------------------------------------ */

/* Finds the particles within reach: all that particle i can feel where it is or where it can go next. */
static void find_near(particles *p, uint32_t i, const double x[3], double reach) {
    bool repels = p->rule == PARTICLE_POTENTIAL;
    double farthest = reach * reach, felt = p->radius * p->radius;
    p->attracting = p->repelling = 0;
    grid_search search = particle_grid_around(&p->grid, x);
    for (const grid_entry *e; (e = grid_search_next(&search)) != NULL;) {
        bool attracts = e->group != p->groups[i];
        if (!attracts && (!repels || e->particle == i || p->objects[e->particle] != p->objects[i])) continue;
        double squared = vec3_squared_distance(e->x, x);
        p->counters.distances++;
        if (!(squared < farthest)) continue;
        if (attracts && squared < felt && i < e->particle) p->counters.pairs++;
        memcpy(p->near[attracts ? p->attracting++ : p->capacity - ++p->repelling], e->x, sizeof e->x);
    }
}

/* When only the strongest attraction counts, most particles do not matter: one that is farther than the
 * nearest by two steps or more cannot become the nearest. */
static void drop_far(particles *p, const double x[3]) {
    double least = INFINITY;
    for (uint32_t j = 0; j < p->attracting; j++) least = min_of(least, vec3_squared_distance(p->near[j], x));
    double farthest = (sqrt(least) + 2.0 * p->longest_step) * (1.0 + 0x1p-40);
    uint32_t kept = 0;
    for (uint32_t j = 0; j < p->attracting; j++) {
        if (vec3_squared_distance(p->near[j], x) > farthest * farthest) continue;
        memmove(p->near[kept++], p->near[j], sizeof *p->near);
    }
    p->attracting = kept;
}

/* The squared length of the sum of (x_j - x) / r^3 (3.13, 3.14), with lengths in units of 1 / R_eff^2. Two
 * particles in one place have no direction, so their pull is added along x. */
static double vector_force(const particles *p, const double x[3]) {
    double reach = p->radius * p->radius, sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t j = 0; j < p->attracting; j++) {
        double d[3];
        vec3_subtract(p->near[j], x, d);
        double squared = vec3_dot(d, d);
        if (!(squared < reach)) continue;
        double r = sqrt(squared), s = p->radius / max_of(r, p->closest);
        if (r > 0.0)
            vec3_add_scaled(sum, s * s / r, d, sum);
        else
            sum[0] += s * s;
    }
    return vec3_dot(sum, sum);
}

static double scalar_force(const particles *p, const double x[3]) {
    double reach = p->radius * p->radius, closest = p->closest * p->closest, sum = 0.0;
    for (uint32_t j = 0; j < p->attracting; j++) {
        double squared = vec3_squared_distance(p->near[j], x);
        if (squared < reach) sum += reach / max_of(squared, closest);
    }
    return sum;
}

/* The attraction falls with the distance, so the nearest particle decides. */
static double strongest_force(const particles *p, const double x[3]) {
    double least = p->radius * p->radius;
    for (uint32_t j = 0; j < p->attracting; j++) least = min_of(least, vec3_squared_distance(p->near[j], x));
    return -least;
}

/* The potential of forces of 1 / r^2 that end at R_eff. */
static double potential_of(const particles *p, const double (*others)[3], uint32_t count, const double x[3]) {
    double reach = p->radius * p->radius, sum = 0.0;
    for (uint32_t j = 0; j < count; j++) {
        double squared = vec3_squared_distance(others[j], x);
        if (squared < reach) sum += p->radius / max_of(sqrt(squared), p->closest) - 1.0;
    }
    return sum;
}

/* Returns the quality of a vertex for the particle whose surroundings were found last: the larger, the
 * better. */
static double worth_of(particles *p, const double x[3]) {
    p->counters.vertices++;
    p->counters.distances += p->attracting + p->repelling;
    switch (p->rule) {
    case PARTICLE_ATTRACTION:
        return vector_force(p, x);
    case PARTICLE_SCALAR:
        return scalar_force(p, x);
    case PARTICLE_STRONGEST:
        return strongest_force(p, x);
    case PARTICLE_POTENTIAL:
        return potential_of(p, (const double(*)[3])p->near, p->attracting, x) -
               potential_of(p, (const double(*)[3])p->near + p->capacity - p->repelling, p->repelling, x);
    }
    return 0.0;
}

/* Returns the best of the vertex where the particle is and those where it can go. Among equally good ones it
 * returns the own vertex, or else the smallest. */
static uint32_t choose_target(particles *p, uint32_t i, const double *x) {
    uint32_t own = p->vertices[i], best = own;
    const double *here = x + (size_t)own * 3;
    find_near(p, i, here, p->radius + p->longest_step);
    if (p->attracting + p->repelling == 0) return own;
    if (p->rule == PARTICLE_STRONGEST) drop_far(p, here);
    double most = worth_of(p, here);
    for (uint32_t k = p->steps.offsets[own]; k < p->steps.offsets[own + 1]; k++) {
        uint32_t target = p->steps.targets[k];
        double there = worth_of(p, x + (size_t)target * 3);
        if (!(there > most)) continue;
        most = there;
        best = target;
    }
    return best;
}

/* ---- walking ------------------------------------------------------------------------------------------ */

/* The hash of a state is the sum of these, so that a move changes two summands. */
static uint64_t mixed_hash(uint32_t particle, uint32_t vertex) {
    uint64_t h = ((uint64_t)particle << 32 | vertex) + UINT64_C(0x9E3779B97F4A7C15);
    h = (h ^ h >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    h = (h ^ h >> 27) * UINT64_C(0x94D049BB133111EB);
    return h ^ h >> 31;
}

void particles_begin(particles *p) {
    p->state = 0;
    for (uint32_t i = 0; i < p->count; i++) p->state += mixed_hash(i, p->vertices[i]);
    for (int i = 0; i < PARTICLES_RECENT; i++) p->recent[i] = p->state;
    p->landmark = p->state;
    p->landmark_round = p->rounds = 0;
}

uint32_t particles_round(particles *p, const double *x) {
    particle_grid_build(&p->grid, x, p->vertices, p->groups, p->count, p->radius + p->longest_step);
    uint32_t moved = 0;
    for (uint32_t i = 0; i < p->count; i++) p->targets[i] = choose_target(p, i, x);
    for (uint32_t i = 0; i < p->count; i++) {
        if (p->targets[i] == p->vertices[i]) continue;
        moved++;
        p->state += mixed_hash(i, p->targets[i]) - mixed_hash(i, p->vertices[i]);
        p->vertices[i] = p->targets[i];
    }
    p->rounds++;
    p->counters.rounds++;
    return moved;
}

/* Returns after how many rounds the state has come back, or 0 if it has not. The state is compared with the
 * last few, since short cycles are common, and with that of a round whose number is a power of two, which in
 * the end finds every cycle (Brent 1980). Equal hashes of different states would end a walk too early, and do
 * no other harm. */
static uint32_t cycle_length(particles *p) {
    uint32_t round = p->rounds;
    for (uint32_t ago = 1; ago <= PARTICLES_RECENT && ago <= round; ago++)
        if (p->recent[(round - ago) % PARTICLES_RECENT] == p->state) return ago;
    if (p->landmark == p->state) return round - p->landmark_round;
    p->recent[round % PARTICLES_RECENT] = p->state;
    if ((round & (round - 1)) == 0) {
        p->landmark = p->state;
        p->landmark_round = round;
    }
    return 0;
}

uint32_t particles_settle(particles *p, const double *x, uint32_t limit) {
    while (p->rounds < limit) {
        if (particles_round(p, x) == 0) return 0;
        uint32_t length = cycle_length(p);
        if (length > 0) return length;
    }
    return 0;
}

void particles_keep(particles *p) {
    memcpy(p->kept, p->vertices, p->count * sizeof *p->kept);
}

void particles_return(particles *p) {
    memcpy(p->vertices, p->kept, p->count * sizeof *p->kept);
}
