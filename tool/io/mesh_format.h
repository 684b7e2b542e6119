/* The list of mesh formats: what each is called, and how the names of its files end. All lists in code, messages and --help come
 * from it. */
#pragma once

/* Each row is the constant behind MESH_FORMAT_, the name for people, and the endings. */
#define MESH_FORMATS(FIRST, NEXT, LAST)                                                                      \
    FIRST(OBJ, "OBJ", ".obj")                                                                                \
    NEXT(PLY, "PLY", ".ply")                                                                                 \
    NEXT(OFF, "OFF", ".off")                                                                                 \
    NEXT(STL, "STL", ".stl")                                                                                 \
    NEXT(GLTF, "glTF", ".glb, .gltf")                                                                        \
    LAST(GIFTI, "GIFTI", ".gii")

#define MESH_FORMAT_CONSTANT(constant, name, endings) MESH_FORMAT_##constant,
typedef enum mesh_format {
    MESH_FORMAT_NONE, /* a mesh that was not read */
    MESH_FORMATS(MESH_FORMAT_CONSTANT, MESH_FORMAT_CONSTANT, MESH_FORMAT_CONSTANT)
} mesh_format;

#define MESH_FIRST_NAME(constant, name, endings)   name
#define MESH_NEXT_NAME(constant, name, endings)    ", " name
#define MESH_OR_NAME(constant, name, endings)      " or " name
#define MESH_FIRST_ENDING(constant, name, endings) endings
#define MESH_NEXT_ENDING(constant, name, endings)  ", " endings
#define MESH_OR_ENDING(constant, name, endings)    " or " endings

/* "OBJ, PLY, .., GIFTI"; "OBJ, PLY, .. or GIFTI"; ".obj, .ply, .. or .gii". */
#define MESH_FORMAT_NAMES   MESH_FORMATS(MESH_FIRST_NAME, MESH_NEXT_NAME, MESH_NEXT_NAME)
#define MESH_FORMAT_CHOICE  MESH_FORMATS(MESH_FIRST_NAME, MESH_NEXT_NAME, MESH_OR_NAME)
#define MESH_FORMAT_ENDINGS MESH_FORMATS(MESH_FIRST_ENDING, MESH_NEXT_ENDING, MESH_OR_ENDING)

/* The format that the ending of a path says, or MESH_FORMAT_NONE. *length is that of the ending. */
mesh_format mesh_format_of_path(const char *path, unsigned *length);

/* What a format is called; "" for MESH_FORMAT_NONE. */
const char *mesh_format_name(mesh_format format);
