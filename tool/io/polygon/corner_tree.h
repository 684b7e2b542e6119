/* A tree over the corners of a polygon, some of which are active: finds an active one in a triangle. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* A stretch of the outline, and its box, which is turned as the stretch runs. */
typedef struct corner_node {
    double direction[2];    /* of the box's first side, about of length 1 */
    double low[2], high[2]; /* along the direction, and across it to the left */
    uint32_t first, end;    /* of its corners */
    uint32_t parent, child, active_count;
} corner_node;

typedef struct corner_tree {
    const double (*points)[2];
    uint32_t *node_of; /* the leaf of each point */
    bool *active;
    corner_node *nodes;
    uint32_t node_count;
    double slack; /* by more than twice of which no projection is wrong */
} corner_tree;

/* No point is active at first. On false memory ran out, and *out holds nothing to free. */
bool corner_tree_create(const double (*points)[2], uint32_t count, corner_tree *out);
void corner_tree_free(corner_tree *tree);

void corner_tree_set_active(corner_tree *tree, uint32_t point, bool active);

/* Finds an active point in the closed triangle, whose corners run counter-clockwise, that is not at the place of one of
 * them; UINT32_MAX if there is none. */
uint32_t corner_tree_find(const corner_tree *tree, const uint32_t triangle[3]);
