/* Patterns of sparse matrices: which blocks the items of lists need. */
#include "runtime/energy/energy.h"

#include "src/core/sort.h"

#include <string.h>

/* ---- checks -------------------------------------------------------------------------------------------- */

static cscd_status check_row(cscd_context *context, const cscd_mesh *mesh, const cscd_energy_pattern *p,
                             uint32_t row) {
    size_t begin = p->rows[row], end = p->rows[row + 1];
    if (end < begin || end > p->block_count)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "row %u of the pattern goes from block %zu to %zu, of %zu", row, begin, end,
                            p->block_count);
    for (size_t i = begin; i < end; i++) {
        if (p->columns[i] < mesh->vertex_count && (i == begin || p->columns[i - 1] < p->columns[i])) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "row %u of the pattern has the column %u; expected ascending vertices below %u",
                            row, p->columns[i], mesh->vertex_count);
    }
    return CSCD_OK;
}

cscd_status energy_pattern_check(cscd_context *context, const cscd_mesh *mesh,
                                 const cscd_energy_pattern *pattern) {
    cscd_status status = CSCD_OK;
    if (pattern->rows == NULL || (pattern->columns == NULL && pattern->block_count > 0))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "the pattern's %s is NULL",
                            pattern->rows == NULL ? "rows" : "columns");
    if (pattern->block_count > SIZE_MAX / 9 / sizeof(double))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "a pattern of %zu blocks exceeds the memory",
                            pattern->block_count);
    if (pattern->rows[0] != 0 || pattern->rows[mesh->vertex_count] != pattern->block_count)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "the pattern's rows begin at block %zu and end at %zu, expected 0 and %zu",
                            pattern->rows[0], pattern->rows[mesh->vertex_count], pattern->block_count);
    for (uint32_t row = 0; row < mesh->vertex_count && status == CSCD_OK; row++)
        status = check_row(context, mesh, pattern, row);
    return status;
}

/* ---- making -------------------------------------------------------------------------------------------- */

void owned_pattern_free(cscd_context *context, owned_pattern *pattern) {
    context_free(context, pattern->rows);
    context_free(context, pattern->columns);
    context_free(context, pattern->keys);
    context_free(context, pattern->spare);
    *pattern = (owned_pattern){NULL};
}

static bool reserve_keys(cscd_context *context, owned_pattern *p, size_t count) {
    if (count <= p->key_capacity) return true;
    size_t room = room_with_spare(count);
    context_free(context, p->keys);
    context_free(context, p->spare);
    p->keys = context_reserve(context, room, sizeof *p->keys);
    p->spare = context_reserve(context, room, sizeof *p->spare);
    p->key_capacity = p->keys != NULL && p->spare != NULL ? room : 0;
    return p->key_capacity > 0;
}

static bool reserve_columns(cscd_context *context, owned_pattern *p, size_t count) {
    if (count <= p->capacity) return true;
    size_t room = room_with_spare(count);
    context_free(context, p->columns);
    p->columns = context_reserve(context, room, sizeof *p->columns);
    p->capacity = p->columns != NULL ? room : 0;
    return p->columns != NULL;
}

static uint64_t key_of_block(uint32_t row, uint32_t column) {
    return (uint64_t)row << 32 | column;
}

static size_t add_terms(const energy_terms *terms, uint64_t *keys) {
    size_t count = 0;
    for (size_t i = 0; i < terms->count; i++) {
        const uint32_t *v = energy_term_vertices(terms, i);
        int size = energy_term_size(terms, i);
        for (int r = 0; r < size; r++) {
            for (int c = 0; c < size; c++) {
                if (r != c) keys[count++] = key_of_block(v[r], v[c]);
            }
        }
    }
    return count;
}

static size_t add_others(const cscd_energy_pattern *others, uint32_t vertex_count, uint64_t *keys) {
    size_t count = 0;
    for (uint32_t v = 0; v < vertex_count; v++) {
        keys[count++] = key_of_block(v, v);
        for (size_t i = 0; others != NULL && i < others->rows[v + 1] - others->rows[v]; i++)
            keys[count++] = key_of_block(v, others->columns[others->rows[v] + i]);
    }
    return count;
}

static size_t drop_repeated(uint64_t *keys, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || keys[i] != keys[i - 1]) keys[kept++] = keys[i];
    }
    return kept;
}

static void write_rows(owned_pattern *p, uint32_t vertex_count, size_t count) {
    size_t i = 0;
    for (uint32_t v = 0; v < vertex_count; v++) {
        p->rows[v] = i;
        for (; i < count && p->keys[i] >> 32 == v; i++) p->columns[i] = (uint32_t)p->keys[i];
    }
    p->rows[vertex_count] = i;
}

/* The blocks of an item besides the diagonal. */
enum { BLOCKS_PER_TERM = 12 };

cscd_status owned_pattern_make(cscd_context *context, const cscd_mesh *mesh, const energy_terms lists[2],
                               const cscd_energy_pattern *others, owned_pattern *out) {
    size_t terms = lists[0].count + lists[1].count, given = others != NULL ? others->block_count : 0;
    size_t largest = SIZE_MAX / sizeof(uint64_t) / 4;
    if (terms > largest / BLOCKS_PER_TERM || given > largest || mesh->vertex_count > largest)
        return context_out_of_memory(context);
    if (!reserve_keys(context, out, BLOCKS_PER_TERM * terms + mesh->vertex_count + given))
        return context_out_of_memory(context);
    size_t count = add_others(others, mesh->vertex_count, out->keys);
    for (int i = 0; i < 2; i++) count += add_terms(&lists[i], out->keys + count);
    sort_by_number(out->keys, out->spare, count, sizeof *out->keys);
    count = drop_repeated(out->keys, count);
    if (out->rows == NULL)
        out->rows = context_reserve(context, (size_t)mesh->vertex_count + 1, sizeof *out->rows);
    if (out->rows == NULL || !reserve_columns(context, out, count)) return context_out_of_memory(context);
    write_rows(out, mesh->vertex_count, count);
    return CSCD_OK;
}
