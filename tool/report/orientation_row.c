/* How the triangles faced their regions' detector points in one interval, and where these points were. */
#include "tool/report/orientation_row.h"

#include "tool/io/io.h"

#include <stdlib.h>
#include <string.h>

bool orientation_row_create(const cscd_detector *detector, const cscd_mesh *mesh, orientation_row *out) {
    orientation_row row = {.triangle_count = cscd_mesh_triangle_count(mesh),
                           .region_count = cscd_detector_region_count(detector)};
    if (row.region_count > 0) {
        row.points = io_realloc(NULL, row.region_count * sizeof *row.points);
        row.facing = io_realloc(NULL, orientation_row_size(row.triangle_count));
        if (row.points == NULL || row.facing == NULL) {
            orientation_row_free(&row);
            return false;
        }
    }
    *out = row;
    return true;
}

void orientation_row_free(orientation_row *row) {
    free(row->points);
    free(row->facing);
    *row = (orientation_row){0};
}

void orientation_row_take(orientation_row *row, const cscd_detector *detector) {
    if (row->region_count == 0) return;
    for (uint32_t i = 0; i < row->region_count; i++)
        cscd_detector_region_point(detector, i, row->points[i], row->points[i] + 3);
    memset(row->facing, 0, orientation_row_size(row->triangle_count));
    for (uint32_t t = 0; t < row->triangle_count; t++) {
        const int orientation = cscd_detector_orientation(detector, t);
        const unsigned bits = orientation > 0 ? 1 : orientation < 0 ? 2 : 0;
        row->facing[t / 4] |= (uint8_t)(bits << t % 4 * 2);
    }
}

void orientation_row_forget(orientation_row *row) {
    if (row->region_count == 0) return;
    memset(row->points, 0, row->region_count * sizeof *row->points);
    memset(row->facing, 0, orientation_row_size(row->triangle_count));
}
