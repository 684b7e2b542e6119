/* Pairs of features that a search at rest has found near each other: named in order, and described eight at a time. */
#pragma once

#include "runtime/detector/contact_list.h"

/* The pairs in order of (kind, a, b): first VF, then EE, both by name, and then those of other kinds. Nearest points follow from
 * the positions; where a kernel has left a pair open, and for other kinds, there is a contact that knows them. */
typedef struct near_list {
    uint64_t *names; /* of VF and EE: a and b, so that they are in order as numbers are */
    size_t capacity;
    int bits;            /* of b */
    size_t count;        /* of all pairs; and of those with names: */
    size_t of_kind[2];   /* by cscd_contact_kind */
    result_buffer known; /* keys of contacts, without items */
    size_t known_count;
} near_list;

/* Takes what the workers have found, but for what the caller leaves out, in any order. The interval of the search may name pairs
 * (swept_interval) or not. Workers get room for their share of a next search like this one. LIST_TOO_LONG: there would be
 * out->count pairs, and there is a cap below that. */
cscd_status near_list_gather(search_space *s, const exclusions *e, near_list *out);

/* Puts them in order; spare has room for twice as many numbers as there are pairs. */
void near_list_sort(near_list *list, uint64_t *spare);

void near_list_free(cscd_context *context, near_list *list);

/* ---- pairs --------------------------------------------------------------------------------------------- */

/* Up to eight pairs of one kind, and their nearest points; those of other kinds than VF and EE are as in cscd_contact. */
typedef struct near_eight {
    cscd_contact_kind kind;
    uint32_t count, a[LANES], b[LANES];
    nearest_points_x8 at;
} near_eight;

/* Where the pairs are. */
typedef struct near_scene {
    const cscd_mesh *mesh;
    const double *positions;
    const near_list *list;
} near_scene;

cscd_contact_kind near_list_kind(const near_list *list, size_t pair);

/* Describes `count` pairs of the list, up to eight of one kind, by their places in it, which ascend. */
void near_list_describe(const near_scene *place, const size_t *pairs, uint32_t count, near_eight *out);

/* Describes the pairs from one on: as many of its kind as there are before `end`, up to eight. */
void near_list_describe_from(const near_scene *place, size_t pair, size_t end, near_eight *out);

/* Writes the features of a pair. */
void near_list_name(const near_list *list, size_t pair, uint32_t *a, uint32_t *b);
