/* The tracker of the public API: options, frames, and events that have ended. */
#include "runtime/events/events.h"
#include "src/core/least_sizes.h"
#include "src/core/sort.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

struct cscd_event_tracker {
    reference_count references;
    cscd_context *context;
    cscd_mesh mesh; /* as objects of the context see it */
    part_labels parts;
    mesh_rings rings;

    event_history history;
    frame_groups groups;
    size_t max_memory; /* of a frame */

    /* Contacts of the interval that ends in the next frame. */
    tracked_contact *contacts;
    size_t contact_count, contact_capacity;

    /* Memory of what was given out last. */
    cscd_event *given;
    tracked_event *spare_closed; /* for sorting */
    size_t given_capacity;
};

static const cscd_event_options default_options = {.struct_size = sizeof default_options, .rings = 2};

void cscd_event_defaults_sized(cscd_event_options *out, size_t size) {
    struct_give_options(out, size, &default_options, sizeof default_options);
}

/* ---- options -------------------------------------------------------------------------------------------- */

static cscd_status check_seams(const cscd_mesh *mesh, const cscd_event_options *options) {
    if (options->seams == NULL && options->seam_count > 0)
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT, "seams is NULL, but there are to be %zu",
                            options->seam_count);
    for (size_t i = 0; i < 2 * options->seam_count; i++) {
        if (options->seams[i] < mesh->vertex_count) continue;
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                            "pair %zu of seams names vertex %u, but the mesh has %u", i / 2,
                            options->seams[i], mesh->vertex_count);
    }
    return CSCD_OK;
}

static cscd_status check_options(const cscd_mesh *mesh, const cscd_event_options *options) {
    cscd_status status = part_labels_check(mesh, options->labels, options->part_count, "cscd_event_options");
    if (status == CSCD_OK) status = check_seams(mesh, options);
    uint64_t elements = (uint64_t)mesh->triangle_count + mesh->vertex_count;
    if (status == CSCD_OK && options->rings == 0 && elements > UINT32_MAX)
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                            "rings is 0, but the mesh has more than 2^32 vertices and triangles together; "
                            "set rings to 1 or more");
    return status;
}

/* ---- creation ------------------------------------------------------------------------------------------- */

static void free_memory(cscd_event_tracker *t) {
    cscd_context *context = t->context;
    part_labels_free(context, &t->parts);
    mesh_rings_free(context, &t->rings);
    event_history_free(context, &t->history);
    frame_groups_free(context, &t->groups);
    context_free(context, t->contacts);
    context_free(context, t->given);
    context_free(context, t->spare_closed);
    context_free(context, t);
}

static void free_tracker(reference_count *references) {
    cscd_event_tracker *t = (cscd_event_tracker *)references;
    cscd_context *context = t->context;
    cscd_mesh mesh = t->mesh;
    free_memory(t);
    mesh_release(&mesh);
    context_release(context);
}

static const char *validate_listed(const reference_count *object) {
    const cscd_event_tracker *t = (const cscd_event_tracker *)object;
    const event_history *h = &t->history;
    size_t open = 0;
    for (size_t e = 0; e < h->event_count; e++) {
        if (h->parents[e] != NO_EVENT && h->parents[e] >= h->event_count)
            return "an event of a tracker became one that there is not";
        open += h->parents[e] == e;
    }
    if (open != h->open_count) return "a tracker has not counted its open events";
    return part_labels_validate(&t->parts, &t->mesh);
}

static cscd_status create_parts(cscd_event_tracker *t, const cscd_event_options *options) {
    t->history.gap = options->gap;
    cscd_status status = part_labels_set(&t->mesh, options->labels, options->part_count, &t->parts);
    return status == CSCD_OK
               ? mesh_rings_create(&t->mesh, options->rings, options->seams, options->seam_count, &t->rings)
               : status;
}

static cscd_status create_tracker(cscd_context *context, const cscd_mesh *mesh,
                                  const cscd_event_options *options, cscd_event_tracker **out) {
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_event_tracker_create: out is NULL");
    cscd_event_options chosen = default_options;
    cscd_mesh seen = mesh_seen_from(context, mesh);
    cscd_status status = CSCD_OK;
    if (options != NULL)
        status = struct_take_options(context, &chosen, sizeof chosen, LEAST_SIZE(cscd_event_options), options,
                                     "cscd_event_defaults");
    if (status == CSCD_OK) status = check_options(&seen, &chosen);
    if (status != CSCD_OK) return status;

    cscd_event_tracker *t = context_allocate(context, 1, sizeof *t);
    if (t == NULL) return context_out_of_memory(context);
    t->context = context;
    t->mesh = seen;
    t->max_memory = chosen.max_memory > 0 ? chosen.max_memory : memory_share();
    mesh_hold(mesh);
    context_add_object(context, &t->references, free_tracker);
    if (create_parts(t, &chosen) != CSCD_OK) {
        cscd_event_tracker_destroy(t);
        return context_out_of_memory(context);
    }
    context_list_object(context, &t->references, validate_listed);
    *out = t;
    return CSCD_OK;
}

cscd_status cscd_event_tracker_create(cscd_context *context, const cscd_mesh *mesh,
                                      const cscd_event_options *options, cscd_event_tracker **out) {
    if (context == NULL || mesh == NULL) return context_lacks(context, "cscd_event_tracker_create", "mesh");
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, create_tracker(context, mesh, options, out));
}

void cscd_event_tracker_destroy(cscd_event_tracker *t) {
    if (t != NULL) context_destroy_object(t->context, &t->references);
}

/* ---- what a frame is given, from anywhere ------------------------------------------------------------------ */

static cscd_status check_pairs(const cscd_mesh *mesh, const cscd_intersections *found) {
    if (found->items == NULL && found->count > 0)
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                            "found counts %zu pairs but has no list; ask for CSCD_ANSWER_LIST", found->count);
    for (size_t i = 0; i < found->count; i++) {
        const cscd_intersection *pair = &found->items[i];
        if (pair->a < mesh->triangle_count && pair->b < mesh->triangle_count && (unsigned)pair->kind < 64)
            continue;
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                            "pair %zu (kind %d, triangles %u and %u) is not of the tracker's mesh", i,
                            (int)pair->kind, pair->a, pair->b);
    }
    return CSCD_OK;
}

static bool piece_fits(const cscd_mesh *mesh, const cscd_curves *curves, const cscd_curve *curve, size_t i) {
    const cscd_curve_piece *piece = &curves->pieces[curve->first_piece + i];
    return piece->a < mesh->triangle_count && piece->b < mesh->triangle_count &&
           isfinite(curve_piece_length(curves, curve, i));
}

static bool range_fits(size_t first, size_t count, size_t all) {
    return first <= all && count <= all - first;
}

static bool curve_fits(const cscd_mesh *mesh, const cscd_curves *curves, const cscd_curve *curve) {
    if (!range_fits(curve->first_point, curve->point_count, curves->point_count) ||
        !range_fits(curve->first_piece, curve->piece_count, curves->piece_count) ||
        curve->point_count < curve->piece_count || (curve->piece_count > 0 && curve->point_count == 0))
        return false;
    for (size_t i = 0; i < curve->piece_count; i++) {
        if (!piece_fits(mesh, curves, curve, i)) return false;
    }
    return true;
}

static cscd_status check_curves(const cscd_mesh *mesh, const cscd_curves *curves) {
    for (size_t i = 0; curves != NULL && i < curves->count; i++) {
        if (curve_fits(mesh, curves, &curves->items[i])) continue;
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT, "curve %zu is not of the tracker's mesh",
                            i);
    }
    return CSCD_OK;
}

static bool depth_fits(const cscd_mesh *mesh, const cscd_depth *depth) {
    bool has_vertex = depth->vertex < mesh->vertex_count || depth->vertex == UINT32_MAX;
    bool has_edge = depth->edge < mesh->edge_count || depth->edge == UINT32_MAX;
    return has_vertex && has_edge && depth->face < mesh->triangle_count &&
           depth->triangle < mesh->triangle_count && depth->depth >= 0.0 && isfinite(depth->depth);
}

static cscd_status check_depths(const cscd_mesh *mesh, const cscd_depths *depths) {
    for (size_t i = 0; depths != NULL && i < depths->count; i++) {
        if (depth_fits(mesh, &depths->items[i])) continue;
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT, "depth %zu is not of the tracker's mesh",
                            i);
    }
    return CSCD_OK;
}

static cscd_status check_input(const cscd_mesh *mesh, const cscd_intersections *found) {
    if (found == NULL) return CSCD_OK;
    cscd_status status = check_pairs(mesh, found);
    if (status == CSCD_OK) status = check_curves(mesh, found->curves);
    return status == CSCD_OK ? check_depths(mesh, found->depths) : status;
}

/* ---- frames --------------------------------------------------------------------------------------------- */

static cscd_status add_contacts(cscd_event_tracker *t, const cscd_contact *contacts, size_t count) {
    cscd_status status =
        given_contacts_check(t->context, &t->mesh, "cscd_event_tracker_add_contacts", contacts, count);
    if (status != CSCD_OK || count == 0) return status;
    size_t before = t->contact_count;
    if (count > t->contact_capacity - before) {
        size_t capacity = room_with_spare(before + count);
        tracked_contact *grown = context_reserve(t->context, capacity, sizeof *grown);
        if (grown == NULL) return context_out_of_memory(t->context);
        if (before > 0) memcpy(grown, t->contacts, before * sizeof *grown);
        context_free(t->context, t->contacts);
        t->contacts = grown;
        t->contact_capacity = capacity;
    }
    for (size_t i = 0; i < count; i++) {
        const cscd_contact *c = &contacts[i];
        t->contacts[before + i] = (tracked_contact){.toi = c->toi,
                                                    .point = {c->point[0], c->point[1], c->point[2]},
                                                    .a = c->a,
                                                    .b = c->b,
                                                    .kind = c->kind};
    }
    t->contact_count += count;
    return CSCD_OK;
}

cscd_status cscd_event_tracker_add_contacts(cscd_event_tracker *tracker, const cscd_contact *contacts,
                                            size_t contact_count) {
    if (tracker == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(tracker, &entry)) return entry.status;
    return context_leave(&entry, add_contacts(tracker, contacts, contact_count));
}

static cscd_status check_frame(cscd_event_tracker *t, uint64_t frame, const cscd_intersections *found) {
    const event_history *h = &t->history;
    if (h->frame_count > 0 && frame <= h->last_frame)
        return context_fail(t->context, CSCD_INVALID_ARGUMENT,
                            "frame %llu does not come after frame %llu; frames go in by ascending numbers",
                            (unsigned long long)frame, (unsigned long long)h->last_frame);
    return found != NULL ? check_input(&t->mesh, found) : CSCD_OK;
}

static cscd_status append_frame(cscd_event_tracker *t, const frame_input *input) {
    frame_row row;
    cscd_status status = frame_groups_find(&t->groups, &t->mesh, &t->parts, &t->rings, input, &row);
    if (status == CSCD_OK) status = event_history_append(t->context, &t->history, &t->rings, &row);
    if (status == CSCD_OK) t->contact_count = 0;
    return status;
}

static void drop_contacts(cscd_event_tracker *t) {
    context_free(t->context, t->contacts);
    t->contacts = NULL;
    t->contact_count = t->contact_capacity = 0;
}

/* The findings of the frame do not fit: it counts as one in which nothing was looked for. */
static cscd_status append_nothing(cscd_event_tracker *t, const frame_input *input, size_t wanted) {
    const size_t contacts = input->contact_count, pairs = input->found != NULL ? input->found->count : 0;
    const frame_input nothing = {.frame = input->frame};
    frame_groups_free(t->context, &t->groups);
    const cscd_status status = append_frame(t, &nothing);
    if (status != CSCD_OK) return context_explain(t->context, status);
    drop_contacts(t);
    return context_fail(
        t->context, CSCD_LIST_TOO_LONG,
        "events of %zu pairs and %zu contacts would take more than max_memory, which is %zu bytes (%zu "
        "or more), so none has anything of this frame",
        pairs, contacts, t->max_memory, wanted);
}

static cscd_status add_frame(cscd_event_tracker *t, uint64_t frame, const cscd_intersections *found) {
    cscd_status status = check_frame(t, frame, found);
    if (status != CSCD_OK) return status;
    memory_budget budget = {.most = t->max_memory};
    const frame_input input = {found, t->contacts, t->contact_count, frame, &budget};
    status = append_frame(t, &input);
    if (status != CSCD_OUT_OF_MEMORY || !budget.exceeded) return context_explain(t->context, status);
    return append_nothing(t, &input, budget.wanted);
}

cscd_status cscd_event_tracker_add_frame(cscd_event_tracker *tracker, uint64_t frame,
                                         const cscd_intersections *found) {
    if (tracker == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(tracker, &entry)) return entry.status;
    return context_leave(&entry, add_frame(tracker, frame, found));
}

/* ---- events that have ended ----------------------------------------------------------------------------- */

static bool reserve_given(cscd_event_tracker *t, size_t count) {
    const array_list list = {
        {ARRAY(t->given, room_with_spare(count)), ARRAY(t->spare_closed, room_with_spare(count))}};
    return context_renew_all(t->context, list, &t->given_capacity, count);
}

/* There is room. */
static cscd_events give_closed(cscd_event_tracker *t) {
    event_history *h = &t->history;
    sort_items(h->closed, t->spare_closed, h->closed_count, sizeof *h->closed, tracked_event_compare);
    for (size_t i = 0; i < h->closed_count; i++) t->given[i] = tracked_event_describe(&h->closed[i]);
    const cscd_events events = {t->given, h->closed_count, h->open_count};
    h->closed_count = 0;
    return events;
}

static cscd_status take_events(cscd_event_tracker *t, cscd_events *out) {
    if (out == NULL)
        return context_fail(t->context, CSCD_INVALID_ARGUMENT, "cscd_event_tracker_take: out is NULL");
    if (!reserve_given(t, t->history.closed_count)) return context_out_of_memory(t->context);
    const cscd_events events = give_closed(t);
    *out = events;
    return CSCD_OK;
}

cscd_status cscd_event_tracker_take(cscd_event_tracker *tracker, cscd_events *out) {
    if (tracker == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(tracker, &entry)) return entry.status;
    return context_leave(&entry, take_events(tracker, out));
}

static cscd_status finish_events(cscd_event_tracker *t, cscd_events *out) {
    event_history *h = &t->history;
    if (out == NULL)
        return context_fail(t->context, CSCD_INVALID_ARGUMENT, "cscd_event_tracker_finish: out is NULL");
    if (t->contact_count > 0)
        return context_fail(t->context, CSCD_INVALID_ARGUMENT,
                            "cscd_event_tracker_finish: %zu contacts wait for the frame that ends their "
                            "interval; add it first",
                            t->contact_count);
    if (!event_history_reserve(t->context, h, 0, h->open_count) ||
        !reserve_given(t, h->closed_count + h->open_count))
        return context_out_of_memory(t->context);
    event_history_close(h);
    const cscd_events events = give_closed(t);
    event_history_clear(h);
    *out = events;
    return CSCD_OK;
}

cscd_status cscd_event_tracker_finish(cscd_event_tracker *tracker, cscd_events *out) {
    if (tracker == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(tracker, &entry)) return entry.status;
    return context_leave(&entry, finish_events(tracker, out));
}
