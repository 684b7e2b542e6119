/* Wires and points, sorted in space for each interval, the boxes around them, and pairs of features of which
 * one is loose. */
#include "runtime/loose/loose.h"

#include "runtime/ccd/ccd.h"
#include "src/core/sort.h"

#include <string.h>

/* One thread encloses this number of elements at a time. */
enum { ELEMENTS_PER_TASK = 1024 };

/* ---- the list ------------------------------------------------------------------------------------------ */

static uint32_t count_elements(const cscd_mesh *mesh) {
    return mesh->loose.wire_count + mesh->loose.point_count;
}

static uint32_t nodes_over(uint32_t children) {
    return (children + LOOSE_NODE_CHILDREN - 1) / LOOSE_NODE_CHILDREN;
}

static array_list list_arrays(loose_elements *e) {
    return (array_list){
        {ARRAY(e->items, e->count), ARRAY(e->order, e->count), ARRAY(e->spare_order, e->count)}};
}

static bool allocate_levels(loose_elements *e) {
    uint32_t count = e->count;
    do {
        loose_level *level = &e->levels[e->level_count++];
        level->count = count;
        level->boxes = context_allocate(e->context, count, sizeof *level->boxes);
        level->sets = context_allocate(e->context, count, sizeof *level->sets);
        level->active = context_allocate(e->context, count, sizeof *level->active);
        if (level->boxes == NULL || level->sets == NULL || level->active == NULL) return false;
        count = nodes_over(count);
    } while (e->levels[e->level_count - 1].count > 1);
    return true;
}

/* An end of a wire is tested by the first wire at it. */
static uint32_t ends_of_wire(const cscd_mesh *mesh, uint32_t wire) {
    const loose_objects *loose = &mesh->loose;
    uint32_t ends = 0;
    for (int i = 0; i < 2; i++) {
        uint32_t first = loose->wire_stars[loose->wire_star_offsets[mesh->edges[wire][i]]];
        ends |= (uint32_t)(first == wire) << i;
    }
    return ends;
}

static void list_object(const cscd_mesh *mesh, uint32_t object, uint32_t *next_point, loose_elements *e) {
    const cscd_object *of = &mesh->objects[object];
    for (uint32_t i = 0; of->kind == CSCD_OBJECT_WIRES && i < of->edge_count; i++)
        e->items[e->count++] =
            (loose_element){of->first_edge + i, object, ends_of_wire(mesh, of->first_edge + i)};
    for (uint32_t i = 0; of->kind == CSCD_OBJECT_POINTS && i < of->vertex_count; i++)
        e->items[e->count++] = (loose_element){(*next_point)++, object, 1};
}

cscd_status loose_elements_create(const cscd_mesh *mesh, loose_elements *out) {
    loose_elements e = {.context = mesh->context, .count = count_elements(mesh)};
    *out = (loose_elements){.context = mesh->context};
    if (e.count == 0) return CSCD_OK;
    if (!context_allocate_all(e.context, list_arrays(&e)) || !allocate_levels(&e)) {
        loose_elements_destroy(&e);
        return CSCD_OUT_OF_MEMORY;
    }
    uint32_t next_point = mesh->edge_count;
    e.count = 0;
    for (uint32_t i = 0; i < mesh->object_count; i++) list_object(mesh, i, &next_point, &e);
    *out = e;
    return CSCD_OK;
}

void loose_elements_destroy(loose_elements *e) {
    if (e->context == NULL) return;
    for (int i = 0; i < e->level_count; i++) {
        context_free(e->context, e->levels[i].boxes);
        context_free(e->context, e->levels[i].sets);
        context_free(e->context, e->levels[i].active);
    }
    context_free_all(e->context, list_arrays(e));
    *e = (loose_elements){.context = NULL};
}

/* ---- order --------------------------------------------------------------------------------------------- */

typedef struct element_motion {
    loose_elements *elements;
    const swept_interval *interval;
    swept_box around;   /* the starts of all elements */
    double to_cells[3]; /* cells per length along each axis */
} element_motion;

static const double *start_of(const swept_interval *interval, const loose_element *element) {
    return interval->x0 + (size_t)interval->mesh->edges[element->edge][0] * 3;
}

static const double *end_of(const swept_interval *interval, const loose_element *element) {
    return interval->x1 + (size_t)interval->mesh->edges[element->edge][0] * 3;
}

/* A sum over each element's first vertex. Any motion will do. */
static void find_common_motion(element_motion *m) {
    loose_elements *e = m->elements;
    double sums[3] = {0.0, 0.0, 0.0};
    m->around = (swept_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < e->count; i++) {
        const double *start = start_of(m->interval, &e->items[i]), *end = end_of(m->interval, &e->items[i]);
        for (int k = 0; k < 3; k++) {
            sums[k] += end[k] - start[k];
            m->around.low[k] = fmin(m->around.low[k], start[k]);
            m->around.high[k] = fmax(m->around.high[k], start[k]);
        }
    }
    for (int k = 0; k < 3; k++) e->common[k] = sums[k] / e->count;
}

/* The number of cells along each axis has this many bits; three numbers of 21 bits fill a code. */
enum { CELL_BITS = 21 };

static uint64_t spread_bits(uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

static void find_cells(element_motion *m) {
    for (int k = 0; k < 3; k++) {
        double extent = m->around.high[k] - m->around.low[k];
        m->to_cells[k] = extent > 0.0 ? (double)((1 << CELL_BITS) - 1) / extent : 0.0;
    }
}

/* The order decides about time only, so that rounding does not matter. */
static uint64_t code_of(const element_motion *m, const double x[3]) {
    uint64_t code = 0;
    for (int k = 0; k < 3; k++) {
        double cell = (x[k] - m->around.low[k]) * m->to_cells[k];
        code |= spread_bits(cell > 0.0 ? (uint64_t)cell & ((1 << CELL_BITS) - 1) : 0) << k;
    }
    return code;
}

static void sort_elements(element_motion *m) {
    loose_elements *e = m->elements;
    for (uint32_t i = 0; i < e->count; i++)
        e->order[i] = (loose_key){code_of(m, start_of(m->interval, &e->items[i])), i};
    sort_by_number(e->order, e->spare_order, e->count, sizeof *e->order);
}

/* ---- boxes --------------------------------------------------------------------------------------------- */

/* Taking off what is common rounds each coordinate at the end by 2^-53 of itself, and that is less than 2^-52 of the
 * larger of the two numbers. */
static void enclose_element(const element_motion *m, uint32_t place) {
    const loose_elements *e = m->elements;
    const swept_interval *interval = m->interval;
    const loose_element *element = &e->items[e->order[place].element];
    double reach = loose_reach(interval, element->object);
    swept_box *box = &e->levels[0].boxes[place];
    *box = (swept_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < 2; i++) {
        size_t at = (size_t)interval->mesh->edges[element->edge][i] * 3;
        for (size_t k = 0; k < 3; k++) {
            double start = interval->x0[at + k], end = interval->x1[at + k] - e->common[k];
            double slack =
                reach + 0x1p-50 * (fabs(start) + fabs(interval->x1[at + k]) + fabs(e->common[k]) + reach);
            box->low[k] = fmin(box->low[k], fmin(start, end) - slack);
            box->high[k] = fmax(box->high[k], fmax(start, end) + slack);
        }
    }
    if (interval->filter.rules != NULL)
        e->levels[0].sets[place] = interval->filter.rules->sets[element->object];
    if (interval->filter.active != NULL)
        e->levels[0].active[place] = edge_is_active(interval->filter.active, interval->mesh, element->edge);
}

static void enclose_share(void *data, uint32_t index) {
    const element_motion *m = data;
    uint32_t begin = index * ELEMENTS_PER_TASK, rest = m->elements->count - begin;
    uint32_t end = begin + (rest < ELEMENTS_PER_TASK ? rest : ELEMENTS_PER_TASK);
    for (uint32_t i = begin; i < end; i++) enclose_element(m, i);
}

static void enclose_node(const loose_level *below, uint32_t node, const swept_interval *interval,
                         loose_level *level) {
    uint32_t begin = node * LOOSE_NODE_CHILDREN, rest = below->count - begin;
    uint32_t count = rest < LOOSE_NODE_CHILDREN ? rest : LOOSE_NODE_CHILDREN;
    swept_box box = below->boxes[begin];
    for (uint32_t i = 1; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            box.low[k] = fmin(box.low[k], below->boxes[begin + i].low[k]);
            box.high[k] = fmax(box.high[k], below->boxes[begin + i].high[k]);
        }
    }
    level->boxes[node] = box;
    level->active[node] = false;
    for (uint32_t i = 0; interval->filter.active != NULL && i < count; i++)
        level->active[node] |= below->active[begin + i];
    if (interval->filter.rules == NULL) return;
    level->sets[node] = below->sets[begin];
    for (uint32_t i = 1; i < count; i++)
        level->sets[node] = object_sets_join(&level->sets[node], &below->sets[begin + i]);
}

void loose_elements_move(loose_elements *e, const swept_interval *interval) {
    element_motion m = {.elements = e, .interval = interval};
    if (e->count == 0) return;
    find_common_motion(&m);
    find_cells(&m);
    sort_elements(&m);
    parallel_run(e->context->threads, (e->count + ELEMENTS_PER_TASK - 1) / ELEMENTS_PER_TASK, enclose_share,
                 &m);
    for (int i = 1; i < e->level_count; i++) {
        for (uint32_t node = 0; node < e->levels[i].count; node++)
            enclose_node(&e->levels[i - 1], node, interval, &e->levels[i]);
    }
}

/* ---- pairs --------------------------------------------------------------------------------------------- */

static bool parted_by_directions(const swept_interval *interval, cscd_contact_kind kind, uint32_t a,
                                 uint32_t b) {
    elementary_query query;
    swept_interval_load(interval, kind, a, b, &query);
    return directions_part(&query, kind, pair_reach(interval, kind, a, b));
}

static void test_end(const swept_interval *interval, uint32_t vertex, uint32_t triangle,
                     contact_worker *worker) {
    if (!pair_filter_admits_features(&interval->filter, CSCD_CONTACT_VF, vertex, triangle)) return;
    if (parted_by_directions(interval, CSCD_CONTACT_VF, vertex, triangle)) return;
    worker->feature_pairs++;
    narrow_phase_test_vf(interval, vertex, triangle, worker);
}

static void test_edges(const swept_interval *interval, uint32_t a, uint32_t b, contact_worker *worker) {
    if (!pair_filter_admits_features(&interval->filter, CSCD_CONTACT_EE, a, b)) return;
    if (parted_by_directions(interval, CSCD_CONTACT_EE, a < b ? a : b, a < b ? b : a)) return;
    worker->feature_pairs++;
    narrow_phase_test_ee(interval, a, b, worker);
}

void loose_pairs_with_triangle(const swept_interval *interval, const loose_element *element,
                               uint32_t triangle, contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    for (int i = 0; i < 2; i++) {
        if ((element->ends >> i & 1) != 0)
            test_end(interval, mesh->edges[element->edge][i], triangle, worker);
    }
    if (edge_is_point(mesh, element->edge)) return;
    uint32_t owned = represented_features(interval->representatives, triangle) >> 3;
    for (int i = 0; i < 3; i++) {
        if ((owned >> i & 1) != 0)
            test_edges(interval, element->edge, mesh->triangle_edges[triangle][i], worker);
    }
}

void loose_pairs_of_elements(const swept_interval *interval, const loose_element *a, const loose_element *b,
                             contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    if (!pair_filter_admits_objects(&interval->filter, a->object, b->object)) return;
    if (edges_share_vertex(mesh->edges[a->edge], mesh->edges[b->edge])) return;
    if (loose_edges_meet(interval, a->edge, b->edge)) test_edges(interval, a->edge, b->edge, worker);
}
