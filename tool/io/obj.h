/* Wavefront OBJ: vertices and polygons; all other records are skipped. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>

/* On false *out is untouched and the reader's error set. */
bool obj_read(file_reader *reader, mesh_file *out);
