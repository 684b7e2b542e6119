/* Energies of near pairs: laws of distance, derivatives of single pairs, sums over lists in a fixed order, and friction. */
#pragma once

#include "cscd/energy.h"
#include "src/core/kernels.h"
#include "src/mesh/mesh.h"

/* ---- the calls of the API, within a call ----------------------------------------------------------------- */

cscd_status energy_create(cscd_context *context, const cscd_mesh *mesh, cscd_energy **out);
cscd_status energy_evaluate(cscd_energy *e, const cscd_proximities *items, const cscd_view *positions,
                            const cscd_energy_options *options, const cscd_energy_targets *targets,
                            cscd_energy_sum *out);

/* ---- laws ---------------------------------------------------------------------------------------------- */

/* A function of one variable, with two derivatives. */
typedef struct energy_curve {
    double value, slope, curvature;
} energy_curve;

/* The natural logarithm of a normal number above 0, to 2 ulp. It has the same bits on every processor, which libm does not
 * promise.
 *
 * x = m 2^k with m in [1/sqrt 2, sqrt 2], and ln m = 2 artanh s, s = (m - 1) / (m + 1), whose series in s^2 <= 0.0295
 * ends below 2^-53 of itself after eleven terms. ln 2 = high + low, and k * high is exact for the exponents of doubles. */
double natural_logarithm(double x);

enum { LOGARITHM_TERMS = 11 };
extern const double logarithm_series[LOGARITHM_TERMS];
#define LOGARITHM_2_HIGH 0x1.62e42fee00000p-1
#define LOGARITHM_2_LOW  0x1.a39ef35793c76p-33

/* The law at a distance, without stiffness and weight. At or below the separation a barrier has the value INFINITY and
 * no slope. */
energy_curve energy_law_at(const cscd_energy_options *options, double distance, double separation);

/* ---- pairs --------------------------------------------------------------------------------------------- */

/* The nearest features of a pair, whose distance is that of the sum of weights[i] * x[i] from 0 at the best weights.
 *
 * The best weights are those that the pair has plus any amounts of `slides`: one for each direction in which a nearest
 * point may slide along its feature. A slide adds up to 0, as the weights do. */
typedef struct pair_frame {
    double weights[4];     /* of the nearest points */
    double normal[3];      /* the unit vector from b's nearest point to a's */
    double tangents[2][3]; /* unit vectors across normal, the first ones along the slides */
    double
        slides[2]
              [4];   /* how weights change while a nearest point slides by a unit of length along a tangent */
    int slide_count; /* 0: two points; 1: a point and a line; 2: a plane, or two lines */
    bool straight;   /* a half-space: the normal never turns */
    double distance; /* of VH the height, below 0 behind the plane */
} pair_frame;

/* A slide along a direction this much shorter than its vector, both squared, as of two edges that are parallel, is none of its own. */
#define LEAST_SQUARED_SINE 1e-26

/* Finds the frame of an item at the positions, 3 doubles for each vertex. */
void pair_frame_find(const cscd_proximity *item, const double *x, pair_frame *out);

/* The number of vertices that an item has, one after the other from its first; the others repeat an earlier one. */
static inline int energy_vertices_of(cscd_contact_kind kind) {
    static const uint8_t counts[] = {[CSCD_CONTACT_VF] = 4,
                                     [CSCD_CONTACT_EE] = 4,
                                     [CSCD_CONTACT_VV] = 2,
                                     [CSCD_CONTACT_EV] = 3,
                                     [CSCD_CONTACT_VH] = 2};
    return counts[kind];
}

/* Asks for an item two pages later, which processors do not foresee; behind the last one there may be no memory, which does no harm. */
static inline void energy_item_prefetch(const cscd_proximity *item) {
    const uintptr_t later = (uintptr_t)item + 8192;
    for (uintptr_t line = 0; line < sizeof *item; line += 64)
        __builtin_prefetch((const void *)(later + line));
}

/* The factor of an item, and the distance that it is to keep. */
static inline double energy_weight_of(const cscd_energy_options *options, const cscd_proximity *item) {
    return options->by_count ? item->count : item->weight;
}
static inline double energy_separation_of(const cscd_energy_options *options, const cscd_proximity *item) {
    return options->beyond ? item->separation : 0.0;
}

/* The energy of one item, and the derivatives that are wanted. */
typedef struct energy_term {
    double value, gap;
    double (*gradient)[3]; /* of the four vertices; NULL: not wanted */
    double (*hessian)[12]; /* 12 rows; NULL: not wanted */
    bool project;
} energy_term;

/* Evaluates an item at the positions. A term with the value INFINITY or 0 has derivatives of 0. */
void energy_pair_evaluate(const cscd_energy_options *options, const cscd_proximity *item, const double *x,
                          energy_term *term);

/* The force between an item's points along the normal, at these positions, and the frame there. */
double energy_pair_force(const cscd_energy_options *options, const cscd_proximity *item, const double *x,
                         pair_frame *frame);

/* ---- pairs, many at a time ------------------------------------------------------------------------------- */

enum { ENERGY_BATCH = 64 };

typedef struct near_terms near_terms;

/* Where values and derivatives of terms go; values and gaps have room for a batch. */
typedef struct energy_outputs {
    double *values, *gaps;
    double (*gradients)[4][3]; /* NULL: not wanted */
} energy_outputs;

/* These evaluate `count` items, a batch at most, as energy_pair_evaluate, to the same bits. */
typedef struct energy_kernels {
    uint64_t (*values)(const near_terms *near, size_t first, size_t count, const energy_outputs *out);

    /* Returns a set of items whose gradients are not found: of pairs whose points are in one place. */
    uint64_t (*gradients)(const near_terms *near, size_t first, size_t count, const energy_outputs *out);
} energy_kernels;

DECLARE_KERNELS(energy_kernels);

static inline const energy_kernels *energy_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, energy_kernels);
}

/* Near pairs at one moment. */
struct near_terms {
    cscd_energy_options options;
    const cscd_proximity *items;
    const double *x;
    const energy_kernels *kernels;
    const cscd_mesh *unchecked; /* the mesh of items that are still to be checked; else NULL */
};

/* ---- eigenvectors -------------------------------------------------------------------------------------- */

enum { SYMMETRIC_MAX = 9, SQUARE_MAX = 5 };

/* A symmetric matrix of up to nine rows; its first `size` rows and columns count. */
typedef struct symmetric_matrix {
    int size;
    double m[SYMMETRIC_MAX][SYMMETRIC_MAX];
} symmetric_matrix;

/* Makes the matrix diagonal, and writes the eigenvectors to the rows of `vectors`. Only the diagonal is left of the matrix. */
void symmetric_diagonalize(symmetric_matrix *a, double vectors[SYMMETRIC_MAX][SYMMETRIC_MAX]);

/* A diagonal matrix plus factor >= 0 times the square of a vector of length 1. At most two numbers of the diagonal are negative,
 * and at least one is not. */
typedef struct diagonal_and_square {
    int size;
    double diagonal[SQUARE_MAX], vector[SQUARE_MAX], factor;
} diagonal_and_square;

/* Finds the negative eigenvalues and their unit eigenvectors, and returns their number. */
int diagonal_and_square_negative(const diagonal_and_square *m, double values[2],
                                 double vectors[2][SQUARE_MAX]);

/* ---- sums ---------------------------------------------------------------------------------------------- */

/* The terms of a sum. */
typedef struct energy_terms {
    void (*evaluate)(const void *of, size_t i, energy_term *term);
    /* Evaluates up to a batch of terms without Hessians; NULL: as each by itself. */
    void (*evaluate_batch)(const void *of, size_t first, size_t count, const energy_outputs *out);
    const void *of;
    size_t count;
    /* Where the vertices of term 0 are, how many bytes later those of the next one, and how many of four each has. */
    const void *vertices, *kinds;
    size_t stride;
} energy_terms;

static inline const uint32_t *energy_term_vertices(const energy_terms *terms, size_t i) {
    return (const uint32_t *)(const void *)((const char *)terms->vertices + i * terms->stride);
}

static inline int energy_term_size(const energy_terms *terms, size_t i) {
    return energy_vertices_of(
        *(const cscd_contact_kind *)(const void *)((const char *)terms->kinds + i * terms->stride));
}

/* Memory that sums keep from call to call. */
typedef struct sum_memory {
    double (*gradients)[4][3]; /* of a round of terms */
    double (*hessians)[12][12];
    double *values, *gaps;
    size_t round;          /* the number of terms in a round */
    uint32_t (*slots)[16]; /* per term and two of its vertices: the block's place in its row of the pattern */
    size_t slot_capacity;
} sum_memory;

void sum_memory_free(cscd_context *context, sum_memory *memory);

/* Sums all terms and writes the targets, of which NULL stands for none. INVALID_ARGUMENT: the pattern lacks a block. */
cscd_status energy_sum_terms(cscd_context *context, const cscd_mesh *mesh, const energy_terms *terms,
                             const cscd_energy_targets *targets, sum_memory *memory, cscd_energy_sum *out);

/* Returns INVALID_ARGUMENT, with a sentence, unless the targets fit each other and the mesh. */
cscd_status energy_targets_check(cscd_context *context, const cscd_mesh *mesh,
                                 const cscd_energy_targets *targets);

/* ---- patterns ------------------------------------------------------------------------------------------ */

/* A pattern that belongs to the energy. */
typedef struct owned_pattern {
    size_t *rows;
    uint32_t *columns;
    size_t capacity;        /* of columns */
    uint64_t *keys, *spare; /* row and column of blocks, to be sorted */
    size_t key_capacity;
} owned_pattern;

void owned_pattern_free(cscd_context *context, owned_pattern *pattern);

/* Lists the blocks of the diagonal, of both lists of terms and of a further pattern, which may be NULL. */
cscd_status owned_pattern_make(cscd_context *context, const cscd_mesh *mesh, const energy_terms lists[2],
                               const cscd_energy_pattern *others, owned_pattern *out);

/* Returns INVALID_ARGUMENT, with a sentence, unless rows and columns ascend and are of the mesh. */
cscd_status energy_pattern_check(cscd_context *context, const cscd_mesh *mesh,
                                 const cscd_energy_pattern *pattern);

/* ---- friction ------------------------------------------------------------------------------------------ */

/* The friction of one pair, frozen. */
typedef struct friction_term {
    uint32_t vertices[4];
    cscd_contact_kind kind;
    double force; /* coefficient times normal force */
    double weights[4];
    double tangents[2][3];
} friction_term;

/* Friction of all pairs, for one displacement. */
typedef struct friction_motion {
    const friction_term *terms;
    double slip;
    const double *x0, *x1;
} friction_motion;

/* Evaluates the i-th term of a friction_motion. */
void friction_term_evaluate(const void *motion, size_t i, energy_term *term);
