/* Finds the columns of a block that give the others, from some of its rows, and looks in all columns at other rows whether they do. */
#include "preprocess/treecode/source_tree.h"

#include "src/core/simd.h"

#include <math.h>
#include <string.h>

/* Rows that decide, and rows of each column that are only compared. Mostly the rank is 3 to 6, and few rows will do. */
enum { ROWS_MOST = 40, ROWS_CHECKED = 8, RANK_MOST = 24, RANK_USUAL = 6 };
static const uint32_t row_counts[] = {8, 16, ROWS_MOST};
_Static_assert(ROWS_MOST * 3 / 5 <= RANK_MOST,
               "there is room for the columns that so many rows can tell apart");

/* The part of a column that may be left, as a share of the largest: about the residual at which the
 * iterations end. */
static const double rank_tolerance = 1e-6, check_tolerance = 1e-5;

/* Memory that is needed for one block. */
typedef struct rank_room {
    const source_node *target, *source;
    uint32_t target_count, source_count, row_count, rank;
    double (*columns)[ROWS_MOST]; /* of each source: its potentials at the rows */
    double *weights;              /* RANK_MOST of each source */
    double *squares;              /* what is left of each column */
    float *chosen_columns;        /* `rank` of them, of all targets */
    uint32_t chosen[RANK_MOST];
} rank_room;

static array_list list_room(rank_room *room) {
    return (array_list){{ARRAY(room->columns, room->source_count),
                         ARRAY(room->weights, (size_t)room->source_count * RANK_MOST),
                         ARRAY(room->squares, room->source_count),
                         ARRAY(room->chosen_columns, (size_t)room->target_count * RANK_MOST)}};
}

static uint32_t count_of(const source_node *node) {
    return node->end - node->begin;
}

/* ---- rows and columns ---------------------------------------------------------------------------------- */

/* Points of targets. */
typedef struct row_points {
    double x[ROWS_MOST], y[ROWS_MOST], z[ROWS_MOST];
    uint32_t count;
} row_points;

static void add_row(const source_tree *tree, uint32_t target, row_points *rows) {
    const double *p = tree->sources[target].centroid;
    rows->x[rows->count] = p[0];
    rows->y[rows->count] = p[1];
    rows->z[rows->count++] = p[2];
}

/* Writes the potentials of a charge of 1 on one source. */
static void find_potentials(const source_tree *tree, uint32_t source, const row_points *rows,
                            double *potentials) {
    const potential_source *triangle = triangle_of(tree, source);
    potential_at(triangle, rows->x, rows->y, rows->z, rows->count, potentials);
    for (uint32_t i = 0; i < rows->count; i++) potentials[i] /= triangle->area;
}

/* Rows evenly from the tree's order, which is one of neighbours. */
static void fill_columns(const source_tree *tree, rank_room *room) {
    row_points rows = {.count = 0};
    for (uint64_t i = 0; i < room->row_count; i++)
        add_row(tree,
                room->target->begin + (uint32_t)((2 * i + 1) * room->target_count / (2 * room->row_count)),
                &rows);
    for (uint32_t j = 0; j < room->source_count; j++) {
        double *column = room->columns[j];
        find_potentials(tree, room->source->begin + j, &rows, column);
        room->squares[j] = 0.0;
        for (uint32_t i = 0; i < room->row_count; i++) room->squares[j] += column[i] * column[i];
    }
}

/* The potentials of one source at all targets of a node. */
static void write_column(const source_tree *tree, const source_node *target, uint32_t source, float *out) {
    double potentials[ROWS_MOST];
    for (uint32_t begin = target->begin; begin < target->end;) {
        row_points rows = {.count = 0};
        while (begin < target->end && rows.count < ROWS_MOST) add_row(tree, begin++, &rows);
        find_potentials(tree, source, &rows, potentials);
        for (uint32_t i = 0; i < rows.count; i++) *out++ = (float)potentials[i];
    }
}

/* ---- the choice of columns ----------------------------------------------------------------------------- */

static uint32_t largest_column(const rank_room *room) {
    uint32_t largest = 0;
    for (uint32_t j = 1; j < room->source_count; j++)
        if (room->squares[j] > room->squares[largest]) largest = j;
    return largest;
}

/* Takes the direction of a column from all columns; their shares of it are weights for now. */
static void take_direction(rank_room *room, uint32_t pivot) {
    const uint32_t rows = room->row_count;
    double direction[ROWS_MOST];
    const double length = sqrt(room->squares[pivot]);
    for (uint32_t i = 0; i < rows; i++) direction[i] = room->columns[pivot][i] / length;
    for (uint32_t j = 0; j < room->source_count; j++) {
        double *column = room->columns[j], share = 0.0, square = 0.0;
        for (uint32_t i = 0; i < rows; i++) share += direction[i] * column[i];
        for (uint32_t i = 0; i < rows; i++) {
            column[i] -= share * direction[i];
            square += column[i] * column[i];
        }
        room->weights[(size_t)j * RANK_MOST + room->rank] = share;
        room->squares[j] = square;
    }
    room->squares[pivot] = 0.0;
    room->chosen[room->rank++] = pivot;
}

/* Shares of directions become weights of the chosen columns: a triangular system each. */
static void find_weights(rank_room *room) {
    for (uint32_t j = 0; j < room->source_count; j++) {
        double *weights = room->weights + (size_t)j * RANK_MOST;
        bool is_chosen = false;
        for (uint32_t r = 0; r < room->rank; r++) is_chosen |= room->chosen[r] == j;
        if (is_chosen) continue;
        for (uint32_t r = room->rank; r-- > 0;) {
            const double *of_chosen = room->weights + (size_t)room->chosen[r] * RANK_MOST;
            weights[r] /= of_chosen[r];
            for (uint32_t q = 0; q < r; q++) weights[q] -= weights[r] * of_chosen[q];
        }
    }
    for (uint32_t r = 0; r < room->rank; r++) {
        double *weights = room->weights + (size_t)room->chosen[r] * RANK_MOST;
        for (uint32_t q = 0; q < room->rank; q++) weights[q] = q == r;
    }
}

/* Compares in each column other rows, so that all targets have their turn. */
static bool rows_agree(const source_tree *tree, const rank_room *room, double most) {
    for (uint32_t j = 0; j < room->source_count; j++) {
        const double *weights = room->weights + (size_t)j * RANK_MOST;
        const uint64_t share =
            (uint32_t)(j * 2654435769u); /* of 2^32: the golden ratio's multiples lie evenly */
        double potentials[ROWS_MOST];
        row_points rows = {.count = 0};
        uint32_t places[ROWS_CHECKED];
        for (uint32_t i = 0; i < ROWS_CHECKED; i++) {
            places[i] = (uint32_t)((((uint64_t)i << 32) + share) / ROWS_CHECKED * room->target_count >> 32);
            add_row(tree, room->target->begin + places[i], &rows);
        }
        find_potentials(tree, room->source->begin + j, &rows, potentials);
        for (uint32_t i = 0; i < ROWS_CHECKED; i++) {
            double sum = 0.0;
            for (uint32_t r = 0; r < room->rank; r++)
                sum += weights[r] * room->chosen_columns[(size_t)r * room->target_count + places[i]];
            if (!(fabs(sum - potentials[i]) <= most)) return false;
        }
    }
    return true;
}

/* False: no columns give the others, as far as this number of rows tells. */
static bool choose_columns_by(const source_tree *tree, uint32_t row_count, rank_room *room) {
    const bool all = room->target_count <= row_count;
    const uint32_t rank_most = all ? RANK_MOST : row_count * 3 / 5; /* of ROWS_MOST no more than RANK_MOST */
    room->row_count = all ? room->target_count : row_count;
    room->rank = 0;
    fill_columns(tree, room);
    uint32_t pivot = largest_column(room);
    const double first = sqrt(room->squares[pivot]), of_row = first / sqrt(room->row_count);
    while (room->rank < rank_most && sqrt(room->squares[pivot]) > rank_tolerance * first) {
        take_direction(room, pivot);
        pivot = largest_column(room);
    }
    if (sqrt(room->squares[pivot]) > rank_tolerance * first) return false;
    find_weights(room);
    for (uint32_t r = 0; r < room->rank; r++)
        write_column(tree, room->target, room->source->begin + room->chosen[r],
                     room->chosen_columns + (size_t)r * room->target_count);
    return all || rows_agree(tree, room, check_tolerance * of_row);
}

static bool choose_columns(const source_tree *tree, rank_room *room) {
    for (size_t i = 0; i < sizeof row_counts / sizeof *row_counts; i++) {
        if (choose_columns_by(tree, row_counts[i], room)) return true;
        if (room->target_count <= row_counts[i]) return false; /* these were all */
    }
    return false;
}

/* ---- lists --------------------------------------------------------------------------------------------- */

typedef struct rank_search {
    const source_tree *tree;
    rank_blocks *blocks;
    const interactions *lists;
    bool failed[TREE_TASKS_MOST]; /* no memory */
} rank_search;

/* Returns room for more numbers, or NULL. */
static float *add_block(cscd_context *context, rank_list *list, rank_block block, size_t number_count) {
    if (list->block_count == list->block_room) {
        const size_t room = 2 * list->block_room + 8;
        rank_block *grown = context_grow(context, list->blocks, list->block_count, room, sizeof *grown);
        if (grown == NULL) return NULL;
        list->blocks = grown;
        list->block_room = room;
    }
    if (list->number_room - list->number_count < number_count) {
        const size_t room = list->number_room + list->number_room / 4 + number_count;
        float *grown = context_grow(context, list->numbers, list->number_count, room, sizeof *grown);
        if (grown == NULL) return NULL;
        list->numbers = grown;
        list->number_room = room;
    }
    block.begin = list->number_count;
    list->blocks[list->block_count++] = block;
    list->number_count += number_count;
    return list->numbers + block.begin;
}

static bool keep_all(const source_tree *tree, rank_list *list, uint32_t target, uint32_t source) {
    const source_node *a = &tree->nodes[target], *b = &tree->nodes[source];
    const size_t rows = count_of(a);
    float *out = add_block(tree->context, list, (rank_block){target, source, 0, 0}, rows * count_of(b));
    if (out == NULL) return false;
    for (uint32_t s = b->begin; s < b->end; s++, out += rows) write_column(tree, a, s, out);
    return true;
}

static bool keep_columns(const source_tree *tree, rank_list *list, uint32_t target, uint32_t source,
                         const rank_room *room) {
    const size_t rows = room->target_count, columns = room->source_count;
    float *out = add_block(tree->context, list, (rank_block){target, source, room->rank, 0},
                           room->rank * (rows + columns));
    if (out == NULL) return false;
    memcpy(out, room->chosen_columns, room->rank * rows * sizeof *out);
    out += room->rank * rows;
    for (uint32_t r = 0; r < room->rank; r++)
        for (size_t j = 0; j < columns; j++) *out++ = (float)room->weights[j * RANK_MOST + r];
    return true;
}

typedef enum rank_outcome { RANK_KEPT, RANK_TOO_HIGH, RANK_NO_MEMORY } rank_outcome;

static rank_outcome try_columns(const source_tree *tree, rank_list *list, uint32_t target, uint32_t source) {
    const source_node *a = &tree->nodes[target], *b = &tree->nodes[source];
    rank_room room = {.target = a, .source = b, .target_count = count_of(a), .source_count = count_of(b)};
    if (!context_reserve_all(tree->context, list_room(&room))) return RANK_NO_MEMORY;
    rank_outcome outcome = choose_columns(tree, &room) ? RANK_KEPT : RANK_TOO_HIGH;
    const uint64_t all = (uint64_t)room.target_count * room.source_count;
    if ((uint64_t)room.rank * ((uint64_t)room.target_count + room.source_count) > all)
        outcome = RANK_TOO_HIGH;
    if (outcome == RANK_KEPT && !keep_columns(tree, list, target, source, &room)) outcome = RANK_NO_MEMORY;
    context_free_all(tree->context, list_room(&room));
    return outcome;
}

/* False: no memory. */
static bool find_block(const source_tree *tree, rank_list *list, uint32_t target, uint32_t source) {
    const source_node *a = &tree->nodes[target], *b = &tree->nodes[source];
    const rank_outcome outcome = try_columns(tree, list, target, source);
    if (outcome != RANK_TOO_HIGH) return outcome == RANK_KEPT;
    if (node_is_leaf(a) && node_is_leaf(b)) return keep_all(tree, list, target, source);
    const bool opens_target = node_is_leaf(b) || (!node_is_leaf(a) && a->target_radius > b->target_radius);
    for (int i = 0; i < 2; i++)
        if (!find_block(tree, list, opens_target ? a->children[i] : target,
                        opens_target ? source : b->children[i]))
            return false;
    return true;
}

static void find_blocks(void *data, uint32_t task) {
    rank_search *search = data;
    const source_tree *tree = search->tree;
    const interactions *lists = search->lists;
    const uint32_t root = tree->task_nodes[task], end = subtree_end(tree, root);
    for (uint32_t n = root; n < end; n++) {
        for (size_t i = lists->long_begins[n]; i < lists->long_begins[n + 1]; i++) {
            if (!progress_go_on(&tree->context->progress, (double)n / tree->node_count)) return;
            search->failed[task] |= !search->failed[task] && !find_block(tree, &search->blocks->lists[task],
                                                                         n, lists->long_sources[i]);
        }
    }
}

double rank_blocks_expected_bytes(const source_tree *tree, const interactions *lists) {
    double numbers = 0.0, largest = 0.0;
    for (uint32_t n = 0; n < tree->node_count; n++) {
        for (size_t i = lists->long_begins[n]; i < lists->long_begins[n + 1]; i++) {
            const double sources = count_of(&tree->nodes[lists->long_sources[i]]);
            numbers += RANK_USUAL * (count_of(&tree->nodes[n]) + sources);
            largest = fmax(largest, sources);
        }
    }
    return numbers * sizeof(float) + parallel_thread_count(tree->context->threads) * largest *
                                         (ROWS_MOST + RANK_MOST + 1) * sizeof(double);
}

double rank_blocks_bytes(const rank_blocks *blocks) {
    double bytes = 0.0;
    for (uint32_t i = 0; i < TREE_TASKS_MOST; i++) {
        const rank_list *list = &blocks->lists[i];
        bytes += (double)list->block_room * sizeof *list->blocks +
                 (double)list->number_room * sizeof *list->numbers;
    }
    return bytes;
}

cscd_status rank_blocks_create(const source_tree *tree, const interactions *lists, rank_blocks *out) {
    memset(out, 0, sizeof *out);
    out->context = tree->context;
    rank_search search = {tree, out, lists, {false}};
    bool failed = false;
    parallel_run(tree->context->threads, tree->task_count, find_blocks, &search);
    for (uint32_t i = 0; i < tree->task_count; i++) failed |= search.failed[i];
    const cscd_status status = context_progress_status(tree->context);
    return status == CSCD_OK && failed ? context_out_of_memory(tree->context) : status;
}

void rank_blocks_destroy(rank_blocks *blocks) {
    for (uint32_t i = 0; blocks->context != NULL && i < TREE_TASKS_MOST; i++) {
        context_free(blocks->context, blocks->lists[i].blocks);
        context_free(blocks->context, blocks->lists[i].numbers);
    }
    blocks->context = NULL;
}

/* ---- application --------------------------------------------------------------------------------------- */

/* The sum of products, in eight parts whose order is fixed. */
static double weigh_charges(const float *weights, const double *charges, uint32_t count) {
    double sums[LANES] = {0.0};
    uint32_t i = 0;
    for (; i + LANES <= count; i += LANES)
        for (int k = 0; k < LANES; k++) sums[k] += weights[i + (uint32_t)k] * charges[i + (uint32_t)k];
    for (; i < count; i++) sums[0] += weights[i] * charges[i];
    return ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
}

static void add_column(const float *column, double charge, uint32_t count, double *potentials) {
    for (uint32_t i = 0; i < count; i++) potentials[i] += charge * column[i];
}

void rank_blocks_add(const source_tree *tree, const rank_blocks *blocks, uint32_t task, const double *charges,
                     double *potentials) {
    const rank_list *list = &blocks->lists[task];
    for (size_t i = 0; i < list->block_count; i++) {
        const rank_block *block = &list->blocks[i];
        const source_node *a = &tree->nodes[block->target], *b = &tree->nodes[block->source];
        const uint32_t rows = count_of(a), columns = count_of(b),
                       kept = block->rank > 0 ? block->rank : columns;
        const float *column = list->numbers + block->begin, *weights = column + (size_t)kept * rows;
        for (uint32_t r = 0; r < kept; r++, column += rows, weights += columns) {
            const double charge =
                block->rank > 0 ? weigh_charges(weights, charges + b->begin, columns) : charges[b->begin + r];
            add_column(column, charge, rows, potentials + a->begin);
        }
    }
}
