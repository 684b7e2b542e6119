/* Wrong points and the places on the other sheet where they belong. A lens is what two sheets that pass through each other bound
 * together; a curve bounds a patch of each. The way out of a wrong patch leads through the lens to the patch beyond the curve. */
#include "runtime/untangle/lenses.h"

#include "runtime/untangle/wrong_sides.h"
#include "src/core/sort.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* The lists of entries: wrong vertices by patch, curves by patch, patches by patch. */
enum { OF_VERTICES, OF_CURVES, OF_PARTNERS, LISTS };

/* Points that are nearer than this to their places, in edge lengths, go along the normal there. */
static const double near_place = 1e-3;

/* The way out of a closed component has at least this share along the normal. */
static const double least_slope = 0.1;

static array_list list_arrays(lens_finder *f) {
    const cscd_mesh *mesh = f->w->mesh;
    const size_t n = mesh->vertex_count, t = mesh->triangle_count;
    return (array_list){{ARRAY(f->patches, n), ARRAY(f->wrong, n), ARRAY(f->sides, n),
                         ARRAY(f->crossings, mesh->edge_count), ARRAY(f->stamps, t),
                         ARRAY(f->queue, n > t ? n : t), ARRAY(f->areas, n), ARRAY(f->colours, n),
                         ARRAY(f->distances, 2 * n)}};
}

bool lens_finder_make(lens_finder *f, untangle_work *w) {
    *f = (lens_finder){.w = w, .set = {.context = w->context}};
    return context_allocate_all(w->context, list_arrays(f));
}

void lens_finder_free(lens_finder *f) {
    cscd_context *context = f->w->context;
    context_free_all(context, list_arrays(f));
    for (int i = 0; i < LISTS; i++) context_free(context, f->entries[i]);
    context_free(context, f->triangles);
    context_free(context, f->points);
    triangle_set_free(&f->set);
}

/* ---- lists --------------------------------------------------------------------------------------------- */

/* Makes room for one more item of a list. */
static bool make_room(cscd_context *context, void **items, size_t count, size_t *capacity, size_t size) {
    if (count < *capacity) return true;
    const size_t more = room_with_spare(count);
    void *grown = context_grow(context, *items, count, more, size);
    if (grown == NULL) return false;
    *items = grown;
    *capacity = more;
    return true;
}

bool lens_finder_add(lens_finder *f, int list, uint32_t patch, uint32_t number) {
    void *items = f->entries[list];
    const bool room = make_room(f->w->context, &items, f->entry_counts[list], &f->entry_capacities[list],
                                sizeof(patch_entry));
    f->entries[list] = items;
    if (room) f->entries[list][f->entry_counts[list]++] = (patch_entry){(uint64_t)patch << 32 | number};
    return room;
}

bool lens_finder_sort(lens_finder *f, int list) {
    const size_t count = f->entry_counts[list];
    if (count < 2) return true;
    patch_entry *scratch = context_reserve(f->w->context, count, sizeof *scratch);
    if (scratch == NULL) return false;
    sort_by_number(f->entries[list], scratch, count, sizeof *scratch);
    context_free(f->w->context, scratch);
    return true;
}

size_t lens_finder_first(const lens_finder *f, int list, uint32_t patch) {
    size_t low = 0, high = f->entry_counts[list];
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (entry_patch(f->entries[list][middle]) < patch)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool add_triangle(lens_finder *f, uint32_t triangle) {
    if (f->stamps[triangle] == f->stamp) return true;
    f->stamps[triangle] = f->stamp;
    void *items = f->triangles;
    const bool room =
        make_room(f->w->context, &items, f->triangle_count, &f->triangle_capacity, sizeof *f->triangles);
    f->triangles = items;
    if (room) f->triangles[f->triangle_count++] = triangle;
    return room;
}

static void begin_triangles(lens_finder *f) {
    f->triangle_count = 0;
    f->stamp++;
}

/* Adds the triangles around those that are there. */
static bool widen_triangles(lens_finder *f, uint32_t rings) {
    const cscd_mesh *mesh = f->w->mesh;
    size_t first = 0;
    for (uint32_t ring = 0; ring < rings; ring++) {
        const size_t end = f->triangle_count;
        for (size_t i = first; i < end; i++) {
            for (int k = 0; k < 3; k++) {
                const uint32_t v = mesh->triangles[f->triangles[i]][k];
                for (uint32_t s = mesh->vertex_star_offsets[v]; s < mesh->vertex_star_offsets[v + 1]; s++) {
                    if (!add_triangle(f, mesh->vertex_stars[s])) return false;
                }
            }
        }
        first = end;
    }
    return true;
}

bool lens_finder_add_point(lens_finder *f, const lens_point *point) {
    void *items = f->points;
    const bool room = make_room(f->w->context, &items, f->point_count, &f->point_capacity, sizeof *f->points);
    f->points = items;
    if (room) f->points[f->point_count++] = *point;
    return room;
}

/* ---- the wrong patches of a curve ------------------------------------------------------------------------ */

/* The triangle of a piece on one of the two sheets. */
static uint32_t piece_triangle(const cscd_curves *curves, size_t piece, int sheet) {
    return sheet == 0 ? curves->pieces[piece].a : curves->pieces[piece].b;
}

/* ---- folds ----------------------------------------------------------------------------------------------- */

/* Where both traces of a curve bound one wrong patch, as skin that is folded through itself, it is halved between them. */

/* Distances, in edges within the patch, from its vertices on a trace. Returns whether there are any. */
static bool measure_from_trace(lens_finder *f, const cscd_curves *curves, const cscd_curve *c, int sheet,
                               uint32_t patch, uint32_t *distances) {
    const cscd_mesh *mesh = f->w->mesh;
    const vertex_graph *g = &f->w->graph;
    uint32_t count = 0;
    for (size_t i = c->first_piece; i < c->first_piece + c->piece_count; i++) {
        for (int k = 0; k < 3; k++) {
            const uint32_t v = g->names[mesh->triangles[piece_triangle(curves, i, sheet)][k]];
            if (!f->wrong[v] || f->patches[v] != patch || distances[v] != UINT32_MAX) continue;
            distances[v] = 0;
            f->queue[count++] = v;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t v = f->queue[i];
        for (size_t n = g->begins[v]; n < g->begins[v + 1]; n++) {
            const uint32_t other = g->neighbours[n];
            if (f->patches[other] != patch || !f->wrong[other] || distances[other] != UINT32_MAX) continue;
            distances[other] = distances[v] + 1;
            f->queue[count++] = other;
        }
    }
    return count > 0;
}

/* Is the vertex on both traces? Then it is the start of none. */
static void halve_patch(lens_finder *f, const cscd_curves *curves, const cscd_curve *c, uint32_t patch) {
    const uint32_t n = f->w->mesh->vertex_count;
    uint32_t *from_first = f->distances, *from_second = f->distances + n;
    memset(from_first, 0xff, 2 * (size_t)n * sizeof *from_first);
    const bool first = measure_from_trace(f, curves, c, 0, patch, from_first);
    const bool second = measure_from_trace(f, curves, c, 1, patch, from_second);
    uint32_t half = 0, all = 0;
    for (uint32_t v = 0; first && second && v < n; v++) {
        if (f->patches[v] != patch || !f->wrong[v]) continue;
        all++;
        half += from_second[v] < from_first[v];
    }
    if (all < 4 || half == 0 || half == all) return;
    for (uint32_t v = 0; v < n; v++) {
        if (f->patches[v] == patch && f->wrong[v] && from_second[v] < from_first[v])
            f->patches[v] = f->next_patch;
    }
    f->next_patch++;
}

/* Returns a patch that both traces bound and that comes after `last`; UINT32_MAX: there is none. */
static uint32_t folded_patch(const lens_finder *f, const cscd_curves *curves, const cscd_curve *c,
                             uint32_t last, bool any) {
    const cscd_mesh *mesh = f->w->mesh;
    uint32_t best = UINT32_MAX;
    for (size_t i = c->first_piece; i < c->first_piece + c->piece_count; i++) {
        for (int k = 0; k < 3; k++) {
            const uint32_t v = mesh->triangles[curves->pieces[i].a][k], patch = f->patches[v];
            if (!f->wrong[v] || patch >= best || (any && patch <= last)) continue;
            for (size_t j = c->first_piece; j < c->first_piece + c->piece_count; j++) {
                const uint32_t *other = mesh->triangles[curves->pieces[j].b];
                for (int l = 0; l < 3; l++) {
                    if (f->wrong[other[l]] && f->patches[other[l]] == patch) best = patch;
                }
                if (best == patch) break;
            }
        }
    }
    return best;
}

static void halve_folds(lens_finder *f, const cscd_curves *curves) {
    for (size_t i = 0; i < curves->count; i++) {
        const cscd_curve *c = &curves->items[i];
        if (c->components[0] != c->components[1]) continue;
        const uint32_t end = f->next_patch;
        uint32_t patch = folded_patch(f, curves, c, 0, false);
        while (patch < end) {
            halve_patch(f, curves, c, patch);
            patch = folded_patch(f, curves, c, patch, true);
        }
    }
}

/* ---- partners -------------------------------------------------------------------------------------------- */

/* Adds the wrong patches of one sheet of a curve to a list, as (patch, number), perhaps more than once. */
static bool add_patches(lens_finder *f, const cscd_curves *curves, size_t curve, int sheet, int list,
                        uint32_t number) {
    const cscd_curve *c = &curves->items[curve];
    uint32_t last = UINT32_MAX;
    for (size_t i = c->first_piece; i < c->first_piece + c->piece_count; i++) {
        const uint32_t *corners = f->w->mesh->triangles[piece_triangle(curves, i, sheet)];
        for (int k = 0; k < 3; k++) {
            if (!f->wrong[corners[k]] || f->patches[corners[k]] == last) continue;
            last = f->patches[corners[k]];
            if (!lens_finder_add(f, list, last, number)) return false;
        }
    }
    return true;
}

static void keep_different(lens_finder *f, int list) {
    patch_entry *e = f->entries[list];
    size_t kept = 0;
    for (size_t i = 0; i < f->entry_counts[list]; i++) {
        if (kept == 0 || e[kept - 1].key != e[i].key) e[kept++] = e[i];
    }
    f->entry_counts[list] = kept;
}

/* Lists for each wrong patch its vertices, and its curves, twice the number plus the sheet. */
static bool list_patches(lens_finder *f, const cscd_curves *curves) {
    for (int i = 0; i < LISTS; i++) f->entry_counts[i] = 0;
    for (uint32_t v = 0; v < f->w->mesh->vertex_count; v++) {
        if (f->wrong[v] && !lens_finder_add(f, OF_VERTICES, f->patches[v], v)) return false;
    }
    for (size_t i = 0; i < curves->count; i++) {
        for (int sheet = 0; sheet < 2; sheet++) {
            if (!add_patches(f, curves, i, sheet, OF_CURVES, (uint32_t)(2 * i) + (uint32_t)sheet))
                return false;
        }
    }
    if (!lens_finder_sort(f, OF_VERTICES) || !lens_finder_sort(f, OF_CURVES)) return false;
    keep_different(f, OF_CURVES);
    return true;
}

/* The triangles in which the points of a patch look for their places: along its curves, those of the other sheets, and the wrong
 * patches there; but none with a corner in the patch. */
static bool choose_triangles(lens_finder *f, const cscd_curves *curves, uint32_t patch, uint32_t rings) {
    const cscd_mesh *mesh = f->w->mesh;
    begin_triangles(f);
    f->entry_counts[OF_PARTNERS] = 0;
    for (size_t i = lens_finder_first(f, OF_CURVES, patch);
         i < f->entry_counts[OF_CURVES] && entry_patch(f->entries[OF_CURVES][i]) == patch; i++) {
        const size_t curve = entry_number(f->entries[OF_CURVES][i]) / 2;
        const int other = 1 - (int)(entry_number(f->entries[OF_CURVES][i]) & 1);
        const cscd_curve *c = &curves->items[curve];
        for (size_t p = c->first_piece; p < c->first_piece + c->piece_count; p++) {
            if (!add_triangle(f, piece_triangle(curves, p, other))) return false;
        }
        if (!add_patches(f, curves, curve, other, OF_PARTNERS, 0)) return false;
    }
    if (!widen_triangles(f, rings)) return false;
    if (!lens_finder_sort(f, OF_PARTNERS)) return false;
    keep_different(f, OF_PARTNERS);
    for (size_t i = 0; i < f->entry_counts[OF_PARTNERS]; i++) {
        const uint32_t partner = entry_patch(f->entries[OF_PARTNERS][i]);
        for (size_t k = lens_finder_first(f, OF_VERTICES, partner);
             k < f->entry_counts[OF_VERTICES] && entry_patch(f->entries[OF_VERTICES][k]) == partner; k++) {
            const uint32_t v = entry_number(f->entries[OF_VERTICES][k]);
            for (uint32_t s = mesh->vertex_star_offsets[v]; s < mesh->vertex_star_offsets[v + 1]; s++) {
                if (!add_triangle(f, mesh->vertex_stars[s])) return false;
            }
        }
    }
    size_t kept = 0;
    for (size_t i = 0; i < f->triangle_count; i++) {
        const uint32_t *corners = mesh->triangles[f->triangles[i]];
        const bool own = f->patches[corners[0]] == patch || f->patches[corners[1]] == patch ||
                         f->patches[corners[2]] == patch;
        if (!own) f->triangles[kept++] = f->triangles[i];
    }
    f->triangle_count = kept;
    return true;
}

/* ---- points -------------------------------------------------------------------------------------------- */

void lens_normal(const lens_finder *f, const double *x, uint32_t triangle, double out[3]) {
    const uint32_t *corners = f->w->mesh->triangles[triangle];
    double u[3], v[3];
    vec3_subtract(x + 3 * (size_t)corners[1], x + 3 * (size_t)corners[0], u);
    vec3_subtract(x + 3 * (size_t)corners[2], x + 3 * (size_t)corners[0], v);
    vec3_cross(u, v, out);
    const double length = sqrt(vec3_dot(out, out));
    for (int k = 0; k < 3; k++) out[k] = length > 0.0 ? out[k] / length : 0.0;
}

static bool triangle_is_closed(const lens_finder *f, uint32_t triangle) {
    const cscd_mesh *mesh = f->w->mesh;
    return mesh->components[mesh->triangle_components[triangle]].closed_manifold;
}

/* Writes the place, and the way there from a point at `from`. The way out of a closed component leads along its normals, and from
 * where it is inside out against them; side is that of the point. */
static void take_place(const lens_finder *f, const double *x, const double *from, const set_place *place,
                       int side, lens_point *out) {
    const uint32_t *corners = f->w->mesh->triangles[place->triangle];
    double normal[3], way[3] = {-from[0], -from[1], -from[2]};
    lens_normal(f, x, place->triangle, normal);
    for (int i = 0; i < 3; i++) {
        out->vertices[2 + i] = corners[i];
        out->weights[2 + i] = -place->weights[i];
        vec3_add_scaled(way, place->weights[i], x + 3 * (size_t)corners[i], way);
    }
    const double length = sqrt(vec3_dot(way, way));
    const bool far = length > near_place * f->w->graph.edge_length;
    for (int k = 0; k < 3; k++) out->direction[k] = far ? way[k] / length : normal[k];
    out->thickness = length;
    if (side == 0 || !triangle_is_closed(f, place->triangle)) return;
    if (side * vec3_dot(out->direction, normal) < least_slope) {
        for (int k = 0; k < 3; k++) out->direction[k] = side * normal[k];
        out->thickness = 0.0;
    }
}

/* The axis of a patch: its vector area, which depends on its border alone, if it is large enough to mean something; towards the
 * other sheet, or for buried patches of closed components into the component. */
static bool patch_axis(const lens_finder *f, const double *x, size_t first, size_t end, double out[3]) {
    const cscd_mesh *mesh = f->w->mesh;
    const uint32_t patch = entry_patch(f->entries[OF_VERTICES][first]);
    double sum[3] = {0.0, 0.0, 0.0}, area = 0.0, own[3] = {0.0, 0.0, 0.0}, others[3] = {0.0, 0.0, 0.0};
    bool closed = false;
    for (size_t i = first; i < end; i++) {
        const uint32_t v = entry_number(f->entries[OF_VERTICES][i]);
        vec3_add_scaled(own, 1.0 / (double)(end - first), x + 3 * (size_t)v, own);
        for (uint32_t s = mesh->vertex_star_offsets[v]; s < mesh->vertex_star_offsets[v + 1]; s++) {
            const uint32_t t = mesh->vertex_stars[s], *corners = mesh->triangles[t];
            const bool whole = f->patches[corners[0]] == patch && f->patches[corners[1]] == patch &&
                               f->patches[corners[2]] == patch;
            double u[3], w[3], across[3];
            if (!whole || corners[0] != v) continue; /* each once */
            vec3_subtract(x + 3 * (size_t)corners[1], x + 3 * (size_t)corners[0], u);
            vec3_subtract(x + 3 * (size_t)corners[2], x + 3 * (size_t)corners[0], w);
            vec3_cross(u, w, across);
            vec3_add_scaled(sum, 0.5, across, sum);
            area += 0.5 * sqrt(vec3_dot(across, across));
            closed = triangle_is_closed(f, t);
        }
    }
    const double length = sqrt(vec3_dot(sum, sum));
    if (!(length > 0.05 * area)) return false;
    double towards = -1.0;
    if (!closed || f->set.count == 0 || !triangle_is_closed(f, f->set.items[0])) {
        for (uint32_t i = 0; i < f->set.count; i++) {
            const uint32_t *corners = mesh->triangles[f->set.items[i]];
            for (int k = 0; k < 3; k++)
                vec3_add_scaled(others, 1.0 / (3.0 * f->set.count), x + 3 * (size_t)corners[k], others);
        }
        vec3_subtract(others, own, others);
        towards = vec3_dot(others, sum) >= 0.0 ? 1.0 : -1.0;
    }
    for (int k = 0; k < 3; k++) out[k] = towards * sum[k] / length;
    return true;
}

/* Along the axis, as far as the other sheet reaches; a point that meets nothing goes as far as its nearest place. */
static void follow_axis(const lens_finder *f, const double *x, const double *from, const double axis[3],
                        lens_point *point) {
    const set_place hit = triangle_set_farthest_hit(&f->set, from, axis);
    if (hit.triangle != UINT32_MAX) {
        take_place(f, x, from, &hit, 0, point);
        point->thickness = hit.distance;
    } else {
        point->thickness =
            min_of(point->thickness, max_of(point->thickness * vec3_dot(point->direction, axis), 0.0));
    }
    memcpy(point->direction, axis, sizeof(double[3]));
}

static bool has_vertex(const lens_finder *f, const lens_point *point, uint32_t vertex) {
    const uint32_t *names = f->w->graph.names;
    for (int i = 2; i < 5; i++) {
        if (names[point->vertices[i]] == names[vertex]) return true;
    }
    return false;
}

static bool add_points_of_patch(lens_finder *f, const cscd_intersections *found, const double *x,
                                const lens_rules *rules, size_t first, size_t end) {
    double axis[3];
    const uint32_t patch = entry_patch(f->entries[OF_VERTICES][first]);
    if (!choose_triangles(f, found->curves, patch, rules->rings)) return false;
    if (f->triangle_count == 0) return true;
    if (!triangle_set_make(&f->set, f->w->mesh, x, f->triangles, (uint32_t)f->triangle_count, end - first))
        return false;
    const bool along = rules->along_axis && patch_axis(f, x, first, end, axis);
    for (size_t i = first; i < end; i++) {
        const uint32_t v = entry_number(f->entries[OF_VERTICES][i]);
        const double *from = x + 3 * (size_t)v;
        const set_place place = triangle_set_nearest(&f->set, from);
        lens_point point = {.vertices = {v, v}, .weights = {1.0, 0.0}};
        take_place(f, x, from, &place, f->sides[v], &point);
        if (along) follow_axis(f, x, from, axis, &point);
        if (has_vertex(f, &point, v)) continue;
        if (!lens_finder_add_point(f, &point)) return false;
    }
    return true;
}

/* ---- edges ----------------------------------------------------------------------------------------------- */

/* On which side of the triangle at a curve point is the edge behind the point: 1 inside, -1 outside. */
static int side_behind(const lens_finder *f, const double *x, const cscd_curve_point *point) {
    const uint32_t *ends = f->w->mesh->edges[point->edge];
    double normal[3], along[3];
    lens_normal(f, x, point->triangle, normal);
    vec3_subtract(x + 3 * (size_t)ends[1], x + 3 * (size_t)ends[0], along);
    return vec3_dot(along, normal) < 0.0 ? 1 : -1;
}

/* A piece of an edge between two curve points. */
static bool add_point_of_edge(lens_finder *f, const double *x, const cscd_curve_point *a,
                              const cscd_curve_point *b) {
    const uint32_t *ends = f->w->mesh->edges[a->edge];
    const double s = 0.5 * (a->s + b->s);
    const int side = side_behind(f, x, a);
    double from[3];
    for (int k = 0; k < 3; k++)
        from[k] = (1.0 - s) * x[3 * (size_t)ends[0] + (size_t)k] + s * x[3 * (size_t)ends[1] + (size_t)k];
    begin_triangles(f);
    if (!add_triangle(f, a->triangle) || !add_triangle(f, b->triangle) || !widen_triangles(f, 1))
        return false;
    size_t kept = 0;
    for (size_t i = 0; i < f->triangle_count; i++) {
        const uint32_t *corners = f->w->mesh->triangles[f->triangles[i]];
        bool shares = false;
        for (int k = 0; k < 3; k++) shares |= corners[k] == ends[0] || corners[k] == ends[1];
        if (!shares) f->triangles[kept++] = f->triangles[i];
    }
    if (kept == 0) return true;
    if (!triangle_set_make(&f->set, f->w->mesh, x, f->triangles, (uint32_t)kept, 1)) return false;
    const set_place place = triangle_set_nearest(&f->set, from);
    lens_point point = {.vertices = {ends[0], ends[1]}, .weights = {1.0 - s, s}};
    take_place(f, x, from, &place, side, &point);
    return lens_finder_add_point(f, &point);
}

static int compare_on_edge(const void *a, const void *b) {
    const cscd_curve_point *const *p = a, *const *q = b;
    if ((*p)->edge != (*q)->edge) return (*p)->edge < (*q)->edge ? -1 : 1;
    if ((*p)->s != (*q)->s) return (*p)->s < (*q)->s ? -1 : 1;
    return (*p)->triangle < (*q)->triangle ? -1 : (*p)->triangle > (*q)->triangle;
}

static bool add_points_of_edges(lens_finder *f, const cscd_curves *curves, const double *x) {
    size_t count = 0;
    const cscd_curve_point **points = context_reserve(f->w->context, 2 * curves->point_count, sizeof *points);
    if (points == NULL) return false;
    for (size_t i = 0; i < curves->point_count; i++) {
        const uint32_t edge = curves->points[i].edge;
        if (edge != UINT32_MAX && f->crossings[edge] > 1) points[count++] = &curves->points[i];
    }
    if (count > 1) sort_items(points, points + curves->point_count, count, sizeof *points, compare_on_edge);
    bool room = true, wrong = false;
    for (size_t i = 0; room && i < count; i++) {
        if (i == 0 || points[i]->edge != points[i - 1]->edge) {
            wrong = f->wrong[f->w->mesh->edges[points[i]->edge][0]];
        } else if (wrong) {
            room = add_point_of_edge(f, x, points[i - 1], points[i]);
        }
        wrong = !wrong;
    }
    context_free(f->w->context, points);
    return room;
}

/* ---- all points -------------------------------------------------------------------------------------------- */

cscd_status lenses_find(lens_finder *f, const cscd_intersections *found, const double *x,
                        const lens_rules *rules) {
    f->point_count = 0;
    f->thickness = 0.0;
    if (!wrong_sides_find(f, found)) return CSCD_OUT_OF_MEMORY;
    halve_folds(f, found->curves);
    if (!list_patches(f, found->curves)) return CSCD_OUT_OF_MEMORY;
    const size_t count = f->entry_counts[OF_VERTICES];
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i; end < count &&
                      entry_patch(f->entries[OF_VERTICES][end]) == entry_patch(f->entries[OF_VERTICES][i]);)
            end++;
        if (!add_points_of_patch(f, found, x, rules, i, end)) return CSCD_OUT_OF_MEMORY;
    }
    if (!add_points_of_edges(f, found->curves, x) || !flush_pairs_add(f, found, x)) return CSCD_OUT_OF_MEMORY;
    for (size_t i = 0; i < f->point_count; i++) f->thickness = max_of(f->thickness, f->points[i].thickness);
    return CSCD_OK;
}
