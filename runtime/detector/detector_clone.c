/* A second detector on the same mesh, which knows what the first one knows: everything is copied, nothing is built. */
#include "runtime/bvh/bvh.h"
#include "runtime/detector/detector.h"
#include "runtime/detector/list_cap.h"
#include "runtime/narrow_phase/narrow_phase.h"

#include <string.h>

/* ---- parts ----------------------------------------------------------------------------------------------- */

static cscd_status clone_culling(const culling *c, const cscd_mesh *mesh, culling *out) {
    culling copy = *c;
    copy.context = mesh->context;
    copy.mesh = mesh;
    if (!context_copy_all(mesh->context, culling_arrays(&copy))) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}

static cscd_status clone_starts(const start_states *s, const cscd_mesh *mesh, start_states *out) {
    start_states copy = *s;
    copy.context = mesh->context;
    copy.mesh = mesh;
    if (!context_copy_all(mesh->context, start_states_arrays(&copy))) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}

/* Lanes are as many as the context has threads, and hold nothing between calls. */
static cscd_status clone_space(const search_space *from, const cscd_mesh *mesh, search_space *to) {
    cscd_context *context = mesh->context;
    *to = (search_space){.context = context, .mesh = mesh, .moves_from = from->moves_from};
    cscd_status status = traversal_create(context, &to->traversal);
    if (status != CSCD_OK) return status;
    to->lanes = context_allocate(context, to->traversal.lane_count, sizeof *to->lanes);
    to->skipped = context_allocate(context, mesh->component_count, sizeof *to->skipped);
    if (to->lanes == NULL || to->skipped == NULL) return CSCD_OUT_OF_MEMORY;
    status = representatives_copy(&from->representatives, mesh, &to->representatives);
    if (status == CSCD_OK) status = loose_elements_create(mesh, &to->loose);
    if (status == CSCD_OK) status = active_set_copy(&from->active, mesh, &to->active);
    if (status == CSCD_OK) status = orphan_pairs_copy(&from->orphans, context, &to->orphans);
    if (status == CSCD_OK) to->orphans_known = from->orphans_known;
    if (status == CSCD_OK) to->orphans_usable = from->orphans_usable;
    if (status == CSCD_OK && from->bvh.mesh != NULL) status = bvh_copy(&from->bvh, mesh, &to->bvh);
    return status;
}

static cscd_status clone_trees(const bvh_rebuild *from, cscd_detector *d) {
    detector_choose_regions(d);
    d->rebuild.active = d->space.active.triangles;
    d->rebuild.spread_when_built = from->spread_when_built;
    d->rebuild.intervals_unmeasured = from->intervals_unmeasured;
    d->rebuild.useless_rebuilds = from->useless_rebuilds;
    return from->kept.mesh != NULL ? bvh_copy(&from->kept, d->mesh, &d->rebuild.kept) : CSCD_OK;
}

static cscd_status clone_lists(const cscd_detector *from, cscd_detector *d) {
    size_t components = d->mesh->component_count;
    if (!context_allocate_all(d->context, detector_arrays(d))) return CSCD_OUT_OF_MEMORY;
    memcpy(d->never_culled, from->never_culled, components * sizeof *d->never_culled);
    memcpy(d->guarantees, from->guarantees, components * sizeof *d->guarantees);
    d->all_never_culled = from->all_never_culled;
    d->intervals = from->intervals;
    return CSCD_OK;
}

static void join_rules(cscd_detector *d) {
    d->space.rules = d->pair_rules.sets != NULL ? &d->pair_rules : NULL;
    d->rebuild.objects = d->pair_rules.sets;
    d->check.objects = d->pair_rules.sets;
    d->check.component_objects = d->pair_rules.component_objects;
    d->starts.never_culled = d->never_culled;
}

/* What was said of the last moment is said of it again. */
static cscd_status clone_collapsed(const collapsed_components *from, const cscd_mesh *mesh,
                                   collapsed_components *to) {
    cscd_status status = collapsed_create(mesh, to);
    if (status != CSCD_OK) return status;
    memcpy(to->marks, from->marks, mesh->component_count * sizeof *to->marks);
    to->count = from->count;
    return CSCD_OK;
}

static cscd_status clone_parts(const cscd_detector *from, cscd_detector *d) {
    const cscd_mesh *mesh = d->mesh;
    cscd_status status = exclusions_copy(&from->exclusions, mesh, &d->exclusions);
    if (status == CSCD_OK) status = waiting_pairs_copy(&from->waiting, mesh, &d->waiting);
    if (status == CSCD_OK) d->exclusions.waiting = &d->waiting.pairs;
    if (status == CSCD_OK) status = clone_space(&from->space, mesh, &d->space);
    if (status == CSCD_OK) status = clone_culling(&from->culling, mesh, &d->culling);
    if (status == CSCD_OK) status = clone_trees(&from->rebuild, d);
    if (status == CSCD_OK) status = clone_starts(&from->starts, mesh, &d->starts);
    if (status == CSCD_OK) status = static_check_create(mesh, d->space.traversal.lane_count, &d->check);
    if (status == CSCD_OK) status = detector_create_baseline(d);
    if (status == CSCD_OK) status = rollback_create(mesh, &d->before);
    if (status == CSCD_OK) status = clone_collapsed(&from->collapsed, mesh, &d->collapsed);
    if (status == CSCD_OK) status = pair_rules_copy(&from->pair_rules, mesh, &d->pair_rules);
    if (status == CSCD_OK) status = edge_rest_copy(&from->rest, mesh, &d->rest);
    if (status == CSCD_OK) status = part_labels_copy(&from->parts, mesh, &d->parts);
    if (status == CSCD_OK) status = part_labels_copy(&from->grouping, mesh, &d->grouping);
    if (status == CSCD_OK) status = clone_lists(from, d);
    if (status == CSCD_OK) join_rules(d);
    if (status == CSCD_OK) status = list_cap_set(d, from->options.longest_list);
    return status;
}

/* ---- all of it --------------------------------------------------------------------------------------------- */

static cscd_status clone_detector(cscd_context *context, const cscd_detector *from, cscd_detector **out) {
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_clone: out is NULL");
    cscd_detector *d = detector_begin(context, from->mesh);
    if (d == NULL) return context_out_of_memory(context);
    detector_take_options(d, from);
    d->timings = from->timings;
    d->counters = from->counters;
    if (clone_parts(from, d) != CSCD_OK) {
        cscd_detector_destroy(d);
        return context_out_of_memory(context);
    }
    detector_list(d);
    *out = d;
    return CSCD_OK;
}

/* The first detector must not change meanwhile, so its context is entered, too. */
static cscd_status clone_from(cscd_context *context, const cscd_detector *from, cscd_detector **out) {
    if (from->context == context) return clone_detector(context, from, out);
    context_entry entry;
    if (!object_enter(from, &entry)) return entry.status;
    return context_leave(&entry, clone_detector(context, from, out));
}

cscd_status cscd_detector_clone(cscd_context *context, const cscd_detector *detector, cscd_detector **out) {
    if (context == NULL || detector == NULL) return context_lacks(context, "cscd_detector_clone", "detector");
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, clone_from(context, detector, out));
}
