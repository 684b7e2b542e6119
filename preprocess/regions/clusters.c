/* Clusters: edge-connected triangles of low charge. */
#include "preprocess/regions/clusters.h"

/* Appends all marked triangles that can be reached from those at `next` and after it, and takes their marks
 * back. */
static uint32_t collect_cluster(const dual_graph *graph, uint32_t *list, uint32_t next, bool *marked) {
    uint32_t end = next + 1;
    for (; next < end; next++) {
        for (uint32_t i = graph->offsets[list[next]]; i < graph->offsets[list[next] + 1]; i++) {
            uint32_t neighbour = graph->neighbours[i];
            if (!marked[neighbour] || graph->edges[i] == DUAL_NO_EDGE) continue;
            marked[neighbour] = false;
            list[end++] = neighbour;
        }
    }
    return end;
}

cscd_status clusters_find(const cscd_mesh *mesh, const dual_graph *graph, const double *equalized,
                          double threshold, clusters *out) {
    cscd_context *context = mesh->context;
    clusters found = {0};
    bool *marked;
    array_list lists = {{ARRAY(found.offsets, (size_t)mesh->triangle_count + 1),
                         ARRAY(found.triangles, mesh->triangle_count), ARRAY(marked, mesh->triangle_count)}};
    if (!context_allocate_all(context, lists)) return context_out_of_memory(context);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        marked[t] = equalized[t] <= threshold && !triangle_of_obstacle(mesh, t);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!marked[t]) continue;
        uint32_t first = found.offsets[found.count];
        found.triangles[first] = t;
        marked[t] = false;
        found.offsets[++found.count] = collect_cluster(graph, found.triangles, first, marked);
    }
    context_free(context, marked);
    *out = found;
    return CSCD_OK;
}

void clusters_free(const cscd_mesh *mesh, clusters *found) {
    context_free(mesh->context, found->offsets);
    context_free(mesh->context, found->triangles);
    *found = (clusters){0};
}
