/* Clusters: triangles of low charge that are joined by edges (Yeh 2012, section 3.3). */
#include "preprocess/baselines/clusters.h"
#include "preprocess/baselines/cutting_list.h"

/* Appends all marked triangles that can be reached from those at `next` and after it, and takes their marks back. */
static uint32_t collect_cluster(const cscd_mesh *mesh, uint32_t *list, uint32_t next, bool *marked) {
    uint32_t end = next + 1;
    for (; next < end; next++) {
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t neighbour = triangle_beyond(mesh, list[next], k);
            if (!marked[neighbour]) continue;
            marked[neighbour] = false;
            list[end++] = neighbour;
        }
    }
    return end;
}

static bool may_be_cut(const cscd_mesh *mesh, uint32_t triangle) {
    const uint32_t component = mesh->triangle_components[triangle];
    return mesh->components[component].closed_manifold && !component_is_obstacle(mesh, component);
}

cscd_status clusters_find(const cscd_mesh *mesh, const double *equalized, double threshold, clusters *out) {
    cscd_context *context = mesh->context;
    clusters found = {0};
    bool *marked;
    array_list lists = {{ARRAY(found.offsets, (size_t)mesh->triangle_count + 1),
                         ARRAY(found.triangles, mesh->triangle_count), ARRAY(marked, mesh->triangle_count)}};
    if (!context_allocate_all(context, lists)) return context_out_of_memory(context);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        marked[t] = equalized[t] < threshold && may_be_cut(mesh, t);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!marked[t]) continue;
        const uint32_t first = found.offsets[found.count];
        found.triangles[first] = t;
        marked[t] = false;
        found.offsets[++found.count] = collect_cluster(mesh, found.triangles, first, marked);
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
