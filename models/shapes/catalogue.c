/* Bodies by name, with any possible number of triangles. */
#include "models/shapes/catalogue.h"
#include "models/shapes/bodies.h"

#include <string.h>

/* A body is made in one of three ways: by rings, by a function, or by squares with a number of their own. */
typedef struct entry {
    const char *name, *description;
    uint32_t default_count, least_count;
    void (*add_rings)(body *b, uint32_t triangle_count);
    bool (*add_implicit)(body *b, uint32_t triangle_count);
    void (*add_squares)(body *b, uint32_t n);
    uint32_t (*count_of)(uint32_t n), least_n;
} entry;

static uint32_t cube_triangles(uint32_t n) {
    return 12 * n * n;
}

static const entry entries[BODY_KIND_COUNT] = {
    [BODY_PAWN] = {"pawn", "a chess pawn: foot, waist, collar, head", 5130, 300, .add_rings = add_pawn},
    [BODY_DUMBBELL] = {"dumbbell", "two balls on a rod", 1710, 100, .add_rings = add_dumbbell},
    [BODY_FIGURE] = {"figure", "a person, standing", 4014, 1000, .add_implicit = add_figure},
    [BODY_SPHERE] = {"sphere", "radius 1", 2000, 20, .add_rings = add_sphere},
    [BODY_ELLIPSOID] = {"ellipsoid", "half axes 1.5, 1, 0.7", 2000, 100, .add_implicit = add_ellipsoid},
    [BODY_CUBE] = {"cube", "edge 2", 1200, 12, .add_squares = add_cube, cube_triangles, 1},
    [BODY_TORUS] = {"torus", "genus 1", 2000, 100, .add_rings = add_torus},
    [BODY_GENUS2] = {"genus2", "two rings grown together: genus 2", 3000, 500, .add_implicit = add_genus2},
    [BODY_CAPSULE] = {"capsule", "a cylinder with round ends", 2000, 60, .add_rings = add_capsule},
    [BODY_COIL] = {"coil", "a spring of five turns", 6000, 1000, .add_rings = add_coil},
    [BODY_SLAB] = {"slab", "a flat box folded twice, like a letter", 4000, 0, .add_squares = add_slab,
                   slab_triangles, 28},
    [BODY_CHAIN] = {"chain", "five linked tori: five components", 5000, 1000, .add_rings = add_chain},
    [BODY_HAND] = {"hand", "a palm and five fingers", 6000, 2000, .add_implicit = add_hand},
    [BODY_OCTOPUS] = {"octopus", "eight arms that curl", 12000, 4000, .add_implicit = add_octopus},
    [BODY_LETTER_T] = {"letter-t", "a T with round edges", 1380, 600, .add_implicit = add_letter_t},
    [BODY_LETTER_U] = {"letter-u", "a U with square corners", 1380, 600, .add_implicit = add_letter_u},
    [BODY_LETTER_V] = {"letter-v", "a V", 1380, 600, .add_implicit = add_letter_v},
    [BODY_LETTER_W] = {"letter-w", "a W", 11920, 1000, .add_implicit = add_letter_w},
};

const char *body_kind_name(body_kind kind) {
    return entries[kind].name;
}

const char *body_kind_description(body_kind kind) {
    return entries[kind].description;
}

bool body_kind_from_name(const char *name, body_kind *out) {
    for (int kind = 0; kind < BODY_KIND_COUNT; kind++) {
        if (strcmp(name, entries[kind].name) != 0) continue;
        *out = (body_kind)kind;
        return true;
    }
    return false;
}

/* Returns the largest n with at most that many triangles, or the least n. */
static uint32_t squares_below(const entry *e, uint32_t triangle_count) {
    uint32_t n = e->least_n;
    while (e->count_of(n + 1) <= triangle_count) n++;
    return n;
}

uint32_t body_least_count(body_kind kind) {
    const entry *e = &entries[kind];
    return e->count_of != NULL ? e->count_of(e->least_n) : e->least_count;
}

uint32_t body_nearest_count(body_kind kind, uint32_t triangle_count) {
    const entry *e = &entries[kind];
    uint32_t least = body_least_count(kind);
    if (triangle_count <= least) return least;
    if (triangle_count > BODY_TRIANGLES_MAX) triangle_count = BODY_TRIANGLES_MAX;
    if (e->count_of == NULL) return triangle_count - triangle_count % 2;
    uint32_t n = squares_below(e, triangle_count), below = e->count_of(n), above = e->count_of(n + 1);
    return triangle_count - below <= above - triangle_count || above > BODY_TRIANGLES_MAX ? below : above;
}

uint32_t body_default_count(body_kind kind) {
    return body_nearest_count(kind, entries[kind].default_count);
}

static bool refuse_count(body_kind kind, uint32_t triangle_count, io_error *error) {
    const entry *e = &entries[kind];
    uint32_t least = body_least_count(kind);
    if (triangle_count < least || triangle_count > BODY_TRIANGLES_MAX)
        return io_fail(error, "%s: %u triangles asked for, from %u to %u are possible", e->name,
                       triangle_count, least, (unsigned)BODY_TRIANGLES_MAX);
    if (e->count_of == NULL)
        return io_fail(error, "%s: %u triangles asked for, closed surfaces have an even number: %u or %u",
                       e->name, triangle_count, triangle_count - 1, triangle_count + 1);
    uint32_t n = squares_below(e, triangle_count), below = e->count_of(n), above = e->count_of(n + 1);
    if (above > BODY_TRIANGLES_MAX)
        return io_fail(error, "%s: %u triangles asked for, its squares make %u at most", e->name,
                       triangle_count, below);
    return io_fail(error, "%s: %u triangles asked for, its squares make %u or %u", e->name, triangle_count,
                   below, above);
}

bool body_make(body_kind kind, uint32_t triangle_count, body *out, io_error *error) {
    const entry *e = &entries[kind];
    body b = {0};
    bool good = true;
    if (triangle_count == 0) triangle_count = body_default_count(kind);
    if (body_nearest_count(kind, triangle_count) != triangle_count)
        return refuse_count(kind, triangle_count, error);
    if (e->add_rings != NULL) e->add_rings(&b, triangle_count);
    if (e->add_implicit != NULL) good = e->add_implicit(&b, triangle_count);
    if (e->add_squares != NULL) e->add_squares(&b, squares_below(e, triangle_count));
    if (!good || b.triangle_count != triangle_count) {
        body_free(&b);
        return io_fail(error, "%s: no even mesh of %u triangles was found", e->name, triangle_count);
    }
    body_round(&b);
    *out = b;
    return true;
}
