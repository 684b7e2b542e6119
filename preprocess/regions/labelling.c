/* Shares tiles out among regions, by minimum cuts, and makes regions connected. */
#include "preprocess/regions/labelling.h"

#include <string.h>

static array_list list_arrays(tile_labelling *l) {
    const size_t n = l->g->count;
    return (array_list){{ARRAY(l->of_tile, n), ARRAY(l->nodes, n), ARRAY(l->pieces, n)}};
}

cscd_status labelling_create(const tile_graph *g, const labelling_prices *prices, tile_labelling *out) {
    *out = (tile_labelling){.g = g, .prices = *prices, .regions.count = 1};
    cscd_status status = min_cut_create(g->context, &g->flow, &out->cut);
    if (status == CSCD_OK) status = soft_paths_create(g, REGIONS_MOST + 1, &out->paths);
    if (status == CSCD_OK && !context_allocate_all(g->context, list_arrays(out)))
        status = context_out_of_memory(g->context);
    if (status != CSCD_OK) labelling_destroy(out);
    return status;
}

void labelling_destroy(tile_labelling *l) {
    if (l->g == NULL) return;
    context_free_all(l->g->context, list_arrays(l));
    soft_paths_destroy(&l->paths);
    min_cut_destroy(&l->cut);
    *l = (tile_labelling){0};
}

tile_set labelling_tiles(tile_labelling *l, uint32_t a, uint32_t b) {
    tile_set set = {l->g, l->nodes, 0};
    for (uint32_t t = 0; t < l->g->count; t++)
        if (l->of_tile[t] == a || l->of_tile[t] == b) l->nodes[set.count++] = t;
    return set;
}

/* ---- costs --------------------------------------------------------------------------------------------- */

/* If two points see a tile equally well, the nearer one takes it: the price of a square distance. */
static const double distance_price = 0.01;

static double tile_cost(const tile_labelling *l, uint32_t t, uint32_t region) {
    const tile *item = &l->g->items[t];
    const sight_point *point = &l->regions.points[region];
    double square = 0.0;
    for (int k = 0; k < 3; k++)
        square += (item->centroid[k] - point->rest[k]) * (item->centroid[k] - point->rest[k]);
    return item->area * (labelling_blindness(l, t, region) + distance_price * square);
}

static double link_cost(const tile_labelling *l, uint32_t link) {
    return l->prices.border * l->g->weights[link] * sqrt(l->g->area);
}

double labelling_border(const tile_labelling *l, uint32_t a, uint32_t b) {
    double sum = 0.0;
    bool any = false;
    for (uint32_t t = 0; t < l->g->count; t++) {
        if (l->of_tile[t] != a) continue;
        for (uint32_t j = l->g->offsets[t]; j < l->g->offsets[t + 1]; j++) {
            if (l->of_tile[l->g->neighbours[j]] != b) continue;
            any = true;
            sum += link_cost(l, j);
        }
    }
    return any ? sum : -1.0;
}

double labelling_cost(const tile_labelling *l) {
    double sum = l->prices.region * l->g->area * l->regions.count;
    for (uint32_t t = 0; t < l->g->count; t++) {
        sum += tile_cost(l, t, l->of_tile[t]);
        for (uint32_t j = l->g->offsets[t]; j < l->g->offsets[t + 1]; j++)
            if (t < l->g->neighbours[j] && l->of_tile[t] != l->of_tile[l->g->neighbours[j]])
                sum += link_cost(l, j);
    }
    return sum;
}

/* ---- numbers of regions -------------------------------------------------------------------------------- */

static void note_change(tile_labelling *l, uint32_t region) {
    l->regions.changed[region] = ++l->regions.now;
}

static void give_tile(tile_labelling *l, uint32_t t, uint32_t region) {
    note_change(l, l->of_tile[t]);
    note_change(l, region);
    l->of_tile[t] = region;
}

void labelling_touch(tile_labelling *l) {
    for (uint32_t r = 0; r < l->regions.count; r++) {
        note_change(l, r);
        labelling_seat(l, r);
    }
}

void labelling_give(tile_labelling *l, const uint32_t *tiles, uint32_t count, uint32_t region) {
    for (uint32_t i = 0; i < count; i++) give_tile(l, tiles[i], region);
}

static void place_seat(tile_labelling *l, uint32_t region, uint32_t seat) {
    l->regions.seats[region] = seat;
    soft_paths_set(&l->paths, region, seat);
}

void labelling_seat(tile_labelling *l, uint32_t region) {
    if (l->paths.rows == NULL) return;
    const tile_set set = labelling_tiles(l, region, region);
    if (set.count > 0) place_seat(l, region, tiles_nearest(&set, l->regions.points[region].rest));
}

void labelling_take_back(tile_labelling *l, const labelled_regions *before) {
    l->regions = *before;
    for (uint32_t r = 0; r < l->regions.count; r++) place_seat(l, r, l->regions.seats[r]);
}

void labelling_add(tile_labelling *l, const sight_point *point, uint32_t seat) {
    labelled_regions *r = &l->regions;
    r->points[r->count] = *point;
    place_seat(l, r->count, seat);
    r->moved[r->count] = r->expanded[r->count] = 0;
    note_change(l, r->count++);
}

/* The last region takes the number of one that has no tiles any more. */
static void take_number(tile_labelling *l, uint32_t number) {
    labelled_regions *r = &l->regions;
    const uint32_t last = --r->count;
    for (uint32_t t = 0; t < l->g->count && number != last; t++)
        if (l->of_tile[t] == last) l->of_tile[t] = number;
    r->points[number] = r->points[last];
    place_seat(l, number, r->seats[last]);
    r->changed[number] = r->changed[last];
    r->moved[number] = r->moved[last];
    r->expanded[number] = r->expanded[last];
}

void labelling_join(tile_labelling *l, uint32_t a, uint32_t b) {
    for (uint32_t t = 0; t < l->g->count; t++)
        if (l->of_tile[t] == b) give_tile(l, t, a);
    take_number(l, b);
}

void labelling_leave_out(tile_labelling *l, uint32_t region) {
    for (uint32_t t = 0; t < l->g->count; t++) {
        if (l->of_tile[t] != region) continue;
        uint32_t best = region == 0 ? 1 : 0;
        for (uint32_t r = best + 1; r < l->regions.count; r++)
            if (r != region && tile_cost(l, t, r) < tile_cost(l, t, best)) best = r;
        give_tile(l, t, best);
    }
    take_number(l, region);
}

/* ---- expansion moves ----------------------------------------------------------------------------------- */

/* Costs become integers: 2^40 is the component's area. Twice that is never worth its cost, for instance the
 * borders of a body that is long compared to the root of its area. So higher costs count as that, and no sum
 * of them overflows. */
static int64_t whole_cost(const tile_labelling *l, double cost) {
    return (int64_t)(fmin(cost / l->g->area, 2.0) * 0x1p40);
}

/* A tile that keeps its region pays its supply, and one that changes its drain: those that stay with the supplies change. */
static void add_cost(tile_labelling *l, uint32_t t, int64_t keeping, int64_t changing) {
    l->cut.supplies[t] += keeping > changing ? keeping - changing : 0;
    l->cut.drains[t] += changing > keeping ? changing - keeping : 0;
}

/* Two tiles of different regions pay for their border unless both change: the first if it keeps its region, and else the link from it
 * to the second (Kolmogorov, Zabih 2004). */
static void set_links(tile_labelling *l, uint32_t t, uint32_t region, uint64_t beside) {
    for (uint32_t j = l->g->offsets[t]; j < l->g->offsets[t + 1]; j++) {
        const uint32_t other = l->g->neighbours[j], its = l->of_tile[other];
        l->cut.residuals[j] = 0;
        if ((beside >> its & 1) == 0) continue; /* the border stays, whatever the tile does */
        const bool pays = its == region || (its != l->of_tile[t] && t < other);
        const int64_t cost = whole_cost(l, link_cost(l, j));
        l->cut.residuals[j] = its != region && (its == l->of_tile[t] || t < other) ? cost : 0;
        if (pays) add_cost(l, t, cost, 0);
    }
}

/* Returns the number of tiles that may change, those of the neighbouring regions; they are the first nodes.
 * *keeping is their cost if none changes. */
static uint32_t prepare_move(tile_labelling *l, uint32_t region, uint64_t beside, int64_t *keeping) {
    uint32_t count = 0;
    for (uint32_t t = 0; t < l->g->count; t++) {
        if (l->of_tile[t] == region || (beside >> l->of_tile[t] & 1) == 0) continue;
        l->nodes[count++] = t;
        l->cut.supplies[t] = l->cut.drains[t] = 0;
        add_cost(l, t, whole_cost(l, tile_cost(l, t, l->of_tile[t])), whole_cost(l, tile_cost(l, t, region)));
    }
    *keeping = 0;
    for (uint32_t i = 0; i < count; i++) {
        set_links(l, l->nodes[i], region, beside);
        *keeping += l->cut.supplies[l->nodes[i]];
    }
    return count;
}

static bool expand_region(tile_labelling *l, uint32_t region, uint64_t beside) {
    int64_t keeping;
    const uint32_t count = prepare_move(l, region, beside, &keeping),
                   changing = min_cut_run(&l->cut, l->nodes, count);
    l->regions.expanded[region] = ++l->regions.now;
    if (l->cut.cost >= keeping) return false;
    labelling_give(l, l->cut.queue, changing, region);
    l->regions.expanded[region] = l->regions.now;
    return true;
}

/* One bit for each region that a region has a border with, and for itself; all bits where it has no tiles. */
static void find_neighbours(const tile_labelling *l, uint64_t neighbours[REGIONS_MOST]) {
    memset(neighbours, 0, REGIONS_MOST * sizeof *neighbours);
    for (uint32_t t = 0; t < l->g->count; t++) {
        uint64_t *beside = &neighbours[l->of_tile[t]];
        *beside |= (uint64_t)1 << l->of_tile[t];
        for (uint32_t j = l->g->offsets[t]; j < l->g->offsets[t + 1]; j++)
            *beside |= (uint64_t)1 << l->of_tile[l->g->neighbours[j]];
    }
    for (uint32_t r = 0; r < REGIONS_MOST; r++)
        if (neighbours[r] == 0) neighbours[r] = UINT64_MAX;
}

/* Returns whether nothing has changed in the region and its neighbours since it was last expanded. */
static bool is_settled(const tile_labelling *l, uint32_t region, uint64_t neighbours) {
    for (uint32_t r = 0; r < l->regions.count; r++)
        if (neighbours >> r & 1 && l->regions.changed[r] > l->regions.expanded[region]) return false;
    return l->regions.expanded[region] > 0;
}

static void leave_out_empty(tile_labelling *l) {
    uint32_t sizes[REGIONS_MOST] = {0};
    for (uint32_t t = 0; t < l->g->count; t++) sizes[l->of_tile[t]]++;
    for (uint32_t r = l->regions.count; r-- > 0;)
        if (sizes[r] == 0) take_number(l, r);
}

void labelling_share_out(tile_labelling *l) {
    enum { ROUNDS_MOST = 4 };
    uint64_t neighbours[REGIONS_MOST];
    bool changed = true;
    for (int round = 0; round < ROUNDS_MOST && changed; round++) {
        changed = false;
        find_neighbours(l, neighbours);
        for (uint32_t r = 0; r < l->regions.count; r++)
            if (!is_settled(l, r, neighbours[r])) changed |= expand_region(l, r, neighbours[r]);
    }
    leave_out_empty(l);
}

void labelling_move_points(tile_labelling *l) {
    for (uint32_t r = 0; r < l->regions.count; r++) {
        sight_point *point = &l->regions.points[r], middle;
        if (l->regions.moved[r] >= l->regions.changed[r] && l->regions.moved[r] > 0) continue;
        const tile_set set = labelling_tiles(l, r, r);
        tiles_centroid(&set, &middle);
        const double from_middle = tiles_best_point(&set, &middle), from_here = tiles_best_point(&set, point);
        if (from_middle <= from_here) *point = middle;
        labelling_seat(l, r);
        note_change(l, r);
        l->regions.moved[r] = l->regions.now;
    }
}

/* ---- connected regions --------------------------------------------------------------------------------- */

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
