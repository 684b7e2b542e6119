/* Scenes for the programs that we are compared with: one mesh, and the positions at both ends of an
 * interval. */
#include "benchmarks/peers/peer_scenes.h"

#include "benchmarks/lib/made_scenes.h"
#include "tool/io/animation.h"
#include "tool/io/mesh_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_LENGTH = 4096 };

void peer_scene_free(peer_scene *s) {
    free(s->triangles);
    free(s->start);
    free(s->end);
    *s = (peer_scene){.name = ""};
}

/* ---- files ------------------------------------------------------------------------------------------- */

/* Takes the triangles and positions of a mesh, which is freed. The end is still to be written. */
static void take_mesh(mesh_file *mesh, peer_scene *out) {
    out->vertex_count = mesh->vertex_count;
    out->triangle_count = mesh->triangle_count;
    out->triangles = mesh->triangles;
    out->start = mesh->positions;
    out->end = body_allocate((size_t)mesh->vertex_count * 3, sizeof *out->end);
    mesh->triangles = NULL;
    mesh->positions = NULL;
    mesh_file_free(mesh);
}

static void name_after_file(const char *path, peer_scene *out) {
    const char *last = strrchr(path, '/');
    snprintf(out->name, sizeof out->name, "%s", last != NULL ? last + 1 : path);
    char *dot = strrchr(out->name, '.');
    if (dot != NULL) *dot = '\0';
}

bool peer_scene_read(const char *first, const char *second, peer_scene *out, io_error *error) {
    mesh_file a, z;
    if (!mesh_file_read(first, &a, error)) return false;
    if (!mesh_file_read(second, &z, error)) {
        mesh_file_free(&a);
        return false;
    }
    bool same = a.vertex_count == z.vertex_count && a.triangle_count == z.triangle_count &&
                memcmp(a.triangles, z.triangles, a.triangle_count * sizeof(uint32_t[3])) == 0;
    if (same) {
        *out = (peer_scene){.name = ""};
        name_after_file(first, out);
        take_mesh(&a, out);
        memcpy(out->end, z.positions, (size_t)z.vertex_count * sizeof(double[3]));
    } else {
        mesh_file_free(&a);
        io_fail(error, "%s and %s: their triangles are not the same", first, second);
    }
    mesh_file_free(&z);
    return same;
}

bool peer_scene_replay(const char *folder, const char *name, uint32_t frame, peer_scene *out,
                       io_error *error) {
    char model[PATH_LENGTH], frames[PATH_LENGTH];
    const char *path = frames;
    mesh_file mesh;
    animation *recording;
    snprintf(model, sizeof model, "%s/%s.obj", folder, name);
    snprintf(frames, sizeof frames, "%s/%s.pc2", folder, name);
    if (!mesh_file_read(model, &mesh, error)) return false;
    if (!animation_open(&path, 1, mesh.vertex_count, NULL, &recording, error)) {
        mesh_file_free(&mesh);
        return false;
    }
    peer_scene s = {.name = ""};
    snprintf(s.name, sizeof s.name, "%s %u", name, frame);
    take_mesh(&mesh, &s);
    bool good = frame + 1 < animation_frame_count(recording)
                    ? animation_read(recording, frame, s.start, error) &&
                          animation_read(recording, frame + 1, s.end, error)
                    : io_fail(error, "%s has no frame %u", frames, frame + 1);
    animation_close(recording);
    if (good)
        *out = s;
    else
        peer_scene_free(&s);
    return good;
}

/* ---- motions ----------------------------------------------------------------------------------------- */

/* Turns p about the axis (1, 2, 3) by an angle. */
static void turn_point(double angle, double p[3]) {
    const double length = sqrt(14.0), axis[3] = {1.0 / length, 2.0 / length, 3.0 / length};
    double c = cos(angle), s = sin(angle), along = p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2];
    const double across[3] = {axis[1] * p[2] - axis[2] * p[1], axis[2] * p[0] - axis[0] * p[2],
                              axis[0] * p[1] - axis[1] * p[0]};
    for (int k = 0; k < 3; k++) p[k] = p[k] * c + across[k] * s + axis[k] * along * (1.0 - c);
}

/* Turns the vertices behind the first ones, whose centre is the origin. */
static void turn_vertices(body *b, uint32_t first, double angle) {
    for (uint32_t v = first; v < b->vertex_count; v++) turn_point(angle, b->positions + (size_t)v * 3);
}

static void move_vertices(body *b, uint32_t first, const double offset[3]) {
    for (size_t v = first; v < b->vertex_count; v++)
        for (size_t k = 0; k < 3; k++) b->positions[v * 3 + k] += offset[k];
}

/* Puts copies of a body on a grid. turned: each in another direction. */
static void append_grid(body *all, const body *one, const int sides[3], double spacing, bool turned) {
    static const double nowhere[3];
    for (int i = 0; i < sides[0] * sides[1] * sides[2]; i++) {
        const int at[3] = {i % sides[0], i / sides[0] % sides[1], i / (sides[0] * sides[1])};
        double offset[3];
        uint32_t first = all->vertex_count;
        for (int k = 0; k < 3; k++) offset[k] = spacing * (at[k] - 0.5 * (sides[k] - 1));
        body_append(all, one, nowhere);
        if (turned) turn_vertices(all, first, 1.7 * i);
        move_vertices(all, first, offset);
    }
}

/* Balls of radius 1 that are 2.02 apart move by a fortieth towards the middle: 0.05 of each goes into its neighbours. */
static void gather_ball(const double centre[3], double p[3]) {
    for (int k = 0; k < 3; k++) p[k] -= 0.025 * centre[k];
}

/* Rods about z, which are 1.01 apart and 1 thick, are drawn together and twisted. */
static void bind_rods(double p[3]) {
    double angle = 0.02 * p[2], x = 0.975 * p[0], y = 0.975 * p[1];
    p[0] = x * cos(angle) - y * sin(angle);
    p[1] = x * sin(angle) + y * cos(angle);
}

/* Presses a figure along z into twenty waves. A wave turns over when `press` is above 1. */
static void press_figure(double press, double p[3]) {
    const double waves = 20.0 * 2.0 * 3.14159265358979323846 / 1.9;
    p[2] += press / waves * sin(waves * p[2]);
}

/* ---- scenes ------------------------------------------------------------------------------------------ */

static uint32_t share_of(body_kind kind, uint32_t triangle_count, uint32_t parts) {
    return body_nearest_count(kind, triangle_count / parts);
}

/* Takes the body as the start, in single precision, and lets the end begin as a copy. */
static void take_body(body *b, const char *name, peer_scene *out) {
    *out = (peer_scene){.vertex_count = b->vertex_count, .triangle_count = b->triangle_count};
    snprintf(out->name, sizeof out->name, "%s", name);
    out->triangles = b->triangles;
    out->start = b->positions;
    out->end = body_allocate((size_t)b->vertex_count * 3, sizeof *out->end);
    memcpy(out->end, out->start, (size_t)b->vertex_count * sizeof(double[3]));
}

static bool make_balls(uint32_t triangle_count, peer_scene *out, io_error *error) {
    const int sides[3] = {4, 4, 4};
    body one, all = {0};
    if (!body_make(BODY_SPHERE, share_of(BODY_SPHERE, triangle_count, 64), &one, error)) return false;
    append_grid(&all, &one, sides, 2.02, true);
    take_body(&all, "balls", out);
    for (size_t v = 0; v < out->vertex_count; v++) {
        double centre[3];
        for (size_t k = 0; k < 3; k++) {
            size_t i = v / one.vertex_count;
            size_t at = k == 0 ? i % 4 : k == 1 ? i / 4 % 4 : i / 16;
            centre[k] = 2.02 * ((double)at - 1.5);
        }
        gather_ball(centre, out->end + v * 3);
    }
    body_free(&one);
    return true;
}

static bool make_rods(uint32_t triangle_count, peer_scene *out, io_error *error) {
    const int sides[3] = {7, 7, 1};
    body one, all = {0};
    if (!body_make(BODY_CAPSULE, share_of(BODY_CAPSULE, triangle_count, 49), &one, error)) return false;
    append_grid(&all, &one, sides, 1.01, false);
    take_body(&all, "rods", out);
    for (size_t v = 0; v < out->vertex_count; v++) bind_rods(out->end + v * 3);
    body_free(&one);
    return true;
}

static bool make_crushed(uint32_t triangle_count, peer_scene *out, io_error *error) {
    body figure;
    if (!body_make(BODY_FIGURE, share_of(BODY_FIGURE, triangle_count, 1), &figure, error)) return false;
    take_body(&figure, "crushed", out);
    for (size_t v = 0; v < out->vertex_count; v++) {
        press_figure(0.9, out->start + v * 3);
        press_figure(2.0, out->end + v * 3);
    }
    return true;
}

static bool make_pawn(uint32_t triangle_count, peer_scene *out, io_error *error) {
    deforming_body b;
    if (!deforming_body_make(BODY_PAWN, triangle_count, DEFORM_WAVE, false, &b, error)) return false;
    body pawn = {.vertex_count = b.vertex_count,
                 .triangle_count = b.triangle_count,
                 .positions = b.rest,
                 .triangles = b.triangles};
    take_body(&pawn, "pawn", out);
    b.rest = body_allocate((size_t)b.vertex_count * 3, sizeof *b.rest);
    memcpy(b.rest, out->start, (size_t)b.vertex_count * sizeof(double[3]));
    deforming_body_interval(&b, 1, 0.0, out->start, out->end);
    b.triangles = NULL;
    deforming_body_free(&b);
    return true;
}

bool peer_scene_make(peer_scene_kind kind, uint32_t triangle_count, peer_scene *out, io_error *error) {
    static bool (*const makers[PEER_KIND_COUNT])(uint32_t, peer_scene *, io_error *) = {
        make_balls, make_rods, make_crushed, make_pawn};
    if (!makers[kind](triangle_count, out, error)) return false;
    body ends[2] = {{.vertex_count = out->vertex_count, .positions = out->start},
                    {.vertex_count = out->vertex_count, .positions = out->end}};
    for (int i = 0; i < 2; i++) body_round(&ends[i]);
    return true;
}
