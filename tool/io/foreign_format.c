/* Recognises files of other programs that are not read, and names the way out of them. */
#include "tool/io/foreign_format.h"

#include "tool/io/path_name.h"

#include <stdbool.h>
#include <string.h>

enum { STARTS_MOST = 2, ENDINGS_MOST = 4 };

#define SCENE_ADVICE                                                                                         \
    ", which is not read: export the mesh as OBJ, and its frames as an OBJ sequence, a PC2 or MDD point "    \
    "cache or animated glTF (.glb); see docs/artist/formats.md"
#define MESH_ADVICE ", which is not read: convert it to OBJ, PLY, OFF or STL; see docs/artist/formats.md"
#define SURFACE_ADVICE                                                                                       \
    ", which is not read: mris_convert makes a GIFTI surface (.gii) of it; see docs/artist/formats.md"

typedef struct foreign_format {
    const char *advice;
    const char *starts[STARTS_MOST];   /* of their content */
    const char *endings[ENDINGS_MOST]; /* of their names */
} foreign_format;

static const foreign_format formats[] = {
    {"an Alembic archive" SCENE_ADVICE, {"Ogawa"}, {".abc"}},
    {"a USD file" SCENE_ADVICE, {"PXR-USDC", "#usda"}, {".usd", ".usda", ".usdc", ".usdz"}},
    {"an FBX file" SCENE_ADVICE, {"Kaydara FBX", "; FBX"}, {".fbx"}},
    {"a Blender file" SCENE_ADVICE, {"BLENDER"}, {".blend"}},
    {"an X3D file" SCENE_ADVICE, {"#X3D"}, {".x3d", ".x3dv", ".x3db"}},
    {"a VRML file" SCENE_ADVICE, {"#VRML"}, {".wrl"}},
    {"a COLLADA file" SCENE_ADVICE, {NULL}, {".dae"}},
    {"a Maya scene" SCENE_ADVICE, {"//Maya"}, {".ma", ".mb"}},
    {"a 3ds Max scene" SCENE_ADVICE, {NULL}, {".max", ".3ds"}},
    {"a Cinema 4D scene" SCENE_ADVICE, {NULL}, {".c4d"}},
    {"a Houdini file" SCENE_ADVICE, {NULL}, {".hip", ".hipnc", ".bgeo", ".geo"}},
    {"a ZBrush project" SCENE_ADVICE, {NULL}, {".zpr", ".ztl"}},
    {"a Marvelous Designer project" SCENE_ADVICE, {NULL}, {".zprj"}},
    {"a VTK file" MESH_ADVICE, {"# vtk DataFile"}, {".vtk", ".vtp", ".vtu"}},
    {"a mesh of Gmsh or Medit" MESH_ADVICE,
     {"$MeshFormat", "MeshVersionFormatted"},
     {".msh", ".mesh", ".meshb"}},
    {"a 3MF package" MESH_ADVICE, {NULL}, {".3mf"}},
    {"a FreeSurfer surface" SURFACE_ADVICE, {"\xff\xff\xfe"}, {".pial", ".white", ".inflated", ".sphere"}},
};

static bool has_start(const foreign_format *format, const char *bytes, size_t size) {
    for (int i = 0; i < STARTS_MOST && format->starts[i] != NULL; i++) {
        const size_t length = strlen(format->starts[i]);
        if (size >= length && memcmp(bytes, format->starts[i], length) == 0) return true;
    }
    return false;
}

static bool has_ending(const foreign_format *format, const char *path) {
    for (int i = 0; i < ENDINGS_MOST && format->endings[i] != NULL; i++)
        if (path_has_extension(path, format->endings[i])) return true;
    return false;
}

const char *foreign_format_advice(const char *path, const char *bytes, size_t size) {
    const size_t count = sizeof formats / sizeof *formats;
    for (size_t i = 0; bytes != NULL && i < count; i++)
        if (has_start(&formats[i], bytes, size)) return formats[i].advice;
    for (size_t i = 0; i < count; i++)
        if (has_ending(&formats[i], path)) return formats[i].advice;
    return NULL;
}
