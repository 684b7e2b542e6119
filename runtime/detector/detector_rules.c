/* What is left out, changed on a live detector: by rules for objects, seams and ignored pairs. */
#include "runtime/detector/detector_rules.h"

#include "runtime/detector/list_cap.h"

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

/* The states of triangles at the start are kept, but for components that are not proven any more: no later step or
 * check looks at them, so what is known of them would go stale. */
static void choose_never_culled(cscd_detector *d) {
    const pair_rules *rules = &d->pair_rules;
    d->all_never_culled = rules->sets != NULL;
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        bool masked = detector_masks(d, c), thick = false;
        if (rules->sets != NULL) {
            uint32_t object = rules->component_objects[c];
            thick = pair_rules_distance(rules, object, object) > 0.0;
        }
        d->never_culled[c] = masked || thick;
        d->all_never_culled &= d->never_culled[c];
        if (masked) start_states_forget_component(&d->starts, c);
    }
}

void detector_take_rules(cscd_detector *d, const pair_rules *rules) {
    pair_rules_free(d->mesh, &d->pair_rules);
    d->pair_rules = *rules;
    d->rules_revision++;
    d->space.rules = rules->sets != NULL ? &d->pair_rules : NULL;
    d->rebuild.objects = rules->sets;
    d->check.objects = rules->sets;
    d->check.component_objects = rules->component_objects;
    d->starts.never_culled = d->never_culled;
    choose_never_culled(d);
}

cscd_status detector_check_distances(cscd_detector *d, double min_separation, double greatest_of_rules) {
    if (min_separation == 0.0 || greatest_of_rules == 0.0) return CSCD_OK;
    return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                        "min_separation is %g, but the thicknesses of objects say how far apart they have to "
                        "stay; leave it at 0",
                        min_separation);
}

void detector_unmark_masked(const cscd_detector *d, bool *triangles) {
    for (uint32_t t = 0; d->pair_rules.sets != NULL && t < d->mesh->triangle_count; t++)
        triangles[t] = triangles[t] && !detector_masks(d, d->mesh->triangle_components[t]);
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
    object_set *sets = pair_rules_copy_sets(d->mesh, &d->pair_rules);
    if (sets != NULL && waiting_pairs_reserve(d->mesh, &d->waiting) == CSCD_OK) return sets;
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
    bool uncovers = live && rules_uncover(d->mesh, &d->pair_rules, &rules);
    object_set *former = uncovers ? reserve_former(d) : NULL;
    if (uncovers && former == NULL) status = CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK) status = detector_check_distances(d, d->options.min_separation, rules.greatest);
    if (status == CSCD_OK && d->space.bvh.mesh != NULL && !bvh_set_objects(&d->space.bvh, rules.sets))
        status = context_out_of_memory(d->context);
    if (status != CSCD_OK) {
        context_free(d->context, former);
        pair_rules_free(d->mesh, &rules);
        return status;
    }
    if (uncovers) waiting_pairs_uncover_objects(d->mesh, &d->waiting, former);
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

cscd_status cscd_detector_set_longest_list(cscd_detector *detector, size_t longest_list) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, list_cap_set(detector, longest_list));
}

/* ---- seams and ignored pairs --------------------------------------------------------------------------- */

/* Replaces what is left out by *next, which becomes the detector's, or is freed. What it uncovers may have to wait. */
static cscd_status replace_exclusions(cscd_detector *d, exclusions *next) {
    exclusions before = exclusions_listed(&d->exclusions);
    bool uncovers = exclusions_uncover(&before, next);
    cscd_status status = uncovers ? waiting_pairs_reserve(d->mesh, &d->waiting) : CSCD_OK;
    if (status != CSCD_OK) {
        exclusions_free(d->context, next);
        return status;
    }
    if (uncovers) waiting_pairs_uncover(d->mesh, &d->waiting, &before);
    exclusions_free(d->context, &before);
    d->exclusions = *next;
    return CSCD_OK;
}

static cscd_status set_seams(cscd_detector *d, const uint32_t *seams, size_t seam_count) {
    exclusions next;
    cscd_status status =
        exclusions_with_seams(&d->exclusions, seams, seam_count, d->options.seam_reach, &next);
    return status == CSCD_OK ? replace_exclusions(d, &next) : status;
}

/* Seams that are still to be checked go on to the exclusions that replace those of now. */
static cscd_status set_ignored(cscd_detector *d, const uint32_t *ignored, size_t ignored_count) {
    exclusions next;
    cscd_status status = exclusions_with_ignored(&d->exclusions, ignored, ignored_count, &next);
    seam_list seams = d->exclusions.seams;
    d->exclusions.seams = (seam_list){.vertices = NULL};
    if (status == CSCD_OK) status = replace_exclusions(d, &next);
    d->exclusions.seams = seams;
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
