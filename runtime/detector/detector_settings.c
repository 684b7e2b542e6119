/* Changes of a live detector: distances, rules for objects, what is left out, active vertices, parts. */
#include "runtime/detector/detector.h"
#include "src/mesh/positions.h"

/* ---- rules, distances, limits -------------------------------------------------------------------------- */

static bool is_neutral(const cscd_object_rule *rule) {
    cscd_object_rule neutral = cscd_object_rule_default();
    return rule->category == neutral.category && rule->mask == neutral.mask && rule->thickness == 0.0 &&
           rule->self && !rule->obstacle_pairs;
}

/* Do the rules say no more than none would? */
static bool all_neutral(const given_rules *given) {
    for (uint32_t i = 0; i < given->count; i++) {
        if (!is_neutral(&given->objects[i])) return false;
    }
    return given->matrix == NULL;
}

/* The states of triangles at the start are kept, except in components that are not proven any more: no later step or
 * check looks at them, so what is known of them would go stale. */
static void choose_never_culled(cscd_detector *d) {
    const pair_rules *rules = &d->config.pair_rules;
    d->config.all_never_culled = rules->sets != NULL;
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        bool masked = config_masks(&d->config, d->mesh, c), thick = false;
        if (rules->sets != NULL) {
            uint32_t object = rules->component_objects[c];
            thick = pair_rules_distance(rules, object, object) > 0.0;
        }
        d->config.never_culled[c] = masked || thick;
        d->config.all_never_culled &= d->config.never_culled[c];
        if (masked) start_states_forget_component(&d->known.starts, c);
    }
}

void detector_take_rules(cscd_detector *d, const pair_rules *rules) {
    pair_rules_free(d->mesh, &d->config.pair_rules);
    d->config.pair_rules = *rules;
    d->config.rules_revision++;
    d->space.rules = rules->sets != NULL ? &d->config.pair_rules : NULL;
    d->rebuild.objects = rules->sets;
    d->known.check.objects = rules->sets;
    d->known.check.component_objects = rules->component_objects;
    d->known.starts.never_culled = d->config.never_culled;
    choose_never_culled(d);
}

/* INVALID_ARGUMENT, if both min_separation and the rules say distances. */
static cscd_status check_distances(cscd_detector *d, double min_separation, double greatest_of_rules) {
    if (min_separation == 0.0 || greatest_of_rules == 0.0) return CSCD_OK;
    return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                        "min_separation is %g, but the thicknesses of objects say how far apart they have to "
                        "stay; leave it at 0",
                        min_separation);
}

/* May objects be looked at with each other that were not? */
static bool rules_uncover(const cscd_mesh *mesh, const pair_rules *before, const pair_rules *now) {
    bool differ = before->sets != NULL;
    if (before->sets != NULL && now->sets != NULL) {
        differ = false;
        for (uint32_t i = 0; i < mesh->object_count; i++) {
            differ |= !object_sets_are_alike(&before->sets[i], &now->sets[i]);
        }
    } else if (now->sets != NULL) {
        for (uint32_t i = 0; i < mesh->object_count; i++)
            differ |= now->sets[i].kinds == OBJECT_ASKING_OBSTACLE;
    }
    return differ;
}

/* Makes room for what the rules of now leave out; NULL: no memory. */
static object_set *reserve_former(cscd_detector *d) {
    object_set *sets = pair_rules_copy_sets(d->mesh, &d->config.pair_rules);
    if (sets != NULL && waiting_pairs_reserve(d->mesh, &d->config.waiting) == CSCD_OK) return sets;
    context_free(d->context, sets);
    context_out_of_memory(d->context);
    return NULL;
}

/* Replaces the rules. What new rules of a live detector uncover may have to wait. */
static cscd_status replace_rules(cscd_detector *d, const given_rules *given, bool live) {
    pair_rules rules;
    cscd_status status = pair_rules_create(d->mesh, given, &rules);
    if (status != CSCD_OK) return status;
    if (all_neutral(given)) pair_rules_free(d->mesh, &rules);
    bool uncovers = live && rules_uncover(d->mesh, &d->config.pair_rules, &rules);
    object_set *former = uncovers ? reserve_former(d) : NULL;
    if (uncovers && former == NULL) status = CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK) status = check_distances(d, d->config.options.min_separation, rules.greatest);
    if (status == CSCD_OK && d->space.bvh.mesh != NULL && !bvh_set_objects(&d->space.bvh, rules.sets))
        status = context_out_of_memory(d->context);
    if (status != CSCD_OK) {
        context_free(d->context, former);
        pair_rules_free(d->mesh, &rules);
        return status;
    }
    if (uncovers) waiting_pairs_uncover_objects(d->mesh, &d->config.waiting, former);
    detector_take_rules(d, &rules);
    return CSCD_OK;
}

cscd_status detector_set_rules(cscd_detector *d, const given_rules *given) {
    return replace_rules(d, given, false);
}

cscd_status cscd_detector_set_rules(cscd_detector *detector, const cscd_object_rule *rules,
                                    uint32_t rule_count, const double *thickness_matrix,
                                    uint32_t thickness_class_count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    const given_rules given = {rules, rule_count, thickness_matrix, thickness_class_count};
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, replace_rules(detector, &given, true));
}

cscd_status detector_set_longest_list(cscd_detector *d, size_t longest) {
    cscd_status status = longest > 0 ? rollback_reserve(d->mesh, &d->known.before) : CSCD_OK;
    if (status == CSCD_OK) status = list_cap_set(d->context, d->mesh, &d->interval.cap, longest);
    if (status != CSCD_OK) return context_out_of_memory(d->context);
    d->config.options.longest_list = longest;
    return CSCD_OK;
}

cscd_status cscd_detector_set_longest_list(cscd_detector *detector, size_t longest_list) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, detector_set_longest_list(detector, longest_list));
}

static cscd_status set_separation(cscd_detector *detector, double min_separation, double tolerance) {
    cscd_detector_options changed = detector->config.options;
    changed.min_separation = min_separation;
    changed.tolerance = tolerance;
    cscd_status status = separation_check(detector->context, min_separation, tolerance);
    if (status == CSCD_OK)
        status = check_distances(detector, min_separation, detector->config.pair_rules.greatest);
    if (status != CSCD_OK) return status;
    detector->config.options = changed;
    detector->config.limit = separation_limit(min_separation, tolerance);
    return CSCD_OK;
}

cscd_status cscd_detector_set_separation(cscd_detector *detector, double min_separation, double tolerance) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, set_separation(detector, min_separation, tolerance));
}

/* ---- seams and ignored pairs --------------------------------------------------------------------------- */

/* Replaces what is left out by *next, which becomes the detector's, or is freed. What it uncovers may have to wait. */
static cscd_status replace_exclusions(cscd_detector *d, exclusions *next) {
    exclusions before = exclusions_listed(&d->config.exclusions);
    bool uncovers = exclusions_uncover(&before, next);
    cscd_status status = uncovers ? waiting_pairs_reserve(d->mesh, &d->config.waiting) : CSCD_OK;
    if (status != CSCD_OK) {
        exclusions_free(d->context, next);
        return status;
    }
    if (uncovers) waiting_pairs_uncover(d->mesh, &d->config.waiting, &before);
    exclusions_free(d->context, &before);
    d->config.exclusions = *next;
    return CSCD_OK;
}

static cscd_status set_seams(cscd_detector *d, const uint32_t *seams, size_t seam_count) {
    exclusions next;
    cscd_status status =
        exclusions_with_seams(&d->config.exclusions, seams, seam_count, d->config.options.seam_reach, &next);
    return status == CSCD_OK ? replace_exclusions(d, &next) : status;
}

/* Seams that are still to be checked go on to the exclusions that replace those of now. */
static cscd_status set_ignored(cscd_detector *d, const uint32_t *ignored, size_t ignored_count) {
    exclusions next;
    cscd_status status = exclusions_with_ignored(&d->config.exclusions, ignored, ignored_count, &next);
    seam_list seams = d->config.exclusions.seams;
    d->config.exclusions.seams = (seam_list){.vertices = NULL};
    if (status == CSCD_OK) status = replace_exclusions(d, &next);
    d->config.exclusions.seams = seams;
    return status;
}

cscd_status cscd_detector_set_seams(cscd_detector *detector, const uint32_t *seams, size_t seam_count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, set_seams(detector, seams, seam_count));
}

cscd_status cscd_detector_set_ignored(cscd_detector *detector, const uint32_t *ignored,
                                      size_t ignored_count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, set_ignored(detector, ignored, ignored_count));
}

/* ---- active vertices ----------------------------------------------------------------------------------- */

/* 0 and -0 are the same place. */
cscd_status detector_check_still(const cscd_detector *d, const double *x0, const double *x1) {
    const bool *active = d->space.active.vertices;
    for (size_t i = 0; active != NULL && i < (size_t)d->mesh->vertex_count * 3; i++) {
        if (x0[i] == x1[i] || active[i / 3]) continue;
        return context_fail(
            d->context, CSCD_INVALID_ARGUMENT,
            "vertex %zu is not active, but has %c = %g in x0 and %g in x1: leave it where it is, "
            "or name it in cscd_detector_set_active",
            i / 3, "xyz"[i % 3], x0[i], x1[i]);
    }
    return CSCD_OK;
}

static cscd_status check_vertices(const cscd_detector *d, const uint32_t *vertices, size_t count) {
    if (vertices == NULL && count > 0)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                            "cscd_detector_set_active: vertices is NULL, but there are to be %zu", count);
    for (size_t i = 0; i < count; i++) {
        if (vertices[i] < d->mesh->vertex_count) continue;
        return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                            "cscd_detector_set_active: vertices[%zu] is %u, but there are %u vertices", i,
                            vertices[i], d->mesh->vertex_count);
    }
    return CSCD_OK;
}

/* Every set that was there has its marks in the trees, so memory is short only where there was none. */
static cscd_status take_vertices(cscd_detector *d, const uint32_t *vertices, size_t count) {
    search_space *s = &d->space;
    cscd_status status = active_set_reserve(d->mesh, &s->active);
    if (status != CSCD_OK) return context_out_of_memory(d->context);
    active_set_fill(d->mesh, vertices, count, &s->active);
    if (s->bvh.mesh != NULL && !bvh_set_active(&s->bvh, s->active.triangles)) {
        active_set_free(d->context, &s->active);
        return context_out_of_memory(d->context);
    }
    d->rebuild.active = s->active.triangles;
    d->config.rules_revision++;
    return CSCD_OK;
}

static void drop_vertices(cscd_detector *d) {
    search_space *s = &d->space;
    if (s->active.vertices == NULL) return;
    if (s->bvh.mesh != NULL) bvh_set_active(&s->bvh, NULL);
    active_set_free(d->context, &s->active);
    d->rebuild.active = NULL;
    d->config.rules_revision++;
}

cscd_status detector_focus(cscd_detector *d, const uint32_t *vertices, size_t count) {
    active_set *focus = &d->response.focus;
    cscd_status status = active_set_reserve(d->mesh, focus);
    if (status != CSCD_OK) return status;
    active_set_fill(d->mesh, vertices, count, focus);
    if (d->space.bvh.mesh != NULL && !bvh_set_active(&d->space.bvh, focus->triangles))
        return CSCD_OUT_OF_MEMORY;
    d->space.active = *focus;
    d->rebuild.active = focus->triangles;
    return CSCD_OK;
}

void detector_unfocus(cscd_detector *d) {
    if (d->space.bvh.mesh != NULL) bvh_set_active(&d->space.bvh, NULL);
    d->space.active = (active_set){.vertices = NULL};
    d->rebuild.active = NULL;
}

static cscd_status set_active(cscd_detector *d, const uint32_t *vertices, size_t count) {
    cscd_status status = check_vertices(d, vertices, count);
    if (status != CSCD_OK) return status;
    if (vertices != NULL) return take_vertices(d, vertices, count);
    drop_vertices(d);
    return CSCD_OK;
}

cscd_status cscd_detector_set_active(cscd_detector *detector, const uint32_t *vertices, size_t count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, set_active(detector, vertices, count));
}

/* ---- parts, bodies, rest ------------------------------------------------------------------------------- */

static cscd_status set_labels(cscd_detector *d, const uint32_t *labels, uint32_t count, part_labels *out,
                              const char *name) {
    cscd_status status = part_labels_check(d->mesh, labels, count, name);
    if (status != CSCD_OK) return status;
    status = part_labels_set(d->mesh, labels, count, out);
    return context_explain(d->context, status);
}

cscd_status cscd_detector_set_parts(cscd_detector *detector, const uint32_t *labels, uint32_t part_count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(
        &entry, set_labels(detector, labels, part_count, &detector->config.parts, "cscd_detector_set_parts"));
}

cscd_status cscd_detector_set_bodies(cscd_detector *detector, const uint32_t *labels, uint32_t label_count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, set_labels(detector, labels, label_count, &detector->config.grouping,
                                            "cscd_detector_set_bodies"));
}

uint32_t cscd_detector_body_labels(const cscd_detector *detector, uint32_t *labels) {
    if (config_bodies_are_components(&detector->config, detector->mesh)) {
        for (uint32_t t = 0; labels != NULL && t < detector->mesh->triangle_count; t++)
            labels[t] = detector->mesh->triangle_components[t];
        return detector->mesh->component_count;
    }
    const surface_bodies *bodies = &config_grouping(&detector->config)->bodies;
    for (uint32_t t = 0; labels != NULL && t < detector->mesh->triangle_count; t++)
        labels[t] = body_of_triangle(bodies, detector->mesh, t);
    return body_count(bodies, detector->mesh);
}

static cscd_status take_rest(cscd_detector *d, const cscd_view *rest) {
    const double *x = NULL;
    cscd_status status = views_read(d->context, d->mesh, rest, "rest", &d->unpacked[0], &x);
    if (status == CSCD_OK) status = positions_check(d->context, x, d->mesh->vertex_count, "rest");
    return status == CSCD_OK ? rest_shape_set(d->context, d->mesh, x, &d->config.rest) : status;
}

cscd_status cscd_detector_set_rest(cscd_detector *detector, const cscd_view *rest) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    cscd_status status = CSCD_OK;
    if (rest == NULL)
        rest_shape_free(detector->context, &detector->config.rest);
    else
        status = take_rest(detector, rest);
    return context_leave(&entry, status);
}
