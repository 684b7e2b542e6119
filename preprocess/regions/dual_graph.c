/* The mesh's dual graph: triangles, joined across their common edges. */
#include "preprocess/regions/tiles.h"

#include "src/core/sort.h"

typedef struct link {
    uint32_t a, b, edge;
} link;

typedef struct link_list {
    uint32_t count;
    link *items;
} link_list;

static void add_link(link_list *links, uint32_t *sets, uint32_t a, uint32_t b, uint32_t edge) {
    links->items[links->count++] = (link){a, b, edge};
    set_unite(sets, a, b);
}

static void link_edges(const cscd_mesh *mesh, link_list *links, uint32_t *sets) {
    for (uint32_t edge = 0; edge < mesh->edge_count; edge++) {
        for (uint32_t i = mesh->edge_star_offsets[edge] + 1; i < mesh->edge_star_offsets[edge + 1]; i++)
            add_link(links, sets, mesh->edge_stars[i - 1], mesh->edge_stars[i], edge);
    }
}

static void link_patches(const cscd_mesh *mesh, link_list *links, uint32_t *sets) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (uint32_t i = mesh->vertex_star_offsets[v] + 1; i < mesh->vertex_star_offsets[v + 1]; i++) {
            uint32_t a = mesh->vertex_stars[i - 1], b = mesh->vertex_stars[i];
            if (set_root(sets, a) != set_root(sets, b)) add_link(links, sets, a, b, DUAL_NO_EDGE);
        }
    }
}

static void put_links(const link_list *links, dual_graph *graph) {
    uint32_t *offsets = graph->offsets;
    for (uint32_t i = 0; i < links->count; i++) {
        offsets[links->items[i].a + 1]++;
        offsets[links->items[i].b + 1]++;
    }
    for (uint32_t t = 0; t < graph->triangle_count; t++) offsets[t + 1] += offsets[t];
    for (uint32_t i = 0; i < links->count; i++) { /* offsets[t] moves to the end of t's links */
        const link *l = &links->items[i];
        uint32_t forth = offsets[l->a]++, back = offsets[l->b]++;
        graph->neighbours[forth] = l->b;
        graph->neighbours[back] = l->a;
        graph->edges[forth] = graph->edges[back] = l->edge;
    }
    for (uint32_t t = graph->triangle_count; t > 0; t--) offsets[t] = offsets[t - 1];
    offsets[0] = 0;
}

static array_list list_arrays(dual_graph *graph) {
    return (array_list){{ARRAY(graph->offsets, (size_t)graph->triangle_count + 1),
                         ARRAY(graph->neighbours, graph->link_count),
                         ARRAY(graph->edges, graph->link_count)}};
}

static cscd_status allocate_graph(const cscd_mesh *mesh, uint32_t link_count, dual_graph *graph) {
    cscd_context *context = mesh->context;
    graph->triangle_count = mesh->triangle_count;
    graph->link_count = link_count * 2;
    bool complete = context_allocate_all(context, list_arrays(graph));
    return complete ? CSCD_OK : context_out_of_memory(context);
}

/* One link less than triangles for each edge; and as many between patches as join them to components, which
 * together are fewer than triangles. */
static size_t link_count_bound(const cscd_mesh *mesh) {
    return (size_t)mesh->triangle_count * 4 - (mesh->edge_count - mesh->loose.wire_count);
}

cscd_status dual_graph_build(const cscd_mesh *mesh, dual_graph *out) {
    cscd_context *context = mesh->context;
    if (link_count_bound(mesh) > UINT32_MAX / 2)
        return context_fail(context, CSCD_INVALID_MESH, "%u triangles are too many for regions",
                            mesh->triangle_count);
    dual_graph graph = {0};
    link_list links = {0, context_allocate(context, link_count_bound(mesh), sizeof(link))};
    uint32_t *sets = context_allocate(context, mesh->triangle_count, sizeof *sets);
    cscd_status status = CSCD_OUT_OF_MEMORY;
    if (links.items != NULL && sets != NULL) {
        sets_begin(sets, mesh->triangle_count);
        link_edges(mesh, &links, sets);
        link_patches(mesh, &links, sets);
        status = allocate_graph(mesh, links.count, &graph);
    } else {
        context_out_of_memory(context);
    }
    if (status == CSCD_OK) {
        put_links(&links, &graph);
        *out = graph;
    } else {
        dual_graph_free(mesh, &graph);
    }
    context_free(context, sets);
    context_free(context, links.items);
    return status;
}

void dual_graph_free(const cscd_mesh *mesh, dual_graph *graph) {
    context_free_all(mesh->context, list_arrays(graph));
    *graph = (dual_graph){0};
}

uint32_t dual_graph_pieces(const dual_graph *graph, const uint32_t *list, uint32_t count,
                           const uint32_t *labels, uint32_t *pieces, uint32_t *scratch) {
    uint32_t piece_count = 0;
    for (uint32_t i = 0; i < count; i++) scratch[list[i]] = list[i];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t t = list[i];
        for (uint32_t j = graph->offsets[t]; j < graph->offsets[t + 1]; j++) {
            if (labels[graph->neighbours[j]] == labels[t]) set_unite(scratch, t, graph->neighbours[j]);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t root = set_root(scratch, list[i]);
        pieces[list[i]] = root == list[i] ? piece_count++ : pieces[root];
    }
    return piece_count;
}
