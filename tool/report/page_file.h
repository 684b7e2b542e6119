/* Puts a page together: the template, and in it the document and the arrays. */
#pragma once

#include "tool/io/json.h"
#include "tool/report/page_arrays.h"
#include "tool/report/template.h"

/* Writes the member `arrays` of the document: what the arrays are called, their types and counts. */
void page_file_list(json *out, const page_arrays *arrays);

/* Puts the page at path in one go; document: JSON, in which any `<` is escaped here. The arrays are finished. */
bool page_file_write(const char *path, const report_template *page, const char *document,
                     const page_arrays *arrays, io_error *error);
