/* The names of the files of an export, one for each frame. */
#pragma once

#include "tool/io/io_error.h"

#include <stddef.h>
#include <stdint.h>

/* The path without that ending, if it has it; to be freed. NULL when out of memory. */
char *export_names_stem(const char *path, const char *ending);

/* STEM_0017.ply of frame 17; NULL when out of memory. To be freed. */
char *export_names_frame(const char *stem, int32_t number, const char *ending);

/* STEM and the ending behind each other. To be freed. */
char *export_names_join(const char *stem, const char *ending);
