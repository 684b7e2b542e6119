/* The nearest features of a pair: how its nearest points slide along them, and the directions across and along. */
#include "runtime/energy/energy.h"

#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* ---- weights and slides -------------------------------------------------------------------------------- */

/* The slide from one vertex towards another one, of b's points with the sign -1. */
static void add_slide(pair_frame *f, int from, int to, double sign) {
    double *slide = f->slides[f->slide_count++];
    memset(slide, 0, 4 * sizeof *slide);
    slide[from] = -sign;
    slide[to] = sign;
}

/* A nearest point slides along what its vertices with weights span; on the border of a feature some weigh exactly 0. */
static void name_slides(const cscd_proximity *item, pair_frame *f) {
    const double *w = item->weights;
    int on[3], count = 0;
    f->slide_count = 0;
    if (item->kind == CSCD_CONTACT_VF) {
        for (int i = 1; i < 4; i++) {
            if (w[i] < 0.0) on[count++] = i;
        }
        for (int i = 1; i < count; i++) add_slide(f, on[0], on[i], -1.0);
    }
    bool edge_a = item->kind == CSCD_CONTACT_EE || item->kind == CSCD_CONTACT_EV;
    if (edge_a && w[0] > 0.0 && w[1] > 0.0) add_slide(f, 0, 1, 1.0);
    if (item->kind == CSCD_CONTACT_EE && w[2] < 0.0 && w[3] < 0.0) add_slide(f, 2, 3, -1.0);
}

/* The sum of amounts[i] * x[i], where the amounts add up to 0: of differences, which are small where the points are
 * near each other. */
static void combine_points(const double *points[4], const double amounts[4], double out[3]) {
    for (int k = 0; k < 3; k++) {
        double sum = 0.0;
        for (int i = 1; i < 4; i++) sum += amounts[i] * (points[i][k] - points[0][k]);
        out[k] = sum;
    }
}

/* ---- directions ---------------------------------------------------------------------------------------- */

/* Takes off v what it has along the first `count` slides, whose tangents are orthogonal, and changes its weights with it. */
static void take_off(double v[3], double weights[4], const pair_frame *f, int count,
                     const double inverses[2]) {
    double along[2];
    for (int j = 0; j < count; j++) along[j] = vec3_dot(v, f->tangents[j]) * inverses[j];
    for (int j = 0; j < count; j++) {
        vec3_add_scaled(v, -along[j], f->tangents[j], v);
        for (int i = 0; i < 4; i++) weights[i] -= along[j] * f->slides[j][i];
    }
}

/* Makes the tangents orthogonal, of any length, and gives their squared lengths and the inverses of these; a slide along no direction goes
 * away. */
static void straighten_slides(const double *points[4], pair_frame *f, double inverses[2], double squares[2]) {
    int count = 0;
    for (int j = 0; j < f->slide_count; j++) {
        double along[3], slide[4];
        memcpy(slide, f->slides[j], sizeof slide);
        combine_points(points, slide, along);
        double whole = vec3_dot(along, along);
        for (int again = 0; again < 2; again++) take_off(along, slide, f, count, inverses);
        double squared = vec3_dot(along, along);
        if (squared <= LEAST_SQUARED_SINE * whole) continue;
        memcpy(f->tangents[count], along, sizeof along);
        memcpy(f->slides[count], slide, sizeof slide);
        inverses[count] = 1.0 / squared;
        squares[count++] = squared;
    }
    f->slide_count = count;
}

/* Makes the slides those by a unit of length. */
static void shorten_slides(pair_frame *f, const double squares[2]) {
    for (int j = 0; j < f->slide_count; j++) {
        double inverse = 1.0 / sqrt(squares[j]);
        for (int k = 0; k < 3; k++) f->tangents[j][k] *= inverse;
        for (int i = 0; i < 4; i++) f->slides[j][i] *= inverse;
    }
}

static void normalize_vector(double v[3], double length) {
    double inverse = 1.0 / length;
    for (int k = 0; k < 3; k++) v[k] *= inverse;
}

/* A unit vector across a unit vector. */
static void direction_across(const double n[3], double out[3]) {
    int least = fabs(n[0]) <= fabs(n[1]) ? 0 : 1;
    if (fabs(n[2]) < fabs(n[least])) least = 2;
    double axis[3] = {0.0, 0.0, 0.0};
    axis[least] = 1.0;
    vec3_cross(n, axis, out);
    normalize_vector(out, sqrt(vec3_dot(out, out)));
}

/* Completes the tangents: those that no point slides along. */
static void add_tangents(pair_frame *f) {
    if (f->slide_count == 0) direction_across(f->normal, f->tangents[0]);
    if (f->slide_count < 2) vec3_cross(f->normal, f->tangents[0], f->tangents[1]);
}

/* ---- frames -------------------------------------------------------------------------------------------- */

/* The plane's normal is that of the item; its length is 1, up to rounding. */
static void frame_of_half_space(const cscd_proximity *item, const double *points[4], pair_frame *f) {
    double apart[3];
    f->straight = true;
    memcpy(f->normal, item->normal, sizeof f->normal);
    vec3_subtract(points[0], points[1], apart);
    f->distance = vec3_dot(apart, f->normal);
    add_tangents(f);
}

/* The normal of features that touch: the item's, or any other across the tangents. */
static void normal_of_touch(const cscd_proximity *item, pair_frame *f) {
    memcpy(f->normal, item->normal, sizeof f->normal);
    for (int j = 0; j < f->slide_count; j++)
        vec3_add_scaled(f->normal, -vec3_dot(f->normal, f->tangents[j]), f->tangents[j], f->normal);
    double length = sqrt(vec3_dot(f->normal, f->normal));
    if (length > 0.5)
        normalize_vector(f->normal, length);
    else
        direction_across(f->slide_count > 0 ? f->tangents[0] : (const double[3]){0.0, 0.0, 1.0}, f->normal);
}

void pair_frame_find(const cscd_proximity *item, const double *x, pair_frame *f) {
    const double *points[4];
    double apart[3], inverses[2] = {0.0, 0.0}, squares[2];
    for (int i = 0; i < 4; i++) points[i] = x + (size_t)item->vertices[i] * 3;
    f->straight = false;
    memcpy(f->weights, item->weights, sizeof f->weights);
    name_slides(item, f);
    if (item->kind == CSCD_CONTACT_VH) {
        frame_of_half_space(item, points, f);
        return;
    }
    straighten_slides(points, f, inverses, squares);
    combine_points(points, f->weights, apart);
    for (int again = 0; again < 2; again++) /* the second time for what rounding has left */
        take_off(apart, f->weights, f, f->slide_count, inverses);
    if (f->slide_count == 2) {
        vec3_cross(f->tangents[0], f->tangents[1], f->normal);
        /* The tangents' lengths by one root: a b = a^2 sqrt(b^2 / a^2). */
        double height = vec3_dot(apart, f->normal);
        double inverse = 1.0 / (squares[0] * sqrt(squares[1] * inverses[0]));
        if (height < 0.0) inverse = -inverse;
        f->distance = height * inverse;
        for (int k = 0; k < 3; k++) f->normal[k] *= inverse;
        shorten_slides(f, squares);
    } else {
        shorten_slides(f, squares);
        f->distance = sqrt(vec3_dot(apart, apart));
        for (int k = 0; k < 3; k++) f->normal[k] = apart[k];
        if (f->distance > 0.0)
            normalize_vector(f->normal, f->distance);
        else
            normal_of_touch(item, f);
    }
    add_tangents(f);
}
