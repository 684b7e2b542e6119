/* A detector finds the contacts of one mesh, interval by interval. It is created once for a mesh, keeps
 * its bounding volume trees between intervals, and is told the positions at the start and at the end of
 * each. Part of cscd/cscd.h, which says what holds for every function.
 *
 * A step looks for pairs of triangles that may touch, leaves out by orientation those that certainly do
 * not (culling), and decides each remaining pair of features by an elementary test, whose verdict is that
 * of exact arithmetic on the given doubles. Culling needs a start that is embedded: the mesh neither
 * intersects nor touches itself there. docs/solver/guarantees.md has all promises; docs/theory/culling.md (Yeh
 * 2012) and docs/theory/elementary.md say why they hold. */
#ifndef CSCD_DETECTOR_API_H
#define CSCD_DETECTOR_API_H

#include <cscd/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Finds the contacts of one mesh. */
typedef struct cscd_detector cscd_detector;

/* What a step promises. Later versions may add values. In both modes an empty list proves that there is no contact. Neither promise holds
 * for the published methods, nor after a start that was vouched for and is not embedded. */
typedef enum cscd_mode {
    CSCD_MODE_ALL,      /* every contact of the interval, on any mesh, whatever its state at the start */
    CSCD_MODE_EARLIEST, /* of the contacts of a component with itself those whose toi is the least, or at most
                        * 1e-9 more. All other contacts, and all contacts when there are pairs to leave
                        * out, as in ALL. After such a contact the whole next start is checked, so that
                        * over a recording ALL costs less. See cscd_detector_guarantee */
    CSCD_MODE_MAX_ENUM = 0x7fffffff
} cscd_mode;

/* The names are "all" and "earliest"; static storage, never NULL. cscd_mode_from_name returns false for
 * any other text and then leaves *out untouched. */
CSCD_API const char *cscd_mode_name(cscd_mode mode);
CSCD_API bool cscd_mode_from_name(const char *name, cscd_mode *out);

/* How a step knows which triangles are clean at its start, because only clean triangles may be culled. A
 * triangle is clean when it neither intersects nor touches its component, neighbours at common corners
 * aside, and lies in the main such part of it; a component is embedded when all of its triangles are
 * clean. A triangle that is clean at the start and takes part in no contact is clean at the end, so most
 * of a start is known from the step before. */
typedef enum cscd_start {
    CSCD_START_PROVE,   /* the step checks the triangles that are not known to be clean */
    CSCD_START_VOUCHED, /* you say that every start is embedded; if that is wrong, contacts may be lost */
    CSCD_START_UNKNOWN, /* only what a cscd_detector_check of the start has shown to be clean is culled */
    CSCD_START_MAX_ENUM = 0x7fffffff
} cscd_start;

/* The bounding volumes of the trees. They differ in time only; boxes are mostly faster (docs/solver/tuning.md). Later
 * versions may add values. */
typedef enum cscd_volume {
    CSCD_VOLUME_BOX,    /* three axes */
    CSCD_VOLUME_KDOP14, /* seven axes, so 14 planes */
    CSCD_VOLUME_MAX_ENUM = 0x7fffffff
} cscd_volume;

/* The names are "box" and "kdop14"; static storage, never NULL. cscd_volume_from_name returns false for
 * any other text and then leaves *out untouched. */
CSCD_API const char *cscd_volume_name(cscd_volume volume);
CSCD_API bool cscd_volume_from_name(const char *name, cscd_volume *out);

/* What a step makes of it that vertices have hardly moved since the one before. Contacts are the same either way, counters
 * are not, nor are the components that AUTO culls. Later versions may add values. */
typedef enum cscd_coherence {
    CSCD_COHERENCE_AUTO, /* in a closed mesh where nothing touches and little moves, the pairs that may come together
                          * are listed once, and tested alone for as long as vertices stay near (docs/solver/tuning.md) */
    CSCD_COHERENCE_OFF, /* every step looks at the whole mesh */
    CSCD_COHERENCE_MAX_ENUM = 0x7fffffff
} cscd_coherence;

/* A vertex and a face, or two edges; for the static check two triangles; with points and wires, and in lists of
 * proximities without repetitions, also two vertices, and an edge and a vertex; a vertex and a half-space. Later
 * versions may add values. */
typedef enum cscd_contact_kind {
    CSCD_CONTACT_VF,
    CSCD_CONTACT_EE,
    CSCD_CONTACT_TT,
    CSCD_CONTACT_VV,
    CSCD_CONTACT_EV,
    CSCD_CONTACT_VH,
    CSCD_CONTACT_KIND_MAX_ENUM = 0x7fffffff
} cscd_contact_kind;

/* The names are "vf", "ee", "tt", "vv", "ev" and "vh"; static storage, never NULL. */
CSCD_API const char *cscd_contact_kind_name(cscd_contact_kind kind);

/* What one object has to do with the others; start from cscd_object_rule_default. It never grows. */
typedef struct cscd_object_rule {
    /* Two objects are looked at when the category of each has a bit in common with the mask of the other. An
     * object that is not looked at with another one touches it unseen: none of their pairs is a contact, an
     * intersection or a proximity. */
    uint64_t category, mask;

    /* A length, 0 for none. Two objects have to stay apart by half of both thicknesses together, an object
     * from itself by its thickness, as if that were their min_separation. Proximity and the static check know
     * no thickness. With a thickness_matrix this is 0, and thickness_class says the row. */
    double thickness;
    uint32_t thickness_class;

    bool self; /* it is looked at with itself, whatever its mask; obstacles never are. Without, it is
                          * neither proven nor culled */
    bool obstacle_pairs; /* an obstacle is looked at with other obstacles that say this, too, if their masks
                          * agree; other objects do not care */
    uint16_t reserved;   /* 0 */
} cscd_object_rule;

/* The rule that changes nothing: category 1, all bits in the mask, no thickness, looked at with itself. */
static inline cscd_object_rule cscd_object_rule_default(void) {
    cscd_object_rule rule = {1, UINT64_MAX, 0.0, 0, true, false, 0};
    return rule;
}

/* Options of a detector; start from cscd_detector_defaults. Arrays are copied; NULL, the default, means
 * none. */
typedef struct cscd_detector_options {
    uint32_t struct_size; /* set by cscd_detector_defaults */
    cscd_method method;   /* AUTO by default */
    cscd_mode mode;       /* ALL by default */
    cscd_start start;     /* PROVE by default */
    cscd_volume volume;   /* BOX by default */

    /* Leaves out pairs: a contact or proximity is not reported when ignore returns true for its kind and
     * features a and b, nor an intersection when it returns true for the kind TT and its triangles a < b. It is
     * called on the calling thread, only for pairs that were found. NULL by default. */
    bool (*ignore)(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b);
    void *ignore_user;

    /* Leaves out pairs of triangles, ignored_count of them in any order: intersections of the two, and contacts
     * and proximities of features of which one is in (or is) the one triangle, the other in the other. */
    const uint32_t *ignored;
    size_t ignored_count;

    /* Seams: seam_count pairs of vertices that count as one vertex, as where panels of cloth are sewn
     * together or a texture splits a surface. Features that have such vertices are neighbours, and so
     * never reported. In a chain of pairs all vertices count as one. A vertex has no seam with itself:
     * INVALID_ARGUMENT. */
    const uint32_t *seams;
    size_t seam_count;

    /* A length, and a share of it. With min_separation 0, the default, a contact is a touch. With min_separation
     * d a contact is coming within d: every pair that comes within d is reported, toi is not after the first
     * moment at which its distance is d, and at toi the distance is at most (1 + tolerance) d. So no pair that
     * stays farther apart is reported, except contacts marked as bounded. tolerance is at most 1; 0, the
     * default, stands for 1e-6. It holds for thicknesses of objects, too, and in cscd_detector_max_step and
     * line searches for each pair's floor instead of d. What it allows is never below 2^-42 of the pair's extent
     * along x, y or z, motion included: that is the limit that rounding sets. */
    double min_separation, tolerance;

    /* cscd_detector_max_step goes at most this share of the way to its limiting contact; in (0,1), 0.8 by default. */
    double step_factor;

    /* Who is looked at with whom: one rule for each object of the mesh, or none. */
    const cscd_object_rule *rules;

    /* The distances of objects by their thickness_class: thickness_class_count rows of as many lengths, at most
     * 256, symmetric; in place of thicknesses. With a matrix or a thickness min_separation is 0. Pairs at distance
     * 0 must not touch, as without. */
    const double *thickness_matrix;
    uint32_t rule_count, thickness_class_count;

    /* A pair that starts nearer than min_separation d has a floor in cscd_detector_max_step and line searches, below
     * which it never comes: one of d, s d, s^2 d, ... with s = floor_ratio. In (0,0.999], 0.9 by default. */
    double floor_ratio;

    /* A length: how far apart the two vertices of a seam may be in the first positions that the detector is
     * given; later they may part. A call with positions in which they are farther apart returns
     * INVALID_ARGUMENT and names the pair, since mostly its indices are wrong. 0, the default, stands for
     * the longest edge at the two vertices; INFINITY allows any distance, as for panels that are to be
     * pulled together. */
    double seam_reach;

    /* The most items that a list of contacts, intersections or proximities may have; 0, the default: any number. The
     * call whose list would be longer fails with LIST_TOO_LONG and changes nothing, as one that is cancelled; *out
     * then has no items, but the number that there would be, counted without keeping them. So memory is bounded by
     * this number; in mode EARLIEST, where later contacts are dropped instead, only as far as contacts are not
     * between components or at the same time. Of lists in the form CSCD_NEAR_UNIQUE it bounds the pairs that the items stand for, and of
     * displacement bounds and truncation the near pairs. Functions without a list, as cscd_detector_max_step,
     * know no cap. `ignore` is asked for each pair that is found, also where the list becomes too long. */
    size_t longest_list;

    cscd_coherence coherence; /* AUTO by default */
    uint32_t reserved;        /* 0 */
    uint64_t
        ours; /* the published methods: what is done as CHARGE does it; see cscd/research.h. 0 by default */
} cscd_detector_options;

/* The default options. */
CSCD_API void cscd_detector_defaults_sized(cscd_detector_options *out, size_t size);
static inline cscd_detector_options cscd_detector_defaults(void) {
    cscd_detector_options options;
    cscd_detector_defaults_sized(&options, sizeof options);
    return options;
}

/* Creates a detector, which allocates from `context` and fails into it; the mesh may be of another context.
 * The detector keeps the mesh. plan: a plan of the same mesh, of which the detector copies what it needs,
 * or NULL; the methods CHARGE and KMEANS need one of their kind, the others take any or none.
 * options may be NULL. */
CSCD_API cscd_status cscd_detector_create(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                          const cscd_detector_options *options, cscd_detector **out);

/* Gives the detector back, and with it its lists. Its line searches keep it, and go on working. */
CSCD_API void cscd_detector_destroy(cscd_detector *detector);

/* The mesh that the detector was created for. */
CSCD_API const cscd_mesh *cscd_detector_mesh(const cscd_detector *detector);

/* A contact: two features, when they touch, and where. u and v name the points that touch at time toi or,
 * with min_separation, the nearest points then:
 *   VF  a is a vertex, b a triangle (p0, p1, p2); the point on it is (1-u-v) p0 + u p1 + v p2
 *   EE  a < b are edges; the points are (1-u) a0 + u a1 and (1-v) b0 + v b1
 *   VV  a < b are points
 *   EV  a is a wire, b a point; the point on the wire is (1-u) a0 + u a1
 *   VH  a is a vertex, b a half-space, by its object; its point is the one below the vertex. At time 0 the vertex
 *       may be anywhere behind the plane */
typedef struct cscd_contact {
    cscd_contact_kind kind;
    uint32_t a, b;        /* two features, in the numbering of the mesh */
    bool bounded;         /* only with min_separation: the limit of work was reached, so toi is safe but may
                           * be early, and the pair may stay farther apart than min_separation */
    uint32_t vertices[4]; /* VF: the vertex, then the triangle's three; EE: the two of a, then those of b;
                           * other kinds: see cscd_stencil */
    double toi;           /* time of impact in [0,1], never after the true time; without min_separation it is
                       * before it by less than 1e-9 */
    double u, v;          /* in [0,1], up to rounding */
    double point[3];      /* the middle between the two points at toi */
    double normal[3];     /* unit vector across the features at toi, against the motion of a relative to b; 0
                       * where there is none, as between parallel edges. With min_separation from b's
                       * nearest point to a's, unless the features touch */
} cscd_contact;

/* Contacts, sorted by (toi, kind, a, b). The list belongs to the detector and lives until the next call of
 * it or of one of its line searches. */
typedef struct cscd_contacts {
    const cscd_contact *items;
    size_t count;
    size_t waiting; /* so many pairs of features wait, and are left out: see cscd_detector_set_seams */
    uint32_t collapsed, reserved; /* so many components are, at an end: see cscd_detector_collapsed */
} cscd_contacts;

/* Finds the contacts from positions x0 to positions x1, as the mode promises. The first call
 * builds the trees, so it is slower. Later calls allocate memory only when a list has to grow or has 2^18
 * contacts or more, when a long deformation has made the trees so loose that they are built again, or in the
 * first interval without culling. CANCELLED: see cscd_progress. */
CSCD_API cscd_status cscd_detector_step(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                        cscd_contacts *out);

/* Two triangles a < b that intersect or touch at one moment: a vertex or an edge of one and the face of
 * the other, or edges of both, have a point in common. Features that share a vertex do not count, but
 * triangles that share one are tested, too. */
typedef struct cscd_intersection {
    uint32_t a, b;
} cscd_intersection;

/* The state of the mesh at one moment. The list is sorted by (a, b); it belongs to the detector and lives
 * until its next call. */
typedef struct cscd_intersections {
    const cscd_intersection *items;
    size_t count; /* 0: the mesh neither intersects nor touches itself, pairs to leave out aside */
    uint32_t zero_area_triangles; /* how many triangles have all corners on one line */
    uint32_t first_zero_area;     /* the first of them; UINT32_MAX if there is none */
    size_t waiting; /* so many pairs of triangles wait, and are left out: see cscd_detector_set_seams */
    uint32_t collapsed, reserved; /* so many components are: see cscd_detector_collapsed */
} cscd_intersections;

/* The static check: lists exactly the triangle pairs that intersect or touch at the given positions
 * (docs/theory/static-check.md); of wires, points and half-spaces it says nothing. A step that starts there need not check
 * them again. CANCELLED: see cscd_progress. Of the timings only check_ms changes; counters stay those of the last step. */
CSCD_API cscd_status cscd_detector_check(cscd_detector *detector, const cscd_view *positions,
                                         cscd_intersections *out);

/* Why the contacts of a component with itself are complete, or why some may be missing. Later versions
 * may add values. */
typedef enum cscd_reason {
    CSCD_REASON_METHOD,    /* complete: the method does not cull, or does not with min_separation or a
                            * thickness of its own */
    CSCD_REASON_SURFACE,   /* complete: open, non-manifold or inconsistently oriented, so it was not culled */
    CSCD_REASON_CROSSING,  /* complete: the start intersects or touches itself; only the rest was culled,
                            * if any */
    CSCD_REASON_UNPROVEN,  /* complete: the start is not known to be embedded; only what is known was
                            * culled */
    CSCD_REASON_CLEAN,     /* complete: the start is embedded, and there is no contact */
    CSCD_REASON_FINISHED,  /* complete: the start is embedded, there are contacts, and mode ALL found all */
    CSCD_REASON_PUBLISHED, /* contacts may be missing: the method is PUBLISHED or ICCD_PUBLISHED */
    CSCD_REASON_CONTOUR,   /* complete: method ICCD or CONES, which need no embedded start */
    CSCD_REASON_EARLIEST,  /* later contacts are left out, because the mode is EARLIEST */
    CSCD_REASON_OBSTACLE,  /* an obstacle: its contacts with itself are not looked for */
    CSCD_REASON_MASK,      /* its object's rule has self = false: contacts with itself are not looked for */
    CSCD_REASON_COLLAPSED, /* it is collapsed at an end: contacts with itself are not looked for */
    CSCD_REASON_MAX_ENUM = 0x7fffffff
} cscd_reason;

/* The reason as a part of a sentence, such as "open, non-manifold or inconsistently oriented"; static
 * storage, never NULL. */
CSCD_API const char *cscd_reason_text(cscd_reason reason);

/* What the last step promises for the contacts of a component with itself. */
typedef struct cscd_guarantee {
    bool complete;       /* every contact of the component with itself was reported */
    bool start_embedded; /* the component was embedded at the start: by proof, or because the caller
                          * vouched for it */
    cscd_reason reason;
} cscd_guarantee;

/* The guarantee of the last step for a component; without meaning before the first step. Contacts between
 * two components are complete in every step. */
CSCD_API cscd_guarantee cscd_detector_guarantee(const cscd_detector *detector, uint32_t component);

/* How a triangle faced the detector point of its region during the whole last step: 1, away from it (S+);
 * -1, towards it (S-); 0, neither, or the triangle was not clean at the start, or the step was answered from a
 * list (cscd_coherence) and the triangle may not stay so. Without meaning after a step that failed. */
CSCD_API int cscd_detector_orientation(const cscd_detector *detector, uint32_t triangle);

/* The number of regions that the detector culls by: those of its plan, or else the components; 0 if it
 * does not cull by orientation, because of its method or with min_separation. */
CSCD_API uint32_t cscd_detector_region_count(const cscd_detector *detector);

/* Writes where the detector point of a region was at the start and at the end of the last step, up to
 * rounding. In between it moved in a straight line. Without meaning before the first step and after a step
 * that failed. */
CSCD_API void cscd_detector_region_point(const cscd_detector *detector, uint32_t region, double p0[3],
                                         double p1[3]);

/* Milliseconds per pipeline stage of the last step. */
typedef struct cscd_timings {
    double update_ms;      /* moving the trees to the new positions */
    double orientation_ms; /* moving the detector points, and finding the triangles that face them */
    double contour_ms;     /* ICCD and CONES only: normal cones and contour tests */
    double traversal_ms;   /* finding the triangle pairs whose volumes overlap */
    double contact_ms;     /* from triangle pairs to contacts: representatives, elementary tests, sorting */
    double total_ms;       /* the whole step, checks of the input included */
    double proof_ms;       /* the static check of the start within the step, a part of the total */
    double check_ms;       /* the last cscd_detector_check, not a part of the total */
    double reserved[4];    /* 0 */
} cscd_timings;

/* What the last step did, in numbers: exact, and the same for any number of threads. */
typedef struct cscd_counters {
    uint64_t static_checks;    /* static checks of the start, or of a part of it, within the step */
    uint64_t clean;            /* triangles that were clean at the start; only these are culled */
    uint64_t rebuilds;         /* 1 if the trees had become loose and were built again, else 0 */
    uint64_t passes;           /* further traversals, for pairs that contacts have uncovered */
    uint64_t plus, minus;      /* triangles that are S+, and S-: see cscd_detector_orientation */
    uint64_t contours, sealed; /* ICCD, CONES: contour tests; and patches that passed theirs, whose pairs were
                                * left out */
    uint64_t boxes_tested;     /* pairs of bounding volumes that the traversal compared */
    uint64_t pcp;              /* potentially colliding pairs: triangle pairs whose volumes overlap */
    uint64_t adjacent;         /* those of them that share a vertex and were left out, because other pairs
                                * test their features (not so in the published methods) */
    uint64_t feature_pairs;    /* pairs of features whose own volumes overlap, each counted once; with
                                * BRUTE all */
    uint64_t tests;            /* elementary tests, one for each of these feature pairs */
    uint64_t by_signs;         /* tests that orientation signs have rejected */
    uint64_t by_roots;         /* tests that intervals around the roots of the coplanarity cubic have
                                * decided */
    uint64_t by_exact;         /* tests that took exact arithmetic, also those of features at rest; the three
                                * add up to all tests, and with min_separation they are 0 */
    uint64_t vf, ee;           /* contacts reported */
    uint64_t bounded;          /* contacts that are marked as bounded */
    uint64_t loose;            /* contacts of other kinds reported: VV, EV and VH */
    uint64_t coherent;         /* 1: the interval was answered from a list of pairs (cscd_coherence). Then
                                * boxes_tested and pcp are 0, and S+ and S- are those that last as long as
                                * the list; else 0 */
    uint64_t reserved[6];      /* 0 */
} cscd_counters;

/* The timings of the last step, and of the last check. */
CSCD_API cscd_timings cscd_detector_timings(const cscd_detector *detector);

/* The counters of the last step. */
CSCD_API cscd_counters cscd_detector_counters(const cscd_detector *detector);

#ifdef __cplusplus
}
#endif

#endif
