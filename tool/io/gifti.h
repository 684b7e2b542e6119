/* GIFTI surfaces (.gii): a set of points and a set of triangles, as programs for brains write them. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>

/* By the ending of the name, or the tag <GIFTI near the beginning. */
bool gifti_recognise(const file_reader *reader);

/* The first NIFTI_INTENT_POINTSET and the first NIFTI_INTENT_TRIANGLE. The transforms of coordinates in the file are not
 * applied. A build without expat says that it lacks it. On false *out is untouched and the reader's error set. */
bool gifti_read(file_reader *reader, mesh_file *out);
