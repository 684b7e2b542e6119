/* A moving vertex and a half-space whose normal is fixed and whose plane moves with a point: exact at
 * distance 0, and with a distance by bounds, since the vertex's height above the plane is linear in time. */

#include "runtime/ccd/ccd.h"

#include "src/core/integer.h"
#include "src/core/vec3.h"

#include <string.h>

/* ---- heights --------------------------------------------------------------------------------------------- */

/* The sum of n_k (x_k - p_k): the height times the normal's length. */
typedef struct scaled_height {
    double value, error;
} scaled_height;

/* A product is off by 2^-53 for the difference and as much for itself, and the sums by as much of what is
 * added: below 5 * 2^-53 of the sum of magnitudes, which is itself off by less. Nothing over- or underflows:
 * a coordinate that is not 0 is at least 2^-300, and a difference 2^-352. */
static scaled_height scaled_height_of(const double x[2][3], const double normal[3]) {
    double sum = 0.0, magnitude = 0.0;
    for (int k = 0; k < 3; k++) {
        double part = normal[k] * (x[0][k] - x[1][k]);
        sum += part;
        magnitude += fabs(part);
    }
    return (scaled_height){sum, magnitude * 0x1p-50};
}

static double length_of(const double normal[3]) {
    return sqrt(vec3_dot(normal, normal));
}

/* The length is off by 4 * 2^-53 of itself, and the quotients by 2^-53. */
plane_height half_space_height(const double x[2][3], const double normal[3]) {
    scaled_height scaled = scaled_height_of(x, normal);
    double length = length_of(normal), offset[3];
    vec3_subtract(x[0], x[1], offset);
    double value = scaled.value / length;
    return (plane_height){value, scaled.error / length * (1.0 + 0x1p-40) + fabs(value) * 0x1p-50,
                          vec3_largest(offset)};
}

/* A height that the vertex certainly has. */
static double least_height(const double x[2][3], const double normal[3]) {
    plane_height height = half_space_height(x, normal);
    return height.value - height.error;
}

/* ---- by integers --------------------------------------------------------------------------------------- */

static int least_exponent(const double *x, int count, int least) {
    for (int i = 0; i < count; i++) {
        int lowest = x[i] != 0.0 ? integer_lowest_bit(x[i]) : least;
        least = lowest < least ? lowest : least;
    }
    return least;
}

/* The heights at both ends as integers, in one unit. */
static void exact_heights(integer_pool *pool, const half_space_query *q, integer heights[2]) {
    const double(*ends[2])[3] = {q->x0, q->x1};
    int exponent = least_exponent(&q->x1[0][0], 6, least_exponent(&q->x0[0][0], 6, INT32_MAX));
    int of_normal = least_exponent(q->normal, 3, INT32_MAX);
    for (int e = 0; e < 2; e++) {
        integer sum = integer_from_int(pool, 0);
        for (int k = 0; k < 3; k++) {
            integer offset = integer_subtract(pool, integer_from_double(pool, ends[e][0][k], exponent),
                                              integer_from_double(pool, ends[e][1][k], exponent));
            integer part = integer_multiply(pool, integer_from_double(pool, q->normal[k], of_normal), offset);
            sum = integer_add(pool, sum, part);
        }
        heights[e] = sum;
    }
}

/* ---- touching ------------------------------------------------------------------------------------------ */

/* The heights at the ends from exact arithmetic or, if they are far beyond their errors, from bounds. */
typedef struct plane_crossing {
    bool touching;
    elementary_level level;
    double toi;
} plane_crossing;

/* Returns a / (a + b) for a > 0 and b >= 0, a little less. Nothing cancels, so a share of 2^-48 covers the
 * rounding. */
static double share_of_sum(double a, double b) {
    return a / (a + b) * (1.0 - 0x1p-48);
}

static plane_crossing cross_exactly(const half_space_query *q) {
    integer_pool pool;
    integer heights[2];
    integer_pool_start(&pool);
    exact_heights(&pool, q, heights);
    int start = integer_sign(heights[0]), end = integer_sign(heights[1]), a_exponent, b_exponent;
    if (start <= 0) return (plane_crossing){true, ELEMENTARY_EXACT, 0.0};
    if (end > 0) return (plane_crossing){false, ELEMENTARY_EXACT, 0.0};
    double a = integer_to_double(heights[0], &a_exponent);
    double b = fabs(integer_to_double(heights[1], &b_exponent));
    int larger = a_exponent > b_exponent || b == 0.0 ? a_exponent : b_exponent;
    double toi = share_of_sum(ldexp(a, a_exponent - larger), b == 0.0 ? 0.0 : ldexp(b, b_exponent - larger));
    return (plane_crossing){true, ELEMENTARY_EXACT, toi};
}

/* Heights that are right to this share give a time that is right to less than 2^-34. */
static const double fine_share = 0x1p-36;

static plane_crossing cross_plane(const half_space_query *q) {
    scaled_height start = scaled_height_of(q->x0, q->normal), end = scaled_height_of(q->x1, q->normal);
    if (start.value > start.error && end.value > end.error)
        return (plane_crossing){false, ELEMENTARY_SIGNS, 0.0};
    if (start.value < -start.error) return (plane_crossing){true, ELEMENTARY_SIGNS, 0.0};
    bool fine = start.error < fine_share * start.value && end.error < -fine_share * end.value;
    if (!fine) return cross_exactly(q);
    double toi = share_of_sum(start.value - start.error, end.error - end.value);
    return (plane_crossing){true, ELEMENTARY_SIGNS, toi};
}

static double blend_ends(double start, double end, double t) {
    return (1.0 - t) * start + t * end;
}

/* The contact at a time: on the way from the vertex to the plane, in the middle. */
static void describe_height(const half_space_query *q, double toi, elementary_contact *contact) {
    double length = length_of(q->normal), x[2][3];
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) x[i][k] = blend_ends(q->x0[i][k], q->x1[i][k], toi);
    }
    double height = scaled_height_of((const double(*)[3])x, q->normal).value / length;
    *contact = (elementary_contact){.toi = toi};
    for (int k = 0; k < 3; k++) {
        contact->normal[k] = q->normal[k] / length;
        contact->point[k] = x[0][k] - 0.5 * height * contact->normal[k];
    }
}

/* A caller that steps to a time computes positions in doubles, each off by at most 2^-52 of the largest
 * coordinate C; two of them are along the normal off by less than 4 sqrt 3 of that. Twice as much is left
 * open, as in contact_frame.c. */
static double leave_gap(const half_space_query *q, double toi) {
    double largest = 0.0;
    for (int i = 0; i < 2; i++)
        largest = max_of(largest, max_of(vec3_largest(q->x0[i]), vec3_largest(q->x1[i])));
    double speed = scaled_height_of(q->x0, q->normal).value - scaled_height_of(q->x1, q->normal).value;
    double earlier = 0x1p-48 * largest * length_of(q->normal) / speed;
    return speed > 0.0 ? max_of(toi - min_of(earlier, 0x1p-32), 0.0) : toi;
}

elementary_verdict half_space_touch(const half_space_query *q, elementary_contact *contact) {
    plane_crossing found = cross_plane(q);
    if (found.touching) describe_height(q, found.toi > 0.0 ? leave_gap(q, found.toi) : 0.0, contact);
    return (elementary_verdict){found.touching, found.level};
}

/* ---- with a distance ----------------------------------------------------------------------------------- */

/* Heights are linear in time, so a number that is below them at both ends is so in between, and where it is
 * the distance the vertex is no nearer before. The errors, 2^-48 of the extent, are well within the
 * tolerance. */
bool half_space_within(const half_space_query *q, double distance, elementary_contact *contact) {
    double start = least_height(q->x0, q->normal), end = least_height(q->x1, q->normal);
    if (start > distance && end > distance) return false;
    double toi = start > distance ? share_of_sum(start - distance, distance - end) : 0.0;
    describe_height(q, toi, contact);
    return true;
}

/* ---- floors (docs/theory/floors.md) -------------------------------------------------------------------- */

/* Returns a number that the height surely exceeds. */
static double sure_height(const double x[2][3], const double normal[3], const floor_ladder *ladder,
                          double *finest) {
    plane_height height = half_space_height(x, normal);
    *finest = FLOOR_FINEST * height.extent;
    return (height.value - height.error - *finest) / (1.0 + ladder->tolerance);
}

/* The height is linear, so it stays above the floor if it surely exceeds it at both ends. */
floor_verdict half_space_floor_test(const half_space_query *q, const floor_ladder *ladder,
                                    elementary_contact *contact) {
    double finest, finest_at_end;
    double start = sure_height(q->x0, q->normal, ladder, &finest);
    if (!(start > finest)) return FLOOR_NONE;
    double floor = separation_floor_rung(ladder, start);
    if (floor < finest) return FLOOR_NONE;
    if (memcmp(q->x0, q->x1, sizeof q->x0) == 0) return FLOOR_KEPT;
    double end = sure_height(q->x1, q->normal, ladder, &finest_at_end);
    if (end > floor) return FLOOR_KEPT;
    describe_height(q, 1.0, contact);
    contact->toi = min_of(max_of((start - floor) / (start - end), 0.0), 1.0);
    return FLOOR_BROKEN;
}

/* ---- gaps (docs/theory/displacement-bounds.md) --------------------------------------------------------- */

/* By integers: with the height h = n.(x - p) / |n|, the gap h - s is ((n.(x - p))^2 - s^2 |n|^2) / ((h + s)
 * |n|^2). */
static double exact_plane_gap(const double x[2][3], const double normal[3], double length) {
    integer_pool pool;
    integer sum, squared, limit;
    int exponent = least_exponent(&length, 1, least_exponent(&x[0][0], 6, INT32_MAX));
    int of_normal = least_exponent(normal, 3, INT32_MAX), above_exponent, sum_exponent;
    if (exponent == INT32_MAX) return 0.0; /* both points are 0 */
    integer_pool_start(&pool);
    sum = squared = integer_from_int(&pool, 0);
    for (int k = 0; k < 3; k++) {
        integer n = integer_from_double(&pool, normal[k], of_normal);
        integer offset = integer_subtract(&pool, integer_from_double(&pool, x[0][k], exponent),
                                          integer_from_double(&pool, x[1][k], exponent));
        sum = integer_add(&pool, sum, integer_multiply(&pool, n, offset));
        squared = integer_add(&pool, squared, integer_multiply(&pool, n, n));
    }
    limit = integer_from_double(&pool, length, exponent);
    limit = integer_multiply(&pool, integer_multiply(&pool, limit, limit), squared);
    integer above = integer_subtract(&pool, integer_multiply(&pool, sum, sum), limit);
    if (integer_sign(sum) <= 0 || integer_sign(above) <= 0) return 0.0;
    double numerator = integer_to_double(above, &above_exponent),
           height = integer_to_double(sum, &sum_exponent);
    double divisor = ldexp(height, sum_exponent + exponent + of_normal) + length * length_of(normal);
    int divisor_exponent;
    divisor = frexp(divisor * length_of(normal), &divisor_exponent);
    double gap = ldexp(numerator / divisor, above_exponent + 2 * (exponent + of_normal) - divisor_exponent);
    return gap * (1.0 - 0x1p-40) >= 0x1p-352 ? gap * (1.0 - 0x1p-40) : 0.0;
}

double half_space_gap(const double x[2][3], const double normal[3], double length) {
    plane_height height = half_space_height(x, normal);
    double error = height.error + 0x1p-52 * length, gap = height.value - length;
    if (gap < -error) return 0.0;
    if (gap * 0x1p-10 > error) return gap - error;
    return exact_plane_gap(x, normal, length);
}

/* A sum of products with powers of two is off as scaled_height_of says. */
double half_space_plane(const double x[2][3], const double normal[3], pair_plane *out) {
    int exponent;
    *out = (pair_plane){.gap = 0.0};
    frexp(vec3_largest(normal), &exponent);
    for (int k = 0; k < 3; k++) out->normal[k] = ldexp(normal[k], 1 - exponent);
    scaled_height height = scaled_height_of(x, out->normal);
    out->height[0] = out->low_a = height.value;
    out->gap = height.value - height.error;
    out->distance = height.value + height.error;
    return length_of(out->normal) * (1.0 + 0x1p-40);
}
