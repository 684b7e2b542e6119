/* A recording: one object or several, each with its model file and its frames, as one mesh and an array of
 * positions for each frame. */
#pragma once

#include "cscd/cscd.h"
#include "tool/common/options.h"
#include "tool/io/animation.h"
#include "tool/io/mesh_file.h"
#include "tool/io/record.h"
#include "tool/io/weld.h"

/* ---- an object of a recording -------------------------------------------------------------------------- */

/* The source of an object. The texts live as long as the command line. */
typedef struct recorded_source {
    const char *name;
    const char *model_path;
    const char *const *frame_paths; /* none: the object rests */
    size_t frame_path_count;
    const char *const *
        itself; /* the model's path again: where the file holds an animation, that is played if there are no other
                                * frames; NULL: it is not */
    mesh_parts_by parts_by; /* what its parts are */
    bool
        obstacle; /* its own triangles are not looked at with each other, nor with those of other obstacles */
} recorded_source;

/* The choice of vertices of a model that are joined. */
typedef struct weld_choice {
    enum {
        WELD_BY_FORMAT, /* equal ones, of glTF within a node, where the format stores vertices several times; else none */
        WELD_NOTHING,
        WELD_WITHIN
    } rule;
    double epsilon; /* WITHIN: how far they lie apart at most; 0: not at all */
} weld_choice;

/* Vertices that lie together in the first frame and come apart in another one, so that they are not
 * joined. */
typedef struct weld_parting {
    uint32_t count; /* how many more vertices are left than if the first frame decided; 0: none comes apart */
    uint32_t vertex,
        frame; /* the first of them that was found, by its number in the file, and the frame by its index */
} weld_parting;

typedef struct recorded_object {
    recorded_source source;
    mesh_file file;
    animation *frames; /* NULL: it rests */
    bool welded;
    weld weld;
    weld_parting parting;                  /* when welded */
    double *file_positions;                /* of the frame read last */
    uint32_t vertex_count, triangle_count; /* welded, as in the mesh */
    uint32_t first_vertex, first_triangle; /* in the mesh of the recording */
    uint64_t frames_hash;                  /* of the hashes of its frames so far */
} recorded_object;

/* The name of the model's format if it stores a vertex once for each face (STL), or for each of its normals
 * (glTF); else NULL. */
const char *recorded_object_split_format(const recorded_object *object);

/* Explains why the file has no parts of the kind that was asked for: a sentence without a full stop, such as
 * "STL files have no materials". */
void recorded_object_explain_parts(const recorded_object *object, char *text, size_t size);

/* The word for parts by a kind: "material". */
const char *recorded_object_parts_word(mesh_parts_by parts_by);

/* On false *out holds nothing to close. */
bool recorded_object_open(const recorded_source *source, weld_choice welding, const animation_options *frames,
                          recorded_object *out, io_error *error);
void recorded_object_close(recorded_object *object);

/* Joins what lies within epsilon in all frames, or, where each frame has a file of its own, in the first one.
 * parts: as for weld_begin. On false *out is untouched. */
bool recorded_object_weld(recorded_object *object, const uint32_t *parts, double epsilon, weld *out,
                          weld_parting *parting, io_error *error);

/* 1 for an object that rests. */
uint32_t recorded_object_frame_count(const recorded_object *object);

/* Reads a frame, by its index from 0, and its positions: vertex_count * 3 of them. */
bool recorded_object_read(recorded_object *object, uint32_t frame, double *positions, io_error *error);

/* Copies the positions of the model file itself, unchecked; positions as above. */
void recorded_object_rest(const recorded_object *object, double *positions);

/* The hash of the model file's triangles and positions. */
uint64_t recorded_object_hash_model(const recorded_object *object);

/* The hash of the file's positions of the frame read last. */
uint64_t recorded_object_hash_frame(const recorded_object *object);

/* The corners of its triangles, counted from 0 within the object; triangle_count * 3 of them. */
const uint32_t *recorded_object_triangles(const recorded_object *object);

/* The numbers of the model file for a vertex and a triangle, both counted from 0 within the object, and the
 * reverse: UINT32_MAX for a triangle that welding has dropped. */
uint32_t recorded_object_file_vertex(const recorded_object *object, uint32_t vertex);
uint32_t recorded_object_file_triangle(const recorded_object *object, uint32_t triangle);
uint32_t recorded_object_find_triangle(const recorded_object *object, uint32_t file_triangle);

/* ---- the recording ------------------------------------------------------------------------------------- */

enum { RECORDING_OBJECTS_MAX = 64 };

/* NAME=PATH of the command line. The name lives as long as the options. */
typedef struct named_path {
    char name[64];
    const char *path;
    bool obstacle; /* of an object */
} named_path;

typedef struct named_paths {
    named_path items[RECORDING_OBJECTS_MAX];
    uint32_t count;
} named_paths;

/* A number that may not be given. */
typedef struct frame_number {
    bool given;
    int32_t value;
} frame_number;

typedef struct recording_options {
    const char *model_path;         /* NULL: there are only objects by name */
    const char *const *frame_paths; /* none: the model is the only frame */
    size_t frame_path_count;
    named_paths objects, frames_of; /* further objects; frames of these or of the model */
    animation_options frames;       /* how frames are read; the model's path is filled in for each object */
    frame_number first_frame;       /* what the first frame is called; not given: what its file says */
    bool plays_models; /* models that hold an animation are played, unless they have other frames */
    bool rest;         /* but these are not */
    weld_choice weld;
    mesh_parts_by parts_by; /* what the parts of all models are */
    double wait_seconds;    /* for files that cannot be read yet; 0: none */
    uint32_t thread_count;  /* 0: one per processor, for small meshes one */
    cscd_simd simd;
    cscd_progress progress; /* of the context; NULL: none */
    cscd_context
        *context; /* to be shared with other recordings, which goes on living; NULL: one of its own */
} recording_options;

/* MODEL and FRAMES: the first input and the others, if there are any. */
void recording_options_take(recording_options *options, const given_options *given);

/* The name of the recording in a sentence: the first model's path. */
const char *recording_options_path(const recording_options *options);

typedef struct recording {
    cscd_context *context;
    bool shares_context;
    cscd_mesh *mesh; /* of welded vertices and triangles, object by object */
    recorded_object *objects;
    char *model_name; /* of the object without a name of its own: its file's, without folder and ending */
    uint32_t object_count;
    uint32_t frame_count;
    mesh_parts_by parts_by; /* that of the options */
    double fps;             /* that of the options; 0: not given */
    double wait_seconds;
    int32_t *frame_numbers;            /* frame_count, ascending: what the artist calls each frame */
    uint32_t (*edge_file_vertices)[2]; /* per edge of mesh; NULL when nothing is welded */
} recording;

/* The options are used as long as the recording is open. On false *out holds nothing to close. */
bool recording_open(const recording_options *options, recording *out, io_error *error);
void recording_close(recording *r);

/* Reads a frame, by its index from 0. positions: cscd_mesh_vertex_count(mesh) * 3. The error names the frame,
 * and vertices as the file numbers them. */
bool recording_read(recording *r, uint32_t frame, double *positions, io_error *error);

/* Closes the files of the frames, of which no more is read. */
void recording_end_reading(recording *r);

/* Says that a frame is read soon, as animation_expect. */
void recording_expect(recording *r, uint32_t frame);

/* Copies the positions of the model files themselves, unchecked; positions as above. */
void recording_rest(const recording *r, double *positions);

/* The hashes of the files' positions of the frame read last, per object; and adds those of a frame to the
 * objects' hashes. */
void recording_hash_frame(const recording *r, uint64_t hashes[RECORDING_OBJECTS_MAX + 1]);
void recording_add_hashes(recording *r, const uint64_t hashes[RECORDING_OBJECTS_MAX + 1]);

/* Frames a second: as --fps says, or 24 where a glTF file was sampled; 0: nobody knows. */
double recording_fps(const recording *r);

/* True if any object has frames. */
bool recording_moves(const recording *r);

/* A contact, with the vertices that the model files number. */
contact_record recording_contact(const recording *r, uint32_t frame, const cscd_contact *contact);

/* The object of a triangle of the mesh. */
uint32_t recording_object_of_triangle(const recording *r, uint32_t triangle);

/* The object of that name; UINT32_MAX: there is none. */
uint32_t recording_find_object(const recording *r, const char *name);

/* The model file's own number of a vertex or triangle of the mesh. */
uint32_t recording_file_vertex(const recording *r, uint32_t vertex);
uint32_t recording_file_triangle(const recording *r, uint32_t triangle);

/* The face of the model file that a triangle of the mesh is cut from, counted from 0. */
uint32_t recording_file_face(const recording *r, uint32_t triangle);

/* The number of the edge between two vertices of the mesh, which must have it. */
uint32_t recording_find_edge(const cscd_mesh *mesh, uint32_t a, uint32_t b);

/* True if the model of an object holds an animation that is not played, although the object has no other
 * frames. */
bool recording_object_rests(const recorded_object *object);

/* Warns on stderr about triangles that welding has dropped, and about open, non-manifold and
 * inconsistently oriented components. */
void recording_warn(recording *r);
