/* Piercings, pieces and winding numbers of a small scene by brute force, on the leading terms of determinants of
 * moved points; and trials that compare the library with these, one scene after another. */
#pragma once

#include "runtime/intersections/intersections.h"
#include "runtime/intersections/named_surface.h"
#include "tests/support/intersections/grid_scene.h"

#include <stdint.h>

/* The leading terms of all determinants of a few moved points: polynomials in epsilon as in docs/theory/curves.md, written
 * out, of which only the term with the least power is kept. Each is computed once and looked up after, so that millions of
 * scenes can be compared. They share no code with src/mesh/symbolic.c, and none with the polynomials of grid_scene.h. */
enum { LEADING_POINTS = 20, LEADING_QUADRUPLES = 4845, LEADING_TRIPLES = 1140 };

/* coefficient * epsilon^power, the coefficient not 0. */
typedef struct leading_term {
    uint64_t power;
    __int128 coefficient;
} leading_term;

/* Points by their names, with integers below 2^28 in magnitude as coordinates. */
typedef struct leading_terms {
    int64_t points[LEADING_POINTS][3];
    leading_term spatial[LEADING_QUADRUPLES],
        flat[3][LEADING_TRIPLES]; /* a coefficient of 0: not known yet */
} leading_terms;

/* Forgets all terms; the points follow. */
void leading_terms_clear(leading_terms *t);

/* Of (b - a) x (c - a) . (d - a), the names all different. */
leading_term leading_orient3d(leading_terms *t, const uint32_t names[4]);

/* The sign of (b - a) x (c - a) in the projection along an axis. */
int leading_orient_along(leading_terms *t, const uint32_t names[3], int axis);

static inline int leading_sign(leading_term term) {
    return term.coefficient > 0 ? 1 : -1;
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

enum { ORACLE_EDGES = 64, ORACLE_TRIANGLES = 32 };

/* An end of a piece: where an edge of one triangle passes through the other; edge_name is the least edge that it is one
 * with. Or, with AT_VERTEX, a vertex that both triangles have, whose name then stands in place of the triangle. */
typedef struct oracle_piercing {
    uint32_t edge_name, triangle;
} oracle_piercing;

enum { AT_VERTEX = UINT32_MAX };

/* The piece that two triangles a < b have in common, in the direction of the normal of a times that of b. */
typedef struct oracle_piece {
    uint32_t a, b;
    oracle_piercing ends[2];
} oracle_piece;

typedef struct surface_oracle {
    const grid_scene *scene;
    double scale; /* times this, coordinates are integers */
    leading_terms terms;
    uint32_t edge_names[ORACLE_EDGES];
    bool passes[ORACLE_EDGES][ORACLE_TRIANGLES]; /* the edge through the triangle */
} surface_oracle;

void surface_oracle_begin(surface_oracle *o, const grid_scene *s, double scale);

/* Finds the piece of two triangles; false: there is none. Aborts if there are piercings that lemmas 2 and 3 of
 * docs/theory/curves.md rule out. */
bool surface_oracle_piece(surface_oracle *o, uint32_t a, uint32_t b, oracle_piece *out);

/* The point of a piercing, rounded to the nearest doubles: s, u, v, then x, y, z. */
void surface_oracle_point(surface_oracle *o, uint32_t edge, uint32_t triangle, double out[6]);

/* The winding number of an object at the point, by a ray along x. */
int surface_oracle_number(surface_oracle *o, corner_side at, uint32_t object);

/* ---- trials -------------------------------------------------------------------------------------------- */

/* How a scene's grid becomes coordinates. */
typedef enum trial_spread {
    SPREAD_NONE,   /* small integers */
    SPREAD_NEARLY, /* most are off the grid by 2^-20, or not */
    SPREAD_FAR,    /* half of them are anywhere between the grid's points */
    SPREAD_COUNT
} trial_spread;

typedef struct trial_totals {
    uint64_t scenes, piercings, degenerate, pieces, curves, open_curves, corners, wound, twice, cut;
} trial_totals;

typedef struct surface_trial {
    traced_scene traced;
    surface_oracle oracle;
    bool closed; /* every component is closed */
    uint8_t points_at[ORACLE_EDGES][ORACLE_TRIANGLES], pieces_at[ORACLE_EDGES][ORACLE_TRIANGLES];
    bool piece_seen[ORACLE_TRIANGLES][ORACLE_TRIANGLES];
    uint32_t parents[ORACLE_TRIANGLES *
                     ORACLE_TRIANGLES]; /* of pieces that are joined; a * ORACLE_TRIANGLES + b */
    trial_totals totals;
} surface_trial;

/* The same arguments give the same scene. Returns NULL, or what differs; the scene stays for surface_trial_print. */
const char *surface_trial_run(surface_trial *t, grid_family family, trial_spread spread, uint64_t seed);

/* Prints vertices and triangles of the last scene. */
void surface_trial_print(const surface_trial *t);
