/* Which files the system has in memory. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* How many pages the file has. */
size_t page_cache_pages(const char *path);

/* How many of these pages are in memory. */
size_t page_cache_count(const char *path);

/* Takes the file out of memory. False where this cannot be: its file system has no disk, or somebody else uses it. */
bool page_cache_drop(const char *path);

/* Waits until the whole file is in memory; the test fails if that takes longer than ten seconds. */
void page_cache_expect(const char *path);
