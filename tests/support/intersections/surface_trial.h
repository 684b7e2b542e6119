/* One small scene after another: curves, pieces, points, patches and winding numbers, as the library finds them and as the
 * oracle does. */
#pragma once

#include "runtime/intersections/intersections.h"
#include "tests/support/intersections/grid_scene.h"
#include "tests/support/intersections/surface_oracle.h"

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
