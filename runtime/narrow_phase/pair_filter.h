/* Decides which pairs are looked at. A search asks one question on each level, from the trees down to what it has found:
 * trees and leaves  object_sets_may_meet, which the traversal asks for eight sets of objects at once;
 * objects           pair_filter_admits_objects, and pair_filter_admits_components;
 * triangles         pair_filter_admits_triangles, where trees of a baseline hold several components;
 * their features    pair_filter_features;
 * two features      pair_filter_admits_features;
 * what was found    exclusions_cover. */
#pragma once

#include "runtime/ccd/ccd.h"
#include "runtime/narrow_phase/exclusions.h"
#include "src/mesh/mesh_change.h"

/* ---- rules --------------------------------------------------------------------------------------------- */

/* The rules of the caller, as they were given: which objects are looked at with which, and how far apart
 * they have to stay. The matrix has class_count rows; NULL: distances are sums of halves of thicknesses. */
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

    /* The greatest distance, and the greatest one of an object that is looked at with itself. */
    double greatest, greatest_to_itself;
} pair_rules;

/* Copies and checks what the caller says. INVALID_ARGUMENT names the object or the place in the matrix. On
 * failure *out holds nothing. */
cscd_status pair_rules_create(const cscd_mesh *mesh, const given_rules *given, pair_rules *out);

/* Copies all of it; mesh: the same one in the context of the copy. On failure *out is untouched. */
cscd_status pair_rules_copy(const pair_rules *r, const cscd_mesh *mesh, pair_rules *out);
void pair_rules_free(const cscd_mesh *mesh, pair_rules *rules);

/* A copy of the sets alone; of default rules, if there are none. NULL: no memory. */
object_set *pair_rules_copy_sets(const cscd_mesh *mesh, const pair_rules *rules);

/* Returns the distance that these objects have to keep; 0: they must not touch. */
static inline double pair_rules_distance(const pair_rules *rules, uint32_t a, uint32_t b) {
    if (rules->matrix == NULL) return rules->halves[a] + rules->halves[b];
    return rules->matrix[(size_t)rules->classes[a] * rules->class_count + rules->classes[b]];
}

/* ---- active vertices ----------------------------------------------------------------------------------- */

/* The vertices that may move in the next motions. Pairs of two features without any of them are not looked
 * for. */
typedef struct active_set {
    bool *vertices;  /* NULL: all are active, and so is everything */
    bool *triangles; /* whether one of their vertices is active */
} active_set;

/* Makes room for a set, unless there is one. OUT_OF_MEMORY: nothing has changed. */
cscd_status active_set_reserve(const cscd_mesh *mesh, active_set *s);

/* Makes these vertices, which are of the mesh, and no others active. There is room. */
void active_set_fill(const cscd_mesh *mesh, const uint32_t *vertices, size_t count, active_set *s);

/* Copies all of it; mesh: the same one in the context of the copy. Here and below *out is untouched on
 * failure. */
cscd_status active_set_copy(const active_set *s, const cscd_mesh *mesh, active_set *out);

/* The set of a mesh that was made from another one; mesh: the new one. Vertices that come from an active
 * vertex are active, and so are new ones. */
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

/* ---- the filter ----------------------------------------------------------------------------------------- */

/* The filter of one interval. */
typedef struct pair_filter {
    const cscd_mesh *mesh;
    const pair_rules *rules;  /* NULL: all objects are looked at, but obstacles with obstacles */
    const active_set *active; /* NULL: all vertices are active */
    const bool *collapsed; /* per component: it is not looked at with others of these; NULL: there are none */
    /* Per vertex, the smallest one of its seam: pairs with a seam in common, which lists leave out anyway, may go untested.
     * NULL: they are tested, because what touches there matters to culling. */
    const uint32_t *seam_names;
} pair_filter;

/* Are two objects, of triangles or not, or an object and itself, looked at with each other? */
static inline bool pair_filter_admits_objects(const pair_filter *f, uint32_t a, uint32_t b) {
    const cscd_object *objects = f->mesh->objects;
    if (f->rules == NULL) return !objects[a].obstacle || !objects[b].obstacle;
    return object_sets_may_meet(&f->rules->sets[a], &f->rules->sets[b]);
}

/* The same of two components, or of one and itself. */
static inline bool pair_filter_admits_components(const pair_filter *f, uint32_t a, uint32_t b) {
    if (f->collapsed != NULL && f->collapsed[a] && f->collapsed[b]) return false;
    if (f->rules == NULL) return !component_is_obstacle(f->mesh, a) || !component_is_obstacle(f->mesh, b);
    const uint32_t *objects = f->rules->component_objects;
    return object_sets_may_meet(&f->rules->sets[objects[a]], &f->rules->sets[objects[b]]);
}

/* Is it known without the other component that this one is looked at with every component, and with itself? */
static inline bool pair_filter_admits_all(const pair_filter *f, uint32_t component) {
    return f->rules == NULL && pair_filter_admits_components(f, component, component);
}

static inline bool pair_filter_admits_triangles(const pair_filter *f, uint32_t a, uint32_t b) {
    const uint32_t *components = f->mesh->triangle_components;
    return pair_filter_admits_components(f, components[a], components[b]);
}

/* Sets of pairs of features of two triangles a and b: bit i is vertex i of a against the face b,
 * FEATURE_VERTEX_B + i vertex i of b against the face a, FEATURE_EDGES + 3 i + j edge i of a against edge j
 * of b. */
enum { FEATURE_VERTEX_B = 3, FEATURE_EDGES = 6, FEATURE_ALL = (1 << 15) - 1 };

/* Those pairs of features of two triangles of which a feature is active. */
static inline uint32_t pair_filter_features(const pair_filter *f, uint32_t triangle_a, uint32_t triangle_b) {
    if (f->active == NULL) return FEATURE_ALL;
    uint32_t a = active_corners(f->active, f->mesh->triangles[triangle_a]);
    uint32_t b = active_corners(f->active, f->mesh->triangles[triangle_b]);
    uint32_t edges_a = a | a >> 1 | (a & 1) << 2, edges_b = b | b >> 1 | (b & 1) << 2, edges = 0;
    for (int i = 0; i < 3; i++) edges |= ((edges_a >> i & 1) != 0 ? 7u : edges_b) << 3 * i;
    return (b != 0 ? 7u : a) | (a != 0 ? 7u : b) << FEATURE_VERTEX_B | edges << FEATURE_EDGES;
}

/* Is one of two features, as in cscd_contact, active? Points may be named as edges. */
static inline bool pair_filter_admits_features(const pair_filter *f, cscd_contact_kind kind, uint32_t a,
                                               uint32_t b) {
    const active_set *s = f->active;
    if (s == NULL) return true;
    if (kind == CSCD_CONTACT_EE) return edge_is_active(s, f->mesh, a) || edge_is_active(s, f->mesh, b);
    if (s->vertices[a]) return true;
    return kind == CSCD_CONTACT_VF ? s->triangles[b] : s->vertices[f->mesh->objects[b].first_vertex];
}

/* ---- what was found ------------------------------------------------------------------------------------- */

/* Is what was found left out? It is a contact, or a proximity, of two features without a common vertex, or,
 * of kind TT, an intersection of triangles a < b at these positions. Seams leave out an intersection if
 * every two features of the triangles that intersect have a vertex of one seam in common. */
bool exclusions_cover(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b,
                      const double *positions);

/* The same of a duplicate: triangles of three shared vertices, which seams do not leave out. */
bool exclusions_cover_duplicate(const exclusions *e, uint32_t a, uint32_t b);

/* Does the caller's function leave these triangles out? */
bool exclusions_host_ignores(const exclusions *e, uint32_t a, uint32_t b);
