/* The contacts of a report: the kept ones as arrays, and how many every triangle takes part in. */
#pragma once

#include "tool/report/packed_array.h"
#include "tool/report/report.h"

typedef struct contact_arrays {
    uint64_t found;
    uint32_t kept;
    uint32_t *heat; /* per triangle: how many contacts have it as the face, or have its vertex or edge */
    packed_array *interval, *kind, *vertices, *toi, *point;
    packed_array *file_vertices; /* NULL where the file has the mesh's numbers */
} contact_arrays;

/* On false *out holds nothing to free. */
bool contact_arrays_create(const report_options *options, contact_arrays *out);
void contact_arrays_free(contact_arrays *arrays); /* a zeroed struct is fine */

/* Points are stored times scale. False: out of memory. */
bool contact_arrays_add(contact_arrays *arrays, const report_options *options, uint32_t interval,
                        const cscd_contacts *contacts, double scale);
