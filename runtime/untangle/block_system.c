/* Sums of blocks, and the way from them to the fronts and back. */
#include "runtime/untangle/block_system.h"

#include <assert.h>
#include <string.h>

enum { NO_SLOT = UINT32_MAX };

/* ---- entries ------------------------------------------------------------------------------------------------- */

void block_system_free(block_system *s) {
    front_tree_free(s->context, &s->tree);
    context_free(s->context, s->entries);
    context_free(s->context, s->last_entries);
    context_free(s->context, s->values);
    context_free(s->context, s->targets);
    context_free(s->context, s->target_begins);
    context_free(s->context, s->factors.factors);
    context_free(s->context, s->factors.updates);
    context_free(s->context, s->factors.scratch);
    context_free(s->context, s->factors.locals);
    context_free(s->context, s->ordered);
    *s = (block_system){.context = s->context};
}

bool block_system_begin(block_system *s, uint32_t row_count) {
    s->row_count = row_count;
    s->entry_count = s->value_count = 0;
    return true;
}

bool block_system_reserve(block_system *s, size_t entries) {
    if (entries > SIZE_MAX / 288 - s->entry_count) return false;
    const size_t wanted = s->entry_count + entries;
    if (wanted > s->entry_capacity) {
        const size_t room = room_with_spare(wanted);
        block_entry *grown = context_grow(s->context, s->entries, s->entry_count, room, sizeof *grown);
        if (grown == NULL) return false;
        s->entries = grown;
        s->entry_capacity = room;
    }
    const size_t numbers = s->value_count + 9 * entries;
    if (numbers > s->value_capacity) {
        const size_t room = room_with_spare(numbers);
        double *grown = context_grow(s->context, s->values, s->value_count, room, sizeof *grown);
        if (grown == NULL) return false;
        s->values = grown;
        s->value_capacity = room;
    }
    return true;
}

static double *add_entry(block_system *s, uint32_t i, uint32_t j, bool is_scalar) {
    assert(s->entry_count < s->entry_capacity && i < s->row_count && j < s->row_count);
    double *values = s->values + s->value_count;
    s->entries[s->entry_count++] =
        (block_entry){i < j ? i : j, i < j ? j : i, 2 * (uint64_t)s->value_count + is_scalar};
    s->value_count += is_scalar ? 1 : 9;
    return values;
}

void block_system_add_scalar(block_system *s, uint32_t i, uint32_t j, double w) {
    *add_entry(s, i, j, true) = w;
}

void block_system_add_block(block_system *s, uint32_t i, uint32_t j, const double block[9]) {
    double *values = add_entry(s, i, j, false);
    for (int k = 0; k < 9; k++) values[k] = block[i <= j ? k : 3 * (k % 3) + k / 3];
}

/* ---- slots --------------------------------------------------------------------------------------------------- */

/* Which entries have the same place. */
typedef struct slot_draft {
    size_t *begins;    /* of rows, among the sorted ones */
    uint32_t *sorted;  /* entries by row */
    uint32_t *columns; /* the slot that the row at hand has at a column */
    uint32_t *slot_of; /* of entries */
    block_slot *slots;
    size_t slot_count;
} slot_draft;

static array_list slot_arrays(slot_draft *d, size_t rows, size_t entries) {
    return (array_list){{ARRAY(d->begins, rows + 2), ARRAY(d->columns, rows + 1), ARRAY(d->sorted, entries),
                         ARRAY(d->slot_of, entries), ARRAY(d->slots, entries + rows)}};
}

/* Counts the entries of each row, so that begins[r + 1] counts up from where row r begins. */
static void sort_entries(const block_system *s, slot_draft *d) {
    for (size_t e = 0; e < s->entry_count; e++) d->begins[s->entries[e].row + 2]++;
    for (size_t r = 0; r < s->row_count; r++) d->begins[r + 2] += d->begins[r + 1];
    for (size_t e = 0; e < s->entry_count; e++) d->sorted[d->begins[s->entries[e].row + 1]++] = (uint32_t)e;
}

/* Each row has the slot of its diagonal, with or without an entry. */
static void find_slots(const block_system *s, slot_draft *d) {
    for (uint32_t c = 0; c < s->row_count; c++) d->columns[c] = NO_SLOT;
    for (uint32_t r = 0; r < s->row_count; r++) {
        const size_t first = d->slot_count;
        d->columns[r] = (uint32_t)d->slot_count;
        d->slots[d->slot_count++] = (block_slot){r, r, true};
        for (size_t k = d->begins[r]; k < d->begins[r + 1]; k++) {
            const block_entry *e = &s->entries[d->sorted[k]];
            if (d->columns[e->column] == NO_SLOT || d->columns[e->column] < first) {
                d->columns[e->column] = (uint32_t)d->slot_count;
                d->slots[d->slot_count++] = (block_slot){r, e->column, true};
            }
            const uint32_t slot = d->slot_of[d->sorted[k]] = d->columns[e->column];
            d->slots[slot].is_scalar &= (e->place & 1) != 0;
        }
    }
}

/* ---- targets ------------------------------------------------------------------------------------------------- */

static uint32_t front_of_slot(const front_tree *t, const block_slot *slot) {
    const uint32_t a = t->places[slot->row], b = t->places[slot->column];
    return t->front_of[a < b ? a : b];
}

static block_target target_of_slot(const front_tree *t, const block_slot *slot) {
    const uint32_t a = t->places[slot->row], b = t->places[slot->column];
    const matrix_front *front = &t->fronts[front_of_slot(t, slot)];
    const size_t row = (a < b ? a : b) - front->first, column = front_tree_find(t, front, a < b ? b : a);
    return (block_target){.place = front->factor + front->unit * (row * front->stride + column),
                          .stride = (uint32_t)front->stride,
                          .is_transposed = b < a,
                          .is_block = front->unit == 3};
}

static void write_targets(block_system *s, const slot_draft *d, block_target *of_slots) {
    size_t *ends = s->target_begins + 1, *begins = s->target_begins;
    for (size_t f = 0; f <= s->tree.front_count; f++) begins[f] = 0;
    for (size_t k = 0; k < d->slot_count; k++) of_slots[k] = target_of_slot(&s->tree, &d->slots[k]);
    for (size_t e = 0; e < s->entry_count; e++) ends[front_of_slot(&s->tree, &d->slots[d->slot_of[e]])]++;
    for (uint32_t f = 0; f < s->tree.front_count; f++) begins[f + 1] += begins[f];
    for (size_t e = s->entry_count; e-- > 0;) {
        const uint32_t slot = d->slot_of[e];
        block_target *target = &s->targets[--ends[front_of_slot(&s->tree, &d->slots[slot])]];
        *target = of_slots[slot];
        target->source = s->entries[e].place;
    }
    /* Now ends[f] is where front f begins. */
    for (uint32_t f = 0; f < s->tree.front_count; f++) begins[f] = begins[f + 1];
    begins[s->tree.front_count] = s->entry_count;
}

static cscd_status renew_targets(block_system *s, const slot_draft *d) {
    const size_t room = room_with_spare(s->entry_count), begin_count = (size_t)s->tree.front_count + 1;
    block_target *of_slots;
    if (!context_renew_all(s->context, (array_list){{ARRAY(s->targets, room)}}, &s->target_capacity,
                           s->entry_count) ||
        !context_renew_all(s->context, (array_list){{ARRAY(s->last_entries, room)}}, &s->last_capacity,
                           s->entry_count) ||
        !context_renew_all(s->context, (array_list){{ARRAY(s->target_begins, room_with_spare(begin_count))}},
                           &s->begin_capacity, begin_count))
        return context_out_of_memory(s->context);
    of_slots = context_reserve(s->context, d->slot_count, sizeof *of_slots);
    if (of_slots == NULL) return context_out_of_memory(s->context);
    write_targets(s, d, of_slots);
    context_free(s->context, of_slots);
    if (s->entry_count > 0) memcpy(s->last_entries, s->entries, s->entry_count * sizeof *s->entries);
    s->last_count = s->entry_count;
    s->has_tree = true;
    return CSCD_OK;
}

/* ---- factors ------------------------------------------------------------------------------------------------- */

static bool pattern_is_kept(const block_system *s) {
    return s->has_tree && s->tree.row_count == s->row_count && s->last_count == s->entry_count &&
           (s->entry_count == 0 ||
            memcmp(s->last_entries, s->entries, s->entry_count * sizeof *s->entries) == 0);
}

static cscd_status analyse_pattern(block_system *s) {
    slot_draft d = {.slot_count = 0};
    s->has_tree = false;
    if (s->entry_count > UINT32_MAX - 1 - s->row_count ||
        !context_allocate_all(s->context, slot_arrays(&d, s->row_count, s->entry_count)))
        return context_out_of_memory(s->context);
    sort_entries(s, &d);
    find_slots(s, &d);
    cscd_status status = front_tree_make(s->context, s->row_count, d.slots, d.slot_count, &s->tree);
    if (status == CSCD_OK) status = renew_targets(s, &d);
    context_free_all(s->context, slot_arrays(&d, s->row_count, s->entry_count));
    return status;
}

static bool renew_factors(block_system *s) {
    const size_t factors = s->tree.factor_size, updates = s->tree.update_size, rows = s->row_count;
    const size_t row_room = room_with_spare(rows);
    return context_renew_all(s->context, (array_list){{ARRAY(s->factors.factors, room_with_spare(factors))}},
                             &s->factor_capacity, factors) &&
           context_renew_all(s->context, (array_list){{ARRAY(s->factors.updates, room_with_spare(updates))}},
                             &s->update_capacity, updates) &&
           context_renew_all(
               s->context,
               (array_list){{ARRAY(s->factors.scratch, 3 * row_room), ARRAY(s->factors.locals, 2 * row_room),
                             ARRAY(s->ordered, 3 * row_room)}},
               &s->row_capacity, rows);
}

/* Writes the rows of a front's pivots, as the matrix has them. */
static void sum_entries(block_system *s, uint32_t number) {
    const matrix_front *front = &s->tree.fronts[number];
    double *rows = s->factors.factors + front->factor;
    memset(rows, 0, front->unit * front->pivot_count * front->stride * sizeof *rows);
    for (size_t k = s->target_begins[number]; k < s->target_begins[number + 1]; k++) {
        const block_target *target = &s->targets[k];
        const double *values = s->values + target->source / 2;
        double *to = s->factors.factors + target->place;
        if (target->source % 2 != 0) {
            for (size_t e = 0; e < (target->is_block ? 3 : 1); e++) to[e * target->stride + e] += values[0];
        } else if (target->is_transposed) {
            for (size_t e = 0; e < 9; e++) to[e % 3 * target->stride + e / 3] += values[e];
        } else {
            for (size_t e = 0; e < 9; e++) to[e / 3 * target->stride + e % 3] += values[e];
        }
    }
}

cscd_status block_system_factor(block_system *s) {
    const cscd_status status = pattern_is_kept(s) ? CSCD_OK : analyse_pattern(s);
    if (status != CSCD_OK) return status;
    if (!renew_factors(s)) return context_out_of_memory(s->context);
    front_factors_begin(&s->factors);
    for (uint32_t f = 0; f < s->tree.front_count; f++) {
        if (progress_cancelled(&s->context->progress)) return context_explain(s->context, CSCD_CANCELLED);
        sum_entries(s, f);
        front_factors_add(&s->factors, s->context, &s->tree, f);
    }
    s->replaced = s->factors.replaced;
    return CSCD_OK;
}

void block_system_solve(const block_system *s, double *x) {
    for (size_t i = 0; i < s->row_count; i++)
        memcpy(s->ordered + 3 * (size_t)s->tree.places[i], x + 3 * i, sizeof(double[3]));
    front_factors_solve(&s->factors, &s->tree, s->ordered);
    for (size_t i = 0; i < s->row_count; i++)
        memcpy(x + 3 * i, s->ordered + 3 * (size_t)s->tree.places[i], sizeof(double[3]));
}
