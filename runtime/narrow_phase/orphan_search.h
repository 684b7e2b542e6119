/* The search for orphan pairs, and what is known while it goes on. */
#pragma once

#include "runtime/narrow_phase/orphan_pairs.h"

#include <stdatomic.h>

typedef struct growing_list {
    uint32_t (*items)[2];
    size_t count, capacity;
} growing_list;

typedef struct orphan_search {
    const cscd_mesh *mesh;
    growing_list vf, ee;
    size_t most;
    atomic_size_t
        *grown; /* what the lists of all that share a search held whenever one grew, added up: at most twice
                           * what they hold now; NULL: nobody shares it */
    size_t looks, noted,
        looks_most;           /* triangles and stars that were looked at; how many *all_looks knows of */
    atomic_size_t *all_looks; /* of all that share the search; NULL: nobody shares it */
    bool out_of_memory;
    uint8_t *features;        /* per triangle, as orphan_search_features says; or NULL */
    uint32_t (*opposites)[2]; /* per edge: the corners opposite it; or NULL */
    bool *even;               /* per edge: orphan_edges.c finds its pairs with others of these; or NULL */

    /* In a mesh that was made from another one: pairs of features that are what they were are known. */
    const cscd_mesh_change *change; /* NULL: nothing is known */
    uint8_t *marks;                 /* per vertex, of objects that have changed */
} orphan_search;

/* Where a vertex has very many triangles, looking takes the square of their number, whatever is found. Then it is given up as
 * well: steps test pairs of adjacent triangles instead, of which the traversal leaves out most there. An ordinary mesh takes
 * some twenty looks for each triangle. */
enum { ORPHANS_PER_TRIANGLE = 8, LOOKS_PER_TRIANGLE = 256 };

/* In the place of an opposite corner: an edge of one triangle has no second one, and an edge of more than two has many. */
enum { NO_CORNER = UINT32_MAX, MANY_CORNERS = UINT32_MAX - 1 };

/* Does every triangle at vertex v share a vertex with triangle t? */
bool orphan_search_says_vertex(const cscd_mesh *mesh, uint32_t v, uint32_t t);

/* Is every triangle at edge a adjacent to every triangle at edge b, which shares no vertex with a? */
bool orphan_search_says(const orphan_search *f, uint32_t a, uint32_t b);

void orphan_search_add(orphan_search *f, growing_list *list, uint32_t a, uint32_t b);

/* Counts looks at so many triangles. */
void orphan_search_look(orphan_search *f, size_t triangles);

/* There are too many, it takes too long, memory has run out, or the call is cancelled. */
bool orphan_search_has_enough(const orphan_search *f);

/* The features whose stars begin with a triangle: bit i for its vertex i, bit 3 + i for its edge i. */
uint32_t orphan_search_features(const cscd_mesh *mesh, uint32_t t);

/* Writes the corners opposite an edge: NO_CORNER in the second place for an edge of one triangle, MANY_CORNERS for one of more
 * than two. */
void orphan_search_opposites(const cscd_mesh *mesh, uint32_t edge, uint32_t out[2]);

/* Looks at the pairs of one triangle with those adjacent to it. */
void orphan_search_around(orphan_search *f, uint32_t t);
