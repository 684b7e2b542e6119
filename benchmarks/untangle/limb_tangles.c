/* Sequences of one closed body whose limbs come into each other, and of skin that folds at joints. Each begins without
 * intersections. */
#include "benchmarks/untangle/tangle_scene.h"

#include "benchmarks/lib/made_scenes.h"
#include "models/common/vec3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum { LINE_STEPS = 2000, SEQUENCE_FRAMES = 24 };

/* Moves a point at a time from 0 to 1. */
typedef void place_point(const void *user, double t, double p[3]);

/* Every frame is the first one, moved. */
static bool end_sequence(tangle_scene *s, place_point *place, const void *user) {
    tangle_begin_frames(s, SEQUENCE_FRAMES);
    for (uint32_t f = 0; f < SEQUENCE_FRAMES; f++) {
        double *frame = s->frames + (size_t)f * s->vertex_count * 3;
        for (size_t v = 0; v < s->vertex_count; v++)
            place(user, (double)f / (SEQUENCE_FRAMES - 1), frame + 3 * v);
    }
    tangle_round_frames(s);
    return true;
}

/* ---- tubes along a line -------------------------------------------------------------------------------- */

/* Curvature of the line across two directions that are carried along without twist, at s from 0 to 1, times its length. */
typedef void find_curvature(const void *user, double t, double s, double curvature[2]);

/* The line, and directions along and across. */
typedef struct carried_frame {
    double at[3], along[3], across[2][3];
} carried_frame;

static void advance_frame(carried_frame *f, const double curvature[2], double step, double length) {
    vec3_add_scaled(f->at, 0.5 * step * length, f->along);
    for (int i = 0; i < 2; i++) vec3_add_scaled(f->along, step * curvature[i], f->across[i]);
    vec3_normalize(f->along);
    vec3_add_scaled(f->at, 0.5 * step * length, f->along);
    vec3_add_scaled(f->across[0], -vec3_dot(f->across[0], f->along), f->along);
    vec3_normalize(f->across[0]);
    vec3_cross(f->along, f->across[0], f->across[1]);
}

/* Bends what lies along z from -length / 2 to length / 2, straight at both ends, so that its axis follows the line. */
static bool end_tube(tangle_scene *s, double length, find_curvature *curvature, const void *user) {
    carried_frame *line = malloc((LINE_STEPS + 1) * sizeof *line);
    if (line == NULL) return false;
    tangle_begin_frames(s, SEQUENCE_FRAMES);
    for (uint32_t f = 0; f < SEQUENCE_FRAMES; f++) {
        double *p = s->frames + (size_t)f * s->vertex_count * 3, bend[2];
        line[0] = (carried_frame){{0}, {0.0, 0.0, 1.0}, {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
        for (int i = 0; i < LINE_STEPS; i++) {
            line[i + 1] = line[i];
            curvature(user, (double)f / (SEQUENCE_FRAMES - 1), (i + 0.5) / LINE_STEPS, bend);
            advance_frame(&line[i + 1], bend, 1.0 / LINE_STEPS, length);
        }
        for (uint32_t v = 0; v < s->vertex_count; v++, p += 3) {
            const double along = fmin(fmax(p[2] / length + 0.5, 0.0), 1.0) * LINE_STEPS;
            const carried_frame *n = &line[(int)fmin(along, LINE_STEPS - 1)];
            const double rest[3] = {p[0], p[1], p[2] - length * ((double)(n - line) / LINE_STEPS - 0.5)};
            memcpy(p, n->at, sizeof n->at);
            vec3_add_scaled(p, rest[0], n->across[0]);
            vec3_add_scaled(p, rest[1], n->across[1]);
            vec3_add_scaled(p, rest[2], n->along);
        }
    }
    free(line);
    tangle_round_frames(s);
    return true;
}

/* A worm: curvature of a few random waves, which grow. */
typedef struct worm {
    tangle_waves waves[2];
    double most;
} worm;

static void bend_worm(const void *user, double t, double s, double curvature[2]) {
    const worm *w = user;
    for (int i = 0; i < 2; i++) curvature[i] = t * w->most * tangle_wave_height(&w->waves[i], s, 0.0);
}

bool tangle_make_worm(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(1000 + seed);
    const double radius = tangle_random(&state, 0.35, 0.5);
    worm w = {.most = 26.0};
    (void)error;
    for (int i = 0; i < 2; i++) w.waves[i] = tangle_random_waves(&state, 0.7);
    body_add_rod(tangle_add_object(s), triangle_count, radius, 16.0 + 2.0 * radius);
    return end_tube(s, 16.0, bend_worm, &w);
}

/* A hook: one end bends back until it is in the middle. The other end of every second hook is pinned. */
typedef struct hook {
    double from, to, angle, turn;
} hook;

static void bend_hook(const void *user, double t, double s, double curvature[2]) {
    const hook *h = user;
    const double bend = s > h->from && s < h->to ? t * h->angle / (h->to - h->from) : 0.0;
    curvature[0] = bend;
    curvature[1] = h->turn * bend;
}

bool tangle_make_hook(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(1100 + seed);
    const hook h = {.from = tangle_random(&state, 0.35, 0.5),
                    .to = tangle_random(&state, 0.75, 0.85),
                    .angle = tangle_random(&state, 1.2, 1.5) * pi,
                    .turn = tangle_random(&state, -0.1, 0.1)};
    (void)error;
    body_add_rod(tangle_add_object(s), triangle_count, tangle_random(&state, 0.5, 0.8), 18.0);
    if (!end_tube(s, 16.0, bend_hook, &h)) return false;
    if (seed % 2 == 0) tangle_pin_below(s, 3.0);
    return true;
}

/* A ring that closes: both ends meet. */
bool tangle_make_ring(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(1200 + seed);
    const hook h = {.from = 0.0,
                    .to = 1.0,
                    .angle = tangle_random(&state, 2.03, 2.12) * pi,
                    .turn = tangle_random(&state, -0.05, 0.05)};
    const double radius = tangle_random(&state, 0.7, 1.0);
    (void)error;
    body_add_rod(tangle_add_object(s), triangle_count, radius, 16.0 + 2.0 * radius);
    return end_tube(s, 16.0, bend_hook, &h);
}

/* A spring that is pressed together: contact along whole turns. */
typedef struct spring {
    double turns, start_pitch, end_pitch; /* rise in a turn, as a multiple of the turn's length around */
} spring;

static void bend_spring(const void *user, double t, double s, double curvature[2]) {
    const spring *c = user;
    const double pitch = c->start_pitch + t * (c->end_pitch - c->start_pitch), round = 2.0 * pi * c->turns;
    const double torsion = round * pitch / sqrt(1.0 + pitch * pitch),
                 bend = round / sqrt(1.0 + pitch * pitch);
    curvature[0] = bend * cos(torsion * s);
    curvature[1] = bend * sin(torsion * s);
}

bool tangle_make_coil(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(1300 + seed);
    const double turns = tangle_random(&state, 2.2, 4.6), length = 2.0 * pi * turns * 2.0;
    const spring c = {.turns = turns, .start_pitch = 0.3, .end_pitch = tangle_random(&state, 0.06, 0.11)};
    (void)error;
    body_add_rod(tangle_add_object(s), triangle_count, 0.75, length + 1.5);
    return end_tube(s, length, bend_spring, &c);
}

/* ---- bodies that bend ---------------------------------------------------------------------------------- */

/* Bends what is beyond `from` along one axis towards another by an angle over a length. mirrored: on both sides of the
 * first axis's zero. The line that keeps its length is at `neutral`. */
typedef struct body_bend {
    int along, towards;
    double from, length, angle, neutral; /* the angle at t = 1; below 0: the other way */
    bool mirrored;
    double low, high; /* only points with coordinate `limited` in between */
    int limited;
} body_bend;

static void bend_point(const body_bend *b, double t, double p[3]) {
    const double angle = t * b->angle, sign = b->mirrored && p[b->along] < 0.0 ? -1.0 : 1.0;
    const double beyond = sign * p[b->along] - b->from;
    if (angle == 0.0 || beyond <= 0.0 || p[b->limited] < b->low || p[b->limited] > b->high) return;
    const double bent = fmin(beyond, b->length), turned = angle * bent / b->length,
                 radius = b->length / angle;
    const double rest = beyond - bent, out = p[b->towards] - b->neutral;
    p[b->along] = sign * (b->from + radius * sin(turned) + rest * cos(turned) - out * sin(turned));
    p[b->towards] = b->neutral + radius * (1.0 - cos(turned)) + rest * sin(turned) + out * cos(turned);
}

enum { BENDS_MAX = 3 };

/* The first bend is the farthest from what stays. */
typedef struct body_bends {
    body_bend bends[BENDS_MAX];
    int count;
} body_bends;

static void bend_all(const void *user, double t, double p[3]) {
    const body_bends *all = user;
    for (int i = 0; i < all->count; i++) bend_point(&all->bends[i], t, p);
}

/* Fingers bend at two joints until they are in the palm and the ball of the thumb. The wrist of every second hand is
 * pinned. */
bool tangle_make_hand(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(1400 + seed);
    const double side = seed % 2 == 0 ? 1.0 : -1.0;
    const body_bends fist = {
        .count = 2,
        .bends = {{2, 1, 0.92, 0.25, side * tangle_random(&state, 0.9, 1.5), 0.0, false, -1.0, 9.0, 2},
                  {2, 1, 0.5, 0.45, side * tangle_random(&state, 2.9, 3.5), 0.0, false, -1.0, 9.0, 2}}};
    if (!tangle_add_body(s, BODY_HAND, triangle_count, error) || !end_sequence(s, bend_all, &fist))
        return false;
    if (seed % 2 == 0) tangle_pin_below(s, 0.3);
    return true;
}

/* Arms curl up along the way from the axis, into mantle and each other; some more than others. */
typedef struct octopus_curl {
    double length, angle, uneven, twist;
} octopus_curl;

static void curl_octopus(const void *user, double t, double p[3]) {
    const octopus_curl *o = user;
    const double radius = hypot(p[0], p[1]), angle = atan2(p[1], p[0]);
    const double part = 1.0 + o->uneven * cos(3.0 * angle) * fmin(1.0, fmax(0.0, radius - 0.4) / 0.2);
    double flat[3] = {radius, 0.0, p[2]};
    const body_bend bend = {0, 2, 0.45, o->length, o->angle * part, 0.0, false, -9.0, 9.0, 2};
    bend_point(&bend, t, flat);
    const double turned = angle + t * o->twist * fmax(0.0, radius - 0.45);
    p[0] = flat[0] * cos(turned);
    p[1] = flat[0] * sin(turned);
    p[2] = flat[2];
}

bool tangle_make_octopus(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(1500 + seed);
    const octopus_curl o = {.length = tangle_random(&state, 0.4, 0.5),
                            .angle = tangle_random(&state, 2.5, 3.2),
                            .uneven = tangle_random(&state, 0.0, 0.3),
                            .twist = tangle_random(&state, 0.0, 0.5)};
    return tangle_add_body(s, BODY_OCTOPUS, triangle_count, error) && end_sequence(s, curl_octopus, &o);
}

/* Arms of the figure swing down until forearms and hands are in hips and thighs. */
bool tangle_make_figure_arms(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(1600 + seed);
    const body_bends arms = {.count = 1,
                             .bends = {{.along = 0,
                                        .towards = 2,
                                        .from = 0.3,
                                        .length = tangle_random(&state, 0.2, 0.35),
                                        .angle = -tangle_random(&state, 1.0, 1.6),
                                        .neutral = 1.33,
                                        .mirrored = true,
                                        .low = 0.78,
                                        .high = 9.0,
                                        .limited = 2}}};
    return tangle_add_body(s, BODY_FIGURE, triangle_count, error) && end_sequence(s, bend_all, &arms);
}

/* Legs of the figure pass through each other. */
static void close_legs_at(const void *user, double t, double p[3]) {
    const double *most = user;
    const double down = fmin(fmax((0.7 - p[2]) / 0.4, 0.0), 1.0);
    p[0] -= down * down * (3.0 - 2.0 * down) * t * *most * p[0] / sqrt(p[0] * p[0] + 0.0025);
}

bool tangle_make_figure_legs(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    const double most = 0.2 + 0.02 * seed;
    return tangle_add_body(s, BODY_FIGURE, triangle_count, error) && end_sequence(s, close_legs_at, &most);
}

/* U and V: strokes bend into each other; T: its arms bend into its stem. */
bool tangle_make_letter_limbs(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(1700 + seed);
    const double angle = tangle_random(&state, 0.7, 1.0);
    const body_bend down = {0, 2, 0.3, 0.35, -1.9 * angle, 1.75, true, -9.0, 9.0, 2};
    body_bends bends = {.count = 1, .bends = {down}};
    if (seed % 3 == 2)
        return tangle_add_body(s, BODY_LETTER_T, triangle_count, error) && end_sequence(s, bend_all, &bends);
    if (!tangle_add_body(s, seed % 3 == 1 ? BODY_LETTER_U : BODY_LETTER_V, triangle_count, error))
        return false;
    /* Both strokes stand on their sides of x = 0: mirrored by hand. */
    tangle_begin_frames(s, SEQUENCE_FRAMES);
    for (uint32_t f = 0; f < SEQUENCE_FRAMES; f++) {
        for (uint32_t v = 0; v < s->vertex_count; v++) {
            double *p = s->frames + ((size_t)f * s->vertex_count + v) * 3;
            const double side = p[0] < 0.0 ? 1.0 : -1.0;
            const body_bend in = {2, 0, 0.7, 0.6, side * 1.3 * angle, -0.65 * side, false, -9.0, 9.0, 2};
            bend_point(&in, (double)f / (SEQUENCE_FRAMES - 1), p);
            p[1] += side * 0.1 * f / (SEQUENCE_FRAMES - 1) * fmax(0.0, p[2] - 0.7);
        }
    }
    tangle_round_frames(s);
    return true;
}

/* Takes over a made scene of one object as one frame. */
static bool take_made_scene(crossing_kind kind, uint32_t triangle_count, tangle_scene *s, io_error *error) {
    crossing_scene made;
    if (!crossing_scene_make(kind, triangle_count, &made, error)) return false;
    *tangle_add_object(s) = made.objects[0];
    made.objects[0] = (body){0};
    crossing_scene_free(&made);
    tangle_begin_frames(s, 1);
    tangle_round_frames(s);
    return true;
}

/* A closed tube that passes through itself 14 times. */
bool tangle_make_knot(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    (void)seed;
    return take_made_scene(CROSSING_KNOT, triangle_count, s, error);
}

/* ---- folds --------------------------------------------------------------------------------------------- */

enum { JOINTS_MAX = 4 };

/* Linear blend skinning of a limb along z: at each joint the weight of what is beyond rises over a width. */
typedef struct skinned_limb {
    double joints[JOINTS_MAX], widths[JOINTS_MAX], angles[JOINTS_MAX], axes[JOINTS_MAX];
    int count;
} skinned_limb;

/* Turns about an axis across z through the joint. */
static void turn_at_joint(double angle, double axis, double joint, double p[3]) {
    const double c = cos(axis), d = sin(axis), across = p[0] * c + p[1] * d, side = -p[0] * d + p[1] * c,
                 up = p[2] - joint;
    const double turned = across * cos(angle) + up * sin(angle);
    p[2] = joint - across * sin(angle) + up * cos(angle);
    p[0] = turned * c - side * d;
    p[1] = turned * d + side * c;
}

static void skin_limb(const void *user, double t, double p[3]) {
    const skinned_limb *l = user;
    double sum[3] = {0.0, 0.0, 0.0}, left = 1.0;
    for (int bone = l->count; bone >= 0; bone--) {
        const double ramp =
            bone == 0 ? 1.0 : fmin(fmax((p[2] - l->joints[bone - 1]) / l->widths[bone - 1] + 0.5, 0.0), 1.0);
        const double share = left * ramp * ramp * (3.0 - 2.0 * ramp);
        double q[3] = {p[0], p[1], p[2]};
        for (int i = bone - 1; i >= 0; i--) turn_at_joint(t * l->angles[i], l->axes[i], l->joints[i], q);
        vec3_add_scaled(sum, share, q);
        left -= share;
    }
    memcpy(p, sum, sizeof sum);
}

static void add_limb(tangle_scene *s, uint32_t triangle_count, double radius, double length, double flat) {
    body *b = tangle_add_object(s);
    body_add_rod(b, triangle_count, radius, length);
    body_scale(b, 1.0, flat, 1.0);
}

bool tangle_make_elbow(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(1800 + seed);
    const double radius = tangle_random(&state, 0.5, 0.9);
    const skinned_limb l = {.count = 1,
                            .widths = {radius * tangle_random(&state, 0.5, 2.5)},
                            .angles = {tangle_random(&state, 1.7, 2.6)},
                            .axes = {tangle_random(&state, 0.0, pi)}};
    (void)error;
    add_limb(s, triangle_count, radius, 7.0, tangle_random(&state, 0.6, 1.0));
    return end_sequence(s, skin_limb, &l);
}

/* Joints of a finger, about axes that differ a little. */
bool tangle_make_finger(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(1900 + seed);
    skinned_limb l = {.count = 2 + (int)(seed % 2)};
    (void)error;
    for (int i = 0; i < l.count; i++) {
        l.joints[i] = -2.0 + 2.2 * i;
        l.widths[i] = tangle_random(&state, 0.5, 1.2);
        l.angles[i] = tangle_random(&state, 1.4, 2.0);
        l.axes[i] = tangle_random(&state, -0.2, 0.2);
    }
    add_limb(s, triangle_count, 0.7, 9.0, 1.0);
    return end_sequence(s, skin_limb, &l);
}

/* Bodies that bend more narrowly than they are thick: figure, capsule, ellipsoid. */
bool tangle_make_waist(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    static const body_kind kinds[] = {BODY_FIGURE, BODY_CAPSULE, BODY_ELLIPSOID};
    static const double froms[] = {0.98, -0.4, -0.3}, lengths[] = {0.2, 0.8, 0.6};
    static const int along[] = {2, 2, 0}, towards[] = {1, 0, 2};
    uint64_t state = tangle_seed(2000 + seed);
    const uint32_t k = seed % 3;
    const body_bends bow = {
        .count = 1,
        .bends = {{along[k], towards[k], froms[k], lengths[k] * tangle_random(&state, 0.7, 1.2),
                   -tangle_random(&state, 1.9, 2.5), 0.0, false, -9.0, 9.0, 2}}};
    return tangle_add_body(s, kinds[k], triangle_count, error) && end_sequence(s, bend_all, &bow);
}

/* A bumpy torus whose spikes run into the surface beside them: many small curves. */
bool tangle_make_spikes(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    (void)seed;
    return take_made_scene(CROSSING_SCAN, triangle_count, s, error);
}

/* A plank that folds in zigzag until its panels are in each other. All lie between the same two planes, so their sides share
 * area. */
typedef struct zigzag {
    int panels;
    double bend, angle; /* the length of a bend, as a share of the whole, and its angle at last */
} zigzag;

static void fold_zigzag(const void *user, double t, double s, double curvature[2]) {
    const zigzag *z = user;
    const double panel = (1.0 - (z->panels - 1) * z->bend) / z->panels, period = panel + z->bend;
    const double within = fmod(s, period);
    const double way = fmod(s, 2.0 * period) < period ? 1.0 : -1.0;
    curvature[0] = within > panel ? way * t * z->angle / z->bend : 0.0;
    curvature[1] = 0.0;
}

bool tangle_make_meander(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(900 + seed);
    const double thickness = 0.4, length = 12.0;
    const zigzag z = {.panels = 2 + (int)(seed % 3),
                      .bend = pi * 0.75 * thickness / length,
                      .angle = pi * tangle_random(&state, 1.04, 1.1)};
    body *b = tangle_add_object(s);
    (void)error;
    body_add_block(b, triangle_count, (double[3]){thickness, 2.0, length});
    body_move(b, -0.5 * thickness, -1.0, -0.5 * length);
    return end_tube(s, length, fold_zigzag, &z);
}
