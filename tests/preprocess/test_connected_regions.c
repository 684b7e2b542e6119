/* The regions of labellings become connected: odd pieces find a region, and that comes to an end. */
#include "tests/support/preprocess/tiled_body.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

/* Connecting a thousand tiles takes some hundred changes. */
enum { CHANGES_MOST = 1000000 };

#if !defined(_WIN32) && !defined(__EMSCRIPTEN__)
static const tile_labelling *watched;

static void count_changes(int number) {
    static const char text[] = "labelling_connect gives tiles to and fro without end\n";
    (void)number;
    if (watched->regions.now < CHANGES_MOST) return;
    if (write(STDERR_FILENO, text, sizeof text - 1) < 0) _exit(EXIT_FAILURE);
    _exit(EXIT_FAILURE);
}

/* Looks at the count of changes ten times a second, or no more: what would hang fails. */
static void watch_changes(const tile_labelling *l) {
    const struct timeval often = {0, l != NULL ? 100000 : 0};
    const struct itimerval timer = {often, often};
    watched = l;
    signal(SIGALRM, count_changes);
    assert_int_equal(setitimer(ITIMER_REAL, &timer, NULL), 0);
}
#else
static void watch_changes(const tile_labelling *l) {
    (void)l;
}
#endif

static void connect_watched(tile_labelling *l) {
    watch_changes(l);
    labelling_connect(l);
    watch_changes(NULL);
    assert_true(l->regions.now < CHANGES_MOST);
}

/* Returns the number of pieces of all regions, and of each. */
static uint32_t count_pieces(const tiled_body *b, const tile_labelling *l,
                             uint32_t region_pieces[REGIONS_MOST]) {
    uint32_t *pieces = body_allocate(b->tile_count, sizeof *pieces);
    memset(region_pieces, 0, REGIONS_MOST * sizeof *region_pieces);
    const uint32_t count =
        dual_graph_pieces(&b->graph, b->list, b->tile_count, l->of_tile, pieces, b->scratch);
    for (uint32_t i = 0, seen = 0; i < b->tile_count; i++)
        if (pieces[i] == seen) region_pieces[l->of_tile[i]]++, seen++;
    free(pieces);
    return count;
}

TEST(regions_become_connected) {
    random_seed(4);
    for (int round = 0; round < 10; round++) {
        const labelling_prices prices = {0.01, 0.01};
        tiled_body *b = tiled_body_make(BODY_FIGURE, 1000);
        tile_labelling l;
        uint32_t region_pieces[REGIONS_MOST];
        expect_ok(labelling_create(&b->g, &prices, &l));
        for (int i = 0; i < 3; i++) labelling_add(&l, &(sight_point){.rest = {0.0, 0.0, 0.1 * i}}, 0);
        for (uint32_t t = 0; t < b->tile_count; t++) { /* stripes, so that each region has several pieces */
            const double *p = b->g.items[t].centroid;
            const uint32_t region = (uint32_t)(40.0 * (p[0] + 0.3 * round * p[2] + 2.0)) % 4;
            labelling_give(&l, &t, 1, region);
        }
        connect_watched(&l);
        assert_int_equal(count_pieces(b, &l, region_pieces), l.regions.count);
        for (uint32_t r = 0; r < l.regions.count; r++) assert_int_equal(region_pieces[r], 1);
        labelling_destroy(&l);
        tiled_body_free(b);
    }
}

/* A torus in four regions, and a patch of it that belongs to the region on the other side. */
typedef struct patched {
    tile_labelling l;
    uint32_t patch[1000], patch_count, own;
    double borders[4]; /* with each region */
} patched;

static uint32_t quarter_of(const tile *t) {
    return (t->centroid[0] > 0.0 ? 1u : 0u) ^ (t->centroid[1] > 0.0 ? 3u : 0u); /* 0 to 3 around */
}

/* Tiles around a random one. */
static void grow_patch(const tile_graph *g, uint32_t count, patched *p) {
    p->patch[0] = (uint32_t)random_integer(0, (int)g->count - 1);
    p->patch_count = 1;
    for (uint32_t next = 0; next < p->patch_count; next++) {
        for (uint32_t j = g->offsets[p->patch[next]]; j < g->offsets[p->patch[next] + 1]; j++) {
            bool known = false;
            for (uint32_t i = 0; i < p->patch_count; i++) known |= p->patch[i] == g->neighbours[j];
            if (!known && p->patch_count < count) p->patch[p->patch_count++] = g->neighbours[j];
        }
    }
}

/* False: the patch is beside the region on the other side, or the regions without it are not connected. */
static bool make_patched(const tiled_body *b, uint32_t count, patched *p) {
    const labelling_prices prices = {0.01, 0.01};
    const tile_graph *g = &b->g;
    uint32_t region_pieces[REGIONS_MOST];
    expect_ok(labelling_create(g, &prices, &p->l));
    for (int i = 0; i < 3; i++) labelling_add(&p->l, &(sight_point){.rest = {0.0}}, 0);
    for (uint32_t t = 0; t < g->count; t++) {
        const uint32_t quarter = quarter_of(&g->items[t]);
        labelling_give(&p->l, &t, 1, quarter);
    }
    grow_patch(g, count, p);
    p->own = (quarter_of(&g->items[p->patch[0]]) + 2) % 4;
    labelling_give(&p->l, p->patch, p->patch_count, p->own);
    memset(p->borders, 0, sizeof p->borders);
    for (uint32_t i = 0; i < p->patch_count; i++)
        for (uint32_t j = g->offsets[p->patch[i]]; j < g->offsets[p->patch[i] + 1]; j++)
            p->borders[p->l.of_tile[g->neighbours[j]]] += g->weights[j];
    p->borders[p->own] = 0.0;
    return count_pieces(b, &p->l, region_pieces) == 5 && region_pieces[p->own] == 2;
}

static uint32_t longest_of(const double borders[4]) {
    uint32_t longest = 0;
    for (uint32_t r = 1; r < 4; r++)
        if (borders[r] > borders[longest]) longest = r;
    return longest;
}

/* The patch, and it alone, goes to the neighbour with the longest border, weighted, or becomes a region. */
static void check_patch(const tiled_body *b, patched *p, bool large) {
    const tile_labelling *l = &p->l;
    uint32_t *before = body_allocate(b->tile_count, sizeof *before);
    const tile_set set = {&b->g, p->patch, p->patch_count};
    const uint32_t expected = large ? 4 : longest_of(p->borders);
    sight_point middle;
    memcpy(before, l->of_tile, b->tile_count * sizeof *before);
    connect_watched(&p->l);
    for (uint32_t i = 0; i < p->patch_count; i++) before[p->patch[i]] = expected;
    assert_memory_equal(l->of_tile, before, b->tile_count * sizeof *before);
    assert_int_equal(l->regions.count, large ? 5 : 4);
    tiles_centroid(&set, &middle);
    for (int k = 0; k < 3 && large; k++)
        assert_true(fabs(l->regions.points[4].rest[k] - middle.rest[k]) < 1e-12);
    free(before);
}

TEST(odd_pieces_find_a_region) {
    random_seed(5);
    tiled_body *b = tiled_body_make(BODY_TORUS, 1000);
    patched *p = body_allocate(1, sizeof *p);
    int between = 0, large = 0;
    for (int round = 0; round < 400; round++) {
        double area = 0.0;
        const bool alone = make_patched(b, (uint32_t)random_integer(1, 14), p);
        for (uint32_t i = 0; i < p->patch_count; i++) area += b->g.items[p->patch[i]].area;
        if (alone) {
            check_patch(b, p, area >= 0.01 * b->g.area);
            large += area >= 0.01 * b->g.area;
            between +=
                area < 0.01 * b->g.area && p->borders[(p->own + 1) % 4] + p->borders[(p->own + 3) % 4] > 0.0;
        }
        labelling_destroy(&p->l);
    }
    print_message("  %d small pieces between two regions, %d large pieces\n", between, large);
    assert_true(between >= 20 && large >= 20);
    free(p);
    tiled_body_free(b);
}
