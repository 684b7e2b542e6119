/* Rasterises triangles with edge functions in homogeneous coordinates (Olano and Greer, "Triangle scan
 * conversion using 2D homogeneous coordinates", 1997): no clipping, whatever lies behind the eye. */
#include "tool/picture/shade.h"

#include "tool/picture/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool picture_visibility_create(uint32_t width, uint32_t height, uint32_t samples, picture_visibility *out,
                               io_error *error) {
    if (width == 0 || height == 0 || width > PICTURE_SIDE_MAX || height > PICTURE_SIDE_MAX)
        return io_fail(error, "picture of %u x %u pixels: each side must be 1 to %u", (unsigned)width,
                       (unsigned)height, PICTURE_SIDE_MAX);
    if (samples == 0 || samples > PICTURE_SAMPLES_MAX)
        return io_fail(error, "picture with %u x %u samples a pixel: 1 to %u are possible", (unsigned)samples,
                       (unsigned)samples, PICTURE_SAMPLES_MAX);
    size_t count = (size_t)width * samples * height * samples;
    float *inverse_depth = calloc(count, sizeof *inverse_depth);
    uint32_t *triangle = malloc(count * sizeof *triangle);
    if (inverse_depth == NULL || triangle == NULL) {
        free(inverse_depth);
        free(triangle);
        return io_fail(error, "picture of %u x %u pixels: out of memory for %zu samples", (unsigned)width,
                       (unsigned)height, count);
    }
    memset(triangle, 0xff, count * sizeof *triangle);
    *out = (picture_visibility){width, height, samples, inverse_depth, triangle};
    return true;
}

void picture_visibility_free(picture_visibility *visibility) {
    free(visibility->inverse_depth);
    free(visibility->triangle);
    *visibility = (picture_visibility){0};
}

static void cross_product(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* A shared edge gives its two triangles exactly opposite coefficients (cross_product is exactly
 * antisymmetric), so no sample falls between them. */
bool picture_edges_set(const double *projected, const uint32_t corners[3], picture_edges *out) {
    const double *a = projected + 3 * (size_t)corners[0], *b = projected + 3 * (size_t)corners[1],
                 *c = projected + 3 * (size_t)corners[2];
    cross_product(b, c, out->edge[0]);
    cross_product(c, a, out->edge[1]);
    cross_product(a, b, out->edge[2]);
    double volume = a[0] * out->edge[0][0] + a[1] * out->edge[0][1] + a[2] * out->edge[0][2];
    /* The normal of the counter-clockwise side points against the line of sight. */
    out->front = volume < 0.0;
    out->volume = fabs(volume);
    if (volume < 0.0)
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++) out->edge[k][i] = -out->edge[k][i];
    return out->volume > 0.0;
}

typedef struct bounds {
    double min[2], max[2];   /* pixels */
    double inverse_depth[2]; /* least and greatest 1 / depth */
    double limit;            /* of 1 / depth: at the near plane for a triangle that passes through it */
} bounds;

static void bounds_add(bounds *box, double x, double y, double depth) {
    box->min[0] = fmin(box->min[0], x / depth);
    box->max[0] = fmax(box->max[0], x / depth);
    box->min[1] = fmin(box->min[1], y / depth);
    box->max[1] = fmax(box->max[1], y / depth);
    box->inverse_depth[0] = fmin(box->inverse_depth[0], 1.0 / depth);
    box->inverse_depth[1] = fmax(box->inverse_depth[1], 1.0 / depth);
}

/* Bounds the part of the triangle beyond the near plane by its corners there and by the points where an
 * edge passes through that plane. False if there is no such part. */
static bool visible_bounds(const double *projected, const uint32_t corners[3], double near_depth,
                           bounds *box) {
    bool any = false;
    *box = (bounds){{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}, HUGE_VAL};
    for (int k = 0; k < 3; k++) {
        const double *a = projected + 3 * (size_t)corners[k],
                     *b = projected + 3 * (size_t)corners[(k + 1) % 3];
        if (a[2] >= near_depth) {
            bounds_add(box, a[0], a[1], a[2]);
            any = true;
        }
        if ((a[2] >= near_depth) != (b[2] >= near_depth)) {
            double t = (near_depth - a[2]) / (b[2] - a[2]);
            bounds_add(box, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), near_depth);
            box->limit = 1.0 / near_depth;
        }
    }
    return any;
}

/* The sample index at or after pixel coordinate x - one sample; anything wild is clamped. */
static uint32_t sample_index(double x, uint32_t samples, uint32_t count) {
    double index = floor(x * samples - 0.5);
    if (!(index > 0.0)) return 0;
    return index < count ? (uint32_t)index : count;
}

static void draw_samples(picture_visibility *visibility, const picture_edges *edges, const bounds *box,
                         uint32_t triangle) {
    uint32_t samples = visibility->samples;
    uint32_t columns = visibility->width * samples, rows = visibility->height * samples;
    uint32_t first_column = sample_index(box->min[0], samples, columns),
             end_column = sample_index(box->max[0] + 2.0 / samples, samples, columns),
             first_row = sample_index(box->min[1], samples, rows),
             end_row = sample_index(box->max[1] + 2.0 / samples, samples, rows);
    double step = 1.0 / samples;
    const double(*edge)[3] = edges->edge;
    for (uint32_t row = first_row; row < end_row; row++) {
        double y = (row + 0.5) * step;
        double r0 = edge[0][1] * y + edge[0][2], r1 = edge[1][1] * y + edge[1][2],
               r2 = edge[2][1] * y + edge[2][2];
        float *inverse_depth = visibility->inverse_depth + (size_t)row * columns;
        uint32_t *triangles = visibility->triangle + (size_t)row * columns;
        for (uint32_t column = first_column; column < end_column; column++) {
            double x = (column + 0.5) * step;
            double e0 = edge[0][0] * x + r0, e1 = edge[1][0] * x + r1, e2 = edge[2][0] * x + r2;
            if (e0 < 0.0 || e1 < 0.0 || e2 < 0.0) continue;
            double exact = (e0 + e1 + e2) / edges->volume;
            if (exact > box->limit) continue;
            /* Rounding throws the depth of a triangle seen nearly edge-on far off; it lies within its
             * bounds. */
            float near = (float)fmin(fmax(exact, box->inverse_depth[0]), box->inverse_depth[1]);
            if (near <= inverse_depth[column]) continue;
            inverse_depth[column] = near;
            triangles[column] = triangle;
        }
    }
}

void picture_visibility_draw(picture_visibility *visibility, const double *projected,
                             const uint32_t *triangles, uint32_t triangle_count, uint32_t first_number,
                             double near_depth) {
    for (uint32_t triangle = 0; triangle < triangle_count; triangle++) {
        const uint32_t *corners = triangles + 3 * (size_t)triangle;
        bounds box;
        picture_edges edges;
        if (visible_bounds(projected, corners, near_depth, &box) &&
            picture_edges_set(projected, corners, &edges))
            draw_samples(visibility, &edges, &box, first_number + triangle);
    }
}
