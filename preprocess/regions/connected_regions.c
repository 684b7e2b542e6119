/* Makes the regions of a labelling connected. */
#include "preprocess/regions/labelling.h"

#include <string.h>

enum { NO_PIECE = UINT32_MAX };

/* The share of the component's area from which on a piece is large. */
static const double large_share = 0.01;

/* A connected piece of a region: its tiles are nodes[begin .. end). */
typedef struct region_piece {
    uint32_t begin, end;
    double area;
} region_piece;

static region_piece flood_piece(tile_labelling *l, uint32_t first, uint32_t begin) {
    const tile_graph *g = l->g;
    region_piece piece = {begin, begin, 0.0};
    l->nodes[piece.end++] = first;
    l->pieces[first] = begin;
    for (uint32_t next = begin; next < piece.end; next++) {
        const uint32_t t = l->nodes[next];
        piece.area += g->items[t].area;
        for (uint32_t j = g->offsets[t]; j < g->offsets[t + 1]; j++) {
            const uint32_t other = g->neighbours[j];
            if (l->pieces[other] != NO_PIECE || l->of_tile[other] != l->of_tile[t]) continue;
            l->pieces[other] = begin;
            l->nodes[piece.end++] = other;
        }
    }
    return piece;
}

/* Finds the largest of the pieces that are not their region's largest; its end is 0 if there is none. */
static region_piece find_odd_piece(tile_labelling *l) {
    region_piece largest[REGIONS_MOST] = {{0, 0, 0.0}}, odd = {0, 0, -1.0};
    memset(l->pieces, 0xff, l->g->count * sizeof *l->pieces);
    for (uint32_t t = 0, end = 0; t < l->g->count; t++) {
        if (l->pieces[t] != NO_PIECE) continue;
        region_piece piece = flood_piece(l, t, end), *most = &largest[l->of_tile[t]];
        end = piece.end;
        if (most->end == 0 || piece.area > most->area) {
            const region_piece held = *most;
            *most = piece;
            piece = held;
        }
        if (piece.end > 0 && piece.area > odd.area) odd = piece;
    }
    return odd;
}

/* The region with the longest border to the piece. There is one, since a component is connected. */
static uint32_t longest_border(const tile_labelling *l, const region_piece *piece) {
    double borders[REGIONS_MOST] = {0.0};
    const uint32_t own = l->of_tile[l->nodes[piece->begin]];
    uint32_t best = own;
    for (uint32_t i = piece->begin; i < piece->end; i++) {
        const uint32_t t = l->nodes[i];
        for (uint32_t j = l->g->offsets[t]; j < l->g->offsets[t + 1]; j++) {
            const uint32_t other = l->of_tile[l->g->neighbours[j]];
            if (other == own) continue;
            borders[other] += l->g->weights[j];
            if (best == own || borders[other] > borders[best]) best = other;
        }
    }
    return best;
}

void labelling_connect(tile_labelling *l) {
    for (region_piece odd; odd = find_odd_piece(l), odd.end > 0;) {
        uint32_t region = l->regions.count;
        if (odd.area < large_share * l->g->area || region == REGIONS_MOST) {
            region = longest_border(l, &odd);
        } else {
            const tile_set set = {l->g, l->nodes + odd.begin, odd.end - odd.begin};
            sight_point middle;
            tiles_centroid(&set, &middle);
            labelling_add(l, &middle, tiles_nearest(&set, middle.rest));
        }
        labelling_give(l, l->nodes + odd.begin, odd.end - odd.begin, region);
    }
}
