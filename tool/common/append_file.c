/* A file that only grows, by whole records, and has one writer. */
#include "tool/common/append_file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static bool cannot_write(const append_file *f, int cause, io_error *error) {
    errno = cause;
    return io_fail_write(error, f->path);
}

/* File systems without locks are taken as they are. */
static bool lock_file(const append_file *f, io_error *error) {
    if (flock(f->file, LOCK_EX | LOCK_NB) == 0 || errno == ENOLCK || errno == EOPNOTSUPP || errno == ENOSYS)
        return true;
    if (errno == EWOULDBLOCK)
        return io_fail(
            error, "%s: another process writes its results here; give each shard a file of its own", f->path);
    return io_fail(error, "%s: cannot lock: %s", f->path, strerror(errno));
}

/* Devices, as /dev/null is one, take records and hold none. */
static bool measure_file(append_file *f, io_error *error) {
    struct stat status;
    if (fstat(f->file, &status) != 0) return cannot_write(f, errno, error);
    if (S_ISFIFO(status.st_mode))
        return io_fail(error, "%s: is a pipe, and results are kept in a file; name one", f->path);
    f->regular = S_ISREG(status.st_mode);
    f->size = f->regular ? status.st_size : 0;
    return true;
}

bool append_file_open(const char *path, append_file *out, io_error *error) {
    append_file f = {.path = path, .file = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666)};
    if (f.file < 0) return cannot_write(&f, errno, error);
    if (!lock_file(&f, error) || !measure_file(&f, error)) {
        append_file_drop(&f);
        return false;
    }
    *out = f;
    return true;
}

bool append_file_cut(append_file *f, off_t size, io_error *error) {
    if (f->size != size && ftruncate(f->file, size) != 0) return cannot_write(f, errno, error);
    f->size = size;
    return true;
}

/* What would be written to a file that has no name any more, or that somebody else changes, would be lost. */
static bool file_is_ours(const append_file *f, io_error *error) {
    struct stat own, named;
    if (!f->regular || fstat(f->file, &own) != 0) return true;
    const bool is_there = stat(f->path, &named) == 0;
    if ((!is_there && errno == ENOENT) ||
        (is_there && (named.st_dev != own.st_dev || named.st_ino != own.st_ino)))
        return io_fail(
            error,
            "%s: was removed or replaced while it was written, and its results with it; run them again",
            f->path);
    return own.st_size == f->size ||
           io_fail(error, "%s: was changed by another process while it was written; --resume goes on with it",
                   f->path);
}

bool append_file_add(append_file *f, const void *record, size_t size, io_error *error) {
    size_t written = 0;
    if (!file_is_ours(f, error)) return false;
    while (written < size) {
        const ssize_t more = write(f->file, (const char *)record + written, size - written);
        if (more < 0 && errno == EINTR) continue;
        if (more < 0) {
            const int cause = errno;
            if (written > 0 && ftruncate(f->file, f->size) != 0) written = 0; /* resuming cuts it off */
            return cannot_write(f, cause, error);
        }
        written += (size_t)more;
    }
    f->size += (off_t)size;
    return true;
}

void append_file_drop(append_file *f) {
    if (f->file >= 0) close(f->file);
    f->file = -1;
}

bool append_file_close(append_file *f, io_error *error) {
    bool good = f->file < 0 || file_is_ours(f, error);
    if (good && f->file >= 0 && fsync(f->file) != 0 && errno != EINVAL && errno != EROFS)
        good = cannot_write(f, errno, error);
    append_file_drop(f);
    return good;
}
