/* Meshes that are hard to solve for charges, and the table of their solutions. */
#include "benchmarks/lib/charge_trial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- meshes -------------------------------------------------------------------------------------------- */

static const double pi = 0x1.921fb54442d18p+1, nowhere[3] = {0.0, 0.0, 0.0};

/* For a square sheet of edge 1: Read, Improved extrapolation technique in the boundary element method to find
 * the capacitances of the unit square and cube, J. Comput. Phys. 133, 1997. */
static const double sheet_capacitance = 0.366787;

static void scale_body(body *b, double scale) {
    for (size_t i = 0; i < (size_t)b->vertex_count * 3; i++) b->positions[i] *= scale;
}

static bool make_kind(body_kind kind, uint32_t triangles, hard_conductor *out, io_error *error) {
    out->capacitance = exact_capacitance(kind);
    return body_make(kind, triangles, &out->body, error);
}

/* A sphere in latitude and longitude: 4 bands of 1,000 triangles that are 125 times as long as wide. */
static void make_needles(body *b) {
    enum { BANDS = 4, SIDES = 1000 };
    const uint32_t south = body_add_vertex(b, 0.0, 0.0, -1.0), north = body_add_vertex(b, 0.0, 0.0, 1.0);
    for (uint32_t ring = 1; ring < BANDS; ring++) {
        for (uint32_t i = 0; i < SIDES; i++) {
            const double up = pi * ring / BANDS, around = 2.0 * pi * i / SIDES;
            body_add_vertex(b, sin(up) * cos(around), sin(up) * sin(around), -cos(up));
        }
    }
    for (uint32_t i = 0; i < SIDES; i++) {
        const uint32_t next = (i + 1) % SIDES, first = north + 1, last = first + (BANDS - 2) * SIDES;
        body_add_triangle(b, south, first + next, first + i);
        body_add_triangle(b, north, last + i, last + next);
        for (uint32_t below = first; below < last; below += SIDES) {
            body_add_triangle(b, below + i, below + next, below + SIDES + next);
            body_add_triangle(b, below + i, below + SIDES + next, below + SIDES + i);
        }
    }
}

/* Every triangle gets corners of its own, or is there twice. */
static void split_corners(const body *from, body *to) {
    for (size_t i = 0; i < (size_t)from->triangle_count * 3; i += 3) {
        uint32_t corners[3];
        for (size_t k = 0; k < 3; k++) {
            const double *p = from->positions + (size_t)from->triangles[i + k] * 3;
            corners[k] = body_add_vertex(to, p[0], p[1], p[2]);
        }
        body_add_triangle(to, corners[0], corners[1], corners[2]);
    }
}

static void double_triangles(body *b) {
    const uint32_t count = b->triangle_count;
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t v[3] = {b->triangles[(size_t)t * 3], b->triangles[(size_t)t * 3 + 1],
                               b->triangles[(size_t)t * 3 + 2]};
        body_add_triangle(b, v[0], v[1], v[2]);
    }
}

/* A sheet of edge 1, and the number of its first vertex. */
static uint32_t add_sheet(body *b, uint32_t side, double height) {
    const uint32_t first = b->vertex_count;
    for (uint32_t i = 0; i <= side; i++)
        for (uint32_t k = 0; k <= side; k++) body_add_vertex(b, (double)k / side, (double)i / side, height);
    for (uint32_t i = 0; i < side; i++) {
        for (uint32_t k = 0; k < side; k++) {
            const uint32_t a = first + i * (side + 1) + k, c = a + side + 1;
            body_add_triangle(b, a, a + 1, c);
            body_add_triangle(b, c, a + 1, c + 1);
        }
    }
    return first;
}

/* Two sheets on each other, which a triangle at a corner makes one component. */
static void make_sheets(body *b, double distance) {
    const uint32_t low = add_sheet(b, 30, 0.0), high = add_sheet(b, 30, distance);
    body_add_triangle(b, low, low + 1, high);
}

/* A cube of edge 1: two triangles to a face, but 7,200 on the one above. */
static void make_uneven_cube(body *b) {
    enum { SIDE = 60 };
    const uint32_t top = add_sheet(b, SIDE, 1.0);
    const uint32_t high[4] = {top, top + SIDE, top + (SIDE + 1) * SIDE + SIDE, top + (SIDE + 1) * SIDE};
    uint32_t low[4];
    for (uint32_t i = 0; i < 4; i++) {
        const double *p = b->positions + (size_t)high[i] * 3;
        low[i] = body_add_vertex(b, p[0], p[1], 0.0);
    }
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t next = (i + 1) % 4;
        body_add_triangle(b, low[i], low[next], high[next]);
        body_add_triangle(b, low[i], high[next], high[i]);
    }
    body_add_triangle(b, low[0], low[2], low[1]);
    body_add_triangle(b, low[0], low[3], low[2]);
}

/* ---- the list -------------------------------------------------------------------------------------------- */

static bool make_from_sphere(bool twice, hard_conductor *out, io_error *error) {
    body sphere;
    if (!body_make(BODY_SPHERE, 2000, &sphere, error)) return false;
    if (twice) {
        double_triangles(&sphere);
        out->body = sphere;
        out->capacitance = 1.0;
        return true;
    }
    split_corners(&sphere, &out->body);
    body_free(&sphere);
    return true;
}

static bool make_shells(hard_conductor *out, io_error *error) {
    for (double radius = 1.0; radius > 0.2; radius *= 0.5) {
        body sphere;
        if (!body_make(BODY_SPHERE, 2000, &sphere, error)) return false;
        scale_body(&sphere, radius);
        body_append(&out->body, &sphere, nowhere);
        body_free(&sphere);
    }
    out->capacitance = 1.75;
    return true;
}

static bool make_scaled(double scale, hard_conductor *out, io_error *error) {
    if (!make_kind(BODY_ELLIPSOID, 4000, out, error)) return false;
    scale_body(&out->body, scale);
    out->capacitance *= scale;
    return true;
}

static bool make_moved(double distance, hard_conductor *out, io_error *error) {
    if (!make_kind(BODY_ELLIPSOID, 4000, out, error)) return false;
    for (size_t i = 0; i < (size_t)out->body.vertex_count * 3; i++) out->body.positions[i] += distance;
    return true;
}

static bool make_sheet_pair(double distance, hard_conductor *out) {
    make_sheets(&out->body, distance);
    out->capacitance = sheet_capacitance;
    return true;
}

static const char *const names[HARD_CONDUCTORS] = {"needles",
                                                   "unwelded sphere",
                                                   "sphere, every triangle twice",
                                                   "three spheres, one in the other",
                                                   "chain of five tori",
                                                   "ellipsoid, a millionth as large",
                                                   "ellipsoid, a million times as large",
                                                   "ellipsoid, a million away",
                                                   "sheets 1e-2 apart",
                                                   "sheets 1e-4 apart",
                                                   "sheets 1e-6 apart",
                                                   "sheets 1e-8 apart",
                                                   "sheets 1e-10 apart",
                                                   "sheets 1e-12 apart",
                                                   "sheets 1e-14 apart",
                                                   "cube, ten triangles beside 7,200"};

bool hard_conductor_make(uint32_t index, hard_conductor *out, io_error *error) {
    *out = (hard_conductor){.capacitance = NAN};
    snprintf(out->name, sizeof out->name, "%s", names[index]);
    switch (index) {
    case 0:
        make_needles(&out->body);
        return true;
    case 1:
        return make_from_sphere(false, out, error);
    case 2:
        return make_from_sphere(true, out, error);
    case 3:
        return make_shells(out, error);
    case 4:
        return make_kind(BODY_CHAIN, 5000, out, error);
    case 5:
        return make_scaled(1e-6, out, error);
    case 6:
        return make_scaled(1e6, out, error);
    case 7:
        return make_moved(1e6, out, error);
    case 15:
        make_uneven_cube(&out->body);
        out->capacitance = 0.5 * exact_capacitance(BODY_CUBE);
        return true;
    default:
        return make_sheet_pair(pow(10.0, 14.0 - 2.0 * index), out);
    }
}

/* ---- the table ----------------------------------------------------------------------------------------- */

static void print_difference(double value, double other) {
    if (isnan(other))
        printf(" %9s", "-");
    else
        printf(" %9.1e", value / other - 1.0);
}

static void print_row(const hard_conductor *c, const char *solver, const charge_trial *t, double dense) {
    printf("  %-34s %9u %10u %-7s", c->name, c->body.triangle_count, t->components, solver);
    if (t->status != CSCD_OK) {
        printf(" %s after %.3f s: %s\n", cscd_status_string(t->status), t->total_ms / 1e3, t->detail);
        return;
    }
    printf(" %13.8g", t->capacitance);
    print_difference(t->capacitance, c->capacitance);
    print_difference(t->capacitance, dense);
    printf(" %4u %9.3f %9.1f\n", t->iterations, t->total_ms / 1e3, t->peak_bytes / 0x1p20);
    fflush(stdout);
}

static void write_row(json *out, const hard_conductor *c, cscd_charge_solver solver, const charge_trial *t) {
    if (!charge_row_begin(out, "hard", c->name, c->body.triangle_count, solver)) return;
    json_integer(out, "components", t->components);
    json_string(out, "status", cscd_status_string(t->status));
    json_string(out, "detail", t->detail);
    json_number(out, "capacitance", t->status == CSCD_OK ? t->capacitance : NAN);
    json_number(out, "exact", c->capacitance);
    charge_row_end(out, t);
}

static bool run_conductor(const hard_conductor *c, const charge_limits *limits, json *out, io_error *error) {
    static const cscd_charge_solver solvers[] = {CSCD_CHARGE_DENSE, CSCD_CHARGE_TREE, CSCD_CHARGE_COARSE};
    double dense = NAN;
    for (int i = 0; i < 3; i++) {
        const charge_request request = {solvers[i], 1, false};
        charge_trial t;
        if (solvers[i] == CSCD_CHARGE_DENSE && c->body.triangle_count > limits->dense_most) continue;
        if (!charge_trial_run(&c->body, &request, &t, NULL, error)) return false;
        print_row(c, charge_solver_name(solvers[i]), &t, i == 0 ? NAN : dense);
        write_row(out, c, solvers[i], &t);
        if (i == 0 && t.status == CSCD_OK) dense = t.capacitance;
    }
    return true;
}

bool charge_print_hard(const charge_limits *limits, json *out, io_error *error) {
    bool good = true;
    printf("\nhard meshes\n  %-34s %9s %10s %-7s %13s %9s %9s %4s %9s %9s\n", "mesh", "triangles",
           "components", "solver", "capacitance", "of exact", "of dense", "its", "seconds", "peak MiB");
    for (uint32_t i = 0; good && i < HARD_CONDUCTORS; i++) {
        hard_conductor c;
        good = hard_conductor_make(i, &c, error) && run_conductor(&c, limits, out, error);
        body_free(&c.body);
    }
    return good;
}
