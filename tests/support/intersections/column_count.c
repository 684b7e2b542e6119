/* Volumes by columns: along many lines, the parts on which a body has a number. */
#include "tests/support/intersections/column_count.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

enum { PASSES_MAX = 256 };

/* Where a line along z passes through a surface. */
typedef struct column_pass {
    double z;
    int of_a, of_b; /* what the numbers change by, going up */
} column_pass;

typedef struct counted_column {
    double x, y;
    column_pass passes[PASSES_MAX];
    int count;
} counted_column;

static double turn_of(const double *a, const double *b, double x, double y) {
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static void pass_triangle(counted_column *c, const double *p, const double *q, const double *r, bool is_b) {
    double u = turn_of(q, r, c->x, c->y), v = turn_of(r, p, c->x, c->y), w = turn_of(p, q, c->x, c->y);
    bool up = u > 0 && v > 0 && w > 0, down = u < 0 && v < 0 && w < 0;
    if ((!up && !down) || c->count == PASSES_MAX) return;
    double z = (u * p[2] + v * q[2] + w * r[2]) / (u + v + w);
    int change = up ? -1 : 1, i = c->count++;
    for (; i > 0 && c->passes[i - 1].z > z; i--) c->passes[i] = c->passes[i - 1];
    c->passes[i] = (column_pass){z, is_b ? 0 : change, is_b ? change : 0};
}

static void pass_body(counted_column *c, const column_body *body, bool is_b) {
    for (uint32_t t = 0; t < body->triangle_count; t++) {
        const double *p[3];
        for (int i = 0; i < 3; i++) p[i] = body->positions + (size_t)body->triangles[t * 3 + (uint32_t)i] * 3;
        pass_triangle(c, p[0], p[1], p[2], is_b);
    }
}

static double measure_column(const counted_column *c, bool with_b, int least_a) {
    int a = 0, b = 0;
    double length = 0.0;
    for (int i = 0; i + 1 < c->count; i++) {
        a += c->passes[i].of_a;
        b += c->passes[i].of_b;
        if (a >= least_a && (!with_b || b >= 1)) length += c->passes[i + 1].z - c->passes[i].z;
    }
    return length;
}

/* Narrows low and high to the box of a body in x and y. */
static void narrow_to_body(const column_body *body, double low[2], double high[2]) {
    for (int k = 0; k < 2; k++) {
        double least = INFINITY, greatest = -INFINITY;
        for (uint32_t i = 0; i < body->triangle_count * 3; i++) {
            double x = body->positions[(size_t)body->triangles[i] * 3 + (size_t)k];
            least = fmin(least, x);
            greatest = fmax(greatest, x);
        }
        low[k] = fmax(low[k], least);
        high[k] = fmin(high[k], greatest);
    }
}

double column_volume(const column_body *a, const column_body *b, int least_a, int lines) {
    double low[2] = {-INFINITY, -INFINITY}, high[2] = {INFINITY, INFINITY}, sum = 0.0;
    narrow_to_body(a, low, high);
    if (b != NULL) narrow_to_body(b, low, high);
    double step[2] = {(high[0] - low[0]) / lines, (high[1] - low[1]) / lines};
    for (int i = 0; i < lines * lines; i++) {
        counted_column c = {.x = low[0] + (i % lines + 0.5) * step[0],
                            .y = low[1] + (i / lines + 0.5) * step[1]};
        pass_body(&c, a, false);
        if (b != NULL) pass_body(&c, b, true);
        sum += measure_column(&c, b != NULL, least_a);
    }
    return sum * step[0] * step[1];
}
