/* A validator of detectors, for debug builds and tests. */
#include "runtime/detector/detector_validate.h"

#include <math.h>

/* ---- regions --------------------------------------------------------------------------------------------- */

static const char *check_regions(const cscd_detector *d) {
    const culling *c = &d->culling;
    const bool *obstacles = d->mesh->obstacles;
    for (uint32_t t = 0; t < d->mesh->triangle_count; t++) {
        if (c->triangle_regions[t] >= c->region_count) return "a triangle is in a region that there is not";
        if (!(c->triangle_weights[t] >= 0.0 && c->triangle_weights[t] <= 1.0 + 0x1p-40))
            return "a triangle has no weight in its region";
        if (c->facing[t] > ORIENTATION_ZERO) return "a triangle has an unknown orientation";
    }
    for (uint32_t i = 0; i < c->region_count; i++) {
        for (int k = 0; k < 3; k++) {
            if (!isfinite(c->detector_offsets[i][k])) return "a detector point is nowhere";
        }
    }
    for (uint32_t i = 0; i < d->mesh->component_count; i++) {
        if (obstacles != NULL && obstacles[i] && d->culled[i]) return "the pairs of an obstacle are culled";
    }
    return NULL;
}

/* ---- what is known of the start -------------------------------------------------------------------------- */

static const char *check_states(const start_states *s) {
    const cscd_mesh *mesh = s->mesh;
    for (uint32_t c = 0; s->counted && c < mesh->component_count; c++) {
        const component_start *start = &s->of[c];
        uint64_t sum = (uint64_t)start->unknown + start->crossing + start->clean;
        if (sum > mesh->components[c].triangle_count)
            return "a component has more states than triangles at its start";
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (s->triangles[t] > TRIANGLE_CLEAN) return "a triangle has an unknown state at its start";
        if (s->triangles[t] != TRIANGLE_UNKNOWN && !s->known)
            return "a triangle has a state at a start that nobody has seen";
    }
    return NULL;
}

/* ---- pairs to leave out, rules --------------------------------------------------------------------------- */

static const char *check_exclusions(const exclusions *e) {
    for (size_t i = 0; i < e->ignored_count; i++) {
        uint64_t a = e->ignored[i] >> 32, b = e->ignored[i] & UINT32_MAX;
        if (a > b || b >= e->mesh->triangle_count) return "a pair to leave out names no two triangles";
        if (i > 0 && e->ignored[i - 1] > e->ignored[i]) return "the pairs to leave out are not sorted";
    }
    for (uint32_t v = 0; e->names != NULL && v < e->mesh->vertex_count; v++) {
        if (e->names[v] > v || e->names[e->names[v]] != e->names[v])
            return "the seams do not name their vertices";
    }
    return NULL;
}

static const char *check_rules(const cscd_detector *d) {
    const pair_rules *r = &d->pair_rules;
    if ((r->sets != NULL) != (d->space.rules != NULL) || r->sets != d->rebuild.objects ||
        r->sets != d->check.objects)
        return "the parts of a detector have different rules";
    if (r->sets == NULL) return NULL;
    if (r->object_count != d->mesh->object_count) return "the rules are of another number of objects";
    for (uint32_t i = 0; i < r->object_count; i++) {
        double reach = r->reaches[i];
        if (!(reach >= 0.0 && reach <= r->greatest)) return "an object's distance is not within the greatest";
        if (r->matrix != NULL && r->classes[i] >= r->class_count)
            return "an object's thickness class is none";
    }
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        if (r->component_objects[c] >= r->object_count)
            return "a component is of an object that there is not";
    }
    return NULL;
}

static const char *check_active(const cscd_detector *d) {
    const search_space *s = &d->space;
    const char *fault = active_set_validate(&s->active, d->mesh);
    if (fault == NULL && d->rebuild.active != s->active.triangles)
        fault = "the trees and their detector have different active sets";
    return fault != NULL || s->bvh.mesh == NULL ? fault : bvh_check_active(&s->bvh, s->active.triangles);
}

/* ---- all of it ------------------------------------------------------------------------------------------- */

static const char *check_parts(const cscd_detector *d) {
    const cscd_mesh *mesh = d->mesh;
    if (mesh != d->seen || d->space.mesh != mesh || d->starts.mesh != mesh || d->culling.mesh != mesh ||
        d->rebuild.mesh != mesh || d->exclusions.mesh != mesh)
        return "the parts of a detector are of different meshes";
    if (mesh->shared != NULL && mesh_of_creator(mesh)->triangle_count != mesh->triangle_count)
        return "the mesh of a detector has changed";
    if (!(d->limit.distance >= 0.0) || !(d->limit.tolerance >= 0.0) ||
        d->limit.distance != d->options.min_separation)
        return "the distance of a detector is not that of its options";
    return NULL;
}

const char *detector_validate(const cscd_detector *d) {
    const char *fault = check_parts(d);
    if (fault == NULL) fault = check_regions(d);
    if (fault == NULL) fault = check_states(&d->starts);
    if (fault == NULL) fault = check_exclusions(&d->exclusions);
    if (fault == NULL) fault = check_rules(d);
    if (fault == NULL && d->space.bvh.mesh != NULL) fault = bvh_validate(&d->space.bvh, false);
    if (fault == NULL) fault = check_active(d);
    if (fault == NULL) fault = part_labels_validate(&d->parts, d->mesh);
    if (fault == NULL) fault = part_labels_validate(&d->grouping, d->mesh);
    return fault;
}
