/* Particle sensors: an early warning for scenes of many objects. Particles walk on the surfaces, those of
 * different objects attract each other, and where two come close, their objects may touch (Saenghaengtham,
 * Chulalongkorn University, 2005; numbers in brackets are sections and equations of this thesis). A
 * warning is a hint, and so is its absence: only a detector finds every contact. Part of cscd/cscd.h,
 * which says what holds for every function; docs/theory/sensors.md says when sensors are worth using. Since 1.1. */
#ifndef CSCD_SENSORS_API_H
#define CSCD_SENSORS_API_H

#include <cscd/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The particles on the objects of one mesh, and the cells that they walk in. The objects are those of the
 * scene, or the components of a mesh that is one object. Parts are nearly convex pieces of an object: the
 * regions of a plan, or the components. Cells are connected groups of a part's vertices, found by vector
 * quantization of positions and normals (Linde, Buzo and Gray 1980). Obstacles have parts and cells, too, but
 * are watched neither for each other nor within themselves. */
typedef struct cscd_sensors cscd_sensors;

/* Which particles there are, and what moves them. Later versions may add values. */
typedef enum cscd_sensor_method {
    CSCD_SENSORS_CELLS,  /* one particle in every cell (Saenghaengtham 2005), drawn to the nearest particle
                         * of another object; the thesis adds up the pulls of all */
    CSCD_SENSORS_RANDOM, /* a fixed number of particles on each object, from random vertices, which also
                         * push each other apart (Senin et al. 2003): to compare with. Watches whole
                         * objects only */
    CSCD_SENSORS_MAX_ENUM = 0x7fffffff
} cscd_sensor_method;

/* Options of sensors; start from cscd_sensor_defaults. */
typedef struct cscd_sensor_options {
    uint32_t struct_size; /* set by cscd_sensor_defaults */
    cscd_sensor_method method;

    /* Parts and cells. */
    bool within;          /* parts of one object are watched for each other, too; false by default */
    uint32_t cells;       /* of each part: at most as many as it has vertices, and more than asked for only
                           * if these are not connected; 0, the default: as many as spheres of the size of
                           * the smallest part of another object fit around the sphere of the part's area
                           * (3.1) */
    uint32_t cells_max;   /* the largest number of cells of a part when `cells` is 0; 1 or more, 64 by
                           * default */
    double normal_weight; /* how much unit normals count beside positions, which are scaled to a root mean
                           * square of 1; from 0 to 1e6, 1 by default */
    double epsilon;       /* cells are improved while the distortion falls by more than this share; in
                           * [0,1), 1e-3 by default */

    /* Particles. */
    double collision_distance; /* mu, a length: two particles closer than this make a warning; 0, the
                                * default: as large as the longest edges and the motion ask for */
    double effective_radius;   /* R_eff, a length: how far particles feel each other, at least mu; it is
                                * raised to mu when mu is the default. 0, the default: mu and the two
                                * largest cells */
    uint32_t step_limit;       /* the largest number of rounds in which particles walk at one moment; 256
                                * by default */
    bool exact;                /* warnings are checked by elementary tests; true by default */
    double area_factor;        /* new cells are due when one has more than this many times the area of the
                                * largest at first; 2 by default */
    uint32_t particles;        /* RANDOM: on each object; 5 by default */
    uint32_t seed;             /* RANDOM: of the first vertices; 1 by default */
} cscd_sensor_options;

/* The default options. */
CSCD_API void cscd_sensor_defaults_sized(cscd_sensor_options *out, size_t size);
static inline cscd_sensor_options cscd_sensor_defaults(void) {
    cscd_sensor_options options;
    cscd_sensor_defaults_sized(&options, sizeof options);
    return options;
}

/* Creates sensors, which keep the mesh, and divides it into parts and cells. plan: a plan of the same mesh,
 * which may be destroyed afterwards, or NULL. positions: the mesh at rest. options may be NULL. INVALID_MESH:
 * it has objects that are not of triangles. */
CSCD_API cscd_status cscd_sensors_create(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                         const cscd_view *positions, const cscd_sensor_options *options,
                                         cscd_sensors **out);

/* Frees the sensors and their lists. */
CSCD_API void cscd_sensors_destroy(cscd_sensors *sensors);

/* ---- parts and cells ----------------------------------------------------------------------------------- */

/* A part of an object. */
typedef struct cscd_sensor_part {
    bool convex; /* the part is a whole object, and convex */
    uint32_t object;
    uint32_t first_cell, cell_count; /* cells are numbered part by part; a part has none if no vertex has
                                      * most of its triangles in it */
    double radius;                   /* of the sphere with the part's area, when its cells were made */
} cscd_sensor_part;

/* The number of parts of all objects together. */
CSCD_API uint32_t cscd_sensors_part_count(const cscd_sensors *sensors);

/* A part. */
CSCD_API cscd_sensor_part cscd_sensors_part(const cscd_sensors *sensors, uint32_t part);

/* The number of cells of all parts together. */
CSCD_API uint32_t cscd_sensors_cell_count(const cscd_sensors *sensors);

/* The cell of a vertex; UINT32_MAX for a vertex without a triangle. */
CSCD_API uint32_t cscd_sensors_vertex_cell(const cscd_sensors *sensors, uint32_t vertex);

/* Makes new cells for one part, or for all if part is UINT32_MAX, at the given positions; their number
 * follows from the area that the part has now. Other parts keep their cells, but the numbers of these may
 * change. Particles take the new cells at the next step. */
CSCD_API cscd_status cscd_sensors_renew(cscd_sensors *sensors, const cscd_view *positions, uint32_t part);

/* ---- steps --------------------------------------------------------------------------------------------- */

/* Two parts whose nearest particles are closer than mu at the start or at the end of the interval. */
typedef struct cscd_warning {
    uint32_t part_a, part_b; /* part_a < part_b */
    uint32_t object_a, object_b;
    uint32_t vertex_a, vertex_b; /* where the two particles are */
    double distance;             /* between these vertices, at the moment at which it is smaller */
    double time;                 /* that moment: 0 or 1 */
    bool contact;                /* the exact check has found a contact of the two objects among the
                                  * triangles around the cells whose particles are near. At the border of a
                                  * part the contact may belong to the part beside it */
    double toi;                  /* the earliest time of such a contact; 0 if there is none */
} cscd_warning;

/* Why a part should have new cells. Later versions may add values. */
typedef enum cscd_renewal {
    CSCD_RENEWAL_NONE,
    CSCD_RENEWAL_AREA,    /* a cell has become too large for one particle */
    CSCD_RENEWAL_EDGE,    /* an edge is longer than the mu of the options, so contacts there may be missed.
                          * New cells do not help; there is no other reason */
    CSCD_RENEWAL_CONCAVE, /* the part was convex and is not any more */
    CSCD_RENEWAL_MAX_ENUM = 0x7fffffff
} cscd_renewal;

/* Warnings, sorted by (part_a, part_b). The list belongs to the sensors and lives until their next step. */
typedef struct cscd_warnings {
    const cscd_warning *items;
    size_t count;
    size_t renewals_due; /* parts for which cscd_sensors_renewal is not NONE */
} cscd_warnings;

/* Lets the particles walk, from where the last step has left them, at the start and then at the end of an
 * interval, and lists the parts that may touch. x0, x1: positions at these moments. */
CSCD_API cscd_status cscd_sensors_step(cscd_sensors *sensors, const cscd_view *x0, const cscd_view *x1,
                                       cscd_warnings *out);

/* Whether, and why, a part should have new cells (cscd_sensors_renew). Ask after a step. */
CSCD_API cscd_renewal cscd_sensors_renewal(const cscd_sensors *sensors, uint32_t part);

/* The number of particles. With CELLS there is one for each cell, in the order of the cells; with RANDOM
 * they are numbered object by object. */
CSCD_API uint32_t cscd_sensors_particle_count(const cscd_sensors *sensors);

/* The vertex at which a particle is. */
CSCD_API uint32_t cscd_sensors_particle(const cscd_sensors *sensors, uint32_t particle);

/* Milliseconds of the last step. */
typedef struct cscd_sensor_timings {
    double walk_ms;     /* particles walk */
    double verdict_ms;  /* distances between particles */
    double exact_ms;    /* elementary tests of warnings */
    double renewal_ms;  /* looking for parts that should have new cells */
    double total_ms;    /* the whole step */
    double reserved[4]; /* 0 */
} cscd_sensor_timings;

/* What the last step did, in numbers. */
typedef struct cscd_sensor_counters {
    uint64_t rounds;         /* rounds in which particles walked */
    uint64_t cycles;         /* moments at which the particles came back to an earlier state */
    uint64_t vertices;       /* vertices at which forces were computed */
    uint64_t particle_pairs; /* pairs of particles within R_eff, in all rounds */
    uint64_t tests;          /* elementary tests of the exact check */
    uint64_t reserved[4];    /* 0 */
} cscd_sensor_counters;

/* The timings of the last step. */
CSCD_API cscd_sensor_timings cscd_sensors_timings(const cscd_sensors *sensors);

/* The counters of the last step. */
CSCD_API cscd_sensor_counters cscd_sensors_counters(const cscd_sensors *sensors);

#ifdef __cplusplus
}
#endif

#endif
