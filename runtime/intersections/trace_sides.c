/* On which side of a trace the patches lie. A forest spans the nodes, and the links of a trace that are in it cut ranges out of
 * its order. Every other link has a random number: where the trace divides the surface, its own sum up to the same as those
 * that lead out of the ranges, so sums that differ say at once that it does not. Where they agree, the links are compared. */
#include "runtime/intersections/trace_sides.h"

#include "src/core/sort.h"

#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_of_elements(trace_sides *s, size_t count) {
    return (array_list){{ARRAY(s->elements, count), ARRAY(s->order, count), ARRAY(s->list, count),
                         ARRAY(s->cursors, count), ARRAY(s->sums, count + 1)}};
}

static array_list list_of_patches(trace_sides *s, size_t count) {
    return (array_list){{ARRAY(s->patch_elements, count)}};
}

static array_list list_of_links(trace_sides *s, size_t count) {
    return (array_list){{ARRAY(s->link_below, count)}};
}

static array_list list_of_components(trace_sides *s, size_t count) {
    return (array_list){{ARRAY(s->component_begins, count + 1)}};
}

static array_list list_of_traces(trace_sides *s, size_t count) {
    return (array_list){{ARRAY(s->trace_begins, count + 1)}};
}

static array_list list_of_passes(trace_sides *s, size_t count) {
    return (array_list){
        {ARRAY(s->trace_passes, count), ARRAY(s->bounds, 2 * count), ARRAY(s->spare_bounds, 2 * count)}};
}

void trace_sides_free(trace_sides *s) {
    if (s->context == NULL) return;
    context_free_all(s->context, list_of_elements(s, 0));
    context_free_all(s->context, list_of_patches(s, 0));
    context_free_all(s->context, list_of_links(s, 0));
    context_free_all(s->context, list_of_components(s, 0));
    context_free_all(s->context, list_of_traces(s, 0));
    context_free_all(s->context, list_of_passes(s, 0));
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

/* ---- elements ------------------------------------------------------------------------------------------ */

static bool reserve_sides(const side_work *w) {
    trace_sides *s = w->sides;
    size_t patches = w->found->patches->patch_count;
    return renew_list(w, list_of_elements, &s->element_capacity, w->links->node_count + patches) &&
           renew_list(w, list_of_patches, &s->patch_capacity, patches) &&
           renew_list(w, list_of_links, &s->link_capacity, w->links->link_count) &&
           renew_list(w, list_of_components, &s->component_capacity, w->mesh->component_count) &&
           renew_list(w, list_of_traces, &s->trace_capacity, 2 * w->found->curves->curve_count) &&
           renew_list(w, list_of_passes, &s->pass_capacity, w->links->pass_count);
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

bool trace_sides_load(trace_sides *s, const surface_cuts *found, const trace_links *links) {
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
    uint64_t sum;  /* of the numbers of those beside the forest, and of all that lead out of the ranges */
    size_t beside; /* so many of them are not in the forest */
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

size_t trace_sides_list(trace_sides *s, uint32_t side) {
    size_t count = 0;
    uint64_t at = s->component_begins[s->component];
    for (size_t i = 0; i < s->bound_count; i += 2) {
        count = side == 1 ? list_range(s, count, s->bounds[i], s->bounds[i + 1])
                          : list_range(s, count, at, s->bounds[i]);
        at = s->bounds[i + 1];
    }
    return side == 1 ? count : list_range(s, count, at, s->component_begins[s->component + 1]);
}

/* So many links beside the forest have one end among the marked elements. */
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

/* Does each odd link beside the forest lead from a marked element to another one? */
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

bool trace_sides_find(trace_sides *s, trace_number trace, uint32_t component) {
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
