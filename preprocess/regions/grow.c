/* Growth of a cluster, ring by ring, until what is left of its component falls apart. */
#include "preprocess/regions/grow.h"
#include "src/core/disjoint_sets.h"

static array_list list_arrays(growth *g) {
    size_t n = g->mesh->triangle_count;
    return (array_list){{ARRAY(g->reached, n), ARRAY(g->rings, n), ARRAY(g->parts, n), ARRAY(g->sets, n),
                         ARRAY(g->relevant_counts, n + 1), ARRAY(g->vertex_stamps, g->mesh->vertex_count),
                         ARRAY(g->set_areas, n)}};
}

cscd_status growth_create(const cscd_mesh *mesh, const dual_graph *graph, const double *areas, growth *out) {
    growth g = {.mesh = mesh, .graph = graph, .areas = areas};
    if (!context_allocate_all(mesh->context, list_arrays(&g))) return context_out_of_memory(mesh->context);
    for (size_t t = 0; t < mesh->triangle_count; t++) g.rings[t] = UINT32_MAX;
    *out = g;
    return CSCD_OK;
}

void growth_destroy(growth *g) {
    if (g->mesh == NULL) return;
    context_free_all(g->mesh->context, list_arrays(g));
}

static void reach_triangle(growth *g, uint32_t triangle, uint32_t ring) {
    if (g->rings[triangle] != UINT32_MAX) return;
    g->rings[triangle] = ring;
    g->reached[g->reached_count++] = triangle;
}

/* Appends the ring after the one that begins at reached[first]. */
static void reach_next_ring(growth *g, uint32_t first) {
    const cscd_mesh *mesh = g->mesh;
    uint32_t end = g->reached_count, ring = g->rings[g->reached[first]] + 1;
    for (uint32_t i = first; i < end; i++) {
        for (int corner = 0; corner < 3; corner++) {
            uint32_t v = mesh->triangles[g->reached[i]][corner];
            if (g->vertex_stamps[v] == g->stamp) continue;
            g->vertex_stamps[v] = g->stamp;
            for (uint32_t j = mesh->vertex_star_offsets[v]; j < mesh->vertex_star_offsets[v + 1]; j++)
                reach_triangle(g, mesh->vertex_stars[j], ring);
        }
    }
}

static void start_growth(growth *g, const uint32_t *cluster, uint32_t cluster_size) {
    for (uint32_t i = 0; i < g->reached_count; i++) g->rings[g->reached[i]] = UINT32_MAX;
    g->reached_count = 0;
    g->stamp++;
    for (uint32_t i = 0; i < cluster_size; i++) reach_triangle(g, cluster[i], 0);
    reach_next_ring(g, 0);
}

/* Is ring 1 connected? Then nothing lies on two sides of the cluster. */
static bool ring_is_whole(growth *g, uint32_t cluster_size) {
    for (uint32_t i = cluster_size; i < g->reached_count; i++) g->sets[g->reached[i]] = g->reached[i];
    uint32_t pieces = g->reached_count - cluster_size;
    for (uint32_t i = cluster_size; i < g->reached_count; i++) {
        uint32_t t = g->reached[i];
        for (uint32_t j = g->graph->offsets[t]; j < g->graph->offsets[t + 1]; j++) {
            uint32_t neighbour = g->graph->neighbours[j];
            if (g->rings[neighbour] != 1 || set_root(g->sets, t) == set_root(g->sets, neighbour)) continue;
            set_unite(g->sets, t, neighbour);
            pieces--;
        }
    }
    return pieces <= 1;
}

static void reach_all(growth *g, uint32_t first) {
    while (first < g->reached_count) {
        uint32_t end = g->reached_count;
        reach_next_ring(g, first);
        first = end;
    }
}

/* Adds a triangle to the parts outside; returns by how much the number of relevant ones changes. */
static int add_to_parts(growth *g, uint32_t t, double relevant_area) {
    g->sets[t] = t;
    g->set_areas[t] = g->areas[t];
    int change = g->areas[t] >= relevant_area;
    for (uint32_t i = g->graph->offsets[t]; i < g->graph->offsets[t + 1]; i++) {
        uint32_t neighbour = g->graph->neighbours[i];
        if (g->sets[neighbour] == UINT32_MAX) continue;
        uint32_t a = set_root(g->sets, t), b = set_root(g->sets, neighbour);
        if (a == b) continue;
        double area = g->set_areas[a] + g->set_areas[b];
        change -= (g->set_areas[a] >= relevant_area) + (g->set_areas[b] >= relevant_area);
        change += area >= relevant_area;
        g->set_areas[set_unite(g->sets, a, b)] = area;
    }
    return change;
}

/* relevant_counts[r] = the number of relevant parts when the rings 0 .. r are taken away: from the last ring
 * inwards, each triangle only ever joins parts, so that all r together cost one pass. */
static void count_relevant_parts(growth *g, double relevant_area) {
    int count = 0;
    for (uint32_t i = 0; i < g->reached_count; i++) g->sets[g->reached[i]] = UINT32_MAX;
    for (uint32_t i = g->reached_count; i-- > 0;) {
        uint32_t t = g->reached[i], ring = g->rings[t];
        if (i + 1 == g->reached_count || ring != g->rings[g->reached[i + 1]])
            g->relevant_counts[ring] = (uint32_t)count;
        count += add_to_parts(g, t, relevant_area);
    }
}

static bool choose_band(growth *g, bool may_grow) {
    uint32_t last = g->rings[g->reached[g->reached_count - 1]], first = 0;
    while (first <= last && g->relevant_counts[first] < 2) first++;
    if (first > last || (first > 0 && !may_grow)) return false;
    g->band_ring = first;
    if (!may_grow) return true;
    for (uint32_t r = first; r <= last && r <= first + first / 2 + 1; r++) {
        if (g->relevant_counts[r] > g->relevant_counts[g->band_ring]) g->band_ring = r;
    }
    return true;
}

/* Floods the part of a triangle outside the band; `queue` has room for the component. Returns its area. */
static double flood_part(growth *g, uint32_t from, uint32_t label, uint32_t *queue, uint32_t *size) {
    double area = 0.0;
    uint32_t end = 1;
    queue[0] = from;
    g->parts[from] = label;
    for (uint32_t next = 0; next < end; next++) {
        uint32_t t = queue[next];
        area += g->areas[t];
        for (uint32_t i = g->graph->offsets[t]; i < g->graph->offsets[t + 1]; i++) {
            uint32_t neighbour = g->graph->neighbours[i];
            if (g->rings[neighbour] <= g->band_ring || g->parts[neighbour] != UINT32_MAX) continue;
            g->parts[neighbour] = label;
            queue[end++] = neighbour;
        }
    }
    *size = end;
    return area;
}

static void label_parts(growth *g, double relevant_area) {
    double largest = 0.0;
    for (uint32_t i = 0; i < g->reached_count; i++)
        g->parts[g->reached[i]] = g->rings[g->reached[i]] <= g->band_ring ? 0 : UINT32_MAX;
    g->part_count = 0;
    for (uint32_t i = 0; i < g->reached_count; i++) {
        uint32_t t = g->reached[i], size;
        if (g->parts[t] != UINT32_MAX) continue;
        double area = flood_part(g, t, g->part_count + 1, g->sets, &size);
        if (area < relevant_area) { /* an island */
            for (uint32_t j = 0; j < size; j++) g->parts[g->sets[j]] = 0;
            continue;
        }
        g->part_count++;
        if (area > largest) {
            largest = area;
            g->largest_part = g->part_count;
        }
    }
}

bool growth_separates(growth *g, const uint32_t *cluster, uint32_t cluster_size, bool may_grow,
                      double relevant_area) {
    start_growth(g, cluster, cluster_size);
    if (!may_grow && ring_is_whole(g, cluster_size)) return false;
    if (g->reached_count > cluster_size) reach_all(g, cluster_size);
    count_relevant_parts(g, relevant_area);
    if (!choose_band(g, may_grow)) return false;
    label_parts(g, relevant_area);
    return g->part_count >= 2;
}
