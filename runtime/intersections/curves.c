/* Joins the pieces of all pairs of triangles to intersection curves: docs/theory/curves.md. */
#include "runtime/intersections/curves.h"

#include "runtime/intersections/event_point.h"
#include "src/core/context.h"
#include "src/core/vec3.h"

#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_of_pairs(curve_joiner *j, size_t count) {
    return (array_list){{ARRAY(j->found, count), ARRAY(j->pair_pieces, count), ARRAY(j->pair_curves, count)}};
}

static array_list list_of_pieces(curve_joiner *j, size_t count) {
    return (array_list){{ARRAY(j->keys, 2 * count), ARRAY(j->spare_keys, 2 * count),
                         ARRAY(j->links, 2 * count), ARRAY(j->piece_curves, count), ARRAY(j->curves, count),
                         ARRAY(j->pieces, count), ARRAY(j->points, 2 * count), ARRAY(j->events, 2 * count),
                         ARRAY(j->end_points, 2 * count)}};
}

void curve_joiner_free(curve_joiner *j) {
    if (j->context == NULL) return;
    context_free_all(j->context, list_of_pairs(j, 0));
    context_free_all(j->context, list_of_pieces(j, 0));
    *j = (curve_joiner){.context = j->context};
}

size_t curve_joiner_size(size_t pair_count) {
    curve_joiner none = {.context = NULL};
    size_t room = room_with_spare(pair_count);
    size_t pairs = memory_size_of_all(list_of_pairs(&none, room));
    size_t pieces = memory_size_of_all(list_of_pieces(&none, room)); /* each pair may have one */
    return pieces < SIZE_MAX - pairs ? pairs + pieces : SIZE_MAX;
}

static bool reserve_pairs(curve_joiner *j, size_t count) {
    return context_renew_all(j->context, list_of_pairs(j, room_with_spare(count)), &j->pair_capacity, count);
}

static bool reserve_pieces(curve_joiner *j, size_t count) {
    return context_renew_all(j->context, list_of_pieces(j, room_with_spare(count)), &j->piece_capacity,
                             count);
}

/* ---- pieces -------------------------------------------------------------------------------------------- */

typedef struct curve_work {
    curve_joiner *joiner;
    const named_surface *surface;
    const cscd_intersection_pair *pairs;
    size_t pair_count;
} curve_work;

enum { PAIRS_A_TASK = 256, POINTS_A_TASK = 64 };

static void find_some_pieces(void *data, uint32_t task) {
    const curve_work *work = data;
    curve_joiner *j = work->joiner;
    size_t begin = (size_t)task * PAIRS_A_TASK, end = begin + PAIRS_A_TASK;
    if (!progress_go_on(&j->context->progress, 0.5 * (double)begin / (double)work->pair_count)) end = begin;
    for (size_t i = begin; i < end && i < work->pair_count; i++) {
        bool has = curve_piece_of_pair(work->surface, work->pairs[i].a, work->pairs[i].b, &j->found[i]);
        j->pair_pieces[i] = has ? 0 : UINT32_MAX;
    }
}

static void find_pieces(curve_work *work) {
    curve_joiner *j = work->joiner;
    parallel_run(j->context->threads, (uint32_t)((work->pair_count + PAIRS_A_TASK - 1) / PAIRS_A_TASK),
                 find_some_pieces, work);
    j->piece_count = 0;
    for (size_t i = 0; i < work->pair_count; i++) {
        if (j->pair_pieces[i] == UINT32_MAX) continue;
        j->found[j->piece_count] = j->found[i];
        j->pair_pieces[i] = (uint32_t)j->piece_count++;
    }
}

/* ---- tracing ------------------------------------------------------------------------------------------- */

/* Where one is on a curve: in a piece, going towards one of its ends, with the triangle of the first sheet. */
typedef struct curve_place {
    uint32_t piece;
    uint32_t towards; /* 0 or 1 */
    uint32_t first;
} curve_place;

/* Goes on to the next piece. The triangle that the edge passes through stays on its sheet. */
static bool go_on(const curve_joiner *j, curve_place *at) {
    uint32_t link = j->links[2 * at->piece + at->towards];
    if (link > LINKS_MAX) return false;
    uint32_t stays = j->found[at->piece].ends[at->towards].triangle;
    const curve_piece *next = &j->found[link / 2];
    uint32_t changed = next->a == stays ? next->b : next->a;
    *at = (curve_place){link / 2, 1 - link % 2, stays == at->first ? stays : changed};
    return true;
}

/* The place from which a curve through a piece is followed: the start of an open one, else that piece. */
static curve_place find_start(const curve_joiner *j, uint32_t piece) {
    curve_place at = {piece, 0, j->found[piece].a};
    while (go_on(j, &at)) {
        if (at.piece == piece) return (curve_place){piece, 1, j->found[piece].a};
    }
    at.towards = 1 - at.towards;
    return at;
}

static cscd_curve_end end_of_link(uint32_t link) {
    switch (link) {
    case LINK_TO_VERTEX:
        return CSCD_CURVE_END_VERTEX;
    case LINK_TO_BORDER:
        return CSCD_CURVE_END_BORDER;
    case LINK_TO_JUNCTION:
        return CSCD_CURVE_END_JUNCTION;
    case LINK_TO_LEFT_OUT:
        return CSCD_CURVE_END_LEFT_OUT;
    default:
        return CSCD_CURVE_END_NONE;
    }
}

/* Follows a curve from its start, and adds its pieces and the events of its points. */
static void trace_curve(curve_joiner *j, curve_place at, cscd_curve *curve) {
    uint32_t first_piece = at.piece, first_triangle = at.first;
    surface_event event = j->found[at.piece].ends[1 - at.towards];
    curve->start = end_of_link(j->links[2 * at.piece + 1 - at.towards]);
    curve->closed = false;
    for (bool more = true; more && !curve->closed;) {
        const curve_piece *piece = &j->found[at.piece];
        uint32_t end = 2 * at.piece + at.towards;
        size_t point = curve->first_point + curve->point_count++;
        j->events[point] = event;
        j->end_points[end ^ 1] = (uint32_t)point;
        j->end_points[end] = (uint32_t)point + 1;
        j->pieces[curve->first_piece + curve->piece_count++] =
            (cscd_curve_piece){at.first, piece->a == at.first ? piece->b : piece->a};
        j->piece_curves[at.piece] = (uint32_t)j->curve_count;
        event = piece->ends[at.towards];
        curve->end = end_of_link(j->links[end]);
        more = go_on(j, &at);
        curve->closed = more && at.piece == first_piece;
        if (curve->closed) j->end_points[end] = (uint32_t)curve->first_point;
    }
    curve->swapped = curve->closed && at.first != first_triangle;
    if (!curve->closed) j->events[curve->first_point + curve->point_count++] = event;
}

static void name_sheets(const curve_joiner *j, const cscd_mesh *mesh, cscd_curve *curve) {
    const cscd_curve_piece *piece = &j->pieces[curve->first_piece];
    curve->components[0] = mesh->triangle_components[piece->a];
    curve->components[1] = mesh->triangle_components[piece->b];
    mesh_objects_of_pair(mesh, CSCD_CONTACT_TT, piece->a, piece->b, curve->objects);
}

static void trace_curves(curve_work *work) {
    curve_joiner *j = work->joiner;
    size_t points = 0, pieces = 0;
    j->curve_count = 0;
    memset(j->piece_curves, 0xff, j->piece_count * sizeof *j->piece_curves);
    for (uint32_t i = 0; i < j->piece_count; i++) {
        if (j->piece_curves[i] != UINT32_MAX) continue;
        cscd_curve *curve = &j->curves[j->curve_count];
        *curve = (cscd_curve){.first_point = points, .first_piece = pieces};
        trace_curve(j, find_start(j, i), curve);
        name_sheets(j, work->surface->mesh, curve);
        points += curve->point_count;
        pieces += curve->piece_count;
        j->curve_count++;
    }
    j->point_count = points;
}

/* ---- points -------------------------------------------------------------------------------------------- */

static void find_some_points(void *data, uint32_t task) {
    const curve_work *work = data;
    curve_joiner *j = work->joiner;
    size_t begin = (size_t)task * POINTS_A_TASK, end = begin + POINTS_A_TASK;
    if (!progress_go_on(&j->context->progress, 0.5 + 0.5 * (double)begin / (double)j->point_count)) return;
    for (size_t i = begin; i < end && i < j->point_count; i++) {
        event_point at;
        event_point_find(work->surface, j->events[i], &at);
        j->points[i] = (cscd_curve_point){j->events[i].edge,          j->events[i].triangle, at.s, at.u, at.v,
                                          {at.x[0], at.x[1], at.x[2]}};
    }
}

static void measure_lengths(curve_joiner *j) {
    for (size_t i = 0; i < j->curve_count; i++) {
        cscd_curve *curve = &j->curves[i];
        const cscd_curve_point *points = j->points + curve->first_point;
        for (size_t k = 0; k < curve->piece_count; k++)
            curve->length += sqrt(vec3_squared_distance(points[k].x, points[(k + 1) % curve->point_count].x));
    }
}

static void name_curves_of_pairs(const curve_work *work) {
    curve_joiner *j = work->joiner;
    for (size_t i = 0; i < work->pair_count; i++)
        j->pair_curves[i] = j->pair_pieces[i] == UINT32_MAX ? UINT32_MAX : j->piece_curves[j->pair_pieces[i]];
}

cscd_status curve_joiner_run(curve_joiner *j, const named_surface *s, const cscd_intersection_pair *pairs,
                             size_t pair_count, cscd_curves *out) {
    curve_work work = {j, s, pairs, pair_count};
    if (pair_count > LINKS_MAX / 2 || !reserve_pairs(j, pair_count)) return CSCD_OUT_OF_MEMORY;
    j->pair_count = pair_count;
    find_pieces(&work);
    if (progress_cancelled(&j->context->progress)) return CSCD_CANCELLED;
    if (!reserve_pieces(j, j->piece_count)) return CSCD_OUT_OF_MEMORY;
    curve_links_find(s, j->found, j->piece_count, j->keys, j->spare_keys, j->links);
    trace_curves(&work);
    parallel_run(j->context->threads, (uint32_t)((j->point_count + POINTS_A_TASK - 1) / POINTS_A_TASK),
                 find_some_points, &work);
    measure_lengths(j);
    name_curves_of_pairs(&work);
    *out = (cscd_curves){j->curves, j->curve_count, j->points,      j->point_count,
                         j->pieces, j->piece_count, j->pair_curves, pair_count};
    return context_progress_status(j->context);
}
