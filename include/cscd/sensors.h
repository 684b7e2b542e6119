/* Particle sensors: an early warning for scenes of many objects. Particles walk on the surfaces, and where
 * two of different objects come close, the objects may touch (Saenghaengtham, Chulalongkorn University,
 * 2005). A warning is a hint, and so is its absence: only a detector finds every contact.
 * docs/theory/sensors.md explains the terms. cscd/cscd.h says what holds for every function; it does not
 * include this header. */
#ifndef CSCD_SENSORS_API_H
#define CSCD_SENSORS_API_H

#include <cscd/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The particles of one mesh, and their cells. Objects are those of the scene, or the components of a mesh
 * that is one object. Parts are the regions of a plan, or the components; cells are connected groups of their
 * vertices. Obstacles are watched neither for each other nor within themselves. */
typedef struct cscd_sensors cscd_sensors;

/* The kind of particles. */
typedef enum cscd_sensor_method {
    /* One in every cell, drawn to the nearest particle of another object. */
    CSCD_SENSORS_CELLS,
    /* A fixed number on each object, first at random vertices; they also push each other apart (Senin et al.
     * 2003). To compare with; whole objects only. */
    CSCD_SENSORS_RANDOM,
    CSCD_SENSORS_MAX_ENUM = 0x7fffffff
} cscd_sensor_method;

/* Options of sensors; start from cscd_sensor_defaults. */
typedef struct cscd_sensor_options {
    uint32_t struct_size; /* set by cscd_sensor_defaults */
    cscd_sensor_method method;

    /* Parts and cells. */
    bool within; /* watches parts of one object for each other, too; false by default */
    /* The number in each part: at most that of its vertices, and more than asked for only where these are not
     * connected. 0, the default: by the size of the smallest part of another object. */
    uint32_t cells;
    uint32_t cells_max;   /* the most cells of a part when `cells` is 0; 1 or more, 64 by default */
    double normal_weight; /* of normals against positions (root mean square 1); 0 to 1e6, 1 by default */
    double epsilon; /* cells improve while distortion falls by a larger share; in [0,1), 1e-3 by default */

    /* Particles. */
    /* mu, a length: closer particles make a warning. 0, the default: it follows from the longest edges and
     * the motion. */
    double collision_distance;
    /* R_eff, a length: how far particles feel each other; at least mu, and raised to a default mu. 0, the
     * default: mu and the two largest cells. */
    double effective_radius;
    uint32_t step_limit; /* the most rounds of walks at one moment; 256 by default */
    bool exact;          /* warnings are checked by elementary tests; true by default */
    double area_factor; /* new cells are due beyond this many times the largest area at first; 2 by default */
    uint32_t particles; /* RANDOM: on each object; 5 by default */
    uint32_t seed;      /* RANDOM: of the first vertices; 1 by default */
} cscd_sensor_options;

/* Returns the default options. */
CSCD_API void cscd_sensor_defaults_sized(cscd_sensor_options *out, size_t size);
static inline cscd_sensor_options cscd_sensor_defaults(void) {
    cscd_sensor_options options;
    cscd_sensor_defaults_sized(&options, sizeof options);
    return options;
}

/* Creates sensors. They keep the mesh, but not the plan, which is of the same mesh, or NULL. positions: at
 * rest. options may be NULL. INVALID_MESH: objects are not of triangles. */
CSCD_API cscd_status cscd_sensors_create(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                         const cscd_view *positions, const cscd_sensor_options *options,
                                         cscd_sensors **out);

/* Frees the sensors and their lists. */
CSCD_API void cscd_sensors_destroy(cscd_sensors *sensors);

/* The sizes of all parts. */
typedef struct cscd_sensor_info {
    uint32_t part_count; /* of all objects together */
    uint32_t cell_count; /* of all parts together */
    /* With CELLS there is one particle for each cell, in their order; with RANDOM they are numbered object by
     * object. */
    uint32_t particle_count;
    uint32_t reserved; /* 0 */
} cscd_sensor_info;

/* Tells how many parts, cells and particles there are. */
CSCD_API cscd_sensor_info cscd_sensors_describe(const cscd_sensors *sensors);
static inline uint32_t cscd_sensors_part_count(const cscd_sensors *sensors) {
    return cscd_sensors_describe(sensors).part_count;
}
static inline uint32_t cscd_sensors_cell_count(const cscd_sensors *sensors) {
    return cscd_sensors_describe(sensors).cell_count;
}
static inline uint32_t cscd_sensors_particle_count(const cscd_sensors *sensors) {
    return cscd_sensors_describe(sensors).particle_count;
}

/* ---- parts and cells ----------------------------------------------------------------------------------- */

/* A part of an object. */
typedef struct cscd_sensor_part {
    bool convex; /* the part is a whole object, and convex */
    uint32_t object;
    /* Cells are numbered part by part. A part has none if no vertex has most of its triangles in it. */
    uint32_t first_cell, cell_count;
    double radius; /* of the sphere with the part's area, when its cells were made */
} cscd_sensor_part;

/* Returns a part by its number. */
CSCD_API cscd_sensor_part cscd_sensors_part(const cscd_sensors *sensors, uint32_t part);

/* Returns the cell of a vertex; UINT32_MAX: the vertex has no triangle. */
CSCD_API uint32_t cscd_sensors_vertex_cell(const cscd_sensors *sensors, uint32_t vertex);

/* Makes new cells for one part, or for all if part is UINT32_MAX, as many as its area at these positions asks
 * for. Cells of other parts may get new numbers. Particles take the new cells at the next step. */
CSCD_API cscd_status cscd_sensors_renew(cscd_sensors *sensors, const cscd_view *positions, uint32_t part);

/* ---- steps --------------------------------------------------------------------------------------------- */

/* Two parts whose nearest particles are closer than mu at the start or at the end of the interval. */
typedef struct cscd_warning {
    uint32_t part_a, part_b; /* part_a < part_b */
    uint32_t object_a, object_b;
    uint32_t vertex_a, vertex_b; /* the places of the two particles */
    double distance;             /* between these vertices, at the moment at which it is smaller */
    double time;                 /* that moment: 0 or 1 */
    /* The exact check found a contact of the two objects around the cells of near particles. At the border of
     * a part it may be of the part beside it. */
    bool contact;
    double toi; /* the earliest time of such a contact; 0 if there is none */
} cscd_warning;

/* The reason for new cells of a part. */
typedef enum cscd_renewal {
    CSCD_RENEWAL_NONE,
    CSCD_RENEWAL_AREA, /* a cell has become too large for one particle */
    /* An edge is longer than the mu of the options, so contacts may be missed. New cells do not help; no
     * other reason holds. */
    CSCD_RENEWAL_EDGE,
    CSCD_RENEWAL_CONCAVE, /* the part was convex and is not any more */
    CSCD_RENEWAL_MAX_ENUM = 0x7fffffff
} cscd_renewal;

/* Warnings, sorted by (part_a, part_b). The list belongs to the sensors and lives until their next step. */
typedef struct cscd_warnings {
    const cscd_warning *items;
    size_t count;
    size_t renewals_due; /* the number of parts whose cscd_sensors_renewal is not NONE */
} cscd_warnings;

/* Lets the particles walk on from where they are, at the positions x0 and then at x1, and lists the parts
 * that may touch. */
CSCD_API cscd_status cscd_sensors_step(cscd_sensors *sensors, const cscd_view *x0, const cscd_view *x1,
                                       cscd_warnings *out);

/* Returns why a part should have new cells (cscd_sensors_renew), as of the last step. */
CSCD_API cscd_renewal cscd_sensors_renewal(const cscd_sensors *sensors, uint32_t part);

/* Returns the vertex at which a particle is. */
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

/* Counts of the last step. */
typedef struct cscd_sensor_counters {
    uint64_t rounds;         /* of walks */
    uint64_t cycles;         /* moments at which an earlier state came back */
    uint64_t vertices;       /* vertices at which forces were computed */
    uint64_t particle_pairs; /* pairs of particles within R_eff, in all rounds */
    uint64_t tests;          /* elementary tests of the exact check */
    uint64_t reserved[4];    /* 0 */
} cscd_sensor_counters;

/* Returns the timings of the last step. */
CSCD_API cscd_sensor_timings cscd_sensors_timings(const cscd_sensors *sensors);

/* Returns the counters of the last step. */
CSCD_API cscd_sensor_counters cscd_sensors_counters(const cscd_sensors *sensors);

#ifdef __cplusplus
}
#endif

#endif
