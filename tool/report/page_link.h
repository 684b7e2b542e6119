/* Links from a page to other files, relative to its own place, so that both may move together. */
#pragma once

#include <stdbool.h>

typedef struct page_folder {
    char *page, *here; /* the folder of the page, and the one that paths count from; "/" alone is "" */
} page_folder;

/* Finds the folder of a page; "-", the standard output, is in the current one. False: memory is short. */
bool page_folder_find(const char *page, page_folder *out);
void page_folder_free(page_folder *folder);

/* The path of a file as it is called from the page's folder, without "." and ".." but at its beginning; to be freed. NULL: memory is
 * short. */
char *page_link_make(const page_folder *folder, const char *path);
