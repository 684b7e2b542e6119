/* Keeps a command from writing over what it reads. */
#include "tool/common/output_path.h"

#include "tool/io/output_file.h"
#include "tool/io/path_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Do two paths name one file that does not exist yet: the same name in the same folder? */
static bool same_place(const char *a, const char *b) {
    const char *names[2] = {a, b};
    char *folders[2] = {NULL, NULL};
    for (int i = 0; i < 2; i++) {
        const char *slash = path_last_separator(names[i]);
        char *folder = slash != NULL ? strndup(names[i], (size_t)(slash - names[i]) + 1) : strdup(".");
        folders[i] = folder != NULL ? realpath(folder, NULL) : NULL;
        free(folder);
        names[i] = slash != NULL ? slash + 1 : names[i];
    }
    bool same = folders[0] != NULL && folders[1] != NULL && strcmp(folders[0], folders[1]) == 0 &&
                strcmp(names[0], names[1]) == 0;
    free(folders[0]);
    free(folders[1]);
    return same;
}

static bool same_file(const char *a, const char *b) {
    struct stat first, second;
    if (strcmp(a, b) == 0 || same_place(a, b)) return true;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && S_ISREG(first.st_mode) &&
           first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

static bool named_like_input(const char *path) {
    static const char *const others[] = {".pc2", ".mdd"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (path_has_extension(path, others[i])) return true;
    return path_mesh_ending(path) > 0;
}

bool output_path_fits(const char *path, const char *ending, io_error *error) {
    static const char *const known[] = {".png", ".jpg", ".jpeg", ".gif",  ".bmp",  ".tif",   ".tiff", ".webp",
                                        ".svg", ".exr", ".pdf",  ".html", ".json", ".jsonl", ".csv",  ".tsv",
                                        ".txt", ".xml", ".xlsx", ".md",   ".vtk",  ".vtp",   ".mp4",  ".mov"};
    for (size_t i = 0; path != NULL && i < sizeof known / sizeof *known; i++) {
        if (path_has_extension(path, known[i]) && strcmp(known[i], ending) != 0)
            return io_fail(error, "'%s' would be no %s file; choose a name that ends in %s", path,
                           known[i] + 1, ending);
    }
    return true;
}

/* Removes the file that was created to see whether it can be; a link that led to nothing stays. */
static void remove_created(const char *path) {
    char *target = realpath(path, NULL);
    if (target != NULL) unlink(target);
    free(target);
}

/* A pipe is not opened: its reader would take the end of this writer for the end of the data. */
static bool try_open(const char *path) {
    struct stat status;
    if (output_file_is_standard(path)) return output_file_standard_opens();
    bool exists = stat(path, &status) == 0;
    if (exists && S_ISFIFO(status.st_mode)) return access(path, W_OK) == 0;
    FILE *file = fopen(path, "ab");
    if (file == NULL) return false;
    fclose(file);
    if (!exists) remove_created(path);
    return true;
}

bool output_path_opens(const char *path, io_error *error) {
    return path == NULL || try_open(path) || io_fail_write(error, path);
}

bool output_path_differs(const char *path, const char *const *others, size_t other_count, io_error *error) {
    for (size_t i = 0; path != NULL && i < other_count; i++) {
        if (others[i] == NULL) continue;
        if (output_file_is_standard(path) && output_file_is_standard(others[i]))
            return io_fail(error, "- would be the standard output twice; give the other output a file");
        if (same_file(path, others[i])) return io_fail(error, "'%s' would overwrite '%s'", path, others[i]);
    }
    return true;
}

bool output_path_is_safe(const char *path, const char *const *others, size_t other_count, io_error *error) {
    if (path == NULL) return true;
    if (!output_path_differs(path, others, other_count, error)) return false;
    char *target = realpath(path, NULL);
    bool like_input = named_like_input(path) || (target != NULL && named_like_input(target));
    free(target);
    return !like_input ||
           io_fail(error, "'%s' is named like a mesh or a point cache; choose another name", path);
}
