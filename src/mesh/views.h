/* Views of positions: from a caller's layout to packed doubles, and back. */
#pragma once

#include "src/mesh/mesh.h"

/* Gives the positions of a mesh as packed doubles, 3 a vertex, without checking coordinates. One view of packed
 * doubles is used where it is. Any other layout is copied to *buffer, which is allocated when it is NULL and
 * belongs to the caller: context_free it at last. INVALID_ARGUMENT: the views do not fit the mesh; `name` is the
 * name of the argument. */
cscd_status views_read(cscd_context *context, const cscd_mesh *mesh, const cscd_view *views, const char *name,
                       double **buffer, const double **out);

/* Checks views before a long call that ends by writing to them; NULL is allowed. */
cscd_status views_check_mutable(cscd_context *context, const cscd_mesh *mesh, const cscd_mutable_view *views,
                                const char *name);

/* Writes packed doubles, 3 a vertex, to checked views; does nothing when these are NULL. */
void views_write(const cscd_mesh *mesh, const cscd_mutable_view *views, const double *positions);

/* Writes the scalar in which checked views hold the vertices of each object. */
void views_scalars(const cscd_mesh *mesh, const cscd_view *views, cscd_scalar *of_objects);
void views_mutable_scalars(const cscd_mesh *mesh, const cscd_mutable_view *views, cscd_scalar *of_objects);
