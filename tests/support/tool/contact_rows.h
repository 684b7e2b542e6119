/* Reads the tool's contact files back, strictly: CSV and JSON Lines. */
#pragma once

#include "src/io/contact_file.h"

#include <stddef.h>

typedef struct contact_rows {
    contact_record *items;
    size_t count;
} contact_rows;

/* Both readers fail the test at anything that the format does not allow. */
contact_rows contact_rows_read_csv(const char *path);
contact_rows contact_rows_read_jsonl(const char *path);
void contact_rows_free(contact_rows *rows);

size_t contact_rows_of(const contact_rows *rows, int32_t frame, cscd_contact_kind kind);

/* Asserts that every number is the same, bit for bit. */
void contact_rows_assert_equal(const contact_rows *a, const contact_rows *b);
