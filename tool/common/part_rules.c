/* Tables of pairs of parts, filled from the names of the command line. */
#include "tool/common/part_rules.h"

#include "tool/io/growable.h"
#include "tool/io/text_escape.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Tables are square, so that many parts are too many. */
enum { PARTS_MAX = 8192 };

static uint32_t row_of(const part_rules *rules, uint32_t part) {
    return part == NO_PART ? rules->size - 1 : part;
}

static void mark_pair(const part_rules *rules, unsigned char *table, uint32_t a, uint32_t b) {
    table[(size_t)a * rules->size + b] = table[(size_t)b * rules->size + a] = 1;
}

static unsigned char *make_table(const part_rules *rules) {
    return io_zeroed((size_t)rules->size * rules->size);
}

static bool fail_name(const part_names *parts, const char *option, const char *name, size_t length,
                      io_error *error) {
    char known[400] = "";
    size_t used = 0;
    for (uint32_t i = 0; i < parts->count && used + 48 < sizeof known; i++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%.*s", i > 0 ? ", " : "",
                                 TEXT_CUT(parts->names[i], 40));
    return io_fail(error, "%s: there is no part '%.*s'; the parts are %s%s", option, (int)length, name, known,
                   parts->count > 0 && used + 48 >= sizeof known ? ", ..." : "");
}

/* Marks the pairs of one text; chosen: two times size. */
static bool mark_text(const part_rules *rules, const char *option, const char *text, unsigned char *table,
                      bool *chosen, io_error *error) {
    const char *comma = strchr(text, ','), *names[2] = {text, comma != NULL ? comma + 1 : NULL};
    const size_t lengths[2] = {comma != NULL ? (size_t)(comma - text) : strlen(text),
                               comma != NULL ? strlen(comma + 1) : 0};
    bool *sides[2] = {chosen, chosen + rules->size};
    for (int i = 0; i < 2; i++) {
        memset(sides[i], names[i] == NULL, rules->size * sizeof *sides[i]);
        if (names[i] != NULL && part_names_choose(rules->parts, names[i], lengths[i], sides[i]) == 0)
            return fail_name(rules->parts, option, names[i], lengths[i], error);
    }
    for (uint32_t a = 0; a < rules->size; a++)
        for (uint32_t b = 0; b < rules->size; b++)
            if (sides[0][a] && sides[1][b]) mark_pair(rules, table, a, b);
    return true;
}

static bool mark_list(const part_rules *rules, const char *option, const part_pairs_list *list,
                      unsigned char **table, io_error *error) {
    if (list->count == 0) return true;
    bool *chosen = io_realloc(NULL, 2 * (size_t)rules->size * sizeof *chosen), marked = chosen != NULL;
    *table = make_table(rules);
    if (*table == NULL || chosen == NULL) marked = io_fail(error, "%s: out of memory", option);
    for (uint32_t i = 0; i < list->count && marked; i++)
        marked = mark_text(rules, option, list->items[i], *table, chosen, error);
    free(chosen);
    return marked;
}

bool part_rules_check_count(const part_names *parts, const char *options_take, io_error *error) {
    return parts->count <= PARTS_MAX ||
           io_fail(error, "%s at most %d parts, and there are %u", options_take, PARTS_MAX, parts->count);
}

bool part_rules_create(const part_names *parts, const part_pairs_list *ignored, const part_pairs_list *only,
                       part_rules *out, io_error *error) {
    part_rules rules = {.parts = parts, .size = parts->count + 1};
    if (ignored->count + only->count > 0 &&
        !part_rules_check_count(parts, "--ignore-parts and --only take", error))
        return false;
    if (!mark_list(&rules, "--ignore-parts", ignored, &rules.ignored, error) ||
        !mark_list(&rules, "--only", only, &rules.only, error)) {
        part_rules_free(&rules);
        return false;
    }
    *out = rules;
    return true;
}

void part_rules_free(part_rules *rules) {
    free(rules->ignored);
    free(rules->only);
    *rules = (part_rules){0};
}

bool part_rules_ignore(part_rules *rules, uint32_t a, uint32_t b) {
    if (rules->parts->count > PARTS_MAX) return false;
    if (rules->ignored == NULL) rules->ignored = make_table(rules);
    if (rules->ignored == NULL) return false;
    mark_pair(rules, rules->ignored, row_of(rules, a), row_of(rules, b));
    return true;
}

bool part_rules_any(const part_rules *rules) {
    return rules->ignored != NULL || rules->only != NULL;
}

static bool any_in_no_part(const part_names *parts, uint32_t triangle_count) {
    for (uint32_t t = 0; t < triangle_count; t++)
        if (parts->labels[t] == NO_PART) return true;
    return false;
}

void part_rules_count(const part_rules *rules, uint32_t triangle_count, size_t *left_out, size_t *all) {
    const uint32_t count = rules->parts->count + any_in_no_part(rules->parts, triangle_count);
    *left_out = 0;
    *all = (size_t)count * (count + 1) / 2;
    if (!part_rules_any(rules)) return;
    for (uint32_t a = 0; a < count; a++)
        for (uint32_t b = a; b < count; b++) {
            const size_t pair = (size_t)a * rules->size + b;
            *left_out += (rules->ignored != NULL && rules->ignored[pair]) ||
                         (rules->only != NULL && !rules->only[pair]);
        }
}

bool part_rules_leave_out(const part_rules *rules, const uint32_t *a, uint32_t a_count, const uint32_t *b,
                          uint32_t b_count) {
    bool wanted = rules->only == NULL;
    for (uint32_t i = 0; i < a_count; i++) {
        const size_t row = (size_t)row_of(rules, rules->parts->labels[a[i]]) * rules->size;
        for (uint32_t k = 0; k < b_count; k++) {
            const size_t pair = row + row_of(rules, rules->parts->labels[b[k]]);
            if (rules->ignored != NULL && rules->ignored[pair]) return true;
            wanted = wanted || rules->only[pair];
        }
    }
    return !wanted;
}
