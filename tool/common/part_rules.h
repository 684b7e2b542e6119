/* Which parts are looked at with each other: what --ignore-parts, --only and --ignore-rest=parts say. */
#pragma once

#include "tool/common/part_names.h"

enum { PART_RULES_MAX = 64 };

/* The texts A or A,B of an option that may be given several times: the pairs of A with B, or of A with everything. */
typedef struct part_pairs_list {
    const char *items[PART_RULES_MAX];
    uint32_t count;
} part_pairs_list;

typedef struct part_rules {
    const part_names *parts;
    uint32_t size;          /* parts, and one more for what is in no part */
    unsigned char *ignored; /* size * size: the pairs that are left out; NULL: none */
    unsigned char *only; /* size * size: the pairs that are looked at, all others are left out; NULL: all */
} part_rules;

/* parts outlive the rules. The error names a part that there is not, and those that there are. */
bool part_rules_create(const part_names *parts, const part_pairs_list *ignored, const part_pairs_list *only,
                       part_rules *out, io_error *error);
void part_rules_free(part_rules *rules);

/* Whether rules can be of so many parts. The sentence begins with the options, and "take" or "takes". */
bool part_rules_check_count(const part_names *parts, const char *options_take, io_error *error);

/* Leaves out the pairs of two parts, which may be NO_PART, from now on. False when there are too many parts, or when out of
 * memory. */
bool part_rules_ignore(part_rules *rules, uint32_t a, uint32_t b);

/* Are two sets of triangles, each that of a feature, left out? They are if one of the first and one of the second form a
 * pair that is ignored, or if none form a pair that is to be looked at. */
bool part_rules_leave_out(const part_rules *rules, const uint32_t *a, uint32_t a_count, const uint32_t *b,
                          uint32_t b_count);

/* How many pairs of parts are left out of how many, each with itself among them. What is in no part of a mesh of so many triangles
 * counts as one. */
void part_rules_count(const part_rules *rules, uint32_t triangle_count, size_t *left_out, size_t *all);

/* Is any pair left out? */
bool part_rules_any(const part_rules *rules);
