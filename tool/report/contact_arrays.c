/* The contacts of a report: the kept ones as arrays, and how many every triangle takes part in. */
#include "tool/report/contact_arrays.h"

#include "tool/io/io.h"
#include "tool/report/page_coordinate.h"

#include <stdlib.h>
#include <string.h>

bool contact_arrays_create(const report_options *options, contact_arrays *out) {
    contact_arrays a = {.found = 0};
    size_t heat_size = cscd_mesh_triangle_count(options->mesh) * sizeof *a.heat;
    packed_array **const arrays[] = {&a.interval, &a.kind, &a.vertices, &a.toi, &a.point, &a.file_vertices};
    size_t count = sizeof arrays / sizeof *arrays - (options->file_vertices == NULL);
    bool created = (a.heat = io_realloc(NULL, heat_size)) != NULL;
    if (created) memset(a.heat, 0, heat_size);
    for (size_t i = 0; i < count && created; i++) created = (*arrays[i] = packed_array_create()) != NULL;
    if (!created) contact_arrays_free(&a);
    *out = a;
    return created;
}

void contact_arrays_free(contact_arrays *a) {
    packed_array *const arrays[] = {a->interval, a->kind, a->vertices, a->toi, a->point, a->file_vertices};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) packed_array_destroy(arrays[i]);
    free(a->heat);
    *a = (contact_arrays){0};
}

static void heat_all(contact_arrays *a, const uint32_t *triangles, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) a->heat[triangles[i]]++;
}

/* No triangle twice: features with a common vertex, as two of one triangle have, are never in contact. */
static void heat_contact(contact_arrays *a, const cscd_mesh *mesh, const cscd_contact *contact) {
    uint32_t count;
    const uint32_t *triangles;
    if (contact->kind == CSCD_CONTACT_VF) {
        a->heat[contact->b]++;
        triangles = cscd_mesh_vertex_triangles(mesh, contact->a, &count);
        heat_all(a, triangles, count);
        return;
    }
    triangles = cscd_mesh_edge_triangles(mesh, contact->a, &count);
    heat_all(a, triangles, count);
    triangles = cscd_mesh_edge_triangles(mesh, contact->b, &count);
    heat_all(a, triangles, count);
}

static bool keep_contact(contact_arrays *a, const report_options *options, uint32_t interval,
                         const cscd_contact *contact, double scale) {
    uint32_t place = interval - options->first;
    uint8_t kind = contact->kind == CSCD_CONTACT_EE;
    cscd_stencil stencil =
        cscd_mesh_stencil(options->mesh, contact->kind, contact->a, contact->b, contact->u, contact->v);
    double point[3];
    for (int k = 0; k < 3; k++) point[k] = page_coordinate(contact->point[k], scale);
    a->kept++;
    if (a->file_vertices != NULL) {
        uint32_t vertices[4];
        options->file_vertices(options->file_vertices_user, contact, vertices);
        if (!packed_array_add_u32(a->file_vertices, vertices, 4)) return false;
    }
    return packed_array_add_u32(a->interval, &place, 1) && packed_array_add_bytes(a->kind, &kind, 1) &&
           packed_array_add_u32(a->vertices, stencil.vertices, 4) &&
           packed_array_add_f64(a->toi, &contact->toi, 1) && packed_array_add_f64(a->point, point, 3);
}

/* How many contacts of an interval may be kept, so that each later interval is left its share of the
 * whole. */
static size_t room_for(const contact_arrays *a, const report_options *options, uint32_t interval) {
    uint32_t intervals = options->last - options->first, to_come = options->last - 1 - interval;
    size_t reserved = (size_t)(REPORT_CONTACTS_MAX / intervals) * to_come;
    size_t room = REPORT_CONTACTS_MAX - a->kept - reserved;
    return room < REPORT_INTERVAL_CONTACTS_MAX ? room : REPORT_INTERVAL_CONTACTS_MAX;
}

bool contact_arrays_add(contact_arrays *a, const report_options *options, uint32_t interval,
                        const cscd_contacts *contacts, double scale) {
    size_t room = room_for(a, options, interval);
    a->found += contacts->count;
    for (size_t i = 0; i < contacts->count; i++) {
        const cscd_contact *contact = &contacts->items[i];
        heat_contact(a, options->mesh, contact);
        if (i < room && !keep_contact(a, options, interval, contact, scale)) return false;
    }
    return true;
}
