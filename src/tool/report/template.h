/* The page without its data: src/tool/report/template.html, a part of the program. */
#pragma once

#include "src/io/io_error.h"

#include <stddef.h>

/* The text before the place of the data, and the text behind it. */
typedef struct report_template {
    const char *head, *tail;
    size_t head_size, tail_size;
} report_template;

/* The template that was built in. */
bool report_template_load(report_template *out, io_error *error);

/* Divides a page at its one line `<!--cscd:data-->`. */
bool report_template_divide(const char *page, size_t size, report_template *out, io_error *error);
