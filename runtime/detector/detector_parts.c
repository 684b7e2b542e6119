/* The parts of a live detector, and contacts summed up by pair of parts. */
#include "runtime/detector/detector.h"
#include "runtime/detector/given_contacts.h"
#include "src/core/sort.h"
#include "src/core/struct_size.h"

/* ---- labels ---------------------------------------------------------------------------------------------- */

static cscd_status check_labels(const cscd_detector *d, const uint32_t *labels, uint32_t part_count) {
    cscd_context *context = d->context;
    if ((labels == NULL) != (part_count == 0))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "cscd_detector_set_parts: %s: give labels and the number of parts, or NULL and 0",
                            labels == NULL ? "labels is NULL" : "part_count is 0");
    for (uint32_t t = 0; labels != NULL && t < d->mesh->triangle_count; t++) {
        if (labels[t] < part_count || labels[t] == UINT32_MAX) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "triangle %u has the label %u, but there are %u parts: a label is below that, or "
                            "UINT32_MAX for none",
                            t, labels[t], part_count);
    }
    return CSCD_OK;
}

static cscd_status set_parts(cscd_detector *d, const uint32_t *labels, uint32_t part_count) {
    cscd_status status = check_labels(d, labels, part_count);
    if (status != CSCD_OK) return status;
    status = part_labels_set(d->mesh, labels, part_count, &d->parts);
    return context_explain(d->context, status);
}

cscd_status cscd_detector_set_parts(cscd_detector *detector, const uint32_t *labels, uint32_t part_count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, set_parts(detector, labels, part_count));
}

/* ---- contacts -------------------------------------------------------------------------------------------- */

/* A pair of parts, and the place of a contact of the two. */
typedef struct contact_part_key {
    uint64_t parts, place;
} contact_part_key;

static uint64_t parts_of_contact(const cscd_detector *d, const cscd_contact *c) {
    const part_labels *labels = &d->parts;
    const cscd_mesh *mesh = d->mesh;
    bool edge_a = c->kind == CSCD_CONTACT_EE || c->kind == CSCD_CONTACT_EV;
    uint32_t a = edge_a ? part_of_edge(labels, mesh, c->a) : part_of_vertex(labels, mesh, c->a), b;
    if (c->kind == CSCD_CONTACT_VF)
        b = part_of_triangle(labels, mesh, c->b);
    else if (c->kind == CSCD_CONTACT_EE)
        b = part_of_edge(labels, mesh, c->b);
    else if (c->kind == CSCD_CONTACT_VH)
        b = labels->triangles == NULL ? c->b : UINT32_MAX;
    else
        b = part_of_vertex(labels, mesh, c->b);
    return key_of_parts(a, b);
}

static void add_contact(const cscd_contact *contacts, size_t place, cscd_contact_part_pair *out) {
    if (out->count == 0 || contacts[place].toi < out->toi) {
        out->earliest = place;
        out->toi = contacts[place].toi;
    }
    out->count++;
}

/* Keys are sorted, those of one pair of parts in the order of the contacts. */
static size_t sum_contacts(const contact_part_key *keys, size_t count, const cscd_contact *contacts,
                           cscd_contact_part_pair *items) {
    size_t made = 0;
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || keys[i].parts != keys[i - 1].parts)
            items[made++] =
                (cscd_contact_part_pair){.a = (uint32_t)(keys[i].parts >> 32), .b = (uint32_t)keys[i].parts};
        add_contact(contacts, keys[i].place, &items[made - 1]);
    }
    return made;
}

static cscd_status contact_parts(cscd_detector *d, const cscd_contact *contacts, size_t count,
                                 cscd_contact_part_pairs *out, size_t size) {
    if (out == NULL)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT, "cscd_detector_contact_parts: out is NULL");
    cscd_status status =
        given_contacts_check(d->context, d->mesh, "cscd_detector_contact_parts", contacts, count);
    if (status != CSCD_OK) return status;
    result_buffer *buffer = &d->contact_parts;
    status = result_buffer_reserve(d->context, buffer, count, sizeof(cscd_contact_part_pair),
                                   sizeof(contact_part_key));
    if (status != CSCD_OK) return context_explain(d->context, status);
    contact_part_key *keys = buffer->keys;
    for (size_t i = 0; i < count; i++) keys[i] = (contact_part_key){parts_of_contact(d, &contacts[i]), i};
    sort_by_number(keys, buffer->spare_keys, count, sizeof *keys);
    const cscd_contact_part_pairs sums = {buffer->items, sum_contacts(keys, count, contacts, buffer->items)};
    struct_give(out, size, &sums, sizeof sums);
    return CSCD_OK;
}

cscd_status cscd_detector_contact_parts_sized(cscd_detector *detector, const cscd_contact *contacts,
                                              size_t contact_count, cscd_contact_part_pairs *out,
                                              size_t size) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, contact_parts(detector, contacts, contact_count, out, size));
}
