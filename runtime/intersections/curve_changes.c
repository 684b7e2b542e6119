/* The points of intersection curves that come or go in an interval, found at its contacts: docs/theory/curves.md,
 * Lemma 10. */
#include "runtime/intersections/named_surface.h"

#include "src/core/context.h"
#include "src/core/sort.h"

#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_of_contacts(change_finder *f, size_t count) {
    return (array_list){{ARRAY(f->order, count), ARRAY(f->spare_order, count), ARRAY(f->rank_first, count),
                         ARRAY(f->contact_first, count), ARRAY(f->next, count)}};
}

static array_list list_of_causes(change_finder *f, size_t count) {
    return (array_list){{ARRAY(f->keys, count), ARRAY(f->spare_keys, count), ARRAY(f->items, count),
                         ARRAY(f->causes, count), ARRAY(f->of_contacts, count)}};
}

void change_finder_free(change_finder *f) {
    if (f->context == NULL) return;
    context_free_all(f->context, list_of_contacts(f, 0));
    context_free_all(f->context, list_of_causes(f, 0));
    for (int i = 0; i < 2; i++) placed_names_free(&f->names[i]);
    *f = (change_finder){.context = f->context};
}

static bool reserve_contacts(change_finder *f, size_t count) {
    return context_renew_all(f->context, list_of_contacts(f, room_with_spare(count)), &f->contact_capacity,
                             count);
}

static bool reserve_causes(change_finder *f, size_t count) {
    return context_renew_all(f->context, list_of_causes(f, room_with_spare(count)), &f->cause_capacity,
                             count);
}

/* ---- one contact --------------------------------------------------------------------------------------- */

typedef struct change_work {
    change_finder *finder;
    named_surface ends[2];
    const cscd_contact *contacts;
    size_t contact_count;
} change_work;

/* The changes at one contact; without room for keys they are only counted. */
typedef struct change_sink {
    const change_work *work;
    uint64_t contact;
    change_key *keys;
    size_t count;
} change_sink;

static void try_event(change_sink *sink, surface_event event) {
    const change_work *work = sink->work;
    bool before = surface_event_happens(&work->ends[0], event);
    bool after = surface_event_happens(&work->ends[1], event);
    if (before == after) return;
    if (sink->keys != NULL)
        sink->keys[sink->count] =
            (change_key){(uint64_t)event.edge << 32 | event.triangle, sink->contact << 1 | after};
    sink->count++;
}

/* The edges of triangles at the vertex, each once, at the first of its triangles. */
static void try_edges_at_vertex(change_sink *sink, uint32_t vertex, uint32_t triangle) {
    const cscd_mesh *mesh = sink->work->ends[0].mesh;
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        uint32_t t = mesh->vertex_stars[i];
        for (int k = 0; k < 3; k++) {
            uint32_t edge = mesh->triangle_edges[t][k];
            if (mesh->edge_stars[mesh->edge_star_offsets[edge]] != t) continue;
            if (mesh->edges[edge][0] == vertex || mesh->edges[edge][1] == vertex)
                try_event(sink, (surface_event){edge, triangle});
        }
    }
}

static void try_triangles_at_edge(change_sink *sink, uint32_t passing, uint32_t edge) {
    const cscd_mesh *mesh = sink->work->ends[0].mesh;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++)
        try_event(sink, (surface_event){passing, mesh->edge_stars[i]});
}

/* Returns the number of changes at a contact, and writes their keys where there is room. */
static size_t changes_at_contact(const change_work *work, size_t contact, change_key *keys) {
    const cscd_contact *c = &work->contacts[contact];
    change_sink sink = {work, contact, keys, 0};
    if (c->kind == CSCD_CONTACT_VF) {
        try_edges_at_vertex(&sink, c->a, c->b);
    } else if (c->kind == CSCD_CONTACT_EE) {
        try_triangles_at_edge(&sink, c->a, c->b);
        try_triangles_at_edge(&sink, c->b, c->a);
    }
    return sink.count;
}

/* ---- all contacts -------------------------------------------------------------------------------------- */

enum { CONTACTS_A_TASK = 64 };

static uint32_t task_count_of(const change_work *work) {
    return (uint32_t)((work->contact_count + CONTACTS_A_TASK - 1) / CONTACTS_A_TASK);
}

/* Times are 0 or more, so they are in the order of their bits. */
static void order_by_toi(const change_work *work) {
    change_finder *f = work->finder;
    for (size_t i = 0; i < work->contact_count; i++) {
        double toi = work->contacts[i].toi + 0.0;
        memcpy(&f->order[i].number, &toi, sizeof toi);
        f->order[i].value = i;
    }
    sort_by_number(f->order, f->spare_order, work->contact_count, sizeof *f->order);
}

static void count_some_changes(void *data, uint32_t task) {
    const change_work *work = data;
    size_t begin = (size_t)task * CONTACTS_A_TASK, end = begin + CONTACTS_A_TASK;
    for (size_t rank = begin; rank < end && rank < work->contact_count; rank++)
        work->finder->rank_first[rank] =
            changes_at_contact(work, (size_t)work->finder->order[rank].value, NULL);
}

/* Turns numbers into the places where so many items begin, and returns how many there are in all. */
static size_t sum_up_counts(size_t *counts, size_t count) {
    size_t sum = 0;
    for (size_t i = 0; i < count; i++) {
        size_t own = counts[i];
        counts[i] = sum;
        sum += own;
    }
    counts[count] = sum;
    return sum;
}

static void write_some_keys(void *data, uint32_t task) {
    const change_work *work = data;
    change_finder *f = work->finder;
    size_t begin = (size_t)task * CONTACTS_A_TASK, end = begin + CONTACTS_A_TASK;
    for (size_t rank = begin; rank < end && rank < work->contact_count; rank++) {
        if (f->rank_first[rank] == f->rank_first[rank + 1]) continue;
        changes_at_contact(work, (size_t)f->order[rank].value, f->keys + f->rank_first[rank]);
    }
}

/* ---- the lists ----------------------------------------------------------------------------------------- */

/* Keys of one change are neighbours, by toi. Returns the number of changes. */
static size_t list_changes(change_finder *f, size_t cause_count) {
    size_t made = 0;
    for (size_t i = 0; i < cause_count; i++) {
        uint64_t number = f->keys[i].number;
        if (i == 0 || number != f->keys[i - 1].number)
            f->items[made++] = (cscd_curve_change){.edge = (uint32_t)(number >> 32),
                                                   .triangle = (uint32_t)number,
                                                   .first_cause = i,
                                                   .comes = (f->keys[i].value & 1) != 0};
        f->items[made - 1].cause_count++;
        f->causes[i] = (size_t)(f->keys[i].value >> 1);
    }
    return made;
}

static void list_by_contact(change_finder *f, size_t change_count, size_t contact_count) {
    for (size_t rank = 0; rank < contact_count; rank++)
        f->contact_first[f->order[rank].value] = f->rank_first[rank + 1] - f->rank_first[rank];
    sum_up_counts(f->contact_first, contact_count);
    memcpy(f->next, f->contact_first, (contact_count + 1) * sizeof *f->next);
    for (size_t change = 0; change < change_count; change++) {
        const cscd_curve_change *c = &f->items[change];
        for (size_t i = c->first_cause; i < c->first_cause + c->cause_count; i++)
            f->of_contacts[f->next[f->causes[i]]++] = change;
    }
}

cscd_status change_finder_run(change_finder *f, const cscd_mesh *mesh, const double *const ends[2],
                              const uint32_t *names, const cscd_contact *contacts, size_t contact_count,
                              cscd_curve_changes *out) {
    change_work work = {.finder = f, .contacts = contacts, .contact_count = contact_count};
    for (int i = 0; i < 2; i++) {
        work.ends[i] = (named_surface){.mesh = mesh, .positions = ends[i]};
        f->names[i].context = f->context;
        if (!placed_names_find(&f->names[i], mesh, ends[i], names, &work.ends[i].names))
            return CSCD_OUT_OF_MEMORY;
    }
    if (!reserve_contacts(f, contact_count + 1)) return CSCD_OUT_OF_MEMORY;
    order_by_toi(&work);
    parallel_run(f->context->threads, task_count_of(&work), count_some_changes, &work);
    size_t cause_count = sum_up_counts(f->rank_first, contact_count);
    if (!reserve_causes(f, cause_count)) return CSCD_OUT_OF_MEMORY;
    parallel_run(f->context->threads, task_count_of(&work), write_some_keys, &work);
    sort_by_number(f->keys, f->spare_keys, cause_count, sizeof *f->keys);
    size_t change_count = list_changes(f, cause_count);
    list_by_contact(f, change_count, contact_count);
    *out = (cscd_curve_changes){f->items,    change_count,     f->causes,
                                cause_count, f->contact_first, f->of_contacts};
    return CSCD_OK;
}
