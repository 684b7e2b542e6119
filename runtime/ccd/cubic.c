/* The cubic whose roots are the times at which four moving points are coplanar, and certified intervals that
 * hold its roots. The roots are guessed, polished, and then proven by the signs of the Bernstein
 * coefficients between them. A wrong or missing guess, or a multiple root, only makes the proof fail. */
#include "runtime/ccd/elementary_levels.h"
#include "src/core/vec3.h"

/* ---- the cubic ----------------------------------------------------------------------------------------- */

static void subtract_at_ends(const elementary_query *query, int to, int from, double out[2][3],
                             double size[3]) {
    vec3_subtract(query->x0[to], query->x0[from], out[0]);
    vec3_subtract(query->x1[to], query->x1[from], out[1]);
    for (int k = 0; k < 3; k++) size[k] = max_of(fabs(out[0][k]), fabs(out[1][k]));
}

void point_vectors_from(const elementary_query *query, cscd_contact_kind kind, point_vectors *out) {
    bool vf = kind == CSCD_CONTACT_VF;
    subtract_at_ends(query, vf ? 2 : 1, vf ? 1 : 0, out->a, out->size_a);
    subtract_at_ends(query, 3, vf ? 1 : 2, out->b, out->size_b);
    subtract_at_ends(query, vf ? 0 : 2, vf ? 1 : 0, out->c, out->size_c);
}

/* Multiplying out the determinant of a + t a', b + t b' and c + t c' gives the coefficients: b0 = f(0), b3 =
 * f(1), and b1 and b2 are a third of the sum of the three determinants with one vector, or two, taken from t
 * = 1.
 *
 * Error: let u = 2^-53, and P the permanent of the components' largest magnitudes, which bounds the sum of
 * the magnitudes of the products in any of these coefficients.
 *     Each product passes 3 subtractions, 2 multiplications, 1 subtraction in the cross product, 1 addition
 *     of cross products, 2 additions in the dot product, 1 addition of dot products and 1 division: 11
 *     roundings. So a coefficient is off by at most P ((1+u)^11 - 1) < 11.1 u P.
 *     Evaluation by blending at three parameters adds 3 multiplications, 3 additions and 3 roundings of 1 - t
 *     to numbers below (1 + 11.1 u) P: at most 9.1 u P.
 * The sum is below 20.2 u P; 24 leaves room for computing P. Each of some 100 operations may lose 2^-1075 to
 * underflow, which 2^-1060 covers. */
coplanarity coplanarity_cubic(const point_vectors *v) {
    coplanarity f;
    double start[3], end[3], one[3], other[3], mixed[3];
    vec3_cross(v->a[0], v->b[0], start);
    vec3_cross(v->a[1], v->b[1], end);
    vec3_cross(v->a[1], v->b[0], one);
    vec3_cross(v->a[0], v->b[1], other);
    for (int k = 0; k < 3; k++) mixed[k] = one[k] + other[k];
    f.b[0] = vec3_dot(start, v->c[0]);
    f.b[1] = (vec3_dot(mixed, v->c[0]) + vec3_dot(start, v->c[1])) / 3.0;
    f.b[2] = (vec3_dot(mixed, v->c[1]) + vec3_dot(end, v->c[0])) / 3.0;
    f.b[3] = vec3_dot(end, v->c[1]);
    double permanent = 0.0;
    for (int k = 0; k < 3; k++) {
        int y = (k + 1) % 3, z = (k + 2) % 3;
        permanent += v->size_c[k] * (v->size_a[y] * v->size_b[z] + v->size_a[z] * v->size_b[y]);
    }
    f.error = 24.0 * 0x1p-53 * permanent + 0x1p-1060;
    return f;
}

bool coplanarity_excluded(const coplanarity *f) {
    const double *b = f->b;
    double error = f->error;
    return (b[0] > error && b[1] > error && b[2] > error && b[3] > error) ||
           (b[0] < -error && b[1] < -error && b[2] < -error && b[3] < -error);
}

/* ---- its roots ----------------------------------------------------------------------------------------- */

enum { POLISH_STEPS = 10, SUBDIVISIONS = 3 };

/* The rounding of t itself moves a root by less than root_rounding. A step of Newton's method shorter than
 * `converged` usually squares the error to less than that. When it does not, the proof fails. */
static const double root_rounding = 0x1p-50, converged = 0x1p-26;

static const double widest_radius = 0x1p-7;

static double blend_linearly(double a, double b, double t) {
    return (1.0 - t) * a + t * b;
}

/* Values of the cubic's polar form at (t, t, 0) and (t, t, 1), by de Casteljau's scheme. Blending them gives
 * values of the cubic and Bernstein coefficients of its parts. */
typedef struct polar_form {
    double low, high;
} polar_form;

static polar_form polar_at(const double b[4], double t) {
    double p0 = blend_linearly(b[0], b[1], t), p1 = blend_linearly(b[1], b[2], t),
           p2 = blend_linearly(b[2], b[3], t);
    return (polar_form){blend_linearly(p0, p1, t), blend_linearly(p1, p2, t)};
}

double cubic_slope(const coplanarity *f, double t) {
    polar_form p = polar_at(f->b, t);
    return 3.0 * (p.high - p.low);
}

/* Writes the coefficients of c[0] + c[1] t + c[2] t^2 + c[3] t^3, times a power of two at which no product of
 * two of them over- or underflows. */
static void to_monomials(const double coefficients[4], double c[4]) {
    int exponent = 0;
    double b[4];
    frexp(max_of(max_of(fabs(coefficients[0]), fabs(coefficients[1])),
                 max_of(fabs(coefficients[2]), fabs(coefficients[3]))),
          &exponent);
    for (int i = 0; i < 4; i++) b[i] = ldexp(coefficients[i], -exponent);
    c[0] = b[0];
    c[1] = 3.0 * (b[1] - b[0]);
    c[2] = 3.0 * (b[0] - 2.0 * b[1] + b[2]);
    c[3] = (b[3] - b[0]) + 3.0 * (b[1] - b[2]);
}

/* Returns the certified sign of the exact cubic on all of [from, to], or 0 if none was found. */
static int sign_between(const coplanarity *f, double from, double to, int subdivisions) {
    polar_form start = polar_at(f->b, from), stop = polar_at(f->b, to);
    double error = f->error;
    double c0 = blend_linearly(start.low, start.high, from), c1 = blend_linearly(start.low, start.high, to);
    double c2 = blend_linearly(stop.low, stop.high, from), c3 = blend_linearly(stop.low, stop.high, to);
    if (c0 > error && c1 > error && c2 > error && c3 > error) return 1;
    if (c0 < -error && c1 < -error && c2 < -error && c3 < -error) return -1;
    if (subdivisions == 0 || !((c0 > error && c3 > error) || (c0 < -error && c3 < -error))) return 0;
    double middle = 0.5 * (from + to);
    int left = sign_between(f, from, middle, subdivisions - 1);
    return left != 0 && left == sign_between(f, middle, to, subdivisions - 1) ? left : 0;
}

/* Newton's method, kept within [low, high]. The cubic has the sign `change` before the root and -change after
 * it; `change` is 0 when that is unknown. Returns false when the method does not converge. */
static bool polish_root(const double b[4], double low, double high, double change, double *t) {
    for (int i = 0; i < POLISH_STEPS; i++) {
        polar_form p = polar_at(b, *t);
        double value = blend_linearly(p.low, p.high, *t), next = *t - value / (3.0 * (p.high - p.low));
        if (change * value > 0.0) low = *t;
        if (change * value < 0.0) high = *t;
        if (!(next >= low && next <= high)) next = 0.5 * (low + high); /* or not a number */
        double step = fabs(next - *t);
        *t = next;
        if (step < converged) return true;
    }
    return false;
}

/* Writes the interval in which rounding leaves the root's place open. Returns false when it is too wide,
 * because the root is multiple, or nearly. */
static bool interval_about(const coplanarity *f, double root, root_interval *out) {
    double radius = 1.25 * (f->error / fabs(cubic_slope(f, root))) + root_rounding;
    *out = (root_interval){.begin = max_of(root - radius, 0.0), .end = min_of(root + radius, 1.0)};
    return radius <= widest_radius;
}

/* Returns the cell of the roots in the interval, or -1 when it reaches into the next cell. */
static double cell_of_roots(const root_interval *interval) {
    double cell = floor(interval->begin / ROOT_CELL) * ROOT_CELL;
    return interval->end < cell + ROOT_CELL ? cell : -1.0;
}

static int guess_intervals(const coplanarity *f, root_interval out[ROOTS_MAX]) {
    double c[4], guesses[3];
    int count = 0;
    to_monomials(f->b, c);
    int guess_count = cubic_guess_roots(c, guesses);
    for (int i = 0; i < guess_count; i++) {
        if (!(guesses[i] > -0x1p-20 && guesses[i] < 1.0 + 0x1p-20)) continue;
        if (!polish_root(f->b, -1.0, 2.0, 0.0, &guesses[i]) || !interval_about(f, guesses[i], &out[count]))
            return ROOTS_UNCERTAIN;
        if (!(out[count].begin < out[count].end)) continue; /* polishing moved it out of [0,1] */
        out[count].toi = cell_of_roots(&out[count]);
        if (count > 0 && !(out[count - 1].end < out[count].begin)) return ROOTS_UNCERTAIN;
        count++;
    }
    return count;
}

static int isolate_by_guesses(const coplanarity *f, root_interval out[ROOTS_MAX]) {
    int count = guess_intervals(f, out), sign = 0;
    double begin = 0.0;
    if (count < 0) return ROOTS_UNCERTAIN;
    for (int i = 0; i <= count; i++) {
        double end = i < count ? out[i].begin : 1.0;
        int next = begin < end ? sign_between(f, begin, end, SUBDIVISIONS) : 0;
        if (next == 0 && begin < end) return ROOTS_UNCERTAIN;
        if (i > 0) out[i - 1].certain = sign * next < 0;
        sign = next;
        if (i < count) begin = out[i].end;
    }
    return count;
}

/* Returns 1 when the Bernstein coefficients change sign once, whatever their errors, from positive to
 * negative, and -1 when they change it once from negative to positive: then there is exactly one root in
 * [0,1], and it is simple. Returns 0 otherwise. */
static int single_change(const coplanarity *f) {
    const double *b = f->b;
    double error = f->error;
    if (b[0] > error && b[3] < -error) return b[1] > error || b[2] < -error ? 1 : 0;
    if (b[0] < -error && b[3] > error) return b[1] < -error || b[2] > error ? -1 : 0;
    return 0;
}

/* Isolates the root in [low, high], from a guess. At the ends the cubic has the opposite signs `change` and
 * -change, and between them it has exactly one root. */
static bool isolate_between(const coplanarity *f, double low, double high, double change, double root,
                            root_interval *out) {
    if (!polish_root(f->b, low, high, change, &root) || !interval_about(f, root, out)) return false;
    out->begin = max_of(out->begin, low);
    out->end = min_of(out->end, high);
    out->toi = out->begin;
    out->certain = true;
    polar_form begin = polar_at(f->b, out->begin), end = polar_at(f->b, out->end);
    return change * blend_linearly(begin.low, begin.high, out->begin) > f->error &&
           change * blend_linearly(end.low, end.high, out->end) < -f->error;
}

/* Guesses where the cubic is least, if it first falls and rises in the end. That is a root of its slope,
 * whose Bernstein coefficients over 3 are d0 < 0, d1 and d2 > 0. The formula takes ratios, which do not
 * overflow. */
static double lowest_at(const double b[4]) {
    double d0 = b[1] - b[0], d1 = b[2] - b[1], d2 = b[3] - b[2];
    double half = (d0 - d1) / d0, square = ((d1 - d0) - (d2 - d1)) / d0;
    double root = sqrt(half * half + square);
    return half >= 0.0 ? 1.0 / (half + root) : (root - half) / square;
}

/* Isolates the roots of a cubic that certainly has the same sign at both ends, and so two roots or none. The
 * coefficients of the parts before and after the place where it is nearest to 0 must say which for certain.
 */
static int isolate_two(const coplanarity *f, root_interval out[ROOTS_MAX]) {
    double sign = f->b[0] > 0.0 ? 1.0 : -1.0, error = f->error;
    coplanarity g = {.error = error};
    for (int i = 0; i < 4; i++) g.b[i] = sign * f->b[i];
    const double *b = g.b;
    double t = lowest_at(b);
    if (!(b[0] > error && b[3] > error && t > 0.0 && t < 1.0)) return ROOTS_UNCERTAIN;
    polar_form p = polar_at(b, t);
    double first = blend_linearly(b[0], b[1], t), last = blend_linearly(b[2], b[3], t),
           value = blend_linearly(p.low, p.high, t);
    if (first > error && p.low > error && value > error && p.high > error && last > error) return 0;
    if (!(value < -error && (first > error || p.low < -error) && (last > error || p.high < -error)))
        return ROOTS_UNCERTAIN;
    double left = t * (b[0] / (b[0] - value)), right = 1.0 - (1.0 - t) * (b[3] / (b[3] - value));
    bool both =
        isolate_between(&g, 0.0, t, 1.0, left, &out[0]) && isolate_between(&g, t, 1.0, -1.0, right, &out[1]);
    return both ? 2 : ROOTS_UNCERTAIN;
}

int cubic_isolate(const coplanarity *f, root_interval out[ROOTS_MAX]) {
    int change = single_change(f), two;
    if (change != 0 && isolate_between(f, 0.0, 1.0, change, f->b[0] / (f->b[0] - f->b[3]), out)) return 1;
    if (change == 0 && (two = isolate_two(f, out)) != ROOTS_UNCERTAIN) return two;
    return isolate_by_guesses(f, out);
}
