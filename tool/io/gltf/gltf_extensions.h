/* The extensions of a glTF file: those that it requires must be read, and those that it only uses are named. */
#pragma once

#include "tool/io/gltf/gltf_scene.h"

/* False, with the reader's error, when the file requires an extension that is not read and may change where surfaces are. */
bool gltf_extensions_check(const gltf_element *root);

/* Which extensions of the nodes, meshes and views that the scene shows are not read, though they may change where surfaces are:
 * a sentence, which the caller frees; *out is NULL when there are none. */
bool gltf_extensions_note(const gltf_scene *scene, char **out);
