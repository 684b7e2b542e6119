/* Particles: the forces that they feel on vertices, and how they walk until all rest. */
#include "runtime/particles.h"

#include "runtime/vector.h"

static bool grow(cscd_context *context, uint32_t **block, uint32_t old_count, uint32_t count) {
    uint32_t *grown = context_grow(context, *block, old_count, count, sizeof *grown);
    if (grown != NULL) *block = grown;
    return grown != NULL;
}

cscd_status particles_reserve(particles *p, uint32_t count) {
    cscd_context *context = p->context;
    if (count > p->capacity || p->vertices == NULL) {
        uint32_t **blocks[] = {&p->vertices, &p->groups, &p->objects, &p->targets, &p->kept};
        for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
            if (!grow(context, blocks[i], *blocks[i] != NULL ? p->capacity : 0, count))
                return CSCD_OUT_OF_MEMORY;
        p->capacity = count;
    }
    return particle_grid_reserve(context, &p->grid, p->capacity);
}

void particles_free(particles *p) {
    void *blocks[] = {p->vertices, p->groups, p->objects, p->targets, p->kept};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(p->context, blocks[i]);
    particle_grid_free(p->context, &p->grid);
}

/* ---- forces ------------------------------------------------------------------------------------------ */

/* Lengths are taken in units of R_eff, so that only the scene's proportions decide. */
typedef struct force_sum {
    double vector[3], scalar, potential;
} force_sum;

/* (x_j - x) / r^3 by (3.13). Two particles in one place have no direction; they pull as hard as any. */
static void add_attraction(const particles *p, const double d[3], double r, force_sum *sum) {
    static const double anywhere[3] = {1.0, 0.0, 0.0};
    double s = larger(r, p->closest) / p->radius;
    double magnitude = 1.0 / (s * s);
    sum->scalar += magnitude;
    if (r > 0.0)
        vector_add_scaled(sum->vector, magnitude / r, d, sum->vector);
    else
        vector_add_scaled(sum->vector, magnitude, anywhere, sum->vector);
}

/* The potential of a force of 1 / r^2 that ends at R_eff, where it is 0. */
static double potential_of(const particles *p, double r) {
    return p->radius / larger(r, p->closest) - 1.0;
}

/* What particle i would feel at x. with_count: its pairs are counted, each where its smaller particle is. */
static force_sum forces_at(particles *p, uint32_t i, const double x[3], bool with_count) {
    force_sum sum = {{0.0, 0.0, 0.0}, 0.0, 0.0};
    bool repels = p->rule == PARTICLE_POTENTIAL;
    double reach = p->radius * p->radius;
    grid_search search = particle_grid_around(&p->grid, x);
    for (const grid_entry *e; (e = grid_search_next(&search)) != NULL;) {
        bool attracts = e->group != p->groups[i];
        if (!attracts && (!repels || e->particle == i || p->objects[e->particle] != p->objects[i])) continue;
        double d[3];
        vector_subtract(e->x, x, d);
        double squared = vector_dot(d, d);
        p->counters.distances++;
        if (!(squared < reach)) continue;
        double r = sqrt(squared);
        if (attracts && with_count && i < e->particle) p->counters.pairs++;
        if (repels)
            sum.potential += attracts ? -potential_of(p, r) : potential_of(p, r);
        else
            add_attraction(p, d, r, &sum);
    }
    p->counters.vertices++;
    return sum;
}

/* The larger, the better the vertex. */
static double worth(const particles *p, const force_sum *sum) {
    switch (p->rule) {
    case PARTICLE_ATTRACTION:
        return vector_dot(sum->vector, sum->vector);
    case PARTICLE_SCALAR:
        return sum->scalar;
    case PARTICLE_POTENTIAL:
        return -sum->potential;
    }
    return 0.0;
}

/* The best of where it is and where it can go; of equals where it is, else the smaller vertex. */
static uint32_t choose_target(particles *p, uint32_t i, const double *x) {
    uint32_t best = p->vertices[i];
    force_sum sum = forces_at(p, i, x + (size_t)best * 3, true);
    double most = worth(p, &sum);
    uint32_t end = p->ways.offsets[best + 1];
    for (uint32_t k = p->ways.offsets[best]; k < end; k++) {
        uint32_t target = p->ways.targets[k];
        sum = forces_at(p, i, x + (size_t)target * 3, false);
        double here = worth(p, &sum);
        if (!(here > most)) continue;
        most = here;
        best = target;
    }
    return best;
}

/* ---- walking ------------------------------------------------------------------------------------------ */

/* A state's hash is the sum of these, so that a move changes it by two of them. */
static uint64_t mixed(uint32_t particle, uint32_t vertex) {
    uint64_t h = ((uint64_t)particle << 32 | vertex) + UINT64_C(0x9E3779B97F4A7C15);
    h = (h ^ h >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    h = (h ^ h >> 27) * UINT64_C(0x94D049BB133111EB);
    return h ^ h >> 31;
}

void particles_begin(particles *p) {
    p->state = 0;
    for (uint32_t i = 0; i < p->count; i++) p->state += mixed(i, p->vertices[i]);
    for (int i = 0; i < PARTICLES_RECENT; i++) p->recent[i] = p->state;
    p->landmark = p->state;
    p->landmark_round = p->rounds = 0;
}

uint32_t particles_round(particles *p, const double *x) {
    particle_grid_build(&p->grid, x, p->vertices, p->groups, p->count, p->radius);
    uint32_t moved = 0;
    for (uint32_t i = 0; i < p->count; i++) p->targets[i] = choose_target(p, i, x);
    for (uint32_t i = 0; i < p->count; i++) {
        if (p->targets[i] == p->vertices[i]) continue;
        moved++;
        p->state += mixed(i, p->targets[i]) - mixed(i, p->vertices[i]);
        p->vertices[i] = p->targets[i];
    }
    p->rounds++;
    p->counters.rounds++;
    return moved;
}

/* After how many rounds the state has come back, or 0: the last few states are compared with, for short
 * cycles are common, and one of a round that is a power of two, which in the end finds every cycle (Brent
 * 1980). Equal hashes of different states would end a walk too early, and do no other harm. */
static uint32_t came_back(particles *p) {
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
        uint32_t length = came_back(p);
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
