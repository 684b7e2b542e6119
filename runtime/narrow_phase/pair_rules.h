/* Which objects are looked at with which, and how far apart they have to stay: the rules of the caller. */
#pragma once

#include "runtime/bvh/object_set.h"
#include "runtime/ccd/min_separation.h"
#include "src/mesh/mesh.h"

/* Rules as they were given. The matrix has class_count rows; NULL: distances are sums of halves of thicknesses. */
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
