/* Shapes of revolution, joints, and what turns when. */
#include "models/mannequin/mannequin.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* The arm hangs almost straight down; these are in metres. */
static const double trunk_radius = 0.17, arm_radius = 0.045, elbow_x = 0.35, elbow_y = 1.34, forearm = 0.3,
                    upper_arm = 0.22, elbow_blend = 0.07, gap_at_rest = 0.13;

#define ELBOW_X    0.35
#define ELBOW_Y    1.34
#define SHOULDER_Y 1.56

const mannequin_joint mannequin_joints[BONE_COUNT] = {
    [BONE_TRUNK] = {"trunk", -1, {0.0, 1.0, 0.0}, 1},
    [BONE_HEAD] = {"head", BONE_TRUNK, {0.0, 1.72, 0.0}, 0},
    [BONE_EYE_L] = {"eye.L", BONE_HEAD, {0.05, 1.89, 0.12}, 1},
    [BONE_EYE_R] = {"eye.R", BONE_HEAD, {-0.05, 1.89, 0.12}, 1},
    [BONE_UPPER_ARM_L] = {"upper_arm.L", BONE_TRUNK, {ELBOW_X, SHOULDER_Y, 0.0}, 2},
    [BONE_FOREARM_L] = {"forearm.L", BONE_UPPER_ARM_L, {ELBOW_X, ELBOW_Y, 0.0}, 2},
    [BONE_UPPER_ARM_R] = {"upper_arm.R", BONE_TRUNK, {-ELBOW_X, SHOULDER_Y, 0.0}, 2},
    [BONE_FOREARM_R] = {"forearm.R", BONE_UPPER_ARM_R, {-ELBOW_X, ELBOW_Y, 0.0}, 2},
    [BONE_LEG_L] = {"leg.L", BONE_TRUNK, {0.09, 0.66, 0.0}, 0},
    [BONE_LEG_R] = {"leg.R", BONE_TRUNK, {-0.09, 0.66, 0.0}, 0},
};

const char *const mannequin_part_names[MANNEQUIN_PARTS] = {
    [PART_TRUNK] = "Trunk", [PART_HEAD] = "Head",   [PART_EYE_L] = "Eye.L", [PART_EYE_R] = "Eye.R",
    [PART_TEETH] = "Teeth", [PART_BELT] = "Belt",   [PART_ARM_L] = "Arm.L", [PART_ARM_R] = "Arm.R",
    [PART_LEG_L] = "Leg.L", [PART_LEG_R] = "Leg.R",
};

/* ---- motion -------------------------------------------------------------------------------------------- */

/* The angle of a forearm to the vertical at which its wrist has that distance from the trunk. */
static double forearm_angle(double gap) {
    return asin((elbow_x - trunk_radius - arm_radius - gap) / forearm);
}

/* A forearm comes, is `depth` deep in the trunk at the frame in the middle, and goes. */
static double swing_forearm(int frame, double middle, double width, double depth) {
    const double t = fmin(fabs(frame - middle) / width, 1.0);
    const double gap = gap_at_rest - (gap_at_rest + depth) * 0.5 * (1.0 + cos(pi * t));
    return forearm_angle(gap) - forearm_angle(gap_at_rest);
}

double mannequin_angle(int bone, int frame) {
    const double sway = sin(2.0 * pi * frame / MANNEQUIN_FRAMES);
    switch (bone) {
    case BONE_HEAD:
        return 0.08 * sway;
    case BONE_EYE_L:
    case BONE_EYE_R:
        return 0.45 * sin(4.0 * pi * frame / MANNEQUIN_FRAMES);
    case BONE_FOREARM_L: /* within the trunk where the cosine is above 0: 7.5 frames to both sides */
        return -swing_forearm(frame, 24.0, 15.0, gap_at_rest);
    case BONE_FOREARM_R: /* where it is above 0.07 / 0.19: 4.56 frames to both sides */
        return swing_forearm(frame, 40.0, 12.0, 0.06);
    case BONE_LEG_L:
        return 0.15 * sway;
    case BONE_LEG_R:
        return -0.15 * sway;
    default:
        return 0.0;
    }
}

typedef struct bone_motion {
    double turn[3][3], place[3]; /* a point p at rest is at turn (p - joint) + place */
} bone_motion;

static void turn_point(const bone_motion *motion, const double p[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = motion->place[i];
        for (int j = 0; j < 3; j++) out[i] += motion->turn[i][j] * p[j];
    }
}

static void move_bones(int frame, bone_motion motions[BONE_COUNT]) {
    for (int b = 0; b < BONE_COUNT; b++) {
        const mannequin_joint *joint = &mannequin_joints[b];
        const double angle = mannequin_angle(b, frame), s = sin(angle), c = cos(angle);
        const int k = joint->axis, l = (k + 1) % 3, m = (k + 2) % 3;
        double own[3][3] = {{0.0}};
        own[k][k] = 1.0;
        own[l][l] = own[m][m] = c;
        own[l][m] = -s;
        own[m][l] = s;
        bone_motion *motion = &motions[b];
        if (joint->parent < 0) {
            memcpy(motion->turn, own, sizeof own);
            memcpy(motion->place, joint->place, sizeof motion->place);
            continue;
        }
        const mannequin_joint *above = &mannequin_joints[joint->parent];
        const bone_motion *parent = &motions[joint->parent];
        double offset[3];
        for (int i = 0; i < 3; i++) offset[i] = joint->place[i] - above->place[i];
        turn_point(parent, offset, motion->place);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                motion->turn[i][j] = 0.0;
                for (int n = 0; n < 3; n++) motion->turn[i][j] += parent->turn[i][n] * own[n][j];
            }
    }
}

void mannequin_pose(const mannequin *m, int frame, double (*positions)[3]) {
    bone_motion motions[BONE_COUNT];
    move_bones(frame, motions);
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        double moved[2][3];
        for (int k = 0; k < 2; k++) {
            const int bone = m->bones[v][k];
            double offset[3];
            for (int i = 0; i < 3; i++) offset[i] = m->positions[v][i] - mannequin_joints[bone].place[i];
            turn_point(&motions[bone], offset, moved[k]);
        }
        const double w = m->weights[v];
        for (int i = 0; i < 3; i++) positions[v][i] = (1.0 - w) * moved[0][i] + w * moved[1][i];
    }
}

/* ---- surfaces ------------------------------------------------------------------------------------------ */

static uint32_t add_point(mannequin *m, const double p[3], int bone) {
    assert(m->vertex_count < MANNEQUIN_VERTICES_MAX);
    const uint32_t v = m->vertex_count++;
    for (int i = 0; i < 3; i++) m->positions[v][i] = (float)p[i];
    m->bones[v][0] = m->bones[v][1] = (uint8_t)bone;
    m->weights[v] = 0.0f;
    return v;
}

static void add_triangle(mannequin *m, uint32_t a, uint32_t b, uint32_t c) {
    assert(m->triangle_count < MANNEQUIN_TRIANGLES_MAX);
    uint32_t *corners = m->triangles[m->triangle_count++];
    corners[0] = a;
    corners[1] = b;
    corners[2] = c;
}

/* A capsule: balls around the points from and from + length axis, and what lies between. around: corners of its rings,
 * caps: rings of a half ball, rows: of the cylinder. */
typedef struct capsule_shape {
    double from[3], axis[3], length, radius;
    int around, caps, rows;
    int bone;
} capsule_shape;

/* The place of a ring along the axis, and its radius. */
static void place_ring(const capsule_shape *s, int ring, double *along, double *radius) {
    const int last = 2 * s->caps + s->rows;
    const int from_end = ring < last - ring ? ring : last - ring;
    const double polar = from_end < s->caps ? 0.5 * pi * from_end / s->caps : 0.5 * pi;
    *radius = s->radius * sin(polar);
    if (ring <= s->caps)
        *along = -s->radius * cos(polar);
    else if (ring >= last - s->caps)
        *along = s->length + s->radius * cos(polar);
    else
        *along = s->length * (ring - s->caps) / s->rows;
}

static void add_capsule(mannequin *m, const capsule_shape *s) {
    /* Two directions across the axis: one of the coordinate axis that is least along it. */
    int least = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(s->axis[i]) < fabs(s->axis[least])) least = i;
    double across[2][3], length = 0.0;
    for (int i = 0; i < 3; i++) across[0][i] = (i == least) - s->axis[least] * s->axis[i];
    for (int i = 0; i < 3; i++) length += across[0][i] * across[0][i];
    for (int i = 0; i < 3; i++) across[0][i] /= sqrt(length);
    for (int i = 0; i < 3; i++)
        across[1][i] =
            s->axis[(i + 1) % 3] * across[0][(i + 2) % 3] - s->axis[(i + 2) % 3] * across[0][(i + 1) % 3];
    const int rings = 2 * s->caps + s->rows + 1;
    uint32_t before = 0;
    for (int ring = 0; ring < rings; ring++) {
        double along, radius;
        place_ring(s, ring, &along, &radius);
        const bool pole = ring == 0 || ring == rings - 1;
        const uint32_t first = m->vertex_count;
        for (int i = 0; i < (pole ? 1 : s->around); i++) {
            const double angle = 2.0 * pi * (i + 0.5 * (ring % 2)) / s->around;
            double p[3];
            for (int k = 0; k < 3; k++)
                p[k] = s->from[k] + along * s->axis[k] +
                       (pole ? 0.0 : radius * (cos(angle) * across[0][k] + sin(angle) * across[1][k]));
            add_point(m, p, s->bone);
        }
        for (int i = 0; i < s->around && ring > 0; i++) {
            const uint32_t n = (uint32_t)s->around, a = (uint32_t)i, b = (a + 1) % n;
            if (ring == 1) {
                add_triangle(m, before, first + b, first + a);
            } else if (pole) {
                add_triangle(m, before + a, before + b, first);
            } else if (ring % 2 == 1) { /* odd rings are half a step ahead */
                add_triangle(m, before + a, before + b, first + a);
                add_triangle(m, first + a, before + b, first + b);
            } else {
                add_triangle(m, before + a, before + b, first + b);
                add_triangle(m, before + a, first + b, first + a);
            }
        }
        before = first;
    }
}

/* A ring around the trunk, whose tube has eight corners. */
static void add_belt(mannequin *m, double height) {
    enum { AROUND = 32, TUBE = 6 };
    const uint32_t first = m->vertex_count;
    for (uint32_t i = 0; i < AROUND; i++) {
        for (uint32_t j = 0; j < TUBE; j++) {
            const double angle = 2.0 * pi * (i + 0.25) / AROUND, tube = 2.0 * pi * (j + 0.25) / TUBE;
            const double radius = trunk_radius + 0.02 * cos(tube);
            add_point(m, (double[3]){radius * cos(angle), height + 0.02 * sin(tube), radius * sin(angle)},
                      BONE_TRUNK);
            const uint32_t a = first + i * TUBE, b = first + (i + 1) % AROUND * TUBE, k = (j + 1) % TUBE;
            add_triangle(m, a + j, a + k, b + j);
            add_triangle(m, b + j, a + k, b + k);
        }
    }
}

/* An arm from the shoulder down, whose skin follows both bones around the elbow. */
static void add_arm(mannequin *m, double side, int upper_bone, int forearm_bone) {
    const double angle = forearm_angle(gap_at_rest);
    const double axis[3] = {-side * sin(angle), -cos(angle), 0.0};
    const uint32_t first = m->vertex_count;
    const capsule_shape shape = {{side * elbow_x - upper_arm * axis[0], elbow_y - upper_arm * axis[1], 0.0},
                                 {axis[0], axis[1], axis[2]},
                                 upper_arm + forearm,
                                 arm_radius,
                                 16,
                                 3,
                                 12,
                                 upper_bone};
    add_capsule(m, &shape);
    for (uint32_t v = first; v < m->vertex_count; v++) {
        const double along =
            (m->positions[v][0] - side * elbow_x) * axis[0] + (m->positions[v][1] - elbow_y) * axis[1];
        const double t = fmin(fmax(0.5 + 0.5 * along / elbow_blend, 0.0), 1.0);
        m->bones[v][1] = (uint8_t)forearm_bone;
        m->weights[v] = (float)(t * t * (3.0 - 2.0 * t));
    }
}

static void add_part(mannequin *m, int part) {
    switch (part) {
    case PART_TRUNK:
        add_capsule(m, &(capsule_shape){{0, 0.95, 0}, {0, 1, 0}, 0.5, trunk_radius, 28, 5, 5, BONE_TRUNK});
        break;
    case PART_HEAD:
        add_capsule(m, &(capsule_shape){{0, 1.86, 0}, {0, 1, 0}, 0.0, 0.14, 20, 6, 0, BONE_HEAD});
        break;
    case PART_EYE_L:
        add_capsule(m, &(capsule_shape){{0.05, 1.89, 0.12}, {0, 0, 1}, 0.0, 0.03, 10, 4, 0, BONE_EYE_L});
        break;
    case PART_EYE_R:
        add_capsule(m, &(capsule_shape){{-0.05, 1.89, 0.12}, {0, 0, 1}, 0.0, 0.03, 10, 4, 0, BONE_EYE_R});
        break;
    case PART_TEETH:
        add_capsule(m, &(capsule_shape){{-0.03, 1.8, 0.122}, {1, 0, 0}, 0.06, 0.012, 8, 2, 3, BONE_HEAD});
        break;
    case PART_BELT:
        add_belt(m, 0.95);
        break;
    case PART_ARM_L:
        add_arm(m, 1.0, BONE_UPPER_ARM_L, BONE_FOREARM_L);
        break;
    case PART_ARM_R:
        add_arm(m, -1.0, BONE_UPPER_ARM_R, BONE_FOREARM_R);
        break;
    case PART_LEG_L:
        add_capsule(m, &(capsule_shape){{0.09, 0.12, 0}, {0, 1, 0}, 0.54, 0.07, 12, 3, 6, BONE_LEG_L});
        break;
    default:
        add_capsule(m, &(capsule_shape){{-0.09, 0.12, 0}, {0, 1, 0}, 0.54, 0.07, 12, 3, 6, BONE_LEG_R});
    }
}

void mannequin_make(mannequin *m) {
    *m = (mannequin){.vertex_count = 0};
    for (int part = 0; part < MANNEQUIN_PARTS; part++) {
        add_part(m, part);
        m->first_vertex[part + 1] = m->vertex_count;
        m->first_triangle[part + 1] = m->triangle_count;
    }
}
