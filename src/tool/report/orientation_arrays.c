/* How triangles faced their regions' detector points, and where these points were, as arrays of a report. */
#include "src/tool/report/orientation_arrays.h"

#include "src/io/growable.h"
#include "src/tool/report/page_coordinate.h"

#include <stdlib.h>
#include <string.h>

static size_t row_size(const orientation_arrays *a) {
    return ((size_t)a->triangle_count + 3) / 4;
}

bool orientation_arrays_create(uint32_t triangle_count, uint32_t kept_count, uint32_t interval_count,
                               orientation_arrays *out) {
    orientation_arrays a = {.triangle_count = triangle_count, .interval_count = interval_count};
    size_t size = row_size(&a);
    bool created = (a.points = packed_array_create()) != NULL;
    if (size <= REPORT_MARKS_MAX / (kept_count > 0 ? kept_count : 1)) {
        a.orientations = packed_array_create();
        a.last = io_realloc(NULL, size);
        a.row = io_realloc(NULL, size);
        created = created && a.orientations != NULL && a.last != NULL && a.row != NULL;
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
    free(a->row);
    *a = (orientation_arrays){0};
}

bool orientation_arrays_add(orientation_arrays *a, const cscd_detector *detector) {
    if (a->orientations == NULL) return true;
    size_t size = row_size(a);
    memset(a->row, 0, size);
    for (uint32_t t = 0; t < a->triangle_count; t++) {
        int orientation = cscd_detector_orientation(detector, t);
        unsigned bits = orientation > 0 ? 1 : orientation < 0 ? 2 : 0;
        a->row[t / 4] |= (uint8_t)(bits << t % 4 * 2);
    }
    for (size_t i = 0; i < size; i++) a->last[i] ^= a->row[i];
    bool added = packed_array_add_bytes(a->orientations, a->last, size);
    uint8_t *swap = a->last;
    a->last = a->row;
    a->row = swap;
    return added;
}

bool orientation_arrays_add_points(orientation_arrays *a, const cscd_detector *detector, double scale) {
    uint32_t count = cscd_detector_region_count(detector);
    size_t size = sizeof(double[6]) * a->interval_count; /* of one region */
    if (a->points != NULL && count > 0 && size > REPORT_MARKS_MAX / count) {
        packed_array_destroy(a->points);
        a->points = NULL;
    }
    if (a->points == NULL) return true;
    for (uint32_t i = 0; i < count; i++) {
        double ends[6];
        cscd_detector_region_point(detector, i, ends, ends + 3);
        for (int k = 0; k < 6; k++) ends[k] = page_coordinate(ends[k], scale);
        if (!packed_array_add_f64(a->points, ends, 6)) return false;
    }
    return true;
}
