/* The arrays of a page: packed, values in, compressed in memory as they come, base64 out; and listed by name,
 * those collected and those that follow from the mesh and the plan. */
#include "tool/report/page.h"

#include "tool/common/methods.h"
#include "tool/common/plans.h"
#include "tool/report/collected.h"

#include <assert.h>
#include <stdlib.h>

/* ---- packed arrays ------------------------------------------------------------------------------------- */

#define ZLIB_CONST

#include "tool/io/io.h"

#include <string.h>
#include <zlib.h>

enum {
    LEVEL = 6,
    CHUNK_VALUES = 1024,
    FIRST_CAPACITY = 4096,
    STEP_MAX = 1 << 30 /* zlib counts in 32 bits */
};

struct packed_array {
    z_stream stream;
    growable bytes; /* of the stream so far */
    size_t size;    /* of what was added */
    bool finished;
};

static voidpf zlib_allocate(voidpf user, uInt count, uInt size) {
    (void)user;
    return count <= SIZE_MAX / size ? io_realloc(NULL, (size_t)count * size) : NULL;
}

static void zlib_release(voidpf user, voidpf memory) {
    (void)user;
    free(memory);
}

packed_array *packed_array_create(void) {
    packed_array *array = io_realloc(NULL, sizeof *array);
    if (array == NULL) return NULL;
    *array =
        (packed_array){.stream = {.zalloc = zlib_allocate, .zfree = zlib_release}, .bytes = growable_of(1)};
    if (deflateInit(&array->stream, LEVEL) == Z_OK) return array;
    free(array);
    return NULL;
}

void packed_array_destroy(packed_array *array) {
    if (array == NULL) return;
    deflateEnd(&array->stream);
    growable_free(&array->bytes);
    free(array);
}

/* Makes room for more of the stream, by doubling. */
static bool make_room(packed_array *array) {
    growable *bytes = &array->bytes;
    if (bytes->count == bytes->capacity) {
        if (bytes->capacity > SIZE_MAX / 2) return false;
        if (!growable_reserve(bytes, bytes->capacity > 0 ? 2 * bytes->capacity : FIRST_CAPACITY))
            return false;
    }
    size_t room = bytes->capacity - bytes->count;
    array->stream.next_out = (Bytef *)bytes->data + bytes->count;
    array->stream.avail_out = (uInt)(room < STEP_MAX ? room : STEP_MAX);
    return true;
}

/* Hands over what next_in has; with Z_FINISH until the stream has ended. */
static bool compress_input(packed_array *array, int flush) {
    z_stream *stream = &array->stream;
    int status = Z_OK;
    while (flush == Z_FINISH ? status != Z_STREAM_END : stream->avail_in > 0) {
        if (!make_room(array)) return false;
        status = deflate(stream, flush);
        array->bytes.count = (size_t)(stream->next_out - (Bytef *)array->bytes.data);
        if (status != Z_OK && status != Z_STREAM_END) return false;
    }
    return true;
}

static bool add_bytes(packed_array *array, const uint8_t *bytes, size_t size) {
    array->size += size;
    while (size > 0) {
        size_t step = size < STEP_MAX ? size : STEP_MAX;
        array->stream.next_in = bytes;
        array->stream.avail_in = (uInt)step;
        if (!compress_input(array, Z_NO_FLUSH)) return false;
        bytes += step;
        size -= step;
    }
    return true;
}

bool packed_array_add_bytes(packed_array *array, const uint8_t *bytes, size_t count) {
    return add_bytes(array, bytes, count);
}

static void store_bytes(uint8_t *bytes, uint64_t bits, size_t size) {
    for (size_t i = 0; i < size; i++) bytes[i] = (uint8_t)(bits >> (8 * i));
}

bool packed_array_add_u32(packed_array *array, const uint32_t *values, size_t count) {
    uint8_t chunk[CHUNK_VALUES * 4];
    for (size_t done = 0; done < count;) {
        size_t step = count - done < CHUNK_VALUES ? count - done : CHUNK_VALUES;
        for (size_t i = 0; i < step; i++) store_bytes(chunk + 4 * i, values[done + i], 4);
        if (!add_bytes(array, chunk, 4 * step)) return false;
        done += step;
    }
    return true;
}

bool packed_array_add_f32(packed_array *array, const float *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        if (!packed_array_add_u32(array, &bits, 1)) return false;
    }
    return true;
}

bool packed_array_add_f64(packed_array *array, const double *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint8_t bytes[8];
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        store_bytes(bytes, bits, sizeof bytes);
        if (!add_bytes(array, bytes, sizeof bytes)) return false;
    }
    return true;
}

/* Bytes added so far. */
static size_t packed_array_size(const packed_array *array) {
    return array->size;
}

bool packed_array_finish(packed_array *array) {
    if (array->finished) return true;
    array->stream.next_in = NULL;
    array->stream.avail_in = 0;
    array->finished = compress_input(array, Z_FINISH);
    return array->finished;
}

/* Three bytes become four characters; a last group of one or two is filled up with `=`. */
static void encode_group(const uint8_t *bytes, size_t count, char characters[4]) {
    static const char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint32_t bits = (uint32_t)bytes[0] << 16;
    if (count > 1) bits |= (uint32_t)bytes[1] << 8;
    if (count > 2) bits |= bytes[2];
    for (size_t i = 0; i < 4; i++) characters[i] = i <= count ? alphabet[bits >> (18 - 6 * i) & 63] : '=';
}

bool packed_array_write(const packed_array *array, FILE *file) {
    char text[CHUNK_VALUES * 4];
    const uint8_t *bytes = array->bytes.data;
    size_t size = array->bytes.count, length = 0;
    for (size_t i = 0; i < size; i += 3) {
        encode_group(bytes + i, size - i < 3 ? size - i : 3, text + length);
        length += 4;
        if (length < sizeof text && i + 3 < size) continue;
        if (fwrite(text, 1, length, file) != length) return false;
        length = 0;
    }
    return true;
}

/* ---- arrays by name ------------------------------------------------------------------------------------ */

static void put_array(page_arrays *a, const char *name, const char *type, packed_array *values, bool owned) {
    assert(a->count < PAGE_ARRAYS_MAX);
    page_array *array = &a->items[a->count++];
    *array = (page_array){.type = type, .values = values, .owned = owned};
    snprintf(array->name, sizeof array->name, "%s", name);
}

/* Lists an array of the report; with values NULL the page has none. */
static bool list_array(page_arrays *a, const char *name, const char *type, packed_array *values) {
    if (values == NULL) return true;
    put_array(a, name, type, values, false);
    return packed_array_finish(values);
}

packed_array *page_arrays_add(page_arrays *a, const char *name, const char *type) {
    packed_array *values = packed_array_create();
    if (values == NULL) return NULL;
    put_array(a, name, type, values, true);
    return values;
}

size_t page_arrays_room(const page_arrays *a) {
    return PAGE_ARRAYS_MAX - a->count;
}

static bool list_u32(page_arrays *a, const char *name, const uint32_t *values, size_t count) {
    packed_array *packed = page_arrays_add(a, name, "u32");
    return packed != NULL && packed_array_add_u32(packed, values, count) && packed_array_finish(packed);
}

static bool list_triangles(page_arrays *a, const cscd_mesh *mesh) {
    packed_array *packed = page_arrays_add(a, "triangles", "u32");
    bool added = packed != NULL;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh) && added; t++) {
        uint32_t corners[3];
        cscd_mesh_triangle(mesh, t, corners);
        added = packed_array_add_u32(packed, corners, 3);
    }
    return added && packed_array_finish(packed);
}

static bool list_components(page_arrays *a, const cscd_mesh *mesh) {
    packed_array *packed = page_arrays_add(a, "component", "u32");
    bool added = packed != NULL;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh) && added; t++) {
        uint32_t component = cscd_mesh_triangle_component(mesh, t);
        added = packed_array_add_u32(packed, &component, 1);
    }
    return added && packed_array_finish(packed);
}

static bool list_charges(page_arrays *a, const cscd_plan *plan, const cscd_mesh *mesh) {
    double *ranks = charge_ranks(plan, mesh);
    packed_array *charges = page_arrays_add(a, "charge", "f32"),
                 *equalized = page_arrays_add(a, "equalized", "f32");
    bool added = ranks != NULL && charges != NULL && equalized != NULL;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh) && added; t++) {
        float charge = (float)cscd_plan_triangle_charge(plan, t), rank = (float)ranks[t];
        added = packed_array_add_f32(charges, &charge, 1) && packed_array_add_f32(equalized, &rank, 1);
    }
    free(ranks);
    return added && packed_array_finish(charges) && packed_array_finish(equalized);
}

static bool list_regions(page_arrays *a, const cscd_plan *plan, const cscd_mesh *mesh) {
    packed_array *packed = page_arrays_add(a, "region", "u32");
    bool added = packed != NULL;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh) && added; t++) {
        uint32_t region = cscd_plan_triangle_region(plan, t);
        added = packed_array_add_u32(packed, &region, 1);
    }
    return added && packed_array_finish(packed);
}

static bool list_scenery(page_arrays *a, report *r) {
    const report_scenery *scenery = &r->options.scenery;
    return scenery->triangles == NULL ||
           (list_u32(a, "scenery_triangles", scenery->triangles, (size_t)scenery->triangle_count * 3) &&
            list_array(a, "scenery_frames", "u8", r->scenery.bytes));
}

static bool list_plan(page_arrays *a, const cscd_plan *plan, const cscd_mesh *mesh) {
    if (plan == NULL) return true;
    return (!method_facts_of(cscd_plan_method(plan)).by_charge || list_charges(a, plan, mesh)) &&
           list_regions(a, plan, mesh);
}

static bool list_contacts(page_arrays *a, report *r) {
    const contact_arrays *c = &r->contacts;
    return c->heat == NULL ||
           (list_u32(a, "heat", c->heat, cscd_mesh_triangle_count(r->options.mesh)) &&
            list_array(a, "contact_interval", "u32", c->interval) &&
            list_array(a, "contact_kind", "u8", c->kind) &&
            list_array(a, "contact_vertices", "u32", c->vertices) &&
            list_array(a, "contact_file_vertices", "u32", c->file_vertices) &&
            list_array(a, "contact_toi", "f64", c->toi) && list_array(a, "contact_point", "f64", c->point));
}

static bool list_answers(page_arrays *a, report *r) {
    const answer_arrays *found = &r->answers;
    if (found->frames_checked == 0) return true;
    return list_array(a, "answer_frame", "u32", found->frame) &&
           list_array(a, "answer_counts", "u32", found->counts) &&
           list_array(a, "answer_triangle", "u32", found->triangle) &&
           list_array(a, "answer_kind", "u8", found->kind) &&
           list_array(a, "curve_vertices", "u32", found->point_vertices) &&
           list_array(a, "curve_share", "f32", found->point_share) &&
           list_array(a, "curve_begins", "u8", found->point_begins) &&
           list_array(a, "depth_vertex", "u32", found->depth_vertex) &&
           list_array(a, "depth", "f32", found->depth);
}

bool page_arrays_list(report *r, page_arrays *out) {
    const cscd_mesh *mesh = r->options.mesh;
    *out = (page_arrays){.count = 0};
    if (mesh == NULL) return true;
    return list_triangles(out, mesh) && list_array(out, "frames", "u8", r->frames.bytes) &&
           list_scenery(out, r) && list_components(out, mesh) && list_plan(out, r->options.plan, mesh) &&
           list_array(out, "orientation", "u8", r->orientations.orientations) &&
           list_array(out, "detector_points", "f64", r->orientations.points) && list_contacts(out, r) &&
           list_answers(out, r);
}

void page_arrays_free(page_arrays *arrays) {
    for (size_t i = 0; i < arrays->count; i++)
        if (arrays->items[i].owned) packed_array_destroy(arrays->items[i].values);
    arrays->count = 0;
}

size_t page_array_count(const page_array *array) {
    size_t bits = strtoul(array->type + 1, NULL, 10);
    return packed_array_size(array->values) * 8 / bits;
}
