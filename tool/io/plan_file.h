/* A plan as a PLY file that any viewer shows: the mesh at rest, charge and region per face, a colour. */
#pragma once

#include "cscd/cscd.h"
#include "tool/io/io.h"

/* Does the file begin as a PLY with the comment that every plan has? False too when it cannot be read. */
bool plan_file_is_plan(const char *path);

/* positions: the mesh at rest, as the plan was made from it; colours: red, green, blue per triangle. A file that
 * was there stays until the plan is whole. */
bool plan_file_write(const char *path, const cscd_mesh *mesh, const double *positions, const cscd_plan *plan,
                     const uint8_t *colours, io_error *error);

/* Reads the plan that was written, bit for bit. It refuses a plan of another mesh, and says what differs. context:
 * that of the mesh. */
bool plan_file_read(const char *path, const cscd_context *context, const cscd_mesh *mesh, cscd_plan **out,
                    io_error *error);
