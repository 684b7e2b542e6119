/* Recorded vertex positions, one frame at a time: PC2 and MDD point caches, sequences of mesh files,
 * animations of glTF files. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct animation animation;

/* Frames a second of glTF files, which have seconds only. */
#define ANIMATION_FPS 24.0

typedef struct animation_options {
    const char
        *model_path; /* joins the mesh files that are listed unless they are a series without it; NULL: no */
    uint32_t
        model_face_count; /* of mesh files: as many faces as the model are the model's; 0: any faces will do */
    uint64_t model_faces_hash;  /* of mesh_file */
    bool allow_gaps;            /* of a series of mesh files, some may be missing */
    double fps;                 /* of a glTF file: frames a second; 0: 24 */
    const char *animation_name; /* of a glTF file: which of its animations; NULL: the first */
} animation_options;

/* paths: one .pc2 or .mdd file; one .glb or .gltf file; one printf pattern (f_%04d.obj); one folder; or a
 * list of mesh files, one a frame. Only headers (and, of a folder, names) are read here; the size of a point
 * cache is checked at once. Every frame must have vertex_count vertices. options NULL: none. On false *out is
 * untouched. */
bool animation_open(const char *const *paths, size_t path_count, uint32_t vertex_count,
                    const animation_options *options, animation **out, io_error *error);
void animation_close(animation *animation);

/* True if all frames are in one file, which may be read again and in any order. */
bool animation_is_one_file(const animation *animation);

uint32_t animation_frame_count(const animation *animation);

/* The artist's number of a frame: that of its file, or that of its sample by the start and rate of a PC2
 * header, or by its time and the frames a second; where there is none, its index. Numbers ascend. */
int32_t animation_frame_number(const animation *animation, uint32_t frame);

/* A sentence about the order of listed files, or the choice among animations, if there is something to say;
 * else NULL. */
const char *animation_note(const animation *animation);

/* Reads a frame, by its index from 0, into positions, vertex_count * 3. The memory in use does not grow with
 * the frames read. On false *error names the frame; positions are then undefined. */
bool animation_read(animation *animation, uint32_t frame, double *positions, io_error *error);

/* Says that a frame, by its index below the count, is read soon: the system begins to fetch its file from the
 * disk, and the caller does not wait. A file that is missing is no error here. Does nothing where all frames
 * are in one file. */
void animation_expect(animation *animation, uint32_t frame);
