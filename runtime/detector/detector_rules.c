/* The rules for objects on a live detector: who is looked at with whom, and how far apart they have to stay. */
#include "runtime/detector/detector_rules.h"

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

/* From here on nothing fails. */
static void take_rules(cscd_detector *d, const pair_rules *rules) {
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

cscd_status detector_set_rules(cscd_detector *d, const given_rules *given) {
    pair_rules rules;
    cscd_status status = pair_rules_create(d->mesh, given, &rules);
    if (status != CSCD_OK) return status;
    if (all_neutral(given)) pair_rules_free(d->mesh, &rules);
    status = detector_check_distances(d, d->options.min_separation, rules.greatest);
    if (status == CSCD_OK && d->space.bvh.mesh != NULL && !bvh_set_objects(&d->space.bvh, rules.sets))
        status = context_out_of_memory(d->context);
    if (status != CSCD_OK) {
        pair_rules_free(d->mesh, &rules);
        return status;
    }
    take_rules(d, &rules);
    return CSCD_OK;
}

cscd_status cscd_detector_set_rules(cscd_detector *detector, const cscd_object_rule *rules,
                                    uint32_t rule_count, const double *thickness_matrix,
                                    uint32_t thickness_class_count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    const given_rules given = {rules, rule_count, thickness_matrix, thickness_class_count};
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, detector_set_rules(detector, &given));
}
