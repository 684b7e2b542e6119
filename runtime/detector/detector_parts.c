/* The parts of a live detector, and contacts summed up by pair of parts. */
#include "runtime/detector/detector.h"
#include "src/core/sort.h"
#include "src/mesh/given_contacts.h"

/* ---- labels ---------------------------------------------------------------------------------------------- */

static cscd_status set_labels(cscd_detector *d, const uint32_t *labels, uint32_t count, part_labels *out,
                              const char *name) {
    cscd_status status = part_labels_check(d->mesh, labels, count, name);
    if (status != CSCD_OK) return status;
    status = part_labels_set(d->mesh, labels, count, out);
    return context_explain(d->context, status);
}

cscd_status cscd_detector_set_parts(cscd_detector *detector, const uint32_t *labels, uint32_t part_count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(
        &entry, set_labels(detector, labels, part_count, &detector->parts, "cscd_detector_set_parts"));
}

cscd_status cscd_detector_set_bodies(cscd_detector *detector, const uint32_t *labels, uint32_t label_count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(
        &entry, set_labels(detector, labels, label_count, &detector->grouping, "cscd_detector_set_bodies"));
}

const part_labels *detector_grouping(const cscd_detector *d) {
    return d->grouping.triangles != NULL ? &d->grouping : &d->parts;
}

bool detector_bodies_are_components(const cscd_detector *d) {
    return detector_grouping(d)->triangles == NULL && d->mesh->object_count == 1;
}

uint32_t cscd_detector_body_labels(const cscd_detector *detector, uint32_t *labels) {
    if (detector_bodies_are_components(detector)) {
        for (uint32_t t = 0; labels != NULL && t < detector->mesh->triangle_count; t++)
            labels[t] = detector->mesh->triangle_components[t];
        return detector->mesh->component_count;
    }
    const surface_bodies *bodies = &detector_grouping(detector)->bodies;
    for (uint32_t t = 0; labels != NULL && t < detector->mesh->triangle_count; t++)
        labels[t] = body_of_triangle(bodies, detector->mesh, t);
    return body_count(bodies, detector->mesh);
}

/* ---- contacts -------------------------------------------------------------------------------------------- */

/* A pair of parts, and the place of a contact of the two. */
typedef struct contact_part_key {
    uint64_t parts, place;
} contact_part_key;

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
        add_contact(contacts, (size_t)keys[i].place, &items[made - 1]);
    }
    return made;
}

static cscd_status contact_parts(cscd_detector *d, const cscd_contact *contacts, size_t count,
                                 cscd_contact_part_pairs *out) {
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
    for (size_t i = 0; i < count; i++) {
        const cscd_contact *c = &contacts[i];
        keys[i] = (contact_part_key){parts_of_contact(&d->parts, d->mesh, c->kind, c->a, c->b), i};
    }
    sort_by_number(keys, buffer->spare_keys, count, sizeof *keys);
    const cscd_contact_part_pairs sums = {buffer->items, sum_contacts(keys, count, contacts, buffer->items)};
    *out = sums;
    return CSCD_OK;
}

cscd_status cscd_detector_contact_parts(cscd_detector *detector, const cscd_contact *contacts,
                                        size_t contact_count, cscd_contact_part_pairs *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, contact_parts(detector, contacts, contact_count, out));
}
