/* Approximate minimum degree. Eliminated rows become elements, and the graph that is left is kept as a quotient graph: a
 * row has elements, whose rows are all its neighbours, and rows that are neighbours by the matrix itself. */
#include "runtime/untangle/fill_order.h"

#include <math.h>
#include <string.h>

enum { NOBODY = UINT32_MAX };

/* ---- the quotient graph -------------------------------------------------------------------------------------- */

typedef enum node_kind { NODE_ROW, NODE_ELEMENT, NODE_GONE } node_kind;

/* Nodes are rows, and elements under the number of the row that they were made of. Rows that have the same neighbours are one node, of
 * the weight of all. */
typedef struct quotient_graph {
    cscd_context *context;
    uint32_t row_count, left; /* rows that are not yet eliminated */
    uint8_t *kinds;
    size_t *begins; /* of lists: of a row its elements and then its rows, of an element its rows */
    uint32_t *sizes, *element_counts;
    uint32_t *weights;                         /* 0: the row is part of another node */
    uint32_t *owners;                          /* the node that a row became part of */
    uint32_t *degrees;                         /* of rows, at most; of elements the weight of their rows */
    uint32_t *heads, *nexts, *previous, least; /* rows by degree; no degree is below the least one */
    uint64_t *overlaps, overlap_stamp; /* of elements with the newest one, counted from the stamp on */
    uint32_t *members;                 /* the element that a row was last found in */
    uint64_t *seen, seen_stamp;
    uint32_t *buckets, *followers, *hashes; /* of rows by what their lists have */
    uint32_t *pivots, pivot_count;          /* in the order of elimination */
    uint32_t *lists, *spare;
    size_t used, capacity;
} quotient_graph;

static array_list node_arrays(quotient_graph *g) {
    const size_t n = (size_t)g->row_count + 1;
    return (array_list){{ARRAY(g->kinds, n), ARRAY(g->begins, n), ARRAY(g->sizes, n),
                         ARRAY(g->element_counts, n), ARRAY(g->weights, n), ARRAY(g->owners, n),
                         ARRAY(g->degrees, n), ARRAY(g->heads, n), ARRAY(g->nexts, n), ARRAY(g->previous, n),
                         ARRAY(g->overlaps, n), ARRAY(g->members, n), ARRAY(g->seen, n), ARRAY(g->buckets, n),
                         ARRAY(g->followers, n), ARRAY(g->hashes, n), ARRAY(g->pivots, n),
                         ARRAY(g->lists, g->capacity), ARRAY(g->spare, g->capacity)}};
}

static void list_degree(quotient_graph *g, uint32_t row, uint32_t degree) {
    const uint32_t head = g->heads[degree];
    g->nexts[row] = head;
    g->previous[row] = NOBODY;
    if (head != NOBODY) g->previous[head] = row;
    g->heads[degree] = row;
    g->degrees[row] = degree;
    if (degree < g->least) g->least = degree;
}

static void unlist_degree(quotient_graph *g, uint32_t row) {
    const uint32_t next = g->nexts[row], previous = g->previous[row];
    if (next != NOBODY) g->previous[next] = previous;
    if (previous != NOBODY)
        g->nexts[previous] = next;
    else
        g->heads[g->degrees[row]] = next;
}

/* A row with more neighbours than this would be looked at again and again, and comes late in any case. */
static double dense_degree(uint32_t row_count) {
    return fmax(16.0, 10.0 * sqrt((double)row_count));
}

static void begin_rows(quotient_graph *g, const row_graph *graph) {
    const double dense = dense_degree(graph->row_count);
    for (uint32_t i = 0; i < g->row_count; i++) {
        g->heads[i] = g->buckets[i] = g->members[i] = g->owners[i] = NOBODY;
        g->weights[i] = (double)(graph->begins[i + 1] - graph->begins[i]) <= dense;
        g->kinds[i] = g->weights[i] > 0 ? NODE_ROW : NODE_GONE;
        g->left += g->weights[i];
    }
    g->least = g->row_count;
    for (uint32_t i = g->row_count; i-- > 0;) {
        g->begins[i] = g->used;
        for (size_t k = graph->begins[i]; k < graph->begins[i + 1]; k++) {
            if (g->weights[i] > 0 && g->weights[graph->neighbours[k]] > 0)
                g->lists[g->used++] = graph->neighbours[k];
        }
        g->sizes[i] = (uint32_t)(g->used - g->begins[i]);
        if (g->weights[i] > 0) list_degree(g, i, g->sizes[i]);
    }
}

/* Moves the lists that still count together. They are never longer than those of the matrix. */
static void move_together(quotient_graph *g) {
    size_t used = 0;
    for (uint32_t i = 0; i < g->row_count; i++) {
        if (g->kinds[i] == NODE_GONE || g->sizes[i] == 0) continue;
        memcpy(g->spare + used, g->lists + g->begins[i], g->sizes[i] * sizeof *g->lists);
        g->begins[i] = used;
        used += g->sizes[i];
    }
    uint32_t *lists = g->lists;
    g->lists = g->spare;
    g->spare = lists;
    g->used = used;
}

/* ---- elimination --------------------------------------------------------------------------------------------- */

static uint32_t take_least(quotient_graph *g) {
    while (g->heads[g->least] == NOBODY) g->least++;
    const uint32_t row = g->heads[g->least];
    unlist_degree(g, row);
    return row;
}

static void add_members(quotient_graph *g, uint32_t pivot, const uint32_t *rows, uint32_t count) {
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t i = rows[k];
        if (g->weights[i] == 0 || i == pivot || g->members[i] == pivot) continue;
        g->members[i] = pivot;
        g->lists[g->used++] = i;
        unlist_degree(g, i);
    }
}

static void end_node(quotient_graph *g, uint32_t node) {
    g->kinds[node] = NODE_GONE;
    g->sizes[node] = 0;
}

/* Makes an element of the pivot, of all rows beside it, and with it absorbs the pivot's elements. */
static void make_element(quotient_graph *g, uint32_t pivot) {
    if (g->capacity - g->used < g->left) move_together(g);
    const size_t begin = g->used;
    const uint32_t *list = g->lists + g->begins[pivot];
    for (uint32_t k = 0; k < g->element_counts[pivot]; k++) {
        const uint32_t e = list[k];
        if (g->kinds[e] != NODE_ELEMENT) continue;
        add_members(g, pivot, g->lists + g->begins[e], g->sizes[e]);
        end_node(g, e);
    }
    add_members(g, pivot, list + g->element_counts[pivot], g->sizes[pivot] - g->element_counts[pivot]);
    g->begins[pivot] = begin;
    g->sizes[pivot] = (uint32_t)(g->used - begin);
    g->kinds[pivot] = NODE_ELEMENT;
    g->members[pivot] = pivot;
}

/* Writes how much of each other element lies outside of the new one: overlaps, less the stamp. */
static void find_overlaps(quotient_graph *g, uint32_t pivot) {
    g->overlap_stamp += 2 * (uint64_t)g->row_count + 2; /* beyond all that was written before */
    for (uint32_t k = 0; k < g->sizes[pivot]; k++) {
        const uint32_t i = g->lists[g->begins[pivot] + k];
        const uint32_t *list = g->lists + g->begins[i];
        for (uint32_t l = 0; l < g->element_counts[i]; l++) {
            const uint32_t e = list[l];
            if (g->kinds[e] != NODE_ELEMENT) continue;
            if (g->overlaps[e] < g->overlap_stamp) g->overlaps[e] = g->overlap_stamp + g->degrees[e];
            g->overlaps[e] -= g->weights[i];
        }
    }
}

/* Drops from the lists of a row of the new element what that element stands for; elements that lie within it are absorbed. Returns
 * the weight of what is beside the row outside of the element, and NOBODY if the row has the element alone. */
static uint32_t shorten_lists(quotient_graph *g, uint32_t pivot, uint32_t row) {
    uint32_t *list = g->lists + g->begins[row], *rows = g->spare, kept = 0, row_count = 0;
    uint64_t outside = 0;
    uint32_t hash = 0;
    for (uint32_t k = g->element_counts[row]; k < g->sizes[row]; k++) {
        const uint32_t i = list[k];
        if (g->weights[i] == 0 || g->kinds[i] != NODE_ROW || g->members[i] == pivot) continue;
        outside += g->weights[i];
        rows[row_count++] = i;
        hash += i;
    }
    for (uint32_t k = 0; k < g->element_counts[row]; k++) {
        const uint32_t e = list[k];
        if (g->kinds[e] != NODE_ELEMENT) continue;
        if (g->overlaps[e] == g->overlap_stamp) {
            end_node(g, e);
            continue;
        }
        outside += g->overlaps[e] - g->overlap_stamp;
        list[kept++] = e;
        hash += e;
    }
    if (kept + row_count == 0) return NOBODY;
    list[kept++] = pivot; /* in the place of the pivot, or of an element that was absorbed */
    memcpy(list + kept, rows, row_count * sizeof *rows);
    g->element_counts[row] = kept;
    g->sizes[row] = kept + row_count;
    g->hashes[row] = hash % g->row_count;
    return outside < g->left ? (uint32_t)outside : g->left;
}

static void join_rows(quotient_graph *g, uint32_t row, uint32_t owner) {
    g->weights[owner] += g->weights[row];
    g->weights[row] = 0;
    g->owners[row] = owner;
    end_node(g, row);
}

static bool same_lists(const quotient_graph *g, uint32_t row) {
    for (uint32_t k = 0; k < g->sizes[row]; k++) {
        if (g->seen[g->lists[g->begins[row] + k]] != g->seen_stamp) return false;
    }
    return true;
}

/* Joins the rows behind `row` in its bucket that have the same lists. */
static void join_followers(quotient_graph *g, uint32_t row) {
    g->seen_stamp++;
    for (uint32_t k = 0; k < g->sizes[row]; k++) g->seen[g->lists[g->begins[row] + k]] = g->seen_stamp;
    uint32_t *link = &g->followers[row];
    while (*link != NOBODY) {
        const uint32_t other = *link;
        if (g->sizes[other] == g->sizes[row] && g->element_counts[other] == g->element_counts[row] &&
            same_lists(g, other)) {
            join_rows(g, other, row);
            *link = g->followers[other];
        } else {
            link = &g->followers[other];
        }
    }
}

static void join_alike(quotient_graph *g, const uint32_t *rows, uint32_t count) {
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t i = rows[k];
        if (g->weights[i] == 0) continue;
        g->followers[i] = g->buckets[g->hashes[i]];
        g->buckets[g->hashes[i]] = i;
    }
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t hash = g->hashes[rows[k]];
        if (g->weights[rows[k]] == 0) continue;
        for (uint32_t i = g->buckets[hash]; i != NOBODY; i = g->followers[i]) {
            if (g->followers[i] != NOBODY) join_followers(g, i);
        }
        g->buckets[hash] = NOBODY;
    }
}

static void eliminate_row(quotient_graph *g, uint32_t pivot) {
    g->pivots[g->pivot_count++] = pivot;
    make_element(g, pivot);
    find_overlaps(g, pivot);
    uint32_t *rows = g->lists + g->begins[pivot], count = g->sizes[pivot], kept = 0, weight = 0;
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t i = rows[k], outside = shorten_lists(g, pivot, i);
        if (outside == NOBODY)
            join_rows(g, i, pivot); /* it has no other neighbours, so it is eliminated at once */
        else if (outside < g->degrees[i])
            g->degrees[i] = outside;
        if (outside != NOBODY) {
            weight += g->weights[i];
            rows[kept++] = i;
        }
    }
    g->left -= g->weights[pivot];
    join_alike(g, rows, kept);
    count = kept;
    kept = 0;
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t i = rows[k], own = g->weights[i];
        if (own == 0) continue;
        const uint32_t degree = g->degrees[i] + (weight - own);
        list_degree(g, i, degree < g->left - own ? degree : g->left - own);
        rows[kept++] = i;
    }
    g->degrees[pivot] = weight;
    g->sizes[pivot] = kept;
    g->used = g->begins[pivot] + kept;
    if (kept == 0) end_node(g, pivot);
}

/* ---- the order ----------------------------------------------------------------------------------------------- */

/* Behind each pivot stand the rows that became part of it; dense rows are last. */
static void write_order(quotient_graph *g, const row_graph *graph, uint32_t *order) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < g->row_count; i++) g->heads[i] = NOBODY;
    for (uint32_t i = g->row_count; i-- > 0;) {
        uint32_t owner = g->owners[i];
        if (owner == NOBODY) continue;
        while (g->owners[owner] != NOBODY) owner = g->owners[owner];
        g->nexts[i] = g->heads[owner];
        g->heads[owner] = i;
    }
    for (uint32_t k = 0; k < g->pivot_count; k++) {
        order[count++] = g->pivots[k];
        for (uint32_t i = g->heads[g->pivots[k]]; i != NOBODY; i = g->nexts[i]) order[count++] = i;
    }
    for (uint32_t i = 0; i < g->row_count; i++) {
        if ((double)(graph->begins[i + 1] - graph->begins[i]) > dense_degree(g->row_count))
            order[count++] = i;
    }
}

enum { PIVOTS_PER_QUESTION = 256 };

cscd_status fill_order_find(cscd_context *context, const row_graph *graph, uint32_t *order) {
    const size_t entries = graph->begins[graph->row_count];
    quotient_graph g = {.context = context, .row_count = graph->row_count};
    if (entries > UINT32_MAX) return context_out_of_memory(context);
    g.capacity = entries + entries / 4 + graph->row_count + 1;
    if (!context_allocate_all(context, node_arrays(&g))) return context_out_of_memory(context);
    begin_rows(&g, graph);
    bool cancelled = false;
    while (g.left > 0 && !cancelled) {
        eliminate_row(&g, take_least(&g));
        if (g.pivot_count % PIVOTS_PER_QUESTION == 0) cancelled = progress_cancelled(&context->progress);
    }
    if (!cancelled) write_order(&g, graph, order);
    context_free_all(context, node_arrays(&g));
    return cancelled ? context_explain(context, CSCD_CANCELLED) : CSCD_OK;
}
