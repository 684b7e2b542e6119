/* Frames as binary PLY files, whose vertices and faces have the arrays of an export as properties. */

#include "tool/export/export_values.h"
#include "tool/io/output_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The place in the header that says whose file it is. */
static const char beginning[] = "ply\nformat binary_little_endian 1.0\ncomment cscd export 1\n";

void ply_output_free(ply_output *p) {
    free(p->stem);
    *p = (ply_output){0};
}

/* A pattern or a folder of frames may hold any mesh, so only files of an earlier export are written over. */
static bool may_write(const char *path, io_error *error) {
    char start[sizeof beginning] = "";
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) /* what is read of a pipe is gone */
        return io_fail(error, "'%s' exists and is no file; choose another name", path);
    FILE *file = fopen(path, "rb");
    if (file == NULL) return errno == ENOENT || io_fail_write(error, path);
    const size_t size = fread(start, 1, sizeof beginning - 1, file);
    fclose(file);
    return (size == sizeof beginning - 1 && memcmp(start, beginning, size) == 0) ||
           io_fail(error, "'%s' exists and was not written by --ply; choose another name", path);
}

bool ply_output_open(const char *path, const recording *r, const part_names *parts,
                     const export_values *values, ply_output *out, io_error *error) {
    ply_output p = {export_names_stem(path, ".ply"), r, parts, values};
    bool opened = p.stem != NULL || io_fail(error, "out of memory");
    for (uint32_t frame = 0; opened && frame < r->frame_count; frame++) {
        char *name = export_names_frame(p.stem, r->frame_numbers[frame], ".ply");
        opened = name != NULL ? may_write(name, error) : io_fail(error, "out of memory");
        free(name);
    }
    if (!opened) {
        ply_output_free(&p);
        return false;
    }
    *out = p;
    return true;
}

static const char *type_name(export_type type) {
    static const char *const names[] = {"uchar", "int", "uint", "double"};
    return names[type];
}

static void write_properties(FILE *out, const export_table *table) {
    for (size_t i = 0; i < table->array_count; i++)
        fprintf(out, "property %s %s\n", type_name(table->arrays[i].type), table->arrays[i].name);
}

/* A name on one line, whatever characters it has. */
static void write_name(FILE *out, const char *what, uint32_t index, const char *name) {
    fprintf(out, "comment %s %" PRIu32 " ", what, index);
    for (; *name != '\0'; name++) fputc((unsigned char)*name < ' ' ? '?' : *name, out);
    fputc('\n', out);
}

static void write_header(FILE *out, const ply_output *p, int32_t number) {
    fprintf(out, "%scomment frame %" PRId32 "\n", beginning, number);
    for (uint32_t i = 0; i < p->parts->count; i++) write_name(out, "part", i, p->parts->names[i]);
    for (uint32_t i = 0; i < p->recording->object_count; i++)
        write_name(out, "object", i, p->recording->objects[i].source.name);
    fprintf(out, "element vertex %" PRIu32 "\nproperty double x\nproperty double y\nproperty double z\n",
            p->values->vertices.count);
    write_properties(out, &p->values->vertices);
    fprintf(out, "element face %" PRIu32 "\nproperty list uchar uint vertex_indices\n",
            p->values->triangles.count);
    write_properties(out, &p->values->triangles);
    fprintf(out, "end_header\n");
}

/* A number of size bytes as it is in memory, its low byte first. */
static void put_number(FILE *out, const void *number, size_t size) {
    const uint16_t one = 1;
    unsigned char bytes[8];
    memcpy(bytes, number, size);
    for (size_t i = 0; *(const unsigned char *)&one != 1 && i < size / 2; i++) {
        const unsigned char low = bytes[i];
        bytes[i] = bytes[size - 1 - i];
        bytes[size - 1 - i] = low;
    }
    fwrite(bytes, 1, size, out);
}

static void put_row(FILE *out, const export_table *table, uint32_t row) {
    for (size_t i = 0; i < table->array_count; i++) {
        const size_t size = export_type_size(table->arrays[i].type);
        put_number(out, (const char *)table->arrays[i].values + row * size, size);
    }
}

static void write_elements(FILE *out, const ply_output *p, const double *positions) {
    const uint32_t *corners = cscd_mesh_array(p->recording->mesh, CSCD_TRIANGLE_VERTICES);
    for (uint32_t v = 0; v < p->values->vertices.count; v++) {
        for (size_t k = 0; k < 3; k++) put_number(out, positions + 3 * (size_t)v + k, sizeof *positions);
        put_row(out, &p->values->vertices, v);
    }
    for (uint32_t t = 0; t < p->values->triangles.count; t++) {
        fputc(3, out);
        for (size_t k = 0; k < 3; k++) put_number(out, corners + 3 * (size_t)t + k, sizeof *corners);
        put_row(out, &p->values->triangles, t);
    }
}

bool ply_output_add_frame(const ply_output *p, int32_t number, const double *positions, io_error *error) {
    char *path = export_names_frame(p->stem, number, ".ply");
    if (path == NULL) return io_fail(error, "out of memory");
    output_file out;
    bool written = output_file_open(path, &out);
    if (written) {
        write_header(out.file, p, number);
        write_elements(out.file, p, positions);
        written = output_file_close(&out, OUTPUT_WHOLE);
    }
    if (!written) io_fail_write(error, path);
    free(path);
    return written;
}
