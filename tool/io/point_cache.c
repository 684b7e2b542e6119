/* Point caches: all frames of an animation in one PC2 or MDD file, read and written frame by frame. */
#include "tool/io/point_cache.h"

#define _FILE_OFFSET_BITS 64 /* caches beyond 2 GiB on 32-bit systems too */

#include "tool/io/io.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { CHUNK_VERTICES = 4096 };

struct point_cache {
    int file;
    bool big_endian;
    uint32_t vertex_count, frame_count;
    int32_t first_number, number_step;
    int64_t file_size;
    int64_t data_start; /* byte offset of frame 0 */
    unsigned char chunk[CHUNK_VERTICES * POINT_CACHE_VERTEX_SIZE];
    char path[];
};

static uint32_t load_uint32(const unsigned char *bytes, bool big_endian) {
    const uint32_t b0 = bytes[0], b1 = bytes[1], b2 = bytes[2], b3 = bytes[3];
    return big_endian ? b0 << 24 | b1 << 16 | b2 << 8 | b3 : b3 << 24 | b2 << 16 | b1 << 8 | b0;
}

static int32_t load_int32(const unsigned char *bytes, bool big_endian) {
    const uint32_t bits = load_uint32(bytes, big_endian);
    int32_t value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float load_float(const unsigned char *bytes, bool big_endian) {
    const uint32_t bits = load_uint32(bytes, big_endian);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Reads the bytes at offset. Returns how many there are, fewer than size only at the end of the file;
 * -1 with errno. */
static int64_t read_at(int file, unsigned char *bytes, size_t size, int64_t offset) {
    size_t done = 0;
    while (done < size) {
        const ssize_t got = pread(file, bytes + done, size - done, (off_t)(offset + (int64_t)done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return -1;
        if (got == 0) break;
        done += (size_t)got;
    }
    return (int64_t)done;
}

/* A named pipe is not opened: whoever writes it would take this for its reader, and until somebody does,
 * opening waits. */
static bool is_regular(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

bool point_cache_recognise(const char *path) {
    if (path_has_extension(path, ".pc2") || path_has_extension(path, ".mdd")) return true;
    if (!is_regular(path)) return false;
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    unsigned char start[POINT_CACHE_PC2_MAGIC_SIZE];
    const bool same = read_at(file, start, sizeof start, 0) == sizeof start &&
                      memcmp(start, POINT_CACHE_PC2_MAGIC, sizeof start) == 0;
    close(file);
    return same;
}

/* ---- header ---------------------------------------------------------------------------------------- */

/* Some programs write the numbers as their own machine has them. */
static bool fail_byte_order(const point_cache *cache, const char *format, bool big_endian, io_error *error) {
    return io_fail(
        error,
        "%s: its numbers are %s-endian, and those of %s are %s-endian; export it again, with another "
        "program if this one always writes it so",
        cache->path, big_endian ? "little" : "big", format, big_endian ? "big" : "little");
}

static bool check_counts(const point_cache *cache, int32_t points, int32_t frames, io_error *error) {
    if (points != (int64_t)cache->vertex_count)
        return io_fail(error,
                       "%s: holds %" PRId32 " points, the model has %" PRIu32
                       " vertices: it was exported from another mesh",
                       cache->path, points, cache->vertex_count);
    if (frames < 1)
        return io_fail(error, "%s: holds %" PRId32 " frames, expected at least 1", cache->path, frames);
    return true;
}

static bool check_magic(const char *path, const unsigned char *header, size_t size, io_error *error) {
    const size_t compared = size < POINT_CACHE_PC2_MAGIC_SIZE ? size : POINT_CACHE_PC2_MAGIC_SIZE;
    if (memcmp(header, POINT_CACHE_PC2_MAGIC, compared) == 0) return true;
    char shown[4 * POINT_CACHE_PC2_MAGIC_SIZE + 1] = "";
    size_t length = 0;
    for (size_t i = 0; i < compared; i++) {
        const bool plain = header[i] >= ' ' && header[i] < 127 && header[i] != '"' && header[i] != '\\';
        length +=
            (size_t)snprintf(shown + length, sizeof shown - length, plain ? "%c" : "\\x%02x", header[i]);
    }
    return io_fail(error, "%s: not a PC2 file: starts with \"%s\", expected \"%s\\x00\"", path, shown,
                   POINT_CACHE_PC2_MAGIC);
}

/* Numbers the frames by the header's start and rate. */
static void number_frames(point_cache *cache, double start, double rate) {
    cache->first_number = 0;
    cache->number_step = 1;
    const double last = start + rate * (cache->frame_count - 1.0);
    const bool whole = start == floor(start) && rate == floor(rate) && rate >= 1.0;
    if (!whole || start < INT32_MIN || last > INT32_MAX || rate > INT32_MAX) return;
    cache->first_number = (int32_t)start;
    cache->number_step = (int32_t)rate;
}

static bool parse_pc2_header(point_cache *cache, const unsigned char *header, size_t size, io_error *error) {
    if (!check_magic(cache->path, header, size, error)) return false;
    if (size < POINT_CACHE_PC2_HEADER_SIZE)
        return io_fail(error, "%s: too short for a PC2 header: %zu bytes, expected at least %d", cache->path,
                       size, POINT_CACHE_PC2_HEADER_SIZE);
    const int32_t version = load_int32(header + 12, false);
    const int32_t points = load_int32(header + 16, false);
    const int32_t samples = load_int32(header + 28, false);
    if (load_int32(header + 12, true) == 1) return fail_byte_order(cache, "a PC2 file", false, error);
    if (version != 1)
        return io_fail(error, "%s: PC2 version %" PRId32 " at byte 12, expected 1", cache->path, version);
    if (!check_counts(cache, points, samples, error)) return false;
    cache->big_endian = false;
    cache->frame_count = (uint32_t)samples;
    cache->data_start = POINT_CACHE_PC2_HEADER_SIZE;
    number_frames(cache, (double)load_float(header + 20, false), (double)load_float(header + 24, false));
    return true;
}

static bool parse_mdd_header(point_cache *cache, const unsigned char *header, size_t size, io_error *error) {
    if (size < POINT_CACHE_MDD_HEADER_SIZE)
        return io_fail(error, "%s: too short for an MDD header: %zu bytes, expected at least %d", cache->path,
                       size, POINT_CACHE_MDD_HEADER_SIZE);
    const int32_t frames = load_int32(header, true);
    const int32_t points = load_int32(header + 4, true);
    if (points != (int64_t)cache->vertex_count &&
        load_int32(header + 4, false) == (int64_t)cache->vertex_count)
        return fail_byte_order(cache, "an MDD file", true, error);
    if (!check_counts(cache, points, frames, error)) return false;
    cache->big_endian = true;
    cache->frame_count = (uint32_t)frames;
    number_frames(cache, 0.0, 1.0);
    cache->data_start = POINT_CACHE_MDD_HEADER_SIZE + (int64_t)frames * (int64_t)sizeof(float);
    return true;
}

static int64_t frame_size(const point_cache *cache) {
    return (int64_t)cache->vertex_count * POINT_CACHE_VERTEX_SIZE;
}

static bool check_size(const point_cache *cache, io_error *error) {
    const int64_t per_frame = frame_size(cache), size = cache->file_size, start = cache->data_start;
    if (cache->frame_count > (INT64_MAX - start) / per_frame)
        return io_fail(error,
                       "%s: its header promises %" PRIu32 " frames of %" PRId64
                       " bytes, more than a file can hold: it has %" PRId64 " bytes",
                       cache->path, cache->frame_count, per_frame, size);
    const int64_t expected = start + cache->frame_count * per_frame;
    if (size == expected) return true;
    const int64_t whole = size < start ? 0 : (size - start) / per_frame;
    return io_fail(error,
                   "%s: too %s: %" PRId64 " bytes, expected %" PRId64 " for %" PRIu32 " frames of %" PRId64
                   " bytes from byte %" PRId64 "; it has room for %" PRId64 " whole frames",
                   cache->path, size < expected ? "short" : "long", size, expected, cache->frame_count,
                   per_frame, start, whole);
}

static bool read_header(point_cache *cache, io_error *error) {
    unsigned char header[POINT_CACHE_PC2_HEADER_SIZE];
    const int64_t size = read_at(cache->file, header, sizeof header, 0);
    if (size < 0) return io_fail(error, "%s: cannot read the header: %s", cache->path, strerror(errno));
    const bool magic = size >= POINT_CACHE_PC2_MAGIC_SIZE &&
                       memcmp(header, POINT_CACHE_PC2_MAGIC, POINT_CACHE_PC2_MAGIC_SIZE) == 0;
    const bool parsed = magic || !path_has_extension(cache->path, ".mdd")
                            ? parse_pc2_header(cache, header, (size_t)size, error)
                            : parse_mdd_header(cache, header, (size_t)size, error);
    return parsed && check_size(cache, error);
}

/* ---- the interface --------------------------------------------------------------------------------- */

static bool open_file(point_cache *cache, io_error *error) {
    struct stat status;
    cache->file = -1;
    if (stat(cache->path, &status) != 0)
        return io_fail(error, "%s: cannot open: %s", cache->path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return io_fail(error, "%s: not a regular file, expected a point cache", cache->path);
    cache->file = open(cache->path, O_RDONLY | O_CLOEXEC);
    if (cache->file < 0) return io_fail(error, "%s: cannot open: %s", cache->path, strerror(errno));
    if (fstat(cache->file, &status) != 0)
        return io_fail(error, "%s: cannot tell its size: %s", cache->path, strerror(errno));
    cache->file_size = status.st_size;
    return true;
}

bool point_cache_open(const char *path, uint32_t vertex_count, point_cache **out, io_error *error) {
    const size_t path_size = strlen(path) + 1;
    point_cache *cache = io_realloc(NULL, sizeof *cache + path_size);
    if (cache == NULL) return io_fail(error, "%s: out of memory", path);
    memset(cache, 0, sizeof *cache);
    memcpy(cache->path, path, path_size);
    cache->vertex_count = vertex_count;
    if (!open_file(cache, error) || !read_header(cache, error)) {
        point_cache_close(cache);
        return false;
    }
    *out = cache;
    return true;
}

void point_cache_close(point_cache *cache) {
    if (cache == NULL) return;
    if (cache->file >= 0) close(cache->file);
    free(cache);
}

int32_t point_cache_frame_number(const point_cache *cache, uint32_t frame) {
    return (int32_t)(cache->first_number + (int64_t)cache->number_step * frame);
}

uint32_t point_cache_frame_count(const point_cache *cache) {
    return cache->frame_count;
}

/* Decodes the values from byte `offset` on, which begin with vertex `first`. */
static bool decode_chunk(const point_cache *cache, uint32_t frame, uint32_t first, uint32_t count,
                         int64_t offset, double *positions, io_error *error) {
    for (size_t i = 0; i < (size_t)count * 3; i++) {
        const float value = load_float(cache->chunk + i * sizeof value, cache->big_endian);
        if (!isfinite(value))
            return io_fail(error,
                           "%s: sample %" PRIu32 ", vertex %zu, %c at byte %" PRId64
                           " is %f, expected a finite number",
                           cache->path, frame, first + i / 3, "xyz"[i % 3],
                           offset + (int64_t)(i * sizeof value), (double)value);
        positions[(size_t)first * 3 + i] = (double)value;
    }
    return true;
}

bool point_cache_read(point_cache *cache, uint32_t frame, double *positions, io_error *error) {
    const int64_t frame_start = cache->data_start + frame * frame_size(cache);
    for (uint32_t first = 0, count; first < cache->vertex_count; first += count) {
        const uint32_t left = cache->vertex_count - first;
        count = left < CHUNK_VERTICES ? left : CHUNK_VERTICES;
        const int64_t size = (int64_t)count * POINT_CACHE_VERTEX_SIZE;
        const int64_t offset = frame_start + (int64_t)first * POINT_CACHE_VERTEX_SIZE;
        const int64_t got = read_at(cache->file, cache->chunk, (size_t)size, offset);
        if (got < 0)
            return io_fail(error, "%s: sample %" PRIu32 ": cannot read at byte %" PRId64 ": %s", cache->path,
                           frame, offset, strerror(errno));
        if (got < size)
            return io_fail(error,
                           "%s: frame %" PRIu32
                           ": the file shrank while it was read: nothing at byte %" PRId64
                           ", expected %" PRId64 " bytes in all",
                           cache->path, frame, offset + got, cache->file_size);
        if (!decode_chunk(cache, frame, first, count, offset, positions, error)) return false;
    }
    return true;
}

/* ---- writing ------------------------------------------------------------------------------------------- */

#define _FILE_OFFSET_BITS 64 /* caches beyond 2 GiB on 32-bit systems too */

#include "tool/io/output_file.h"

#include <float.h>

enum { CHUNK_FLOATS = 4096 };

struct point_cache_writer {
    output_file out; /* its file is NULL after a failure */
    bool big_endian;
    uint32_t vertex_count, frame_count, written_count;
    uint32_t next;     /* the frame that is written next */
    float start, rate; /* of a PC2 header */
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
    return io_fail(error, "%s: cannot write frame %" PRIu32 ": %s", writer->path, writer->next,
                   io_write_reason());
}

static bool write_pc2_header(point_cache_writer *writer, io_error *error) {
    unsigned char *header = writer->chunk;
    memcpy(header, POINT_CACHE_PC2_MAGIC, POINT_CACHE_PC2_MAGIC_SIZE);
    store_uint32(header + 12, 1, false);
    store_uint32(header + 16, writer->vertex_count, false);
    store_float(header + 20, writer->start, false);
    store_float(header + 24, writer->rate, false);
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

static bool write_header(point_cache_writer *writer, io_error *error) {
    return writer->big_endian ? write_mdd_header(writer, error) : write_pc2_header(writer, error);
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
    return create_file(writer, error) && write_header(writer, error);
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
    writer->rate = 1.0F;
    if (!begin_file(writer, error)) {
        abandon_file(writer);
        free(writer);
        return false;
    }
    *out = writer;
    return true;
}

static bool write_frame(point_cache_writer *writer, const double *positions, io_error *error) {
    if (writer->next == writer->frame_count)
        return io_fail(error, "%s: one frame more than the %" PRIu32 " that its header promises",
                       writer->path, writer->frame_count);
    const size_t count = (size_t)writer->vertex_count * 3;
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        if (!(fabs(positions[i]) <= (double)FLT_MAX)) /* comparing NaN gives false */
            return io_fail(
                error, "%s: frame %" PRIu32 ", vertex %zu, %c is %g, expected a number that fits in float32",
                writer->path, writer->next, i / 3, "xyz"[i % 3], positions[i]);
        store_float(writer->chunk + used, (float)positions[i], writer->big_endian);
        used += sizeof(float);
        if (used == sizeof writer->chunk || i + 1 == count) {
            if (!write_bytes(writer, used, error)) return false;
            used = 0;
        }
    }
    writer->written_count++;
    writer->next++;
    return true;
}

/* ---- writing in another order --------------------------------------------------------------------------- */

/* The byte at which a frame begins, in a file of so many frames. */
static int64_t frame_offset(const point_cache_writer *writer, uint32_t frame_count, uint32_t frame) {
    const int64_t times = (int64_t)frame_count * (int64_t)sizeof(float);
    const int64_t start =
        writer->big_endian ? POINT_CACHE_MDD_HEADER_SIZE + times : POINT_CACHE_PC2_HEADER_SIZE;
    return start + (int64_t)frame * writer->vertex_count * POINT_CACHE_VERTEX_SIZE;
}

/* What was written before has to go to the file first, which may be full. */
static bool seek_to(point_cache_writer *writer, int64_t offset, io_error *error) {
    if (fseeko(writer->out.file, (off_t)offset, SEEK_SET) == 0) return true;
    if (errno != ESPIPE) return io_fail_write(error, writer->path);
    return io_fail(error, "%s: cannot write its frames in another order than theirs: %s", writer->path,
                   strerror(errno));
}

bool point_cache_writer_seek(point_cache_writer *writer, uint32_t frame, io_error *error) {
    if (writer->out.file == NULL) return io_fail(error, "%s: an earlier write failed", writer->path);
    if (frame == writer->next) return true;
    writer->next = frame;
    if (seek_to(writer, frame_offset(writer, writer->frame_count, frame), error)) return true;
    abandon_file(writer);
    return false;
}

static bool renew_header(point_cache_writer *writer, io_error *error) {
    return seek_to(writer, 0, error) && write_header(writer, error);
}

bool point_cache_writer_number(point_cache_writer *writer, int32_t first, uint32_t step, io_error *error) {
    const bool exact = (double)(float)first == (double)first && (double)(float)step == (double)step;
    if (writer->out.file == NULL) return io_fail(error, "%s: an earlier write failed", writer->path);
    if (!exact || (first == 0 && step == 1)) return true; /* as it is */
    writer->start = (float)first;
    writer->rate = (float)step;
    if (writer->big_endian || renew_header(writer, error)) return true;
    abandon_file(writer);
    return false;
}

/* Moves bytes towards the beginning. */
static bool move_bytes(point_cache_writer *writer, int64_t from, int64_t to, int64_t size, io_error *error) {
    FILE *file = writer->out.file;
    for (int64_t done = 0, part; done < size && from != to; done += part) {
        part = size - done < (int64_t)sizeof writer->chunk ? size - done : (int64_t)sizeof writer->chunk;
        if (!seek_to(writer, from + done, error)) return false;
        if (fread(writer->chunk, 1, (size_t)part, file) != (size_t)part)
            return io_fail(error, "%s: cannot read what was written: %s", writer->path, strerror(errno));
        if (!seek_to(writer, to + done, error) || !write_bytes(writer, (size_t)part, error)) return false;
    }
    return true;
}

static bool keep_frames(point_cache_writer *writer, uint32_t first, uint32_t count, io_error *error) {
    const int64_t from = frame_offset(writer, writer->frame_count, first),
                  to = frame_offset(writer, count, 0);
    const int64_t end = frame_offset(writer, count, count);
    if (!move_bytes(writer, from, to, end - to, error)) return false;
    writer->start += (float)first * writer->rate;
    writer->frame_count = writer->written_count = count;
    return renew_header(writer, error) &&
           ((fflush(writer->out.file) == 0 && ftruncate(fileno(writer->out.file), (off_t)end) == 0) ||
            io_fail_write(error, writer->path));
}

bool point_cache_writer_keep(point_cache_writer *writer, uint32_t first, uint32_t count, io_error *error) {
    if (writer->out.file == NULL) return io_fail(error, "%s: an earlier write failed", writer->path);
    if (keep_frames(writer, first, count, error)) return true;
    abandon_file(writer);
    return false;
}

/* ---- writing: the interface ----------------------------------------------------------------------------- */

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

void point_cache_writer_abandon(point_cache_writer *writer) {
    if (writer != NULL) abandon_file(writer);
    free(writer);
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
