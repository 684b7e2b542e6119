/* Puts the objects of a recording together: one mesh, one array of positions, one series of frames. */
#include "tool/common/recording.h"

#include "tool/common/command.h"
#include "tool/common/provenance.h"
#include "tool/common/terminal.h"
#include "tool/io/format_reader.h"
#include "tool/io/io.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

void recording_options_take(recording_options *options, const given_options *given) {
    if (given->input_count == 0) return;
    options->model_path = given->inputs[0];
    options->frame_paths = given->inputs + 1;
    options->frame_path_count = given->input_count - 1;
}

const char *recording_options_path(const recording_options *options) {
    return options->model_path != NULL ? options->model_path : options->objects.items[0].path;
}

/* ---- objects ------------------------------------------------------------------------------------------- */

static char *name_of_model(const char *path) {
    const char *name = path_file_name(path), *dot = strrchr(name, '.');
    return strndup(name, dot != NULL && dot > name ? (size_t)(dot - name) : strlen(name));
}

/* The frames that --frames-of names for an object, unless it has some already. */
static bool find_frames(const recording_options *options, recorded_source *source, io_error *error) {
    for (uint32_t i = 0; i < options->frames_of.count; i++) {
        const named_path *frames = &options->frames_of.items[i];
        if (strcmp(frames->name, source->name) != 0) continue;
        if (source->frame_path_count > 0)
            return io_fail(error, "--frames-of %s: it has frames already, %s", source->name,
                           source->frame_paths[0]);
        source->frame_paths = &frames->path;
        source->frame_path_count = 1;
    }
    return true;
}

static bool open_object(const recording_options *options, recorded_source source, recording *r,
                        io_error *error) {
    if (!find_frames(options, &source, error)) return false;
    if (recording_find_object(r, source.name) != UINT32_MAX)
        return io_fail(error, "two objects are called %s", source.name);
    recorded_object *object = &r->objects[r->object_count];
    if (!recorded_object_open(&source, options->weld, &options->frames, object, error)) return false;
    if (r->object_count > 0) {
        const recorded_object *before = object - 1;
        object->first_vertex = before->first_vertex + before->vertex_count;
        object->first_triangle = before->first_triangle + before->triangle_count;
    }
    r->object_count++;
    return true;
}

/* All that --frames-of names must be there. */
static bool check_named(const recording_options *options, const recording *r, io_error *error) {
    for (uint32_t i = 0; i < options->frames_of.count; i++)
        if (recording_find_object(r, options->frames_of.items[i].name) == UINT32_MAX)
            return io_fail(error, "--frames-of %s: there is no object of that name, see --object",
                           options->frames_of.items[i].name);
    return true;
}

static bool open_objects(const recording_options *options, recording *r, io_error *error) {
    r->objects = calloc(options->objects.count + 1, sizeof *r->objects);
    if (options->model_path != NULL) r->model_name = name_of_model(options->model_path);
    if (r->objects == NULL || (options->model_path != NULL && r->model_name == NULL))
        return io_fail(error, "out of memory");
    const bool plays = options->plays_models && !options->rest;
    recorded_source model = {.name = r->model_name,
                             .model_path = options->model_path,
                             .frame_paths = options->frame_paths,
                             .frame_path_count = options->frame_path_count,
                             .parts_by = options->parts_by,
                             .itself = plays ? &options->model_path : NULL};
    if (options->model_path != NULL && !open_object(options, model, r, error)) return false;
    for (uint32_t i = 0; i < options->objects.count; i++) {
        const named_path *named = &options->objects.items[i];
        recorded_source source = {.name = named->name,
                                  .model_path = named->path,
                                  .obstacle = named->obstacle,
                                  .parts_by = options->parts_by,
                                  .itself = plays ? &named->path : NULL};
        if (!open_object(options, source, r, error)) return false;
    }
    return check_named(options, r, error);
}

/* ---- frames -------------------------------------------------------------------------------------------- */

static bool plays_itself(const recorded_object *object) {
    return object->source.itself != NULL && object->source.frame_paths == object->source.itself;
}

/* All objects with frames must have as many; the first of them says what they are called. */
static bool count_frames(recording *r, const recorded_object **first, io_error *error) {
    *first = NULL;
    for (uint32_t i = 0; i < r->object_count; i++) {
        const recorded_object *object = &r->objects[i];
        if (object->frames == NULL) continue;
        if (*first == NULL) *first = object;
        uint32_t own = recorded_object_frame_count(object), others = recorded_object_frame_count(*first);
        if (own != others)
            return io_fail(error, "%s has %u frames (%s), and %s has %u (%s): expected as many%s",
                           (*first)->source.name, others, (*first)->source.frame_paths[0],
                           object->source.name, own, object->source.frame_paths[0],
                           plays_itself(*first) || plays_itself(object)
                               ? "; --rest leaves files at rest that no FRAMES are given for"
                               : "");
    }
    r->frame_count = *first != NULL ? recorded_object_frame_count(*first) : 1;
    return true;
}

/* The numbers of the frames' files, or of the first one, if that was given, on in their steps. */
static bool number_frames(const recording_options *options, recording *r, io_error *error) {
    const recorded_object *first;
    if (!count_frames(r, &first, error)) return false;
    r->frame_numbers = malloc((size_t)r->frame_count * sizeof *r->frame_numbers);
    if (r->frame_numbers == NULL) return io_fail(error, "out of memory for %u frames", r->frame_count);
    for (uint32_t i = 0; i < r->frame_count; i++)
        r->frame_numbers[i] = first != NULL ? animation_frame_number(first->frames, i) : (int32_t)i;
    if (!options->first_frame.given) return true;
    const int64_t shift = (int64_t)options->first_frame.value - r->frame_numbers[0];
    const int64_t last = r->frame_numbers[r->frame_count - 1] + shift;
    if (last > INT32_MAX)
        return io_fail(error, "--first-frame %d: the last frame would be number %lld, expected at most %d",
                       options->first_frame.value, (long long)last, INT32_MAX);
    for (uint32_t i = 0; i < r->frame_count; i++)
        r->frame_numbers[i] = (int32_t)(r->frame_numbers[i] + shift);
    return true;
}

/* ---- mesh ---------------------------------------------------------------------------------------------- */

/* Unless the user says otherwise: starting threads takes longer than a whole command on a mesh so small
 * that the library would give them nothing to do (runtime/bvh/traversal.c shares trees of 768 triangles
 * and more). */
static uint32_t choose_thread_count(const recording_options *options, const recording *r) {
    enum { SHARED_TRIANGLES_MIN = 1000 };
    uint64_t triangles = 0;
    for (uint32_t i = 0; i < r->object_count; i++) triangles += r->objects[i].triangle_count;
    return options->thread_count == 0 && triangles < SHARED_TRIANGLES_MIN ? 1 : options->thread_count;
}

static bool create_context(const recording_options *options, recording *r, io_error *error) {
    r->shares_context = options->context != NULL;
    if (r->shares_context) {
        r->context = options->context;
        return true;
    }
    cscd_context_options context_options = cscd_context_defaults();
    context_options.thread_count = choose_thread_count(options, r);
    context_options.simd = options->simd;
    context_options.progress = options->progress;
    cscd_status status = cscd_context_create(&context_options, &r->context);
    if (status == CSCD_SYSTEM_ERROR)
        return io_fail(error, "the system refused to start %u threads; give --threads a smaller number",
                       options->thread_count);
    if (status == CSCD_INVALID_ARGUMENT)
        return io_fail(error, "this processor does not have %s; leave --simd at auto",
                       cscd_name(CSCD_SIMDS, options->simd));
    return status == CSCD_OK || io_fail(error, "%s", cscd_status_string(status));
}

static bool create_mesh(recording *r, io_error *error) {
    cscd_object_desc descs[RECORDING_OBJECTS_MAX + 1];
    for (uint32_t i = 0; i < r->object_count; i++) {
        const recorded_object *object = &r->objects[i];
        descs[i] = cscd_object_of_triangles(object->vertex_count, object->triangle_count,
                                            recorded_object_triangles(object));
        descs[i].obstacle = object->source.obstacle;
    }
    if (cscd_mesh_create(r->context, descs, r->object_count, &r->mesh) == CSCD_OK) return true;
    return io_fail(error, "%s: %s", r->objects[0].source.model_path, cscd_context_detail(r->context));
}

/* The mesh's edges are sorted by their vertices. */
uint32_t recording_find_edge(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    uint32_t smaller = a < b ? a : b, larger = a < b ? b : a;
    uint32_t low = 0, high = cscd_mesh_edge_count(mesh);
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2, ends[2];
        cscd_mesh_edge(mesh, middle, ends);
        if (ends[0] > smaller || (ends[0] == smaller && ends[1] > larger))
            high = middle;
        else
            low = middle;
    }
    uint32_t found[2];
    cscd_mesh_edge(mesh, low, found);
    assert(found[0] == smaller && found[1] == larger);
    return low;
}

static bool any_welded(const recording *r) {
    for (uint32_t i = 0; i < r->object_count; i++)
        if (r->objects[i].welded) return true;
    return false;
}

/* An edge is named by the file's vertices in the first triangle that contains it. */
static bool map_edges(recording *r, io_error *error) {
    if (!any_welded(r)) return true;
    uint32_t edge_count = cscd_mesh_edge_count(r->mesh);
    r->edge_file_vertices = malloc((size_t)edge_count * sizeof *r->edge_file_vertices);
    if (r->edge_file_vertices == NULL) return io_fail(error, "out of memory for %u edges", edge_count);
    for (uint32_t t = cscd_mesh_triangle_count(r->mesh); t-- > 0;) {
        const recorded_object *object = &r->objects[recording_object_of_triangle(r, t)];
        const uint32_t *own = object->file.triangles + (size_t)recording_file_triangle(r, t) * 3;
        uint32_t corners[3];
        cscd_mesh_triangle(r->mesh, t, corners);
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3;
            uint32_t *names = r->edge_file_vertices[recording_find_edge(r->mesh, corners[i], corners[j])];
            names[0] = own[corners[i] < corners[j] ? i : j];
            names[1] = own[corners[i] < corners[j] ? j : i];
        }
    }
    return true;
}

/* ---- files that come late ------------------------------------------------------------------------------ */

/* A file that cannot be read may be one that another machine has written a moment ago, on a network file
 * system. */

/* The time for which a file that cannot be read is tried again, and when that began. */
typedef struct late_files {
    double seconds, began_ms;
} late_files;

/* The time of a clock that nobody sets. */
static double now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* Begins to try, for this many seconds; 0: once. */
static late_files begin_trying(double seconds) {
    return (late_files){seconds, seconds > 0.0 ? now_ms() : 0.0};
}

/* Rests for a moment after a failure, and returns true if there is to be another try. An interrupt ends
 * it. */
static bool try_again(const late_files *late) {
    const struct timespec rest = {.tv_nsec = 50 * 1000 * 1000};
    if (late->seconds <= 0.0 || now_ms() - late->began_ms >= late->seconds * 1e3) return false;
    if (interrupt_ends_wait()) return false;
    nanosleep(&rest, NULL);
    return true;
}

/* ---- opening and reading ------------------------------------------------------------------------------- */

static bool open_once(const recording_options *options, recording *out, io_error *error) {
    recording r = {
        .parts_by = options->parts_by, .fps = options->frames.fps, .wait_seconds = options->wait_seconds};
    if (!open_objects(options, &r, error) || !number_frames(options, &r, error) ||
        !create_context(options, &r, error) || !create_mesh(&r, error) || !map_edges(&r, error)) {
        recording_close(&r);
        return false;
    }
    *out = r;
    return true;
}

/* A file that is not there yet, or not all of it, may be a moment later. */
bool recording_open(const recording_options *options, recording *out, io_error *error) {
    const late_files late = begin_trying(options->wait_seconds);
    while (!open_once(options, out, error))
        if (!try_again(&late)) return false;
    return true;
}

void recording_close(recording *r) {
    cscd_mesh_destroy(r->mesh);
    if (!r->shares_context) cscd_context_destroy(r->context);
    for (uint32_t i = 0; i < r->object_count; i++) recorded_object_close(&r->objects[i]);
    free(r->objects);
    free(r->model_name);
    free(r->edge_file_vertices);
    free(r->frame_numbers);
    *r = (recording){0};
}

static bool read_once(recording *r, uint32_t frame, double *positions, io_error *error) {
    for (uint32_t i = 0; i < r->object_count; i++) {
        recorded_object *object = &r->objects[i];
        io_error reason;
        const uint32_t own = object->frames != NULL ? frame : 0;
        if (recorded_object_read(object, own, positions + (size_t)object->first_vertex * 3, &reason))
            continue;
        if (r->object_count == 1)
            return io_fail(error, "frame %d could not be read: %s", r->frame_numbers[frame], reason.text);
        return io_fail(error, "frame %d could not be read: %s: %s", r->frame_numbers[frame],
                       object->source.name, reason.text);
    }
    return true;
}

bool recording_read(recording *r, uint32_t frame, double *positions, io_error *error) {
    const late_files late = begin_trying(r->wait_seconds);
    while (!read_once(r, frame, positions, error))
        if (!try_again(&late)) return false;
    return true;
}

void recording_end_reading(recording *r) {
    for (uint32_t i = 0; i < r->object_count; i++) {
        animation_close(r->objects[i].frames);
        r->objects[i].frames = NULL;
    }
}

void recording_expect(recording *r, uint32_t frame) {
    for (uint32_t i = 0; i < r->object_count; i++)
        if (r->objects[i].frames != NULL) animation_expect(r->objects[i].frames, frame);
}

void recording_rest(const recording *r, double *positions) {
    for (uint32_t i = 0; i < r->object_count; i++)
        recorded_object_rest(&r->objects[i], positions + (size_t)r->objects[i].first_vertex * 3);
}

void recording_hash_frame(const recording *r, uint64_t hashes[RECORDING_OBJECTS_MAX + 1]) {
    for (uint32_t i = 0; i < r->object_count; i++) hashes[i] = recorded_object_hash_frame(&r->objects[i]);
}

void recording_add_hashes(recording *r, const uint64_t hashes[RECORDING_OBJECTS_MAX + 1]) {
    for (uint32_t i = 0; i < r->object_count; i++) {
        recorded_object *o = &r->objects[i];
        o->frames_hash = provenance_hash_numbers(o->frames_hash, &hashes[i], 1, sizeof hashes[i]);
    }
}

double recording_fps(const recording *r) {
    if (r->fps > 0.0) return r->fps;
    for (uint32_t i = 0; i < r->object_count; i++) {
        const recorded_object *object = &r->objects[i];
        if (object->frames != NULL && gltf_recognise_path(object->source.frame_paths[0]))
            return ANIMATION_FPS;
    }
    return 0.0;
}

bool recording_object_rests(const recorded_object *object) {
    return object->frames == NULL && object->file.animation_count > 0;
}

bool recording_moves(const recording *r) {
    for (uint32_t i = 0; i < r->object_count; i++)
        if (r->objects[i].frames != NULL) return true;
    return false;
}

static uint32_t recording_object_of_vertex(const recording *r, uint32_t vertex) {
    uint32_t i = 0;
    while (i + 1 < r->object_count && vertex >= r->objects[i + 1].first_vertex) i++;
    return i;
}

uint32_t recording_object_of_triangle(const recording *r, uint32_t triangle) {
    uint32_t i = 0;
    while (i + 1 < r->object_count && triangle >= r->objects[i + 1].first_triangle) i++;
    return i;
}

uint32_t recording_find_object(const recording *r, const char *name) {
    for (uint32_t i = 0; i < r->object_count; i++)
        if (strcmp(r->objects[i].source.name, name) == 0) return i;
    return UINT32_MAX;
}

uint32_t recording_file_vertex(const recording *r, uint32_t vertex) {
    const recorded_object *object = &r->objects[recording_object_of_vertex(r, vertex)];
    return recorded_object_file_vertex(object, vertex - object->first_vertex);
}

uint32_t recording_file_triangle(const recording *r, uint32_t triangle) {
    const recorded_object *object = &r->objects[recording_object_of_triangle(r, triangle)];
    return recorded_object_file_triangle(object, triangle - object->first_triangle);
}

uint32_t recording_file_face(const recording *r, uint32_t triangle) {
    const recorded_object *object = &r->objects[recording_object_of_triangle(r, triangle)];
    return mesh_file_polygon(&object->file, recording_file_triangle(r, triangle));
}

static void edge_vertices(const recording *r, uint32_t edge, uint32_t vertices[2]) {
    if (r->edge_file_vertices != NULL) {
        memcpy(vertices, r->edge_file_vertices[edge], sizeof r->edge_file_vertices[edge]);
        return;
    }
    cscd_mesh_edge(r->mesh, edge, vertices);
    for (int i = 0; i < 2; i++) vertices[i] = recording_file_vertex(r, vertices[i]);
}

static uint32_t object_of_edge(const recording *r, uint32_t edge) {
    uint32_t ends[2];
    cscd_mesh_edge(r->mesh, edge, ends);
    return recording_object_of_vertex(r, ends[0]);
}

contact_record recording_contact(const recording *r, uint32_t frame, const cscd_contact *contact) {
    contact_record record = {.frame = r->frame_numbers[frame],
                             .kind = contact->kind,
                             .toi = contact->toi,
                             .u = contact->u,
                             .v = contact->v,
                             .bounded = contact->bounded};
    if (contact->kind == CSCD_CONTACT_VF) {
        record.objects[0] = recording_object_of_vertex(r, contact->a);
        record.objects[1] = recording_object_of_triangle(r, contact->b);
        record.a[0] = recording_file_vertex(r, contact->a);
        const mesh_file *second = &r->objects[record.objects[1]].file;
        memcpy(record.b, second->triangles + (size_t)recording_file_triangle(r, contact->b) * 3,
               sizeof record.b);
    } else {
        record.objects[0] = object_of_edge(r, contact->a);
        record.objects[1] = object_of_edge(r, contact->b);
        edge_vertices(r, contact->a, record.a);
        edge_vertices(r, contact->b, record.b);
    }
    memcpy(record.point, contact->point, sizeof record.point);
    memcpy(record.normal, contact->normal, sizeof record.normal);
    return record;
}
