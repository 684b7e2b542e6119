/* A sorted set of pairs of features, or of triangles. */
#include "runtime/narrow_phase/named_pair_set.h"

#include "src/core/sort.h"

void named_pair_set_free(cscd_context *context, named_pair_set *set) {
    context_free(context, set->items);
    *set = (named_pair_set){.items = NULL};
}

bool named_pair_set_add(cscd_context *context, named_pair_set *set, cscd_contact_kind kind, uint32_t a,
                        uint32_t b) {
    if (set->count == set->capacity) {
        size_t capacity = 2 * set->capacity + 64;
        named_pair *grown = context_grow(context, set->items, set->count, capacity, sizeof *grown);
        if (grown == NULL) return false;
        set->items = grown;
        set->capacity = capacity;
    }
    set->items[set->count++] = (named_pair){(uint32_t)kind, a, b, 0};
    return true;
}

static int compare_pairs(const void *left, const void *right) {
    const named_pair *l = left, *r = right;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

static void count_triangle_pairs(named_pair_set *set) {
    set->triangle_pairs = 0;
    for (size_t i = 0; i < set->count; i++) set->triangle_pairs += set->items[i].kind == CSCD_CONTACT_TT;
}

bool named_pair_set_sort(cscd_context *context, named_pair_set *set) {
    size_t kept = 0;
    if (set->count > 1) {
        named_pair *scratch = context_allocate(context, set->count, sizeof *scratch);
        if (scratch == NULL) return false;
        sort_items(set->items, scratch, set->count, sizeof *scratch, compare_pairs);
        context_free(context, scratch);
    }
    for (size_t i = 0; i < set->count; i++) {
        if (i == 0 || compare_pairs(&set->items[i], &set->items[kept - 1]) != 0)
            set->items[kept++] = set->items[i];
    }
    set->count = kept;
    count_triangle_pairs(set);
    return true;
}

void named_pair_set_keep_marked(named_pair_set *set) {
    size_t kept = 0;
    for (size_t i = 0; i < set->count; i++) {
        if (set->items[i].marked == 0) continue;
        set->items[kept] = set->items[i];
        set->items[kept++].marked = 0;
    }
    set->count = kept;
    count_triangle_pairs(set);
}

named_pair *named_pair_set_find(const named_pair_set *set, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const named_pair wanted = {(uint32_t)kind, a, b, 0};
    size_t low = 0, high = set->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (compare_pairs(&set->items[middle], &wanted) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < set->count && compare_pairs(&set->items[low], &wanted) == 0 ? &set->items[low] : NULL;
}
