/* Counts the triangles that culling leaves. */
#include "preprocess/regions/tiles.h"

#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

typedef struct share_work {
    const judged_regions *regions;
    region_scene scene;
    bool *at_border;     /* of vertices */
    uint32_t *region_of; /* of vertices: one of those around */
    float *blindness;    /* of triangles, summed over the frames */
    double *ways;        /* of triangles: the blindness for soft material on the way */
    double *signs; /* of regions: the sum of their orientations at rest, negative where they are inside out */
    region_way *moves;   /* of regions */
    double (*points)[3]; /* of regions, in a frame */
} share_work;

static array_list list_arrays(share_work *w) {
    const cscd_mesh *mesh = w->regions->mesh;
    const size_t triangles = mesh->triangle_count, vertices = mesh->vertex_count,
                 regions = w->regions->region_count;
    return (array_list){{ARRAY(w->at_border, vertices), ARRAY(w->region_of, vertices),
                         ARRAY(w->blindness, triangles), ARRAY(w->ways, triangles), ARRAY(w->signs, regions),
                         ARRAY(w->moves, regions), ARRAY(w->points, regions)}};
}

static void mark_borders(share_work *w) {
    const cscd_mesh *mesh = w->regions->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int i = 0; i < 3; i++) w->region_of[mesh->triangles[t][i]] = w->regions->of_triangle[t];
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int i = 0; i < 3; i++)
            w->at_border[mesh->triangles[t][i]] |=
                w->region_of[mesh->triangles[t][i]] != w->regions->of_triangle[t];
}

static void find_signs(share_work *w) {
    for (uint32_t t = 0; t < w->regions->mesh->triangle_count; t++) {
        const uint32_t r = w->regions->of_triangle[t];
        w->signs[r] += orientation_value(w->regions->mesh, w->regions->positions, t, w->scene.points[r]);
    }
}

/* From 0, the point sees the triangle well, to 1, it does not see it. */
static double triangle_blindness(const cscd_mesh *mesh, const double *positions, uint32_t t,
                                 const double point[3], bool turned) {
    const double value = orientation_value(mesh, positions, t, point);
    double away[3], normal[3];
    if (turned ? !(value < 0.0) : !(value > 0.0)) return 1.0;
    for (uint32_t k = 0; k < 3; k++) {
        away[k] = -point[k];
        for (uint32_t corner = 0; corner < 3; corner++)
            away[k] += surface_corner(mesh, positions, t, corner)[k] / 3.0;
    }
    surface_normal(mesh, positions, t, normal);
    const double well = SEEN_WELL_SINE * surface_norm(normal) * surface_norm(away);
    return fabs(value) < well ? GRAZING_BLINDNESS * (1.0 - fabs(value) / well) : 0.0;
}

static void add_frame(share_work *w, const double *positions, const double (*points)[3]) {
    for (uint32_t t = 0; t < w->regions->mesh->triangle_count; t++) {
        const uint32_t r = w->regions->of_triangle[t];
        w->blindness[t] +=
            (float)triangle_blindness(w->regions->mesh, positions, t, points[r], w->signs[r] < 0.0);
    }
}

static double sum_share(const share_work *w) {
    const cscd_mesh *mesh = w->regions->mesh;
    double tested = 0.0, all = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (triangle_of_obstacle(mesh, t)) continue;
        bool whole = !mesh->components[mesh->triangle_components[t]].closed_manifold;
        for (int i = 0; i < 3; i++) whole |= w->at_border[mesh->triangles[t][i]];
        tested += whole ? 1.0 : fmax((double)w->blindness[t] / (1.0 + w->regions->frame_count), w->ways[t]);
        all += 1.0;
    }
    return all > 0.0 ? tested / all : 0.0;
}

cscd_status regions_tested_share(const judged_regions *regions, double *out) {
    cscd_context *context = regions->mesh->context;
    share_work w = {.regions = regions,
                    .scene = {.mesh = regions->mesh,
                              .positions = regions->positions,
                              .count = regions->mesh->triangle_count,
                              .of_triangle = regions->of_triangle,
                              .region_count = regions->region_count,
                              .points = regions->points}};
    if (!context_allocate_all(context, list_arrays(&w))) return context_out_of_memory(context);
    mark_borders(&w);
    find_signs(&w);
    add_frame(&w, regions->positions, w.scene.points);
    for (uint32_t f = 0; f < regions->frame_count && progress_go_on(&context->progress, 1.0); f++) {
        region_points_move(&w.scene, regions->frames[f], w.moves, w.points);
        add_frame(&w, regions->frames[f], (const double(*)[3])w.points);
    }
    cscd_status status = context_progress_status(context);
    if (status == CSCD_OK && regions->stiffness != NULL)
        status = soft_ways_find(&w.scene, regions->stiffness, w.ways);
    *out = sum_share(&w);
    context_free_all(context, list_arrays(&w));
    return status;
}
