/* A file that takes another's place only when it is complete. */
#include "src/tool/report/replacing_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINKS_MAX = 40, NAMES_MAX = 1000 };

/* The folder of path, with its slash, and then name; to be freed. */
static char *name_beside(const char *path, const char *name) {
    const char *slash = strrchr(path, '/');
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
static int create_temporary(replacing_file *f) {
    for (int i = 0; i < NAMES_MAX; i++) {
        char name[64];
        snprintf(name, sizeof name, ".cscd-report-%ld-%d", (long)getpid(), i);
        f->temporary = name_beside(f->target, name);
        if (f->temporary == NULL) return -1;
        int descriptor = open(f->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) return descriptor;
        int cause = errno;
        free(f->temporary);
        f->temporary = NULL;
        errno = cause;
        if (cause != EEXIST) return -1;
    }
    return -1;
}

/* replaced: the file that is there, NULL if there is none. */
static bool open_temporary(replacing_file *f, const struct stat *replaced) {
    if (replaced != NULL && access(f->target, W_OK) != 0) return false;
    int descriptor = create_temporary(f);
    if (descriptor < 0) return false;
    if (replaced == NULL || fchmod(descriptor, replaced->st_mode & 07777) == 0)
        f->file = fdopen(descriptor, "wb");
    if (f->file != NULL) return true;
    int cause = errno;
    close(descriptor);
    unlink(f->temporary);
    errno = cause;
    return false;
}

static void free_names(replacing_file *f) {
    int cause = errno;
    free(f->target);
    free(f->temporary);
    *f = (replacing_file){0};
    errno = cause;
}

bool replacing_file_open(const char *path, replacing_file *out) {
    replacing_file f = {0};
    struct stat status;
    bool exists = stat(path, &status) == 0;
    if (exists && !S_ISREG(status.st_mode))
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

bool replacing_file_close(replacing_file *f, bool complete) {
    int cause = errno;
    bool written = fclose(f->file) == 0;
    if (complete && !written) cause = errno;
    bool placed = complete && written;
    if (placed && f->temporary != NULL && rename(f->temporary, f->target) != 0) {
        placed = false;
        cause = errno;
    }
    if (!placed && f->temporary != NULL) unlink(f->temporary);
    free_names(f);
    errno = cause;
    return placed;
}
