/* Intersection curves as polylines of a .vtp file. */
#include "tool/export/vtk_curves.h"

#include <stdlib.h>
#include <string.h>

void vtk_curves_free(vtk_curves *lines) {
    free(lines->points);
    free(lines->corners);
    free(lines->ends);
    free(lines->lengths);
    free(lines->objects[0]);
    free(lines->objects[1]);
    free(lines->closed);
    free(lines->touching);
    *lines = (vtk_curves){0};
}

static bool allocate_lines(vtk_curves *l) {
    const size_t count = l->count + 1; /* never 0 */
    l->points = malloc((l->point_count + 1) * 3 * sizeof *l->points);
    l->corners = malloc((l->corner_count + 1) * sizeof *l->corners);
    l->ends = malloc(count * sizeof *l->ends);
    l->lengths = malloc(count * sizeof *l->lengths);
    l->objects[0] = malloc(count * sizeof *l->objects[0]);
    l->objects[1] = malloc(count * sizeof *l->objects[1]);
    l->closed = malloc(count);
    l->touching = malloc(count);
    return l->points != NULL && l->corners != NULL && l->ends != NULL && l->lengths != NULL &&
           l->objects[0] != NULL && l->objects[1] != NULL && l->closed != NULL && l->touching != NULL;
}

bool vtk_curves_collect(const cscd_curves *curves, vtk_curves *out) {
    static const cscd_curves none = {.count = 0};
    if (curves == NULL) curves = &none; /* they did not fit the memory, which the run says */
    vtk_curves l = {
        .count = curves->count, .point_count = curves->point_count, .corner_count = curves->point_count};
    for (size_t i = 0; i < curves->count; i++) l.corner_count += curves->items[i].closed;
    if (!allocate_lines(&l)) {
        vtk_curves_free(&l);
        return false;
    }
    for (size_t i = 0; i < curves->point_count; i++)
        memcpy(l.points + 3 * i, curves->points[i].x, 3 * sizeof *l.points);
    int64_t end = 0;
    for (size_t i = 0; i < curves->count; i++) {
        const cscd_curve *curve = &curves->items[i];
        for (size_t k = 0; k < curve->point_count; k++) l.corners[end++] = (int64_t)(curve->first_point + k);
        if (curve->closed) l.corners[end++] = (int64_t)curve->first_point;
        l.ends[i] = end;
        l.lengths[i] = curve->length;
        for (int k = 0; k < 2; k++) l.objects[k][i] = curve->objects[k];
        l.closed[i] = curve->closed;
        l.touching[i] = curve->touching;
    }
    l.corner_count = (uint64_t)end;
    *out = l;
    return true;
}

void vtk_curves_add(const vtk_curves *l, vtp_file *file) {
    vtp_add(file, VTP_CELL_DATA, "length", VTP_FLOAT64, l->count, 1, l->lengths);
    vtp_add(file, VTP_CELL_DATA, "closed", VTP_UINT8, l->count, 1, l->closed);
    vtp_add(file, VTP_CELL_DATA, "touching", VTP_UINT8, l->count, 1, l->touching);
    vtp_add(file, VTP_CELL_DATA, "object_a", VTP_UINT32, l->count, 1, l->objects[0]);
    vtp_add(file, VTP_CELL_DATA, "object_b", VTP_UINT32, l->count, 1, l->objects[1]);
    vtp_add(file, VTP_POINTS, "Points", VTP_FLOAT64, l->point_count, 3, l->points);
    vtp_add(file, VTP_LINES, "connectivity", VTP_INT64, l->corner_count, 1, l->corners);
    vtp_add(file, VTP_LINES, "offsets", VTP_INT64, l->count, 1, l->ends);
}
