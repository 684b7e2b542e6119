/* What is in a folder. */
#include "tool/windows/posix.h"

#include "tool/windows/wide.h"

#include <errno.h>
#include <windows.h>

struct windows_folder {
    HANDLE search;
    WIN32_FIND_DATAW found;
    bool ready; /* found holds an entry that was not read yet */
    struct windows_entry entry;
    char path[];
};

static HANDLE begin_search(const char *path, WIN32_FIND_DATAW *found) {
    const size_t length = strlen(path);
    char *pattern = malloc(length + 3);
    if (pattern == NULL) return INVALID_HANDLE_VALUE;
    memcpy(pattern, path, length);
    strcpy(pattern + length, "/*");
    wchar_t *wide = wide_path(pattern);
    free(pattern);
    const HANDLE search = wide != NULL ? FindFirstFileW(wide, found) : INVALID_HANDLE_VALUE;
    if (wide != NULL && search == INVALID_HANDLE_VALUE) wide_failure();
    free(wide);
    return search;
}

windows_folder *windows_opendir(const char *path) {
    struct windows_stat status;
    if (windows_stat(path, &status) != 0) return NULL;
    if (!S_ISDIR(status.st_mode)) {
        errno = ENOTDIR;
        return NULL;
    }
    const size_t size = strlen(path) + 1;
    windows_folder *folder = malloc(sizeof *folder + size);
    if (folder == NULL) return NULL;
    memcpy(folder->path, path, size);
    folder->search = begin_search(path, &folder->found);
    folder->ready = true;
    if (folder->search != INVALID_HANDLE_VALUE) return folder;
    free(folder);
    return NULL;
}

struct windows_entry *windows_readdir(windows_folder *folder) {
    if (!folder->ready && !FindNextFileW(folder->search, &folder->found)) {
        if (GetLastError() != ERROR_NO_MORE_FILES) wide_failure();
        return NULL;
    }
    folder->ready = false;
    char *name = narrow_text(folder->found.cFileName);
    if (name == NULL) return NULL;
    snprintf(folder->entry.d_name, sizeof folder->entry.d_name, "%s", name);
    free(name);
    return &folder->entry;
}

int windows_closedir(windows_folder *folder) {
    FindClose(folder->search);
    free(folder);
    return 0;
}

int windows_fstatat(windows_folder *folder, const char *name, struct windows_stat *out, int flags) {
    (void)flags;
    const size_t folder_size = strlen(folder->path), name_size = strlen(name) + 1;
    char *path = malloc(folder_size + 1 + name_size);
    if (path == NULL) return -1;
    memcpy(path, folder->path, folder_size);
    path[folder_size] = '/';
    memcpy(path + folder_size + 1, name, name_size);
    const int result = windows_stat(path, out);
    free(path);
    return result;
}
