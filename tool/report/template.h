/* The pages without their data: tool/report/template.html and jobs.html, parts of the program. */
#pragma once

#include "tool/io/io.h"

#include <stddef.h>

/* The text before the place of the data, and the text behind it. */
typedef struct report_template {
    const char *head, *tail;
    size_t head_size, tail_size;
} report_template;

typedef enum template_kind {
    TEMPLATE_REPORT, /* of one recording, or of several side by side */
    TEMPLATE_JOBS    /* a table of many */
} template_kind;

/* A template that was built in. */
bool report_template_load(template_kind kind, report_template *out, io_error *error);

/* Divides a page at its one line `<!--cscd:data-->`. */
bool report_template_divide(const char *page, size_t size, report_template *out, io_error *error);
