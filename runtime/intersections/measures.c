/* The volumes of overlaps and the lengths of curves, by pair of bodies, each with its gradient:
 * docs/theory/curves.md, lemmas 11 and 12. */
#include "runtime/intersections/named_surface.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

/* A triangle that bounds a volume, or with the triangle UINT32_MAX the fact that the volume is unknown. The derivative by
 * corner i is weights[i] times the normal, as long as twice the area. */
typedef struct volume_share {
    uint64_t bodies; /* see key_of_bodies */
    double weights[3];
    uint32_t triangle;
} volume_share;

/* Integrals over the parts of a projected triangle, each part as often as it bounds a volume: of 1, and of the place
 * relative to corner 0. */
typedef struct bounding_moments {
    double area, place[2];
} bounding_moments;

struct measure_finder {
    cscd_context *context;
    volume_share *shares;
    size_t share_count, share_capacity;
    curve_key *keys, *spare_keys; /* number: two bodies; end: a share, or a piece */
    size_t key_count, key_capacity;
    bounding_moments *moments; /* per slot */
    size_t moment_capacity;
    triangle_cuts cuts;
    overlap_gaps gaps;

    /* Per vertex: the derivative for the bodies at hand, and whether the vertex is listed. Between two pairs of bodies no
     * vertex is, and all sums are 0. */
    double (*sums)[3];
    bool *is_listed;
    uint32_t *listed, *spare_listed;
    size_t vertex_capacity, listed_count;

    cscd_measure *measures;
    size_t measure_capacity;
    cscd_vertex_gradient *gradients;
    size_t gradient_count, gradient_capacity;
};

static array_list list_of_keys(measure_finder *m, size_t count) {
    return (array_list){{ARRAY(m->keys, count), ARRAY(m->spare_keys, count), ARRAY(m->measures, count)}};
}

static array_list list_of_moments(measure_finder *m, size_t count) {
    return (array_list){{ARRAY(m->moments, count)}};
}

static array_list list_of_vertices(measure_finder *m, size_t count) {
    return (array_list){{ARRAY(m->sums, count), ARRAY(m->is_listed, count), ARRAY(m->listed, count),
                         ARRAY(m->spare_listed, count)}};
}

static measure_finder empty_finder(cscd_context *context) {
    return (measure_finder){.context = context, .cuts = {.context = context}, .gaps = {.context = context}};
}

measure_finder *measure_finder_create(cscd_context *context) {
    measure_finder *m = context_allocate(context, 1, sizeof *m);
    if (m != NULL) *m = empty_finder(context);
    return m;
}

void measure_finder_clear(measure_finder *m) {
    cscd_context *context = m->context;
    context_free_all(context, list_of_keys(m, 0));
    context_free_all(context, list_of_moments(m, 0));
    context_free_all(context, list_of_vertices(m, 0));
    context_free(context, m->shares);
    context_free(context, m->gradients);
    triangle_cuts_free(&m->cuts);
    overlap_gaps_free(&m->gaps);
    *m = empty_finder(context);
}

void measure_finder_destroy(measure_finder *m) {
    if (m == NULL) return;
    measure_finder_clear(m);
    context_free(m->context, m);
}

/* One measure of all pairs of bodies. */
typedef struct measure_work {
    measure_finder *finder;
    const surface_cuts *found;
    const cscd_mesh *mesh;
    const double *positions;
    bool out_of_memory;
} measure_work;

static measure_work begin_work(measure_finder *m, const surface_cuts *found) {
    m->share_count = m->key_count = m->gradient_count = 0;
    return (measure_work){m, found, found->surface->mesh, found->surface->positions, false};
}

/* Makes room for a number of items behind those of an array, which may move. NULL: no memory. */
static void *grow_for(measure_work *work, void *items, size_t count, size_t more, size_t *capacity,
                      size_t size) {
    if (!memory_budget_take(work->found->budget, more, MEMORY_WHILE_DOUBLING * size)) return NULL;
    if (items != NULL && more <= *capacity - count) return items;
    const size_t larger = room_with_spare(2 * count + more);
    void *grown = context_grow(work->finder->context, items, count, larger, size);
    if (grown != NULL) *capacity = larger;
    return grown;
}

/* ---- the triangles that bound a volume ----------------------------------------------------------------- */

static void add_share(measure_work *work, volume_share share) {
    measure_finder *m = work->finder;
    volume_share *grown = work->out_of_memory ? NULL
                                              : grow_for(work, m->shares, m->share_count, 1,
                                                         &m->share_capacity, sizeof *m->shares);
    if (grown == NULL) {
        work->out_of_memory = true;
        return;
    }
    m->shares = grown;
    m->shares[m->share_count++] = share;
}

static void add_unknown(measure_work *work, uint64_t bodies) {
    add_share(work, (volume_share){bodies, {0.0, 0.0, 0.0}, UINT32_MAX});
}

static bool component_is_closed(const measure_work *work, uint32_t component) {
    return work->mesh->components[component].closed_manifold;
}

static bool triangle_is_closed(const measure_work *work, uint32_t triangle) {
    return component_is_closed(work, work->mesh->triangle_components[triangle]);
}

/* Returns how often the surface of a body with a number just outside bounds what it contains together with a body of the
 * other number, or, without that, what it contains more than once. */
static double times_bounding(const measure_work *work, int32_t own, uint32_t other, int32_t number) {
    return own == 0 ? patch_times_within(work->found->patches, other, number) : 0.0;
}

static double times_bounding_itself(int32_t own) {
    return own >= 1 ? 1.0 : 0.0;
}

static void add_whole_triangle(measure_work *work, uint32_t triangle, const cscd_patch *patch) {
    const cscd_winding *windings = work->found->patches->windings + patch->first_winding;
    for (uint32_t i = 0; i < patch->winding_count; i++) {
        const double times = windings[i].body == patch->body
                                 ? times_bounding_itself(windings[i].number)
                                 : times_bounding(work, patch->own, windings[i].body, windings[i].number);
        const double weight = times * surface_sense(work->found->surface, triangle) / 6.0;
        if (times == 0.0) continue;
        add_share(
            work,
            (volume_share){key_of_bodies(patch->body, windings[i].body), {weight, weight, weight}, triangle});
    }
}

static void add_whole_triangles(measure_work *work) {
    const patch_finder *p = work->found->patches;
    for (uint32_t t = 0; t < work->mesh->triangle_count; t++) {
        const uint32_t patch = p->triangle_patches[t];
        if (patch == UINT32_MAX || p->patches[patch].winding_count == 0 || !triangle_is_closed(work, t))
            continue;
        add_whole_triangle(work, t, &p->patches[patch]);
    }
}

/* A triangle whose parts are taken. */
typedef struct cut_integral {
    const measure_work *work;
    const loaded_cut *cut;
    bounding_moments *moments; /* per slot */
} cut_integral;

/* The integrals of a part, which two triangles make up. */
static bounding_moments moments_of_part(const cut_part *part, const double corner[2]) {
    const double width = part->x[1] - part->x[0];
    const double left = part->x[0] - corner[0], right = part->x[1] - corner[0];
    const double areas[2] = {0.5 * width * (part->high[1] - part->low[1]),
                             0.5 * width * (part->high[0] - part->low[0])};
    const double both = (part->low[0] - corner[1]) + (part->high[1] - corner[1]);
    const double heights[2] = {both + (part->low[1] - corner[1]), both + (part->high[0] - corner[1])};
    return (bounding_moments){areas[0] + areas[1],
                              {(areas[0] * (left + 2.0 * right) + areas[1] * (2.0 * left + right)) / 3.0,
                               (areas[0] * heights[0] + areas[1] * heights[1]) / 3.0}};
}

static void add_moments(bounding_moments *sum, double times, const bounding_moments *part) {
    sum->area += times * part->area;
    sum->place[0] += times * part->place[0];
    sum->place[1] += times * part->place[1];
}

static void integrate_part(void *data, const cut_part *part) {
    const cut_integral *of = data;
    const bounding_moments moments = moments_of_part(part, of->cut->cut.corners[0]);
    for (uint32_t i = 0; i < part->listed_count; i++) {
        const uint32_t slot = part->listed[i];
        const double times = slot == 0 ? times_bounding_itself(part->numbers[0])
                                       : times_bounding(of->work, part->numbers[0],
                                                        of->cut->slot_bodies[slot], part->numbers[slot]);
        if (times != 0.0) add_moments(&of->moments[slot], times, &moments);
    }
}

/* The integrals of the three barycentric coordinates in the projection, over twice its area. */
static void integrate_corners(const loaded_cut *cut, const bounding_moments *m, double out[3]) {
    const double(*c)[2] = (const double(*)[2])cut->cut.corners;
    const double u[2] = {c[1][0] - c[0][0], c[1][1] - c[0][1]}, v[2] = {c[2][0] - c[0][0], c[2][1] - c[0][1]};
    const double twice = u[0] * v[1] - u[1] * v[0];
    const double first = (m->place[0] * v[1] - m->place[1] * v[0]) / twice;
    const double second = (u[0] * m->place[1] - u[1] * m->place[0]) / twice;
    out[0] = (m->area - first - second) / twice;
    out[1] = first / twice;
    out[2] = second / twice;
}

static void add_slots(measure_work *work, const loaded_cut *cut) {
    const double sense = surface_sense(work->found->surface, cut->triangle);
    for (uint32_t slot = 0; slot < cut->cut.slot_count; slot++) {
        const bounding_moments *m = &work->finder->moments[slot];
        if (m->area == 0.0) continue;
        volume_share share = {.bodies = key_of_bodies(cut->slot_bodies[0], cut->slot_bodies[slot]),
                              .triangle = cut->triangle};
        integrate_corners(cut, m, share.weights);
        for (int i = 0; i < 3; i++) share.weights[i] *= sense;
        add_share(work, share);
    }
}

static bool integrate_cut(measure_work *work, loaded_cut *cut) {
    measure_finder *m = work->finder;
    const size_t slots = cut->cut.slot_count;
    if (!context_renew_all(m->context, list_of_moments(m, room_with_spare(slots)), &m->moment_capacity,
                           slots))
        return false;
    memset(m->moments, 0, slots * sizeof *m->moments);
    cut_integral integral = {work, cut, m->moments};
    if (!cut_triangle_divide(m->context, &cut->cut, &m->cuts.memory, integrate_part, &integral)) return false;
    add_slots(work, cut);
    return true;
}

static bool add_cut_triangles(measure_work *work) {
    triangle_cuts *c = &work->finder->cuts;
    if (!triangle_cuts_sort(c, work->found)) return false;
    for (size_t begin = 0, end = 0; begin < c->key_count && !work->out_of_memory; begin = end) {
        loaded_cut cut;
        while (end < c->key_count && c->keys[end].number == c->keys[begin].number) end++;
        if (!triangle_is_closed(work, (uint32_t)c->keys[begin].number)) continue;
        if (!triangle_cuts_load(c, work->found, begin, end, &cut)) return false;
        if (cut.stretch > 0.0 && !integrate_cut(work, &cut)) return false;
    }
    return true;
}

/* ---- what is unknown ----------------------------------------------------------------------------------- */

/* An open component has no inside, so what it has in common with a body that it crosses, or that contains a patch of it, is
 * unknown. */
static void add_open_components(measure_work *work) {
    const patch_finder *p = work->found->patches;
    const curve_joiner *j = work->found->curves;
    for (size_t i = 0; i < j->curve_count; i++) {
        const cscd_curve *c = &j->curves[i];
        if (!component_is_closed(work, c->components[0]) || !component_is_closed(work, c->components[1]))
            add_unknown(work, key_of_bodies(curve_body(work->found->surface, c, 0),
                                            curve_body(work->found->surface, c, 1)));
    }
    for (size_t i = 0; i < p->patch_count; i++) {
        const cscd_patch *patch = &p->patches[i];
        for (uint32_t k = 0; k < patch->winding_count && !component_is_closed(work, patch->component); k++) {
            const cscd_winding w = p->windings[patch->first_winding + k];
            if (w.number >= 1) add_unknown(work, key_of_bodies(patch->body, w.body));
        }
    }
}

static void add_gaps(measure_work *work) {
    const overlap_gaps *g = &work->finder->gaps;
    for (size_t i = 0; i < g->count; i++)
        if (i == 0 || g->bodies[i] != g->bodies[i - 1]) add_unknown(work, g->bodies[i]);
}

/* ---- sums ---------------------------------------------------------------------------------------------- */

static bool begin_vertices(measure_work *work) {
    measure_finder *m = work->finder;
    const size_t count = work->mesh->vertex_count, room = room_with_spare(count);
    if (!memory_budget_take_all(work->found->budget, list_of_vertices(m, room)) ||
        !context_renew_all(m->context, list_of_vertices(m, room), &m->vertex_capacity, count))
        return false;
    memset(m->sums, 0, count * sizeof *m->sums);
    memset(m->is_listed, false, count * sizeof *m->is_listed);
    m->listed_count = 0;
    return true;
}

static bool begin_keys(measure_work *work, size_t count) {
    measure_finder *m = work->finder;
    const size_t room = room_with_spare(count);
    return memory_budget_take_all(work->found->budget, list_of_keys(m, room)) &&
           context_renew_all(m->context, list_of_keys(m, room), &m->key_capacity, count);
}

static void add_to_vertex(measure_finder *m, uint32_t vertex, double weight, const double direction[3]) {
    if (!m->is_listed[vertex]) {
        m->is_listed[vertex] = true;
        m->listed[m->listed_count++] = vertex;
    }
    for (int k = 0; k < 3; k++) m->sums[vertex][k] += weight * direction[k];
}

static int compare_vertices(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Moves the sums of the bodies at hand into the list of gradients. */
static bool take_gradients(measure_work *work, cscd_measure *measure) {
    measure_finder *m = work->finder;
    cscd_vertex_gradient *grown = grow_for(work, m->gradients, m->gradient_count, m->listed_count,
                                           &m->gradient_capacity, sizeof *grown);
    if (grown == NULL) return false;
    m->gradients = grown;
    measure->first_gradient = m->gradient_count;
    measure->gradient_count = m->listed_count;
    sort_items(m->listed, m->spare_listed, m->listed_count, sizeof *m->listed, compare_vertices);
    for (size_t i = 0; i < m->listed_count; i++) {
        const uint32_t vertex = m->listed[i];
        cscd_vertex_gradient *to = &m->gradients[m->gradient_count++];
        *to = (cscd_vertex_gradient){.vertex = vertex};
        memcpy(to->gradient, m->sums[vertex], sizeof to->gradient);
        memset(m->sums[vertex], 0, sizeof to->gradient);
        m->is_listed[vertex] = false;
    }
    m->listed_count = 0;
    return true;
}

/* Measures the bodies of some keys: its value, and the sums of the vertices. False: the value is unknown. */
typedef bool measure_function(measure_work *work, const curve_key *keys, size_t count, double *value);

/* Goes through the keys of all pairs of bodies. False: no memory. */
static bool sum_up_keys(measure_work *work, measure_function *measure, cscd_measures *out) {
    measure_finder *m = work->finder;
    size_t count = 0, unknown = 0;
    double sum = 0.0;
    sort_by_number(m->keys, m->spare_keys, m->key_count, sizeof *m->keys);
    for (size_t begin = 0, end = 0; begin < m->key_count; begin = end) {
        const uint64_t bodies = m->keys[begin].number;
        while (end < m->key_count && m->keys[end].number == bodies) end++;
        cscd_measure *next = &m->measures[count++];
        *next = (cscd_measure){
            .a = (uint32_t)(bodies >> 32), .b = (uint32_t)bodies, .first_gradient = m->gradient_count};
        if (!measure(work, m->keys + begin, end - begin, &next->value)) {
            next->value = (double)NAN;
            unknown++;
            continue;
        }
        sum += next->value;
        if (!take_gradients(work, next)) return false;
    }
    *out = (cscd_measures){m->measures, count, m->gradients, m->gradient_count, sum, unknown};
    return true;
}

/* ---- volumes ------------------------------------------------------------------------------------------- */

/* A volume has the degree 3 in all positions: so three times as much is the sum of derivatives times positions, from any
 * origin, since a translation changes nothing. The first vertex is as near as any. */
static double volume_of_sums(const measure_work *work) {
    const measure_finder *m = work->finder;
    double sum = 0.0;
    for (size_t i = 0; i < m->listed_count; i++) {
        double from[3];
        vec3_subtract(work->positions + (size_t)m->listed[i] * 3, work->positions + (size_t)m->listed[0] * 3,
                      from);
        sum += vec3_dot(from, m->sums[m->listed[i]]);
    }
    return sum / 3.0;
}

static bool measure_volume(measure_work *work, const curve_key *keys, size_t count, double *value) {
    measure_finder *m = work->finder;
    if (overlap_gaps_have(&m->gaps, (uint32_t)(keys[0].number >> 32), (uint32_t)keys[0].number)) return false;
    for (size_t i = 0; i < count; i++)
        if (m->shares[keys[i].end].triangle == UINT32_MAX) return false;
    for (size_t i = 0; i < count; i++) {
        const volume_share *share = &m->shares[keys[i].end];
        double normal[3];
        surface_normal(work->mesh, work->positions, share->triangle, normal);
        for (int k = 0; k < 3; k++)
            add_to_vertex(m, work->mesh->triangles[share->triangle][k], share->weights[k], normal);
    }
    *value = volume_of_sums(work);
    return true;
}

static bool list_shares(measure_work *work) {
    measure_finder *m = work->finder;
    if (!begin_keys(work, m->share_count)) return false;
    for (size_t i = 0; i < m->share_count; i++) m->keys[i] = (curve_key){m->shares[i].bodies, i};
    m->key_count = m->share_count;
    return true;
}

cscd_status overlap_volumes_run(measure_finder *m, const surface_cuts *found, const left_out_pairs *left_out,
                                cscd_measures *out) {
    measure_work work = begin_work(m, found);
    if (work.mesh->triangle_count == 0) {
        *out = (cscd_measures){.count = 0};
        return CSCD_OK;
    }
    if (!overlap_gaps_find(&m->gaps, found, left_out)) return CSCD_OUT_OF_MEMORY;
    add_whole_triangles(&work);
    add_open_components(&work);
    add_gaps(&work);
    if (!add_cut_triangles(&work) || work.out_of_memory) return CSCD_OUT_OF_MEMORY;
    if (!list_shares(&work) || !begin_vertices(&work)) return CSCD_OUT_OF_MEMORY;
    return sum_up_keys(&work, measure_volume, out) ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

/* ---- lengths of curves --------------------------------------------------------------------------------- */

static void find_unit_normal(const measure_work *work, uint32_t triangle, double out[3]) {
    surface_normal(work->mesh, work->positions, triangle, out);
    const double norm = surface_norm(out);
    for (int k = 0; k < 3; k++) out[k] = norm > 0.0 ? out[k] / norm : 0.0;
}

/* Divides a vector by its length, and returns how many times its rounding errors, which are those of numbers of this size,
 * are as large as it: INFINITY where it is 0. */
static double make_unit(double v[3], double size) {
    const double norm = surface_norm(v);
    if (norm == 0.0) return (double)INFINITY;
    for (int k = 0; k < 3; k++) v[k] /= norm;
    return size / norm;
}

/* Writes the unit vector along a piece, from both normals or from both points, whichever is better known. The normals say it
 * for the shortest pieces, the points for planes that hardly cross. All 0: nobody knows. */
static void find_piece_direction(const measure_work *work, const curve_piece *piece, const double from[3],
                                 const double to[3], double out[3]) {
    double a[3], b[3], along[3];
    find_unit_normal(work, piece->a, a);
    find_unit_normal(work, piece->b, b);
    vec3_cross(a, b, along);
    vec3_subtract(to, from, out);
    const double by_points = make_unit(out, vec3_largest(from) + vec3_largest(to));
    const double by_normals = make_unit(along, 1.0);
    if (by_normals < by_points) memcpy(out, along, sizeof along);
}

/* Adds the derivatives of the way of a piercing along a direction. The point stays on the line of its edge, and in the
 * plane of its triangle, which moves at the point as the mean of its corners. If the edge lies in that plane, the point
 * goes with the edge. */
static void add_piercing(measure_work *work, const cscd_curve_point *at, const double direction[3]) {
    measure_finder *m = work->finder;
    if (at->edge == NO_EDGE) {
        add_to_vertex(m, at->triangle, 1.0, direction);
        return;
    }
    const uint32_t *ends = work->mesh->edges[at->edge], *corners = work->mesh->triangles[at->triangle];
    double normal[3], edge[3], across[3];
    find_unit_normal(work, at->triangle, normal);
    vec3_subtract(work->positions + (size_t)ends[1] * 3, work->positions + (size_t)ends[0] * 3, edge);
    const double rise = vec3_dot(normal, edge);
    const double slide = rise != 0.0 ? vec3_dot(direction, edge) / rise : 0.0;
    vec3_add_scaled(direction, -slide, normal, across);
    add_to_vertex(m, ends[0], 1.0 - at->s, across);
    add_to_vertex(m, ends[1], at->s, across);
    add_to_vertex(m, corners[0], slide * (1.0 - at->u - at->v), normal);
    add_to_vertex(m, corners[1], slide * at->u, normal);
    add_to_vertex(m, corners[2], slide * at->v, normal);
}

static bool measure_length(measure_work *work, const curve_key *keys, size_t count, double *value) {
    const curve_joiner *j = work->found->curves;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        const size_t piece = (size_t)keys[i].end;
        const cscd_curve_point *from = &j->points[j->end_points[2 * piece]],
                               *to = &j->points[j->end_points[2 * piece + 1]];
        double along[3], back[3];
        find_piece_direction(work, &j->found[piece], from->x, to->x, along);
        for (int k = 0; k < 3; k++) back[k] = -along[k];
        add_piercing(work, from, back);
        add_piercing(work, to, along);
        sum += sqrt(vec3_squared_distance(from->x, to->x));
    }
    *value = sum;
    return true;
}

static void list_pieces(measure_work *work) {
    measure_finder *m = work->finder;
    const curve_joiner *j = work->found->curves;
    for (size_t i = 0; i < j->piece_count; i++) {
        const uint32_t a = surface_body(work->found->surface, j->found[i].a),
                       b = surface_body(work->found->surface, j->found[i].b);
        m->keys[i] = (curve_key){key_of_bodies(a, b), i};
    }
    m->key_count = j->piece_count;
}

cscd_status curve_lengths_run(measure_finder *m, const surface_cuts *found, cscd_measures *out) {
    measure_work work = begin_work(m, found);
    if (!begin_keys(&work, found->curves->piece_count) || !begin_vertices(&work)) return CSCD_OUT_OF_MEMORY;
    list_pieces(&work);
    return sum_up_keys(&work, measure_length, out) ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}
