/* Which pairs are looked at: by the rules of their objects, and by which vertices are active. */
#pragma once

#include "runtime/ccd/min_separation.h"
#include "runtime/narrow_phase/exclusions.h"
#include "src/mesh/mesh_change.h"

/* ---- rules --------------------------------------------------------------------------------------------- */

/* Which objects are looked at with which, and how far apart they have to stay: the rules of the caller, as they were given.
 * The matrix has class_count rows; NULL: distances are sums of halves of thicknesses. */
typedef struct given_rules {
    const cscd_object_rule *objects; /* NULL: the default rule for each */
    uint32_t count;                  /* 0, or the number of objects */
    const double *matrix;
    uint32_t class_count;
} given_rules;

enum { THICKNESS_CLASSES_MAX = 256 };

typedef struct pair_rules {
    uint32_t object_count;
    object_set *sets;            /* one for each object */
    cscd_object_rule *given;     /* as the caller has said */
    uint32_t *component_objects; /* the object that each component lies in */
    double *reaches;             /* per object: the greatest distance of its pairs, or more */

    /* The distance of two objects is that of the matrix for their classes, or the sum of their halves. */
    double *halves;                 /* per object; NULL with a matrix */
    uint32_t *classes, class_count; /* per object its class; NULL and 0 without a matrix */
    double *matrix;

    double greatest,
        greatest_to_itself; /* distances, the latter of objects that are looked at with themselves */
} pair_rules;

/* Copies and checks what the caller says. INVALID_ARGUMENT names the object or the place in the matrix. On failure *out
 * holds nothing. */
cscd_status pair_rules_create(const cscd_mesh *mesh, const given_rules *given, pair_rules *out);

/* Copies all of it; mesh: the same one in the context of the copy. On failure *out is untouched. */
cscd_status pair_rules_copy(const pair_rules *r, const cscd_mesh *mesh, pair_rules *out);
void pair_rules_free(const cscd_mesh *mesh, pair_rules *rules);

/* A copy of the sets alone; of default rules, if there are none. NULL: no memory. */
object_set *pair_rules_copy_sets(const cscd_mesh *mesh, const pair_rules *rules);

/* Is object a looked at with object b? They may be one object. */
static inline bool pair_rules_look_at(const pair_rules *rules, uint32_t a, uint32_t b) {
    return object_sets_may_meet(&rules->sets[a], &rules->sets[b]);
}

/* How far these objects have to stay apart; 0: they must not touch. */
static inline double pair_rules_distance(const pair_rules *rules, uint32_t a, uint32_t b) {
    if (rules->matrix == NULL) return rules->halves[a] + rules->halves[b];
    return rules->matrix[(size_t)rules->classes[a] * rules->class_count + rules->classes[b]];
}

/* ---- active vertices ----------------------------------------------------------------------------------- */

/* Which vertices may move in the next motions. Pairs of two features without any of them are not looked for. */
typedef struct active_set {
    bool *vertices;  /* NULL: all are active, and so is everything */
    bool *triangles; /* whether one of their vertices is active */
} active_set;

/* Makes room for a set, unless there is one. OUT_OF_MEMORY: nothing has changed. */
cscd_status active_set_reserve(const cscd_mesh *mesh, active_set *s);

/* Makes these vertices, which are of the mesh, and no others active. There is room. */
void active_set_fill(const cscd_mesh *mesh, const uint32_t *vertices, size_t count, active_set *s);

/* Copies all of it; mesh: the same one in the context of the copy. Here and below *out is untouched on failure. */
cscd_status active_set_copy(const active_set *s, const cscd_mesh *mesh, active_set *out);

/* The set of a mesh that was made from another one; mesh: the new one. What comes from an active vertex is active, and
 * so is what is new. */
cscd_status active_set_move(const active_set *s, const cscd_mesh *mesh, const cscd_mesh_change *change,
                            active_set *out);
void active_set_free(cscd_context *context, active_set *s);

/* Returns the first fault as a sentence, or NULL. */
const char *active_set_validate(const active_set *s, const cscd_mesh *mesh);

static inline bool edge_is_active(const active_set *s, const cscd_mesh *mesh, uint32_t edge) {
    return s->vertices[mesh->edges[edge][0]] || s->vertices[mesh->edges[edge][1]];
}

/* Bit i: corner i of the triangle is active. */
static inline uint32_t active_corners(const active_set *s, const uint32_t corners[3]) {
    return (uint32_t)s->vertices[corners[0]] | (uint32_t)s->vertices[corners[1]] << 1 |
           (uint32_t)s->vertices[corners[2]] << 2;
}

/* ---- what was found ----------------------------------------------------------------------------------- */

/* Is this contact, or proximity, of two features without a common vertex to be left out? */
bool exclusions_cover_features(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b);

/* Is this intersection of triangles a < b to be left out? Seams exclude it when every two of their features
 * that intersect have a vertex of one seam in common. */
bool exclusions_cover_triangles(const exclusions *e, uint32_t a, uint32_t b, const double *positions);

/* The same of a duplicate: triangles of three shared vertices, which seams do not exclude. */
bool exclusions_cover_duplicate(const exclusions *e, uint32_t a, uint32_t b);

/* Does the caller's function leave these triangles out? */
bool exclusions_host_ignores(const exclusions *e, uint32_t a, uint32_t b);
