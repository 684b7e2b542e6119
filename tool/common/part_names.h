/* The parts of a recording: which part each triangle of its mesh is in, and what the parts are called. */
#pragma once

#include "tool/common/recording.h"

#define NO_PART UINT32_MAX

typedef struct part_names {
    uint32_t count;
    char **names;     /* count of them */
    uint32_t *labels; /* per triangle of the mesh: a part, or NO_PART */
    uint32_t *
        bodies; /* per triangle, below body_count, or NO_PART: what belongs together, where that is not the parts; NULL: they say
                       * so. Parts of --parts-by do not, so that depths stay what they are. In no part, each component is by itself. */
    uint32_t body_count;
    bool named; /* by files or a table; else they are components or regions, or the recording itself */
} part_names;

/* Names parts by what the recording says, the first of these that says anything: the objects and parts that
 * its files name (OBJECT/PART where there are several objects), its components, the regions of a plan (NULL:
 * none), itself. On false *out holds nothing to free. */
bool part_names_find(const recording *r, const cscd_plan *plan, part_names *out, io_error *error);

/* Reads parts from a table of two columns: `triangle,name`, `face,name` or `vertex,name` in its first line,
 * and a number of the model file and a name in each other one; with several objects the number is NAME:12. Of
 * vertices a triangle is in the part that most of its corners are in; of equally many, that of its first
 * corner. What no line names is in no part. The error names the file and the line. */
bool part_names_read(const recording *r, const char *path, part_names *out, io_error *error);
void part_names_free(part_names *parts);

/* Tells a detector what the parts are, and what belongs together. */
cscd_status part_names_tell(const part_names *parts, cscd_detector *detector);

/* The name of a part in a sentence; that of NO_PART is "(no part)". */
const char *part_names_at(const part_names *parts, uint32_t part);

/* Marks the parts that a name stands for: that of the same name, and all below it (NAME/...). chosen: count
 * of them. Returns how many there are. */
uint32_t part_names_choose(const part_names *parts, const char *name, size_t length, bool *chosen);

/* Fails because an option names a part that there is not: says so, and which there are. */
bool part_names_fail(const part_names *parts, const char *option, const char *name, size_t length,
                     io_error *error);
