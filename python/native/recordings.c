/* Recordings, plans and polygons for Python: what the tool reads from files, and the tool itself. */
#include "python/native/host.h"

#include "tool/common/methods.h"
#include "tool/common/options.h"
#include "tool/common/part_names.h"
#include "tool/common/plans.h"
#include "tool/io/mesh_builder.h"
#include "tool/io/ply.h"
#include "tool/tool.h"
#include "tool/windows/console.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct read_recording {
    recording_options options; /* of which the recording has texts */
    recording recording;
    part_names parts;
} read_recording;

/* The tool's options, as Python gives them. Texts that are not given are NULL. */
typedef struct read_choices {
    const char *model_path;
    const char *const
        *frame_paths; /* what the tool takes for FRAMES; none: the model, or what a glTF file animates */
    size_t frame_path_count;
    const char *weld;       /* exact, none or a distance */
    const char *animation;  /* of a glTF file */
    const char *parts_path; /* a table of parts */
    const char *parts_by;   /* object, group or material */
    double fps;             /* of a glTF file, 0: 24 */
    const char *const *names,
        *const *paths, *const *frames; /* object_count: further objects; frames are NULL of those that rest */
    const unsigned char *obstacles;    /* object_count */
    size_t object_count;
    unsigned char rest, allow_gaps;
} read_choices;

static bool take_name(named_paths *list, const char *name, const char *path, bool obstacle, io_error *error) {
    named_path *named = &list->items[list->count];
    if (list->count == RECORDING_OBJECTS_MAX)
        return io_fail(error, "objects: expected %d at most", RECORDING_OBJECTS_MAX);
    if (name[0] == '\0' || strlen(name) >= sizeof named->name || strpbrk(name, ":,=") != NULL)
        return io_fail(error,
                       "objects: a name has 1 to %zu bytes, and no ':', ',' and '=' among them; got '%.80s'",
                       sizeof named->name - 1, name);
    *named = (named_path){.path = path, .obstacle = obstacle};
    memcpy(named->name, name, strlen(name));
    list->count++;
    return true;
}

static bool take_choices(const read_choices *choices, recording_options *out, io_error *error) {
    *out = (recording_options){.model_path = choices->model_path,
                               .frame_paths = choices->frame_paths,
                               .frame_path_count = choices->frame_path_count,
                               .plays_models = true,
                               .rest = choices->rest != 0,
                               .frames = {.fps = choices->fps,
                                          .animation_name = choices->animation,
                                          .allow_gaps = choices->allow_gaps != 0},
                               .thread_count = 1};
    if (choices->weld != NULL && !read_weld(choices->weld, &out->weld))
        return io_fail(error, "weld: expected 'exact', 'none' or a distance above 0, got '%.40s'",
                       choices->weld);
    if (choices->parts_by != NULL && !read_parts_by(choices->parts_by, &out->parts_by))
        return io_fail(error, "parts_by: expected 'object', 'group' or 'material', got '%.40s'",
                       choices->parts_by);
    if (choices->parts_by != NULL && choices->parts_path != NULL)
        return io_fail(error, "parts and parts_by both say what the parts are; give one of them");
    for (size_t i = 0; i < choices->object_count; i++) {
        if (!take_name(&out->objects, choices->names[i], choices->paths[i], choices->obstacles[i] != 0,
                       error) ||
            (choices->frames[i] != NULL &&
             !take_name(&out->frames_of, choices->names[i], choices->frames[i], false, error)))
            return false;
    }
    return true;
}

/* The choices, which are used as long as the recording is open, are the caller's. Files are read without Python's lock. */
PYTHON_API bool cscdpy_recording_open(const read_choices *choices, read_recording **out, io_error *error) {
    read_recording *r = calloc(1, sizeof *r);
    recording_options *options = r != NULL ? &r->options : NULL;
    if (r == NULL) return io_fail(error, "out of memory");
    if (!take_choices(choices, options, error)) {
        free(r);
        return false;
    }
    void *thread = python.save_thread();
    bool opened = recording_open(options, &r->recording, error);
    if (opened &&
        !(choices->parts_path != NULL ? part_names_read(&r->recording, choices->parts_path, &r->parts, error)
                                      : part_names_find(&r->recording, NULL, &r->parts, error))) {
        recording_close(&r->recording);
        opened = false;
    }
    python.restore_thread(thread);
    if (!opened) {
        free(r);
        return false;
    }
    *out = r;
    return true;
}

PYTHON_API void cscdpy_recording_close(read_recording *r) {
    part_names_free(&r->parts);
    recording_close(&r->recording);
    free(r);
}

PYTHON_API const cscd_mesh *cscdpy_recording_mesh(const read_recording *r) {
    return r->recording.mesh;
}

PYTHON_API uint32_t cscdpy_recording_frame_count(const read_recording *r) {
    return r->recording.frame_count;
}

PYTHON_API double cscdpy_recording_fps(const read_recording *r) {
    return recording_fps(&r->recording);
}

/* Per frame: what the artist calls it. Per triangle: the face of the file that it is cut from, and its part. Per vertex: its
 * number in the file; of several objects each counts by itself. */
PYTHON_API void cscdpy_recording_copy(const read_recording *r, int32_t *frame_numbers, uint32_t *faces,
                                      uint32_t *parts, uint32_t *file_vertices) {
    const cscd_mesh *mesh = r->recording.mesh;
    const uint32_t triangle_count = cscd_mesh_triangle_count(mesh);
    memcpy(frame_numbers, r->recording.frame_numbers, r->recording.frame_count * sizeof *frame_numbers);
    for (uint32_t t = 0; t < triangle_count; t++) {
        faces[t] = recording_file_face(&r->recording, t);
        parts[t] = r->parts.labels[t];
    }
    for (uint32_t v = 0; v < cscd_mesh_vertex_count(mesh); v++)
        file_vertices[v] = recording_file_vertex(&r->recording, v);
}

/* Per triangle: what it belongs to where that is not its part. False: it is. */
PYTHON_API bool cscdpy_recording_copy_bodies(const read_recording *r, uint32_t *bodies) {
    const uint32_t count = cscd_mesh_triangle_count(r->recording.mesh);
    if (r->parts.bodies != NULL) memcpy(bodies, r->parts.bodies, count * sizeof *bodies);
    return r->parts.bodies != NULL;
}

PYTHON_API uint32_t cscdpy_recording_object_count(const read_recording *r) {
    return r->recording.object_count;
}

/* Tells the name of an object, and in counts its vertices, its triangles, the faces of its file, and whether
 * it is an obstacle. */
PYTHON_API const char *cscdpy_recording_object(const read_recording *r, uint32_t object, uint32_t counts[4]) {
    const recorded_object *o = &r->recording.objects[object];
    counts[0] = o->vertex_count;
    counts[1] = o->triangle_count;
    counts[2] = o->file.polygon_count;
    counts[3] = o->source.obstacle;
    return o->source.name;
}

PYTHON_API uint32_t cscdpy_recording_part_count(const read_recording *r) {
    return r->parts.count;
}

PYTHON_API const char *cscdpy_recording_part_name(const read_recording *r, uint32_t part) {
    return r->parts.names[part];
}

/* positions: of all vertices, three doubles each. One call at a time. */
PYTHON_API bool cscdpy_recording_read(read_recording *r, uint32_t frame, double *positions, io_error *error) {
    void *thread = python.save_thread();
    bool read = recording_read(&r->recording, frame, positions, error);
    python.restore_thread(thread);
    return read;
}

/* ---- plans --------------------------------------------------------------------------------------------- */

/* Within a turn in the host of the mesh, which has the plan. */
PYTHON_API bool cscdpy_plan_read(const char *path, const cscd_mesh *mesh, cscd_plan **out, io_error *error) {
    return plan_file_read(path, cscd_mesh_context(mesh), mesh, out, error);
}

static bool colour_plan(const cscd_plan *plan, const cscd_mesh *mesh, uint8_t *colours) {
    if (method_facts_of(cscd_plan_method(plan)).by_charge) return plan_colour_charge(plan, mesh, colours);
    plan_colour_regions(plan, cscd_mesh_triangle_count(mesh), colours);
    return true;
}

/* positions: the mesh at rest, as the plan was made from it. */
PYTHON_API bool cscdpy_plan_write(const char *path, const cscd_mesh *mesh, const double *positions,
                                  const cscd_plan *plan, io_error *error) {
    uint8_t *colours = malloc((size_t)cscd_mesh_triangle_count(mesh) * 3);
    bool written = (colours != NULL && colour_plan(plan, mesh, colours)) || io_fail(error, "out of memory");
    written = written && plan_file_write(path, mesh, positions, plan, colours, error);
    free(colours);
    return written;
}

/* The mesh at rest in a plan file, or in any file of a mesh; cscdpy_polygons_... work on it. */
PYTHON_API bool cscdpy_mesh_read(const char *path, mesh_file **out, io_error *error) {
    mesh_file *mesh = calloc(1, sizeof *mesh);
    if (mesh == NULL) return io_fail(error, "out of memory");
    if (!mesh_file_read(path, mesh, error)) {
        free(mesh);
        return false;
    }
    *out = mesh;
    return true;
}

PYTHON_API uint32_t cscdpy_mesh_vertex_count(const mesh_file *mesh) {
    return mesh->vertex_count;
}

PYTHON_API void cscdpy_mesh_copy_positions(const mesh_file *mesh, double *positions) {
    memcpy(positions, mesh->positions, (size_t)mesh->vertex_count * 3 * sizeof *positions);
}

/* ---- the tool ------------------------------------------------------------------------------------------ */

/* Runs the tool `cscd` in this process, with its own signals and output, and returns its exit code. */
PYTHON_API int cscdpy_run_tool(int argument_count, char **arguments) {
    const bool has_lock_to_give = python.save_thread != NULL; /* not where nothing but the tool is used */
    void *thread = has_lock_to_give ? python.save_thread() : NULL;
    const unsigned page = console_begin();
    int code = tool_run(argument_count, arguments);
    fflush(NULL);
    console_end(page);
    if (has_lock_to_give) python.restore_thread(thread);
    return code;
}

/* ---- polygons ------------------------------------------------------------------------------------------ */

/* Faces that Python has are cut into triangles in the way that faces of files are. */
static bool add_faces(mesh_builder *builder, const double *positions, uint32_t vertex_count,
                      const uint32_t *corners, const uint32_t *face_sizes, size_t face_count) {
    for (uint32_t v = 0; v < vertex_count; v++)
        if (!mesh_builder_add_vertex(builder, positions + (size_t)v * 3)) return false;
    for (size_t face = 0; face < face_count; face++) {
        if (!mesh_builder_begin_face(builder)) return false;
        for (uint32_t i = 0; i < face_sizes[face]; i++)
            if (!mesh_builder_add_corner(builder, *corners++)) return false;
        if (!mesh_builder_end_face(builder)) return false;
    }
    return true;
}

/* Faces of face_sizes corners, one after the other, become *out, which cscdpy_polygons_free gives back. Faces without three
 * different corners are left without a triangle. On false `error` says why. */
PYTHON_API bool cscdpy_polygons_cut(const double *positions, uint32_t vertex_count, const uint32_t *corners,
                                    const uint32_t *face_sizes, size_t face_count, mesh_file **out,
                                    io_error *error) {
    file_reader reader = {.path = "faces", .error = error};
    mesh_builder builder = mesh_builder_of(&reader, 0);
    mesh_file *mesh = calloc(1, sizeof *mesh);
    bool cut = mesh != NULL &&
               add_faces(&builder, positions, vertex_count, corners, face_sizes, face_count) &&
               (builder.triangle_count == 0 || mesh_builder_finish(&builder, mesh));
    if (mesh == NULL) io_fail(error, "out of memory");
    mesh_builder_free(&builder);
    if (!cut) {
        free(mesh);
        return false;
    }
    *out = mesh;
    return true;
}

PYTHON_API uint32_t cscdpy_polygons_count(const mesh_file *mesh) {
    return mesh->triangle_count;
}

/* Copies the triangles, three vertices each, and the face that each is cut from. */
PYTHON_API void cscdpy_polygons_copy(const mesh_file *mesh, uint32_t *triangles, uint32_t *faces) {
    memcpy(triangles, mesh->triangles, (size_t)mesh->triangle_count * 3 * sizeof *triangles);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) faces[i] = mesh_file_polygon(mesh, i);
}

PYTHON_API void cscdpy_polygons_free(mesh_file *mesh) {
    mesh_file_free(mesh);
    free(mesh);
}

/* ---- standard error ------------------------------------------------------------------------------------ */

/* libpng writes to this stream inside the module, in place of the C library's variable: see link.sh. */
extern FILE *cscdpy_standard_error;
FILE *cscdpy_standard_error;

__attribute__((constructor)) static void find_stream(void) {
    cscdpy_standard_error = stderr;
}
