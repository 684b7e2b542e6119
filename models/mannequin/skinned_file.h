/* The figure as glTF: a node with a mesh for each part, a skin and an animation, which whoever reads it evaluates. */
#pragma once

#include "models/mannequin/mannequin.h"
#include "tool/io/io_error.h"

#include <stdbool.h>

/* Writes a .glb file. */
bool skinned_file_write(const char *path, const mannequin *m, io_error *error);
