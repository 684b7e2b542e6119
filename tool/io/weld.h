/* Joins vertices that lie on each other, as exporters split them along texture seams; and finds open edges
 * that all but lie on each other. */
#pragma once

#include <cscd/detector.h>

#include "tool/io/io.h"

#include <stdbool.h>
#include <stdint.h>

/* Maps a file's vertices and triangles to welded ones, and back. */
typedef struct weld {
    double epsilon; /* 0: exactly equal coordinates */
    uint32_t file_vertex_count, vertex_count, triangle_count;
    uint32_t collapsed_triangles;    /* those that repeat a vertex once welded: dropped */
    uint32_t *vertex_of_file_vertex; /* file_vertex_count */
    uint32_t *file_vertex;           /* vertex_count: the first file vertex of each welded one */
    uint32_t *triangles;             /* triangle_count * 3 welded vertices */
    uint32_t *file_triangle;         /* triangle_count: which triangle of the file it is */
} weld;

/* Each vertex joins the first one, in file order, that stands for itself and lies within epsilon. Welded
 * vertices are numbered in the order of their first file vertex. parts: vertex_count labels, and a vertex
 * joins those of its own part alone; NULL: there are none. There are no triangles before weld_finish. On
 * false *out is untouched. */
bool weld_begin(const double *positions, uint32_t vertex_count, const uint32_t *parts, double epsilon,
                weld *out, io_error *error);

/* Takes apart what lies apart in these positions, too: of vertices that were joined only those within epsilon
 * of each other stay so. *parted becomes the first that lay apart, UINT32_MAX if none did. */
bool weld_part(weld *w, const double *positions, uint32_t *parted, io_error *error);

/* Maps the triangles. False if none is left, too. After any false the caller frees the weld. */
bool weld_finish(weld *w, const uint32_t *triangles, uint32_t triangle_count, io_error *error);
void weld_free(weld *w);

/* Welded positions are those of the first file vertex. False, with the vertices and their distance, when two
 * that were welded lie farther apart than epsilon in this frame. */
bool weld_positions(const weld *w, const double *file_positions, double *out, io_error *error);

/* ---- near seams ---------------------------------------------------------------------------------------- */

/* Open edges that all but lie on each other, as rounding leaves them between triangles that bring vertices of
 * their own. */
typedef struct near_seams {
    uint32_t open_edges;   /* of the object */
    uint32_t joined_edges; /* those of them that would be joined with others */
    double gap;            /* their corners lie so far apart at most */
    double distance;       /* by --weld with this distance, which has two digits at most */
} near_seams;

/* Looks at an object of the mesh, whose vertices have these positions: open edges whose corners lie within
 * 1e-5 of its size of those of another one. False: there are none, or not enough memory to find them. */
bool near_seams_find(const cscd_mesh *mesh, uint32_t object, const double *positions, near_seams *out);
