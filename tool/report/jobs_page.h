/* The page of many jobs: a table of all of them, the worst first. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stdint.h>

/* What is known of a job in numbers; NaN: nothing. A column that no job has is not shown. */
typedef enum jobs_page_number {
    JOBS_PAGE_CROSSING_FRAMES,
    JOBS_PAGE_FRAMES, /* that were looked at */
    JOBS_PAGE_EVENTS,
    JOBS_PAGE_DEPTH,
    JOBS_PAGE_PAIRS,
    JOBS_PAGE_SECONDS,
    JOBS_PAGE_NUMBERS
} jobs_page_number;

typedef struct jobs_page_row {
    uint8_t outcome; /* one of the page's outcomes */
    bool found;      /* what the rules of the run ask for */
    const char *name, *answer;
    const char *report; /* the path of its page, from the current folder; "": it has none */
    double numbers[JOBS_PAGE_NUMBERS];
} jobs_page_row;

typedef struct jobs_page_options {
    const char *path; /* of the page: links to others are relative to its folder */
    const char *title, *generator;
    const char *const
        *outcomes; /* their names, up to a NULL; the page has words for those of docs/artist/formats.md */
    const char *missing; /* the jobs that are not done, in words; "": none */
    uint64_t list;       /* the hash of the list */
} jobs_page_options;

typedef struct jobs_page jobs_page;

/* Everything that the options point to outlives the page. */
bool jobs_page_create(const jobs_page_options *options, jobs_page **out, io_error *error);
void jobs_page_destroy(jobs_page *page);

/* The next job, in the order of the list; the row is copied. */
bool jobs_page_add(jobs_page *page, const jobs_page_row *row, io_error *error);

/* Puts the page at its path in one go. Once. */
bool jobs_page_write(jobs_page *page, io_error *error);
