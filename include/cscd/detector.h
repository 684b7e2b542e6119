/* A detector: the runtime. Part of cscd/cscd.h, which says what holds for every function. */
#ifndef CSCD_DETECTOR_API_H
#define CSCD_DETECTOR_API_H

#include <cscd/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct cscd_detector cscd_detector;

typedef enum cscd_mode {
    CSCD_MODE_ALL, /* every contact of the interval is reported, whatever the mesh and its start state (but
                    * for published methods, and starts vouched for wrongly) */
    CSCD_MODE_EARLIEST /* of a component whose start is proven embedded, at least one contact with itself at
                        * its earliest time; so none is a proof that there is none. All other contacts as in
                        * ALL, and all with pairs to leave out. After such a contact the whole next start is
                        * checked, so over a recording ALL costs less. See cscd_detector_guarantee */
} cscd_mode;

/* "all", "earliest"; static storage, never NULL. from_name leaves *out untouched when it returns false. */
CSCD_API const char *cscd_mode_name(cscd_mode mode);
CSCD_API bool cscd_mode_from_name(const char *name, cscd_mode *out);

/* What is done to prove that triangles are clean at the start, so that culling by orientation is sound:
 * nothing of their component meets them, and no contact cuts them off from most of it. A component is
 * embedded when all are. What is clean and takes no part in a contact is clean at the next start. */
typedef enum cscd_start {
    CSCD_START_PROVE,   /* the static check of the triangles not known to be clean */
    CSCD_START_VOUCHED, /* nothing: the caller knows that every start is embedded */
    CSCD_START_UNKNOWN  /* nothing: triangles are culled only after a cscd_detector_check of the start */
} cscd_start;

/* Bounding volumes in the trees. They differ in time only. */
typedef enum cscd_volume {
    CSCD_VOLUME_BOX,   /* three axes: the faster, by measurement (docs/measurements.md) */
    CSCD_VOLUME_KDOP14 /* seven axes, 14 planes */
} cscd_volume;

/* "box", "kdop14"; static storage, never NULL. from_name leaves *out untouched when it returns false. */
CSCD_API const char *cscd_volume_name(cscd_volume volume);
CSCD_API bool cscd_volume_from_name(const char *name, cscd_volume *out);

typedef struct cscd_detector_options {
    uint32_t struct_size; /* set by cscd_detector_defaults */
    cscd_method method;   /* default AUTO */
    cscd_mode mode;       /* default ALL */
    cscd_start start;     /* default PROVE */
    cscd_volume volume;   /* default BOX */

    /* Pairs to leave out: a contact or proximity is not reported, and a self-intersection not listed, when
     * this says true for two triangles a < b of which one contains (or is) the one feature and the other the
     * other. Called on the calling thread, for pairs in contact only. Default NULL: nothing is left out. */
    bool (*ignore)(void *user, uint32_t a, uint32_t b);
    void *ignore_user;

    /* The same as a list, which is copied: ignored_count pairs of triangles, in any order. Default NULL. */
    const uint32_t *ignored;
    size_t ignored_count;

    /* Seams, copied: seam_count pairs of vertices that count as one vertex, as where panels of cloth are sewn
     * together or a welded surface is split. Features that share one are never reported, as ever. A chain of
     * pairs makes all of its vertices one. Default NULL. */
    const uint32_t *seams;
    size_t seam_count;

    /* Lengths, each 0 or from 2^-300 to 2^300. min_separation 0, the default: a contact is touching; d: a
     * contact is coming within d. Then every pair that comes within d is reported, and toi is not after the
     * first moment at which its distance is d; at toi it is at most d + tolerance, so no pair that stays
     * farther apart is reported. Only contacts that are marked as bounded may be farther apart at toi.
     * tolerance: 0, the default, stands for 1e-6 d; without min_separation it must be 0. Rounding sets it a
     * limit: for a pair whose positions at both ends extend over a length s along x, y or z, a tolerance
     * below 2^-42 s is taken for 2^-42 s. */
    double min_separation, tolerance;

    /* A step that a contact limits has at most this share of its time: cscd_detector_max_step. In (0,1),
     * default 0.8. */
    double step_factor;
} cscd_detector_options;

CSCD_API cscd_detector_options cscd_detector_defaults(void);

/* The mesh lives as long as its detectors. plan: NULL, or one of the mesh; the detector copies what it needs.
 * CHARGE and KMEANS want a plan of that method; the others take any, or none. */
CSCD_API cscd_status cscd_detector_create(const cscd_mesh *mesh, const cscd_plan *plan,
                                          const cscd_detector_options *options, cscd_detector **out);
CSCD_API void cscd_detector_destroy(cscd_detector *detector);

/* Other values for min_separation and tolerance, as in the options, from the next call on: a solver that has
 * to get nearer need not build another detector. What is known of starts is forgotten where culling ends. A
 * line begun with less must begin again before its next max_step, which else is INVALID_ARGUMENT. */
CSCD_API cscd_status cscd_detector_set_separation(cscd_detector *detector, double min_separation,
                                                  double tolerance);

/* A vertex and a face, or two edges. */
typedef enum cscd_contact_kind { CSCD_CONTACT_VF, CSCD_CONTACT_EE } cscd_contact_kind;

/* "vf", "ee"; static storage, never NULL. */
CSCD_API const char *cscd_contact_kind_name(cscd_contact_kind kind);

/* Where two features meet at time toi, or with min_separation, their nearest points then:
 *   VF  a = vertex, b = triangle (p0,p1,p2): (1-u-v) p0 + u p1 + v p2
 *   EE  a < b edges: (1-u) a0 + u a1 and (1-v) b0 + v b1 */
typedef struct cscd_contact {
    cscd_contact_kind kind;
    uint32_t a, b;    /* vertex and triangle, or edges, in the mesh's numbering */
    double toi;       /* in [0,1], not after the true time */
    double u, v;      /* in [0,1], up to rounding */
    double point[3];  /* midpoint of the two points named by u and v at toi */
    double normal[3]; /* unit, against the motion of a relative to b; 0 where the features have none; with
                       * min_separation from b's nearest point to a's, unless the features touch */
    bool bounded;     /* only with min_separation > 0: the bound on work was hit, so toi is safe but may be
                       * early, and the pair may stay farther apart than min_separation */
} cscd_contact;

/* Sorted by (toi, kind, a, b). Owned by the detector, valid until the next call of it or of one of its lines.
 */
typedef struct cscd_contacts {
    const cscd_contact *items;
    size_t count;
} cscd_contacts;

/* The contacts between start and end, two arrays of positions, that the mode promises. The first call builds
 * the trees from start, so it is slower; later calls allocate only when a buffer has to grow, when trees have
 * decayed over a long deformation and are built anew, or in the first interval in which nothing is culled. */
CSCD_API cscd_status cscd_detector_step(cscd_detector *detector, const double *start, const double *end,
                                        cscd_contacts *out);

/* Two triangles a < b, of which an edge or vertex of one meets a face, or an edge an edge, of the other;
 * features that share a vertex aside. Touching counts; triangles that share vertices are tested too. */
typedef struct cscd_intersection {
    uint32_t a, b;
} cscd_intersection;

/* The state of the mesh at one moment. Sorted by (a, b). Valid until the detector's next call. */
typedef struct cscd_intersections {
    const cscd_intersection *items;
    size_t count;                 /* 0: the mesh is embedded there (pairs left out aside) */
    uint32_t zero_area_triangles; /* triangles whose corners lie on one line */
    uint32_t first_zero_area;     /* UINT32_MAX if there is none */
} cscd_intersections;

/* Static check with exact predicates. Timings and counters of the last step stay as they are, but for
 * check_ms. */
CSCD_API cscd_status cscd_detector_check(cscd_detector *detector, const double *positions,
                                         cscd_intersections *out);

/* Why a component's contacts with itself in the last step are what they are. */
typedef enum cscd_reason {
    CSCD_REASON_METHOD,    /* complete: the method does not cull, or not with min_separation */
    CSCD_REASON_SURFACE,   /* complete: open, non-manifold or inconsistently oriented, so never culled */
    CSCD_REASON_CROSSING,  /* complete: the start crosses or touches itself; culled, if at all, where not */
    CSCD_REASON_UNPROVEN,  /* complete: the start is not known to be embedded; culled, if at all, where it is
                            */
    CSCD_REASON_CLEAN,     /* complete: the start is embedded, and there is no contact */
    CSCD_REASON_FINISHED,  /* complete: the start is embedded, there are contacts, and mode ALL found all */
    CSCD_REASON_PUBLISHED, /* contacts may be missing: method PUBLISHED or ICCD_PUBLISHED */
    CSCD_REASON_CONTOUR,   /* complete: ICCD needs no embedded start */
    CSCD_REASON_EARLIEST,  /* the start is embedded, and mode EARLIEST promises the first contacts only */
    CSCD_REASON_OBSTACLE   /* not looked for: an obstacle */
} cscd_reason;

/* A sentence's part: "open, non-manifold or inconsistently oriented"; static storage, never NULL. */
CSCD_API const char *cscd_reason_text(cscd_reason reason);

typedef struct cscd_guarantee {
    bool complete;       /* every contact of the component with itself was reported */
    bool start_embedded; /* proven, or vouched for */
    cscd_reason reason;
} cscd_guarantee;

/* Of the last step, meaningless before the first; contacts between components are always complete. component
 * < the mesh's count. */
CSCD_API cscd_guarantee cscd_detector_guarantee(const cscd_detector *detector, uint32_t component);

/* How a triangle faced its region's detector point during the last step: 1 (S+), -1 (S-), or 0: neither
 * throughout, or it was not clean at the start. Undefined after a step that failed. */
CSCD_API int cscd_detector_orientation(const cscd_detector *detector, uint32_t triangle);
/* Regions by which the detector culls: those of its plan, or the components; 0 where it does not cull by
 * orientation: by its method, or with min_separation. Since 1.1. */
CSCD_API uint32_t cscd_detector_region_count(const cscd_detector *detector);
/* Where the detector point of a region was at the start and at the end of the last step, up to rounding; in
 * between it moved on a line. region < the count; undefined before the first step, and after one that failed.
 * Since 1.1. */
CSCD_API void cscd_detector_region_point(const cscd_detector *detector, uint32_t region, double start[3],
                                         double end[3]);

typedef struct cscd_timings { /* of the last step; the seed of each is a stage of the pipeline */
    double update_ms;         /* BVH update: records and refit */
    double orientation_ms;    /* detector points, orientation check */
    double contour_ms;        /* ICCD: normal cones and contour tests */
    double traversal_ms;      /* overlapping triangle pairs */
    double contact_ms;        /* representatives, elementary tests, sorting */
    double total_ms;          /* the whole step, checks of the input included */
    double proof_ms;          /* static check of the start within the step, a part of total_ms */
    double check_ms;          /* the last cscd_detector_check */
} cscd_timings;

typedef struct cscd_counters { /* of the last step; exact, and the same for any thread count */
    uint64_t static_checks;    /* of the start, within the step: of the triangles not known to be free */
    uint64_t clean;            /* triangles clean at the start: only these are culled */
    uint64_t rebuilds;         /* 1: the trees had decayed and were built anew */
    uint64_t passes;           /* further traversals, for pairs that contacts have uncovered */
    uint64_t plus, minus;      /* triangles that are S+ and S- */
    uint64_t contours, sealed; /* ICCD: contour tests; patches that passed, in which no pair is looked at */
    uint64_t boxes_tested;     /* pairs of bounding volumes compared during traversal */
    uint64_t pcp;              /* potentially colliding pairs: triangle pairs whose volumes overlap */
    uint64_t adjacent;         /* those of them that share a vertex and were left out: others answer for their
                                * features, but in the published methods */
    uint64_t feature_pairs; /* VF and EE pairs, none twice, that may touch by their own volumes; BRUTE: all */
    uint64_t tests;         /* elementary tests, one for each of these */
    uint64_t by_signs;      /* tests that signs rejected, */
    uint64_t by_roots;      /* those that intervals about the roots decided, */
    uint64_t by_exact;      /* and those that took exact arithmetic: together all tests, or with
                             * min_separation none */
    uint64_t vf, ee;        /* contacts reported */
    uint64_t bounded;       /* of these, cscd_contact.bounded */
} cscd_counters;

CSCD_API cscd_timings cscd_detector_timings(const cscd_detector *detector);
CSCD_API cscd_counters cscd_detector_counters(const cscd_detector *detector);

#ifdef __cplusplus
}
#endif

#endif
