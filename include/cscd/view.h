/* Views: positions as a solver stores them. Every function that takes positions takes views of them, so
 * nothing has to be copied or converted first. Part of cscd/cscd.h, which says what holds for every function. */
#ifndef CSCD_VIEW_API_H
#define CSCD_VIEW_API_H

#include <cscd/context.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The type of a coordinate. */
typedef enum cscd_scalar { CSCD_SCALAR_DOUBLE, CSCD_SCALAR_FLOAT } cscd_scalar;

/* Positions, floats or doubles, in structs of any size or by columns: x of vertex i lies at byte i * stride,
 * y and z coordinate_stride and twice coordinate_stride bytes behind it. No alignment is needed. For a matrix
 * with the columns x, y and z, stride is the size of a scalar and coordinate_stride that of a column.
 *
 * A function that takes `const cscd_view *x0` takes an array of views, which hold the vertices of the mesh's
 * objects, object by object. Often that is one view of all vertices: object_count 0 says that it holds all
 * objects that the views before it do not hold. A view that is shorter than its objects is refused. An example,
 * cloth in an array of structs and, as the mesh's second object, a floor in doubles by columns:
 *
 *     struct particle {
 *         float position[3], velocity[3];
 *     } cloth[16] = {{{0}, {0}}};
 *     double floor[3][16] = {{0}}; // x of all vertices, then y, then z
 *     const cscd_view positions[2] = {
 *         {cloth, sizeof cloth, sizeof cloth[0], 0, CSCD_SCALAR_FLOAT, 1},
 *         {floor, sizeof floor, sizeof(double), sizeof floor[0], CSCD_SCALAR_DOUBLE, 1}};
 *     cscd_intersections found;
 *     cscd_status status = cscd_detector_check(detector, positions, &found);
 *     if (status == CSCD_OK) printf("%zu pairs intersect\n", found.count);
 *
 * Views never grow, so they carry no size of their own. */
typedef struct cscd_view {
    const void *data;
    size_t size;              /* of the memory at data, in bytes */
    size_t stride;            /* in bytes; 0: that of three scalars */
    size_t coordinate_stride; /* in bytes; 0: that of one scalar */
    cscd_scalar scalar;       /* doubles by default */
    uint32_t object_count;    /* how many consecutive objects it holds; 0: all that are left */
} cscd_view;

/* The same for positions that a function writes. Its vertices must not overlap each other. Doubles are
 * rounded to the nearest float where scalar says so. */
typedef struct cscd_mutable_view {
    void *data;
    size_t size;
    size_t stride;
    size_t coordinate_stride;
    cscd_scalar scalar;
    uint32_t object_count;
} cscd_mutable_view;

/* Views of vertex_count packed positions x, y, z. */
static inline cscd_view cscd_view_doubles(const double *positions, size_t vertex_count) {
    cscd_view view = {positions, vertex_count * 3 * sizeof *positions, 0, 0, CSCD_SCALAR_DOUBLE, 0};
    return view;
}
static inline cscd_view cscd_view_floats(const float *positions, size_t vertex_count) {
    cscd_view view = {positions, vertex_count * 3 * sizeof *positions, 0, 0, CSCD_SCALAR_FLOAT, 0};
    return view;
}
static inline cscd_mutable_view cscd_mutable_view_doubles(double *positions, size_t vertex_count) {
    cscd_mutable_view view = {positions, vertex_count * 3 * sizeof *positions, 0, 0, CSCD_SCALAR_DOUBLE, 0};
    return view;
}
static inline cscd_mutable_view cscd_mutable_view_floats(float *positions, size_t vertex_count) {
    cscd_mutable_view view = {positions, vertex_count * 3 * sizeof *positions, 0, 0, CSCD_SCALAR_FLOAT, 0};
    return view;
}

/* In C, the same as pointers, which live until the block ends in which they stand:
 *   cscd_detector_step(detector, CSCD_DOUBLES(x0, n), CSCD_DOUBLES(x1, n), &contacts); */
#ifndef __cplusplus
#define CSCD_DOUBLES(positions, vertex_count)                                                                \
    ((const cscd_view[1]){cscd_view_doubles(positions, vertex_count)})
#define CSCD_FLOATS(positions, vertex_count) ((const cscd_view[1]){cscd_view_floats(positions, vertex_count)})
#define CSCD_MUTABLE_DOUBLES(positions, vertex_count)                                                        \
    ((const cscd_mutable_view[1]){cscd_mutable_view_doubles(positions, vertex_count)})
#define CSCD_MUTABLE_FLOATS(positions, vertex_count)                                                         \
    ((const cscd_mutable_view[1]){cscd_mutable_view_floats(positions, vertex_count)})
#endif

#ifdef __cplusplus
}
#endif

#endif
