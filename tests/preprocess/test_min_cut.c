/* Minimum cuts of small random graphs, beside all cuts. */
#include "preprocess/regions/tiles.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <string.h>

enum { NODES_MOST = 9, LINKS_MOST = NODES_MOST * (NODES_MOST - 1) };

/* Each two nodes are linked or not; capacities differ by direction. */
typedef struct network {
    uint32_t node_count, link_count, offsets[NODES_MOST + 1], neighbours[LINKS_MOST], twins[LINKS_MOST];
    int64_t capacities[LINKS_MOST], supplies[NODES_MOST], drains[NODES_MOST];
} network;

static network random_network(void) {
    network n = {.node_count = (uint32_t)random_integer(1, NODES_MOST)};
    bool linked[NODES_MOST][NODES_MOST] = {{false}};
    uint32_t places[NODES_MOST][NODES_MOST];
    for (uint32_t a = 0; a < n.node_count; a++)
        for (uint32_t b = a + 1; b < n.node_count; b++)
            linked[a][b] = linked[b][a] = random_integer(0, 2) > 0;
    for (uint32_t a = 0; a < n.node_count; a++) {
        n.supplies[a] = random_integer(-6, 9) > 0 ? random_integer(0, 9) : 0;
        n.drains[a] = random_integer(-6, 9) > 0 ? random_integer(0, 9) : 0;
        n.offsets[a] = n.link_count;
        for (uint32_t b = 0; b < n.node_count; b++) {
            if (!linked[a][b]) continue;
            places[a][b] = n.link_count;
            n.neighbours[n.link_count] = b;
            n.capacities[n.link_count++] = random_integer(-2, 6) > 0 ? random_integer(0, 6) : 0;
        }
    }
    n.offsets[n.node_count] = n.link_count;
    for (uint32_t a = 0; a < n.node_count; a++)
        for (uint32_t b = 0; b < n.node_count; b++)
            if (linked[a][b]) n.twins[places[a][b]] = places[b][a];
    return n;
}

/* Nodes of the set are with the supplies: they pay their drains and the links out of the set, and the others their supplies. */
static int64_t cost_of(const network *n, uint32_t set) {
    int64_t cost = 0;
    for (uint32_t a = 0; a < n->node_count; a++) {
        const bool inside = set >> a & 1;
        cost += inside ? n->drains[a] : n->supplies[a];
        for (uint32_t j = n->offsets[a]; j < n->offsets[a + 1] && inside; j++)
            if (!(set >> n->neighbours[j] & 1)) cost += n->capacities[j];
    }
    return cost;
}

static uint32_t size_of(uint32_t set) {
    uint32_t size = 0;
    for (; set != 0; set &= set - 1) size++;
    return size;
}

TEST(costs_the_least_and_keeps_the_fewest) {
    cscd_context *context;
    expect_ok(cscd_context_create(NULL, &context));
    const size_t bytes = cscd_context_describe(context).bytes;
    random_seed(1);
    for (int round = 0; round < 3000; round++) {
        const network n = random_network();
        const flow_graph graph = {n.node_count, n.link_count, n.offsets, n.neighbours, n.twins};
        uint32_t nodes[NODES_MOST], found = 0, fewest = NODES_MOST;
        int64_t least = INT64_MAX;
        min_cut cut;
        expect_ok(min_cut_create(context, &graph, &cut));
        memcpy(cut.residuals, n.capacities, n.link_count * sizeof *n.capacities);
        memcpy(cut.supplies, n.supplies, n.node_count * sizeof *n.supplies);
        memcpy(cut.drains, n.drains, n.node_count * sizeof *n.drains);
        for (uint32_t a = 0; a < n.node_count; a++) nodes[a] = a;
        const uint32_t count = min_cut_run(&cut, nodes, n.node_count);
        for (uint32_t i = 0; i < count; i++) found |= 1u << cut.queue[i];
        for (uint32_t set = 0; set < 1u << n.node_count; set++) {
            const int64_t cost = cost_of(&n, set);
            if (cost < least || (cost == least && size_of(set) < fewest)) fewest = size_of(set);
            least = cost < least ? cost : least;
        }
        assert_true(cut.cost == least && cost_of(&n, found) == least);
        assert_int_equal(size_of(found), fewest);
        min_cut_destroy(&cut);
    }
    assert_int_equal(cscd_context_describe(context).bytes, bytes);
    cscd_context_destroy(context);
}
