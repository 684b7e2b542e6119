/* Lenses of the public API: points by patch and sheet, sorted, with what they have in common. */
#include "runtime/untangle/lenses.h"
#include "src/core/sort.h"
#include "src/core/vec3.h"
#include "src/mesh/positions.h"

#include <math.h>

/* What the points of one lens have in common: the reason, the group, components and parts of both sides. */
enum { NAMES = 6 };

/* A point, and what it is sorted by. */
typedef struct named_point {
    uint32_t names[NAMES];
    uint32_t vertex, edge;
    double s;
    const lens_point *point;
} named_point;

/* Those of one lens. */
typedef struct lens_range {
    size_t begin, end;
    double thickness;
    bool whole; /* all points of its patch are in it */
} lens_range;

typedef struct lens_search {
    cscd_detector *detector;
    const cscd_mesh *mesh;
    const double *x;
    const cscd_patches *patches;
    lens_finder finder;
    named_point *points; /* and as much room to sort them */
    lens_range *ranges;  /* the same */
    size_t point_count, range_count;
    cscd_lenses out;
} lens_search;

/* ---- points by lens -------------------------------------------------------------------------------------- */

static uint32_t component_of(const cscd_mesh *mesh, const lens_point *point) {
    const uint32_t triangle = point->edge == UINT32_MAX
                                  ? mesh->vertex_stars[mesh->vertex_star_offsets[point->vertices[0]]]
                                  : mesh->edge_stars[mesh->edge_star_offsets[point->edge]];
    return mesh->triangle_components[triangle];
}

static named_point name_point(const lens_search *s, const lens_point *point) {
    const part_labels *labels = &s->detector->config.parts;
    const bool vertex = point->edge == UINT32_MAX;
    return (named_point){.names = {(uint32_t)point->reason, point->group, component_of(s->mesh, point),
                                   s->mesh->triangle_components[point->triangle],
                                   vertex ? part_of_vertex(labels, s->mesh, point->vertices[0])
                                          : part_of_edge(labels, s->mesh, point->edge),
                                   part_of_triangle(labels, s->mesh, point->triangle)},
                         .vertex = vertex ? point->vertices[0] : UINT32_MAX,
                         .edge = point->edge,
                         .s = vertex ? 0.0 : point->weights[1],
                         .point = point};
}

static int compare_names(const named_point *a, const named_point *b, int count) {
    for (int i = 0; i < count; i++) {
        if (a->names[i] != b->names[i]) return a->names[i] < b->names[i] ? -1 : 1;
    }
    return 0;
}

static int compare_points(const void *p, const void *q) {
    const named_point *a = p, *b = q;
    const int names = compare_names(a, b, NAMES);
    if (names != 0) return names;
    if (a->vertex != b->vertex) return a->vertex < b->vertex ? -1 : 1;
    if (a->edge != b->edge) return a->edge < b->edge ? -1 : 1;
    return a->s < b->s ? -1 : a->s > b->s;
}

/* A corner that lies on several triangles of the other sheet counts once. */
static bool is_repeated(const named_point *a, const named_point *b) {
    return a->vertex != UINT32_MAX && a->vertex == b->vertex && compare_names(a, b, NAMES) == 0;
}

static void sort_points(lens_search *s) {
    const size_t count = s->finder.point_count;
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) s->points[i] = name_point(s, &s->finder.points[i]);
    if (count > 1) sort_items(s->points, s->points + count, count, sizeof *s->points, compare_points);
    for (size_t i = 0; i < count; i++) {
        if (kept == 0 || !is_repeated(&s->points[kept - 1], &s->points[i])) s->points[kept++] = s->points[i];
    }
    s->point_count = kept;
}

/* ---- the lenses, by thickness ---------------------------------------------------------------------------- */

static int compare_ranges(const void *p, const void *q) {
    const lens_range *a = p, *b = q;
    if (a->thickness != b->thickness) return a->thickness > b->thickness ? -1 : 1;
    return a->begin < b->begin ? -1 : a->begin > b->begin;
}

/* Have points the same reason and the same patch? */
static bool is_other_patch(const lens_search *s, size_t i, size_t k) {
    return i >= s->point_count || k >= s->point_count || compare_names(&s->points[i], &s->points[k], 2) != 0;
}

static void sort_ranges(lens_search *s) {
    s->range_count = 0;
    for (size_t i = 0, end; i < s->point_count; i = end) {
        double thickness = 0.0;
        for (end = i; end < s->point_count && compare_names(&s->points[i], &s->points[end], NAMES) == 0;
             end++)
            thickness = max_of(thickness, s->points[end].point->thickness);
        s->ranges[s->range_count++] =
            (lens_range){i, end, thickness, is_other_patch(s, i, i - 1) && is_other_patch(s, i, end)};
    }
    if (s->range_count > 1)
        sort_items(s->ranges, s->ranges + s->finder.point_count, s->range_count, sizeof *s->ranges,
                   compare_ranges);
}

/* ---- what is given out ------------------------------------------------------------------------------------- */

static cscd_lens_point describe_point(const lens_search *s, const named_point *named) {
    const lens_point *p = named->point;
    const bool vertex = named->edge == UINT32_MAX;
    cscd_lens_point out = {.vertex = named->vertex,
                           .edge = named->edge,
                           .triangle = p->triangle,
                           .along_normal = p->along_normal,
                           .s = named->s,
                           .u = -p->weights[3],
                           .v = -p->weights[4],
                           .thickness = p->thickness};
    for (size_t k = 0; k < 3; k++) {
        const double a = s->x[3 * (size_t)p->vertices[0] + k], b = s->x[3 * (size_t)p->vertices[1] + k];
        out.x[k] = vertex ? a : p->weights[0] * a + p->weights[1] * b;
        out.direction[k] = p->direction[k];
    }
    return out;
}

/* Halves of folds have one patch; vertices at which curves end have none. */
static uint32_t patch_of_range(const lens_search *s, const lens_range *range) {
    if (s->points[range->begin].names[0] >= CSCD_LENS_EDGE) return UINT32_MAX;
    for (size_t i = range->begin; i < range->end; i++) {
        const uint32_t patch = s->patches->vertex_patches[s->points[i].vertex];
        if (patch != UINT32_MAX) return patch;
    }
    return UINT32_MAX;
}

/* Means that are shorter than this share of the ways are none. */
static const double least_mean = 0.05;

/* Writes the mean of the ways, or of directions where none is a way, as a unit vector; false: they cancel each other. */
static bool mean_way(const lens_search *s, const lens_range *range, double out[3]) {
    double sum[3] = {0.0, 0.0, 0.0}, all = 0.0;
    for (size_t i = range->begin; i < range->end; i++) {
        const lens_point *p = s->points[i].point;
        const double weight = range->thickness > 0.0 ? p->thickness / range->thickness : 1.0;
        vec3_add_scaled(sum, weight, p->direction, sum);
        all += weight;
    }
    const double length = sqrt(vec3_dot(sum, sum));
    const bool any = length > least_mean * all;
    for (int k = 0; k < 3; k++) out[k] = any ? sum[k] / length : 0.0;
    return any;
}

/* Where ways cancel each other, what is buried leaves against its outward normals, and what is inside out along them. */
static void find_axis(const lens_search *s, const lens_range *range, cscd_lens *out) {
    double area[3];
    bool closed;
    double sign = 0.0;
    const bool any = mean_way(s, range, out->axis);
    const uint32_t group = s->points[range->begin].names[1];
    if (!range->whole || out->reason >= CSCD_LENS_EDGE) return;
    if (!lens_vector_area(&s->finder, s->x, group, &closed, area) || !closed) return;
    if (any)
        sign = vec3_dot(area, out->axis) < 0.0 ? -1.0 : 1.0;
    else if (out->reason <= CSCD_LENS_INSIDE_OUT)
        sign = out->reason == CSCD_LENS_BURIED ? -1.0 : 1.0;
    for (int k = 0; k < 3 && sign != 0.0; k++) out->axis[k] = sign * area[k];
}

static cscd_lens describe_lens(const lens_search *s, const lens_range *range, size_t first) {
    const named_point *named = &s->points[range->begin];
    const uint32_t *names = named->names;
    cscd_lens out = {.reason = (cscd_lens_reason)names[0],
                     .patch = patch_of_range(s, range),
                     .components = {names[2], names[3]},
                     .objects = {cscd_mesh_vertex_object(s->mesh, named->point->vertices[0]),
                                 cscd_mesh_vertex_object(s->mesh, named->point->vertices[2])},
                     .parts = {names[4], names[5]},
                     .fold = names[0] < CSCD_LENS_EDGE && s->finder.folded[named->vertex],
                     .first_point = first,
                     .point_count = range->end - range->begin,
                     .thickest = first,
                     .thickness = range->thickness};
    while (s->points[range->begin + (out.thickest - first)].point->thickness < range->thickness)
        out.thickest++;
    find_axis(s, range, &out);
    return out;
}

static cscd_status give_out(lens_search *s) {
    detector_results *results = &s->detector->results;
    cscd_context *context = s->detector->context;
    cscd_status status =
        result_buffer_reserve_items(context, &results->lenses, s->range_count, sizeof(cscd_lens));
    if (status == CSCD_OK)
        status = result_buffer_reserve_items(context, &results->lens_points, s->point_count,
                                             sizeof(cscd_lens_point));
    if (status != CSCD_OK) return status;
    cscd_lens *lenses = results->lenses.items;
    cscd_lens_point *points = results->lens_points.items;
    size_t count = 0;
    for (size_t i = 0; i < s->range_count; i++) {
        const lens_range *range = &s->ranges[i];
        lenses[i] = describe_lens(s, range, count);
        for (size_t k = range->begin; k < range->end; k++) points[count++] = describe_point(s, &s->points[k]);
    }
    s->out.items = lenses;
    s->out.count = s->range_count;
    s->out.points = points;
    s->out.point_count = count;
    s->out.thickness = s->range_count > 0 ? lenses[0].thickness : 0.0;
    s->out.undecided = s->finder.undecided;
    return CSCD_OK;
}

/* ---- the call ---------------------------------------------------------------------------------------------- */

static array_list search_arrays(lens_search *s, size_t count) {
    return (array_list){{ARRAY(s->points, 2 * count), ARRAY(s->ranges, 2 * count)}};
}

/* Finds the points, and makes the lenses of them. */
static cscd_status search_lenses(lens_search *s, untangle_work *w, const cscd_intersections *found) {
    static const lens_rules rules = {.rings = 2};
    cscd_context *context = w->context;
    cscd_status status = CSCD_OUT_OF_MEMORY;
    s->patches = found->patches;
    if (lens_finder_make(&s->finder, w)) status = lenses_find(&s->finder, found, s->x, &rules);
    const size_t count = s->finder.point_count;
    if (status == CSCD_OK && !context_reserve_all(context, search_arrays(s, count)))
        status = CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK) {
        sort_points(s);
        sort_ranges(s);
        status = give_out(s);
    }
    context_free_all(context, search_arrays(s, count));
    lens_finder_free(&s->finder);
    return status;
}

static cscd_status find_lenses(cscd_detector *d, const cscd_view *positions,
                               const cscd_intersection_options *options, cscd_lenses *out) {
    cscd_context *context = d->context;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_find_lenses: out is NULL");
    cscd_intersections found;
    untangle_work work = {.detector = d, .context = context, .mesh = d->mesh};
    lens_search search = {.detector = d, .mesh = d->mesh};
    cscd_status status = views_read(context, d->mesh, positions, "positions", &d->unpacked[0], &search.x);
    if (status == CSCD_OK)
        status = detector_find_patches(d, CSCD_DOUBLES(search.x, d->mesh->vertex_count), options, &found);
    if (status != CSCD_OK) return status;
    search.out.pairs = found.count;
    if (found.count > 0) {
        const graph_source source = {.positions = search.x, .names = d->config.exclusions.names};
        status = vertex_graph_make(&work.graph, context, d->mesh, &source);
        if (status == CSCD_OK) status = search_lenses(&search, &work, &found);
        vertex_graph_free(&work.graph);
    }
    if (status != CSCD_OK) return context_explain(context, status);
    *out = search.out;
    return CSCD_OK;
}

cscd_status cscd_detector_find_lenses(cscd_detector *detector, const cscd_view *positions,
                                      const cscd_intersection_options *options, cscd_lenses *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, find_lenses(detector, positions, options, out));
}
