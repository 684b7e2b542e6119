/* Which pieces of intersection curves go on in each other. */
#pragma once

#include "runtime/intersections/curve_piece.h"

/* An end of a piece, with a number for sorting. */
typedef struct curve_key {
    uint64_t number;
    uint64_t end; /* 2 piece + 0 or 1 */
} curve_key;

/* What an end is joined to, beside other ends. */
enum {
    LINK_TO_VERTEX = UINT32_MAX,
    LINK_TO_BORDER = UINT32_MAX - 1,
    LINK_TO_JUNCTION = UINT32_MAX - 2,
    LINK_TO_LEFT_OUT = UINT32_MAX - 3,
    LINKS_MAX = UINT32_MAX - 4
};

/* Fills links with the end, or one of the above, that each end is joined to, for ends 2 piece + 0 or 1. Two ends are joined
 * when they are at one event, and no third piece is there. keys and spare_keys have room for two keys per piece;
 * piece_count is at most LINKS_MAX / 2. */
void curve_links_find(const named_surface *s, const curve_piece *pieces, size_t piece_count, curve_key *keys,
                      curve_key *spare_keys, uint32_t *links);
