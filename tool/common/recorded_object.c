/* Opens the model and the frames of an object, and reads one frame after the other. */
#include "tool/common/recording.h"

#include "tool/common/provenance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A file that holds a model and its animation is played, unless it has frames. */
static bool open_frames(const animation_options *frames, recorded_object *o, io_error *error) {
    recorded_source *source = &o->source;
    if (source->frame_path_count == 0 && source->itself != NULL && o->file.animation_count > 0) {
        source->frame_paths = source->itself;
        source->frame_path_count = 1;
    }
    o->file_positions = malloc((size_t)o->file.vertex_count * 3 * sizeof *o->file_positions);
    if (o->file_positions == NULL) return io_fail(error, "%s: out of memory", source->model_path);
    animation_options options = *frames;
    options.model_path = source->model_path;
    options.model_face_count = o->file.polygon_count;
    options.model_faces_hash = o->file.faces_hash;
    return source->frame_path_count == 0 || animation_open(source->frame_paths, source->frame_path_count,
                                                           o->file.vertex_count, &options, &o->frames, error);
}

/* Reads the file's own positions of a frame into file_positions. */
static bool read_file_positions(recorded_object *o, uint32_t frame, io_error *error) {
    if (o->frames != NULL) return animation_read(o->frames, frame, o->file_positions, error);
    memcpy(o->file_positions, o->file.positions,
           (size_t)o->file.vertex_count * 3 * sizeof *o->file_positions);
    return true;
}

const char *recorded_object_split_format(const recorded_object *o) {
    const mesh_format format = o->file.format;
    return format == MESH_FORMAT_STL || format == MESH_FORMAT_GLTF ? mesh_format_name(format) : NULL;
}

const char *recorded_object_parts_word(mesh_parts_by parts_by) {
    static const char *const words[] = {"part", "object", "group", "material"};
    return words[parts_by];
}

void recorded_object_explain_parts(const recorded_object *o, char *text, size_t size) {
    static const char *const keywords[] = {"", "o", "g", "usemtl"};
    const mesh_parts_by by = o->source.parts_by;
    const char *word = recorded_object_parts_word(by);
    if (o->file.format == MESH_FORMAT_OBJ)
        snprintf(text, size, "no line '%s' names %s %s of its faces", keywords[by],
                 by == MESH_PARTS_BY_OBJECT ? "an" : "a", word);
    else if (by == MESH_PARTS_BY_OBJECT)
        snprintf(text, size, "the file names no objects");
    else if (o->file.format == MESH_FORMAT_GLTF && by == MESH_PARTS_BY_MATERIAL)
        snprintf(text, size, "none of its triangles has a material");
    else
        snprintf(text, size, "%s files have no %ss", mesh_format_name(o->file.format), word);
}

/* The part of each vertex: objects of a scene may stand on each other, and stay apart; the materials of one
 * skin are joined. */
static bool label_vertices(const mesh_file *file, uint32_t **out, io_error *error) {
    const mesh_parts *own = mesh_file_own_parts(file);
    uint32_t *parts = malloc((size_t)file->vertex_count * sizeof *parts);
    if (parts == NULL)
        return io_fail(error, "out of memory for the parts of %u vertices", file->vertex_count);
    for (uint32_t v = 0; v < file->vertex_count; v++) parts[v] = NO_MESH_PART;
    for (size_t i = 0; own->of_triangle != NULL && i < 3 * (size_t)file->triangle_count; i++)
        parts[file->triangles[i]] = own->of_triangle[i / 3];
    *out = parts;
    return true;
}

/* Takes apart, of what lies together in the first frame, what comes apart in any other. A frame that cannot
 * be read is passed over: that is said when its turn comes. */
static bool part_in_frames(recorded_object *o, weld *w, weld_parting *parting, bool *changed,
                           io_error *error) {
    const uint32_t count = recorded_object_frame_count(o);
    *changed = false;
    for (uint32_t frame = 0; frame < count; frame++) {
        uint32_t parted;
        if (!read_file_positions(o, frame, NULL)) continue;
        if (!weld_part(w, o->file_positions, &parted, error)) return false;
        if (parted == UINT32_MAX) continue;
        *changed = true;
        if (parting->vertex == UINT32_MAX) *parting = (weld_parting){.vertex = parted, .frame = frame};
    }
    return true;
}

/* Frames in files of their own may come late, or be pipes, so they are read once, and in their turn. */
static bool weld_in_all_frames(recorded_object *o, weld *w, weld_parting *parting, io_error *error) {
    const uint32_t joined = w->vertex_count;
    bool changed = joined < w->file_vertex_count && o->frames != NULL && animation_is_one_file(o->frames);
    /* If distances are allowed, another vertex may stand for those that are left, which must lie near it in
     * every frame. */
    while (changed) {
        if (!part_in_frames(o, w, parting, &changed, error)) return false;
        if (w->epsilon == 0.0) break;
    }
    parting->count = w->vertex_count - joined;
    return true;
}

bool recorded_object_weld(recorded_object *o, const uint32_t *parts, double epsilon, weld *out,
                          weld_parting *parting, io_error *error) {
    weld w;
    *parting = (weld_parting){.vertex = UINT32_MAX};
    if (!read_file_positions(o, 0, error) ||
        !weld_begin(o->file_positions, o->file.vertex_count, parts, epsilon, &w, error))
        return false;
    if (!weld_in_all_frames(o, &w, parting, error) ||
        !weld_finish(&w, o->file.triangles, o->file.triangle_count, error)) {
        weld_free(&w);
        return false;
    }
    *out = w;
    return true;
}

static bool weld_as_chosen(weld_choice welding, recorded_object *o, io_error *error) {
    o->vertex_count = o->file.vertex_count;
    o->triangle_count = o->file.triangle_count;
    const bool by_format = welding.rule == WELD_BY_FORMAT && recorded_object_split_format(o) != NULL;
    if (welding.rule != WELD_WITHIN && !by_format) return true;
    uint32_t *parts = NULL;
    if (by_format && o->file.format == MESH_FORMAT_GLTF && !label_vertices(&o->file, &parts, error))
        return false;
    o->welded = recorded_object_weld(o, parts, welding.epsilon, &o->weld, &o->parting, error);
    free(parts);
    if (!o->welded) return false;
    o->vertex_count = o->weld.vertex_count;
    o->triangle_count = o->weld.triangle_count;
    return true;
}

uint64_t recorded_object_hash_model(const recorded_object *o) {
    const mesh_file *file = &o->file;
    uint64_t hash = provenance_hash_numbers(PROVENANCE_HASH_START, file->triangles,
                                            (size_t)file->triangle_count * 3, sizeof *file->triangles);
    return provenance_hash_numbers(hash, file->positions, (size_t)file->vertex_count * 3,
                                   sizeof *file->positions);
}

bool recorded_object_open(const recorded_source *source, weld_choice welding, const animation_options *frames,
                          recorded_object *out, io_error *error) {
    recorded_object o = {.source = *source, .frames_hash = PROVENANCE_HASH_START};
    if (!mesh_file_read_parts(source->model_path, source->parts_by, &o.file, error) ||
        !open_frames(frames, &o, error) || !weld_as_chosen(welding, &o, error)) {
        recorded_object_close(&o);
        return false;
    }
    *out = o;
    return true;
}

void recorded_object_close(recorded_object *o) {
    animation_close(o->frames);
    weld_free(&o->weld);
    mesh_file_free(&o->file);
    free(o->file_positions);
    *o = (recorded_object){0};
}

uint32_t recorded_object_frame_count(const recorded_object *o) {
    return o->frames != NULL ? animation_frame_count(o->frames) : 1;
}

/* Checks the range that the library accepts, so that the error can name vertices as the file numbers them. */
static bool check_range(const recorded_object *o, io_error *error) {
    for (size_t i = 0; i < (size_t)o->file.vertex_count * 3; i++) {
        double x = o->file_positions[i], magnitude = fabs(x);
        if (x == 0.0 || (magnitude >= 0x1p-300 && magnitude <= 0x1p300)) continue;
        return io_fail(error, "vertex %zu has %c = %g, expected 0 or a magnitude from 2^-300 to 2^300", i / 3,
                       "xyz"[i % 3], x);
    }
    return true;
}

bool recorded_object_read(recorded_object *o, uint32_t frame, double *positions, io_error *error) {
    if (!read_file_positions(o, frame, error) || !check_range(o, error)) return false;
    if (o->welded) return weld_positions(&o->weld, o->file_positions, positions, error);
    memcpy(positions, o->file_positions, (size_t)o->vertex_count * 3 * sizeof *positions);
    return true;
}

void recorded_object_rest(const recorded_object *o, double *positions) {
    for (uint32_t v = 0; v < o->vertex_count; v++)
        memcpy(positions + (size_t)v * 3, o->file.positions + (size_t)recorded_object_file_vertex(o, v) * 3,
               3 * sizeof *positions);
}

uint64_t recorded_object_hash_frame(const recorded_object *o) {
    return provenance_hash_numbers(PROVENANCE_HASH_START, o->file_positions, (size_t)o->file.vertex_count * 3,
                                   sizeof *o->file_positions);
}

const uint32_t *recorded_object_triangles(const recorded_object *o) {
    return o->welded ? o->weld.triangles : o->file.triangles;
}

uint32_t recorded_object_file_vertex(const recorded_object *o, uint32_t vertex) {
    return o->welded ? o->weld.file_vertex[vertex] : vertex;
}

uint32_t recorded_object_file_triangle(const recorded_object *o, uint32_t triangle) {
    return o->welded ? o->weld.file_triangle[triangle] : triangle;
}

uint32_t recorded_object_find_triangle(const recorded_object *o, uint32_t file_triangle) {
    if (!o->welded) return file_triangle;
    uint32_t low = 0, high = o->weld.triangle_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (o->weld.file_triangle[middle] < file_triangle)
            low = middle + 1;
        else
            high = middle;
    }
    return low < o->weld.triangle_count && o->weld.file_triangle[low] == file_triangle ? low : UINT32_MAX;
}
