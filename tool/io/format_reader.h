/* The readers of file formats: meshes, a reader for each format, and the frames of a glTF file or of a
 * sequence of mesh files. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/io.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The reader of one format of mesh files. */
typedef struct format_reader {
    mesh_format format;
    bool by_ending;   /* a file with the ending of the format is read so if its content says nothing else */
    bool names_parts; /* groups and materials, too */
    /* NULL if the content of a file never says that it has this format. */
    bool (*recognise)(const file_reader *reader);
    /* On false *out is untouched and the reader's error set. */
    bool (*read)(file_reader *reader, mesh_file *out);
} format_reader;

/* Reads the mesh of a file that was opened, by the reader of its format, as mesh_file_read. */
bool mesh_reader_read(file_reader *reader, mesh_file *out);

/* Wavefront OBJ: vertices and polygons; all other records are skipped. */
extern const format_reader obj_reader;
/* PLY (Stanford polygon format), text and binary of either byte order. Coordinates keep the precision of the
 * file: a float in text is read as the double that it spells. */
extern const format_reader ply_reader;
/* OFF (Object File Format) in text, with normals, colours or texture coordinates ignored. The keyword may be
 * missing. */
extern const format_reader off_reader;
/* STL (stereolithography), binary and text: triangles that each bring their own three vertices, in file
 * order. The content says which kind it is, since binary files may begin with "solid", too. */
extern const format_reader stl_reader;
/* glTF 2.0: all nodes of the default scene as one mesh, in metres, y up: each node with a mesh in the order
 * of the tree, and of it the vertices of its primitives in file order. The state is that of the nodes' own
 * transforms and weights. */
extern const format_reader gltf_reader;
/* GIFTI surfaces, as programs for brains write them: the first NIFTI_INTENT_POINTSET and the first
 * NIFTI_INTENT_TRIANGLE. Transforms of coordinates are not applied. A build without expat says that it lacks
 * it. */
extern const format_reader gifti_reader;

/* ---- frames of a glTF file ----------------------------------------------------------------------------- */

/* True if the ending of the path is one of glTF files. */
bool gltf_recognise_path(const char *path);

typedef struct gltf_frames gltf_frames;

/* The frames of the animation of this name (NULL: the first) at the times start + i / fps, up to its end. The
 * file stays in memory; nothing is kept per frame. On false *out is untouched. */
bool gltf_frames_open(const char *path, uint32_t vertex_count, double fps, const char *name,
                      gltf_frames **out, io_error *error);
void gltf_frames_close(gltf_frames *frames);

uint32_t gltf_frames_count(const gltf_frames *frames);
/* The time of the frame in frames a second, as animation programs count: frame 1 is at 1 / fps. */
int32_t gltf_frames_number(const gltf_frames *frames, uint32_t frame);

/* A note that names the one of several animations that is played, if none was asked for by name; else
 * NULL. */
const char *gltf_frames_note(const gltf_frames *frames);

/* frame is below the count; positions takes vertex_count * 3 and is undefined on false. */
bool gltf_frames_read(gltf_frames *frames, uint32_t frame, double *positions, io_error *error);

/* ---- sequences of mesh files, one per frame, of which only positions are read -------------------------- */

typedef struct frame_files frame_files;

/* Looks at names only. On false *out is untouched. frames/frame_names.h says what belongs to
 * a sequence, in which order, and what allow_gaps allows. */
bool frame_files_open_pattern(const char *pattern, bool allow_gaps, uint32_t vertex_count, frame_files **out,
                              io_error *error);
bool frame_files_open_folder(const char *folder, bool allow_gaps, uint32_t vertex_count, frame_files **out,
                             io_error *error);

/* Takes the paths, percent signs included, in the order of their numbers if they are a series, else in the
 * order given; each must be a file that exists. model_path, unless NULL, joins a series that it belongs to
 * and is not in yet, and names that are no series: it is then the first of them. */
bool frame_files_open_list(const char *const *paths, size_t path_count, const char *model_path,
                           bool allow_gaps, uint32_t vertex_count, frame_files **out, io_error *error);

/* From now on a frame with face_count faces is refused if they are not those of this hash (mesh_file.h): its
 * vertices most likely have another order. 0: none is. */
void frame_files_expect_faces(frame_files *files, uint32_t face_count, uint64_t faces_hash);
void frame_files_close(frame_files *files);

uint32_t frame_files_frame_count(const frame_files *files);

/* The artist's number of a frame: that in its name, else its index. */
int32_t frame_files_number(const frame_files *files, uint32_t frame);

/* A sentence about the order of a list; NULL when there is nothing to say. */
const char *frame_files_note(const frame_files *files);

/* frame is below the count; positions takes vertex_count * 3 and is undefined on false. */
bool frame_files_read(frame_files *files, uint32_t frame, double *positions, io_error *error);

/* As animation_expect. */
void frame_files_expect(frame_files *files, uint32_t frame);

/* ---- files of other programs, which are not read ------------------------------------------------------- */

/* The words of an error about such a file: "an Alembic archive, which is not read: export ...". NULL: it
 * is none. The first bytes decide, else the ending of the name; bytes may be NULL when only the name is
 * known. */
const char *foreign_format_advice(const char *path, const char *bytes, size_t size);
