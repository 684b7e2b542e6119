/* The regions of one body: labellings of its tiles, of all of them one of low cost, by expansion moves (Boykov, Veksler, Zabih
 * 2001). */
#pragma once

#include "preprocess/regions/tiles.h"

enum { REGIONS_MOST = 64 };

/* A labelling costs, in shares of the component's area: what is not seen, + region for each region, + border times the weight of
 * the borders over the root of the area. */
typedef struct labelling_prices {
    double region, border;
} labelling_prices;

/* The regions, each with its point, and with its seat: the tile from which ways through soft material begin. Times count changes: of
 * the region's tiles, of its point, and when it was last looked at. */
typedef struct labelled_regions {
    uint32_t count;
    sight_point points[REGIONS_MOST];
    uint32_t seats[REGIONS_MOST];
    uint32_t changed[REGIONS_MOST], moved[REGIONS_MOST], expanded[REGIONS_MOST], now;
} labelled_regions;

typedef struct tile_labelling {
    const tile_graph *g;
    labelling_prices prices;
    uint32_t *of_tile;
    labelled_regions regions;
    uint32_t *nodes, *pieces; /* room for tiles */
    min_cut cut;
    soft_paths paths; /* a row for each region, that of its seat, and one more, for trials */
} tile_labelling;

/* All tiles are in one region. */
cscd_status labelling_create(const tile_graph *g, const labelling_prices *prices, tile_labelling *out);
void labelling_destroy(tile_labelling *l);

/* Returns the blindness of a region's point for a tile. */
static inline double labelling_blindness(const tile_labelling *l, uint32_t t, uint32_t region) {
    return soft_paths_blindness(&l->paths, region, t, tile_blindness(l->g, t, &l->regions.points[region]));
}

double labelling_cost(const tile_labelling *l);

/* The tiles of a region, or of two; valid until the next call. */
tile_set labelling_tiles(tile_labelling *l, uint32_t a, uint32_t b);

/* Returns the cost of the border of two regions; -1: they have none. */
double labelling_border(const tile_labelling *l, uint32_t a, uint32_t b);

/* Adds a region with a point and a seat, which has no tiles yet. */
void labelling_add(tile_labelling *l, const sight_point *point, uint32_t seat);

/* The seat of a region that has tiles becomes the one that is nearest to its point. */
void labelling_seat(tile_labelling *l, uint32_t region);

/* The regions become what they were before; of_tile is the caller's to set. */
void labelling_take_back(tile_labelling *l, const labelled_regions *before);

/* All regions count as changed, and get seats: the tiles are others than before. */
void labelling_touch(tile_labelling *l);

/* Gives tiles to a region. */
void labelling_give(tile_labelling *l, const uint32_t *tiles, uint32_t count, uint32_t region);

/* Gives tiles to other regions for as long as that costs less. Regions that become empty are left out. */
void labelling_share_out(tile_labelling *l);

/* Moves the points of regions whose tiles have changed. */
void labelling_move_points(tile_labelling *l);

/* Makes regions connected: a large piece becomes a region, with its centroid for a point, and a small one joins the neighbour with
 * the longest border. */
void labelling_connect(tile_labelling *l);

/* Region b becomes a part of a, and the last region takes its number. */
void labelling_join(tile_labelling *l, uint32_t a, uint32_t b);

/* Each tile of the region goes to the point among the others that sees it best, and the last region takes its number. */
void labelling_leave_out(tile_labelling *l, uint32_t region);

/* ---- bodies -------------------------------------------------------------------------------------------- */

/* Regions so far: of each triangle, and their detector points. */
typedef struct body_regions {
    uint32_t *of_triangle; /* room for each triangle of the mesh */
    uint32_t count, capacity;
    double (*points)[3];
} body_regions;

/* Room for each triangle of the mesh. */
typedef struct body_room {
    uint32_t *tile_of, *scratch;
    bool *marked;
} body_room;

/* Adds the regions of a component, whose triangles are listed, ascending. Each of them is connected. */
cscd_status body_regions_add(body_regions *regions, const tile_surface *surface, const uint32_t *list,
                             uint32_t count, const body_room *room);

/* Adds a component as one region. */
cscd_status body_regions_add_whole(body_regions *regions, const tile_surface *surface, const uint32_t *list,
                                   uint32_t count);
