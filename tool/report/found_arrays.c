/* Findings as arrays of the page: contacts of intervals, intersections and depths of frames, and how
 * triangles face their detector points. */
#include "tool/report/collected.h"

#include "cscd/research.h"
#include "tool/io/io.h"
#include "tool/report/report.h"

#include <stdlib.h>
#include <string.h>

/* ---- contacts ------------------------------------------------------------------------------------------ */

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

/* The number of contacts of an interval that may be kept, so that each later interval is left its share of
 * the whole. */
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

/* ---- answers ------------------------------------------------------------------------------------------- */

enum { ARRAYS = 9, COUNTS = sizeof(answer_counts) / sizeof(uint32_t) };

static void list_arrays(answer_arrays *a, packed_array **out[ARRAYS]) {
    packed_array **arrays[ARRAYS] = {&a->frame,          &a->counts,       &a->triangle,
                                     &a->kind,           &a->point_share,  &a->point_begins,
                                     &a->point_vertices, &a->depth_vertex, &a->depth};
    memcpy(out, arrays, sizeof arrays);
}

bool answer_arrays_create(const report_options *options, answer_arrays *out) {
    *out = (answer_arrays){0};
    packed_array **arrays[ARRAYS];
    list_arrays(out, arrays);
    size_t size = cscd_mesh_triangle_count(options->mesh) * sizeof *out->kinds;
    bool created = (out->kinds = io_realloc(NULL, size)) != NULL;
    if (created) memset(out->kinds, 0, size);
    for (size_t i = 0; i < ARRAYS && created; i++) created = (*arrays[i] = packed_array_create()) != NULL;
    if (!created) answer_arrays_free(out);
    return created;
}

void answer_arrays_free(answer_arrays *a) {
    packed_array **arrays[ARRAYS];
    list_arrays(a, arrays);
    for (size_t i = 0; i < ARRAYS; i++) packed_array_destroy(*arrays[i]);
    free(a->kinds);
    *a = (answer_arrays){0};
}

/* The number that may still be kept in a frame, so that each later frame is left its share of the whole. */
static uint32_t room_of(uint32_t most, uint32_t kept, const report_options *options, uint32_t frame) {
    const uint32_t sets = options->kind == REPORT_UNTANGLED ? 2 : 1; /* of each frame */
    const uint32_t frames = (options->last - options->first + 1) * sets, place = frame - options->first;
    return most - kept - most / frames * (frames - 1 - place);
}

/* Marks the triangles with the kinds of their pairs. */
static void mark_kinds(answer_arrays *a, const cscd_intersections *found, answer_counts *counts) {
    for (size_t i = 0; i < found->count; i++) {
        const cscd_intersection *pair = &found->items[i];
        a->kinds[pair->a] |= (uint8_t)cscd_intersection_set(pair->kind);
        a->kinds[pair->b] |= (uint8_t)cscd_intersection_set(pair->kind);
        if (pair->kind == CSCD_INTERSECTION_CROSSING)
            counts->crossing++;
        else
            counts->touching++;
    }
}

/* Keeps the marked triangles, each once, and takes the marks away. */
static bool keep_triangles(answer_arrays *a, const cscd_intersections *found, uint32_t room,
                           answer_counts *counts) {
    bool added = true;
    for (size_t i = 0; i < 2 * found->count; i++) {
        uint32_t triangle = i % 2 == 0 ? found->items[i / 2].a : found->items[i / 2].b;
        uint8_t kinds = a->kinds[triangle];
        if (kinds == 0) continue;
        a->kinds[triangle] = 0;
        a->found.triangles++;
        if (counts->triangles >= room || !added) continue;
        counts->triangles++;
        added = packed_array_add_u32(a->triangle, &triangle, 1) && packed_array_add_bytes(a->kind, &kinds, 1);
    }
    return added;
}

/* The point by its edge, so that it lies on the surface that the page shows, however that is rounded. */
static bool keep_point(answer_arrays *a, const cscd_mesh *mesh, const cscd_curve_point *point, bool begins) {
    uint32_t ends[2] = {point->triangle, point->triangle}; /* a vertex */
    if (point->edge != UINT32_MAX) cscd_mesh_edge(mesh, point->edge, ends);
    float share = (float)point->s;
    return packed_array_add_u32(a->point_vertices, ends, 2) &&
           packed_array_add_f32(a->point_share, &share, 1) &&
           packed_array_add_bytes(a->point_begins, &(uint8_t){begins}, 1);
}

static bool keep_curves(answer_arrays *a, const cscd_mesh *mesh, const cscd_curves *curves, uint32_t room,
                        answer_counts *counts) {
    for (size_t c = 0; curves != NULL && c < curves->count; c++) {
        const cscd_curve *curve = &curves->items[c];
        size_t count = curve->point_count + curve->closed;
        a->found.points += (uint32_t)count;
        for (size_t i = 0; i < count && counts->points < room; i++) {
            const cscd_curve_point *point = &curves->points[curve->first_point + i % curve->point_count];
            counts->points++;
            if (!keep_point(a, mesh, point, i == 0)) return false;
        }
    }
    return true;
}

/* Each vertex once, with the greatest of its depths. */
static bool keep_depths(answer_arrays *a, const cscd_depths *depths, uint32_t room, double scale,
                        answer_counts *counts) {
    for (size_t i = 0; depths != NULL && i < depths->vertex_count;) {
        uint32_t vertex = depths->items[i].vertex;
        double deepest = 0.0;
        for (; i < depths->vertex_count && depths->items[i].vertex == vertex; i++)
            if (depths->items[i].depth > deepest) deepest = depths->items[i].depth;
        a->found.depths++;
        if (counts->depths >= room) continue;
        float depth = (float)page_coordinate(deepest, scale);
        counts->depths++;
        if (!packed_array_add_u32(a->depth_vertex, &vertex, 1) || !packed_array_add_f32(a->depth, &depth, 1))
            return false;
    }
    return true;
}

static void sum_up(answer_arrays *a, const answer_counts *counts) {
    a->found.crossing += counts->crossing;
    a->found.touching += counts->touching;
    a->kept.triangles += counts->triangles;
    a->kept.points += counts->points;
    a->kept.depths += counts->depths;
}

bool answer_arrays_add(answer_arrays *a, const report_options *options, uint32_t frame,
                       const cscd_intersections *found, double scale) {
    uint32_t place = frame - options->first;
    answer_counts counts = {0};
    a->frames_checked++;
    mark_kinds(a, found, &counts);
    bool kept =
        keep_triangles(a, found, room_of(REPORT_ANSWER_TRIANGLES_MAX, a->kept.triangles, options, frame),
                       &counts) &&
        keep_curves(a, options->mesh, found->curves,
                    room_of(REPORT_ANSWER_POINTS_MAX, a->kept.points, options, frame), &counts) &&
        keep_depths(a, found->depths, room_of(REPORT_ANSWER_DEPTHS_MAX, a->kept.depths, options, frame),
                    scale, &counts);
    if (!kept) return false;
    sum_up(a, &counts);
    bool nothing = found->count == 0 && counts.points == 0 && counts.depths == 0;
    const uint32_t numbers[COUNTS] = {counts.crossing, counts.touching, counts.triangles, counts.points,
                                      counts.depths};
    return nothing ||
           (packed_array_add_u32(a->frame, &place, 1) && packed_array_add_u32(a->counts, numbers, COUNTS));
}

/* ---- the orientations of an interval ------------------------------------------------------------------- */

static uint32_t count_regions(const cscd_detector *detector) {
    uint32_t count = 0;
    double points[2][3];
    while (cscd_detector_region_point(detector, count, points[0], points[1])) count++;
    return count;
}

bool orientation_row_create(const cscd_detector *detector, const cscd_mesh *mesh, orientation_row *out) {
    orientation_row row = {.triangle_count = cscd_mesh_triangle_count(mesh),
                           .region_count = count_regions(detector)};
    if (row.region_count > 0) {
        row.points = io_realloc(NULL, row.region_count * sizeof *row.points);
        row.facing = io_realloc(NULL, orientation_row_size(row.triangle_count));
        if (row.points == NULL || row.facing == NULL) {
            orientation_row_free(&row);
            return false;
        }
    }
    *out = row;
    return true;
}

void orientation_row_free(orientation_row *row) {
    free(row->points);
    free(row->facing);
    *row = (orientation_row){0};
}

void orientation_row_take(orientation_row *row, const cscd_detector *detector) {
    if (row->region_count == 0) return;
    for (uint32_t i = 0; i < row->region_count; i++)
        cscd_detector_region_point(detector, i, row->points[i], row->points[i] + 3);
    memset(row->facing, 0, orientation_row_size(row->triangle_count));
    for (uint32_t t = 0; t < row->triangle_count; t++) {
        const int orientation = cscd_detector_orientation(detector, t);
        const unsigned bits = orientation > 0 ? 1 : orientation < 0 ? 2 : 0;
        row->facing[t / 4] |= (uint8_t)(bits << t % 4 * 2);
    }
}

void orientation_row_forget(orientation_row *row) {
    if (row->region_count == 0) return;
    memset(row->points, 0, row->region_count * sizeof *row->points);
    memset(row->facing, 0, orientation_row_size(row->triangle_count));
}

/* ---- orientations -------------------------------------------------------------------------------------- */

bool orientation_arrays_create(uint32_t triangle_count, uint32_t kept_count, uint32_t interval_count,
                               orientation_arrays *out) {
    orientation_arrays a = {.triangle_count = triangle_count, .interval_count = interval_count};
    size_t size = orientation_row_size(triangle_count);
    bool created = (a.points = packed_array_create()) != NULL;
    if (size <= REPORT_MARKS_MAX / (kept_count > 0 ? kept_count : 1)) {
        a.orientations = packed_array_create();
        a.last = io_realloc(NULL, size);
        a.change = io_realloc(NULL, size);
        created = created && a.orientations != NULL && a.last != NULL && a.change != NULL;
    }
    if (created && a.last != NULL) memset(a.last, 0, size);
    if (!created) orientation_arrays_free(&a);
    *out = a;
    return created;
}

void orientation_arrays_free(orientation_arrays *a) {
    packed_array_destroy(a->orientations);
    packed_array_destroy(a->points);
    free(a->last);
    free(a->change);
    *a = (orientation_arrays){0};
}

bool orientation_arrays_add(orientation_arrays *a, const orientation_row *row) {
    if (a->orientations == NULL) return true;
    const size_t size = orientation_row_size(a->triangle_count);
    for (size_t i = 0; i < size; i++) a->change[i] = a->last[i] ^ row->facing[i];
    memcpy(a->last, row->facing, size);
    return packed_array_add_bytes(a->orientations, a->change, size);
}

bool orientation_arrays_add_points(orientation_arrays *a, const orientation_row *row, double scale) {
    size_t size = sizeof(double[6]) * a->interval_count; /* of one region */
    if (a->points != NULL && row->region_count > 0 && size > REPORT_MARKS_MAX / row->region_count) {
        packed_array_destroy(a->points);
        a->points = NULL;
    }
    if (a->points == NULL) return true;
    for (uint32_t i = 0; i < row->region_count; i++) {
        double ends[6];
        for (int k = 0; k < 6; k++) ends[k] = page_coordinate(row->points[i][k], scale);
        if (!packed_array_add_f64(a->points, ends, 6)) return false;
    }
    return true;
}
