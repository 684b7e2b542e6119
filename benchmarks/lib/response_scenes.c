/* Scenes that press and pull, by position based dynamics with springs along edges and across them. */
#include "benchmarks/lib/response_scenes.h"

#include "models/cloth/cloth_scene.h"
#include "models/common/vec3.h"
#include "models/shapes/catalogue.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum { SOLVER_PASSES = 12 };

static const char *const kind_names[RESPONSE_KIND_COUNT] = {"twist",  "press", "bounce", "stack",
                                                            "sleeve", "bag",   "knot"};

const char *response_kind_name(response_kind kind) {
    return kind_names[kind];
}

/* ---- shapes -------------------------------------------------------------------------------------------- */

static body *add_object(response_scene *s) {
    return &s->objects[s->object_count++];
}

static void lift_body(body *b, double height) {
    for (uint32_t v = 0; v < b->vertex_count; v++) b->positions[3 * (size_t)v + 2] += height;
}

static uint32_t side_of_sheet(uint32_t triangle_count) {
    return 1 + (uint32_t)lround(sqrt(0.5 * triangle_count));
}

/* The centre line of a rope with a loose overhand knot, for t from 0 to 1, and its two straight ends. */
static void knot_line(double t, double p[3]) {
    double a = 2.0 * pi * (1.25 * (t - 0.5)), reach = 1.0 + 6.0 * pow(fabs(2.0 * t - 1.0), 4.0);
    p[0] = (sin(a) + 2.0 * sin(2.0 * a)) * 0.3 + (t - 0.5) * reach;
    p[1] = (cos(a) - 2.0 * cos(2.0 * a)) * 0.3 * (1.0 - pow(fabs(2.0 * t - 1.0), 6.0));
    p[2] = -0.3 * sin(3.0 * a) * (1.0 - pow(fabs(2.0 * t - 1.0), 6.0));
}

/* A tube about the line with `around` vertices a ring, and a cap at each end. */
static void add_rope(body *b, uint32_t rings, uint32_t around, double radius) {
    double across[3] = {0.0, 0.0, 1.0};
    for (uint32_t i = 0; i < rings; i++) {
        double before[3], here[3], after[3], along[3], other[3];
        knot_line((i - 0.5) / (rings - 1), before);
        knot_line((double)i / (rings - 1), here);
        knot_line((i + 0.5) / (rings - 1), after);
        vec3_subtract(after, before, along);
        vec3_normalize(along);
        vec3_add_scaled(across, -vec3_dot(across, along), along);
        vec3_normalize(across);
        vec3_cross(along, across, other);
        for (uint32_t j = 0; j < around; j++) {
            double c = radius * cos(2.0 * pi * j / around), d = radius * sin(2.0 * pi * j / around);
            body_add_vertex(b, here[0] + c * across[0] + d * other[0], here[1] + c * across[1] + d * other[1],
                            here[2] + c * across[2] + d * other[2]);
        }
    }
    for (uint32_t i = 0; i + 1 < rings; i++) {
        for (uint32_t j = 0; j < around; j++) {
            uint32_t v = i * around + j, w = i * around + (j + 1) % around;
            body_add_triangle(b, v, w, w + around);
            body_add_triangle(b, v, w + around, v + around);
        }
    }
    for (uint32_t j = 1; j + 1 < around; j++) {
        uint32_t last = (rings - 1) * around;
        body_add_triangle(b, 0, j + 1, j);
        body_add_triangle(b, last, last + j, last + j + 1);
    }
}

static bool add_ball(response_scene *s, uint32_t triangle_count, double radius, double height,
                     io_error *error) {
    body *ball = add_object(s);
    if (!garment_add_ball(ball, triangle_count, radius, error)) return false;
    lift_body(ball, height);
    return true;
}

static void add_plate(response_scene *s, double reach, double height) {
    body *plate = add_object(s);
    garment_add_box(plate, reach);
    lift_body(plate, height);
}

static void add_sheets(response_scene *s, uint32_t count, uint32_t triangle_count, double height,
                       double gap) {
    for (uint32_t i = 0; i < count; i++) {
        body *sheet = add_object(s);
        garment_add_sheet(sheet, side_of_sheet(triangle_count / count), 1.0);
        for (uint32_t v = 0; v < sheet->vertex_count; v++) {
            double *p = sheet->positions + 3 * (size_t)v, turn = 0.3 * i, x = p[0];
            p[0] = cos(turn) * x - sin(turn) * p[1];
            p[1] = sin(turn) * x + cos(turn) * p[1];
        }
        lift_body(sheet, height + gap * i);
    }
}

static bool make_objects(response_scene *s, uint32_t triangle_count, io_error *error) {
    uint32_t columns = 2 + (uint32_t)lround(sqrt(triangle_count / 4.0)), around = 12;
    bool good = true;
    switch (s->kind) {
    case RESPONSE_TWIST:
        add_sheets(s, 1, triangle_count, 0.32, 0.0);
        s->free_object_count = s->object_count;
        return add_ball(s, 1280, 0.25, 0.0, error);
    case RESPONSE_PRESS:
        good = add_ball(s, triangle_count, 0.5, 0.53, error);
        s->free_object_count = s->object_count;
        add_plate(s, 1.0, 0.0);
        add_plate(s, 1.0, 1.27);
        return good;
    case RESPONSE_BOUNCE:
        good = add_ball(s, triangle_count, 0.5, 0.8, error);
        s->free_object_count = s->object_count;
        add_plate(s, 2.0, 0.0);
        return good;
    case RESPONSE_STACK:
        add_sheets(s, 6, triangle_count, 0.05, 0.05);
        s->free_object_count = s->object_count;
        add_plate(s, 2.0, 0.0);
        return true;
    case RESPONSE_SLEEVE:
        garment_add_tube(add_object(s), triangle_count / 2 * 2, 0.15, 1.0);
        s->free_object_count = s->object_count;
        return true;
    case RESPONSE_BAG: {
        body *bag = add_object(s);
        garment_add_bag(bag, columns, columns, 0.8, 0.8, 0.1);
        s->seams = garment_bag_seams(columns, columns, &s->seam_count);
        lift_body(bag, 0.3);
        s->free_object_count = s->object_count;
        return add_ball(s, 1280, 0.25, 0.0, error);
    }
    default:
        add_rope(add_object(s), triangle_count / (2 * around), around, 0.09);
        s->free_object_count = s->object_count;
        return true;
    }
}

/* ---- springs ------------------------------------------------------------------------------------------- */

typedef struct sheet_side {
    uint32_t low, high, opposite;
} sheet_side;

static int compare_sides(const void *left, const void *right) {
    const sheet_side *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    return (a->opposite > b->opposite) - (a->opposite < b->opposite);
}

static void add_spring(response_scene *s, uint32_t a, uint32_t b, double stiffness) {
    double between[3];
    vec3_subtract(s->rest + 3 * (size_t)a, s->rest + 3 * (size_t)b, between);
    s->springs[s->spring_count++] = (response_spring){a, b, vec3_norm(between), stiffness};
}

/* A spring along each edge, and a weaker one across it. */
static void make_springs(response_scene *s) {
    size_t sides_max = 0, count = 0;
    for (uint32_t o = 0; o < s->free_object_count; o++) sides_max += 3 * (size_t)s->objects[o].triangle_count;
    sheet_side *sides = body_allocate(sides_max, sizeof *sides);
    uint32_t first = 0;
    for (uint32_t o = 0; o < s->free_object_count; first += s->objects[o++].vertex_count) {
        const body *b = &s->objects[o];
        for (size_t i = 0; i < 3 * (size_t)b->triangle_count; i++) {
            const uint32_t *v = b->triangles + i / 3 * 3;
            uint32_t from = first + v[i % 3], to = first + v[(i + 1) % 3];
            sides[count++] =
                (sheet_side){from < to ? from : to, from < to ? to : from, first + v[(i + 2) % 3]};
        }
    }
    qsort(sides, count, sizeof *sides, compare_sides);
    s->springs = body_allocate(2 * count, sizeof *s->springs);
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        bool again = i > 0 && sides[i].low == sides[i - 1].low && sides[i].high == sides[i - 1].high;
        if (again) {
            add_spring(s, sides[i].opposite, sides[i - 1].opposite, s->kind == RESPONSE_KNOT ? 0.5 : 0.1);
        } else {
            add_spring(s, sides[i].low, sides[i].high, 0.9);
            sum += s->springs[s->spring_count - 1].rest;
        }
    }
    size_t edges = 0;
    for (uint32_t i = 0; i < s->spring_count; i++) edges += s->springs[i].stiffness == 0.9;
    s->spacing = sum / (double)edges;
    free(sides);
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

/* The ends of tubes and ropes are held. */
static void choose_grips(response_scene *s) {
    for (uint32_t v = 0; v < s->free_count; v++) {
        double z = s->rest[3 * (size_t)v + 2], x = s->rest[3 * (size_t)v];
        s->inverse_masses[v] = 1.0;
        if (s->kind == RESPONSE_SLEEVE && (z < 0.02 || z > 0.98))
            s->roles[v] = z < 0.5 ? ROLE_FIRST_GRIP : ROLE_SECOND_GRIP;
        if (s->kind == RESPONSE_KNOT && fabs(x) > 3.2)
            s->roles[v] = x < 0.0 ? ROLE_FIRST_GRIP : ROLE_SECOND_GRIP;
        if (s->roles[v] != ROLE_FREE) s->inverse_masses[v] = 0.0;
    }
}

static void join_objects(response_scene *s) {
    for (uint32_t o = 0; o < s->object_count; o++) {
        s->vertex_count += s->objects[o].vertex_count;
        s->triangle_count += s->objects[o].triangle_count;
        if (o < s->free_object_count) s->free_count += s->objects[o].vertex_count;
    }
    size_t count = 3 * (size_t)s->vertex_count;
    double **arrays[] = {&s->rest, &s->x, &s->velocities, &s->target};
    for (size_t i = 0; i < 4; i++) *arrays[i] = body_allocate(count, sizeof(double));
    s->inverse_masses = body_allocate(s->vertex_count, sizeof(double));
    s->roles = body_allocate(s->vertex_count, 1);
    double *to = s->rest;
    for (uint32_t o = 0; o < s->object_count; o++) {
        size_t size = 3 * (size_t)s->objects[o].vertex_count;
        memcpy(to, s->objects[o].positions, size * sizeof *to);
        to += size;
    }
    memcpy(s->x, s->rest, count * sizeof *s->x);
}

bool response_scene_make(response_kind kind, uint32_t triangle_count, response_scene *out, io_error *error) {
    response_scene s = {.kind = kind, .frame_seconds = 1.0 / 60.0, .gravity = 9.81, .friction = 0.3};
    if (!make_objects(&s, triangle_count, error)) {
        response_scene_free(&s);
        return false;
    }
    join_objects(&s);
    make_springs(&s);
    choose_grips(&s);
    if (kind == RESPONSE_PRESS) s.pressure = 20.0;
    if (kind == RESPONSE_BOUNCE) s.pressure = 60.0;
    if (kind == RESPONSE_KNOT) s.pressure = 30.0;
    if (kind == RESPONSE_SLEEVE || kind == RESPONSE_KNOT) s.gravity = 0.0;
    for (uint32_t v = 0; kind == RESPONSE_BOUNCE && v < s.free_count; v++)
        s.velocities[3 * (size_t)v + 2] = -6.0;
    *out = s;
    return true;
}

void response_scene_free(response_scene *s) {
    for (uint32_t o = 0; o < RESPONSE_OBJECTS_MAX; o++) body_free(&s->objects[o]);
    void *arrays[] = {s->seams, s->roles,      s->springs, s->rest,
                      s->x,     s->velocities, s->target,  s->inverse_masses};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    *s = (response_scene){0};
}

/* ---- one frame ----------------------------------------------------------------------------------------- */

static double ramp_share(double time, double begin, double seconds) {
    return fmax(0.0, fmin((time - begin) / seconds, 1.0));
}

static void turn_about_z(const double from[3], double angle, double to[3]) {
    double c = cos(angle), d = sin(angle);
    to[0] = c * from[0] - d * from[1];
    to[1] = d * from[0] + c * from[1];
    to[2] = from[2];
}

/* Obstacles and grips move as the clock says. */
static void place_given(const response_scene *s, double time, double *x) {
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        const double *from = s->rest + 3 * (size_t)v;
        double *to = x + 3 * (size_t)v, side = s->roles[v] == ROLE_FIRST_GRIP ? -1.0 : 1.0;
        if (v < s->free_count && s->roles[v] == ROLE_FREE) continue;
        memcpy(to, from, sizeof(double[3]));
        if (s->kind == RESPONSE_TWIST) turn_about_z(from, 2.0 * pi * ramp_share(time, 0.6, 2.4), to);
        if (s->kind == RESPONSE_PRESS && from[2] > 1.0) to[2] -= 0.9 * ramp_share(time, 0.2, 2.0);
        if (s->kind == RESPONSE_SLEEVE) {
            turn_about_z(from, side * 1.5 * pi * ramp_share(time, 0.0, 2.5), to);
            to[2] -= side * 0.15 * ramp_share(time, 0.0, 2.5);
        }
        if (s->kind == RESPONSE_KNOT) to[0] += side * 1.5 * ramp_share(time, 0.0, 3.0);
    }
}

static double volume_of(const response_scene *s, const double *x) {
    double sum = 0.0;
    const body *b = &s->objects[0];
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const uint32_t *v = b->triangles + 3 * (size_t)t;
        double across[3];
        vec3_cross(x + 3 * (size_t)v[1], x + 3 * (size_t)v[2], across);
        sum += vec3_dot(x + 3 * (size_t)v[0], across) / 6.0;
    }
    return sum;
}

/* A gas in the first object pushes its triangles outwards, the more the smaller its volume is. */
static void press_out(const response_scene *s, double *velocities) {
    if (s->pressure == 0.0) return;
    const body *b = &s->objects[0];
    double excess = volume_of(s, s->rest) / volume_of(s, s->x) - 0.9;
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const uint32_t *v = b->triangles + 3 * (size_t)t;
        double along[3], other[3], normal[3];
        vec3_subtract(s->x + 3 * (size_t)v[1], s->x + 3 * (size_t)v[0], along);
        vec3_subtract(s->x + 3 * (size_t)v[2], s->x + 3 * (size_t)v[0], other);
        vec3_cross(along, other, normal);
        double scale = s->pressure * excess * s->frame_seconds / (6.0 * s->spacing * s->spacing);
        for (int i = 0; i < 3; i++) vec3_add_scaled(velocities + 3 * (size_t)v[i], scale, normal);
    }
}

static void solve_spring(const response_scene *s, const response_spring *spring, double *x) {
    double *a = x + 3 * (size_t)spring->a, *b = x + 3 * (size_t)spring->b, between[3];
    double mobility = s->inverse_masses[spring->a] + s->inverse_masses[spring->b];
    vec3_subtract(a, b, between);
    double length = vec3_norm(between);
    if (mobility == 0.0 || length == 0.0) return;
    double share = spring->stiffness * (spring->rest - length) / (length * mobility);
    vec3_add_scaled(a, share * s->inverse_masses[spring->a], between);
    vec3_add_scaled(b, -share * s->inverse_masses[spring->b], between);
}

static void sew_seams(const response_scene *s, double *x) {
    for (uint32_t i = 0; i < s->seam_count; i++) {
        double *a = x + 3 * (size_t)s->seams[2 * i], *b = x + 3 * (size_t)s->seams[2 * i + 1];
        for (int k = 0; k < 3; k++) a[k] = b[k] = a[k] == b[k] ? a[k] : 0.5 * (a[k] + b[k]);
    }
}

void response_scene_aim(response_scene *s) {
    double *x = s->target;
    press_out(s, s->velocities);
    memcpy(x, s->x, 3 * (size_t)s->vertex_count * sizeof *x);
    for (uint32_t v = 0; v < s->free_count; v++) {
        double *velocity = s->velocities + 3 * (size_t)v;
        if (s->inverse_masses[v] == 0.0) continue;
        velocity[2] -= s->gravity * s->frame_seconds;
        for (int k = 0; k < 3; k++) velocity[k] *= 0.995;
        vec3_add_scaled(x + 3 * (size_t)v, s->frame_seconds, velocity);
    }
    place_given(s, s->clock + s->frame_seconds, x);
    for (int pass = 0; pass < SOLVER_PASSES; pass++) {
        for (uint32_t i = 0; i < s->spring_count; i++) solve_spring(s, &s->springs[i], x);
        sew_seams(s, x);
    }
}

void response_scene_take(response_scene *s, const double *reached, double obstacle_share) {
    for (size_t i = 0; i < 3 * (size_t)s->free_count; i++)
        s->velocities[i] = (reached[i] - s->x[i]) / s->frame_seconds;
    memcpy(s->x, reached, 3 * (size_t)s->vertex_count * sizeof *reached);
    s->clock += obstacle_share * s->frame_seconds;
}
