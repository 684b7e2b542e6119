/* The data that the searches of a detector work with and keep: trees, lanes, and which triangle pair tests which
 * features. */
#include "runtime/detector/search_space.h"

cscd_status search_space_create(const cscd_mesh *mesh, search_space *out) {
    search_space s = {.context = mesh->context, .mesh = mesh, .moves_from = LONG_LIST};
    cscd_status status = traversal_create(s.context, &s.traversal);
    if (status == CSCD_OK) status = representatives_create(mesh, &s.representatives);
    if (status == CSCD_OK) status = loose_elements_create(mesh, &s.loose);
    if (status == CSCD_OK) {
        s.lanes = context_allocate(s.context, s.traversal.lane_count, sizeof *s.lanes);
        s.skipped = context_allocate(s.context, mesh->component_count, sizeof *s.skipped);
        if (s.lanes == NULL || s.skipped == NULL) status = CSCD_OUT_OF_MEMORY;
    }
    if (status != CSCD_OK) {
        search_space_destroy(&s);
        return status;
    }
    *out = s;
    return CSCD_OK;
}

static void free_lanes(search_space *s) {
    for (uint32_t i = 0; s->lanes != NULL && i < s->traversal.lane_count; i++) {
        contact_lane_free(s->context, &s->lanes[i]);
        context_free(s->context, s->lanes[i].candidates[CSCD_CONTACT_VF].pairs);
        context_free(s->context, s->lanes[i].candidates[CSCD_CONTACT_EE].pairs);
    }
    context_free(s->context, s->lanes);
}

void search_space_destroy(search_space *s) {
    if (s->context == NULL) return;
    free_lanes(s);
    if (s->traversal.lanes != NULL) traversal_destroy(&s->traversal);
    bvh_free(&s->bvh);
    active_set_free(s->context, &s->active);
    representatives_free(s->context, &s->representatives);
    orphan_pairs_free(s->context, &s->orphans);
    loose_elements_destroy(&s->loose);
    context_free(s->context, s->skipped);
    *s = (search_space){.context = NULL};
}

cscd_status search_space_status(const search_space *s) {
    for (uint32_t i = 0; i < s->traversal.lane_count; i++) {
        if (s->lanes[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
    }
    return CSCD_OK;
}

bool search_space_found_any(const search_space *s) {
    for (uint32_t i = 0; i < s->traversal.lane_count; i++) {
        if (s->lanes[i].count > 0) return true;
    }
    return false;
}
