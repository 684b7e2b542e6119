/* Particle sensors: an early warning for scenes of many objects. Part of cscd/cscd.h, which says what holds
 * for every function. A warning is a hint, and so is its absence: only a detector finds every contact.
 * Since 1.1. */
#ifndef CSCD_SENSORS_API_H
#define CSCD_SENSORS_API_H

#include <cscd/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the cells that particles walk in ------------------------------------------------------------------ */

/* Objects are those of the scene, or of a mesh that is one object, its components. Parts are the regions of a
 * plan, or the components: nearly convex pieces of one object. Cells are connected groups of a part's
 * vertices, by vector quantization (Linde, Buzo and Gray 1980) of positions and normals; each holds one
 * particle. Obstacles have parts and cells, too, but are not watched for each other, nor within. */
typedef struct cscd_partition cscd_partition;

typedef struct cscd_partition_options {
    uint32_t struct_size; /* set by cscd_partition_defaults */
    uint32_t cells; /* of each part, at most its vertices, and more only where these are not connected; 0, the
                     * default: by how many of the smallest spheres touch one */
    uint32_t cells_max;   /* of a part, where they are counted so; 1 or more, default 64 */
    double normal_weight; /* of unit normals beside positions scaled to a root mean square of 1; 0 to 1e6,
                           * default 1 */
    double epsilon; /* the share by which the distortion has to fall for another iteration; in [0,1), default
                     * 1e-3 */
    bool within;    /* parts of one object are watched for each other, too; default false */
} cscd_partition_options;

CSCD_API cscd_partition_options cscd_partition_defaults(void);

/* plan: NULL, or one of the mesh. positions: at rest. The mesh lives as long as the partition, of the plan
 * nothing is kept. */
CSCD_API cscd_status cscd_partition_create(const cscd_mesh *mesh, const cscd_plan *plan,
                                           const double *positions, const cscd_partition_options *options,
                                           cscd_partition **out);
CSCD_API void cscd_partition_destroy(cscd_partition *partition);

/* Cells anew for one part, or with part UINT32_MAX for all, at these positions and with as many as its area
 * now asks for. Other parts keep their cells, which may be numbered anew. Sensors of the partition take it up
 * in their next step. */
CSCD_API cscd_status cscd_partition_renew(cscd_partition *partition, const double *positions, uint32_t part);

typedef struct cscd_part {
    uint32_t object;
    uint32_t first_cell, cell_count; /* cells are numbered part by part; 0 cells where no vertex has most of
                                      * its triangles here */
    double radius;                   /* of the sphere of its area, when its cells were made */
    bool convex;                     /* the part is a whole object, and convex */
} cscd_part;

CSCD_API uint32_t cscd_partition_object_count(const cscd_partition *partition);
CSCD_API uint32_t cscd_partition_part_count(const cscd_partition *partition);
CSCD_API cscd_part cscd_partition_part(const cscd_partition *partition, uint32_t part);
CSCD_API uint32_t cscd_partition_cell_count(const cscd_partition *partition);
/* UINT32_MAX for a vertex without a triangle. */
CSCD_API uint32_t cscd_partition_vertex_cell(const cscd_partition *partition, uint32_t vertex);
/* Mean squared distance to the cells' means, per dimension (3.10), when a part's cells were made. */
CSCD_API double cscd_partition_distortion(const cscd_partition *partition, uint32_t part);

/* ---- the particles ------------------------------------------------------------------------------------- */

typedef struct cscd_sensors cscd_sensors;

typedef enum cscd_sensor_method {
    CSCD_SENSORS_CELLS, /* a particle in every cell (Saenghaengtham 2006), drawn to the nearest of another
                         * object, where the thesis adds up the pulls of all */
    CSCD_SENSORS_RANDOM /* a fixed number on each object, from random vertices, which also push each other
                         * apart (Senin et al. 2003): to compare with; watches objects, not within them */
} cscd_sensor_method;

typedef struct cscd_sensor_options {
    uint32_t struct_size; /* set by cscd_sensor_defaults */
    cscd_sensor_method method;
    double collision_distance; /* mu, a length; 0, the default: what the longest edges and the motion ask
                                * for */
    double effective_radius;   /* R_eff, a length, at least mu, and raised to mu where that is the default; 0,
                                * the default: mu and the two largest cells */
    uint32_t step_limit;       /* of rounds in which particles walk, per moment; default 256 */
    bool exact;                /* warnings are checked by elementary tests; default true */
    double area_factor; /* renewal is due when a cell's area is beyond so many times the largest at first;
                         * default 2 */
    uint32_t particles; /* RANDOM: on each object; default 5 */
    uint32_t seed;      /* RANDOM; default 1 */
} cscd_sensor_options;

CSCD_API cscd_sensor_options cscd_sensor_defaults(void);

/* The mesh and the partition live as long as the sensors. */
CSCD_API cscd_status cscd_sensors_create(const cscd_mesh *mesh, cscd_partition *partition,
                                         const cscd_sensor_options *options, cscd_sensors **out);
CSCD_API void cscd_sensors_destroy(cscd_sensors *sensors);

/* The nearest particles of two parts that are watched, nearer than mu at the start or at the end. */
typedef struct cscd_warning {
    uint32_t part_a, part_b; /* part_a < part_b */
    uint32_t object_a, object_b;
    uint32_t vertex_a, vertex_b; /* where the two particles are */
    double distance;             /* between them, the smaller of both moments, */
    double time;                 /* and which moment: 0 or 1 */
    bool contact; /* the exact check has found one of these objects, among the triangles about the cells of
                   * both parts whose particles are near; at the parts' borders it may be another part's */
    double toi;   /* its earliest; 0 without */
} cscd_warning;

/* Why cells of a part should be made anew. */
typedef enum cscd_renewal {
    CSCD_RENEWAL_NONE,
    CSCD_RENEWAL_AREA,   /* a cell has become too large for one particle */
    CSCD_RENEWAL_EDGE,   /* an edge is longer than the mu of the options, which new cells do not change, so
                          * contacts there may be missed; no other reason holds */
    CSCD_RENEWAL_CONCAVE /* the part has turned concave */
} cscd_renewal;

/* Sorted by (part_a, part_b). Owned by the sensors, valid until their next step. */
typedef struct cscd_warnings {
    const cscd_warning *items;
    size_t count;
    uint32_t renewals_due; /* parts for which cscd_sensors_renewal is not NONE */
} cscd_warnings;

/* One interval: particles walk where they were left, at the start and then at the end. */
CSCD_API cscd_status cscd_sensors_step(cscd_sensors *sensors, const double *start, const double *end,
                                       cscd_warnings *out);

/* After a step; part < the partition's count. */
CSCD_API cscd_renewal cscd_sensors_renewal(const cscd_sensors *sensors, uint32_t part);

/* Certified: two different parts do not come to touch in the interval of the last step that has not failed.
 * False means nothing, and is all there is before a step and after a renewal. */
CSCD_API bool cscd_sensors_apart(const cscd_sensors *sensors, uint32_t part_a, uint32_t part_b);

/* Particles: one per cell, in their order, or those of objects in theirs; and the vertex of each. */
CSCD_API uint32_t cscd_sensors_particle_count(const cscd_sensors *sensors);
CSCD_API uint32_t cscd_sensors_particle(const cscd_sensors *sensors, uint32_t particle);

typedef struct cscd_sensor_timings { /* of the last step */
    double walk_ms, verdict_ms, exact_ms, renewal_ms, total_ms;
} cscd_sensor_timings;

typedef struct cscd_sensor_counters { /* of the last step */
    uint64_t rounds;                  /* in which particles walked */
    uint64_t cycles;                  /* moments at which they came back to an earlier state */
    uint64_t vertices;                /* at which forces were summed */
    uint64_t particle_pairs;          /* within R_eff, over all rounds */
    uint64_t tests;                   /* elementary tests of the exact check */
} cscd_sensor_counters;

CSCD_API cscd_sensor_timings cscd_sensors_timings(const cscd_sensors *sensors);
CSCD_API cscd_sensor_counters cscd_sensors_counters(const cscd_sensors *sensors);

#ifdef __cplusplus
}
#endif

#endif
