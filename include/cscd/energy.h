/* Energies of near pairs, with gradients and Hessians: barriers, penalties and friction of incremental
 * potential contact. docs/solver/energies.md has the formulas and a program. */
#ifndef CSCD_ENERGY_API_H
#define CSCD_ENERGY_API_H

#include <cscd/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ==== Energies of near pairs ================================================================================ */

/* The energy of a list is the sum over its items of
 *
 *     stiffness * weight * mollifier * law(distance)
 *
 * The weight is that of the item: an area of convergent IPC after cscd_detector_set_rest, else its count. Items
 * come from cscd_detector_find_near or cscd_line_search_find_near at the same positions, in either form;
 * both have one sum, up to rounding, which goes on smoothly where a pair changes from one kind to another. The
 * distance is that of the item's nearest features: two points, a point and a line, a point and a plane, or
 * two lines; so the derivatives are those of Li et al. (Incremental Potential Contact, 2020). They are exact
 * up to rounding, which grows as an edge or a face becomes small, and as two edges become parallel.
 *
 * Items may also be your own. Of each, kind, vertices, weights, weight, separation, threshold and count are
 * read, and of VH the normal. On the border of a feature some weights are exactly 0 (cscd_stencil), and so are
 * those of vertices that the kind does not have. */

/* An energy of a distance d, with the reach r and a distance s to keep (cscd_energy_options). It is 0 from
 * s + r on; below, with g = d - s:
 *   BARRIER          -(g - r)^2 ln(g / r): Li et al. 2020, eq. 6; a squared length, infinite at s
 *   BARRIER_SQUARED  the same of d^2 - s^2 and (s + r)^2 - s^2, as in their programs and in IPC Toolkit; the
 *                    fourth power of a length, infinite at s
 *   QUADRATIC        (r - g)^2 / 2, a squared length; finite at s and below
 *   CUBIC            (r - g)^3 / (6 r), a squared length; its curvature begins at 0, and is that of QUADRATIC
 *                    at s */
typedef enum cscd_energy_law {
    CSCD_ENERGY_BARRIER,
    CSCD_ENERGY_BARRIER_SQUARED,
    CSCD_ENERGY_QUADRATIC,
    CSCD_ENERGY_CUBIC,
    CSCD_ENERGY_LAW_MAX_ENUM = 0x7fffffff
} cscd_energy_law;

/* Options of energies; start from cscd_energy_defaults and set the reach. */
typedef struct cscd_energy_options {
    uint32_t struct_size; /* set by cscd_energy_defaults */
    cscd_energy_law law;  /* BARRIER by default */
    double reach;         /* a length above 0; 0, the default, is refused */
    double stiffness;     /* 0 or more; 1 by default */

    /* The law is multiplied to become a length: by 1 / r, and BARRIER_SQUARED by r / ((s + r)^2 - s^2)^2. With
     * areas as weights the stiffness is then a pressure, whatever the reach (convergent IPC, Li et al. 2023).
     * False by default. */
    bool physical;

    bool by_count;       /* an item weighs its count (Li et al. 2020); false, the default: its weight */
    bool beyond;         /* for lists of CSCD_NEAR_BEYOND: s is the item's separation; else, by default, 0 */
    uint8_t reserved[5]; /* 0 */

    /* For cscd_energy_freeze_friction: a coefficient for all pairs, 0 by default; or one for each object, of
     * which a pair has the geometric mean; or one for each item. The last array that is not NULL counts. */
    double friction;
    const double *object_friction;
    const double *item_friction;

    /* Points that slide less than this length hold by static friction: IPC's eps_v times the time step. Above
     * 0 where there is friction; 0 by default. */
    double slip;
} cscd_energy_options;

/* Returns the default options of energies. */
CSCD_API void cscd_energy_defaults_sized(cscd_energy_options *out, size_t size);
static inline cscd_energy_options cscd_energy_defaults(void) {
    cscd_energy_options options;
    cscd_energy_defaults_sized(&options, sizeof options);
    return options;
}

/* Memory for sums over the pairs of one mesh, a pattern of a matrix, and friction that was frozen. */
typedef struct cscd_energy cscd_energy;

/* Creates an energy for a mesh, which it keeps. Without a mesh of surfaces, take one of points
 * (cscd_object_of_points). The threads of the context share its calls. */
CSCD_API cscd_status cscd_energy_create(cscd_context *context, const cscd_mesh *mesh, cscd_energy **out);

/* Frees the energy with its pattern. */
CSCD_API void cscd_energy_destroy(cscd_energy *energy);

/* The places of the 3 x 3 blocks of a sparse matrix, whose rows are the vertices. */
typedef struct cscd_energy_pattern {
    const size_t *rows;      /* vertex_count + 1 numbers: where each row begins, and block_count */
    const uint32_t *columns; /* block_count vertices, ascending in each row */
    size_t block_count;
} cscd_energy_pattern;

/* Makes the pattern of a matrix: the diagonal, and a block for each two vertices of an item, of an item of
 * frozen friction, or of `others`, which may be NULL. It lives until the next call of this function with the
 * energy. Solvers that keep one pattern for many lists give their own. CSR of numbers has three rows for each
 * row of blocks. */
CSCD_API cscd_status cscd_energy_make_pattern(cscd_energy *energy, const cscd_proximities *items,
                                              const cscd_energy_pattern *others, cscd_energy_pattern *out);

/* Derivatives to be written; NULL for those that are not wanted. */
typedef struct cscd_energy_targets {
    double *gradient; /* 3 numbers for each vertex */

    /* The Hessian item by item: 144 numbers each, row by row a 12 x 12 matrix of the item's four vertices. Rows
     * and columns of vertices that repeat an earlier one are 0. With friction, items are those that were
     * frozen. */
    double *blocks;

    /* The Hessian as 9 block_count numbers in the places of a pattern. INVALID_ARGUMENT: a block of an item
     * has no place. */
    double *matrix;
    const cscd_energy_pattern *pattern;

    bool scalar_rows;    /* matrix is CSR of numbers; false: BSR, block by block, each row by row */
    bool project;        /* each item's Hessian becomes the nearest positive semidefinite matrix */
    bool add;            /* gradient and matrix are added to what is there; false: they replace it */
    uint8_t reserved[5]; /* 0 */
} cscd_energy_targets;

/* A sum of energies. */
typedef struct cscd_energy_sum {
    double value;    /* INFINITY if an item is infinite */
    double least;    /* the least distance less separation of all items; INFINITY without items */
    size_t active;   /* the number of items with an energy that is not 0 */
    size_t infinite; /* the number of items with infinite energy, whose derivatives count as 0 */
    size_t first;    /* the first of these; SIZE_MAX if there is none */
} cscd_energy_sum;

/* Sums the energy of near pairs at the positions and, unless targets is NULL, its derivatives. Items are added
 * in their order, so the bits do not depend on threads. It allocates only to make its memory larger. An
 * example:
 *
 *     cscd_energy *energy;
 *     cscd_proximities pairs;
 *     cscd_energy_sum sum;
 *     double gradient[3 * VERTICES];
 *     cscd_energy_targets targets = {.gradient = gradient};
 *     cscd_energy_options options = cscd_energy_defaults();
 *     options.reach = 0.6;
 *     cscd_energy_create(context, mesh, &energy);
 *     cscd_detector_find_near(detector, CSCD_DOUBLES(x0, n), options.reach, CSCD_NEAR_UNIQUE, &pairs);
 *     cscd_status status =
 *         cscd_energy_evaluate(energy, &pairs, CSCD_DOUBLES(x0, n), &options, &targets, &sum);
 *     cscd_energy_destroy(energy);
 */
CSCD_API cscd_status cscd_energy_evaluate(cscd_energy *energy, const cscd_proximities *items,
                                          const cscd_view *positions, const cscd_energy_options *options,
                                          const cscd_energy_targets *targets, cscd_energy_sum *out);

/* ---- friction ------------------------------------------------------------------------------------------- */

/* Freezes the friction of near pairs at these positions (Li et al. 2020, section 5): for each pair its normal
 * force -energy', mollifier included, its tangent plane, and the weights of its points. It replaces what was
 * frozen before. INVALID_ARGUMENT: an item is infinite, a coefficient is negative, or slip is 0. */
CSCD_API cscd_status cscd_energy_freeze_friction(cscd_energy *energy, const cscd_proximities *items,
                                                 const cscd_view *positions,
                                                 const cscd_energy_options *options);

/* Sums the dissipative potential of frozen friction for the displacement from x0 to x1, and its derivatives by
 * x1: coefficient * normal force * f0(|sliding|), with f0 of Li et al. 2020, eq. 14 and slip for eps_v h. The
 * Hessian is positive semidefinite as it is. The sum's least is the least sliding; nothing is infinite. */
CSCD_API cscd_status cscd_energy_evaluate_friction(cscd_energy *energy, const cscd_view *x0,
                                                   const cscd_view *x1, const cscd_energy_targets *targets,
                                                   cscd_energy_sum *out);

#ifdef __cplusplus
}
#endif

#endif
