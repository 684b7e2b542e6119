/* Edges that pass through another sheet and back: a piece of one is wrong, and has no vertex. */
#include "runtime/untangle/lenses.h"

#include "src/core/sort.h"
#include "src/core/vec3.h"

/* On which side of the triangle at a curve point is the edge behind the point: 1 inside, -1 outside. */
static int side_behind(const lens_finder *f, const double *x, const cscd_curve_point *point) {
    const uint32_t *ends = f->w->mesh->edges[point->edge];
    double normal[3], along[3];
    lens_normal(f, x, point->triangle, normal);
    vec3_subtract(x + 3 * (size_t)ends[1], x + 3 * (size_t)ends[0], along);
    return vec3_dot(along, normal) < 0.0 ? 1 : -1;
}

/* The curve of one of the points. */
static uint32_t curve_of_point(const cscd_curves *curves, const cscd_curve_point *point) {
    const size_t place = (size_t)(point - curves->points);
    size_t low = 0, high = curves->count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (curves->items[middle].first_point <= place)
            low = middle;
        else
            high = middle;
    }
    return (uint32_t)low;
}

/* A piece of an edge between two curve points. */
static bool add_point_of_edge(lens_finder *f, const cscd_curves *curves, const double *x,
                              const cscd_curve_point *a, const cscd_curve_point *b) {
    const uint32_t *ends = f->w->mesh->edges[a->edge];
    const double s = 0.5 * (a->s + b->s);
    const int side = side_behind(f, x, a);
    double from[3];
    for (int k = 0; k < 3; k++)
        from[k] = (1.0 - s) * x[3 * (size_t)ends[0] + (size_t)k] + s * x[3 * (size_t)ends[1] + (size_t)k];
    lens_triangles_begin(f);
    if (!lens_triangles_add(f, a->triangle) || !lens_triangles_add(f, b->triangle) ||
        !lens_triangles_widen(f, 1))
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
    lens_point point = {.vertices = {ends[0], ends[1]},
                        .weights = {1.0 - s, s},
                        .reason = CSCD_LENS_EDGE,
                        .group = curve_of_point(curves, a),
                        .edge = a->edge};
    lens_take_place(f, x, from, &place, side, &point);
    return lens_finder_add_point(f, &point) && lens_finder_add(f, DECIDED, point.group, 0) &&
           lens_finder_add(f, DECIDED, curve_of_point(curves, b), 0);
}

static int compare_on_edge(const void *a, const void *b) {
    const cscd_curve_point *const *p = a, *const *q = b;
    if ((*p)->edge != (*q)->edge) return (*p)->edge < (*q)->edge ? -1 : 1;
    if ((*p)->s != (*q)->s) return (*p)->s < (*q)->s ? -1 : 1;
    return (*p)->triangle < (*q)->triangle ? -1 : (*p)->triangle > (*q)->triangle;
}

bool lens_edges_add(lens_finder *f, const cscd_curves *curves, const double *x) {
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
            room = add_point_of_edge(f, curves, x, points[i - 1], points[i]);
        }
        wrong = !wrong;
    }
    context_free(f->w->context, points);
    return room;
}
