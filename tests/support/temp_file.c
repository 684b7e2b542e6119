/* A temporary folder for a test, and files of given bytes in it. */
#include "tests/support/temp_file.h"

#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void require_done(bool done, const char *action, const char *path) {
    if (done) return;
    fprintf(stderr, "cannot %s %s: %s\n", action, path, strerror(errno));
    abort();
}

temp_folder temp_folder_make(void) {
    temp_folder folder;
    const char *parent = getenv("TMPDIR");
    if (parent == NULL || strlen(parent) > sizeof folder.path / 2) parent = "/tmp";
    snprintf(folder.path, sizeof folder.path, "%s/cscd-test-XXXXXX", parent);
    require_done(mkdtemp(folder.path) != NULL, "make", folder.path);
    return folder;
}

void temp_folder_remove(const temp_folder *folder) {
    DIR *entries = opendir(folder->path);
    require_done(entries != NULL, "list", folder->path);
    for (struct dirent *entry = readdir(entries); entry != NULL; entry = readdir(entries)) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        temp_path path = temp_file_path(folder, entry->d_name);
        require_done(remove(path.text) == 0, "remove", path.text);
    }
    closedir(entries);
    require_done(rmdir(folder->path) == 0, "remove", folder->path);
}

temp_path temp_file_path(const temp_folder *folder, const char *name) {
    temp_path path;
    int length = snprintf(path.text, sizeof path.text, "%s/%s", folder->path, name);
    require_done(length > 0 && (size_t)length < sizeof path.text, "name", name);
    return path;
}

temp_path temp_file_write(const temp_folder *folder, const char *name, const void *bytes, size_t size) {
    temp_path path = temp_file_path(folder, name);
    /* Where a file is emptied and written again, file systems wait for the disk; a new one takes as long under wine. */
    FILE *file = fopen(path.text, "r+b");
    if (file == NULL) file = fopen(path.text, "wb");
    require_done(file != NULL, "create", path.text);
    require_done(fwrite(bytes, 1, size, file) == size && fflush(file) == 0, "write", path.text);
    require_done(ftruncate(fileno(file), (off_t)size) == 0, "cut", path.text);
    require_done(fclose(file) == 0, "close", path.text);
    return path;
}

char *temp_file_read(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    require_done(file != NULL && fseek(file, 0, SEEK_END) == 0, "open", path);
    const long length = ftell(file);
    char *text = malloc((size_t)length + 1);
    rewind(file);
    require_done(text != NULL && fread(text, 1, (size_t)length, file) == (size_t)length, "read", path);
    text[length] = '\0';
    fclose(file);
    if (size != NULL) *size = (size_t)length;
    return text;
}
