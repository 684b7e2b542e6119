/* Links from a page to other files, relative to its own place. */
#include "tool/report/page_link.h"

#include "tool/io/io.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Takes the last name away. */
static size_t parent_length(const char *path, size_t length) {
    while (length > 0 && path[length - 1] != '/') length--;
    return length > 0 ? length - 1 : 0;
}

/* Adds the names of a path to a folder, in place. */
static void add_names(char *folder, const char *path) {
    size_t length = strlen(folder);
    while (*path != '\0') {
        const size_t size = strcspn(path, PATH_SEPARATORS);
        const bool stays = size == 0 || (size == 1 && path[0] == '.');
        if (size == 2 && memcmp(path, "..", 2) == 0)
            length = parent_length(folder, length);
        else if (!stays) {
            folder[length++] = '/';
            memcpy(folder + length, path, size);
            length += size;
        }
        path += size + path_is_separator(path[size]);
    }
    folder[length] = '\0';
}

static char *absolute_path(const char *here, const char *path) {
    char *whole = malloc(strlen(here) + strlen(path) + 2);
    if (whole == NULL) return NULL;
    const size_t drive = path_drive_length(path);
    strcpy(whole, drive > 0 || path_is_separator(path[0]) ? "" : here);
    if (drive > 0) snprintf(whole, drive + 1, "%s", path);
    add_names(whole, path + drive);
    return whole;
}

/* A folder that links do not lead away from; one that does not exist is taken as it is called. */
static char *real_folder(const char *here, const char *folder) {
    char *found = realpath(folder, NULL);
    if (found == NULL) return absolute_path(here, folder);
    const size_t drive = path_drive_length(found);
    if (strcmp(found + drive, "/") == 0) found[drive] = '\0';
    return found;
}

bool page_folder_find(const char *page, page_folder *out) {
    const char *slash = path_last_separator(page);
    char *folder = slash != NULL ? strndup(page, (size_t)(slash - page) + 1) : strdup(".");
    out->here = real_folder("", ".");
    out->page = folder != NULL && out->here != NULL ? real_folder(out->here, folder) : NULL;
    free(folder);
    return out->page != NULL;
}

void page_folder_free(page_folder *folder) {
    free(folder->page);
    free(folder->here);
}

/* The length of the folders that both have in common. */
static size_t common_length(const char *folder, const char *path) {
    size_t common = 0, i = 0;
    for (;; i++) {
        const bool ends = folder[i] == '\0' || folder[i] == '/';
        if (ends && (path[i] == '/' || path[i] == '\0')) common = i;
        if (folder[i] == '\0' || folder[i] != path[i]) return common;
    }
}

char *page_link_make(const page_folder *folder, const char *path) {
    char *target = absolute_path(folder->here, path);
    if (target == NULL) return NULL;
    const size_t common = common_length(folder->page, target);
    size_t up = 0;
    for (const char *c = folder->page + common; *c != '\0'; c++) up += *c == '/';
    char *link = malloc(3 * up + strlen(target + common) + 1), *at = link;
    if (link != NULL) {
        for (size_t i = 0; i < up; i++, at += 3) memcpy(at, "../", 3);
        strcpy(at, target + common + (target[common] == '/'));
    }
    free(target);
    return link;
}
