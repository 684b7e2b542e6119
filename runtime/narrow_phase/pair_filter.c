/* Decides which pairs are looked at: by the rules of their objects, by active vertices, and by what the
 * caller leaves out. */
#include "runtime/narrow_phase/pair_filter.h"

#include "src/core/floating.h"
#include "src/mesh/predicates.h"

#include <math.h>
#include <string.h>

/* ---- rules: what the caller says --------------------------------------------------------------------------- */

static cscd_status check_matrix(cscd_context *context, const given_rules *given) {
    uint32_t count = given->class_count;
    if (given->matrix == NULL || count > THICKNESS_CLASSES_MAX || count == 0) {
        if (given->matrix == NULL && count == 0) return CSCD_OK;
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "thickness_matrix is %s and thickness_class_count is %u, expected a matrix of 1 to "
            "%d classes, or NULL and 0",
            given->matrix == NULL ? "NULL" : "given", count, THICKNESS_CLASSES_MAX);
    }
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = 0; j < count; j++) {
            double distance = given->matrix[(size_t)i * count + j],
                   other = given->matrix[(size_t)j * count + i];
            if (!is_length(distance))
                return context_fail(
                    context, CSCD_INVALID_ARGUMENT,
                    "thickness_matrix has %g for classes %u and %u, expected 0 or a length from 2^-300 to 2^300",
                    distance, i, j);
            if (distance != other)
                return context_fail(
                    context, CSCD_INVALID_ARGUMENT,
                    "thickness_matrix has %g for classes %u and %u, but %g for %u and %u; make it "
                    "symmetric",
                    distance, i, j, other, j, i);
        }
    }
    return CSCD_OK;
}

static cscd_status check_rule(cscd_context *context, const given_rules *given, uint32_t object) {
    const cscd_object_rule *rule = &given->objects[object];
    if (!is_length(rule->thickness))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "object %u has a thickness of %g, expected 0 or a length from 2^-300 to 2^300",
                            object, rule->thickness);
    if (rule->reserved != 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "object %u has a rule whose member reserved is %u, expected 0", object,
                            rule->reserved);
    if (given->matrix != NULL && rule->thickness > 0.0)
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "object %u has a thickness of %g, but the distances are those of thickness_matrix; leave it at 0",
            object, rule->thickness);
    if (given->matrix != NULL ? rule->thickness_class >= given->class_count : rule->thickness_class != 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "object %u has the thickness_class %u, but there are %u classes", object,
                            rule->thickness_class, given->class_count);
    return CSCD_OK;
}

static cscd_status check_rules(const cscd_mesh *mesh, const given_rules *given) {
    cscd_context *context = mesh->context;
    if (given->count != 0 && given->count != mesh->object_count)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "there are %u rules, expected none or one for each of the %u objects",
                            given->count, mesh->object_count);
    if (given->count > 0 && given->objects == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "rules is NULL, but there are to be %u",
                            given->count);
    if (given->count == 0 && given->objects != NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "rules are given, but rule_count is 0");
    cscd_status status = check_matrix(context, given);
    for (uint32_t i = 0; status == CSCD_OK && i < given->count; i++) status = check_rule(context, given, i);
    return status;
}

/* ---- rules: what follows ------------------------------------------------------------------------------------ */

static array_list list_rules(const cscd_mesh *mesh, pair_rules *r) {
    size_t objects = r->object_count, classes = r->class_count;
    return (array_list){
        {ARRAY(r->sets, objects), ARRAY(r->given, objects), ARRAY(r->reaches, objects),
         ARRAY(r->component_objects, mesh->component_count), ARRAY_IF(classes == 0, r->halves, objects),
         ARRAY_IF(classes > 0, r->classes, objects), ARRAY_IF(classes > 0, r->matrix, classes * classes)}};
}

static object_set set_of(const cscd_mesh *mesh, const cscd_object_rule *rule, uint32_t object) {
    bool obstacle = mesh->objects[object].obstacle, asks = rule->obstacle_pairs;
    uint8_t kind = !obstacle ? OBJECT_FREE : asks ? OBJECT_ASKING_OBSTACLE : OBJECT_OBSTACLE;
    uint8_t sought = !obstacle ? OBJECT_FREE | OBJECT_OBSTACLE | OBJECT_ASKING_OBSTACLE
                     : asks    ? OBJECT_FREE | OBJECT_ASKING_OBSTACLE
                               : OBJECT_FREE;
    return (object_set){.categories = rule->category,
                        .masks = rule->mask,
                        .kinds = kind,
                        .kinds_sought = sought,
                        .self = rule->self && !obstacle,
                        .first = object,
                        .last = object};
}

static double greatest_of_row(const pair_rules *r, uint32_t row) {
    double greatest = 0.0;
    for (uint32_t i = 0; i < r->class_count; i++)
        greatest = fmax(greatest, r->matrix[(size_t)row * r->class_count + i]);
    return greatest;
}

static void fill_objects(const cscd_mesh *mesh, const given_rules *given, pair_rules *r) {
    for (uint32_t i = 0; i < r->object_count; i++) {
        cscd_object_rule rule = given->count > 0 ? given->objects[i] : cscd_object_rule_default();
        r->given[i] = rule;
        r->sets[i] = set_of(mesh, &rule, i);
        if (r->matrix != NULL) r->classes[i] = rule.thickness_class;
        if (r->halves != NULL) r->halves[i] = 0.5 * rule.thickness;
        r->reaches[i] = r->matrix != NULL ? greatest_of_row(r, rule.thickness_class) : rule.thickness;
        r->greatest = fmax(r->greatest, r->reaches[i]);
        if (r->sets[i].self)
            r->greatest_to_itself = fmax(r->greatest_to_itself, pair_rules_distance(r, i, i));
    }
}

/* No component spans two objects. */
static void name_objects(const cscd_mesh *mesh, uint32_t *component_objects) {
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        const cscd_object *object = &mesh->objects[i];
        for (uint32_t t = 0; t < object->triangle_count; t++)
            component_objects[mesh->triangle_components[object->first_triangle + t]] = i;
    }
}

cscd_status pair_rules_create(const cscd_mesh *mesh, const given_rules *given, pair_rules *out) {
    cscd_status status = check_rules(mesh, given);
    if (status != CSCD_OK) return status;
    pair_rules r = {.object_count = mesh->object_count, .class_count = given->class_count};
    if (!context_allocate_all(mesh->context, list_rules(mesh, &r)))
        return context_out_of_memory(mesh->context);
    if (r.matrix != NULL)
        memcpy(r.matrix, given->matrix, (size_t)r.class_count * r.class_count * sizeof *r.matrix);
    fill_objects(mesh, given, &r);
    name_objects(mesh, r.component_objects);
    *out = r;
    return CSCD_OK;
}

cscd_status pair_rules_copy(const pair_rules *r, const cscd_mesh *mesh, pair_rules *out) {
    pair_rules copy = *r;
    if (!context_copy_all(mesh->context, list_rules(mesh, &copy))) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}

object_set *pair_rules_copy_sets(const cscd_mesh *mesh, const pair_rules *rules) {
    const cscd_object_rule usual = cscd_object_rule_default();
    object_set *sets = context_allocate(mesh->context, mesh->object_count, sizeof *sets);
    for (uint32_t i = 0; sets != NULL && i < mesh->object_count; i++)
        sets[i] = rules->sets != NULL ? rules->sets[i] : set_of(mesh, &usual, i);
    return sets;
}

void pair_rules_free(const cscd_mesh *mesh, pair_rules *r) {
    context_free_all(mesh->context, list_rules(mesh, r));
    *r = (pair_rules){.object_count = 0};
}

/* ---- active vertices ----------------------------------------------------------------------------------- */

static array_list list_marks(const cscd_mesh *mesh, active_set *s) {
    return (array_list){{ARRAY(s->vertices, mesh->vertex_count), ARRAY(s->triangles, mesh->triangle_count)}};
}

cscd_status active_set_reserve(const cscd_mesh *mesh, active_set *s) {
    active_set fresh;
    if (s->vertices != NULL) return CSCD_OK;
    if (!context_allocate_all(mesh->context, list_marks(mesh, &fresh))) return CSCD_OUT_OF_MEMORY;
    *s = fresh;
    return CSCD_OK;
}

static void fill_triangles(const cscd_mesh *mesh, active_set *s) {
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        s->triangles[t] = active_corners(s, mesh->triangles[t]) != 0;
}

void active_set_fill(const cscd_mesh *mesh, const uint32_t *vertices, size_t count, active_set *s) {
    memset(s->vertices, false, mesh->vertex_count * sizeof *s->vertices);
    for (size_t i = 0; i < count; i++) s->vertices[vertices[i]] = true;
    fill_triangles(mesh, s);
}

cscd_status active_set_copy(const active_set *s, const cscd_mesh *mesh, active_set *out) {
    active_set copy = *s;
    if (!context_copy_all(mesh->context, list_marks(mesh, &copy))) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}

cscd_status active_set_move(const active_set *s, const cscd_mesh *mesh, const cscd_mesh_change *change,
                            active_set *out) {
    active_set moved = {.vertices = NULL};
    if (s->vertices != NULL) {
        cscd_status status = active_set_reserve(mesh, &moved);
        if (status != CSCD_OK) return status;
        mesh_change_make_whole(change, &change->vertices);
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            uint32_t origin = change->vertices.to_old[v];
            moved.vertices[v] = origin == UINT32_MAX || s->vertices[origin];
        }
        fill_triangles(mesh, &moved);
    }
    *out = moved;
    return CSCD_OK;
}

void active_set_free(cscd_context *context, active_set *s) {
    context_free(context, s->vertices);
    context_free(context, s->triangles);
    *s = (active_set){.vertices = NULL};
}

const char *active_set_validate(const active_set *s, const cscd_mesh *mesh) {
    if ((s->vertices != NULL) != (s->triangles != NULL)) return "an active set has no triangles";
    for (uint32_t t = 0; s->vertices != NULL && t < mesh->triangle_count; t++) {
        if (s->triangles[t] != (active_corners(s, mesh->triangles[t]) != 0))
            return "a triangle is not as active as its vertices";
    }
    return NULL;
}

/* ---- what was found: pairs of triangles -------------------------------------------------------------------------------- */

static bool host_ignores(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (e->ignore == NULL) return false;
    host_call call = host_call_begin(&e->mesh->context->entry);
    bool ignored = e->ignore(e->ignore_user, kind, a, b);
    host_call_end(&call);
    return ignored;
}

static bool is_waiting(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (e->waiting == NULL || e->waiting->count == 0) return false;
    const named_pair *pair = named_pair_set_find(e->waiting, kind, a, b);
    return pair != NULL && (!e->marked_wait || pair->marked != 0);
}

bool exclusions_cover_duplicate(const exclusions *e, uint32_t a, uint32_t b) {
    if (is_waiting(e, CSCD_CONTACT_TT, a, b)) return true;
    if (exclusions_have(e, a, b)) return true;
    return host_ignores(e, CSCD_CONTACT_TT, a, b);
}

bool exclusions_host_ignores(const exclusions *e, uint32_t a, uint32_t b) {
    return host_ignores(e, CSCD_CONTACT_TT, a, b);
}

static bool covers_triangles(const exclusions *e, uint32_t a, uint32_t b, const double *positions) {
    if (exclusions_cover_duplicate(e, a, b)) return true;
    if (e->names == NULL) return false;
    const uint32_t *corners_a = e->mesh->triangles[a], *corners_b = e->mesh->triangles[b];
    return !triangles_intersect_by_names(corners_a, corners_b, e->names, positions);
}

/* ---- what was found: pairs of features --------------------------------------------------------------------------------- */

typedef struct triangle_list {
    const uint32_t *items;
    uint32_t count;
} triangle_list;

static triangle_list vertex_star(const cscd_mesh *mesh, uint32_t vertex) {
    uint32_t begin = mesh->vertex_star_offsets[vertex];
    return (triangle_list){mesh->vertex_stars + begin, mesh->vertex_star_offsets[vertex + 1] - begin};
}

static triangle_list edge_star(const cscd_mesh *mesh, uint32_t edge) {
    return (triangle_list){mesh->edge_stars + mesh->edge_star_offsets[edge], edge_star_size(mesh, edge)};
}

static bool any_pair_listed(const exclusions *e, triangle_list a, triangle_list b) {
    for (uint32_t i = 0; i < a.count; i++) {
        for (uint32_t j = 0; j < b.count; j++) {
            if (a.items[i] != b.items[j] && exclusions_have(e, a.items[i], b.items[j])) return true;
        }
    }
    return false;
}

static bool features_listed(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (e->ignored_count == 0 || (kind != CSCD_CONTACT_VF && kind != CSCD_CONTACT_EE)) return false;
    if (kind == CSCD_CONTACT_VF) return any_pair_listed(e, vertex_star(e->mesh, a), (triangle_list){&b, 1});
    return any_pair_listed(e, edge_star(e->mesh, a), edge_star(e->mesh, b));
}

static bool share_name(const uint32_t *names, const uint32_t *a, int a_count, const uint32_t *b,
                       int b_count) {
    for (int i = 0; i < a_count; i++) {
        for (int j = 0; j < b_count; j++) {
            if (names[a[i]] == names[b[j]]) return true;
        }
    }
    return false;
}

/* Do two features have vertices of one seam? A half-space has its point. */
static bool in_one_seam(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const cscd_mesh *mesh = e->mesh;
    bool edge_a = kind == CSCD_CONTACT_EE || kind == CSCD_CONTACT_EV;
    const uint32_t *of_a = edge_a ? mesh->edges[a] : &a;
    const uint32_t *of_b = kind == CSCD_CONTACT_VF   ? mesh->triangles[b]
                           : kind == CSCD_CONTACT_EE ? mesh->edges[b]
                           : kind == CSCD_CONTACT_VH ? &mesh->objects[b].first_vertex
                                                     : &b;
    int count_b = kind == CSCD_CONTACT_VF ? 3 : kind == CSCD_CONTACT_EE ? 2 : 1;
    return share_name(e->names, of_a, edge_a ? 2 : 1, of_b, count_b);
}

static bool covers_features(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (is_waiting(e, kind, a, b)) return true;
    if (e->names != NULL && in_one_seam(e, kind, a, b)) return true;
    return features_listed(e, kind, a, b) || host_ignores(e, kind, a, b);
}

bool exclusions_cover(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b,
                      const double *positions) {
    if (!exclusions_any(e)) return false;
    return kind == CSCD_CONTACT_TT ? covers_triangles(e, a, b, positions) : covers_features(e, kind, a, b);
}
