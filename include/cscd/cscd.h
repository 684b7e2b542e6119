/*
 * cscd - continuous self-collision detection for deforming triangle meshes.
 *
 * One mesh, two sets of vertex positions (start and end of an interval), every vertex moving in a
 * straight line between them: cscd reports every vertex-face and edge-edge pair of the mesh that touches.
 *
 * Conventions, true for every function below:
 *   positions   packed x,y,z doubles, vertex_count * 3 values, in any one unit of length; each value is
 *               0 or has a magnitude in [2^-300, 2^300]
 *   time        fraction of the interval, 0 = start, 1 = end
 *   contact     two features that touch, or come within min_separation; features that share a vertex are
 *               never reported, features in contact at the start already are reported at time 0
 *   timings     milliseconds of wall clock
 *   errors      functions that can fail return cscd_status and leave *out untouched unless CSCD_OK;
 *               cscd_context_detail then says in a sentence what is wrong, where, and what to do (a NULL
 *               context, mesh or detector has no place for a sentence)
 *   ownership   the library copies what it is given; a _create has one _destroy; destroy in reverse
 *               order of creation; destroying NULL does nothing
 *   threads     an object, and what was created from it, is used by one thread at a time; separate
 *               contexts are independent
 *   defaults    a NULL options pointer means the matching _defaults(); start from those, never from {0}
 *   complete    a list is whole or the call failed
 *   repeatable  one build, the same inputs: the same contacts in the same order, bit for bit,
 *               for any thread count
 */
#ifndef CSCD_H
#define CSCD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CSCD_VERSION_MAJOR 0
#define CSCD_VERSION_MINOR 1
#define CSCD_VERSION_PATCH 0

#ifndef CSCD_API
#if defined(__GNUC__)
#define CSCD_API __attribute__((visibility("default")))
#else
#define CSCD_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* "0.1.0", static storage. */
CSCD_API const char *cscd_version_string(void);

/* ---- status -------------------------------------------------------------------------------------- */

typedef enum cscd_status {
    CSCD_OK = 0,
    CSCD_OUT_OF_MEMORY,    /* an allocation failed; every object is still valid and unchanged */
    CSCD_INVALID_ARGUMENT, /* NULL, out of range, not finite, or options not made by _defaults() */
    CSCD_INVALID_MESH, /* empty, too large, an index past vertex_count, a triangle that repeats a vertex */
    CSCD_SYSTEM_ERROR  /* the system refused a thread */
} cscd_status;

/* One short English phrase, static storage, never NULL. */
CSCD_API const char *cscd_status_string(cscd_status status);

/* ---- context: allocator and threads ---------------------------------------------------------------- */

typedef struct cscd_context cscd_context;

/* Set both functions or neither. allocate returns NULL on failure; alignment is a power of two;
 * release gets the size that was asked for. Calls are serialised by the context. */
typedef struct cscd_allocator {
    void *(*allocate)(void *user, size_t size, size_t alignment);
    void (*release)(void *user, void *block, size_t size);
    void *user;
} cscd_allocator;

/* Vector instructions. Results are the same on every level, bit for bit. */
typedef enum cscd_simd {
    CSCD_SIMD_AUTO,   /* the best that the processor has */
    CSCD_SIMD_SCALAR, /* what the compiler takes for granted */
    CSCD_SIMD_AVX2,
    CSCD_SIMD_AVX512 /* F, VL, DQ and BW */
} cscd_simd;

/* "auto", "scalar", "avx2", "avx512"; static storage, never NULL. from_name leaves *out untouched when it
 * returns false. */
CSCD_API const char *cscd_simd_name(cscd_simd simd);
CSCD_API bool cscd_simd_from_name(const char *name, cscd_simd *out);

typedef struct cscd_context_options {
    uint32_t struct_size;     /* set by cscd_context_defaults */
    uint32_t thread_count;    /* 0 = one per processor; default 1; at most 256 */
    cscd_simd simd;           /* default AUTO; INVALID_ARGUMENT where the processor has it not */
    cscd_allocator allocator; /* default: aligned_alloc and free */
} cscd_context_options;

CSCD_API cscd_context_options cscd_context_defaults(void);
CSCD_API cscd_status cscd_context_create(const cscd_context_options *options, cscd_context **out);
CSCD_API void cscd_context_destroy(cscd_context *context);

/* The sentence behind the last failure in this context, "" if none. Valid until the next call. */
CSCD_API const char *cscd_context_detail(const cscd_context *context);

CSCD_API uint32_t cscd_context_thread_count(const cscd_context *context);

/* The level in use, never AUTO. */
CSCD_API cscd_simd cscd_context_simd(const cscd_context *context);

/* Bytes now held through this context's allocator. */
CSCD_API size_t cscd_context_bytes(const cscd_context *context);

/* ---- mesh: connectivity that never changes --------------------------------------------------------- */

typedef struct cscd_mesh cscd_mesh;

typedef struct cscd_mesh_desc {
    uint32_t vertex_count;     /* 1 or more, below 2^32 - 1 */
    uint32_t triangle_count;   /* 1 or more, at most (2^32 - 1) / 3 */
    const uint32_t *triangles; /* triangle_count * 3 vertex indices, counter-clockwise from outside */
} cscd_mesh_desc;

/* Vertices without a triangle are allowed and take no part in collisions. Open, non-manifold and
 * inconsistently oriented meshes are allowed: see cscd_component. INVALID_MESH names the triangle. */
CSCD_API cscd_status cscd_mesh_create(cscd_context *context, const cscd_mesh_desc *desc, cscd_mesh **out);
CSCD_API void cscd_mesh_destroy(cscd_mesh *mesh);

CSCD_API uint32_t cscd_mesh_vertex_count(const cscd_mesh *mesh);
CSCD_API uint32_t cscd_mesh_triangle_count(const cscd_mesh *mesh);

/* The triangle's three vertices as given; triangle < triangle_count. */
CSCD_API void cscd_mesh_triangle(const cscd_mesh *mesh, uint32_t triangle, uint32_t vertices[3]);

/* Edges are numbered by (smaller vertex, larger vertex), each once; edge < edge_count. */
CSCD_API uint32_t cscd_mesh_edge_count(const cscd_mesh *mesh);
CSCD_API void cscd_mesh_edge(const cscd_mesh *mesh, uint32_t edge, uint32_t vertices[2]);

/* A component: triangles connected through shared vertices. Numbered by their first triangle. */
typedef struct cscd_component {
    uint32_t vertex_count, edge_count, triangle_count;
    uint32_t open_edges;            /* in one triangle only */
    uint32_t non_manifold_edges;    /* in three triangles or more */
    uint32_t non_manifold_vertices; /* their triangles do not form one fan (bow-tie) */
    uint32_t inconsistent_edges;    /* traversed in the same direction by their two triangles */
    uint32_t first_open_edge;       /* an example of each, UINT32_MAX if there is none */
    uint32_t first_non_manifold_edge;
    uint32_t first_non_manifold_vertex;
    uint32_t first_inconsistent_edge;
    int64_t euler_characteristic; /* V - E + F; a closed oriented component has genus 1 - euler / 2 */
    bool closed_manifold;         /* closed, manifold and consistently oriented */
} cscd_component;

CSCD_API uint32_t cscd_mesh_component_count(const cscd_mesh *mesh);
CSCD_API cscd_component cscd_mesh_component(const cscd_mesh *mesh, uint32_t component);
CSCD_API uint32_t cscd_mesh_triangle_component(const cscd_mesh *mesh, uint32_t triangle);

/* ---- plan: what is found out about a mesh once, at rest --------------------------------------------- */

/* How pairs are left out that need no test. Methods differ in time only: in one mode every method keeps the
 * same guarantee, but for those as published. */
typedef enum cscd_method {
    CSCD_METHOD_AUTO,      /* the plan's, or NONE without a plan */
    CSCD_METHOD_NONE,      /* bounding volumes, no culling */
    CSCD_METHOD_BRUTE,     /* every pair of features: the reference, O(n^2) */
    CSCD_METHOD_SINGLE,    /* one region per component */
    CSCD_METHOD_KMEANS,    /* regions by k-means */
    CSCD_METHOD_CHARGE,    /* regions by charge density */
    CSCD_METHOD_PUBLISHED, /* the thesis's culling as published; loses contacts, for comparison only */
    CSCD_METHOD_ICCD,      /* normal cones and contour tests (Tang et al. 2009), corrected: to compare with */
    CSCD_METHOD_ICCD_PUBLISHED /* the same as published; loses contacts, for comparison only */
} cscd_method;

/* "auto", "none", "brute", "single", "kmeans", "charge", "published", "iccd", "iccd-published"; static
 * storage, never NULL. from_name leaves *out untouched when it returns false. */
CSCD_API const char *cscd_method_name(cscd_method method);
CSCD_API bool cscd_method_from_name(const char *name, cscd_method *out);

typedef struct cscd_plan cscd_plan;

typedef struct cscd_plan_options {
    uint32_t struct_size; /* set by cscd_plan_defaults */
    cscd_method method;   /* CHARGE (default), KMEANS or SINGLE */
    uint32_t k;           /* KMEANS: how many regions, shared out over the components; default 4 */
    uint32_t seed;        /* KMEANS; default 1 */
    double threshold;     /* CHARGE: share of the triangles, by density, that cuts start from; default 0.1 */
    bool published;       /* CHARGE: equalize with 256 bins as published; default false */
    size_t memory_limit;  /* CHARGE: in bytes, for the dense system; 0 (default): what the system has */
} cscd_plan_options;

CSCD_API cscd_plan_options cscd_plan_defaults(void);

/* Cuts the mesh, at rest in positions, into regions. CHARGE solves a dense system: 4 bytes per pair of
 * triangles of a component, and time with the cube. OUT_OF_MEMORY: the sentence gives the amount. */
CSCD_API cscd_status cscd_plan_create(const cscd_mesh *mesh, const double *positions,
                                      const cscd_plan_options *options, cscd_plan **out);
CSCD_API void cscd_plan_destroy(cscd_plan *plan);

/* A region: connected triangles of one component, and the point that they are seen from. */
typedef struct cscd_region {
    uint32_t component, triangle_count;
    double area;          /* of its triangles at rest */
    double visible_share; /* of that area, what faces the detector point, in [0,1] */
    double detector_point[3];
} cscd_region;

/* A plan from what an earlier one held, for the same mesh: triangle_regions per triangle, region_count
 * detector points of 3 doubles, and with CHARGE also charges per triangle and capacitances per component
 * (else both NULL). INVALID_ARGUMENT names what does not fit. */
typedef struct cscd_plan_parts {
    cscd_method method; /* CHARGE, KMEANS or SINGLE */
    uint32_t region_count;
    const uint32_t *triangle_regions;
    const double *detector_points, *charges, *capacitances;
} cscd_plan_parts;

CSCD_API cscd_status cscd_plan_create_from_parts(const cscd_mesh *mesh, const double *positions,
                                                 const cscd_plan_parts *parts, cscd_plan **out);

CSCD_API cscd_method cscd_plan_method(const cscd_plan *plan);
CSCD_API uint32_t cscd_plan_region_count(const cscd_plan *plan);
CSCD_API cscd_region cscd_plan_region(const cscd_plan *plan, uint32_t region);
CSCD_API uint32_t cscd_plan_triangle_region(const cscd_plan *plan, uint32_t triangle);

/* Charge per area at potential 1 of the triangle's component, in Gaussian units; 0 without CHARGE. */
CSCD_API double cscd_plan_triangle_charge(const cscd_plan *plan, uint32_t triangle);

/* Of a component, in units of length (Gaussian); 0 without CHARGE. */
CSCD_API double cscd_plan_capacitance(const cscd_plan *plan, uint32_t component);

typedef struct cscd_preprocess_timings {
    double assembly_ms, solve_ms; /* CHARGE */
    double regions_ms;            /* cuts or k-means, detector points, visible shares */
    double total_ms;
} cscd_preprocess_timings;

CSCD_API cscd_preprocess_timings cscd_plan_timings(const cscd_plan *plan);

/* A hash of the vertex count and the triangles in their order, not of positions: plans fit where it is equal.
 */
CSCD_API uint64_t cscd_mesh_hash(const cscd_mesh *mesh);

/* ---- detector: the runtime ------------------------------------------------------------------------- */

typedef struct cscd_detector cscd_detector;

typedef enum cscd_mode {
    CSCD_MODE_ALL, /* every contact of the interval is reported, whatever the mesh and its start state (but
                    * for published methods, and starts vouched for wrongly) */
    CSCD_MODE_EARLIEST /* of a component whose start is proven embedded, at least one contact with itself at
                        * its earliest time; so none is a proof that there is none. All other contacts as in
                        * ALL, and all with pairs to leave out. After such a contact the whole next start is
                        * checked, so over a recording ALL costs less. See cscd_detector_guarantee */
} cscd_mode;

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

typedef struct cscd_detector_options {
    uint32_t struct_size; /* set by cscd_detector_defaults */
    cscd_method method;   /* default AUTO */
    cscd_mode mode;       /* default ALL */
    cscd_start start;     /* default PROVE */

    /* Pairs to leave out: a contact is not reported, and a self-intersection not listed, when this says
     * true for two triangles a < b of which one contains (or is) the one feature and the other the other.
     * Called on the calling thread, for pairs in contact only. Default NULL: nothing is left out. */
    bool (*ignore)(void *user, uint32_t a, uint32_t b);
    void *ignore_user;

    /* Lengths, each 0 or from 2^-300 to 2^300. min_separation 0, the default: a contact is touching; d: a
     * contact is coming within d. Then every pair that comes within d is reported, and toi is not after the
     * first moment at which its distance is d; at toi it is at most d + tolerance, so no pair that stays
     * farther apart is reported. Only contacts that are marked as bounded may be farther apart at toi.
     * tolerance: 0, the default, stands for 1e-6 d; without min_separation it must be 0. Rounding sets it a
     * limit: for a pair whose positions at both ends extend over a length s along x, y or z, a tolerance
     * below 2^-42 s is taken for 2^-42 s. */
    double min_separation, tolerance;
} cscd_detector_options;

CSCD_API cscd_detector_options cscd_detector_defaults(void);

/* plan: NULL, or one of the mesh; the detector copies what it needs. CHARGE and KMEANS
 * want a plan of that method; the others take any, or none. */
CSCD_API cscd_status cscd_detector_create(const cscd_mesh *mesh, const cscd_plan *plan,
                                          const cscd_detector_options *options, cscd_detector **out);
CSCD_API void cscd_detector_destroy(cscd_detector *detector);

typedef enum cscd_contact_kind { CSCD_CONTACT_VF, CSCD_CONTACT_EE } cscd_contact_kind;

/* "vf", "ee"; static storage, never NULL. */
CSCD_API const char *cscd_contact_kind_name(cscd_contact_kind kind);

/* Where two features meet at time toi, or with min_separation, their nearest points then:
 *   VF  a = vertex, b = triangle (p0,p1,p2): (1-u-v) p0 + u p1 + v p2
 *   EE  a < b edges: (1-u) a0 + u a1 and (1-v) b0 + v b1 */
typedef struct cscd_contact {
    cscd_contact_kind kind;
    uint32_t a, b;
    double toi; /* in [0,1] */
    double u, v;
    double point[3];  /* midpoint of the two points named by u and v at toi */
    double normal[3]; /* unit, against the motion of a relative to b; 0 where the features have none; with
                       * min_separation from b's nearest point to a's, unless the features touch */
    bool bounded;     /* only with min_separation > 0: the bound on work was hit, so toi is safe but may be
                       * early, and the pair may stay farther apart than min_separation */
} cscd_contact;

/* Sorted by (toi, kind, a, b). Owned by the detector, valid until its next call. */
typedef struct cscd_contacts {
    const cscd_contact *items;
    size_t count;
} cscd_contacts;

/* The contacts between start and end, two arrays of positions, that the mode promises. The first call builds
 * the trees from start, so it is slower; later calls allocate only when a buffer has to grow. */
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
    CSCD_REASON_CROSSING,  /* complete: the start crosses or touches itself; culled where it does not */
    CSCD_REASON_UNPROVEN,  /* complete: the start is not known to be embedded; culled where it is */
    CSCD_REASON_CLEAN,     /* complete: the start is embedded, and there is no contact */
    CSCD_REASON_FINISHED,  /* complete: the start is embedded, there are contacts, and mode ALL found all */
    CSCD_REASON_PUBLISHED, /* contacts may be missing: method PUBLISHED or ICCD_PUBLISHED */
    CSCD_REASON_CONTOUR,   /* complete: ICCD needs no embedded start */
    CSCD_REASON_EARLIEST   /* the start is embedded, and mode EARLIEST promises the first contacts only */
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

typedef struct cscd_timings { /* of the last step; the seed of each is a stage of the pipeline */
    double update_ms;         /* BVH update: swept boxes and refit */
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
    uint64_t passes;           /* further traversals, for pairs that contacts have uncovered */
    uint64_t plus, minus;      /* triangles that are S+ and S- */
    uint64_t contours, sealed; /* ICCD: contour tests; patches that passed, in which no pair is looked at */
    uint64_t boxes_tested;     /* pairs of bounding volumes compared during traversal */
    uint64_t pcp;              /* potentially colliding pairs: triangle pairs whose volumes overlap */
    uint64_t feature_pairs;    /* VF and EE pairs assigned to these triangle pairs, none twice */
    uint64_t tests;            /* elementary tests: those of them whose own swept volumes overlap */
    uint64_t by_signs;         /* tests that signs rejected, */
    uint64_t by_roots;         /* those that intervals about the roots decided, */
    uint64_t by_exact;         /* and those that took exact arithmetic: together all tests, or with
                                * min_separation none */
    uint64_t vf, ee;           /* contacts reported */
    uint64_t bounded;          /* of these, cscd_contact.bounded */
} cscd_counters;

CSCD_API cscd_timings cscd_detector_timings(const cscd_detector *detector);
CSCD_API cscd_counters cscd_detector_counters(const cscd_detector *detector);

#ifdef __cplusplus
}
#endif

#endif
