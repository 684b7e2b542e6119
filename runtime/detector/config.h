/* The configuration of a detector: its options, and all that follows from them. */
#pragma once

#include "cscd/research.h"
#include "runtime/culling/culling.h"
#include "runtime/detector/rest_shape.h"
#include "runtime/detector/search.h"
#include "runtime/narrow_phase/narrow_phase.h"
#include "src/core/names.h"
#include "src/mesh/parts.h"

/* A method's way through the pipeline. */
typedef struct method_stages {
    cscd_method method;
    const culling_rules *rules; /* NULL: this build does not have the method */
    const pair_hider *hider;    /* NULL: no pairs are hidden */
    const own_search *search;   /* in place of the trees and tests of a step; NULL: those of a step */
    bool brute_force;           /* tests every pair of features, without trees */
    uint64_t ours;              /* the bits that cscd_detector_options.ours may have */
} method_stages;

/* Returns the row of a method; every method has one. */
const method_stages *method_stages_of(cscd_method method);

typedef struct detector_config {
    cscd_detector_options options;
    separation limit; /* of the options, with the default tolerance filled in */
    const method_traits *traits;
    const method_stages *stages;
    void *baseline_state; /* of stages->hider or stages->search */
    culling_rules rules;
    exclusions exclusions; /* its waiting pairs are those of the next member */
    waiting_pairs waiting;

    pair_rules pair_rules;   /* for objects; without sets: there are none */
    uint32_t rules_revision; /* grows whenever they, or the active vertices, are set */
    /* Per component: its triangles are not looked at with each other, or have to stay farther apart than 0. */
    bool *never_culled;
    bool all_never_culled;

    part_labels parts;    /* see cscd_detector_set_parts */
    part_labels grouping; /* see cscd_detector_set_bodies */
    rest_shape rest;      /* see cscd_detector_set_rest */
    size_t memory_most;   /* what answers may take, where the caller does not say; 0: not known yet */
} detector_config;

/* The labels of what belongs together: cscd_detector_set_bodies, or else the parts. */
static inline const part_labels *config_grouping(const detector_config *c) {
    return c->grouping.triangles != NULL ? &c->grouping : &c->parts;
}

/* True if nothing says what belongs together in the only object. */
static inline bool config_bodies_are_components(const detector_config *c, const cscd_mesh *mesh) {
    return config_grouping(c)->triangles == NULL && mesh->object_count == 1;
}

/* True if the rules say distances. */
static inline bool config_is_thick(const detector_config *c) {
    return c->pair_rules.greatest > 0.0;
}

/* True if triangles of a component are not looked at with each other, because the rule of its object says so. */
static inline bool config_masks(const detector_config *c, const cscd_mesh *mesh, uint32_t component) {
    if (c->pair_rules.sets == NULL || component_is_obstacle(mesh, component)) return false;
    return !c->pair_rules.sets[c->pair_rules.component_objects[component]].self;
}

/* True if the method's own search finds the contacts. It knows touching only. */
static inline bool config_searches_alone(const detector_config *c) {
    return c->stages->search != NULL && c->limit.distance == 0.0 && c->pair_rules.greatest == 0.0;
}

/* True if pairs are culled by orientation: not with a minimum separation; nor, in a component, with a distance from
 * itself. */
static inline bool config_culls(const detector_config *c) {
    const bool knows_how = c->stages->search == NULL || config_searches_alone(c);
    return c->rules.by_orientation && knows_how && c->limit.distance == 0.0 && !c->all_never_culled;
}

/* True if the method's hider hides pairs within a component. */
static inline bool config_hides_pairs(const detector_config *c) {
    return c->stages->hider != NULL && c->limit.distance == 0.0 && c->pair_rules.greatest_to_itself == 0.0;
}

/* The greatest distance that a pair may have to keep. */
static inline double config_greatest_separation(const detector_config *c) {
    return c->limit.distance > c->pair_rules.greatest ? c->limit.distance : c->pair_rules.greatest;
}

/* The widening of a step's volumes. */
static inline volume_growth config_growth(const detector_config *c) {
    return (volume_growth){c->limit.distance, config_is_thick(c) ? c->pair_rules.reaches : NULL, 0.0};
}

/* Begins a search for what comes nearer than it may, from x0 to x1. */
static inline interval_search config_search_begin(const detector_config *c, search_space *space,
                                                  const double *x0, const double *x1) {
    interval_search search = interval_search_begin(space, x0, x1, c->limit);
    search.interval.thick = config_is_thick(c);
    search.interval.tolerance = c->options.tolerance;
    return search;
}
