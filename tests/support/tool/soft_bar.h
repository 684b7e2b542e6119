/* A PLY of a bar that says how stiff its faces are. */
#pragma once

#include "tests/support/temp_file.h"

#include <stdbool.h>

/* Writes a bar of 468 quads and two ends of 12 corners, between 40 rings: 3 stiff, and soft between the rings 26 and 28. Split: every
 * face has corners of its own. */
temp_path soft_bar_write(const temp_folder *folder, const char *name, double soft, bool split);

/* The same, with a bad value at one face. */
temp_path soft_bar_write_bad(const temp_folder *folder, const char *name, int bad_face, double bad);
