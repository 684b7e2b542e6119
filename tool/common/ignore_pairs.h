/* Pairs that the user wants left out: pairs of triangles that intersect or touch in the first frame, those of
 * a list file, and pairs of parts. */
#pragma once

#include "tool/common/part_names.h"

enum { PART_RULES_MAX = 64 };

/* The texts A or A,B of an option that may be given several times: the pairs of A with B, or of A with
 * everything. */
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

/* Leaves out the pairs of two parts, which may be NO_PART, from now on. False when there are too many parts,
 * or when out of memory. */
bool part_rules_ignore(part_rules *rules, uint32_t a, uint32_t b);

typedef struct ignore_options {
    const char *path;       /* of a list file; NULL: none */
    const char *parts_path; /* of a table of parts; NULL: those that the recording names */
    enum {
        REST_KEPT,
        REST_PAIRS, /* pairs of triangles that intersect or touch in the first frame are left out */
        REST_PARTS  /* pairs of parts that do; within a part the pairs of triangles */
    } rest;
    part_pairs_list ignored, only; /* pairs of parts */
} ignore_options;

/* True if the options leave out anything. */
bool ignore_options_any(const ignore_options *options);

/* Two triangles, or two components. */
typedef struct ignored_pair {
    uint32_t a, b;
} ignored_pair;

typedef struct ignore_pairs {
    const cscd_mesh *mesh;
    part_names parts;
    part_rules rules;
    size_t rest_pairs;       /* of triangles that intersect or touch in the first frame, if that was asked */
    ignored_pair *triangles; /* sorted by (a, b) */
    size_t triangle_count, triangle_capacity;
    ignored_pair *components; /* a <= b; few; sorted */
    size_t component_count, component_capacity;
    ignored_pair *separated; /* a < b: different components of which pairs of triangles are left out */
    size_t separated_count, separated_capacity;
} ignore_pairs;

/* Finds the parts of a recording, and what is left out of it. On false *out holds nothing to free.
 *
 * Each line of a list file is `A B` (two triangles), `components A B` (all pairs between two components, or
 * within one), blank, or a comment from # on. Triangles are numbered from 0 in the order of the model file, a polygon
 * counting as many as it is cut into; with several objects they are `NAME:A`, of the first one `A` as well. Components
 * are numbered as `cscd info` lists them. */
bool ignore_pairs_prepare(const ignore_options *options, recording *r, ignore_pairs *out, io_error *error);

/* The same of a mesh without files, from which nothing is left out yet. Takes the parts. *out stays where it
 * is, since its rules point to its parts. */
bool ignore_pairs_of(const cscd_mesh *mesh, part_names *parts, ignore_pairs *out, io_error *error);

/* Leaves out pairs that intersect or touch at rest; by_parts: all pairs of the two parts, unless both
 * triangles are in one. False when there are too many parts for that, or when out of memory. */
bool ignore_pairs_add_rest(ignore_pairs *pairs, const cscd_intersections *found, bool by_parts);

/* Makes a detector leave out the pairs, which live until it has been destroyed. */
void ignore_pairs_choose(ignore_pairs *pairs, cscd_detector_options *options);

/* True if anything is left out. */
bool ignore_pairs_any(const ignore_pairs *pairs);

/* Numbers of different pairs of parts, of components, and of triangles that are left out. A part with itself
 * is a pair, too. */
typedef struct ignore_counts {
    size_t parts, all_parts; /* left out, and in all */
    size_t components, triangles;
} ignore_counts;

ignore_counts ignore_pairs_count(const ignore_pairs *pairs);

/* True if it is left out that a vertex, an edge or a triangle is inside of what has the other triangle: if
 * contacts of the two are, or if the components differ and any pair of their triangles is left out. */
bool ignore_pairs_separate_vertex(const ignore_pairs *pairs, uint32_t vertex, uint32_t triangle);
bool ignore_pairs_separate_edge(const ignore_pairs *pairs, uint32_t edge, uint32_t triangle);
bool ignore_pairs_separate_triangles(const ignore_pairs *pairs, uint32_t a, uint32_t b);

void ignore_pairs_free(ignore_pairs *pairs);
