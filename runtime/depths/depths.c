/* The depths of buried vertices, edges and triangles below the outer surfaces of bodies. */
#include "runtime/depths/depths.h"

#include "runtime/depths/deepest_points.h"
#include "runtime/depths/outer_surface.h"
#include "src/core/floating.h"
#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

_Static_assert(sizeof(depth_question) <= sizeof(cscd_depth), "questions are sorted in the room of depths");

/* ---- the deepest point of a part of an edge ------------------------------------------------------------ */

/* A place on an edge; distance: scaled. */
typedef struct edge_place {
    double s, x[3], distance;
    outer_point nearest;
} edge_place;

/* The part of an edge that a body contains. */
typedef struct edge_search {
    const outer_surface *outer;
    const surface_cuts *found;
    const bvh *bvh;
    uint32_t body;
    const double *ends[2];
    double s[2];             /* where on the edge it begins, and ends */
    double length;           /* of the edge; scaled */
    const outer_point *near; /* the last answer, or NULL */
} edge_search;

/* deepest: at places that are no deeper than this, scaled, the depth may be less than what is set; -1: it is none of those. */
static edge_place place_at(const edge_search *e, double s, const outer_point *near, double deepest) {
    edge_place at = {.s = s};
    for (int k = 0; k < 3; k++) at.x[k] = e->ends[0][k] + s * (e->ends[1][k] - e->ends[0][k]);
    at.nearest = outer_surface_search(e->outer, e->found, e->bvh, e->body, at.x, near, deepest);
    at.distance = sqrt(at.nearest.squared);
    return at;
}

/* No point in between is deeper. The depth changes by no more than the way; and it is no more than the distance from one
 * convex part, which is largest at an end. */
static double bound_between(const edge_search *e, const edge_place *a, const edge_place *b) {
    double by_way = 0.5 * (a->distance + b->distance + (b->s - a->s) * e->length);
    const outer_surface *outer = e->outer;
    double by_first = max_of(a->distance, outer_part_reach(outer, b->x, &a->nearest.part));
    double by_last = max_of(b->distance, outer_part_reach(outer, a->x, &b->nearest.part));
    return min_of(by_way, min_of(by_first, by_last));
}

enum { HALVINGS_MAX = 64 };

/* Halves what may be deeper by more than a millionth of the edge. */
static edge_place search_edge(const edge_search *e) {
    edge_place ends[HALVINGS_MAX + 1], at = place_at(e, e->s[0], e->near, -1.0), deepest = at;
    int count = 0;
    ends[count++] = place_at(e, e->s[1], &at.nearest, deepest.distance);
    if (ends[0].distance > deepest.distance) deepest = ends[0];
    while (count > 0) { /* from at to the last one of ends */
        edge_place *end = &ends[count - 1];
        bool halve = count < HALVINGS_MAX && bound_between(e, &at, end) > deepest.distance + 1e-6 * e->length;
        if (!halve) {
            at = *end;
            count--;
            continue;
        }
        ends[count] = place_at(e, at.s + 0.5 * (end->s - at.s), &at.nearest, deepest.distance);
        if (ends[count].distance > deepest.distance) deepest = ends[count];
        count++;
    }
    return deepest;
}

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_of_depths(depth_finder *d, size_t count) {
    return (array_list){{ARRAY(d->depths, count)}};
}

static depth_finder empty_finder(cscd_context *context) {
    return (depth_finder){.context = context,
                          .outer = {.context = context, .cuts = {.context = context}},
                          .deepest = {.context = context}};
}

depth_finder *depth_finder_create(cscd_context *context) {
    depth_finder *d = context_allocate(context, 1, sizeof *d);
    if (d != NULL) *d = empty_finder(context);
    return d;
}

void depth_finder_clear(depth_finder *d) {
    cscd_context *context = d->context;
    outer_surface_free(&d->outer);
    deepest_finder_free(&d->deepest);
    context_free_all(context, list_of_depths(d, 0));
    context_free(context, d->questions);
    context_free(context, d->patches);
    *d = empty_finder(context);
}

void depth_finder_destroy(depth_finder *d) {
    if (d == NULL) return;
    depth_finder_clear(d);
    context_free(d->context, d);
}

/* ---- questions ----------------------------------------------------------------------------------------- */

typedef struct depth_work {
    depth_finder *finder;
    const surface_cuts *found;
    const bvh *bvh;
    double rounding; /* what computed depths may be off by */
} depth_work;

/* With its answer, and what sorting takes. */
static bool take_question(const depth_finder *d) {
    return memory_budget_take(d->outer.budget, 1,
                              MEMORY_WHILE_DOUBLING * sizeof *d->questions + 2 * sizeof *d->depths);
}

static bool add_question(depth_finder *d, depth_question question) {
    if (!take_question(d)) return false;
    if (d->question_count == d->question_capacity) {
        size_t larger = d->question_capacity == 0 ? 64 : 2 * d->question_capacity;
        depth_question *grown =
            context_grow(d->context, d->questions, d->question_count, larger, sizeof *grown);
        if (grown == NULL) return false;
        d->questions = grown;
        d->question_capacity = larger;
    }
    d->questions[d->question_count++] = question;
    return true;
}

/* The patch of a corner of one of the vertex's triangles. */
static uint32_t patch_in_star(const depth_work *work, uint32_t vertex, uint32_t triangle) {
    const uint32_t *corners = work->found->surface->mesh->triangles[triangle];
    uint32_t corner = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
    return work->found->patches->corner_patches[(size_t)triangle * 3 + corner];
}

/* At a vertex at which curves end, the own body's number is the least around it, since it differs from triangle to
 * triangle; those of other bodies do not. */
static bool own_contains(const depth_work *work, uint32_t vertex) {
    const cscd_mesh *mesh = work->found->surface->mesh;
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        uint32_t patch = patch_in_star(work, vertex, mesh->vertex_stars[i]);
        if (work->found->patches->patches[patch].own < 1) return false;
    }
    return true;
}

/* A vertex none of whose triangles has an area is a vertex of no surface. */
static bool has_surface(const depth_work *work, uint32_t vertex) {
    const named_surface *s = work->found->surface;
    for (uint32_t i = s->mesh->vertex_star_offsets[vertex]; i < s->mesh->vertex_star_offsets[vertex + 1];
         i++) {
        double normal[3];
        surface_normal(s->mesh, s->positions, s->mesh->vertex_stars[i], normal);
        if (surface_norm(normal) > 0.0) return true;
    }
    return false;
}

static bool ask_of_vertex(const depth_work *work, uint32_t vertex) {
    const cscd_mesh *mesh = work->found->surface->mesh;
    const patch_finder *p = work->found->patches;
    if (vertex_has_no_triangle(mesh, vertex)) return true;
    uint32_t patch = p->vertex_patches[vertex];
    const cscd_patch *of =
        &p->patches[patch != UINT32_MAX
                        ? patch
                        : patch_in_star(work, vertex, mesh->vertex_stars[mesh->vertex_star_offsets[vertex]])];
    for (uint32_t i = 0; i < of->winding_count; i++) {
        cscd_winding w = p->windings[of->first_winding + i];
        if (w.number < 1 || !has_surface(work, vertex)) continue;
        if (patch == UINT32_MAX && w.body == of->body && !own_contains(work, vertex)) continue;
        uint32_t face = mesh->vertex_stars[mesh->vertex_star_offsets[vertex]];
        depth_question question = {vertex, UINT32_MAX, face, patch, w.body, {0.0, 0.0}};
        if (!add_question(work->finder, question)) return false;
    }
    return true;
}

/* Asks for the depths of the parts of an edge that a body contains between two of its passages. `last` keeps
 * the last passage of each body, and the corner's numbers its number. */
static bool ask_of_edge(const depth_work *work, const loaded_cut *cut, uint32_t i, cut_border *last) {
    const cscd_mesh *mesh = work->found->surface->mesh;
    uint32_t edge = mesh->triangle_edges[cut->triangle][i];
    bool along = mesh->edges[edge][0] == mesh->triangles[cut->triangle][i];
    int32_t *numbers = cut->cut.corner_numbers + (size_t)i * cut->cut.slot_count;
    for (uint32_t slot = 0; slot < cut->cut.slot_count; slot++) last[slot].s = (double)INFINITY;
    for (size_t k = 0; k < cut->cut.border_count; k++) {
        const cut_border *b = &cut->cut.borders[k];
        if (b->edge != i) continue;
        double s = last[b->slot].s;
        if (numbers[b->slot] >= 1 && s < b->s) {
            depth_question question = {UINT32_MAX,
                                       edge,
                                       mesh->edge_stars[mesh->edge_star_offsets[edge]],
                                       UINT32_MAX,
                                       cut->slot_bodies[b->slot],
                                       {along ? s : 1.0 - b->s, along ? b->s : 1.0 - s}};
            if (!add_question(work->finder, question)) return false;
        }
        last[b->slot] = *b;
        numbers[b->slot] += b->jump;
    }
    return true;
}

/* The first triangle of an edge that has an area asks for the edge. Without an area there is no projection,
 * and the triangle says nothing of the edge that the others do not. */
static bool asks_of_edge(const depth_work *work, uint32_t triangle, uint32_t edge) {
    const named_surface *s = work->found->surface;
    for (uint32_t i = s->mesh->edge_star_offsets[edge]; i < s->mesh->edge_star_offsets[edge + 1]; i++) {
        double normal[3];
        if (s->mesh->edge_stars[i] == triangle) return true;
        surface_normal(s->mesh, s->positions, s->mesh->edge_stars[i], normal);
        if (surface_norm(normal) > 0.0) return false;
    }
    return false;
}

/* Do curves pass through one of the triangle's edges more than once? */
static bool passes_an_edge_twice(const depth_work *work, const triangle_cuts *c, size_t begin, size_t end) {
    const uint32_t *edges = work->found->surface->mesh->triangle_edges[c->keys[begin].number];
    bool passed[3] = {false, false, false};
    for (size_t k = begin; k < end; k++) {
        const curve_piece *piece = &work->found->curves->found[c->keys[k].end / 2];
        for (int e = 0; e < 2; e++) {
            for (int i = 0; i < 3; i++) {
                if (piece->ends[e].edge != edges[i]) continue;
                if (passed[i]) return true;
                passed[i] = true;
            }
        }
    }
    return false;
}

static bool ask_of_edges(const depth_work *work) {
    triangle_cuts *c = &work->finder->outer.cuts;
    const cscd_mesh *mesh = work->found->surface->mesh;
    for (size_t begin = 0, end = 0; begin < c->key_count; begin = end) {
        loaded_cut cut;
        while (end < c->key_count && c->keys[end].number == c->keys[begin].number) end++;
        if (!passes_an_edge_twice(work, c, begin, end)) continue;
        if (!triangle_cuts_load(c, work->found, begin, end, &cut)) return false;
        if (cut.stretch == 0.0) continue;
        for (uint32_t i = 0; i < 3; i++) {
            uint32_t edge = mesh->triangle_edges[cut.triangle][i];
            if (!asks_of_edge(work, cut.triangle, edge)) continue;
            if (!ask_of_edge(work, &cut, i, c->spare_borders)) return false;
        }
    }
    return true;
}

/* ---- answers ------------------------------------------------------------------------------------------- */

/* The outward normal at the nearest point, for a point that is on the surface. */
static void find_normal(const depth_work *work, uint32_t triangle, double out[3]) {
    const named_surface *s = work->found->surface;
    surface_normal(s->mesh, s->positions, triangle, out);
    double norm = surface_norm(out) * surface_sense(s, triangle);
    for (int k = 0; k < 3; k++) out[k] = norm != 0.0 ? out[k] / norm : 0.0;
}

static void set_answer(const depth_work *work, const outer_point *nearest, cscd_depth *out) {
    out->triangle = nearest->triangle;
    if (nearest->triangle == UINT32_MAX) return; /* no outer surface: the body is all within itself */
    for (int k = 0; k < 3; k++) out->direction[k] = nearest->x[k] - out->x[k];
    out->depth = surface_norm(out->direction);
    if (out->depth <= work->rounding &&
        (out->vertex == UINT32_MAX || body_has_point(work->found->surface, work->bvh, out->body, out->x)))
        out->depth = 0.0;
    out->bound = out->depth;
    if (out->depth > 0.0)
        for (int k = 0; k < 3; k++) out->direction[k] /= out->depth;
    else
        find_normal(work, nearest->triangle, out->direction);
}

/* near: an answer for the same body, or NULL. Returns the answer, and so below. */
static outer_point answer_edge(const depth_work *work, const depth_question *q, const outer_point *near,
                               cscd_depth *out) {
    const named_surface *s = work->found->surface;
    const outer_surface *outer = &work->finder->outer;
    const uint32_t *v = s->mesh->edges[q->edge];
    const edge_search e = {outer,
                           work->found,
                           work->bvh,
                           q->body,
                           {s->positions + (size_t)v[0] * 3, s->positions + (size_t)v[1] * 3},
                           {q->s[0], q->s[1]},
                           surface_edge_length(s->mesh, s->positions, q->edge) * outer->scale,
                           near};
    const edge_place deepest = search_edge(&e);
    out->s = deepest.s;
    memcpy(out->x, deepest.x, sizeof out->x);
    set_answer(work, &deepest.nearest, out);
    return deepest.nearest;
}

static outer_point answer_vertex(const depth_work *work, const depth_question *q, const outer_point *near,
                                 cscd_depth *out) {
    memcpy(out->x, work->found->surface->positions + (size_t)q->vertex * 3, sizeof out->x);
    const outer_point nearest =
        outer_surface_search(&work->finder->outer, work->found, work->bvh, q->body, out->x, near, -1.0);
    set_answer(work, &nearest, out);
    return nearest;
}

enum { QUESTIONS_A_TASK = 16 };

/* Questions that follow each other are often asked at places that are near to each other. */
static void answer_some(void *data, uint32_t task) {
    const depth_work *work = data;
    const depth_finder *d = work->finder;
    size_t first = (size_t)task * QUESTIONS_A_TASK, end = first + QUESTIONS_A_TASK;
    outer_point last;
    if (!progress_go_on(&d->context->progress, (double)first / (double)d->question_count)) return;
    for (size_t i = first; i < end && i < d->question_count; i++) {
        const depth_question *q = &d->questions[i];
        const outer_point *near = i > first && q[-1].body == q->body ? &last : NULL;
        cscd_depth *out = &d->depths[i];
        *out = (cscd_depth){
            .vertex = q->vertex, .edge = q->edge, .face = q->face, .patch = q->patch, .body = q->body};
        last = q->edge == UINT32_MAX ? answer_vertex(work, q, near, out) : answer_edge(work, q, near, out);
    }
}

/* ---- patches ------------------------------------------------------------------------------------------- */

/* The faces of a patch in one body follow each other. */
static size_t list_patches(depth_finder *d, size_t first, size_t end) {
    size_t count = 0;
    for (size_t i = first; i < end; i++) {
        const cscd_depth *at = &d->depths[i];
        cscd_patch_depth *last = count > 0 ? &d->patches[count - 1] : NULL;
        if (at->patch == UINT32_MAX) break;
        if (last == NULL || last->patch != at->patch || last->body != at->body)
            d->patches[count++] = (cscd_patch_depth){at->patch, at->body, i};
        else if (at->depth > d->depths[last->deepest].depth)
            last->deepest = i;
    }
    return count;
}

/* Edges come in the order of the triangles that asked. */
static int compare_questions(const void *a, const void *b) {
    const depth_question *p = a, *q = b;
    if (p->edge != q->edge) return p->edge < q->edge ? -1 : 1;
    if (p->body != q->body) return p->body < q->body ? -1 : 1;
    return (p->s[0] > q->s[0]) - (p->s[0] < q->s[0]);
}

/* Computed distances are off by a few units in the last place of the largest coordinate. */
static double rounding_of(const named_surface *s) {
    double largest = 0.0;
    for (size_t i = 0; i < (size_t)s->mesh->vertex_count * 3; i++)
        largest = max_of(largest, fabs(s->positions[i]));
    return largest * 0x1p-46;
}

/* A search costs this number of comparisons. One search for each vertex is work in proportion to the mesh;
 * vertices that many bodies contain have more. */
enum { A_SEARCH = 256 };

static bool take_searches(const depth_work *work, size_t count) {
    const size_t vertices = work->found->surface->mesh->vertex_count;
    return memory_budget_work(work->found->budget, count > vertices ? count - vertices : 0, A_SEARCH);
}

/* Writes the answers of vertices and edges. */
static cscd_status find_points(depth_work *work, size_t *vertices) {
    depth_finder *d = work->finder;
    d->question_count = 0;
    for (uint32_t v = 0; v < work->found->surface->mesh->vertex_count; v++) {
        if (!ask_of_vertex(work, v)) return CSCD_OUT_OF_MEMORY;
    }
    *vertices = d->question_count;
    if (!ask_of_edges(work)) return CSCD_OUT_OF_MEMORY;
    size_t count = d->question_count;
    if (!outer_surface_take_work(&d->outer, count) || !take_searches(work, count)) return CSCD_OUT_OF_MEMORY;
    if (!context_renew_all(d->context, list_of_depths(d, room_with_spare(count)), &d->depth_capacity, count))
        return CSCD_OUT_OF_MEMORY;
    if (count > *vertices) /* depths are not there yet, so theirs is the room for sorting */
        sort_items(d->questions + *vertices, d->depths, count - *vertices, sizeof *d->questions,
                   compare_questions);
    parallel_run(d->context->threads, (uint32_t)((count + QUESTIONS_A_TASK - 1) / QUESTIONS_A_TASK),
                 answer_some, work);
    return progress_cancelled(&d->context->progress) ? CSCD_CANCELLED : CSCD_OK;
}

/* Room for as many more depths, behind those of points. */
static bool reserve_faces(depth_finder *d, size_t points, size_t faces) {
    const size_t count = points + faces;
    if (!memory_budget_take(d->outer.budget, faces, 2 * sizeof *d->depths + sizeof *d->patches)) return false;
    if (faces > d->patch_capacity || d->patches == NULL) {
        context_free(d->context, d->patches);
        d->patches = context_reserve(d->context, room_with_spare(faces), sizeof *d->patches);
        d->patch_capacity = d->patches != NULL ? room_with_spare(faces) : 0;
        if (d->patches == NULL) return false;
    }
    if (count <= d->depth_capacity) return true;
    cscd_depth *grown = context_grow(d->context, d->depths, points, room_with_spare(count), sizeof *grown);
    if (grown == NULL) return false;
    d->depths = grown;
    d->depth_capacity = room_with_spare(count);
    return true;
}

cscd_status depth_finder_run(depth_finder *d, const surface_cuts *found, const depth_request *request,
                             cscd_depths *out) {
    depth_work work = {d, found, request->bvh, rounding_of(found->surface)};
    size_t vertices, points;
    if (!outer_surface_find(&d->outer, found, request->bvh)) return CSCD_OUT_OF_MEMORY;
    cscd_status status = find_points(&work, &vertices);
    if (status != CSCD_OK) return status;
    points = d->question_count;
    const depth_facts facts = {.found = found,
                               .bvh = request->bvh,
                               .outer = &d->outer,
                               .cuts = &d->outer.cuts,
                               .labels = request->labels,
                               .pairs = request->pairs,
                               .pair_count = request->pair_count,
                               .vertices = d->depths,
                               .vertex_count = vertices,
                               .limit = request->limit,
                               .rounding = work.rounding};
    if (!deepest_finder_begin(&d->deepest, &facts))
        return progress_cancelled(&d->context->progress) ? CSCD_CANCELLED : CSCD_OUT_OF_MEMORY;
    if (!reserve_faces(d, points, d->deepest.group_count)) return CSCD_OUT_OF_MEMORY;
    depth_facts moved = facts;
    moved.vertices = d->depths;
    size_t count = points + deepest_finder_run(&d->deepest, &moved, d->depths + points);
    if (progress_cancelled(&d->context->progress)) return CSCD_CANCELLED;
    *out = (cscd_depths){.items = d->depths,
                         .count = count,
                         .vertex_count = vertices,
                         .edge_count = points - vertices,
                         .patches = d->patches,
                         .patch_count = list_patches(d, points, count)};
    return context_progress_status(d->context);
}
