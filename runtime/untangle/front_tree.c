/* Symbolic analysis: order, elimination tree (Liu 1990), fronts of columns with like patterns, which are merged where that adds few
 * zeros, and the rows of all fronts. */
#include "runtime/untangle/front_tree.h"

#include "runtime/untangle/fill_order.h"

#include <string.h>

/* ---- graphs -------------------------------------------------------------------------------------------------- */

typedef struct owned_graph {
    size_t *begins;
    uint32_t *neighbours;
} owned_graph;

static array_list graph_arrays(owned_graph *g, size_t row_count, size_t neighbour_count) {
    return (array_list){{ARRAY(g->begins, row_count + 1), ARRAY(g->neighbours, neighbour_count)}};
}

/* Makes begins of the counts that stand one place behind. */
static void sum_begins(size_t *begins, size_t row_count) {
    for (size_t i = 0; i < row_count; i++) begins[i + 1] += begins[i];
}

/* Fills by the ends: begins[i + 1] counts up from where row i begins. */
static void shift_begins(size_t *begins, size_t row_count) {
    for (size_t i = row_count; i > 0; i--) begins[i] = begins[i - 1];
    begins[0] = 0;
}

static void fill_both(owned_graph *g, uint32_t row_count, const block_slot *slots, size_t slot_count) {
    for (size_t s = 0; s < slot_count; s++) {
        if (slots[s].row == slots[s].column) continue;
        g->begins[slots[s].row + 1]++;
        g->begins[slots[s].column + 1]++;
    }
    sum_begins(g->begins, row_count);
    for (size_t s = 0; s < slot_count; s++) {
        const uint32_t row = slots[s].row, column = slots[s].column;
        if (row == column) continue;
        g->neighbours[g->begins[row]++] = column;
        g->neighbours[g->begins[column]++] = row;
    }
    shift_begins(g->begins, row_count);
}

/* Writes for each place the earlier places beside it. */
static void fill_earlier(owned_graph *g, uint32_t row_count, const block_slot *slots, size_t slot_count,
                         const uint32_t *places) {
    memset(g->begins, 0, ((size_t)row_count + 1) * sizeof *g->begins);
    for (size_t s = 0; s < slot_count; s++) {
        const uint32_t a = places[slots[s].row], b = places[slots[s].column];
        if (a != b) g->begins[(a < b ? b : a) + 1]++;
    }
    sum_begins(g->begins, row_count);
    for (size_t s = 0; s < slot_count; s++) {
        const uint32_t a = places[slots[s].row], b = places[slots[s].column];
        if (a != b) g->neighbours[g->begins[a < b ? b : a]++] = a < b ? a : b;
    }
    shift_begins(g->begins, row_count);
}

/* ---- the elimination tree ------------------------------------------------------------------------------------ */

/* The work of an analysis; all arrays but the graph are by place. */
typedef struct tree_draft {
    cscd_context *context;
    uint32_t row_count;
    const block_slot *slots;
    size_t slot_count;
    owned_graph graph;
    uint32_t *order, *parents, *ancestors, *counts, *marks, *renamed;
    uint32_t *heads, *nexts, *stack;
    uint32_t *nodes; /* of places: the unmerged fronts */
    bool *is_full;   /* of unmerged fronts: blocks are not numbers times the identity */
    uint32_t *node_pivots, *node_rows, *node_parents, *node_owners;
    size_t *node_zeros;
    uint32_t node_count;
} tree_draft;

static array_list draft_arrays(tree_draft *d) {
    const size_t n = (size_t)d->row_count + 1;
    return (array_list){{ARRAY(d->order, n), ARRAY(d->parents, n), ARRAY(d->ancestors, n),
                         ARRAY(d->counts, n), ARRAY(d->marks, n), ARRAY(d->renamed, n), ARRAY(d->heads, n),
                         ARRAY(d->nexts, n), ARRAY(d->stack, n), ARRAY(d->nodes, n), ARRAY(d->is_full, n),
                         ARRAY(d->node_pivots, n), ARRAY(d->node_rows, n), ARRAY(d->node_parents, n),
                         ARRAY(d->node_owners, n), ARRAY(d->node_zeros, n)}};
}

static void find_parents(tree_draft *d) {
    for (uint32_t j = 0; j < d->row_count; j++) {
        d->parents[j] = d->ancestors[j] = NO_FRONT;
        for (size_t k = d->graph.begins[j]; k < d->graph.begins[j + 1]; k++) {
            uint32_t i = d->graph.neighbours[k];
            while (i != NO_FRONT && i != j) {
                const uint32_t next = d->ancestors[i];
                d->ancestors[i] = j;
                if (next == NO_FRONT) d->parents[i] = j;
                i = next;
            }
        }
    }
}

/* Writes a postorder of a forest: the numbers of nodes, children in ascending order. */
static void write_postorder(tree_draft *d, const uint32_t *parents, uint32_t count, uint32_t *numbers) {
    uint32_t number = 0, root = NO_FRONT;
    for (uint32_t i = 0; i < count; i++) d->heads[i] = NO_FRONT;
    for (uint32_t i = count; i-- > 0;) {
        uint32_t *head = parents[i] == NO_FRONT ? &root : &d->heads[parents[i]];
        d->nexts[i] = *head;
        *head = i;
    }
    for (; root != NO_FRONT; root = d->nexts[root]) {
        uint32_t depth = 0;
        d->stack[depth++] = root;
        while (depth > 0) {
            const uint32_t top = d->stack[depth - 1], child = d->heads[top];
            if (child != NO_FRONT) {
                d->heads[top] = d->nexts[child];
                d->stack[depth++] = child;
            } else {
                numbers[top] = number++;
                depth--;
            }
        }
    }
}

/* Renumbers the places in postorder, which changes nothing of the fill. */
static void postorder_places(tree_draft *d, uint32_t *places) {
    write_postorder(d, d->parents, d->row_count, d->renamed);
    for (uint32_t i = 0; i < d->row_count; i++) {
        d->ancestors[d->renamed[i]] = d->parents[i] == NO_FRONT ? NO_FRONT : d->renamed[d->parents[i]];
        places[i] = d->renamed[places[i]];
    }
    memcpy(d->parents, d->ancestors, d->row_count * sizeof *d->parents);
    fill_earlier(&d->graph, d->row_count, d->slots, d->slot_count, places);
}

/* The rows of each column of the factor: a row reaches all columns on the paths from its earlier neighbours to itself. */
static void count_columns(tree_draft *d) {
    for (uint32_t j = 0; j < d->row_count; j++) {
        d->counts[j] = 1;
        d->marks[j] = j;
        for (size_t k = d->graph.begins[j]; k < d->graph.begins[j + 1]; k++) {
            for (uint32_t i = d->graph.neighbours[k]; d->marks[i] != j; i = d->parents[i]) {
                d->counts[i]++;
                d->marks[i] = j;
            }
        }
    }
}

/* ---- fronts -------------------------------------------------------------------------------------------------- */

static void find_nodes(tree_draft *d, const uint32_t *places) {
    uint32_t count = 0;
    for (uint32_t j = 0; j < d->row_count; j++) {
        if (j == 0 || d->parents[j - 1] != j || d->counts[j - 1] != d->counts[j] + 1) {
            d->node_pivots[count] = 0;
            d->node_rows[count] = d->counts[j];
            d->node_owners[count] = count;
            count++;
        }
        d->nodes[j] = count - 1;
        d->node_pivots[count - 1]++;
    }
    d->node_count = count;
    for (uint32_t j = 0; j < d->row_count; j++)
        d->node_parents[d->nodes[j]] = d->parents[j] == NO_FRONT ? NO_FRONT : d->nodes[d->parents[j]];
    for (size_t s = 0; s < d->slot_count; s++) {
        const uint32_t a = places[d->slots[s].row], b = places[d->slots[s].column];
        if (!d->slots[s].is_scalar) d->is_full[d->nodes[a < b ? a : b]] = true;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (d->is_full[i] && d->node_parents[i] != NO_FRONT) d->is_full[d->node_parents[i]] = true;
    }
}

static size_t count_entries(size_t pivots, size_t rows) {
    return pivots * rows - pivots * (pivots - 1) / 2;
}

/* Small fronts cost more than their operations, so the smaller they are, the more zeros are worth it: 0.4 of the entries where there
 * are four pivots. */
static bool merging_pays(size_t pivots, size_t zeros, size_t entries) {
    return (double)zeros * (double)pivots < 1.6 * (double)entries;
}

/* Merges nodes with their parents where that pays. An owner is a later node, the last of those that are merged. */
static void merge_nodes(tree_draft *d) {
    for (uint32_t i = 0; i < d->node_count; i++) {
        const uint32_t p = d->node_parents[i];
        if (p == NO_FRONT || d->is_full[i] != d->is_full[p]) continue;
        const size_t pivots = d->node_pivots[i] + d->node_pivots[p],
                     rows = d->node_rows[p] + d->node_pivots[i];
        const size_t used = count_entries(d->node_pivots[i], d->node_rows[i]) - d->node_zeros[i] +
                            count_entries(d->node_pivots[p], d->node_rows[p]) - d->node_zeros[p];
        const size_t entries = count_entries(pivots, rows);
        if (!merging_pays(pivots, entries - used, entries)) continue;
        d->node_owners[i] = p;
        d->node_pivots[p] = (uint32_t)pivots;
        d->node_rows[p] = (uint32_t)rows;
        d->node_zeros[p] = entries - used;
    }
    for (uint32_t i = d->node_count; i-- > 0;) d->node_owners[i] = d->node_owners[d->node_owners[i]];
    for (uint32_t i = 0; i < d->node_count; i++) {
        if (d->node_parents[i] != NO_FRONT) d->node_parents[i] = d->node_owners[d->node_parents[i]];
    }
}

/* Numbers what is left of the nodes in postorder: renamed has their numbers. */
static uint32_t number_fronts(tree_draft *d) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < d->node_count; i++) {
        if (d->node_owners[i] == i) d->order[i] = count++;
    }
    for (uint32_t i = 0; i < d->node_count; i++) {
        if (d->node_owners[i] == i)
            d->ancestors[d->order[i]] =
                d->node_parents[i] == NO_FRONT ? NO_FRONT : d->order[d->node_parents[i]];
    }
    write_postorder(d, d->ancestors, count, d->counts);
    for (uint32_t i = 0; i < d->node_count; i++) d->renamed[i] = d->counts[d->order[d->node_owners[i]]];
    return count;
}

static void write_fronts(tree_draft *d, front_tree *t) {
    for (uint32_t i = 0; i < d->node_count; i++) {
        if (d->node_owners[i] != i) continue;
        const uint32_t parent = d->node_parents[i];
        t->fronts[d->renamed[i]] =
            (matrix_front){.pivot_count = d->node_pivots[i],
                           .row_count = d->node_rows[i],
                           .parent = parent == NO_FRONT ? NO_FRONT : d->renamed[parent],
                           .unit = d->is_full[i] ? 3 : 1};
    }
    uint32_t first = 0;
    size_t list = 0;
    for (uint32_t f = 0; f < t->front_count; f++) {
        matrix_front *front = &t->fronts[f];
        front->first = first;
        front->list = list;
        first += front->pivot_count;
        list += front->row_count - front->pivot_count;
        if (front->row_count > t->largest) t->largest = front->row_count;
        if (front->parent != NO_FRONT) t->fronts[front->parent].descendants += front->descendants + 1;
    }
}

/* Gives the places their last numbers: by front, and within it as before. */
static void place_in_fronts(tree_draft *d, front_tree *t) {
    for (uint32_t f = 0; f < t->front_count; f++) d->marks[f] = t->fronts[f].first;
    for (uint32_t j = 0; j < d->row_count; j++) d->order[j] = d->marks[d->renamed[d->nodes[j]]]++;
    for (uint32_t i = 0; i < d->row_count; i++) t->places[i] = d->order[t->places[i]];
    for (uint32_t f = 0; f < t->front_count; f++) {
        for (uint32_t k = 0; k < t->fronts[f].pivot_count; k++) t->front_of[t->fronts[f].first + k] = f;
    }
    fill_earlier(&d->graph, d->row_count, d->slots, d->slot_count, t->places);
}

/* Each place in turn goes to all fronts on the paths from its earlier neighbours to its own, so lists are ascending. */
static void write_lists(tree_draft *d, front_tree *t) {
    for (uint32_t f = 0; f < t->front_count; f++) {
        d->marks[f] = NO_FRONT;
        d->counts[f] = 0;
    }
    for (uint32_t j = 0; j < d->row_count; j++) {
        const uint32_t own = t->front_of[j];
        for (size_t k = d->graph.begins[j]; k < d->graph.begins[j + 1]; k++) {
            for (uint32_t f = t->front_of[d->graph.neighbours[k]]; f != own && d->marks[f] != j;
                 f = t->fronts[f].parent) {
                d->marks[f] = j;
                t->lists[t->fronts[f].list + d->counts[f]++] = j;
            }
        }
    }
}

/* A front's update is made above those of its children, and then moved to where the first of them began. */
static bool lay_out(front_tree *t) {
    size_t height = 0;
    for (uint32_t f = 0; f < t->front_count; f++) {
        matrix_front *front = &t->fronts[f];
        const size_t later = (size_t)(front->row_count - front->pivot_count) * front->unit;
        const size_t pivots = (size_t)front->pivot_count * front->unit;
        front->update_stride = front_align(later);
        front->stride = front_align(pivots + front->update_stride);
        front->factor = t->factor_size;
        front->update = front->descendants > 0 ? t->fronts[f - front->descendants].update : height;
        const size_t size = later * front->update_stride;
        if (pivots > (SIZE_MAX / 16 - t->factor_size) / front->stride) return false;
        t->factor_size += pivots * front->stride;
        if (height + size > t->update_size) t->update_size = height + size;
        height = front->update + size;
    }
    return true;
}

/* ---- the analysis -------------------------------------------------------------------------------------------- */

void front_tree_free(cscd_context *context, front_tree *tree) {
    context_free(context, tree->places);
    context_free(context, tree->front_of);
    context_free(context, tree->fronts);
    context_free(context, tree->lists);
    *tree = (front_tree){.row_count = 0};
}

static cscd_status make_fronts(tree_draft *d, front_tree *t) {
    size_t list_size = 0;
    fill_earlier(&d->graph, d->row_count, d->slots, d->slot_count, t->places);
    find_parents(d);
    postorder_places(d, t->places);
    count_columns(d);
    find_nodes(d, t->places);
    merge_nodes(d);
    t->front_count = number_fronts(d);
    for (uint32_t i = 0; i < d->node_count; i++) {
        if (d->node_owners[i] == i) list_size += d->node_rows[i] - d->node_pivots[i];
    }
    t->fronts = context_allocate(d->context, t->front_count, sizeof *t->fronts);
    t->lists = context_reserve(d->context, list_size, sizeof *t->lists);
    if (t->fronts == NULL || t->lists == NULL) return context_out_of_memory(d->context);
    write_fronts(d, t);
    place_in_fronts(d, t);
    write_lists(d, t);
    return lay_out(t) ? CSCD_OK : context_out_of_memory(d->context);
}

static cscd_status order_places(tree_draft *d, front_tree *t) {
    const row_graph graph = {d->row_count, d->graph.begins, d->graph.neighbours};
    fill_both(&d->graph, d->row_count, d->slots, d->slot_count);
    const cscd_status status = fill_order_find(d->context, &graph, d->order);
    if (status != CSCD_OK) return status;
    for (uint32_t k = 0; k < d->row_count; k++) t->places[d->order[k]] = k;
    return CSCD_OK;
}

cscd_status front_tree_make(cscd_context *context, uint32_t row_count, const block_slot *slots,
                            size_t slot_count, front_tree *out) {
    tree_draft d = {.context = context, .row_count = row_count, .slots = slots, .slot_count = slot_count};
    cscd_status status;
    front_tree_free(context, out);
    out->row_count = row_count;
    out->places = context_reserve(context, row_count, sizeof *out->places);
    out->front_of = context_reserve(context, row_count, sizeof *out->front_of);
    if (out->places == NULL || out->front_of == NULL ||
        !context_allocate_all(context, graph_arrays(&d.graph, row_count, 2 * slot_count))) {
        status = context_out_of_memory(context);
    } else {
        status = context_allocate_all(context, draft_arrays(&d)) ? order_places(&d, out)
                                                                 : context_out_of_memory(context);
        if (status == CSCD_OK) status = make_fronts(&d, out);
        context_free_all(context, draft_arrays(&d));
        context_free_all(context, graph_arrays(&d.graph, row_count, 2 * slot_count));
    }
    if (status != CSCD_OK) front_tree_free(context, out);
    return status;
}

uint32_t front_tree_find(const front_tree *tree, const matrix_front *front, uint32_t place) {
    if (place < front->first + front->pivot_count) return place - front->first;
    const uint32_t *list = tree->lists + front->list;
    uint32_t low = 0, high = front->row_count - front->pivot_count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (list[middle] <= place)
            low = middle;
        else
            high = middle;
    }
    return front->pivot_count + low;
}
