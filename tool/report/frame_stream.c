/* Frames as the page stores them: positions rounded to a grid, each frame as its difference from the one
 * before. */
#include "tool/report/collected.h"

#include "tool/io/io.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Steps of the grid, as shares of the longest side: that of a new grid, and the coarsest that may be kept.
 * Half of the latter and float32's 2^-25 together are below 2^-15.9 of the side. */
#define STEP_OF_SIDE     0x1p-16
#define STEP_OF_SIDE_MAX 0x1p-15
#define VALUE_LIMIT      0x1p30

typedef struct box {
    double low[3], high[3], side; /* side: the longest */
} box;

static void *allocate_stream(size_t count, size_t size) {
    return count <= SIZE_MAX / size ? io_realloc(NULL, count * size) : NULL;
}

bool frame_stream_create(uint32_t vertex_count, double scale, frame_stream *out) {
    frame_stream s = {.vertex_count = vertex_count, .scale = scale};
    size_t count = (size_t)vertex_count * 3;
    s.bytes = packed_array_create();
    s.values = allocate_stream(count, sizeof *s.values);
    s.previous = allocate_stream(count, sizeof *s.previous);
    s.residuals = allocate_stream(count, sizeof *s.residuals);
    s.plane = allocate_stream(count, sizeof *s.plane);
    *out = s;
    if (s.bytes != NULL && s.values != NULL && s.previous != NULL && s.residuals != NULL && s.plane != NULL)
        return true;
    frame_stream_free(out);
    return false;
}

void frame_stream_free(frame_stream *stream) {
    packed_array_destroy(stream->bytes);
    free(stream->values);
    free(stream->previous);
    free(stream->residuals);
    free(stream->plane);
    *stream = (frame_stream){0};
}

static box box_of(const frame_stream *s, const double *positions) {
    box b = {.side = 0.0};
    for (size_t k = 0; k < 3; k++) {
        b.low[k] = b.high[k] = page_coordinate(positions[k], s->scale);
        for (size_t v = 1; v < s->vertex_count; v++) {
            double x = page_coordinate(positions[v * 3 + k], s->scale);
            if (x < b.low[k]) b.low[k] = x;
            if (x > b.high[k]) b.high[k] = x;
        }
        b.side = fmax(b.side, b.high[k] - b.low[k]);
    }
    return b;
}

/* Is the grid fine enough for the frame, and no value out of range? */
static bool grid_serves(const frame_stream *s, const box *b) {
    if (!(s->step > 0.0 && s->step <= b->side * STEP_OF_SIDE_MAX)) return false;
    double reach = (VALUE_LIMIT - 1.0) * s->step;
    for (int k = 0; k < 3; k++)
        if (!(b->low[k] - s->origin[k] > -reach && b->high[k] - s->origin[k] < reach)) return false;
    return true;
}

static void quantize_position(frame_stream *s, const double *positions) {
    for (size_t k = 0; k < 3; k++) {
        int32_t *values = s->values + k * s->vertex_count;
        for (size_t v = 0; v < s->vertex_count; v++) {
            double from_origin = page_coordinate(positions[v * 3 + k], s->scale) - s->origin[k];
            values[v] = s->step > 0.0 ? (int32_t)lrint(from_origin / s->step) : 0;
        }
    }
}

static double position_of(const frame_stream *s, size_t axis, int32_t value) {
    return s->origin[axis] + s->step * value;
}

/* Computes what the page shows along an axis, float32 from the middle. Returns the largest error, and how
 * long the frame is along the axis. */
static double measure_axis(const frame_stream *s, const double *positions, size_t axis, double *length) {
    const int32_t *values = s->values + axis * s->vertex_count;
    int32_t low = values[0], high = values[0];
    for (size_t v = 1; v < s->vertex_count; v++) {
        if (values[v] < low) low = values[v];
        if (values[v] > high) high = values[v];
    }
    double centre = (position_of(s, axis, low) + position_of(s, axis, high)) / 2.0, error = 0.0;
    double least = INFINITY, most = -INFINITY;
    for (size_t v = 0; v < s->vertex_count; v++) {
        double x = positions[v * 3 + axis] * s->scale;
        float local = (float)(position_of(s, axis, values[v]) - centre);
        double off = fabs(local + centre - x);
        if (off > error) error = off;
        if (x < least) least = x;
        if (x > most) most = x;
    }
    *length = most - least;
    return error;
}

static void measure_box(frame_stream *s, const double *positions) {
    double error = 0.0, side = 0.0;
    for (size_t k = 0; k < 3; k++) {
        double length;
        error = fmax(error, measure_axis(s, positions, k, &length));
        side = fmax(side, length);
    }
    s->max_error = fmax(s->max_error, error / s->scale);
    if (error > 0.0) s->relative_error = fmax(s->relative_error, side > 0.0 ? error / side : 1.0);
}

static bool add_key(frame_stream *s) {
    memset(s->previous, 0, (size_t)s->vertex_count * 3 * sizeof *s->previous);
    return packed_array_add_bytes(s->bytes, &(uint8_t){1}, 1) &&
           packed_array_add_f64(s->bytes, s->origin, 3) && packed_array_add_f64(s->bytes, &s->step, 1);
}

/* The average movement of the vertices; the prediction is moved by it. */
static bool add_shift(frame_stream *s) {
    uint32_t shifts[3];
    for (size_t k = 0; k < 3; k++) {
        size_t first = k * s->vertex_count;
        int64_t sum = 0;
        for (size_t v = first; v < first + s->vertex_count; v++)
            sum += (int64_t)s->values[v] - s->previous[v];
        shifts[k] = (uint32_t)llround((double)sum / s->vertex_count);
        for (size_t v = first; v < first + s->vertex_count; v++)
            s->previous[v] = (int32_t)((uint32_t)s->previous[v] + shifts[k]);
    }
    return packed_array_add_bytes(s->bytes, &(uint8_t){0}, 1) && packed_array_add_u32(s->bytes, shifts, 3);
}

static uint32_t zigzag_code(uint32_t r) {
    return r << 1 ^ (r >> 31 != 0 ? UINT32_MAX : 0);
}

/* Returns the bitwise or of all values. */
static uint32_t take_residuals(frame_stream *s) {
    uint32_t all = 0;
    for (size_t k = 0; k < 3; k++) {
        uint32_t before = 0;
        for (size_t v = k * s->vertex_count; v < (k + 1) * s->vertex_count; v++) {
            uint32_t difference = (uint32_t)s->values[v] - (uint32_t)s->previous[v];
            s->residuals[v] = zigzag_code(difference - before);
            all |= s->residuals[v];
            before = difference;
        }
    }
    return all;
}

static bool add_body(frame_stream *s) {
    size_t count = (size_t)s->vertex_count * 3;
    uint32_t all = take_residuals(s);
    uint8_t planes = 1;
    while (planes < 4 && all >> (8 * planes) != 0) planes++;
    if (!packed_array_add_bytes(s->bytes, &planes, 1)) return false;
    for (uint32_t p = 0; p < planes; p++) {
        for (size_t i = 0; i < count; i++) s->plane[i] = (uint8_t)(s->residuals[i] >> (8 * p));
        if (!packed_array_add_bytes(s->bytes, s->plane, count)) return false;
    }
    return true;
}

bool frame_stream_add(frame_stream *s, const double *positions) {
    box b = box_of(s, positions);
    bool key = !grid_serves(s, &b);
    if (key) {
        memcpy(s->origin, b.low, sizeof s->origin);
        s->step = b.side * STEP_OF_SIDE;
    }
    quantize_position(s, positions);
    measure_box(s, positions);
    if (!(key ? add_key(s) : add_shift(s)) || !add_body(s)) return false;
    int32_t *swap = s->previous;
    s->previous = s->values;
    s->values = swap;
    return true;
}
