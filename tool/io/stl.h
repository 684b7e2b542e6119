/* STL (stereolithography), binary and as text: triangles that each bring their own three vertices. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>

/* The size is that of a binary file, or the text begins with "solid" and goes on with a facet. */
bool stl_recognise(const file_reader *reader);

/* Vertices are those of the facets, in file order, three for each triangle; coordinates are the file's floats, or what its
 * text spells. Which kind it is follows from the content, since binary files may begin with "solid", too. On false *out
 * is untouched and the reader's error set. */
bool stl_read(file_reader *reader, mesh_file *out);
