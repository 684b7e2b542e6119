/* Which patches of open surfaces lie on two sides of which traces of curves. A trace is crossed on the way from one end of
 * an edge to the other as often as it passes over the edge, and on the way around a corner as often as it ends there. */
#include "runtime/intersections/trace_links.h"

#include "src/core/sort.h"

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_of_passes(trace_links *t, size_t count) {
    return (array_list){{ARRAY(t->passes, count), ARRAY(t->spare_passes, count), ARRAY(t->links, count),
                         ARRAY(t->nodes, 2 * count), ARRAY(t->spare_nodes, 2 * count),
                         ARRAY(t->node_links, 2 * count + 1), ARRAY(t->link_list, 2 * count)}};
}

void trace_links_free(trace_links *t) {
    if (t->context == NULL) return;
    context_free_all(t->context, list_of_passes(t, 0));
    *t = (trace_links){.context = t->context};
}

/* ---- traces -------------------------------------------------------------------------------------------- */

/* On which sheet the edge of a point is, seen from a piece beside it. */
static uint32_t side_of_point(const cscd_curve_point *point, const cscd_curve_piece *piece) {
    return point->triangle == piece->b ? 0 : 1;
}

/* An end at a border divides the sheet whose border it is; on the other sheet the trace ends within a triangle. */
static bool end_may_divide(const curve_joiner *j, const cscd_curve *c, cscd_curve_end end, size_t point,
                           size_t piece, uint32_t side) {
    return end == CSCD_CURVE_END_BORDER &&
           side_of_point(&j->points[c->first_point + point], &j->pieces[c->first_piece + piece]) == side;
}

/* Does the sheet of a trace lie in one component? */
static bool is_in_one_component(const cscd_mesh *mesh, const curve_joiner *j, const cscd_curve *c,
                                uint32_t side) {
    uint32_t component = mesh->triangle_components[trace_triangle(&j->pieces[c->first_piece], side)];
    for (size_t i = 0; i < c->piece_count; i++) {
        uint32_t triangle = trace_triangle(&j->pieces[c->first_piece + i], side);
        if (mesh->triangle_components[triangle] != component) return false;
    }
    return true;
}

static bool triangle_has_edge(const cscd_mesh *mesh, uint32_t triangle, uint32_t edge) {
    const uint32_t *edges = mesh->triangle_edges[triangle];
    return edges[0] == edge || edges[1] == edge || edges[2] == edge;
}

/* Does the trace go over a seam? Then the edge of a point is only in one of the two triangles at it. */
static bool goes_over_seam(const cscd_mesh *mesh, const curve_joiner *j, const cscd_curve *c, uint32_t side) {
    for (size_t i = 0; i < c->piece_count; i++) {
        const cscd_curve_piece *piece = &j->pieces[c->first_piece + i];
        uint32_t triangle = trace_triangle(piece, side);
        for (size_t k = 0; k < 2; k++) {
            const cscd_curve_point *point = &j->points[c->first_point + (i + k) % c->point_count];
            if (point->edge == NO_EDGE || point->triangle == triangle) continue;
            if (!triangle_has_edge(mesh, triangle, point->edge)) return true;
        }
    }
    return false;
}

bool trace_may_divide(const cscd_mesh *mesh, const curve_joiner *j, trace_number trace) {
    const cscd_curve *c = &j->curves[trace / 2];
    uint32_t side = trace % 2;
    const cscd_curve_piece *first = &j->pieces[c->first_piece];
    if (mesh->components[mesh->triangle_components[trace_triangle(first, side)]].closed_manifold)
        return false;
    if (!is_in_one_component(mesh, j, c, side) || goes_over_seam(mesh, j, c, side)) return false;
    if (trace_is_both(c))
        return side == 0 && c->components[0] == c->components[1] && is_in_one_component(mesh, j, c, 1) &&
               !goes_over_seam(mesh, j, c, 1);
    if (c->closed) return true;
    return end_may_divide(j, c, c->start, 0, 0, side) &&
           end_may_divide(j, c, c->end, c->point_count - 1, c->piece_count - 1, side);
}

/* ---- passes -------------------------------------------------------------------------------------------- */

typedef struct pass_work {
    trace_links *links;
    const surface_cuts *found;
    const cscd_mesh *mesh;
} pass_work;

static void add_pass(pass_work *work, uint64_t link, size_t curve, uint32_t side) {
    trace_links *t = work->links;
    bool both = trace_is_both(&work->found->curves->curves[curve]);
    t->passes[t->pass_count++] = (trace_pass){link, (uint32_t)(2 * curve) + (both ? 0 : side), 0};
}

static bool is_open(const pass_work *work, uint32_t triangle) {
    return !work->mesh->components[work->mesh->triangle_components[triangle]].closed_manifold;
}

/* The curve ends at a vertex, at one corner of each of the two triangles. */
static void add_corners(pass_work *work, size_t curve, const cscd_curve_piece *piece, uint32_t vertex) {
    const named_surface *s = work->found->surface;
    for (uint32_t side = 0; side < 2; side++) {
        uint32_t triangle = trace_triangle(piece, side);
        for (uint32_t i = 0; i < 3 && is_open(work, triangle); i++) {
            if (surface_name(s, work->mesh->triangles[triangle][i]) == surface_name(s, vertex))
                add_pass(work, work->mesh->edge_count + (uint64_t)triangle * 3 + i, curve, side);
        }
    }
}

static void add_passes(pass_work *work, size_t curve) {
    const curve_joiner *j = work->found->curves;
    const cscd_curve *c = &j->curves[curve];
    for (size_t i = 0; i < c->point_count; i++) {
        const cscd_curve_point *point = &j->points[c->first_point + i];
        const cscd_curve_piece *piece = &j->pieces[c->first_piece + (i < c->piece_count ? i : i - 1)];
        uint32_t side = side_of_point(point, piece);
        if (point->edge == NO_EDGE)
            add_corners(work, curve, piece, point->triangle);
        else if (is_open(work, trace_triangle(piece, side)))
            add_pass(work, point->edge, curve, side);
    }
}

/* ---- links --------------------------------------------------------------------------------------------- */

uint32_t trace_link_triangle(const cscd_mesh *mesh, uint64_t link) {
    if (link >= mesh->edge_count) return (uint32_t)((link - mesh->edge_count) / 3);
    return mesh->edge_stars[mesh->edge_star_offsets[link]];
}

static void find_nodes(const pass_work *work, uint64_t link, uint64_t out[2]) {
    const cscd_mesh *mesh = work->mesh;
    const patch_finder *p = work->found->patches;
    if (link < mesh->edge_count) {
        for (int i = 0; i < 2; i++) out[i] = patch_node(p, (uint32_t)link, mesh->edges[link][i]);
        return;
    }
    uint32_t corner = (uint32_t)(link - mesh->edge_count), triangle = corner / 3, i = corner % 3;
    uint32_t vertex = mesh->triangles[triangle][i];
    out[0] = patch_node(p, mesh->triangle_edges[triangle][i], vertex);
    out[1] = patch_node(p, mesh->triangle_edges[triangle][(i + 2) % 3], vertex);
}

/* Passes are sorted; those over one edge, or at one corner, make a link. */
static void make_links(pass_work *work) {
    trace_links *t = work->links;
    size_t ends = 0;
    t->link_count = t->node_count = 0;
    for (size_t i = 0; i < t->pass_count; i++) {
        if (i == 0 || t->passes[i].link != t->passes[i - 1].link) {
            t->links[t->link_count++] = (trace_link){.first_pass = i};
            find_nodes(work, t->passes[i].link, &t->nodes[ends]);
            ends += 2;
        }
        t->links[t->link_count - 1].end_pass = i + 1;
    }
    sort_by_number(t->nodes, t->spare_nodes, ends, sizeof *t->nodes);
    for (size_t i = 0; i < ends; i++) {
        if (i == 0 || t->nodes[i] != t->nodes[t->node_count - 1]) t->nodes[t->node_count++] = t->nodes[i];
    }
}

uint32_t trace_links_node(const trace_links *t, uint32_t root) {
    size_t low = 0, high = t->node_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (t->nodes[middle] < root)
            low = middle + 1;
        else
            high = middle;
    }
    return low < t->node_count && t->nodes[low] == root ? (uint32_t)low : UINT32_MAX;
}

/* Lists the links of each node, once the nodes are known. */
static void list_links(pass_work *work) {
    trace_links *t = work->links;
    for (size_t i = 0; i <= t->node_count; i++) t->node_links[i] = 0;
    for (size_t i = 0; i < t->link_count; i++) {
        uint64_t roots[2];
        find_nodes(work, t->passes[t->links[i].first_pass].link, roots);
        for (int k = 0; k < 2; k++) {
            t->links[i].nodes[k] = trace_links_node(t, (uint32_t)roots[k]);
            t->node_links[t->links[i].nodes[k]]++;
        }
    }
    size_t sum = 0;
    for (size_t i = 0; i <= t->node_count; i++) {
        sum += t->node_links[i];
        t->node_links[i] = sum;
    }
    for (size_t i = t->link_count; i-- > 0;) {
        for (int k = 0; k < 2; k++) t->link_list[--t->node_links[t->links[i].nodes[k]]] = (uint32_t)i;
    }
}

bool trace_links_find(trace_links *t, const surface_cuts *found) {
    const curve_joiner *j = found->curves;
    pass_work work = {t, found, found->surface->mesh};
    size_t most = 6 * j->point_count; /* a point at a vertex is at corners of two triangles */
    if (!memory_budget_take_all(found->budget, list_of_passes(t, room_with_spare(most)))) return false;
    if (!context_renew_all(t->context, list_of_passes(t, room_with_spare(most)), &t->pass_capacity, most))
        return false;
    t->pass_count = 0;
    for (size_t i = 0; i < j->curve_count; i++) add_passes(&work, i);
    sort_by_number(t->passes, t->spare_passes, t->pass_count, sizeof *t->passes);
    make_links(&work);
    list_links(&work);
    return true;
}
