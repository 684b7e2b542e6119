/* A detector that moves over to a mesh that was made from its own: untouched components keep what they have. */
#include "runtime/bvh/bvh.h"
#include "runtime/culling/culling.h"
#include "runtime/detector/detector.h"
#include "runtime/detector/detector_rules.h"
#include "runtime/detector/list_cap.h"
#include "runtime/narrow_phase/narrow_phase.h"

/* All that depends on the mesh is made anew in a detector beside, and exchanged when nothing can fail any more. */
typedef struct detector_move {
    cscd_detector *from, *to;
    const cscd_mesh_change *change;
} detector_move;

/* ---- culling, trees ------------------------------------------------------------------------------------ */

static const bvh *trees_of(const cscd_detector *d) {
    return d->space.bvh.mesh != NULL ? &d->space.bvh : &d->rebuild.kept;
}

static cscd_status move_trees(const detector_move *m, const region_move *regions) {
    const bvh *trees = trees_of(m->from);
    if (trees->mesh == NULL || regions->kept_count == 0) return CSCD_OK;
    const bvh_move move = {.mesh = m->to->mesh,
                           .change = m->change,
                           .regions = regions->to_new,
                           .old_region_count = regions->old_count,
                           .region_count = regions->kept_count + regions->fresh_count,
                           .fresh = regions->fresh,
                           .fresh_count = regions->fresh_count};
    return bvh_move_over(trees, &move, &m->to->rebuild.kept);
}

static cscd_status move_regions(const detector_move *m) {
    cscd_detector *d = m->to;
    region_move regions;
    cscd_status status = region_move_find(d->context, &m->from->culling, m->change, &regions);
    if (status != CSCD_OK) return status;
    status = culling_move(&m->from->culling, d->mesh, m->change, &regions, &d->culling);
    if (status == CSCD_OK) status = move_trees(m, &regions);
    region_move_free(d->context, &regions);
    return status;
}

static cscd_status move_culling(const detector_move *m) {
    cscd_detector *d = m->to;
    const cscd_status status = move_regions(m);
    if (status != CSCD_OK) return status;
    bvh kept = d->rebuild.kept;
    detector_choose_regions(d);
    d->rebuild.kept = kept;
    d->rebuild.active = d->space.active.triangles;
    d->rebuild.spread_when_built = m->from->rebuild.spread_when_built;
    d->rebuild.intervals_unmeasured = m->from->rebuild.intervals_unmeasured;
    d->rebuild.useless_rebuilds = m->from->rebuild.useless_rebuilds;
    return CSCD_OK;
}

/* ---- features ------------------------------------------------------------------------------------------ */

static cscd_status move_orphans(const detector_move *m) {
    const search_space *from = &m->from->space;
    search_space *to = &m->to->space;
    if (!from->orphans_known || !from->orphans_usable) return CSCD_OK; /* looked for when they are needed */
    bool too_many;
    cscd_status status = orphan_pairs_move(&from->orphans, to->mesh, m->change, &to->orphans, &too_many);
    if (status != CSCD_OK) return status;
    to->orphans_known = true;
    to->orphans_usable = !too_many;
    return CSCD_OK;
}

static cscd_status move_space(const detector_move *m) {
    search_space *to = &m->to->space;
    *to = (search_space){.context = m->to->context, .mesh = m->to->mesh};
    to->traversal.lane_count = m->from->space.traversal.lane_count;
    to->skipped = context_allocate(to->context, to->mesh->component_count, sizeof *to->skipped);
    if (to->skipped == NULL) return CSCD_OUT_OF_MEMORY;
    cscd_status status =
        representatives_move(&m->from->space.representatives, to->mesh, m->change, &to->representatives);
    if (status == CSCD_OK) status = loose_elements_create(to->mesh, &to->loose);
    if (status == CSCD_OK) status = active_set_move(&m->from->space.active, to->mesh, m->change, &to->active);
    return status == CSCD_OK ? move_orphans(m) : status;
}

/* ---- rules --------------------------------------------------------------------------------------------- */

static void map_rules(const detector_move *m, cscd_object_rule *rules) {
    for (uint32_t i = 0; i < m->change->objects.new_count; i++) {
        uint32_t origin = m->change->objects.to_old[i];
        rules[i] = origin != UINT32_MAX ? m->from->pair_rules.given[origin] : cscd_object_rule_default();
    }
}

/* Rules that were accepted are accepted again. */
static cscd_status move_rules(const detector_move *m) {
    cscd_detector *d = m->to;
    const pair_rules *before = &m->from->pair_rules;
    pair_rules moved = {.object_count = 0};
    if (before->sets != NULL) {
        uint32_t count = d->mesh->object_count;
        cscd_object_rule *rules = context_allocate(d->context, count, sizeof *rules);
        if (rules == NULL) return CSCD_OUT_OF_MEMORY;
        map_rules(m, rules);
        const given_rules given = {rules, count, before->matrix, before->class_count};
        cscd_status status = pair_rules_create(d->mesh, &given, &moved);
        context_free(d->context, rules);
        if (status != CSCD_OK) return status;
    }
    detector_take_rules(d, &moved);
    return CSCD_OK;
}

/* ---- all of it ------------------------------------------------------------------------------------------- */

static cscd_status move_parts(const detector_move *m) {
    const cscd_detector *from = m->from;
    cscd_detector *d = m->to;
    const left_out_before before = {from->mesh, &from->exclusions, &from->pair_rules};
    cscd_status status = exclusions_move(&from->exclusions, d->mesh, m->change, &d->exclusions);
    if (status == CSCD_OK)
        status = waiting_pairs_move(&from->waiting, &before, d->mesh, m->change, &d->waiting);
    if (status == CSCD_OK) status = move_space(m);
    if (status == CSCD_OK) status = move_culling(m);
    if (status == CSCD_OK) status = start_states_move(&from->starts, d->mesh, m->change, &d->starts);
    if (status == CSCD_OK) status = static_check_create(d->mesh, d->space.traversal.lane_count, &d->check);
    if (status == CSCD_OK) status = detector_create_baseline(d);
    if (status == CSCD_OK) status = rollback_create(d->mesh, &d->before);
    if (status == CSCD_OK) status = collapsed_create(d->mesh, &d->collapsed);
    if (status == CSCD_OK) status = edge_rest_move(d->context, &from->rest, m->change, &d->rest);
    if (status == CSCD_OK) status = part_labels_move(&from->parts, d->mesh, m->change, &d->parts);
    if (status == CSCD_OK) status = part_labels_move(&from->grouping, d->mesh, m->change, &d->grouping);
    if (status == CSCD_OK && !context_allocate_all(d->context, detector_arrays(d)))
        status = CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK) status = list_cap_set(d, from->options.longest_list);
    return status == CSCD_OK ? move_rules(m) : status;
}

#define EXCHANGE(member)                                                                                     \
    do {                                                                                                     \
        __typeof__(a->member) other = a->member;                                                             \
        a->member = b->member;                                                                               \
        b->member = other;                                                                                   \
    } while (0)

static void exchange_space(search_space *a, search_space *b) {
    EXCHANGE(mesh);
    EXCHANGE(bvh);
    EXCHANGE(representatives);
    EXCHANGE(orphans);
    EXCHANGE(loose);
    EXCHANGE(active);
    EXCHANGE(orphans_known);
    EXCHANGE(orphans_usable);
    EXCHANGE(skipped);
}

/* Lists and lanes stay where they are. */
static void exchange_parts(cscd_detector *a, cscd_detector *b) {
    exchange_space(&a->space, &b->space);
    EXCHANGE(seen);
    EXCHANGE(mesh);
    EXCHANGE(exclusions);
    EXCHANGE(waiting);
    EXCHANGE(pair_rules);
    EXCHANGE(never_culled);
    EXCHANGE(all_never_culled);
    EXCHANGE(rebuild);
    EXCHANGE(culling);
    EXCHANGE(starts);
    EXCHANGE(check);
    EXCHANGE(collapsed);
    EXCHANGE(baseline_state);
    EXCHANGE(before);
    EXCHANGE(cap);
    EXCHANGE(culled);
    EXCHANGE(closes);
    EXCHANGE(touched);
    EXCHANGE(earliest);
    EXCHANGE(kept);
    EXCHANGE(kept_by_lanes);
    EXCHANGE(incomplete);
    EXCHANGE(contacts_seen);
    EXCHANGE(guarantees);
    EXCHANGE(answers);
    EXCHANGE(parts);
    EXCHANGE(grouping);
    EXCHANGE(part_sums);
    EXCHANGE(rest);
    EXCHANGE(unpacked[0]);
    EXCHANGE(unpacked[1]);
    EXCHANGE(reached);
    EXCHANGE(reached_scalars);
    EXCHANGE(vertex_scratch);
    EXCHANGE(scalars);
    EXCHANGE(timings);
    EXCHANGE(counters);
}

/* From here on nothing fails. `to` gets what the detector had. */
static void end_move(const detector_move *m) {
    cscd_detector *d = m->from;
    bvh *trees = d->space.bvh.mesh != NULL ? &d->space.bvh : &d->rebuild.kept;
    if (trees->mesh != NULL && m->to->rebuild.kept.mesh != NULL)
        bvh_take_records(&m->to->rebuild.kept, trees);
    exchange_parts(d, m->to);
    verlet_list_free(d->context, &d->verlet);
    d->space.rules = d->pair_rules.sets != NULL ? &d->pair_rules : NULL;
    d->exclusions.waiting = &d->waiting.pairs;
    d->mesh_revision++;
    mesh_hold(d->mesh);
    mesh_release(m->to->mesh);
}

static cscd_status change_mesh(cscd_detector *d, const cscd_mesh_change *change) {
    if (!mesh_is_same(d->mesh, change->old_mesh))
        return context_fail(
            d->context, CSCD_INVALID_ARGUMENT,
            "cscd_detector_change_mesh: the change begins at another mesh than the detector's");
    detector_move m = {d, detector_allocate(d->context, change->mesh), change};
    if (m.to == NULL) return context_out_of_memory(d->context);
    detector_take_options(m.to, d);
    cscd_status status = move_parts(&m);
    if (status == CSCD_OK) end_move(&m);
    detector_free(m.to);
    return status == CSCD_OK ? CSCD_OK : context_out_of_memory(d->context);
}

cscd_status cscd_detector_change_mesh(cscd_detector *detector, const cscd_mesh_change *change) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    if (change == NULL) return context_lacks(detector->context, "cscd_detector_change_mesh", "change");
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, change_mesh(detector, change));
}
