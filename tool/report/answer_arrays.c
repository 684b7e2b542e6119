/* What intersects in each frame of a report: triangles with their kinds, points of curves, depths of vertices. */
#include "tool/report/answer_arrays.h"

#include "tool/io/io.h"
#include "tool/report/page_coordinate.h"

#include <stdlib.h>
#include <string.h>

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

/* How many more may be kept in a frame, so that each later frame is left its share of the whole. */
static uint32_t room_of(uint32_t most, uint32_t kept, const report_options *options, uint32_t frame) {
    uint32_t frames = options->last - options->first + 1, to_come = options->last - frame;
    return most - kept - most / frames * to_come;
}

/* Marks the triangles with the kinds of their pairs. */
static void mark_kinds(answer_arrays *a, const cscd_intersection_pairs *found, answer_counts *counts) {
    for (size_t i = 0; i < found->count; i++) {
        const cscd_intersection_pair *pair = &found->items[i];
        a->kinds[pair->a] |= (uint8_t)cscd_intersection_set(pair->kind);
        a->kinds[pair->b] |= (uint8_t)cscd_intersection_set(pair->kind);
        if (pair->kind == CSCD_INTERSECTION_CROSSING)
            counts->crossing++;
        else
            counts->touching++;
    }
}

/* Keeps the marked triangles, each once, and takes the marks away. */
static bool keep_triangles(answer_arrays *a, const cscd_intersection_pairs *found, uint32_t room,
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
                       const cscd_intersection_pairs *found, double scale) {
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
