/* The readers of mesh files, one for each format. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/mesh_file.h"

typedef struct format_reader {
    mesh_format format;
    bool by_ending;   /* a file with the ending of the format is read so if its content says nothing else */
    bool names_parts; /* groups and materials, too */
    /* NULL if the content of a file never says that it has this format. */
    bool (*recognise)(const file_reader *reader);
    /* On false *out is untouched and the reader's error set. */
    bool (*read)(file_reader *reader, mesh_file *out);
} format_reader;

/* Wavefront OBJ: vertices and polygons; all other records are skipped. */
extern const format_reader obj_reader;
/* PLY (Stanford polygon format), text and binary of either byte order. Coordinates keep the precision of the file: a float in text is
 * read as the double that it spells. */
extern const format_reader ply_reader;
/* OFF (Object File Format) in text, with normals, colours or texture coordinates ignored. The keyword may be missing. */
extern const format_reader off_reader;
/* STL (stereolithography), binary and text: triangles that each bring their own three vertices, in file order. The content says which
 * kind it is, since binary files may begin with "solid", too. */
extern const format_reader stl_reader;
/* glTF 2.0: all nodes of the default scene as one mesh, in metres, y up: each node with a mesh in the order of the tree, and of it the
 * vertices of its primitives in file order. The state is that of the nodes' own transforms and weights. */
extern const format_reader gltf_reader;
/* GIFTI surfaces, as programs for brains write them: the first NIFTI_INTENT_POINTSET and the first NIFTI_INTENT_TRIANGLE. Transforms
 * of coordinates are not applied. A build without expat says that it lacks it. */
extern const format_reader gifti_reader;
