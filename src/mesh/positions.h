/* Positions: their coordinates, and views of them, from a caller's layout to packed doubles and back. */
#pragma once

#include "src/mesh/mesh.h"

/* Every coordinate must be 0 or have a magnitude in [2^-300, 2^300], so that no product of the exact
 * predicates over- or underflows. INVALID_ARGUMENT names the vertex; name says which array. */
cscd_status positions_check(cscd_context *context, const double *positions, uint32_t vertex_count,
                            const char *name);

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

/* ---- overlaps ---------------------------------------------------------------------------------------------- */

/* Scalars of views that lie on each other cannot be written, and are read wrongly.
 *
 * The place of coordinate k of vertex i: scalar_size bytes from data + i * stride + k * coordinate_stride on. All of
 * it lies within SIZE_MAX / 8 bytes, so that differences of places do not overflow. */
typedef struct view_grid {
    const char *data;
    size_t stride, coordinate_stride, scalar_size; /* none is 0 */
    uint32_t vertex_count;                         /* 1 or more */
} view_grid;

/* Two scalars with a byte in common. */
typedef struct view_clash {
    uint32_t vertices[2], coordinates[2];
} view_clash;

/* Tells whether two scalars of one view overlap. Takes constant time. */
bool view_overlaps_itself(const view_grid *g, view_clash *out);

/* Tells whether scalars of two views overlap. Takes constant time where their memory lies apart or their strides are equal, and
 * else time linear in their vertices. */
bool views_overlap(const view_grid *a, const view_grid *b, view_clash *out);
