/* Whether the scalars of views lie on each other: such positions cannot be written, and are read wrongly. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Where coordinate k of vertex i lies: scalar_size bytes from data + i * stride + k * coordinate_stride on. All of
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

/* Do two scalars of one view overlap? Takes constant time. */
bool view_overlaps_itself(const view_grid *g, view_clash *out);

/* Do scalars of two views overlap? Takes constant time where their memory lies apart or their strides are equal, and
 * else time linear in their vertices. */
bool views_overlap(const view_grid *a, const view_grid *b, view_clash *out);
