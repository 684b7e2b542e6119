/* Is what a tracker is given of its mesh? It may come from anywhere. */
#include "runtime/events/frame_groups.h"
#include "src/core/vec3.h"

#include <math.h>

double curve_piece_length(const cscd_curves *curves, const cscd_curve *curve, size_t piece) {
    const cscd_curve_point *points = &curves->points[curve->first_point];
    return sqrt(vec3_squared_distance(points[piece].x, points[(piece + 1) % curve->point_count].x));
}

static cscd_status check_pairs(const cscd_mesh *mesh, const cscd_intersection_pairs *found) {
    if (found->items == NULL && found->count > 0)
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                            "found counts %zu pairs but has no list; ask for CSCD_ANSWER_LIST", found->count);
    for (size_t i = 0; i < found->count; i++) {
        const cscd_intersection_pair *pair = &found->items[i];
        if (pair->a < mesh->triangle_count && pair->b < mesh->triangle_count && (unsigned)pair->kind < 64)
            continue;
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                            "pair %zu (kind %d, triangles %u and %u) is not of the tracker's mesh", i,
                            (int)pair->kind, pair->a, pair->b);
    }
    return CSCD_OK;
}

static bool piece_fits(const cscd_mesh *mesh, const cscd_curves *curves, const cscd_curve *curve, size_t i) {
    const cscd_curve_piece *piece = &curves->pieces[curve->first_piece + i];
    return piece->a < mesh->triangle_count && piece->b < mesh->triangle_count &&
           isfinite(curve_piece_length(curves, curve, i));
}

static bool range_fits(size_t first, size_t count, size_t all) {
    return first <= all && count <= all - first;
}

static bool curve_fits(const cscd_mesh *mesh, const cscd_curves *curves, const cscd_curve *curve) {
    if (!range_fits(curve->first_point, curve->point_count, curves->point_count) ||
        !range_fits(curve->first_piece, curve->piece_count, curves->piece_count) ||
        curve->point_count < curve->piece_count || (curve->piece_count > 0 && curve->point_count == 0))
        return false;
    for (size_t i = 0; i < curve->piece_count; i++) {
        if (!piece_fits(mesh, curves, curve, i)) return false;
    }
    return true;
}

static cscd_status check_curves(const cscd_mesh *mesh, const cscd_curves *curves) {
    for (size_t i = 0; curves != NULL && i < curves->count; i++) {
        if (curve_fits(mesh, curves, &curves->items[i])) continue;
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT, "curve %zu is not of the tracker's mesh",
                            i);
    }
    return CSCD_OK;
}

static bool depth_fits(const cscd_mesh *mesh, const cscd_depth *depth) {
    bool has_vertex = depth->vertex < mesh->vertex_count || depth->vertex == UINT32_MAX;
    bool has_edge = depth->edge < mesh->edge_count || depth->edge == UINT32_MAX;
    return has_vertex && has_edge && depth->face < mesh->triangle_count &&
           depth->triangle < mesh->triangle_count && depth->depth >= 0.0 && isfinite(depth->depth);
}

static cscd_status check_depths(const cscd_mesh *mesh, const cscd_depths *depths) {
    for (size_t i = 0; depths != NULL && i < depths->count; i++) {
        if (depth_fits(mesh, &depths->items[i])) continue;
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT, "depth %zu is not of the tracker's mesh",
                            i);
    }
    return CSCD_OK;
}

cscd_status frame_input_check(const cscd_mesh *mesh, const cscd_intersection_pairs *found) {
    if (found == NULL) return CSCD_OK;
    cscd_status status = check_pairs(mesh, found);
    if (status == CSCD_OK) status = check_curves(mesh, found->curves);
    return status == CSCD_OK ? check_depths(mesh, found->depths) : status;
}
