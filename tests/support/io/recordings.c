/* Recordings for tests: meshes with frames and the files that hold them, point caches built byte by byte, and
 * checks of what is read. */
#include "tests/support/io/recordings.h"

#include "tests/support/test.h"
#include "tool/io/mesh_file.h"
#include "tool/io/point_cache.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static void require_done(bool done, const char *what) {
    if (done) return;
    fprintf(stderr, "test fixture: %s\n", what);
    abort();
}

static recorded make_recorded(uint32_t vertex_count, uint32_t triangle_count, uint32_t frame_count) {
    recorded r = {vertex_count, triangle_count, frame_count, NULL, NULL};
    r.triangles = calloc((size_t)triangle_count * 3, sizeof *r.triangles);
    r.frames = calloc((size_t)frame_count * vertex_count * 3, sizeof *r.frames);
    require_done(r.triangles != NULL && r.frames != NULL, "out of memory");
    return r;
}

void recorded_free(recorded *r) {
    free(r->triangles);
    free(r->frames);
    *r = (recorded){0};
}

static double *position_at(const recorded *r, uint32_t frame, uint32_t vertex) {
    return r->frames + ((size_t)frame * r->vertex_count + vertex) * 3;
}

const double *recorded_position(const recorded *r, uint32_t frame, uint32_t vertex) {
    return position_at(r, frame, vertex);
}

/* `volatile` is needed because gcc 12 drops neighbouring (double)(float) conversions when it joins them
 * into vectors. */
static double to_float32(double x) {
    volatile float rounded = (float)x;
    return (double)rounded;
}

static void put_position(const recorded *r, uint32_t frame, uint32_t vertex, double x, double y, double z) {
    double *p = position_at(r, frame, vertex);
    p[0] = to_float32(x);
    p[1] = to_float32(y);
    p[2] = to_float32(z);
}

/* Adds the four outward triangles of a tetrahedron whose first three vertices are counter-clockwise from
 * outside. */
static void add_tetrahedron(const recorded *r, uint32_t triangle, const uint32_t v[4]) {
    static const int corners[12] = {0, 1, 2, 1, 0, 3, 2, 1, 3, 0, 2, 3};
    for (int i = 0; i < 12; i++) r->triangles[(size_t)triangle * 3 + (size_t)i] = v[corners[i]];
}

recorded recorded_tetrahedra(uint32_t frame_count) {
    static const uint32_t hit[4] = {0, 1, 2, 3}, flying[4] = {5, 6, 7, 4};
    recorded r = make_recorded(8, 8, frame_count);
    add_tetrahedron(&r, 0, hit);
    add_tetrahedron(&r, 4, flying);
    for (uint32_t k = 0; k < frame_count; k++) {
        double x = 3.5 - k;
        put_position(&r, k, 0, 0, 0, 0);
        put_position(&r, k, 1, 0, 4, 0);
        put_position(&r, k, 2, 0, 0, 4);
        put_position(&r, k, 3, -4, 0, 0);
        put_position(&r, k, 4, x, 1, 1);
        put_position(&r, k, 5, x + 4, 1.5, 1);
        put_position(&r, k, 6, x + 4, 0.5, 1.5);
        put_position(&r, k, 7, x + 4, 0.5, 0.5);
    }
    return r;
}

/* Adds a grid of quads, each two triangles. closed: its ends are joined both ways. */
static void add_grid(const recorded *r, uint32_t columns, uint32_t rows, bool closed) {
    uint32_t *t = r->triangles, across = closed ? columns : columns + 1, along = closed ? rows : rows + 1;
    for (uint32_t j = 0; j < rows; j++) {
        for (uint32_t i = 0; i < columns; i++, t += 6) {
            uint32_t a = j * across + i, b = j * across + (i + 1) % across;
            uint32_t c = (j + 1) % along * across + (i + 1) % across, d = (j + 1) % along * across + i;
            memcpy(t, (uint32_t[6]){a, b, c, a, c, d}, 6 * sizeof *t);
        }
    }
}

/* The strip bends in its middle fifth: s is the length along it from there, w the place across. */
static void put_folded(const recorded *r, uint32_t frame, uint32_t vertex, double s, double w, double angle) {
    const double half = 1.0;
    double radius = 2.0 * half / angle, turned = angle * fmin(1.0, fmax(0.0, (s + half) / (2.0 * half)));
    double before = fmin(0.0, s + half), after = fmax(0.0, s - half);
    double wave = 0.05 * sin(1.7 * s + 2.3 * w) + 0.03 * cos(3.1 * w - 0.9 * s);
    double x = before + radius * sin(turned) + after * cos(turned) - wave * sin(turned);
    double z = radius * (1.0 - cos(turned)) + after * sin(turned) + wave * cos(turned);
    put_position(r, frame, vertex, x, w + 0.04 * after, z);
}

recorded recorded_fold(uint32_t columns, uint32_t rows, uint32_t frame_count) {
    recorded r = make_recorded((columns + 1) * (rows + 1), columns * rows * 2, frame_count);
    add_grid(&r, columns, rows, false);
    for (uint32_t k = 0; k < frame_count; k++) {
        double angle = 0.1 + (200.0 / 180.0 * pi - 0.1) * (frame_count > 1 ? k / (frame_count - 1.0) : 0.0);
        for (uint32_t v = 0; v < r.vertex_count; v++) {
            double s = 10.0 * (v % (columns + 1)) / columns - 5.0, w = 4.0 * (v / (columns + 1)) / rows;
            put_folded(&r, k, v, s, w, angle);
        }
    }
    return r;
}

/* Computes corner c of a cube (bits x, y, z), turned generically about its centre. */
static void cube_corner(uint32_t c, double out[3]) {
    double p[3] = {c & 1 ? 1.0 : -1.0, c & 2 ? 1.0 : -1.0, c & 4 ? 1.0 : -1.0};
    static const double angles[3] = {0.71, 0.43, 0.29};
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double x = p[i], y = p[j];
        p[i] = cos(angles[k]) * x - sin(angles[k]) * y;
        p[j] = sin(angles[k]) * x + cos(angles[k]) * y;
    }
    memcpy(out, p, sizeof p);
}

/* The corners of each side of a cube, counter-clockwise from outside. */
static const uint32_t cube_sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

recorded recorded_cube(bool split) {
    uint32_t corners = split ? 24 : 8;
    recorded r = make_recorded(corners + 4, 16, 3);
    for (uint32_t side = 0; side < 6; side++) {
        uint32_t v[4];
        for (uint32_t i = 0; i < 4; i++) v[i] = split ? side * 4 + i : cube_sides[side][i];
        memcpy(r.triangles + (size_t)side * 6, (uint32_t[6]){v[0], v[1], v[2], v[0], v[2], v[3]},
               6 * sizeof *v);
    }
    add_tetrahedron(&r, 12, (uint32_t[4]){corners, corners + 1, corners + 2, corners + 3});
    for (uint32_t k = 0; k < 3; k++) {
        for (uint32_t v = 0; v < corners; v++) {
            double p[3];
            cube_corner(split ? cube_sides[v / 4][v % 4] : v, p);
            put_position(&r, k, v, p[0] - 4.0 + 2.1 * k, p[1] + 0.1, p[2] - 0.2);
        }
        put_position(&r, k, corners, 1.1, -3, -2);
        put_position(&r, k, corners + 1, 0.8, 3, -2);
        put_position(&r, k, corners + 2, 1, 0.3, 3);
        put_position(&r, k, corners + 3, -2, 0.5, 0.2);
    }
    return r;
}

recorded recorded_torus(uint32_t rings, uint32_t segments) {
    recorded r = make_recorded(rings * segments, rings * segments * 2, 1);
    add_grid(&r, segments, rings, true);
    for (uint32_t v = 0; v < r.vertex_count; v++) {
        double u = 2.0 * pi * (v % segments) / segments, w = 2.0 * pi * (v / segments) / rings;
        put_position(&r, 0, v, (3.0 + cos(u)) * cos(w), (3.0 + cos(u)) * sin(w), -sin(u));
    }
    return r;
}

static void write_ply(const char *path, const mesh_file *mesh) {
    FILE *file = fopen(path, "w");
    require_done(file != NULL, path);
    fprintf(file, "ply\nformat ascii 1.0\nelement vertex %u\n", mesh->vertex_count);
    fprintf(file, "property double x\nproperty double y\nproperty double z\nelement face %u\n",
            mesh->triangle_count);
    fprintf(file, "property list uchar int vertex_indices\nend_header\n");
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const double *p = mesh->positions + (size_t)v * 3;
        fprintf(file, "%.17g %.17g %.17g\n", p[0], p[1], p[2]);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangles + (size_t)t * 3;
        fprintf(file, "3 %u %u %u\n", v[0], v[1], v[2]);
    }
    require_done(fclose(file) == 0, path);
}

temp_path recorded_write_mesh(const temp_folder *folder, const char *name, const recorded *r,
                              uint32_t frame) {
    temp_path path = temp_file_path(folder, name);
    mesh_file mesh = mesh_file_of(r->vertex_count, r->triangle_count, position_at(r, frame, 0), r->triangles);
    io_error error = {""};
    if (strlen(name) > 4 && strcmp(name + strlen(name) - 4, ".ply") == 0)
        write_ply(path.text, &mesh);
    else
        require_done(mesh_file_write_obj(path.text, &mesh, &error), error.text);
    return path;
}

temp_path recorded_write_parts(const temp_folder *folder, const char *name, const recorded *r,
                               const char *const *records) {
    temp_path path = temp_file_path(folder, name);
    FILE *file = fopen(path.text, "w");
    require_done(file != NULL, path.text);
    for (uint32_t v = 0; v < r->vertex_count; v++) {
        const double *x = recorded_position(r, 0, v);
        fprintf(file, "v %.17g %.17g %.17g\n", x[0], x[1], x[2]);
    }
    for (uint32_t t = 0; t < r->triangle_count; t++) {
        const uint32_t *c = r->triangles + (size_t)t * 3;
        fprintf(file, "%s\nf %u %u %u\n", records[t], c[0] + 1, c[1] + 1, c[2] + 1);
    }
    require_done(fclose(file) == 0, path.text);
    return path;
}

/* Returns 0 1 2 3 2 1 0 1 ... for four frames. */
static uint32_t cycle_frame(uint32_t k, uint32_t frame_count) {
    if (frame_count == 1) return 0;
    uint32_t period = 2 * (frame_count - 1), place = k % period;
    return place < frame_count ? place : period - place;
}

temp_path recorded_write_cycle(const temp_folder *folder, const char *name, const recorded *r,
                               uint32_t frame_count) {
    temp_path path = temp_file_path(folder, name);
    point_cache_writer *writer = NULL;
    io_error error = {""};
    require_done(point_cache_writer_open(path.text, r->vertex_count, frame_count, &writer, &error),
                 error.text);
    for (uint32_t k = 0; k < frame_count; k++) {
        uint32_t frame = cycle_frame(k, r->frame_count);
        require_done(point_cache_writer_write(writer, position_at(r, frame, 0), &error), error.text);
    }
    require_done(point_cache_writer_close(writer, &error), error.text);
    return path;
}

temp_path recorded_write_cache(const temp_folder *folder, const char *name, const recorded *r) {
    return recorded_write_cycle(folder, name, r, r->frame_count);
}

/* The pattern's %04d is replaced here, since the compiler cannot check a format that is not a literal. */

/* ---- point caches byte by byte ------------------------------------------------------------------------- */

void frame_fixture_put_int(frame_fixture_bytes *bytes, size_t offset, int32_t value, bool big_endian) {
    assert_true(offset <= bytes->size && offset + 4 <= sizeof bytes->data);
    const uint32_t bits = (uint32_t)value;
    unsigned char *at = bytes->data + offset;
    at[big_endian ? 0 : 3] = (unsigned char)(bits >> 24);
    at[big_endian ? 1 : 2] = (unsigned char)(bits >> 16 & 255);
    at[big_endian ? 2 : 1] = (unsigned char)(bits >> 8 & 255);
    at[big_endian ? 3 : 0] = (unsigned char)(bits & 255);
    if (bytes->size < offset + 4) bytes->size = offset + 4;
}

void frame_fixture_put_float(frame_fixture_bytes *bytes, size_t offset, float value, bool big_endian) {
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    frame_fixture_put_int(bytes, offset, bits, big_endian);
}

double frame_fixture_value(uint32_t frame, uint32_t vertex, uint32_t axis) {
    return (double)frame * 64 - (double)vertex * 0.75 + (double)axis * 0.0625 - 3.5;
}

static void append_frames(frame_fixture_bytes *bytes, uint32_t vertex_count, uint32_t frame_count,
                          bool big_endian) {
    for (uint32_t frame = 0; frame < frame_count; frame++)
        for (uint32_t i = 0; i < vertex_count * 3; i++)
            frame_fixture_put_float(bytes, bytes->size, (float)frame_fixture_value(frame, i / 3, i % 3),
                                    big_endian);
}

frame_fixture_bytes frame_fixture_pc2(uint32_t vertex_count, uint32_t frame_count) {
    frame_fixture_bytes bytes = {.data = "POINTCACHE2", .size = 12};
    frame_fixture_put_int(&bytes, 12, 1, false);
    frame_fixture_put_int(&bytes, 16, (int32_t)vertex_count, false);
    frame_fixture_put_float(&bytes, 20, 1.0F, false);
    frame_fixture_put_float(&bytes, 24, 0.5F, false);
    frame_fixture_put_int(&bytes, 28, (int32_t)frame_count, false);
    append_frames(&bytes, vertex_count, frame_count, false);
    return bytes;
}

frame_fixture_bytes frame_fixture_mdd(uint32_t vertex_count, uint32_t frame_count) {
    frame_fixture_bytes bytes = {.size = 0};
    frame_fixture_put_int(&bytes, 0, (int32_t)frame_count, true);
    frame_fixture_put_int(&bytes, 4, (int32_t)vertex_count, true);
    for (uint32_t frame = 0; frame < frame_count; frame++)
        frame_fixture_put_float(&bytes, bytes.size, (float)frame / 24.0F, true);
    append_frames(&bytes, vertex_count, frame_count, true);
    return bytes;
}

temp_path frame_fixture_write(const temp_folder *folder, const char *name, const frame_fixture_bytes *bytes) {
    return temp_file_write(folder, name, bytes->data, bytes->size);
}

temp_path frame_fixture_write_mesh(const temp_folder *folder, const char *name, uint32_t vertex_count,
                                   uint32_t frame) {
    frame_fixture_bytes bytes = {.size = 0};
    for (uint32_t vertex = 0; vertex <= vertex_count; vertex++) {
        char line[100] = "f 1 2 3\n";
        if (vertex < vertex_count)
            snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", frame_fixture_value(frame, vertex, 0),
                     frame_fixture_value(frame, vertex, 1), frame_fixture_value(frame, vertex, 2));
        assert_true(bytes.size + strlen(line) < sizeof bytes.data);
        memcpy(bytes.data + bytes.size, line, strlen(line));
        bytes.size += strlen(line);
    }
    return frame_fixture_write(folder, name, &bytes);
}

animation *frame_fixture_open(const char *path, uint32_t vertex_count) {
    animation *opened = NULL;
    io_error error = {""};
    if (!animation_open(&path, 1, vertex_count, NULL, &opened, &error)) fail_msg("%s", error.text);
    assert_non_null(opened);
    return opened;
}

void frame_fixture_check(animation *opened, uint32_t vertex_count, uint32_t frame, uint32_t expected) {
    double *positions = malloc((size_t)vertex_count * 3 * sizeof *positions);
    assert_non_null(positions);
    io_error error = {""};
    if (!animation_read(opened, frame, positions, &error)) fail_msg("%s", error.text);
    for (uint32_t i = 0; i < vertex_count * 3; i++)
        if (positions[i] != frame_fixture_value(expected, i / 3, i % 3))
            fail_msg("frame %u, value %u: %g, expected %g", frame, i, positions[i],
                     frame_fixture_value(expected, i / 3, i % 3));
    free(positions);
}

void frame_fixture_check_error(const io_error *error, ...) {
    assert_true(error->text[0] != '\0');
    assert_null(strchr(error->text, '\n'));
    va_list parts;
    va_start(parts, error);
    for (const char *part = va_arg(parts, const char *); part != NULL; part = va_arg(parts, const char *))
        if (strstr(error->text, part) == NULL) fail_msg("\"%s\" lacks \"%s\"", error->text, part);
    va_end(parts);
}

void frame_fixture_open_fails(const char *path, uint32_t vertex_count, io_error *error) {
    animation *untouched = (animation *)(void *)error, *opened = untouched;
    error->text[0] = '\0';
    assert_false(animation_open(&path, 1, vertex_count, NULL, &opened, error));
    assert_ptr_equal(opened, untouched);
    frame_fixture_check_error(error, NULL);
    assert_false(animation_open(&path, 1, vertex_count, NULL, &opened, NULL));
}

void frame_fixture_read_fails(animation *opened, uint32_t vertex_count, uint32_t frame, io_error *error) {
    double *positions = malloc((size_t)vertex_count * 3 * sizeof *positions);
    assert_non_null(positions);
    error->text[0] = '\0';
    assert_false(animation_read(opened, frame, positions, error));
    frame_fixture_check_error(error, NULL);
    free(positions);
}
