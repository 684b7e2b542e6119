/* Inverts the equations of each leaf and of the triangles around it (Vavasis 1992: mesh neighbours of boundary elements). */
#include "preprocess/treecode/source_tree.h"

#include <math.h>
#include <string.h>

enum { AROUND_MOST = 64, BLOCK_MOST = SOURCES_PER_LEAF + AROUND_MOST };

/* Room of a worker for one leaf at a time. */
typedef struct block_room {
    /* The transposed equations of the block, and on their right the unit vectors of the leaf's own; then the
     * solutions. */
    double equations[BLOCK_MOST][BLOCK_MOST + SOURCES_PER_LEAF];
    double x[BLOCK_MOST], y[BLOCK_MOST], z[BLOCK_MOST];
} block_room;

static array_list list_begins(near_blocks *b) {
    const size_t leaves = b->t->tree.leaf_count;
    return (array_list){{ARRAY(b->begins, leaves + 1), ARRAY(b->row_begins, leaves + 1)}};
}

static array_list list_members(near_blocks *b) {
    return (array_list){{ARRAY(b->members, b->member_count), ARRAY(b->rows, b->row_count)}};
}

static const source_node *leaf_node(const treecode *t, uint32_t leaf) {
    return &t->tree.nodes[t->tree.leaves[leaf]];
}

static uint32_t own_count(const source_node *leaf) {
    return leaf->end - leaf->begin;
}

/* ---- members ------------------------------------------------------------------------------------------- */

/* The leaf's own, and of those that are near some. */
static size_t block_size(const treecode *t, uint32_t l) {
    const size_t *near_begins = t->lists.near_begins + 2 * (size_t)l;
    const size_t own = own_count(leaf_node(t, l)), around = near_begins[1] - near_begins[0] - own;
    return own + (around < AROUND_MOST ? around : AROUND_MOST);
}

double near_blocks_bytes(const treecode *t) {
    double bytes = (double)parallel_thread_count(t->context->threads) * sizeof(block_room);
    for (uint32_t l = 0; l < t->tree.leaf_count; l++) {
        const size_t of_member = sizeof(uint32_t) + sizeof(float) * own_count(leaf_node(t, l));
        bytes += (double)(block_size(t, l) * of_member + 2 * sizeof(size_t));
    }
    return bytes;
}

static void begin_blocks(near_blocks *b) {
    size_t members = 0, rows = 0;
    for (uint32_t l = 0; l < b->t->tree.leaf_count; l++) {
        const size_t block = block_size(b->t, l);
        b->begins[l] = members;
        b->row_begins[l] = rows;
        members += block;
        rows += block * own_count(leaf_node(b->t, l));
    }
    b->begins[b->t->tree.leaf_count] = b->member_count = members;
    b->row_begins[b->t->tree.leaf_count] = b->row_count = rows;
}

/* A triangle around a leaf, and the square of its distance from the nearest of the leaf's. */
typedef struct neighbour {
    double square;
    uint32_t source;
} neighbour;

static double nearest_square(const source_tree *tree, const source_node *leaf, const double p[3]) {
    double nearest = INFINITY;
    for (uint32_t i = leaf->begin; i < leaf->end; i++) {
        const double *q = tree->sources[i].centroid;
        const double d[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
        nearest = fmin(nearest, d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    }
    return nearest;
}

static bool is_nearer(neighbour a, neighbour b) {
    return a.square < b.square || (a.square == b.square && a.source < b.source);
}

/* Lists the leaf's own sources, and of those that are near the nearest, in order. */
static void list_block(near_blocks *b, uint32_t l) {
    const treecode *t = b->t;
    const source_node *leaf = leaf_node(b->t, l);
    const size_t *near_begins = t->lists.near_begins + 2 * (size_t)l;
    uint32_t *members = b->members + b->begins[l];
    const uint32_t most = (uint32_t)(b->begins[l + 1] - b->begins[l]) - own_count(leaf);
    neighbour nearest[AROUND_MOST];
    uint32_t count = 0;
    for (size_t i = near_begins[0]; i < near_begins[1]; i++) {
        const uint32_t source = t->lists.near_sources[i];
        if (source >= leaf->begin && source < leaf->end) continue;
        const neighbour next = {nearest_square(&t->tree, leaf, t->tree.sources[source].centroid), source};
        if (count == most && !is_nearer(next, nearest[count - 1])) continue;
        uint32_t place = count < most ? count++ : count - 1;
        for (; place > 0 && is_nearer(next, nearest[place - 1]); place--) nearest[place] = nearest[place - 1];
        nearest[place] = next;
    }
    for (uint32_t i = leaf->begin; i < leaf->end; i++) *members++ = i;
    for (uint32_t i = 0; i < count; i++) *members++ = nearest[i].source;
}

/* ---- rows of the inverse ------------------------------------------------------------------------------- */

static void set_equations(const near_blocks *b, const uint32_t *members, uint32_t count, uint32_t own,
                          block_room *room) {
    const source_tree *tree = &b->t->tree;
    for (uint32_t i = 0; i < count; i++) {
        const double *p = tree->sources[members[i]].centroid;
        room->x[i] = p[0];
        room->y[i] = p[1];
        room->z[i] = p[2];
    }
    for (uint32_t k = 0; k < count; k++) {
        const potential_source *triangle = triangle_of(tree, members[k]);
        double *row = room->equations[k];
        potential_at(triangle, room->x, room->y, room->z, count, row);
        for (uint32_t i = 0; i < count; i++) row[i] /= triangle->area;
        for (uint32_t i = 0; i < own; i++) row[count + i] = i == k;
    }
}

static void swap_rows(block_room *room, uint32_t a, uint32_t b, uint32_t width) {
    for (uint32_t i = 0; i < width; i++) {
        const double held = room->equations[a][i];
        room->equations[a][i] = room->equations[b][i];
        room->equations[b][i] = held;
    }
}

/* Gaussian elimination with partial pivoting. False: the equations depend on each other. */
static bool eliminate_columns(block_room *room, uint32_t count, uint32_t width) {
    for (uint32_t k = 0; k < count; k++) {
        uint32_t pivot = k;
        for (uint32_t i = k + 1; i < count; i++)
            if (fabs(room->equations[i][k]) > fabs(room->equations[pivot][k])) pivot = i;
        if (pivot != k) swap_rows(room, k, pivot, width);
        if (!(fabs(room->equations[k][k]) > 0.0)) return false;
        for (uint32_t i = k + 1; i < count; i++) {
            const double factor = room->equations[i][k] / room->equations[k][k];
            for (uint32_t j = k + 1; j < width; j++) room->equations[i][j] -= factor * room->equations[k][j];
        }
    }
    return true;
}

/* Leaves the solutions where the right-hand sides were. */
static void substitute_back(block_room *room, uint32_t count, uint32_t width) {
    for (uint32_t k = count; k-- > 0;) {
        for (uint32_t j = k + 1; j < count; j++) {
            const double factor = room->equations[k][j];
            for (uint32_t i = count; i < width; i++) room->equations[k][i] -= factor * room->equations[j][i];
        }
        for (uint32_t i = count; i < width; i++) room->equations[k][i] /= room->equations[k][k];
    }
}

/* If the block has no inverse, each triangle is taken alone. */
static void take_alone(block_room *room, const near_blocks *b, const uint32_t *members, uint32_t count,
                       uint32_t own) {
    set_equations(b, members, count, own, room);
    for (uint32_t k = 0; k < own; k++) room->equations[k][count + k] = 1.0 / room->equations[k][k];
}

static void invert_block(near_blocks *b, uint32_t l, block_room *room) {
    const uint32_t own = own_count(leaf_node(b->t, l)), count = (uint32_t)(b->begins[l + 1] - b->begins[l]);
    const uint32_t *members = b->members + b->begins[l];
    float *rows = b->rows + b->row_begins[l];
    set_equations(b, members, count, own, room);
    if (eliminate_columns(room, count, count + own))
        substitute_back(room, count, count + own);
    else
        take_alone(room, b, members, count, own);
    for (uint32_t k = 0; k < count; k++)
        for (uint32_t i = 0; i < own; i++) *rows++ = (float)room->equations[k][count + i];
}

typedef struct block_inversion {
    near_blocks *blocks;
    block_room *rooms; /* of each worker */
    uint32_t worker_count;
} block_inversion;

static void invert_share(void *data, uint32_t worker) {
    const block_inversion *inversion = data;
    near_blocks *b = inversion->blocks;
    const size_t leaves = b->t->tree.leaf_count,
                 end = parallel_share(leaves, worker + 1, inversion->worker_count);
    for (size_t l = parallel_share(leaves, worker, inversion->worker_count); l < end; l++) {
        if (!progress_go_on(&b->t->context->progress, (double)l / (double)leaves)) return;
        list_block(b, (uint32_t)l);
        invert_block(b, (uint32_t)l, &inversion->rooms[worker]);
    }
}

static cscd_status invert_blocks(near_blocks *b) {
    cscd_context *context = b->t->context;
    block_inversion inversion = {b, NULL, parallel_thread_count(context->threads)};
    inversion.rooms = context_reserve(context, inversion.worker_count, sizeof *inversion.rooms);
    if (inversion.rooms == NULL) return context_out_of_memory(context);
    parallel_run(context->threads, inversion.worker_count, invert_share, &inversion);
    context_free(context, inversion.rooms);
    return context_progress_status(context);
}

cscd_status near_blocks_create(const treecode *t, near_blocks *out) {
    cscd_context *context = t->context;
    *out = (near_blocks){.t = t};
    if (!context_reserve_all(context, list_begins(out))) return context_out_of_memory(context);
    begin_blocks(out);
    const cscd_status status =
        context_reserve_all(context, list_members(out)) ? invert_blocks(out) : context_out_of_memory(context);
    if (status != CSCD_OK) near_blocks_destroy(out);
    return status;
}

void near_blocks_destroy(near_blocks *blocks) {
    if (blocks->t == NULL) return;
    context_free_all(blocks->t->context, list_begins(blocks));
    context_free_all(blocks->t->context, list_members(blocks));
}

/* ---- application --------------------------------------------------------------------------------------- */

typedef struct block_product {
    const near_blocks *blocks;
    const double *potentials;
    double *charges;
} block_product;

static void apply_block(void *data, uint32_t l) {
    const block_product *p = data;
    const near_blocks *b = p->blocks;
    const source_node *leaf = leaf_node(b->t, l);
    const uint32_t own = own_count(leaf);
    const float *rows = b->rows + b->row_begins[l];
    double sums[SOURCES_PER_LEAF] = {0.0};
    for (size_t k = b->begins[l]; k < b->begins[l + 1]; k++) {
        const double potential = p->potentials[b->members[k]];
        for (uint32_t i = 0; i < own; i++) sums[i] += potential * *rows++;
    }
    memcpy(p->charges + leaf->begin, sums, own * sizeof *sums);
}

void near_blocks_apply(const near_blocks *blocks, const double *potentials, double *charges) {
    block_product product = {blocks, potentials, charges};
    parallel_run(blocks->t->context->threads, blocks->t->tree.leaf_count, apply_block, &product);
}
