/* Detectors that are made from another one: one that moves over to a mesh that was made from its own, where untouched
 * components keep what they have; and a clone, a second one on the same mesh, which knows what the first one knows. */
#include "runtime/bvh/bvh.h"
#include "runtime/detector/detector.h"

#include <string.h>

/* ==== another mesh ========================================================================================= */

/* A second detector gets all that depends on the mesh, and the two exchange it when nothing can fail any more. */
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
    cscd_status status = region_move_find(d->context, &m->from->interval.culling, m->change, &regions);
    if (status != CSCD_OK) return status;
    status = culling_move(&m->from->interval.culling, d->mesh, m->change, &regions, &d->interval.culling);
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
    to->traversal.worker_count = m->from->space.traversal.worker_count;
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
        rules[i] =
            origin != UINT32_MAX ? m->from->config.pair_rules.given[origin] : cscd_object_rule_default();
    }
}

/* Rules that were accepted are accepted again. */
static cscd_status move_rules(const detector_move *m) {
    cscd_detector *d = m->to;
    const pair_rules *before = &m->from->config.pair_rules;
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
    const left_out_before before = {from->mesh, &from->config.exclusions, &from->config.pair_rules};
    cscd_status status = exclusions_move(&from->config.exclusions, d->mesh, m->change, &d->config.exclusions);
    if (status == CSCD_OK)
        status = waiting_pairs_move(&from->config.waiting, &before, d->mesh, m->change, &d->config.waiting);
    if (status == CSCD_OK) status = move_space(m);
    if (status == CSCD_OK) status = move_culling(m);
    if (status == CSCD_OK)
        status = start_states_move(&from->known.starts, d->mesh, m->change, &d->known.starts);
    if (status == CSCD_OK)
        status = static_check_create(d->mesh, d->space.traversal.worker_count, &d->known.check);
    if (status == CSCD_OK) status = detector_create_baseline(d);
    if (status == CSCD_OK) status = rollback_create(d->mesh, &d->known.before);
    if (status == CSCD_OK) status = collapsed_create(d->mesh, &d->known.collapsed);
    if (status == CSCD_OK) status = rest_shape_move(&from->config.rest, d->mesh, m->change, &d->config.rest);
    if (status == CSCD_OK)
        status = part_labels_move(&from->config.parts, d->mesh, m->change, &d->config.parts);
    if (status == CSCD_OK)
        status = part_labels_move(&from->config.grouping, d->mesh, m->change, &d->config.grouping);
    if (status == CSCD_OK && !context_allocate_all(d->context, detector_arrays(d)))
        status = CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK) status = detector_set_longest_list(d, from->config.options.longest_list);
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

/* Lists and workers stay where they are. */
static void exchange_parts(cscd_detector *a, cscd_detector *b) {
    exchange_space(&a->space, &b->space);
    EXCHANGE(seen);
    EXCHANGE(mesh);
    EXCHANGE(config.exclusions);
    EXCHANGE(config.waiting);
    EXCHANGE(config.pair_rules);
    EXCHANGE(config.never_culled);
    EXCHANGE(config.all_never_culled);
    EXCHANGE(rebuild);
    EXCHANGE(interval.culling);
    EXCHANGE(known.starts);
    EXCHANGE(known.check);
    EXCHANGE(known.collapsed);
    EXCHANGE(config.baseline_state);
    EXCHANGE(known.before);
    EXCHANGE(interval.cap);
    EXCHANGE(interval.culled);
    EXCHANGE(interval.closes);
    EXCHANGE(interval.touched);
    EXCHANGE(interval.earliest);
    EXCHANGE(interval.kept);
    EXCHANGE(interval.kept_by_workers);
    EXCHANGE(interval.incomplete);
    EXCHANGE(interval.contacts_seen);
    EXCHANGE(results.guarantees);
    EXCHANGE(results.answers);
    EXCHANGE(config.parts);
    EXCHANGE(config.grouping);
    EXCHANGE(results.part_sums);
    EXCHANGE(config.rest);
    EXCHANGE(unpacked[0]);
    EXCHANGE(unpacked[1]);
    EXCHANGE(reached);
    EXCHANGE(reached_scalars);
    EXCHANGE(vertex_scratch);
    EXCHANGE(scalars);
    EXCHANGE(response.vertices);
    EXCHANGE(response.focus);
    EXCHANGE(results.timings);
    EXCHANGE(results.counters);
}

/* From here on nothing fails. `to` gets what the detector had. */
static void end_move(const detector_move *m) {
    cscd_detector *d = m->from;
    bvh *trees = d->space.bvh.mesh != NULL ? &d->space.bvh : &d->rebuild.kept;
    if (trees->mesh != NULL && m->to->rebuild.kept.mesh != NULL)
        bvh_take_records(&m->to->rebuild.kept, trees);
    exchange_parts(d, m->to);
    verlet_list_free(d->context, &d->known.verlet);
    d->space.rules = d->config.pair_rules.sets != NULL ? &d->config.pair_rules : NULL;
    d->config.exclusions.waiting = &d->config.waiting.pairs;
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

/* ==== a clone ============================================================================================== */

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

/* Workers are as many as the context has threads, and hold nothing between calls. */
static cscd_status clone_space(const search_space *from, const cscd_mesh *mesh, search_space *to) {
    cscd_context *context = mesh->context;
    *to = (search_space){.context = context, .mesh = mesh, .moves_from = from->moves_from};
    cscd_status status = traversal_create(context, &to->traversal);
    if (status != CSCD_OK) return status;
    to->workers = context_allocate(context, to->traversal.worker_count, sizeof *to->workers);
    to->skipped = context_allocate(context, mesh->component_count, sizeof *to->skipped);
    if (to->workers == NULL || to->skipped == NULL) return CSCD_OUT_OF_MEMORY;
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
    memcpy(d->config.never_culled, from->config.never_culled, components * sizeof *d->config.never_culled);
    memcpy(d->results.guarantees, from->results.guarantees, components * sizeof *d->results.guarantees);
    d->config.all_never_culled = from->config.all_never_culled;
    d->interval.intervals = from->interval.intervals;
    return CSCD_OK;
}

static void join_rules(cscd_detector *d) {
    d->space.rules = d->config.pair_rules.sets != NULL ? &d->config.pair_rules : NULL;
    d->rebuild.objects = d->config.pair_rules.sets;
    d->known.check.objects = d->config.pair_rules.sets;
    d->known.check.component_objects = d->config.pair_rules.component_objects;
    d->known.starts.never_culled = d->config.never_culled;
}

/* The new detector says of the last moment what the old one said. */
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
    cscd_status status = exclusions_copy(&from->config.exclusions, mesh, &d->config.exclusions);
    if (status == CSCD_OK) status = waiting_pairs_copy(&from->config.waiting, mesh, &d->config.waiting);
    if (status == CSCD_OK) d->config.exclusions.waiting = &d->config.waiting.pairs;
    if (status == CSCD_OK) status = clone_space(&from->space, mesh, &d->space);
    if (status == CSCD_OK) status = clone_culling(&from->interval.culling, mesh, &d->interval.culling);
    if (status == CSCD_OK) status = clone_trees(&from->rebuild, d);
    if (status == CSCD_OK) status = clone_starts(&from->known.starts, mesh, &d->known.starts);
    if (status == CSCD_OK)
        status = static_check_create(mesh, d->space.traversal.worker_count, &d->known.check);
    if (status == CSCD_OK) status = detector_create_baseline(d);
    if (status == CSCD_OK) status = rollback_create(mesh, &d->known.before);
    if (status == CSCD_OK) status = clone_collapsed(&from->known.collapsed, mesh, &d->known.collapsed);
    if (status == CSCD_OK) status = pair_rules_copy(&from->config.pair_rules, mesh, &d->config.pair_rules);
    if (status == CSCD_OK) status = rest_shape_copy(&from->config.rest, mesh, &d->config.rest);
    if (status == CSCD_OK) status = part_labels_copy(&from->config.parts, mesh, &d->config.parts);
    if (status == CSCD_OK) status = part_labels_copy(&from->config.grouping, mesh, &d->config.grouping);
    if (status == CSCD_OK) status = clone_lists(from, d);
    if (status == CSCD_OK) join_rules(d);
    if (status == CSCD_OK) status = detector_set_longest_list(d, from->config.options.longest_list);
    return status;
}

/* ---- all of it --------------------------------------------------------------------------------------------- */

static cscd_status clone_detector(cscd_context *context, const cscd_detector *from, cscd_detector **out) {
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_clone: out is NULL");
    cscd_detector *d = detector_begin(context, from->mesh);
    if (d == NULL) return context_out_of_memory(context);
    detector_take_options(d, from);
    d->results.timings = from->results.timings;
    d->results.counters = from->results.counters;
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
