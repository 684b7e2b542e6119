/* Axis-aligned boxes of moving features, in double. */
#pragma once

#include "runtime/narrow_phase/swept_interval.h"

#include <math.h>

typedef struct swept_box {
    double low[3], high[3];
} swept_box;

static inline void swept_box_add(const swept_interval *interval, uint32_t vertex, swept_box *box) {
    for (int k = 0; k < 3; k++) {
        double start = interval->x0[(size_t)vertex * 3 + (size_t)k];
        double end = interval->x1[(size_t)vertex * 3 + (size_t)k];
        double low = start < end ? start : end, high = start < end ? end : start;
        box->low[k] = low < box->low[k] ? low : box->low[k];
        box->high[k] = high > box->high[k] ? high : box->high[k];
    }
}

static inline swept_box swept_box_of(const swept_interval *interval, const uint32_t *vertices, int count) {
    swept_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < count; i++) swept_box_add(interval, vertices[i], &box);
    return box;
}

/* Rounding is monotone, so a gap of no more than the distance is never found to be more: nothing needs to be
 * rounded outward here. */
static inline bool swept_boxes_within(const swept_box *a, const swept_box *b, double distance) {
    for (int k = 0; k < 3; k++) {
        if (b->low[k] - a->high[k] > distance || a->low[k] - b->high[k] > distance) return false;
    }
    return true;
}
