/* A whole file in memory, a position in it, and errors that name the place. */
#include "tool/io/file_reader.h"

#include "tool/io/growable.h"
#include "tool/io/path_name.h"
#include "tool/io/pipe_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A longer path would leave no room for what is wrong, so only its end is shown. */
enum { SHOWN_PATH_LENGTH = 500, MESSAGE_SIZE = sizeof((io_error *)0)->text };

static size_t write_path(char *message, const char *path) {
    size_t length = strlen(path);
    bool cut = length > SHOWN_PATH_LENGTH;
    const char *shown = cut ? path + length - SHOWN_PATH_LENGTH : path;
    while (cut && ((unsigned char)*shown & 0xc0) == 0x80) shown++; /* within a character */
    return (size_t)snprintf(message, MESSAGE_SIZE, "%s%s", cut ? "..." : "", shown);
}

static void write_rest(char *message, size_t used, const char *format, va_list arguments)
    __attribute__((format(printf, 3, 0)));

static void write_rest(char *message, size_t used, const char *format, va_list arguments) {
    vsnprintf(message + used, MESSAGE_SIZE - used, format, arguments);
}

bool file_reader_fail(file_reader *reader, const char *format, ...) {
    char message[MESSAGE_SIZE];
    size_t used = write_path(message, reader->path);
    used += (size_t)snprintf(message + used, MESSAGE_SIZE - used, ": ");
    va_list arguments;
    va_start(arguments, format);
    write_rest(message, used, format, arguments);
    va_end(arguments);
    return io_fail(reader->error, "%s", message);
}

bool file_reader_fail_here(file_reader *reader, const char *format, ...) {
    char message[MESSAGE_SIZE];
    size_t used = write_path(message, reader->path);
    const char *place = reader->binary ? ": byte %zu: " : ":%zu: ";
    size_t number = reader->binary ? reader->mark : reader->line;
    used += (size_t)snprintf(message + used, MESSAGE_SIZE - used, place, number);
    va_list arguments;
    va_start(arguments, format);
    write_rest(message, used, format, arguments);
    va_end(arguments);
    return io_fail(reader->error, "%s", message);
}

/* The size that fstat gives is only a hint: pipes have none, and a file may grow while it is read. */
static bool read_all(file_reader *reader, FILE *file, size_t expected_size, growable *bytes) {
    if (!growable_reserve(bytes, expected_size)) goto out_of_memory;
    for (;;) {
        size_t room = bytes->capacity - bytes->count - 1; /* one for the 0 */
        size_t got = fread((char *)bytes->data + bytes->count, 1, room, file);
        bytes->count += got;
        if (got < room) break;
        if (bytes->capacity > SIZE_MAX / 2 || !growable_reserve(bytes, 2 * bytes->capacity))
            goto out_of_memory;
    }
    if (ferror(file)) return file_reader_fail(reader, "cannot read: %s", strerror(errno));
    ((char *)bytes->data)[bytes->count] = '\0';
    return true;

out_of_memory:
    return file_reader_fail(reader, "out of memory for a file of %zu bytes or more",
                            bytes->count > expected_size ? bytes->count : expected_size);
}

static bool read_file(file_reader *reader, FILE *file) {
    struct stat status = {.st_mode = S_IFIFO};
    if (fileno(file) >= 0 && fstat(fileno(file), &status) != 0)
        return file_reader_fail(reader, "cannot open: %s", strerror(errno));
    if (S_ISDIR(status.st_mode)) return file_reader_fail(reader, "is a directory, expected a file");
    if (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)) {
        return file_reader_fail(reader, "is a device, expected a file");
    }
    /* One byte more than the file holds, so that the first read already meets its end, and one for the 0. */
    uintmax_t expected_size = (uintmax_t)(status.st_size > 0 ? status.st_size : 4096) + 2;
    growable bytes = growable_of(1);
    bool done = read_all(reader, file, expected_size > SIZE_MAX ? SIZE_MAX : (size_t)expected_size, &bytes);
    if (done) {
        reader->size = bytes.count;
        reader->bytes = bytes.data;
    } else {
        growable_free(&bytes);
    }
    return done;
}

bool file_reader_open(file_reader *reader, const char *path, io_error *error) {
    *reader = (file_reader){.path = path, .error = error, .line = 1};
    FILE *file = pipe_file_read(path);
    if (file == NULL)
        return file_reader_fail(reader, "cannot open: %s%s", strerror(errno),
                                errno == ENOENT ? path_missing_advice(path) : "");
    bool done = read_file(reader, file);
    fclose(file);
    return done;
}

void file_reader_close(file_reader *reader) {
    free(reader->bytes);
    *reader = (file_reader){0};
}

void file_reader_expect(const char *path) {
#ifdef POSIX_FADV_WILLNEED
    struct stat status;
    /* Whoever writes a pipe would take this for its reader. */
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode)) return;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) return;
    posix_fadvise(file, 0, 0, POSIX_FADV_WILLNEED);
    close(file);
#else
    (void)path;
#endif
}
