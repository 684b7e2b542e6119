/* Copies of mesh files in which vertices have other places. */
#include "tool/io/mesh_copy.h"

#include "tool/io/file_reader.h"
#include "tool/io/format_reader.h"
#include "tool/io/output_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct mesh_copy {
    file_reader reader; /* with the bytes */
    mesh_file mesh;
    growable places;        /* of coordinate_place[3] */
    growable normal_places; /* the same, of faces, in the file's order */
    bool floats;
    char path[];
};

bool mesh_copy_knows(mesh_format format) {
    return format == MESH_FORMAT_OBJ || format == MESH_FORMAT_PLY || format == MESH_FORMAT_OFF ||
           format == MESH_FORMAT_STL;
}

static const coordinate_place *places_of(const mesh_copy *copy, uint32_t vertex) {
    return (const coordinate_place *)copy->places.data + (size_t)vertex * 3;
}

/* Whatever is read from elsewhere than a file is gone when it is to be copied. */
static bool check_regular(const char *path, io_error *error) {
    struct stat status;
    return stat(path, &status) != 0 || S_ISREG(status.st_mode) ||
           io_fail(error, "%s: not a regular file, so it cannot be copied with its vertices moved", path);
}

static bool check_places(mesh_copy *copy, io_error *error) {
    if (!mesh_copy_knows(copy->mesh.format))
        return io_fail(error,
                       "%s: cannot be copied with its vertices moved, expected an " MESH_COPY_FORMATS " file",
                       copy->path);
    for (uint32_t v = 0; v < copy->mesh.vertex_count; v++) {
        for (int axis = 0; axis < 3; axis++) {
            const coordinate_place *place = &places_of(copy, v)[axis];
            if (place->form == COORDINATE_NOWHERE)
                return io_fail(
                    error,
                    "%s: vertex %u is stored as integers, or divided by a fourth number, so it cannot "
                    "be written anywhere else; convert the file to OBJ",
                    copy->path, v);
            copy->floats = copy->floats || (place->form != COORDINATE_TEXT && place->size == sizeof(float));
        }
    }
    return true;
}

bool mesh_copy_open(const char *path, mesh_copy **out, io_error *error) {
    const size_t path_size = strlen(path) + 1;
    if (!check_regular(path, error)) return false;
    mesh_copy *copy = io_zeroed(sizeof *copy + path_size);
    if (copy == NULL) return io_fail(error, "%s: out of memory", path);
    memcpy(copy->path, path, path_size);
    copy->places = growable_of(sizeof(coordinate_place[3]));
    copy->normal_places = growable_of(sizeof(coordinate_place[3]));
    bool opened = file_reader_open(&copy->reader, copy->path, error);
    if (opened) {
        copy->reader.places = &copy->places;
        copy->reader.normal_places = &copy->normal_places;
        opened = mesh_reader_read(&copy->reader, &copy->mesh) && check_places(copy, error);
    }
    if (opened)
        *out = copy;
    else
        mesh_copy_close(copy);
    return opened;
}

void mesh_copy_close(mesh_copy *copy) {
    if (copy == NULL) return;
    file_reader_close(&copy->reader);
    mesh_file_free(&copy->mesh);
    growable_free(&copy->places);
    growable_free(&copy->normal_places);
    free(copy);
}

uint32_t mesh_copy_vertex_count(const mesh_copy *copy) {
    return copy->mesh.vertex_count;
}

const double *mesh_copy_positions(const mesh_copy *copy) {
    return copy->mesh.positions;
}

bool mesh_copy_holds_floats(const mesh_copy *copy) {
    return copy->floats;
}

/* ---- writing ------------------------------------------------------------------------------------------- */

static void write_text(FILE *file, double value) {
    enum { DIGITS_FEWEST = 15, DIGITS_ALL = 17 };
    char text[32];
    for (int digits = DIGITS_FEWEST; digits <= DIGITS_ALL; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) break;
    }
    fputs(text, file);
}

static void write_bits(FILE *file, uint64_t bits, size_t size, bool big_endian) {
    for (size_t i = 0; i < size; i++) fputc((int)(bits >> 8 * (big_endian ? size - 1 - i : i) & 0xff), file);
}

static void write_coordinate(FILE *file, const coordinate_place *place, double value) {
    const float rounded = (float)value;
    uint32_t single_bits;
    uint64_t double_bits;
    memcpy(&single_bits, &rounded, sizeof rounded);
    memcpy(&double_bits, &value, sizeof value);
    if (place->form == COORDINATE_TEXT)
        write_text(file, value);
    else
        write_bits(file, place->size == sizeof rounded ? single_bits : double_bits, place->size,
                   place->form == COORDINATE_BIG);
}

/* Writes the bytes of the file up to a place. */
static void copy_bytes(const mesh_copy *copy, FILE *file, size_t *from, size_t to) {
    fwrite(copy->reader.bytes + *from, 1, to - *from, file);
    *from = to;
}

/* A PLY may have z before x. */
static void sort_axes(const coordinate_place *places, int axes[3]) {
    for (int i = 0; i < 3; i++) {
        int place = 0;
        for (int k = 0; k < 3; k++) place += places[k].at < places[i].at;
        axes[place] = i;
    }
}

/* Has any of the vertices from v on, count of them, moved? */
static bool any_moved(const mesh_copy *copy, const double *positions, uint32_t v, uint32_t count) {
    return memcmp(positions + (size_t)v * 3, copy->mesh.positions + (size_t)v * 3,
                  (size_t)count * 3 * sizeof *positions) != 0;
}

/* The unit normal of the triangle of three vertices; 0 where it has none. */
static void find_normal(const double *x, double normal[3]) {
    double a[3], b[3], square = 0.0;
    for (int k = 0; k < 3; k++) {
        a[k] = x[3 + k] - x[k];
        b[k] = x[6 + k] - x[k];
    }
    for (int k = 0; k < 3; k++) {
        normal[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        square += normal[k] * normal[k];
    }
    for (int k = 0; k < 3; k++) normal[k] = square > 0.0 ? (double)(float)(normal[k] / sqrt(square)) : 0.0;
}

/* Writes the normal before the vertex v, if it is that of a face which begins there and has moved. */
static void print_normal(const mesh_copy *copy, FILE *file, const double *positions, uint32_t v,
                         size_t *normals, size_t *from) {
    const coordinate_place *places = (const coordinate_place *)copy->normal_places.data + *normals * 3;
    double normal[3];
    if (*normals == copy->normal_places.count || places->at > places_of(copy, v)->at) return;
    ++*normals;
    if (v + 3 > copy->mesh.vertex_count || !any_moved(copy, positions, v, 3)) return;
    find_normal(positions + (size_t)v * 3, normal);
    for (int axis = 0; axis < 3; axis++) {
        copy_bytes(copy, file, from, places[axis].at);
        write_coordinate(file, &places[axis], normal[axis]);
        *from += places[axis].size;
    }
}

static void print_vertex(const mesh_copy *copy, FILE *file, const double *positions, uint32_t v,
                         size_t *from) {
    const coordinate_place *places = places_of(copy, v);
    int axes[3];
    sort_axes(places, axes);
    for (int i = 0; i < 3; i++) {
        const size_t at = (size_t)v * 3 + (size_t)axes[i];
        const coordinate_place *place = &places[axes[i]];
        if (memcmp(&positions[at], &copy->mesh.positions[at], sizeof *positions) == 0) continue;
        copy_bytes(copy, file, from, place->at);
        write_coordinate(file, place, positions[at]);
        *from += place->size;
    }
}

static void print_copy(const mesh_copy *copy, FILE *file, const double *positions) {
    size_t from = 0, normals = 0;
    for (uint32_t v = 0; v < copy->mesh.vertex_count; v++) {
        print_normal(copy, file, positions, v, &normals, &from);
        print_vertex(copy, file, positions, v, &from);
    }
    copy_bytes(copy, file, &from, copy->reader.size);
}

bool mesh_copy_write(const mesh_copy *copy, const char *path, const double *positions, io_error *error) {
    output_file out;
    if (!output_file_open(path, &out)) return io_fail_write(error, path);
    print_copy(copy, out.file, positions);
    const bool printed = output_file_writes(&out);
    return output_file_close(&out, printed ? OUTPUT_WHOLE : OUTPUT_ABANDONED) || io_fail_write(error, path);
}
