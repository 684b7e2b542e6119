/* Joins the pieces of all pairs of triangles to intersection curves: docs/theory/curves.md. */
#include "runtime/intersections/named_surface.h"

#include "src/core/context.h"
#include "src/core/sort.h"
#include "src/core/vec3.h"

#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_of_pairs(curve_joiner *j, size_t count) {
    return (array_list){{ARRAY(j->found, count), ARRAY(j->pair_pieces, count), ARRAY(j->pair_curves, count)}};
}

static array_list list_of_pieces(curve_joiner *j, size_t count) {
    return (array_list){{ARRAY(j->keys, 2 * count), ARRAY(j->spare_keys, 2 * count),
                         ARRAY(j->links, 2 * count), ARRAY(j->piece_curves, count), ARRAY(j->curves, count),
                         ARRAY(j->pieces, count), ARRAY(j->points, 2 * count), ARRAY(j->piercings, 2 * count),
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
    const cscd_intersection *pairs;
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

/* ---- links --------------------------------------------------------------------------------------------- */

/* Ends of pieces at one piercing are joined. A piercing is an edge and a triangle, so that joining compares numbers. Edges whose
 * vertices have the same names are one edge. */

/* The things that an end is joined to, if not to another end. */
enum {
    LINK_TO_VERTEX = UINT32_MAX,
    LINK_TO_BORDER = UINT32_MAX - 1,
    LINK_TO_JUNCTION = UINT32_MAX - 2,
    LINK_TO_LEFT_OUT = UINT32_MAX - 3,
    LINKS_MAX = UINT32_MAX - 4
};

/* The ends of a call, and what they are linked to. */
typedef struct link_work {
    const named_surface *surface;
    const curve_piece *pieces;
    uint32_t *links;
} link_work;

static surface_piercing piercing_of(const link_work *work, uint64_t end) {
    return work->pieces[end / 2].ends[end % 2];
}

/* The names of an edge's vertices, the smaller one in the upper half. */
static uint64_t name_edge(const named_surface *s, uint32_t edge) {
    const uint32_t *v = s->mesh->edges[edge];
    uint32_t a = surface_name(s, v[0]), b = surface_name(s, v[1]);
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

static bool triangle_is_collapsed(const named_surface *s, uint32_t triangle) {
    const uint32_t *v = s->mesh->triangles[triangle];
    uint32_t a = surface_name(s, v[0]), b = surface_name(s, v[1]), c = surface_name(s, v[2]);
    return a == b || b == c || c == a;
}

/* The triangles of an edge, but those of which a seam has made an edge. */
static uint32_t count_triangles(const named_surface *s, uint32_t edge) {
    const cscd_mesh *mesh = s->mesh;
    if (s->names == NULL) return edge_star_size(mesh, edge);
    uint32_t count = 0;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++)
        count += !triangle_is_collapsed(s, mesh->edge_stars[i]);
    return count;
}

static uint32_t link_of_lonely(uint32_t triangles) {
    return triangles <= 1 ? LINK_TO_BORDER : triangles == 2 ? LINK_TO_LEFT_OUT : LINK_TO_JUNCTION;
}

/* Joins the ends of one triangle and one edge, or of edges that seams have made one. Each end has a triangle of the edge of
 * its own, so three are at a junction. */
static void link_group(link_work *work, const curve_key *keys, size_t count) {
    uint32_t first = piercing_of(work, keys[0].end).edge, last = piercing_of(work, keys[count - 1].end).edge;
    uint32_t triangles = count_triangles(work->surface, first);
    if (last != first) triangles += count_triangles(work->surface, last);
    if (count > 2) triangles = 3;
    bool joined = count == 2 && triangles == 2;
    for (size_t i = 0; i < count; i++)
        work->links[keys[i].end] = joined ? (uint32_t)keys[1 - i].end : link_of_lonely(triangles);
}

/* Sorts the ends by triangle, and within a triangle by the names of the edge. */
static size_t sort_ends(link_work *work, size_t piece_count, curve_key *keys, curve_key *spare_keys) {
    size_t count = 0;
    for (uint64_t end = 0; end < 2 * piece_count; end++) {
        surface_piercing piercing = piercing_of(work, end);
        if (piercing.edge == NO_EDGE)
            work->links[end] = LINK_TO_VERTEX;
        else
            keys[count++] = (curve_key){piercing.triangle, end};
    }
    sort_by_number(keys, spare_keys, count, sizeof *keys);
    for (size_t i = 0; i < count; i++)
        keys[i].number = name_edge(work->surface, piercing_of(work, keys[i].end).edge);
    for (size_t i = 0, begin = 0; i < count; i++) { /* a run has the ends of one triangle, mostly a handful */
        if (i + 1 < count &&
            piercing_of(work, keys[i + 1].end).triangle == piercing_of(work, keys[i].end).triangle)
            continue;
        sort_by_number(keys + begin, spare_keys, i + 1 - begin, sizeof *keys);
        begin = i + 1;
    }
    return count;
}

/* The first key of this number or a larger one. */
static size_t find_key(const curve_key *keys, size_t count, uint64_t number) {
    size_t low = 0;
    while (low < count) {
        size_t middle = low + (count - low) / 2;
        if (keys[middle].number < number)
            low = middle + 1;
        else
            count = middle;
    }
    return low;
}

/* An edge was found that may be joined to those of the ends: they are at no border then. */
static void count_joined_edge(link_work *work, const curve_key *keys, size_t count, uint32_t edge) {
    uint64_t number = name_edge(work->surface, edge);
    uint32_t triangles = count_triangles(work->surface, edge);
    for (size_t i = find_key(keys, count, number); i < count && keys[i].number == number; i++) {
        uint32_t *link = &work->links[keys[i].end];
        if (piercing_of(work, keys[i].end).edge == edge || triangles == 0) continue;
        *link = *link == LINK_TO_BORDER && triangles == 1 ? LINK_TO_LEFT_OUT : LINK_TO_JUNCTION;
    }
}

/* The triangle on the other side of a seam may have no end here, as its pair is left out. So all
 * edges of the mesh are compared with those of the ends that seem to be at a border. */
static void name_ends_at_seams(link_work *work, size_t piece_count, curve_key *keys, curve_key *spare_keys) {
    const cscd_mesh *mesh = work->surface->mesh;
    size_t count = 0;
    for (uint64_t end = 0; end < 2 * piece_count; end++) {
        if (work->links[end] == LINK_TO_BORDER)
            keys[count++] = (curve_key){name_edge(work->surface, piercing_of(work, end).edge), end};
    }
    sort_by_number(keys, spare_keys, count, sizeof *keys);
    for (uint32_t edge = 0; edge < mesh->edge_count && count > 0; edge++)
        count_joined_edge(work, keys, count, edge);
}

/* Fills links with the end, or one of the above, that each end is joined to. Two ends are joined when they are at one piercing,
 * and no third piece is there. keys and spare_keys have room for two keys per piece; piece_count is at most LINKS_MAX / 2. */
static void find_links(const named_surface *s, const curve_piece *pieces, size_t piece_count, curve_key *keys,
                       curve_key *spare_keys, uint32_t *links) {
    link_work work = {s, pieces, links};
    size_t count = sort_ends(&work, piece_count, keys, spare_keys), begin = 0;
    for (size_t i = 0; i < count; i++) {
        bool last = i + 1 == count || keys[i + 1].number != keys[i].number ||
                    piercing_of(&work, keys[i + 1].end).triangle != piercing_of(&work, keys[i].end).triangle;
        if (!last) continue;
        link_group(&work, keys + begin, i + 1 - begin);
        begin = i + 1;
    }
    if (s->names != NULL) name_ends_at_seams(&work, piece_count, keys, spare_keys);
}

/* ---- tracing ------------------------------------------------------------------------------------------- */

/* A place on a curve: in a piece, going towards one of its ends, with the triangle of the first sheet. */
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

/* Follows a curve from its start, and adds its pieces and the piercings of its points. */
static void trace_curve(curve_joiner *j, curve_place at, cscd_curve *curve) {
    uint32_t first_piece = at.piece, first_triangle = at.first;
    surface_piercing piercing = j->found[at.piece].ends[1 - at.towards];
    curve->start = end_of_link(j->links[2 * at.piece + 1 - at.towards]);
    curve->closed = false;
    for (bool more = true; more && !curve->closed;) {
        const curve_piece *piece = &j->found[at.piece];
        uint32_t end = 2 * at.piece + at.towards;
        size_t point = curve->first_point + curve->point_count++;
        j->piercings[point] = piercing;
        j->end_points[end ^ 1] = (uint32_t)point;
        j->end_points[end] = (uint32_t)point + 1;
        j->pieces[curve->first_piece + curve->piece_count++] =
            (cscd_curve_piece){at.first, piece->a == at.first ? piece->b : piece->a};
        j->piece_curves[at.piece] = (uint32_t)j->curve_count;
        piercing = piece->ends[at.towards];
        curve->end = end_of_link(j->links[end]);
        more = go_on(j, &at);
        curve->closed = more && at.piece == first_piece;
        if (curve->closed) j->end_points[end] = (uint32_t)curve->first_point;
    }
    curve->swapped = curve->closed && at.first != first_triangle;
    if (!curve->closed) j->piercings[curve->first_point + curve->point_count++] = piercing;
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
        piercing_point at;
        piercing_point_find(work->surface, j->piercings[i], &at);
        j->points[i] = (cscd_curve_point){
            j->piercings[i].edge, j->piercings[i].triangle, at.s, at.u, at.v, {at.x[0], at.x[1], at.x[2]}};
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

cscd_status curve_joiner_run(curve_joiner *j, const named_surface *s, const cscd_intersection *pairs,
                             size_t pair_count, cscd_curves *out) {
    curve_work work = {j, s, pairs, pair_count};
    if (pair_count > LINKS_MAX / 2 || !reserve_pairs(j, pair_count)) return CSCD_OUT_OF_MEMORY;
    j->pair_count = pair_count;
    find_pieces(&work);
    if (progress_cancelled(&j->context->progress)) return CSCD_CANCELLED;
    if (!reserve_pieces(j, j->piece_count)) return CSCD_OUT_OF_MEMORY;
    find_links(s, j->found, j->piece_count, j->keys, j->spare_keys, j->links);
    trace_curves(&work);
    parallel_run(j->context->threads, (uint32_t)((j->point_count + POINTS_A_TASK - 1) / POINTS_A_TASK),
                 find_some_points, &work);
    measure_lengths(j);
    name_curves_of_pairs(&work);
    *out = (cscd_curves){j->curves, j->curve_count, j->points,      j->point_count,
                         j->pieces, j->piece_count, j->pair_curves, pair_count};
    return context_progress_status(j->context);
}

/* ---- curves along which surfaces only touch ------------------------------------------------------------ */

/* None of their pairs crosses, and what they bound has depth 0. */

typedef struct touching_work {
    const cscd_mesh *mesh;
    const surface_bodies *bodies;
    const cscd_patches *patches;
    const cscd_depths *depths;
} touching_work;

/* Has the patch a depth above 0 in the body? */
static bool patch_is_deep(const touching_work *w, uint32_t patch, uint32_t body) {
    size_t low = 0, high = w->depths->patch_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const cscd_patch_depth *at = &w->depths->patches[middle];
        if (at->patch < patch || (at->patch == patch && at->body < body))
            low = middle + 1;
        else
            high = middle;
    }
    if (low == w->depths->patch_count) return false;
    const cscd_patch_depth *found = &w->depths->patches[low];
    return found->patch == patch && found->body == body && w->depths->items[found->deepest].depth > 0.0;
}

/* The first item of a range whose vertex, or edge, is not below a number. */
static size_t find_item(const touching_work *w, size_t low, size_t high, bool of_edges, uint32_t number) {
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const cscd_depth *at = &w->depths->items[middle];
        if ((of_edges ? at->edge : at->vertex) < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool vertex_is_deep(const touching_work *w, uint32_t vertex, uint32_t body) {
    uint32_t patch = w->patches->vertex_patches[vertex];
    if (patch != UINT32_MAX) return patch_is_deep(w, patch, body);
    const cscd_depth *items = w->depths->items;
    size_t end = w->depths->vertex_count;
    for (size_t i = find_item(w, 0, end, false, vertex); i < end && items[i].vertex == vertex; i++) {
        if (items[i].body == body && items[i].depth > 0.0) return true;
    }
    return false;
}

static bool edge_is_deep(const touching_work *w, uint32_t edge, uint32_t body) {
    const cscd_depth *items = w->depths->items;
    size_t end = w->depths->count;
    for (size_t i = find_item(w, w->depths->vertex_count, end, true, edge); i < end && items[i].edge == edge;
         i++) {
        if (items[i].body == body && items[i].depth > 0.0) return true;
    }
    return false;
}

static bool point_is_deep(const touching_work *w, const cscd_curve_point *point) {
    if (point->edge == UINT32_MAX) return false;
    uint32_t body = body_of_triangle(w->bodies, w->mesh, point->triangle);
    const uint32_t *ends = w->mesh->edges[point->edge];
    return vertex_is_deep(w, ends[0], body) || vertex_is_deep(w, ends[1], body) ||
           edge_is_deep(w, point->edge, body);
}

void touching_curves_mark(curve_joiner *j, const named_surface *s, const cscd_intersection *pairs,
                          const cscd_patches *patches, const cscd_depths *depths) {
    const touching_work work = {s->mesh, s->bodies, patches, depths};
    for (size_t i = 0; i < j->curve_count; i++) j->curves[i].touching = true;
    for (size_t i = 0; i < j->pair_count; i++) {
        if (pairs[i].kind == CSCD_INTERSECTION_CROSSING && j->pair_curves[i] != UINT32_MAX)
            j->curves[j->pair_curves[i]].touching = false;
    }
    for (size_t i = 0; i < j->curve_count; i++) {
        cscd_curve *curve = &j->curves[i];
        for (size_t k = 0; k < curve->point_count && curve->touching; k++)
            curve->touching = !point_is_deep(&work, &j->points[curve->first_point + k]);
    }
}
