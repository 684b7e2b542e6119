/* glTF 2.0 (.gltf, .glb): the mesh in its rest state, and the frames of an animation. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>
#include <stdint.h>

/* Do the first bytes of the file say that it is glTF, or the ending of its name? */
bool gltf_recognise_path(const char *path);

typedef struct gltf_frames gltf_frames;

/* The frames of the animation of this name (NULL: the first) at the times start + i / fps, up to its end. The file stays
 * in memory; nothing is kept per frame. On false *out is untouched. */
bool gltf_frames_open(const char *path, uint32_t vertex_count, double fps, const char *name,
                      gltf_frames **out, io_error *error);
void gltf_frames_close(gltf_frames *frames);

uint32_t gltf_frames_count(const gltf_frames *frames);
/* The time of the frame in frames a second, as animation programs count: frame 1 is at 1 / fps. */
int32_t gltf_frames_number(const gltf_frames *frames, uint32_t frame);

/* Which of several animations is played, if none was named; else NULL. */
const char *gltf_frames_note(const gltf_frames *frames);

/* frame is below the count; positions takes vertex_count * 3 and is undefined on false. */
bool gltf_frames_read(gltf_frames *frames, uint32_t frame, double *positions, io_error *error);
