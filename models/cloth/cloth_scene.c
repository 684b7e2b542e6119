/* The scenes of the cloth simulator: garments and obstacles as meshes, and which garment falls how, onto what. */
#include "models/cloth/cloth_scene.h"

#include "models/shapes/catalogue.h"
#include "models/shapes/rings.h"

#include <math.h>
#include <string.h>

/* ---- sheets, tubes, boxes and balls as meshes ---------------------------------------------------------- */

/* Adds two triangles for each cell of a lattice of vertices, which stand in rows from `first` on. turned:
 * counter-clockwise seen from the other side. */
static void add_cells(body *b, uint32_t first, uint32_t columns, uint32_t rows, bool turned) {
    for (uint32_t j = 0; j + 1 < rows; j++) {
        for (uint32_t i = 0; i + 1 < columns; i++) {
            uint32_t v00 = first + j * columns + i, v10 = v00 + 1, v01 = v00 + columns, v11 = v01 + 1;
            uint32_t left = turned ? v01 : v10, right = turned ? v10 : v01;
            bool rising = (i + j) % 2 == 0;
            body_add_triangle(b, v00, left, rising ? v11 : right);
            body_add_triangle(b, rising ? v00 : left, v11, right);
        }
    }
}

void garment_add_sheet(body *b, uint32_t side, double width) {
    uint32_t first = b->vertex_count;
    double spacing = width / (side - 1);
    for (uint32_t j = 0; j < side; j++) {
        for (uint32_t i = 0; i < side; i++)
            body_add_vertex(b, i * spacing - 0.5 * width, j * spacing - 0.5 * width, 0.0);
    }
    add_cells(b, first, side, side, false);
    body_round(b);
}

void garment_add_bag(body *b, uint32_t columns, uint32_t rows, double width, double height, double depth) {
    for (int side = 0; side < 2; side++) {
        uint32_t first = b->vertex_count;
        for (uint32_t j = 0; j < rows; j++) {
            double up = (double)j / (rows - 1), open = 1.0 - up * up;
            for (uint32_t i = 0; i < columns; i++) {
                double across = 2.0 * i / (columns - 1) - 1.0, bulge = depth * open * (1.0 - across * across);
                body_add_vertex(b, 0.5 * width * across, side == 0 ? 0.0 - bulge : bulge, height * up);
            }
        }
        add_cells(b, first, columns, rows, side == 1);
    }
    body_round(b);
}

uint32_t *garment_bag_seams(uint32_t columns, uint32_t rows, uint32_t *pair_count) {
    uint32_t *seams = body_allocate(2 * (2 * (size_t)rows + columns), sizeof *seams), count = 0;
    for (uint32_t v = 0; v < columns * rows; v++) {
        uint32_t column = v % columns, row = v / columns;
        if (column > 0 && column + 1 < columns && row + 1 < rows) continue;
        seams[2 * count] = v;
        seams[2 * count++ + 1] = columns * rows + v;
    }
    *pair_count = count;
    return seams;
}

void garment_add_tube(body *b, uint32_t triangle_count, double radius, double height) {
    const double rim = 0.15 * radius;
    outline o = {.end = {0.0, 0.0}};
    outline_arc(&o, radius - rim, rim, rim, -90.0, 0.0);
    outline_arc(&o, radius - rim, height - rim, rim, 0.0, 90.0);
    outline_line(&o, 0.0, height);
    body_add_rings(b, &o, triangle_count, NULL);
    body_round(b);
}

/* The bits of a corner's number, 0 to 7, are its x, y and z. */
void garment_add_box(body *b, double reach) {
    static const uint8_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const double thickness = 0.1 * reach;
    uint32_t first = b->vertex_count;
    for (uint32_t i = 0; i < 8; i++)
        body_add_vertex(b, i & 1 ? reach : -reach, i & 2 ? reach : -reach, i & 4 ? 0.0 : -thickness);
    for (uint32_t i = 0; i < 6; i++) {
        const uint8_t *s = sides[i];
        body_add_triangle(b, first + s[0], first + s[1], first + s[2]);
        body_add_triangle(b, first + s[0], first + s[2], first + s[3]);
    }
    body_round(b);
}

bool garment_add_ball(body *b, uint32_t triangle_count, double radius, io_error *error) {
    body sphere;
    if (!body_make(BODY_SPHERE, body_nearest_count(BODY_SPHERE, triangle_count), &sphere, error))
        return false;
    for (uint32_t i = 0; i < sphere.vertex_count * 3; i++) sphere.positions[i] *= radius;
    body_append(b, &sphere, (double[3]){0.0, 0.0, 0.0});
    body_round(b);
    body_free(&sphere);
    return true;
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

enum { BALL_TRIANGLES = 1280 };

static const double pi = 3.14159265358979323846;

const cloth_scene cloth_scenes[] = {
    {
        .name = "cloth-drape",
        .text = "a sheet falls onto a ball, which sinks and turns until the sheet lies in folds on the floor",
        .cut = CLOTH_SHEET,
        .width = 1.8,
        .resolution = 60,
        .place = {0.05, -0.03, 1.05},
        .turn = 0.15,
        .lean = 0.03,
        .stuff = {.density = 0.15, .stretch = 400.0, .bending = 2e-4, .damping = 3e-3, .drag = 2.5},
        .friction = 0.4,
        .gravity = 10.0,
        .obstacle_count = 2,
        .obstacles = {{.kind = CLOTH_BOX, .size = 3.0},
                      {.kind = CLOTH_BALL,
                       .size = 0.35,
                       .centre = {0.0, 0.0, 0.65},
                       .begin = 1.0,
                       .seconds = 1.6,
                       .rise = -0.22,
                       .turn = 1.7}},
        .frame_count = 320,
        .frame_seconds = 0.01,
        .small_steps = 12,
    },
    {
        .name = "sleeve",
        .text = "a closed sleeve collapses in folds on itself, and a ball presses it down",
        .cut = CLOTH_TUBE,
        .width = 0.5,
        .height = 1.3,
        .resolution = 60,
        .place = {0.0, 0.0, 0.02},
        .turn = 0.1,
        .lean = 0.01,
        .stuff = {.density = 0.15, .stretch = 400.0, .bending = 4e-4, .damping = 3e-3, .drag = 2.5},
        .friction = 0.4,
        .gravity = 10.0,
        .obstacle_count = 2,
        .obstacles =
            {{.kind = CLOTH_BOX, .size = 3.0},
             {.kind = CLOTH_BALL, .size = 0.25, .centre = {0.03, 0.02, 1.65}, .seconds = 1.5, .rise = -1.27}},
        .frame_count = 240,
        .frame_seconds = 0.01,
        .small_steps = 12,
    },
    {
        .name = "bag",
        .text = "a bag sewn of two panels falls over a ball, which turns and lifts it",
        .cut = CLOTH_BAG,
        .width = 0.9,
        .height = 0.9,
        .depth = 0.25,
        .resolution = 45,
        .place = {0.02, 0.01, 0.56},
        .turn = 0.3,
        .lean = 0.02,
        .stuff = {.density = 0.15, .stretch = 400.0, .bending = 2e-4, .damping = 3e-3, .drag = 2.5},
        .friction = 0.6,
        .gravity = 10.0,
        .obstacle_count = 2,
        .obstacles = {{.kind = CLOTH_BOX, .size = 3.0},
                      {.kind = CLOTH_BALL,
                       .size = 0.18,
                       .centre = {0.0, 0.0, 0.36},
                       .begin = 0.9,
                       .seconds = 1.2,
                       .rise = 0.3,
                       .turn = 1.5}},
        .frame_count = 260,
        .frame_seconds = 0.01,
        .small_steps = 12,
    },
};

const uint32_t cloth_scene_count = sizeof cloth_scenes / sizeof *cloth_scenes;

const cloth_scene *cloth_scene_find(const char *name) {
    for (uint32_t i = 0; i < cloth_scene_count; i++) {
        if (strcmp(cloth_scenes[i].name, name) == 0) return &cloth_scenes[i];
    }
    return NULL;
}

/* A bag needs an odd number of columns. */
static uint32_t bag_columns(uint32_t resolution) {
    return resolution | 1;
}

static uint32_t bag_rows(const cloth_scene *s, uint32_t resolution) {
    return 1 | (uint32_t)(s->height / cloth_scene_spacing(s, resolution) + 1.0);
}

double cloth_scene_spacing(const cloth_scene *s, uint32_t resolution) {
    if (s->cut == CLOTH_TUBE) return s->width * pi / resolution;
    return s->width / ((s->cut == CLOTH_BAG ? bag_columns(resolution) : resolution) - 1);
}

/* Rotates two coordinates; `tangent` is that of half the angle. This needs no sines, whose last bits
 * differ between libraries. */
static void turn_plane(double tangent, double *x, double *y) {
    double square = tangent * tangent, c = (1.0 - square) / (1.0 + square),
           s = 2.0 * tangent / (1.0 + square);
    double turned = c * *x - s * *y;
    *y = s * *x + c * *y;
    *x = turned;
}

/* Adds a tube of even triangles whose sides are as long as the spacing. */
static void add_tube(const cloth_scene *s, uint32_t resolution, body *b) {
    double spacing = cloth_scene_spacing(s, resolution), radius = 0.5 * s->width;
    double area = 2.0 * pi * radius * (s->height + radius);
    garment_add_tube(b, 2 * (uint32_t)(area / (0.5 * sqrt(3.0) * spacing * spacing)), radius, s->height);
}

uint32_t *cloth_scene_seams(const cloth_scene *s, uint32_t resolution, uint32_t *pair_count) {
    *pair_count = 0;
    return s->cut == CLOTH_BAG
               ? garment_bag_seams(bag_columns(resolution), bag_rows(s, resolution), pair_count)
               : NULL;
}

body cloth_scene_garment(const cloth_scene *s, uint32_t resolution) {
    body b = {0};
    if (s->cut == CLOTH_SHEET) garment_add_sheet(&b, resolution, s->width);
    if (s->cut == CLOTH_TUBE) add_tube(s, resolution, &b);
    if (s->cut == CLOTH_BAG)
        garment_add_bag(&b, bag_columns(resolution), bag_rows(s, resolution), s->width, s->height, s->depth);
    for (uint32_t v = 0; v < b.vertex_count; v++) {
        double *p = b.positions + v * 3;
        turn_plane(s->turn, &p[0], &p[1]);
        turn_plane(s->lean, &p[1], &p[2]);
        for (int k = 0; k < 3; k++) p[k] += s->place[k];
    }
    body_round(&b);
    return b;
}

bool cloth_obstacle_make(const cloth_obstacle *o, body *out, io_error *error) {
    body made = {0};
    if (o->kind == CLOTH_BOX) garment_add_box(&made, o->size);
    if (o->kind == CLOTH_BALL && !garment_add_ball(&made, BALL_TRIANGLES, o->size, error)) return false;
    *out = made;
    return true;
}

void cloth_obstacle_place(const cloth_obstacle *o, const body *shape, double time, double *positions) {
    double part = o->seconds > 0.0 ? fmin(fmax((time - o->begin) / o->seconds, 0.0), 1.0) : 0.0;
    double done = part * part * (3.0 - 2.0 * part);
    for (uint32_t v = 0; v < shape->vertex_count; v++) {
        double *p = positions + v * 3;
        memcpy(p, shape->positions + v * 3, 3 * sizeof *p);
        turn_plane(done * o->turn, &p[0], &p[1]);
        for (int k = 0; k < 3; k++) p[k] += o->centre[k] + (k == 2 ? done * o->rise : 0.0);
    }
}
