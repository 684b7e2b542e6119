/* The parts of open surfaces that traces of curves cut off: docs/theory/curves.md, Lemma 10. */
#include "runtime/intersections/named_surface.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <string.h>

/* ---- traces and links ---------------------------------------------------------------------------------- */

/* A trace is crossed on the way from one end of an edge to the other as often as it passes over the edge, and on the way around
 * a corner as often as it ends there. */

/* The number of a trace: twice its curve, plus 1 for that on the second sheet. A trace that is both has the
 * number of the first. */
typedef uint32_t trace_number;

/* A trace passes between two nodes: over an edge between its ends, or, where it ends at a corner, between the two edges there.
 * Corners are numbered behind edges, three a triangle. */
typedef struct trace_pass {
    uint64_t link;
    trace_number trace;
    uint32_t reserved;
} trace_pass;

/* Two nodes, and the passes between them. */
typedef struct trace_link {
    uint32_t nodes[2]; /* places in the list of nodes */
    size_t first_pass, end_pass;
} trace_link;

/* Links of all open components, and the memory of all calls; begins with nothing but the context set. */
typedef struct trace_links {
    cscd_context *context;
    trace_pass *passes, *spare_passes;
    trace_link *links;
    uint64_t *nodes, *spare_nodes; /* roots of the patch finder's sets, ascending */
    size_t *node_links;            /* where the links of each node begin in link_list */
    uint32_t *link_list;
    size_t pass_count, link_count, node_count, pass_capacity;
} trace_links;

/* Is this trace a part of the one that is both? */
static inline bool trace_is_both(const cscd_curve *c) {
    return c->swapped || (c->start == CSCD_CURVE_END_VERTEX && c->end == CSCD_CURVE_END_VERTEX);
}

/* The triangle of a trace in a piece of its curve. */
static inline uint32_t trace_triangle(const cscd_curve_piece *piece, uint32_t side) {
    return side == 0 ? piece->a : piece->b;
}

static array_list list_of_passes(trace_links *t, size_t count) {
    return (array_list){{ARRAY(t->passes, count), ARRAY(t->spare_passes, count), ARRAY(t->links, count),
                         ARRAY(t->nodes, 2 * count), ARRAY(t->spare_nodes, 2 * count),
                         ARRAY(t->node_links, 2 * count + 1), ARRAY(t->link_list, 2 * count)}};
}

static void trace_links_free(trace_links *t) {
    if (t->context == NULL) return;
    context_free_all(t->context, list_of_passes(t, 0));
    *t = (trace_links){.context = t->context};
}

/* Returns the sheet on which the edge of a point is, seen from a neighbouring piece. */
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

/* Whether the trace has ends only where it may divide a surface: none, at its own border, or in the other trace. */
static bool trace_may_divide(const cscd_mesh *mesh, const curve_joiner *j, trace_number trace) {
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

/* A triangle at the edge or corner of a pass. */
static uint32_t trace_link_triangle(const cscd_mesh *mesh, uint64_t link) {
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

/* The place of a node in the list, or UINT32_MAX. */
static uint32_t trace_links_node(const trace_links *t, uint32_t root) {
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

/* False: no memory. */
static bool trace_links_find(trace_links *t, const surface_cuts *found) {
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

/* ---- sides --------------------------------------------------------------------------------------------- */

/* A forest spans the nodes, and the links of a trace that are in it cut ranges out of its order. Every other
 * link has a random number. If the trace divides the surface, the numbers of its own links have the same sum
 * as those of the links that lead out of the ranges, so sums that differ say at once that it does not. If
 * they agree, the links are compared. Time for one trace is that of its own links and of the smaller side,
 * since the forest has each side as a few ranges of its order. */

/* An element of a component: a node, which links join, or a patch that no link names. */
typedef struct side_element {
    uint32_t patch; /* or UINT32_MAX: a corner between two curves that no patch is named by */
    uint32_t component;
    uint32_t begin, end; /* where what is below it in the forest lies in the order; itself is first */
    uint32_t above;
    uint32_t marked; /* one more than the last trace of whose listed side it was; 0: none */
} side_element;

/* The memory of all calls; begins with nothing but the context set. */
typedef struct trace_sides {
    cscd_context *context;
    const trace_links *links;
    side_element *elements; /* nodes, then patches without one */
    uint32_t *order;        /* the forest, component by component */
    uint32_t *list;         /* of elements: the side that was listed last */
    size_t *cursors;
    uint64_t *sums; /* over all elements before in the order, of the numbers of links outside the forest */
    size_t element_count, element_capacity;
    uint32_t *patch_elements; /* UINT32_MAX: the patch is of a closed component */
    size_t patch_capacity;
    uint32_t *link_below; /* per link: the lower one of its nodes; UINT32_MAX: it is not of the forest */
    size_t link_capacity;
    uint32_t *component_begins; /* in the order */
    size_t component_capacity;
    size_t *trace_begins;
    size_t trace_capacity;
    uint32_t *trace_passes; /* links, by trace, ascending */
    uint64_t *bounds, *spare_bounds;
    size_t pass_capacity;

    /* The last trace: side 1 is from each even bound to the next one. */
    size_t bound_count;
    uint32_t trace, component, known_side; /* the elements of known_side are those that are marked */
} trace_sides;

/* The side of a patch of the component. */
static inline uint32_t trace_side_of_patch(const trace_sides *s, uint32_t patch) {
    bool is_known = s->elements[s->patch_elements[patch]].marked == s->trace + 1;
    return is_known ? s->known_side : 1 - s->known_side;
}

static array_list list_of_elements(trace_sides *s, size_t count) {
    return (array_list){{ARRAY(s->elements, count), ARRAY(s->order, count), ARRAY(s->list, count),
                         ARRAY(s->cursors, count), ARRAY(s->sums, count + 1)}};
}

static array_list list_of_side_patches(trace_sides *s, size_t count) {
    return (array_list){{ARRAY(s->patch_elements, count)}};
}

static array_list list_of_links(trace_sides *s, size_t count) {
    return (array_list){{ARRAY(s->link_below, count)}};
}

static array_list list_of_side_components(trace_sides *s, size_t count) {
    return (array_list){{ARRAY(s->component_begins, count + 1)}};
}

static array_list list_of_traces(trace_sides *s, size_t count) {
    return (array_list){{ARRAY(s->trace_begins, count + 1)}};
}

static array_list list_of_trace_passes(trace_sides *s, size_t count) {
    return (array_list){
        {ARRAY(s->trace_passes, count), ARRAY(s->bounds, 2 * count), ARRAY(s->spare_bounds, 2 * count)}};
}

static void trace_sides_free(trace_sides *s) {
    if (s->context == NULL) return;
    context_free_all(s->context, list_of_elements(s, 0));
    context_free_all(s->context, list_of_side_patches(s, 0));
    context_free_all(s->context, list_of_links(s, 0));
    context_free_all(s->context, list_of_side_components(s, 0));
    context_free_all(s->context, list_of_traces(s, 0));
    context_free_all(s->context, list_of_trace_passes(s, 0));
    *s = (trace_sides){.context = s->context};
}

typedef struct side_work {
    trace_sides *sides;
    const surface_cuts *found;
    const cscd_mesh *mesh;
    const trace_links *links;
} side_work;

static bool renew_list(const side_work *w, array_list (*list)(trace_sides *, size_t), size_t *capacity,
                       size_t count) {
    trace_sides *s = w->sides;
    return memory_budget_take_all(w->found->budget, list(s, room_with_spare(count))) &&
           context_renew_all(s->context, list(s, room_with_spare(count)), capacity, count);
}

static bool reserve_sides(const side_work *w) {
    trace_sides *s = w->sides;
    size_t patches = w->found->patches->patch_count;
    return renew_list(w, list_of_elements, &s->element_capacity, w->links->node_count + patches) &&
           renew_list(w, list_of_side_patches, &s->patch_capacity, patches) &&
           renew_list(w, list_of_links, &s->link_capacity, w->links->link_count) &&
           renew_list(w, list_of_side_components, &s->component_capacity, w->mesh->component_count) &&
           renew_list(w, list_of_traces, &s->trace_capacity, 2 * w->found->curves->curve_count) &&
           renew_list(w, list_of_trace_passes, &s->pass_capacity, w->links->pass_count);
}

static uint32_t node_of_patch(const side_work *w, const cscd_patch *patch) {
    const patch_finder *p = w->found->patches;
    uint32_t edge = w->mesh->triangle_edges[patch->triangle][patch->corner];
    if (!p->crossed_components[patch->component]) return UINT32_MAX;
    return trace_links_node(w->links,
                            patch_node(p, edge, w->mesh->triangles[patch->triangle][patch->corner]));
}

static void load_elements(const side_work *w) {
    trace_sides *s = w->sides;
    const patch_finder *p = w->found->patches;
    s->element_count = w->links->node_count;
    for (size_t i = 0; i < s->element_count; i++) s->elements[i] = (side_element){.patch = UINT32_MAX};
    for (size_t i = 0; i < w->links->link_count; i++) {
        const trace_link *link = &w->links->links[i];
        uint32_t triangle = trace_link_triangle(w->mesh, w->links->passes[link->first_pass].link);
        for (int k = 0; k < 2; k++)
            s->elements[link->nodes[k]].component = w->mesh->triangle_components[triangle];
    }
    for (uint32_t i = 0; i < p->patch_count; i++) {
        const cscd_patch *patch = &p->patches[i];
        s->patch_elements[i] = UINT32_MAX;
        if (w->mesh->components[patch->component].closed_manifold) continue;
        uint32_t element = node_of_patch(w, patch);
        if (element == UINT32_MAX) element = (uint32_t)s->element_count++;
        s->elements[element] = (side_element){.patch = i, .component = patch->component};
        s->patch_elements[i] = element;
    }
}

/* ---- the forest ---------------------------------------------------------------------------------------- */

static uint32_t other_node(const trace_link *link, uint32_t node) {
    return link->nodes[0] == node ? link->nodes[1] : link->nodes[0];
}

/* An end of 0 tells what was not entered. */
static void enter_element(trace_sides *s, uint32_t element, uint32_t above, uint32_t place) {
    side_element *e = &s->elements[element];
    e->begin = place;
    e->end = UINT32_MAX;
    e->above = above;
    s->order[place] = element;
    s->cursors[element] = element < s->links->node_count ? s->links->node_links[element] : 0;
}

/* Visits all that links join to the root; returns the place behind it. */
static uint32_t visit_tree(trace_sides *s, uint32_t root, uint32_t place) {
    const trace_links *t = s->links;
    uint32_t at = root;
    enter_element(s, root, UINT32_MAX, place++);
    while (at != UINT32_MAX) {
        size_t last = at < t->node_count ? t->node_links[at + 1] : 0;
        if (s->cursors[at] == last) {
            s->elements[at].end = place;
            at = s->elements[at].above;
            continue;
        }
        uint32_t link = t->link_list[s->cursors[at]++], other = other_node(&t->links[link], at);
        if (s->elements[other].end != 0) continue;
        s->link_below[link] = other;
        enter_element(s, other, at, place++);
        at = other;
    }
    return place;
}

/* The order has the components one after the other. */
static void grow_forest(const side_work *w) {
    trace_sides *s = w->sides;
    uint32_t components = w->mesh->component_count, place = 0;
    uint32_t *begins = s->component_begins;
    memset(s->link_below, 0xff, w->links->link_count * sizeof *s->link_below);
    memset(begins, 0, ((size_t)components + 1) * sizeof *begins);
    for (size_t i = 0; i < s->element_count; i++) begins[s->elements[i].component + 1]++;
    for (uint32_t c = 0; c < components; c++) begins[c + 1] += begins[c];
    for (uint32_t i = 0; i < s->element_count; i++) s->list[begins[s->elements[i].component]++] = i;
    for (size_t i = 0; i < s->element_count; i++) {
        if (s->elements[s->list[i]].end == 0) place = visit_tree(s, s->list[i], place);
    }
    for (uint32_t c = components; c > 0; c--) begins[c] = begins[c - 1];
    begins[0] = 0;
}

/* The output function of splitmix64: different for different links, and as if at random. */
static uint64_t number_of_link(uint64_t link) {
    uint64_t x = (link + 1) * UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
    return x ^ x >> 31;
}

static void sum_numbers(const side_work *w) {
    trace_sides *s = w->sides;
    memset(s->sums, 0, (s->element_count + 1) * sizeof *s->sums);
    for (size_t i = 0; i < w->links->link_count; i++) {
        if (s->link_below[i] != UINT32_MAX) continue;
        for (int k = 0; k < 2; k++)
            s->sums[s->elements[w->links->links[i].nodes[k]].begin + 1] ^= number_of_link(i);
    }
    for (size_t i = 0; i < s->element_count; i++) s->sums[i + 1] ^= s->sums[i];
}

static void list_passes(const side_work *w) {
    trace_sides *s = w->sides;
    const trace_links *t = w->links;
    size_t traces = 2 * w->found->curves->curve_count, *begins = s->trace_begins;
    memset(begins, 0, (traces + 1) * sizeof *begins);
    for (size_t i = 0; i < t->pass_count; i++) begins[t->passes[i].trace + 1]++;
    for (size_t i = 0; i < traces; i++) begins[i + 1] += begins[i];
    for (uint32_t i = 0; i < t->link_count; i++) {
        for (size_t k = t->links[i].first_pass; k < t->links[i].end_pass; k++)
            s->trace_passes[begins[t->passes[k].trace]++] = i;
    }
    for (size_t i = traces; i > 0; i--) begins[i] = begins[i - 1];
    begins[0] = 0;
}

/* Links have been found. False: no memory. */
static bool trace_sides_load(trace_sides *s, const surface_cuts *found, const trace_links *links) {
    const side_work work = {s, found, found->surface->mesh, links};
    s->links = links;
    if (!reserve_sides(&work)) return false;
    load_elements(&work);
    grow_forest(&work);
    sum_numbers(&work);
    list_passes(&work);
    return true;
}

/* ---- one trace ----------------------------------------------------------------------------------------- */

/* The links that a trace passes an odd number of times. */
typedef struct odd_links {
    /* of the numbers of the odd links outside the forest, and of all links that lead out of the ranges */
    uint64_t sum;
    size_t beside; /* the number of odd links outside the forest */
} odd_links;

static void take_odd_link(trace_sides *s, uint32_t link, odd_links *odd) {
    uint32_t below = s->link_below[link];
    if (below == UINT32_MAX) {
        odd->sum ^= number_of_link(link);
        odd->beside++;
        return;
    }
    const side_element *e = &s->elements[below];
    odd->sum ^= s->sums[e->begin] ^ s->sums[e->end];
    s->bounds[s->bound_count++] = e->begin;
    s->bounds[s->bound_count++] = e->end;
}

static odd_links find_odd_links(trace_sides *s) {
    odd_links odd = {0, 0};
    size_t end = s->trace_begins[s->trace + 1];
    s->bound_count = 0;
    for (size_t i = s->trace_begins[s->trace], next = i; i < end; i = next) {
        while (next < end && s->trace_passes[next] == s->trace_passes[i]) next++;
        if ((next - i) % 2 == 1) take_odd_link(s, s->trace_passes[i], &odd);
    }
    return odd;
}

/* Returns how many elements side 1 has. */
static size_t sort_bounds(trace_sides *s) {
    size_t count = 0;
    sort_by_number(s->bounds, s->spare_bounds, s->bound_count, sizeof *s->bounds);
    for (size_t i = 0; i < s->bound_count; i += 2) count += (size_t)(s->bounds[i + 1] - s->bounds[i]);
    return count;
}

static size_t list_range(trace_sides *s, size_t count, uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; i++) s->list[count++] = s->order[i];
    return count;
}

/* Lists the elements of a side of the component, in no order that matters. */
static size_t trace_sides_list(trace_sides *s, uint32_t side) {
    size_t count = 0;
    uint64_t at = s->component_begins[s->component];
    for (size_t i = 0; i < s->bound_count; i += 2) {
        count = side == 1 ? list_range(s, count, s->bounds[i], s->bounds[i + 1])
                          : list_range(s, count, at, s->bounds[i]);
        at = s->bounds[i + 1];
    }
    return side == 1 ? count : list_range(s, count, at, s->component_begins[s->component + 1]);
}

/* The number of links outside the forest with exactly one marked end. */
static size_t count_links_out(const trace_sides *s, size_t listed) {
    const trace_links *t = s->links;
    size_t count = 0;
    for (size_t i = 0; i < listed; i++) {
        uint32_t node = s->list[i];
        size_t end = node < t->node_count ? t->node_links[node + 1] : 0;
        for (size_t k = node < t->node_count ? t->node_links[node] : 0; k < end; k++) {
            uint32_t link = t->link_list[k], other = other_node(&t->links[link], node);
            count += s->link_below[link] == UINT32_MAX && s->elements[other].marked != s->trace + 1;
        }
    }
    return count;
}

/* Whether each odd link outside the forest leads from a marked element to another one. */
static bool odd_links_lead_out(const trace_sides *s) {
    size_t end = s->trace_begins[s->trace + 1];
    for (size_t i = s->trace_begins[s->trace], next = i; i < end; i = next) {
        while (next < end && s->trace_passes[next] == s->trace_passes[i]) next++;
        const trace_link *link = &s->links->links[s->trace_passes[i]];
        bool out = (s->elements[link->nodes[0]].marked == s->trace + 1) !=
                   (s->elements[link->nodes[1]].marked == s->trace + 1);
        if ((next - i) % 2 == 1 && !out) return false;
    }
    return true;
}

/* Whether a trace, which lies in one open component, has two sides. If so, the next calls are about these
 * sides. */
static bool trace_sides_find(trace_sides *s, trace_number trace, uint32_t component) {
    s->trace = trace;
    s->component = component;
    const odd_links odd = find_odd_links(s);
    if (odd.sum != 0) return false;
    size_t ones = sort_bounds(s);
    s->known_side = 2 * ones <= s->component_begins[component + 1] - s->component_begins[component] ? 1 : 0;
    size_t listed = trace_sides_list(s, s->known_side);
    for (size_t i = 0; i < listed; i++) s->elements[s->list[i]].marked = trace + 1;
    return count_links_out(s, listed) == odd.beside && odd_links_lead_out(s);
}

/* ---- cut-offs ------------------------------------------------------------------------------------------ */

/* A piece of a trace, by its triangle. */
typedef struct trace_piece {
    uint64_t triangle;
    uint64_t piece; /* in the list of all pieces of curves */
} trace_piece;

struct cut_off_finder {
    cscd_context *context;
    trace_links links;
    trace_sides sides;
    /* Per patch the area of its triangles. The area of a triangle that curves cut counts for the patch of its
     * first corner. */
    double *patch_areas;
    size_t patch_capacity;
    double *component_areas;
    size_t component_capacity;
    cscd_cut_off *items;
    size_t curve_capacity;
    trace_piece *pieces, *spare_pieces; /* of one trace */
    cut_line *lines;
    cut_border *borders, *spare_borders;
    size_t piece_capacity;
    cut_memory memory;
    uint64_t *sorted, *spare_sorted; /* patches of one side */
    uint32_t *listed;
    size_t listed_count, listed_capacity, item_count;
};

static array_list list_of_patches(cut_off_finder *f, size_t count) {
    return (array_list){
        {ARRAY(f->patch_areas, count), ARRAY(f->sorted, count), ARRAY(f->spare_sorted, count)}};
}

static array_list list_of_components(cut_off_finder *f, size_t count) {
    return (array_list){{ARRAY(f->component_areas, count)}};
}

static array_list list_of_curves(cut_off_finder *f, size_t count) {
    return (array_list){{ARRAY(f->items, 2 * count)}};
}

static array_list list_of_pieces(cut_off_finder *f, size_t count) {
    return (array_list){{ARRAY(f->pieces, count), ARRAY(f->spare_pieces, count), ARRAY(f->lines, count),
                         ARRAY(f->borders, 2 * count), ARRAY(f->spare_borders, 2 * count)}};
}

static cut_off_finder empty_finder(cscd_context *context) {
    return (cut_off_finder){.context = context, .links = {.context = context}, .sides = {.context = context}};
}

cut_off_finder *cut_off_finder_create(cscd_context *context) {
    cut_off_finder *f = context_allocate(context, 1, sizeof *f);
    if (f != NULL) *f = empty_finder(context);
    return f;
}

void cut_off_finder_clear(cut_off_finder *f) {
    context_free_all(f->context, list_of_patches(f, 0));
    context_free_all(f->context, list_of_components(f, 0));
    context_free_all(f->context, list_of_curves(f, 0));
    context_free_all(f->context, list_of_pieces(f, 0));
    context_free(f->context, f->listed);
    cut_memory_free(f->context, &f->memory);
    trace_links_free(&f->links);
    trace_sides_free(&f->sides);
    *f = empty_finder(f->context);
}

void cut_off_finder_destroy(cut_off_finder *f) {
    if (f == NULL) return;
    cut_off_finder_clear(f);
    context_free(f->context, f);
}

static bool reserve_list(cut_off_finder *f, memory_budget *budget,
                         array_list (*list)(cut_off_finder *, size_t), size_t *capacity, size_t count) {
    return memory_budget_take_all(budget, list(f, room_with_spare(count))) &&
           context_renew_all(f->context, list(f, room_with_spare(count)), capacity, count);
}

/* A trace may have both sides of a curve in one triangle. */
static size_t most_lines(const curve_joiner *j) {
    size_t most = 0;
    for (size_t i = 0; i < j->curve_count; i++) {
        if (2 * j->curves[i].piece_count > most) most = 2 * j->curves[i].piece_count;
    }
    return most;
}

static bool reserve_all(cut_off_finder *f, const surface_cuts *found) {
    const curve_joiner *j = found->curves;
    return cut_memory_begin(&f->memory, found->budget, most_lines(j), 1) &&
           reserve_list(f, found->budget, list_of_patches, &f->patch_capacity, found->patches->patch_count) &&
           reserve_list(f, found->budget, list_of_components, &f->component_capacity,
                        found->surface->mesh->component_count) &&
           reserve_list(f, found->budget, list_of_curves, &f->curve_capacity, j->curve_count) &&
           reserve_list(f, found->budget, list_of_pieces, &f->piece_capacity, 2 * j->piece_count);
}

/* ---- areas --------------------------------------------------------------------------------------------- */

typedef struct cut_off_work {
    cut_off_finder *finder;
    const surface_cuts *found;
    const cscd_mesh *mesh;
    trace_number trace;
    uint32_t component;
} cut_off_work;

static int32_t side_of_corner(const cut_off_work *work, uint32_t triangle, uint32_t corner) {
    const patch_finder *p = work->found->patches;
    return (int32_t)trace_side_of_patch(&work->finder->sides,
                                        p->corner_patches[(size_t)triangle * 3 + corner]);
}

/* Adds the trace's pieces in one side's triangles to the list. */
static size_t list_side(const cut_off_work *work, uint32_t side, size_t count) {
    const curve_joiner *j = work->found->curves;
    const cscd_curve *c = &j->curves[work->trace / 2];
    for (size_t i = c->first_piece; i < c->first_piece + c->piece_count; i++)
        work->finder->pieces[count++] = (trace_piece){trace_triangle(&j->pieces[i], side), i};
    return count;
}

static size_t list_pieces(const cut_off_work *work) {
    cut_off_finder *f = work->finder;
    bool both = trace_is_both(&work->found->curves->curves[work->trace / 2]);
    size_t count = list_side(work, work->trace % 2, 0);
    if (both) count = list_side(work, 1, count);
    sort_by_number(f->pieces, f->spare_pieces, count, sizeof *f->pieces);
    return count;
}

static void add_border(const cut_off_work *work, uint32_t triangle, const cscd_curve_point *point,
                       cut_triangle *cut) {
    const cscd_mesh *mesh = work->mesh;
    for (uint32_t i = 0; i < 3; i++) {
        if (mesh->triangle_edges[triangle][i] != point->edge) continue;
        bool along = mesh->edges[point->edge][0] == mesh->triangles[triangle][i];
        cut->borders[cut->border_count++] = (cut_border){i, along ? point->s : 1.0 - point->s, 0, 1};
    }
}

/* The ends of a piece in the triangle; each end on the triangle's border changes the side. */
static void add_line(const cut_off_work *work, loaded_cut *out, size_t piece) {
    const curve_joiner *j = work->found->curves;
    const cscd_curve *c = &j->curves[work->trace / 2];
    size_t at = piece - c->first_piece;
    const cscd_curve_point *points = &j->points[c->first_point];
    const cscd_curve_point *ends[2] = {&points[at], &points[(at + 1) % c->point_count]};
    cut_line line = {.rise = 1};
    loaded_cut_point(out, ends[0]->x, line.from);
    loaded_cut_point(out, ends[1]->x, line.to);
    out->cut.lines[out->cut.line_count++] = line;
    for (int i = 0; i < 2; i++) add_border(work, out->triangle, ends[i], &out->cut);
}

/* The numbers of parts count how often the trace is crossed. */
static void add_odd_part(void *data, const cut_part *part) {
    if (part->numbers[0] % 2 != 0) *(double *)data += cut_part_area(part);
}

/* Divides a triangle that has these pieces of the trace. False: no memory. */
static bool divide_triangle(const cut_off_work *work, const trace_piece *pieces, size_t count,
                            double areas[2]) {
    cut_off_finder *f = work->finder;
    uint32_t triangle = (uint32_t)pieces[0].triangle;
    int32_t numbers[3];
    double normal[3], odd = 0.0;
    surface_normal(work->mesh, work->found->surface->positions, triangle, normal);
    double norm = surface_norm(normal);
    if (norm == 0.0) return true;
    loaded_cut cut = {.triangle = triangle, .stretch = norm / vec3_largest(normal)};
    for (uint32_t i = 0; i < 3; i++) numbers[i] = side_of_corner(work, triangle, i);
    cut.cut.lines = f->lines;
    cut.cut.borders = f->borders;
    cut.cut.corner_numbers = numbers;
    cut.cut.slot_count = 1;
    loaded_cut_project(work->found->surface, normal, false, &cut);
    for (size_t i = 0; i < count; i++) add_line(work, &cut, (size_t)pieces[i].piece);
    loaded_cut_sort_borders(&cut, f->spare_borders);
    if (!cut_memory_reserve(f->context, &f->memory, count, 1) ||
        !cut_triangle_divide(f->context, &cut.cut, &f->memory, add_odd_part, &odd))
        return false;
    areas[numbers[0]] -= 0.5 * norm;
    areas[1] += cut.stretch * odd;
    areas[0] += 0.5 * norm - cut.stretch * odd;
    return true;
}

/* Adds the triangles that the trace divides to both sides, over the areas of load_patches. False: no
 * memory. */
static bool divide_triangles(const cut_off_work *work, double areas[2]) {
    cut_off_finder *f = work->finder;
    areas[0] = areas[1] = 0.0;
    size_t count = list_pieces(work);
    for (size_t begin = 0, end = 0; begin < count; begin = end) {
        while (end < count && f->pieces[end].triangle == f->pieces[begin].triangle) end++;
        if (!divide_triangle(work, f->pieces + begin, end - begin, areas)) return false;
    }
    return true;
}

/* The areas of a side's patches. */
static double sum_side(const cut_off_work *work, uint32_t side) {
    cut_off_finder *f = work->finder;
    double sum = 0.0;
    size_t count = trace_sides_list(&f->sides, side);
    for (size_t i = 0; i < count; i++) {
        uint32_t patch = f->sides.elements[f->sides.list[i]].patch;
        if (patch != UINT32_MAX) sum += f->patch_areas[patch];
    }
    return sum;
}

/* The side with fewer elements is summed up, and the other one too, unless that is the larger one. False: no memory. */
static bool measure_sides(const cut_off_work *work, double areas[2]) {
    cut_off_finder *f = work->finder;
    double whole = f->component_areas[work->component], shifts[2];
    uint32_t known = f->sides.known_side;
    if (!divide_triangles(work, shifts)) return false;
    areas[known] = fmax(sum_side(work, known) + shifts[known], 0.0);
    areas[1 - known] = 2.0 * areas[known] <= whole ? whole - areas[known]
                                                   : fmax(sum_side(work, 1 - known) + shifts[1 - known], 0.0);
    return true;
}

/* ---- all traces ---------------------------------------------------------------------------------------- */

static bool reserve_listed(cut_off_finder *f, size_t more) {
    if (!memory_budget_take(f->memory.budget, more, MEMORY_WHILE_DOUBLING * sizeof *f->listed)) return false;
    if (more <= f->listed_capacity - f->listed_count) return true;
    size_t larger = room_with_spare(f->listed_count + more);
    uint32_t *grown = context_grow(f->context, f->listed, f->listed_count, larger, sizeof *grown);
    if (grown == NULL) return false;
    f->listed = grown;
    f->listed_capacity = larger;
    return true;
}

/* Lists the patches of one side. False: no memory. */
static bool list_patches(const cut_off_work *work, uint32_t side, cscd_cut_off *item) {
    cut_off_finder *f = work->finder;
    size_t elements = trace_sides_list(&f->sides, side), count = 0;
    for (size_t i = 0; i < elements; i++) {
        uint32_t patch = f->sides.elements[f->sides.list[i]].patch;
        if (patch != UINT32_MAX) f->sorted[count++] = patch;
    }
    sort_by_number(f->sorted, f->spare_sorted, count, sizeof *f->sorted);
    if (!reserve_listed(f, count)) return false;
    item->first_patch = f->listed_count;
    item->patch_count = count;
    for (size_t i = 0; i < count; i++) f->listed[f->listed_count++] = (uint32_t)f->sorted[i];
    return true;
}

static bool add_cut_off(const cut_off_work *work) {
    double areas[2];
    if (!measure_sides(work, areas)) return false;
    uint32_t smaller = areas[1] <= areas[0] ? 1 : 0;
    bool both = trace_is_both(&work->found->curves->curves[work->trace / 2]);
    cscd_cut_off item = {.curve = work->trace / 2,
                         .trace = both                   ? CSCD_TRACE_BOTH
                                  : work->trace % 2 == 0 ? CSCD_TRACE_FIRST
                                                         : CSCD_TRACE_SECOND,
                         .component = work->component,
                         .object = work->found->curves->curves[work->trace / 2].objects[work->trace % 2],
                         .area = areas[smaller],
                         .rest = areas[1 - smaller]};
    if (!list_patches(work, smaller, &item)) return false;
    work->finder->items[work->finder->item_count++] = item;
    return true;
}

static void load_areas(const cut_off_work *work) {
    cut_off_finder *f = work->finder;
    const cscd_mesh *mesh = work->mesh;
    const patch_finder *p = work->found->patches;
    memset(f->patch_areas, 0, p->patch_count * sizeof *f->patch_areas);
    memset(f->component_areas, 0, mesh->component_count * sizeof *f->component_areas);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (mesh->components[mesh->triangle_components[t]].closed_manifold) continue;
        f->patch_areas[p->corner_patches[(size_t)t * 3]] +=
            surface_area(mesh, work->found->surface->positions, t);
    }
    for (uint32_t i = 0; i < p->patch_count; i++)
        f->component_areas[p->patches[i].component] += f->patch_areas[i];
}

static bool try_trace(cut_off_work *work) {
    const curve_joiner *j = work->found->curves;
    if (!trace_may_divide(work->mesh, j, work->trace)) return true;
    const cscd_curve_piece *piece = &j->pieces[j->curves[work->trace / 2].first_piece];
    work->component = work->mesh->triangle_components[trace_triangle(piece, work->trace % 2)];
    return !trace_sides_find(&work->finder->sides, work->trace, work->component) || add_cut_off(work);
}

cscd_status cut_off_finder_run(cut_off_finder *f, const surface_cuts *found, cscd_cut_offs *out) {
    cut_off_work work = {.finder = f, .found = found, .mesh = found->surface->mesh};
    size_t traces = 2 * found->curves->curve_count;
    f->item_count = f->listed_count = 0;
    if (!trace_links_find(&f->links, found) || !trace_sides_load(&f->sides, found, &f->links) ||
        !reserve_all(f, found))
        return CSCD_OUT_OF_MEMORY;
    load_areas(&work);
    for (size_t i = 0; i < traces; i++) {
        if (!progress_go_on(&f->context->progress, (double)i / (double)traces)) break;
        work.trace = (uint32_t)i;
        if (!try_trace(&work)) return CSCD_OUT_OF_MEMORY;
    }
    *out = (cscd_cut_offs){f->items, f->item_count, f->listed, f->listed_count};
    return context_progress_status(f->context);
}
