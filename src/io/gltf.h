/* glTF 2.0 (.gltf, .glb): the mesh in its rest state. */
#pragma once

#include "src/io/file_reader.h"
#include "src/io/mesh_file.h"

#include <stdbool.h>

/* By the first bytes, or the ending of the name. */
bool gltf_recognise(const file_reader *reader);
bool gltf_recognise_path(const char *path);

/* All nodes of the default scene as one mesh, in metres, y up: each node with a mesh in the order of the tree, and of it the vertices
 * of its primitives in file order. The state is that of the nodes' own transforms and weights. On false *out is untouched
 * and the reader's error set. */
bool gltf_read(file_reader *reader, mesh_file *out);
