/* The parts of a glTF scene: a name for each node with triangles, or for each material of triangles, no two of them equal. */
#pragma once

#include "tool/io/gltf/gltf_scene.h"
#include "tool/io/mesh_parts.h"

/* Nodes are called by their own name, else by that of their mesh, else "node 3"; a name that is taken gets .001, .002, ... behind
 * it. On false *out owns nothing, and the error of the scene's reader is set. */
bool gltf_parts_of(const gltf_scene *scene, mesh_parts *out);

/* The materials of triangles, in the order of these, by their names, else "material 3"; taken names as above. The reader must have been
 * asked for parts by material. Where no triangle has one, there are no parts. */
bool gltf_parts_of_materials(const gltf_scene *scene, mesh_parts *out);
