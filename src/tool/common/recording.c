/* A model file and its recorded frames, welded if the user asks for it, as a mesh and an array of
 * positions for each frame. */
#include "src/tool/common/recording.h"

#include "src/tool/common/provenance.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void recording_options_take(recording_options *options, const given_options *given) {
    options->model_path = given->inputs[0];
    options->frame_paths = given->inputs + 1;
    options->frame_path_count = given->input_count - 1;
}

/* The numbers of the frames' files, or of the first one, if that was given, on in their steps. */
static bool number_frames(const recording_options *options, recording *r, io_error *error) {
    r->frame_numbers = malloc((size_t)r->frame_count * sizeof *r->frame_numbers);
    if (r->frame_numbers == NULL) return io_fail(error, "out of memory for %u frames", r->frame_count);
    for (uint32_t i = 0; i < r->frame_count; i++)
        r->frame_numbers[i] = r->frames != NULL ? animation_frame_number(r->frames, i) : (int32_t)i;
    if (!options->first_frame.given) return true;
    const int64_t shift = (int64_t)options->first_frame.value - r->frame_numbers[0];
    if (r->frame_numbers[r->frame_count - 1] + shift > INT32_MAX)
        return io_fail(error, "--first-frame %d: the last frame would be number %lld, expected at most %d",
                       options->first_frame.value, (long long)(r->frame_numbers[r->frame_count - 1] + shift),
                       INT32_MAX);
    for (uint32_t i = 0; i < r->frame_count; i++)
        r->frame_numbers[i] = (int32_t)(r->frame_numbers[i] + shift);
    return true;
}

static bool open_frames(const recording_options *options, recording *r, io_error *error) {
    r->frame_count = 1;
    r->file_positions = malloc((size_t)r->file.vertex_count * 3 * sizeof *r->file_positions);
    if (r->file_positions == NULL) return io_fail(error, "%s: out of memory", options->model_path);
    const animation_options frames = {.model_path = options->model_path, .allow_gaps = options->allow_gaps};
    if (options->frame_path_count > 0) {
        if (!animation_open(options->frame_paths, options->frame_path_count, r->file.vertex_count, &frames,
                            &r->frames, error))
            return false;
        r->frame_count = animation_frame_count(r->frames);
    }
    return number_frames(options, r, error);
}

/* Reads the file's own positions of a frame into file_positions. */
static bool read_file_positions(recording *r, uint32_t frame, io_error *error) {
    io_error reason;
    if (r->frames != NULL)
        return animation_read(r->frames, frame, r->file_positions, &reason) ||
               io_fail(error, "frame %d: %s", r->frame_numbers[frame], reason.text);
    memcpy(r->file_positions, r->file.positions,
           (size_t)r->file.vertex_count * 3 * sizeof *r->file_positions);
    return true;
}

static bool create_mesh(const recording_options *options, recording *r, io_error *error) {
    cscd_context_options context_options = cscd_context_defaults();
    context_options.thread_count = options->thread_count;
    context_options.simd = options->simd;
    context_options.progress = options->progress;
    cscd_status status = cscd_context_create(&context_options, &r->context);
    if (status == CSCD_SYSTEM_ERROR)
        return io_fail(error, "the system refused to start %u threads; give --threads a smaller number",
                       options->thread_count);
    if (status == CSCD_INVALID_ARGUMENT)
        return io_fail(error, "this processor does not have %s; leave --simd at auto",
                       cscd_simd_name(options->simd));
    if (status != CSCD_OK) return io_fail(error, "%s", cscd_status_string(status));
    cscd_object_desc desc =
        cscd_object_of_triangles(r->file.vertex_count, r->file.triangle_count, r->file.triangles);
    if (r->welded)
        desc = cscd_object_of_triangles(r->weld.vertex_count, r->weld.triangle_count, r->weld.triangles);
    status = cscd_mesh_create(r->context, &desc, 1, &r->mesh);
    if (status == CSCD_OK) return true;
    return io_fail(error, "%s: %s", options->model_path, cscd_context_detail(r->context));
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

/* An edge is named by the file's vertices in the first triangle that contains it. */
static bool map_edges(recording *r, io_error *error) {
    uint32_t edge_count = cscd_mesh_edge_count(r->mesh);
    r->edge_file_vertices = malloc((size_t)edge_count * sizeof *r->edge_file_vertices);
    if (r->edge_file_vertices == NULL) return io_fail(error, "out of memory for %u edges", edge_count);
    for (uint32_t t = r->weld.triangle_count; t-- > 0;) {
        const uint32_t *welded = r->weld.triangles + (size_t)t * 3;
        const uint32_t *own = r->file.triangles + (size_t)r->weld.file_triangle[t] * 3;
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3;
            uint32_t *names = r->edge_file_vertices[recording_find_edge(r->mesh, welded[i], welded[j])];
            names[0] = own[welded[i] < welded[j] ? i : j];
            names[1] = own[welded[i] < welded[j] ? j : i];
        }
    }
    return true;
}

static bool weld_first_frame(const recording_options *options, recording *r, io_error *error) {
    if (!read_file_positions(r, 0, error)) return false;
    if (!weld_create(r->file_positions, r->file.vertex_count, r->file.triangles, r->file.triangle_count,
                     options->weld_epsilon, &r->weld, error))
        return false;
    r->welded = true;
    return true;
}

static uint64_t hash_model(const mesh_file *file) {
    uint64_t hash = provenance_hash(PROVENANCE_HASH_START, file->triangles,
                                    (size_t)file->triangle_count * 3 * sizeof *file->triangles);
    return provenance_hash(hash, file->positions, (size_t)file->vertex_count * 3 * sizeof *file->positions);
}

bool recording_open(const recording_options *options, recording *out, io_error *error) {
    recording r = {.frames_hash = PROVENANCE_HASH_START};
    bool opened = mesh_file_read(options->model_path, &r.file, error) && open_frames(options, &r, error) &&
                  (!options->weld || weld_first_frame(options, &r, error)) &&
                  create_mesh(options, &r, error) && (!options->weld || map_edges(&r, error));
    if (!opened) {
        recording_close(&r);
        return false;
    }
    r.model_hash = hash_model(&r.file);
    *out = r;
    return true;
}

void recording_close(recording *r) {
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    animation_close(r->frames);
    weld_free(&r->weld);
    free(r->edge_file_vertices);
    free(r->file_positions);
    free(r->frame_numbers);
    mesh_file_free(&r->file);
    *r = (recording){0};
}

/* Checks the range that the library accepts, so that the error can name vertices as the file numbers them. */
static bool check_range(const recording *r, uint32_t frame, io_error *error) {
    for (size_t i = 0; i < (size_t)r->file.vertex_count * 3; i++) {
        double x = r->file_positions[i], magnitude = fabs(x);
        if (x == 0.0 || (magnitude >= 0x1p-300 && magnitude <= 0x1p300)) continue;
        return io_fail(error,
                       "frame %d: vertex %zu has %c = %g, expected 0 or a magnitude from 2^-300 to 2^300",
                       r->frame_numbers[frame], i / 3, "xyz"[i % 3], x);
    }
    return true;
}

void recording_hash_frame(recording *r) {
    size_t size = (size_t)r->file.vertex_count * 3 * sizeof *r->file_positions;
    r->frames_hash = provenance_hash(r->frames_hash, r->file_positions, size);
}

bool recording_read(recording *r, uint32_t frame, double *positions, io_error *error) {
    if (!read_file_positions(r, frame, error) || !check_range(r, frame, error)) return false;
    size_t size = (size_t)r->file.vertex_count * 3 * sizeof *positions;
    if (r->welded)
        return weld_positions(&r->weld, r->file_positions, r->frame_numbers[frame], positions, error);
    memcpy(positions, r->file_positions, size);
    return true;
}

void recording_rest(const recording *r, double *positions) {
    for (uint32_t v = 0; v < cscd_mesh_vertex_count(r->mesh); v++) {
        uint32_t from = r->welded ? r->weld.file_vertex[v] : v;
        memcpy(positions + (size_t)v * 3, r->file.positions + (size_t)from * 3, 3 * sizeof *positions);
    }
}

uint32_t recording_file_triangle(const recording *r, uint32_t triangle) {
    return r->welded ? r->weld.file_triangle[triangle] : triangle;
}

static void edge_vertices(const recording *r, uint32_t edge, uint32_t vertices[2]) {
    if (r->welded)
        memcpy(vertices, r->edge_file_vertices[edge], sizeof r->edge_file_vertices[edge]);
    else
        cscd_mesh_edge(r->mesh, edge, vertices);
}

contact_record recording_contact(const recording *r, uint32_t frame, const cscd_contact *contact) {
    contact_record record = {.frame = r->frame_numbers[frame],
                             .kind = contact->kind,
                             .toi = contact->toi,
                             .u = contact->u,
                             .v = contact->v,
                             .bounded = contact->bounded};
    if (contact->kind == CSCD_CONTACT_VF) {
        record.a[0] = r->welded ? r->weld.file_vertex[contact->a] : contact->a;
        memcpy(record.b, r->file.triangles + (size_t)recording_file_triangle(r, contact->b) * 3,
               sizeof record.b);
    } else {
        edge_vertices(r, contact->a, record.a);
        edge_vertices(r, contact->b, record.b);
    }
    memcpy(record.point, contact->point, sizeof record.point);
    memcpy(record.normal, contact->normal, sizeof record.normal);
    return record;
}
