/* Named pipes that a signal interrupts. A look at a flag before open(2) or read(2) would be a moment too
 * early for a signal that comes between the two, and the call then waits for ever. So no call here waits
 * without an end: pipes are opened without waiting, poll(2) waits for their bytes, and both end soon enough
 * to look again. */
#include "tool/io/io.h"

#include <stdatomic.h>

/* Signals belong to the process, and so does whom to ask about them. */
static _Atomic(bool (*)(void)) asked;

void pipe_file_ask(bool (*stopped)(void)) {
    atomic_store(&asked, stopped);
}

#ifdef __linux__

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum {
    LOOK_MS = 100, /* between two looks, when a signal goes to another thread; else it ends the wait itself */
    FIRST_NAP = 1, /* ms, until the first look for a reader; */
    LONGEST_NAP = 50 /* they grow to this */
};

/* Sets errno when the program is to stop. */
static bool goes_on(void) {
    bool (*const stopped)(void) = atomic_load(&asked);
    if (stopped == NULL || !stopped()) return true;
    errno = EINTR;
    return false;
}

static bool is_pipe(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISFIFO(status.st_mode);
}

/* ---- reading ------------------------------------------------------------------------------------------- */

/* Until there are bytes, or nobody is left to write any. That nobody has come yet is neither, as poll
 * has it. */
static bool await_bytes(int file) {
    struct pollfd polled = {.fd = file, .events = POLLIN};
    for (int found = 0; found <= 0;) {
        if (!goes_on()) return false;
        found = poll(&polled, 1, LOOK_MS);
        if (found < 0 && errno != EINTR) return false;
    }
    return true;
}

static ssize_t read_pipe(void *file, char *bytes, size_t size) {
    const int *descriptor = file;
    for (;;) {
        if (!await_bytes(*descriptor)) return -1;
        const ssize_t got = read(*descriptor, bytes, size);
        if (got >= 0 || (errno != EAGAIN && errno != EINTR)) return got; /* another reader may be faster */
    }
}

static int close_pipe(void *file) {
    int *descriptor = file;
    const int result = close(*descriptor);
    free(descriptor);
    return result;
}

static FILE *stream_of(int descriptor) {
    int *file = malloc(sizeof *file);
    FILE *stream = NULL;
    if (file != NULL) {
        *file = descriptor;
        stream = fopencookie(file, "rb", (cookie_io_functions_t){.read = read_pipe, .close = close_pipe});
    }
    if (stream != NULL) return stream;
    free(file);
    close(descriptor);
    errno = ENOMEM;
    return NULL;
}

FILE *pipe_file_read(const char *path) {
    if (atomic_load(&asked) == NULL || !is_pipe(path)) return fopen(path, "rb");
    const int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    return descriptor >= 0 ? stream_of(descriptor) : NULL;
}

/* ---- writing ------------------------------------------------------------------------------------------- */

/* Without a reader a pipe cannot be opened without waiting, and nothing tells when one comes. */
static int await_reader(const char *path) {
    for (int nap = FIRST_NAP;; nap = 2 * nap < LONGEST_NAP ? 2 * nap : LONGEST_NAP) {
        if (!goes_on()) return -1;
        const int file = open(path, O_WRONLY | O_NONBLOCK | O_CLOEXEC);
        if (file >= 0 || errno != ENXIO) return file;
        nanosleep(&(struct timespec){.tv_nsec = nap * 1000000L}, NULL);
    }
}

FILE *pipe_file_write(const char *path) {
    if (atomic_load(&asked) == NULL) return fopen(path, "wb");
    const int file = await_reader(path);
    if (file < 0) return NULL;
    const int flags = fcntl(file, F_GETFL);
    FILE *stream = flags >= 0 && fcntl(file, F_SETFL, flags & ~O_NONBLOCK) == 0 ? fdopen(file, "wb") : NULL;
    if (stream != NULL) return stream;
    const int cause = errno;
    close(file);
    errno = cause;
    return NULL;
}

#else

/* Pipes are others elsewhere, and so are streams of one's own; there a second signal ends the wait, and the
 * process. */
FILE *pipe_file_read(const char *path) {
    return fopen(path, "rb");
}

FILE *pipe_file_write(const char *path) {
    return fopen(path, "wb");
}

#endif
