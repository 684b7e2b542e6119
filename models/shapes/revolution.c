/* Bodies that are an outline revolved, bent, or linked. */
#include "models/shapes/bodies.h"
#include "models/shapes/rings.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* The outline is a foot with a rounded rim, a waist, a collar below the head, and the head. */
void add_pawn(body *b, uint32_t triangle_count) {
    outline o = {0};
    outline_arc(&o, 0.88, 0.12, 0.12, -90.0, 0.0);
    outline_arc(&o, 0.80, 0.30, 0.20, 0.0, 50.0);
    outline_turn(&o, 1.678, -49.0);
    outline_arc(&o, 0.52, 1.88, 0.09, -90.0, 90.0);
    outline_arc(&o, 0.0, 2.43, 0.54, -51.0, 90.0);
    body_add_rings(b, &o, triangle_count, NULL);
}

void add_dumbbell(body *b, uint32_t triangle_count) {
    outline o = {.end = {0.0, -2.05}};
    outline_arc(&o, 0.0, -1.25, 0.8, -90.0, 68.0);
    outline_arc(&o, 0.0, 1.25, 0.8, -68.0, 90.0);
    body_add_rings(b, &o, triangle_count, NULL);
}

void add_sphere(body *b, uint32_t triangle_count) {
    outline o = {.end = {0.0, -1.0}};
    outline_arc(&o, 0.0, 0.0, 1.0, -90.0, 90.0);
    body_add_rings(b, &o, triangle_count, NULL);
}

static outline capsule_outline(double radius, double straight) {
    outline o = {.end = {0.0, -0.5 * straight - radius}};
    outline_arc(&o, 0.0, -0.5 * straight, radius, -90.0, 0.0);
    outline_arc(&o, 0.0, 0.5 * straight, radius, 0.0, 90.0);
    return o;
}

void add_capsule(body *b, uint32_t triangle_count) {
    outline o = capsule_outline(0.5, 2.0);
    body_add_rings(b, &o, triangle_count, NULL);
}

static outline ring_outline(double major, double minor) {
    outline o = {.closed = true, .end = {major + minor, 0.0}};
    outline_arc(&o, major, 0.0, minor, 0.0, 360.0);
    return o;
}

void add_torus(body *b, uint32_t triangle_count) {
    outline o = ring_outline(1.0, 0.35);
    body_add_rings(b, &o, triangle_count, NULL);
}

/* The axis of the capsule becomes a helix, straight on beyond its ends. Frenet's frame turns about the helix,
 * which the angle makes up for. */
static const double coil_radius = 1.0, coil_pitch = 0.7, coil_turns = 5.0;

static double coil_length(void) {
    return coil_turns * hypot(2.0 * pi * coil_radius, coil_pitch);
}

static void place_on_coil(double radius, double height, double angle, double point[3]) {
    double half = 0.5 * coil_length(), per_turn = coil_length() / coil_turns;
    double along = fmin(fmax(height, -half), half), beyond = height - along;
    double around = 2.0 * pi * along / per_turn, c = cos(around), s = sin(around);
    double flat = 2.0 * pi * coil_radius / per_turn, rise = coil_pitch / per_turn;
    double tangent[3] = {-flat * s, flat * c, rise}, normal[3] = {-c, -s, 0.0};
    double binormal[3] = {rise * s, -rise * c, flat};
    double centre[3] = {coil_radius * c, coil_radius * s, rise * along};
    double turned = angle - around * rise;
    for (int k = 0; k < 3; k++)
        point[k] =
            centre[k] + beyond * tangent[k] + radius * (cos(turned) * normal[k] + sin(turned) * binormal[k]);
}

void add_coil(body *b, uint32_t triangle_count) {
    outline o = capsule_outline(0.2, coil_length());
    body_add_rings(b, &o, triangle_count, place_on_coil);
}

static void place_upright(double radius, double height, double angle, double point[3]) {
    point[0] = radius * cos(angle);
    point[1] = -height;
    point[2] = radius * sin(angle);
}

/* Every second link stands upright; a link's tube passes through the holes of its two neighbours. */
void add_chain(body *b, uint32_t triangle_count) {
    outline o = ring_outline(1.0, 0.22);
    uint32_t halves = triangle_count / 2;
    for (uint32_t i = 0; i < CHAIN_LINKS; i++) {
        body link = {0};
        uint32_t share = halves / CHAIN_LINKS + (i < halves % CHAIN_LINKS);
        body_add_rings(&link, &o, 2 * share, i % 2 == 1 ? place_upright : NULL);
        body_append(b, &link, (double[3]){1.35 * (i - 0.5 * (CHAIN_LINKS - 1)), 0.0, 0.0});
        body_free(&link);
    }
}
