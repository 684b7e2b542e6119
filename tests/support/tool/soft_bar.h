/* A PLY of a bar that says how stiff its faces are. */
#pragma once

#include "tests/support/temp_file.h"

/* Writes a bar of quads with two ends, of 40 rings: 3 stiff, soft between the rings 26 and 28, and bad at one face (-1: at none). */
temp_path soft_bar_write(const temp_folder *folder, const char *name, double soft, int bad_face, double bad);
