/* Writes PC2 and MDD point caches through one small buffer. */
#define _FILE_OFFSET_BITS 64 /* caches beyond 2 GiB on 32-bit systems too */

#include "tool/io/point_cache_write.h"

#include "tool/io/growable.h"
#include "tool/io/output_file.h"
#include "tool/io/point_cache.h"

#include <errno.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { CHUNK_FLOATS = 4096 };

struct point_cache_writer {
    output_file out; /* its file is NULL after a failure */
    bool big_endian;
    uint32_t vertex_count, frame_count, written_count;
    unsigned char chunk[CHUNK_FLOATS * sizeof(float)];
    char path[];
};

static void store_uint32(unsigned char *bytes, uint32_t value, bool big_endian) {
    for (int i = 0; i < 4; i++) bytes[big_endian ? 3 - i : i] = (unsigned char)(value >> (8 * i) & 0xff);
}

static void store_float(unsigned char *bytes, float value, bool big_endian) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    store_uint32(bytes, bits, big_endian);
}

static void abandon_file(point_cache_writer *writer) {
    if (writer->out.file != NULL) output_file_close(&writer->out, OUTPUT_ABANDONED);
}

static bool write_bytes(point_cache_writer *writer, size_t size, io_error *error) {
    if (fwrite(writer->chunk, 1, size, writer->out.file) == size) return true;
    return io_fail(error, "%s: cannot write frame %" PRIu32 ": %s", writer->path, writer->written_count,
                   io_write_reason());
}

static bool write_pc2_header(point_cache_writer *writer, io_error *error) {
    unsigned char *header = writer->chunk;
    memcpy(header, POINT_CACHE_PC2_MAGIC, POINT_CACHE_PC2_MAGIC_SIZE);
    store_uint32(header + 12, 1, false);
    store_uint32(header + 16, writer->vertex_count, false);
    store_float(header + 20, 0.0F, false);
    store_float(header + 24, 1.0F, false);
    store_uint32(header + 28, writer->frame_count, false);
    return write_bytes(writer, POINT_CACHE_PC2_HEADER_SIZE, error);
}

static bool write_mdd_header(point_cache_writer *writer, io_error *error) {
    store_uint32(writer->chunk, writer->frame_count, true);
    store_uint32(writer->chunk + 4, writer->vertex_count, true);
    if (!write_bytes(writer, POINT_CACHE_MDD_HEADER_SIZE, error)) return false;
    for (uint32_t i = 0; i < writer->frame_count; i++) {
        store_float(writer->chunk, (float)(i / 24.0), true);
        if (!write_bytes(writer, sizeof(float), error)) return false;
    }
    return true;
}

static bool create_file(point_cache_writer *writer, io_error *error) {
    return output_file_open(writer->path, &writer->out) ||
           io_fail(error, "%s: cannot create: %s", writer->path, strerror(errno));
}

static bool begin_file(point_cache_writer *writer, io_error *error) {
    const char *dot = strrchr(writer->path, '.');
    const bool pc2 = dot != NULL && strcasecmp(dot, ".pc2") == 0;
    writer->big_endian = dot != NULL && strcasecmp(dot, ".mdd") == 0;
    if (!pc2 && !writer->big_endian)
        return io_fail(error, "%s: unknown extension, expected .pc2 or .mdd", writer->path);
    if (writer->vertex_count - 1 >= INT32_MAX || writer->frame_count - 1 >= INT32_MAX)
        return io_fail(error, "%s: %" PRIu32 " frames of %" PRIu32 " vertices, expected 1 to %d of each",
                       writer->path, writer->frame_count, writer->vertex_count, INT32_MAX);
    if (!create_file(writer, error)) return false;
    return pc2 ? write_pc2_header(writer, error) : write_mdd_header(writer, error);
}

bool point_cache_writer_open(const char *path, uint32_t vertex_count, uint32_t frame_count,
                             point_cache_writer **out, io_error *error) {
    const size_t path_size = strlen(path) + 1;
    point_cache_writer *writer = io_realloc(NULL, sizeof *writer + path_size);
    if (writer == NULL) return io_fail(error, "%s: out of memory", path);
    memset(writer, 0, sizeof *writer);
    memcpy(writer->path, path, path_size);
    writer->vertex_count = vertex_count;
    writer->frame_count = frame_count;
    if (!begin_file(writer, error)) {
        abandon_file(writer);
        free(writer);
        return false;
    }
    *out = writer;
    return true;
}

static bool write_frame(point_cache_writer *writer, const double *positions, io_error *error) {
    if (writer->written_count == writer->frame_count)
        return io_fail(error, "%s: one frame more than the %" PRIu32 " that its header promises",
                       writer->path, writer->frame_count);
    const size_t count = (size_t)writer->vertex_count * 3;
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        if (!(fabs(positions[i]) <= (double)FLT_MAX)) /* comparing NaN gives false */
            return io_fail(
                error, "%s: frame %" PRIu32 ", vertex %zu, %c is %g, expected a number that fits in float32",
                writer->path, writer->written_count, i / 3, "xyz"[i % 3], positions[i]);
        store_float(writer->chunk + used, (float)positions[i], writer->big_endian);
        used += sizeof(float);
        if (used == sizeof writer->chunk || i + 1 == count) {
            if (!write_bytes(writer, used, error)) return false;
            used = 0;
        }
    }
    writer->written_count++;
    return true;
}

bool point_cache_writer_write(point_cache_writer *writer, const double *positions, io_error *error) {
    if (writer->out.file == NULL) return io_fail(error, "%s: an earlier write failed", writer->path);
    if (write_frame(writer, positions, error)) return true;
    abandon_file(writer);
    return false;
}

static bool finish_file(point_cache_writer *writer, io_error *error) {
    if (writer->written_count < writer->frame_count)
        return io_fail(error, "%s: only %" PRIu32 " frames were written, expected %" PRIu32, writer->path,
                       writer->written_count, writer->frame_count);
    return output_file_close(&writer->out, OUTPUT_WHOLE) || io_fail_write(error, writer->path);
}

bool point_cache_writer_close(point_cache_writer *writer, io_error *error) {
    if (writer == NULL) return true;
    bool finished = false;
    if (writer->out.file != NULL) {
        finished = finish_file(writer, error);
        if (!finished) abandon_file(writer);
    }
    free(writer);
    return finished;
}
