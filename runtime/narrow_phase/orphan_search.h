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
    bool out_of_memory;
    uint8_t *features;        /* per triangle, as orphan_search_features says; or NULL */
    uint32_t (*opposites)[2]; /* per edge: the corners opposite it; or NULL */
    bool *even;               /* per edge: orphan_edges.c finds its pairs with others of these; or NULL */

    /* In a mesh that was made from another one: pairs of features that are what they were are known. */
    const cscd_mesh_change *change; /* NULL: nothing is known */
    uint8_t *marks;                 /* per vertex, of objects that have changed */
} orphan_search;

enum { ORPHANS_PER_TRIANGLE = 8 };

/* In the place of an opposite corner: an edge of one triangle has no second one, and an edge of more than two has many. */
enum { NO_CORNER = UINT32_MAX, MANY_CORNERS = UINT32_MAX - 1 };

/* Does every triangle at vertex v share a vertex with triangle t? */
bool orphan_search_says_vertex(const cscd_mesh *mesh, uint32_t v, uint32_t t);

/* Is every triangle at edge a adjacent to every triangle at edge b, which shares no vertex with a? */
bool orphan_search_says(const orphan_search *f, uint32_t a, uint32_t b);

void orphan_search_add(orphan_search *f, growing_list *list, uint32_t a, uint32_t b);

/* There are too many, or memory has run out. */
bool orphan_search_has_enough(const orphan_search *f);

/* The features whose stars begin with a triangle: bit i for its vertex i, bit 3 + i for its edge i. */
uint32_t orphan_search_features(const cscd_mesh *mesh, uint32_t t);

/* Writes the corners opposite an edge: NO_CORNER in the second place for an edge of one triangle, MANY_CORNERS for one of more
 * than two. */
void orphan_search_opposites(const cscd_mesh *mesh, uint32_t edge, uint32_t out[2]);

/* Looks at the pairs of one triangle with those adjacent to it. */
void orphan_search_around(orphan_search *f, uint32_t t);
