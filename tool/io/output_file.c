/* Files that are written: one that takes another's place only when it is complete, where "-" is the standard
 * output; and one that only grows. */
#include "tool/io/output_file.h"

#include "tool/io/io.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINKS_MAX = 40, NAMES_MAX = 1000 };

/* The folder of path, with its slash, and then name; to be freed. */
static char *name_beside(const char *path, const char *name) {
    const char *slash = path_last_separator(path);
    size_t folder_size = slash != NULL ? (size_t)(slash - path) + 1 : 0, name_size = strlen(name) + 1;
    char *joined = malloc(folder_size + name_size);
    if (joined == NULL) return NULL;
    memcpy(joined, path, folder_size);
    memcpy(joined + folder_size, name, name_size);
    return joined;
}

/* The path that a link leads to, whether a file is there or not; to be freed. */
static char *follow_links(const char *path) {
    char *target = name_beside("", path);
    for (int i = 0; i < LINKS_MAX && target != NULL; i++) {
        char link[PATH_MAX];
        ssize_t size = readlink(target, link, sizeof link - 1);
        if (size < 0) return target;
        link[size] = '\0';
        char *next = name_beside(link[0] == '/' ? "" : target, link);
        free(target);
        target = next;
    }
    if (target != NULL) errno = ELOOP;
    free(target);
    return NULL;
}

/* Creates a new file in the target's folder. Its name is short, because the target's may be as long as
 * names can be. */
static int create_temporary(output_file *f) {
    for (int i = 0; i < NAMES_MAX; i++) {
        char name[64];
        snprintf(name, sizeof name, ".cscd-output-%ld-%d", (long)getpid(), i);
        f->temporary = name_beside(f->target, name);
        if (f->temporary == NULL) return -1;
        int descriptor = open(f->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) return descriptor;
        int cause = errno;
        free(f->temporary);
        f->temporary = NULL;
        errno = cause;
        if (cause != EEXIST) return -1;
    }
    return -1;
}

/* Is the path that of a file which is open already? */
static bool names_descriptor(const char *path) {
    return strncmp(path, "/dev/", 5) == 0 || strncmp(path, "/proc/", 6) == 0;
}

/* replaced: the file that is there, NULL if there is none. */
static bool open_temporary(output_file *f, const struct stat *replaced) {
    if (replaced != NULL && access(f->target, W_OK) != 0) return false;
    int descriptor = create_temporary(f);
    if (descriptor < 0) {
        /* The file may be written where its folder may not: it is then written itself. */
        bool only_in_place = replaced != NULL && (errno == EACCES || errno == EPERM || errno == EROFS);
        f->file = only_in_place ? fopen(f->target, "w+b") : NULL;
        return f->file != NULL;
    }
    if (replaced == NULL || fchmod(descriptor, replaced->st_mode & 07777) == 0)
        f->file = fdopen(descriptor, "w+b");
    if (f->file != NULL) return true;
    int cause = errno;
    close(descriptor);
    unlink(f->temporary);
    errno = cause;
    return false;
}

/* One that was closed may be held by a file that cannot be written (main.c). */
bool output_file_standard_opens(void) {
    const int flags = fcntl(STDOUT_FILENO, F_GETFL);
    if (flags >= 0 && (flags & O_ACCMODE) == O_RDONLY) errno = EBADF;
    return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

/* Takes the standard output for the file, and leaves the standard error to whatever is printed. */
static FILE *open_standard(void) {
    if (!output_file_standard_opens()) return NULL;
    int descriptor = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (descriptor < 0) return NULL;
    FILE *file =
        fflush(stdout) == 0 && dup2(STDERR_FILENO, STDOUT_FILENO) >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (file != NULL) return file;
    int cause = errno;
    close(descriptor);
    errno = cause;
    return NULL;
}

static void free_names(output_file *f) {
    int cause = errno;
    free(f->target);
    free(f->temporary);
    *f = (output_file){0};
    errno = cause;
}

bool output_file_is_standard(const char *path) {
    return path != NULL && strcmp(path, "-") == 0;
}

bool output_file_open(const char *path, output_file *out) {
    output_file f = {0};
    struct stat status;
    bool standard = output_file_is_standard(path), exists = !standard && stat(path, &status) == 0;
    if (standard)
        f.file = open_standard();
    else if (exists && S_ISFIFO(status.st_mode))
        f.file = pipe_file_write(path);
    else if (exists && (!S_ISREG(status.st_mode) || names_descriptor(path)))
        f.file = fopen(path, "wb");
    else if ((f.target = follow_links(path)) != NULL)
        open_temporary(&f, exists ? &status : NULL);
    if (f.file == NULL) {
        free_names(&f);
        return false;
    }
    *out = f;
    return true;
}

/* A stream knows only that it has failed, and errno soon is of something else. */
static bool note_cause(output_file *f) {
    if (f->cause == 0) f->cause = errno != 0 ? errno : EIO;
    errno = f->cause;
    return false;
}

bool output_file_writes(output_file *f) {
    return !ferror(f->file) || note_cause(f);
}

bool output_file_flush(output_file *f) {
    if (fflush(f->file) != 0 || ferror(f->file)) return note_cause(f);
    off_t size = f->temporary != NULL ? ftello(f->file) : -1;
    if (size >= 0) f->whole_size = size;
    return true;
}

/* Keeps what was written up to the last flush, without what a full disk has cut off behind it. */
static bool cut_to_whole(const output_file *f) {
    return f->temporary != NULL && f->whole_size > 0 && truncate(f->temporary, f->whole_size) == 0;
}

bool output_file_close(output_file *f, output_ending ending) {
    bool written = output_file_writes(f);
    int cause = errno;
    if (fclose(f->file) != 0 && written) {
        written = false;
        cause = errno;
    }
    if (ending == OUTPUT_ABANDONED) written = false;
    bool placed = written || (ending == OUTPUT_WHOLE_LINES && cut_to_whole(f));
    if (placed && f->temporary != NULL && rename(f->temporary, f->target) != 0) {
        placed = written = false;
        cause = errno;
    }
    if (!placed && f->temporary != NULL) unlink(f->temporary);
    free_names(f);
    errno = cause;
    return written;
}

/* ---- files that only grow ------------------------------------------------------------------------------ */

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

/* Bytes that go to a file that has no name any more, or that somebody else changes, would be lost. */
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
