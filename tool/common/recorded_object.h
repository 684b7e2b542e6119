/* One object of a recording: a model file and its frames, welded if that was asked for. */
#pragma once

#include "tool/io/animation.h"
#include "tool/io/mesh_file.h"
#include "tool/io/weld.h"

/* Where an object comes from. The texts live as long as the command line. */
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

/* Which vertices of a model are joined. */
typedef struct weld_choice {
    enum {
        WELD_BY_FORMAT, /* equal ones, of glTF within a node, where the format stores vertices several times; else none */
        WELD_NOTHING,
        WELD_WITHIN
    } rule;
    double epsilon; /* WITHIN: how far they lie apart at most; 0: not at all */
} weld_choice;

/* Vertices that lie together in the first frame and come apart in another one, so that they are not joined. */
typedef struct weld_parting {
    uint32_t count; /* so many more vertices are left than if the first frame decided; 0: none comes apart */
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

/* What the model's format is called if it stores a vertex once for each face (STL), or for each of its normals (glTF); else
 * NULL. */
const char *recorded_object_split_format(const recorded_object *object);

/* Why the file has no parts of the kind that was asked for: a sentence without a full stop, such as "STL files have no materials". */
void recorded_object_explain_parts(const recorded_object *object, char *text, size_t size);

/* What parts by a kind are called: "material". */
const char *recorded_object_parts_word(mesh_parts_by parts_by);

/* On false *out holds nothing to close. */
bool recorded_object_open(const recorded_source *source, weld_choice welding, const animation_options *frames,
                          recorded_object *out, io_error *error);
void recorded_object_close(recorded_object *object);

/* Joins what lies within epsilon in all frames, or, where each frame has a file of its own, in the first one. parts: as for
 * weld_begin. On false *out is untouched. */
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

/* The numbers of the model file for a vertex and a triangle, both counted from 0 within the object, and the reverse:
 * UINT32_MAX for a triangle that welding has dropped. */
uint32_t recorded_object_file_vertex(const recorded_object *object, uint32_t vertex);
uint32_t recorded_object_file_triangle(const recorded_object *object, uint32_t triangle);
uint32_t recorded_object_find_triangle(const recorded_object *object, uint32_t file_triangle);
