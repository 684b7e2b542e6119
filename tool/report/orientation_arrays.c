/* How triangles faced their regions' detector points, and where these points were, as arrays of a report. */
#include "tool/report/orientation_arrays.h"

#include "tool/io/io.h"
#include "tool/report/page_coordinate.h"

#include <stdlib.h>
#include <string.h>

bool orientation_arrays_create(uint32_t triangle_count, uint32_t kept_count, uint32_t interval_count,
                               orientation_arrays *out) {
    orientation_arrays a = {.triangle_count = triangle_count, .interval_count = interval_count};
    size_t size = orientation_row_size(triangle_count);
    bool created = (a.points = packed_array_create()) != NULL;
    if (size <= REPORT_MARKS_MAX / (kept_count > 0 ? kept_count : 1)) {
        a.orientations = packed_array_create();
        a.last = io_realloc(NULL, size);
        a.change = io_realloc(NULL, size);
        created = created && a.orientations != NULL && a.last != NULL && a.change != NULL;
    }
    if (created && a.last != NULL) memset(a.last, 0, size);
    if (!created) orientation_arrays_free(&a);
    *out = a;
    return created;
}

void orientation_arrays_free(orientation_arrays *a) {
    packed_array_destroy(a->orientations);
    packed_array_destroy(a->points);
    free(a->last);
    free(a->change);
    *a = (orientation_arrays){0};
}

bool orientation_arrays_add(orientation_arrays *a, const orientation_row *row) {
    if (a->orientations == NULL) return true;
    const size_t size = orientation_row_size(a->triangle_count);
    for (size_t i = 0; i < size; i++) a->change[i] = a->last[i] ^ row->facing[i];
    memcpy(a->last, row->facing, size);
    return packed_array_add_bytes(a->orientations, a->change, size);
}

bool orientation_arrays_add_points(orientation_arrays *a, const orientation_row *row, double scale) {
    size_t size = sizeof(double[6]) * a->interval_count; /* of one region */
    if (a->points != NULL && row->region_count > 0 && size > REPORT_MARKS_MAX / row->region_count) {
        packed_array_destroy(a->points);
        a->points = NULL;
    }
    if (a->points == NULL) return true;
    for (uint32_t i = 0; i < row->region_count; i++) {
        double ends[6];
        for (int k = 0; k < 6; k++) ends[k] = page_coordinate(row->points[i][k], scale);
        if (!packed_array_add_f64(a->points, ends, 6)) return false;
    }
    return true;
}
