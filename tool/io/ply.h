/* PLY (Stanford polygon format): text and binary, either byte order. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>

/* The first line of the file is "ply". */
bool ply_recognise(const file_reader *reader);

/* Coordinates keep the precision that the file has: a float in text is read as the double it spells. On false
 * *out is untouched and the reader's error set. */
bool ply_read(file_reader *reader, mesh_file *out);
