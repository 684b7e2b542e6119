/* The kernels that decide pairs of features, eight at a time. */
#pragma once

#include "runtime/ccd/min_separation.h"
#include "src/core/context.h"
#include "src/core/kernels.h"

/* The points, triangles and edges that pairs of features name. */
typedef struct feature_source {
    const double *x0, *x1; /* three per vertex */
    const uint32_t (*triangles)[3], (*edges)[2];
} feature_source;

/* Pairs of features: vertex a[i] and triangle b[i], or edges a[i] and b[i]. Kernels take eight at a time, so
 * the arrays go on for seven more readable and writable places after the last pair. */
typedef struct feature_pairs {
    uint32_t *a, *b;
    uint32_t count;
} feature_pairs;

/* The verdicts on eight pairs, and for each contact the begin of the first root interval in which it touches. */
typedef struct root_outcomes {
    uint32_t apart, contacts; /* sets of lanes */
    double begin[LANES];
} root_outcomes;

typedef void root_kernel(const feature_source *source, const uint32_t *a, const uint32_t *b,
                         root_outcomes *out);

/* Eight pairs that touch, and for each the begin of the root interval in which it does. */
typedef struct found_pairs {
    uint32_t a[LANES], b[LANES];
    double begin[LANES];
} found_pairs;

/* Their contacts, with members as in elementary_contact. */
typedef struct described_contacts {
    double toi[LANES], u[LANES], v[LANES], point[3][LANES], normal[3][LANES];
} described_contacts;

typedef void describe_kernel(const feature_source *source, const found_pairs *pairs, described_contacts *out);

/* The limits of eight pairs; see separation. */
typedef struct separations_x8 {
    double distance[LANES], tolerance[LANES];
} separations_x8;

/* The outcomes for eight pairs. Pairs apart certainly stay farther apart than their limit's distance and tolerance.
 * Pairs within its distance are so for certain at the start. For them u, v and offset name the nearest points at
 * the start as parameters and as the offset from b's point to a's; distance is the offset's length. */
typedef struct proximity_outcomes {
    uint32_t apart, within; /* sets of lanes */
    double u[LANES], v[LANES], offset[3][LANES], distance[LANES];
} proximity_outcomes;

typedef void proximity_kernel(const feature_source *source, const uint32_t *a, const uint32_t *b,
                              const separations_x8 *limits, proximity_outcomes *out);

typedef struct ccd_kernels {
    /* Keep the pairs that signs leave undecided, in their order. The same operations as separated_by_axes and
     * coplanarity_excluded, so the same verdicts. */
    void (*reject_by_signs_vf)(const feature_source *source, feature_pairs *pairs);
    void (*reject_by_signs_ee)(const feature_source *source, feature_pairs *pairs);

    /* Level two for pairs a[0], b[0] to a[7], b[7]. These decide pairs whose cubic certainly has one root, */
    root_kernel *roots_vf, *roots_ee;

    /* and these pairs whose cubic certainly has two roots, or none. */
    root_kernel *two_roots_vf, *two_roots_ee;

    /* The same bits as contact_frame_describe. */
    describe_kernel *describe_vf, *describe_ee;

    /* Distances of pairs a[0], b[0] to a[7], b[7]. */
    proximity_kernel *proximity_vf, *proximity_ee;
} ccd_kernels;

DECLARE_KERNELS(ccd_kernels);

static inline const ccd_kernels *ccd_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, ccd_kernels);
}
