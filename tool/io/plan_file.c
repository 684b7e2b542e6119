/* A plan as a PLY file that any viewer shows: the mesh at rest, charge and region per face, a colour. */
#include "tool/io/ply.h"

#include <cscd/research.h>

#include "tool/io/format_reader.h"
#include "tool/io/output_file.h"
#include "tool/io/text_encoding.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The data of a plan beside the vertices and their faces. */
typedef enum column {
    COLUMN_REGION,
    COLUMN_POINT_X,
    COLUMN_POINT_Y,
    COLUMN_POINT_Z,
    COLUMN_CHARGE,
    COLUMN_CAPACITANCE,
    COLUMN_COUNT
} column;

static const struct {
    const char *element, *property;
} columns[COLUMN_COUNT] = {{"face", "region"}, {"region", "x"},    {"region", "y"},
                           {"region", "z"},    {"face", "charge"}, {"component", "capacitance"}};

typedef struct plan_reader {
    ply_data data;
    const cscd_mesh *mesh;
    cscd_method method;
    bool charged; /* plans by this method have charges */
    char origin[256];
    uint64_t mesh_hash; /* as the file says */
    uint32_t region_count;
    double *positions, *points, *charges, *capacitances;
    uint32_t *regions;
    uint32_t differing;  /* the first triangle that differs from the mesh's, or UINT32_MAX */
    uint32_t corners[3]; /* its corners in the file */
} plan_reader;

/* ---- comments of the header ------------------------------------------------------------------------ */

/* Every plan has the first three. */
typedef enum comment_kind {
    COMMENT_PLAN,
    COMMENT_METHOD,
    COMMENT_MESH,
    COMMENT_ORIGIN,
    COMMENT_COUNT
} comment_kind;

static const char *const comment_names[COMMENT_COUNT] = {"plan", "method", "mesh", "made"};

static bool parse_hash(text_token token, uint64_t *out) {
    uint64_t hash = 0;
    for (size_t i = 0; i < token.length; i++) {
        char c = token.text[i];
        if (!((c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'))) return false;
        hash = hash << 4 | (uint64_t)(c <= '9' ? c - '0' : c - 'a' + 10);
    }
    if (token.length != 16) return false;
    *out = hash;
    return true;
}

/* Keeps the rest of the line, as much of it as there is room for. */
static void keep_origin(plan_reader *p, text_token first) {
    size_t length = 0; /* a 0 is behind the file's last byte */
    while (length + 1 < sizeof p->origin && first.text[length] >= ' ' && first.text[length] <= '~') {
        p->origin[length] = first.text[length];
        length++;
    }
    while (length > 0 && p->origin[length - 1] == ' ') length--;
    p->origin[length] = '\0';
}

static bool read_comment(plan_reader *p, file_reader *reader, comment_kind kind) {
    text_token value;
    text_next_token(reader, &value);
    const char *expected = "1, the format of this version";
    if (kind == COMMENT_ORIGIN) {
        keep_origin(p, value);
        return true;
    }
    bool fits = false;
    if (kind == COMMENT_PLAN) fits = text_equals(value, "1");
    if (kind == COMMENT_METHOD) {
        expected = "charge, kmeans, single or published";
        cscd_method_info info;
        fits = cscd_from_name(CSCD_METHODS, text_show(value).text, (uint32_t *)&p->method) &&
               cscd_method_describe(p->method, &info) && info.makes_plan;
        p->charged = fits && info.by_charge;
    } else if (kind == COMMENT_MESH) {
        expected = "the mesh's hash in 16 hexadecimal digits";
        fits = parse_hash(value, &p->mesh_hash);
    }
    return fits || file_reader_fail_here(reader, "found '%s', expected %s", text_show(value).text, expected);
}

/* Returns which "comment cscd NAME" the line begins with; COMMENT_COUNT: it is another line. */
static comment_kind comment_of_line(file_reader *reader) {
    text_token token;
    int kind = 0;
    if (!text_next_token(reader, &token) || !text_equals(token, "comment") ||
        !text_next_token(reader, &token) || !text_equals(token, "cscd") || !text_next_token(reader, &token))
        return COMMENT_COUNT;
    while (kind < COMMENT_COUNT && !text_equals(token, comment_names[kind])) kind++;
    return (comment_kind)kind;
}

/* start: a reader at the file's first byte. The header is known to be well-formed. */
static bool read_comments(plan_reader *p, file_reader start) {
    bool seen[COMMENT_COUNT] = {false};
    file_reader reader = start;
    size_t end = p->data.reader->at;
    for (; reader.at < end; text_skip_line(&reader)) {
        comment_kind kind = comment_of_line(&reader);
        if (kind == COMMENT_COUNT) continue;
        if (!read_comment(p, &reader, kind)) return false;
        seen[kind] = true;
    }
    for (int kind = 0; kind < COMMENT_ORIGIN; kind++) {
        if (!seen[kind])
            return file_reader_fail(p->data.reader,
                                    "the header lacks 'comment cscd %s', expected a plan that cscd wrote",
                                    comment_names[kind]);
    }
    return true;
}

/* ---- the rest of the header ------------------------------------------------------------------------ */

static const ply_element *find_element(const plan_reader *p, const char *name, size_t *found) {
    const ply_element *elements = p->data.header.elements.data, *first = NULL;
    *found = 0;
    for (size_t i = 0; i < p->data.header.elements.count; i++) {
        if (!text_equals(elements[i].name, name)) continue;
        if ((*found)++ == 0) first = &elements[i];
    }
    return first;
}

static bool has_column(const plan_reader *p, const ply_element *element, column c) {
    const ply_property *properties = p->data.header.properties.data;
    for (size_t i = 0; i < element->property_count; i++) {
        const ply_property *property = &properties[element->first_property + i];
        if (!property->is_list && text_equals(property->name, columns[c].property)) return true;
    }
    return false;
}

static bool check_columns(const plan_reader *p) {
    int count = p->charged ? COLUMN_COUNT : COLUMN_CHARGE;
    for (int c = 0; c < count; c++) {
        size_t found;
        const ply_element *element = find_element(p, columns[c].element, &found);
        if (found != 1)
            return file_reader_fail(p->data.reader, "%zu elements '%s' in the header, expected one", found,
                                    columns[c].element);
        if (!has_column(p, element, (column)c))
            return file_reader_fail(p->data.reader,
                                    "element '%s' lacks the property '%s', expected one number",
                                    columns[c].element, columns[c].property);
    }
    return true;
}

static int64_t count_of(const plan_reader *p, const char *name) {
    size_t found;
    const ply_element *element = find_element(p, name, &found);
    return element != NULL ? element->count : 0;
}

static bool check_counts(plan_reader *p) {
    file_reader *reader = p->data.reader;
    int64_t vertices = count_of(p, "vertex"), faces = count_of(p, "face"), regions = count_of(p, "region"),
            components = count_of(p, "component");
    uint32_t mesh_vertices = cscd_mesh_vertex_count(p->mesh), triangles = cscd_mesh_triangle_count(p->mesh);
    if (vertices != mesh_vertices || faces != triangles)
        return file_reader_fail(reader,
                                "the plan is of another mesh: it has %" PRId64 " vertices and %" PRId64
                                " triangles, expected %" PRIu32 " and %" PRIu32
                                ", of the same model with the same --weld",
                                vertices, faces, mesh_vertices, triangles);
    if (regions < 1 || regions > faces)
        return file_reader_fail(reader, "%" PRId64 " regions, expected 1 to %" PRIu32, regions, triangles);
    if (p->charged && components != cscd_mesh_component_count(p->mesh))
        return file_reader_fail(reader, "%" PRId64 " components, expected the %" PRIu32 " of the mesh",
                                components, cscd_mesh_component_count(p->mesh));
    p->region_count = (uint32_t)regions;
    return true;
}

/* ---- rows ------------------------------------------------------------------------------------------ */

/* The counts are those of the mesh, so a header cannot ask for more than fits to the mesh. */
static bool allocate_lists(plan_reader *p) {
    size_t triangles = cscd_mesh_triangle_count(p->mesh);
    p->positions = io_realloc(NULL, cscd_mesh_vertex_count(p->mesh) * sizeof(double[3]));
    p->points = io_realloc(NULL, p->region_count * sizeof(double[3]));
    p->regions = io_realloc(NULL, triangles * sizeof *p->regions);
    bool allocated = p->positions != NULL && p->points != NULL && p->regions != NULL;
    if (p->charged) {
        p->charges = io_realloc(NULL, triangles * sizeof *p->charges);
        p->capacitances = io_realloc(NULL, cscd_mesh_component_count(p->mesh) * sizeof *p->capacitances);
        allocated = allocated && p->charges != NULL && p->capacitances != NULL;
    }
    return allocated || file_reader_fail(p->data.reader, "out of memory for %zu triangles", triangles);
}

static bool read_finite(plan_reader *p, const ply_property *property, double *out) {
    if (!ply_data_number(&p->data, property, out)) return false;
    if (isfinite(*out)) return true;
    return file_reader_fail_here(p->data.reader, "'%s' of %s %" PRId64 " is %g, expected a finite number",
                                 text_show(property->name).text, text_show(p->data.element->name).text,
                                 p->data.row, *out);
}

static bool read_region(plan_reader *p, const ply_property *property) {
    double value;
    if (!read_finite(p, property, &value)) return false;
    if (!(value >= 0.0 && value < p->region_count && value == floor(value)))
        return file_reader_fail_here(p->data.reader,
                                     "face %" PRId64 " is in region %.9g, expected one of the %" PRIu32
                                     " regions, from 0",
                                     p->data.row, value, p->region_count);
    p->regions[p->data.row] = (uint32_t)value;
    return true;
}

/* Compares the corners with the mesh's, and keeps the first triangle that differs for the message. */
static bool compare_corners(plan_reader *p, const ply_property *property) {
    int64_t length;
    if (!ply_data_length(&p->data, property, &length)) return false;
    if (length != 3)
        return file_reader_fail_here(p->data.reader, "a face of %" PRId64 " corners, expected 3", length);
    uint32_t own[3], theirs[3];
    cscd_mesh_triangle(p->mesh, (uint32_t)p->data.row, own);
    bool equal = true;
    for (int i = 0; i < 3; i++) {
        double value;
        if (!ply_data_number(&p->data, property, &value)) return false;
        theirs[i] = value >= 0.0 && value < UINT32_MAX ? (uint32_t)value : UINT32_MAX;
        equal = equal && value == own[i];
    }
    if (equal || p->differing != UINT32_MAX) return true;
    p->differing = (uint32_t)p->data.row;
    for (int i = 0; i < 3; i++) p->corners[i] = theirs[i];
    return true;
}

static column column_of(const ply_element *element, const ply_property *property) {
    int c = 0;
    while (c < COLUMN_COUNT && (!text_equals(element->name, columns[c].element) ||
                                !text_equals(property->name, columns[c].property)))
        c++;
    return (column)c;
}

/* A column of the plan, or what somebody has added to it. */
static bool read_column(plan_reader *p, const ply_property *property) {
    const size_t row = (size_t)p->data.row;
    switch (column_of(p->data.element, property)) {
    case COLUMN_REGION:
        return read_region(p, property);
    case COLUMN_POINT_X:
        return read_finite(p, property, &p->points[row * 3]);
    case COLUMN_POINT_Y:
        return read_finite(p, property, &p->points[row * 3 + 1]);
    case COLUMN_POINT_Z:
        return read_finite(p, property, &p->points[row * 3 + 2]);
    case COLUMN_CHARGE:
        if (p->charges != NULL) return read_finite(p, property, &p->charges[row]);
        break;
    case COLUMN_CAPACITANCE:
        if (p->capacitances != NULL) return read_finite(p, property, &p->capacitances[row]);
        break;
    case COLUMN_COUNT:
        break;
    }
    return ply_data_skip(&p->data, property);
}

/* Parts and stiffness are a mesh's: a plan has none. */
static bool visit_property(void *user, const ply_property *property) {
    plan_reader *p = user;
    switch (property->role) {
    case PLY_X:
    case PLY_Y:
    case PLY_Z:
        return read_finite(p, property, &p->positions[(size_t)p->data.row * 3 + property->role]);
    case PLY_CORNERS:
        return compare_corners(p, property);
    case PLY_PART:
    case PLY_STIFFNESS:
    case PLY_IGNORED:
        break;
    }
    return property->is_list ? ply_data_skip(&p->data, property) : read_column(p, property);
}

static bool end_row(void *user) {
    (void)user;
    return true;
}

/* ---- the plan -------------------------------------------------------------------------------------- */

static bool check_mesh(const plan_reader *p) {
    uint32_t own[3];
    if (p->differing != UINT32_MAX) {
        cscd_mesh_triangle(p->mesh, p->differing, own);
        return file_reader_fail(p->data.reader,
                                "the plan is of another mesh: its triangle %" PRIu32
                                " has the vertices %" PRIu32 " %" PRIu32 " %" PRIu32 ", expected %" PRIu32
                                " %" PRIu32 " %" PRIu32 ", of the same model with the same --weld",
                                p->differing, p->corners[0], p->corners[1], p->corners[2], own[0], own[1],
                                own[2]);
    }
    if (p->mesh_hash == cscd_mesh_hash(p->mesh)) return true;
    return file_reader_fail(p->data.reader,
                            "the header gives the mesh's hash as %016" PRIx64
                            ", but the triangles have %016" PRIx64
                            ": the file was changed, expected it as cscd wrote it",
                            p->mesh_hash, cscd_mesh_hash(p->mesh));
}

static bool create_plan(const plan_reader *p, const cscd_context *context, cscd_plan **out) {
    cscd_plan_parts parts = {.method = p->method,
                             .region_count = p->region_count,
                             .triangle_regions = p->regions,
                             .detector_points = p->points,
                             .charges = p->charges,
                             .capacitances = p->capacitances,
                             .origin = p->origin[0] != '\0' ? p->origin : NULL};
    if (cscd_plan_create_from_parts(cscd_mesh_context(p->mesh), p->mesh,
                                    CSCD_DOUBLES(p->positions, cscd_mesh_vertex_count(p->mesh)), &parts,
                                    out) == CSCD_OK)
        return true;
    return file_reader_fail(p->data.reader, "%s", cscd_context_detail(context));
}

static bool read_plan(plan_reader *p, file_reader *reader, const cscd_context *context, cscd_plan **out) {
    file_reader start = *reader;
    const ply_visitor visitor = {visit_property, end_row, p};
    return ply_data_open(&p->data, reader) && read_comments(p, start) && check_columns(p) &&
           check_counts(p) && allocate_lists(p) && ply_data_read(&p->data, &visitor) && check_mesh(p) &&
           create_plan(p, context, out);
}

bool plan_file_read(const char *path, const cscd_context *context, const cscd_mesh *mesh, cscd_plan **out,
                    io_error *error) {
    file_reader reader;
    if (!file_reader_open(&reader, path, error)) return false;
    plan_reader p = {.mesh = mesh, .differing = UINT32_MAX};
    reader.at = text_mark_size(reader.bytes, reader.size);
    bool done = read_plan(&p, &reader, context, out);
    ply_data_close(&p.data);
    file_reader_close(&reader);
    void *blocks[] = {p.positions, p.points, p.charges, p.capacitances, p.regions};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) free(blocks[i]);
    return done;
}

bool plan_file_is_plan(const char *path) {
    file_reader reader;
    if (!file_reader_open(&reader, path, NULL)) return false;
    bool found = false;
    reader.at = text_mark_size(reader.bytes, reader.size);
    if (ply_reader.recognise(&reader)) {
        ply_data data;
        bool opened = ply_data_open(&data, &reader);
        file_reader probe = reader;
        probe.at = 0;
        while (opened && !found && probe.at < reader.at) {
            found = comment_of_line(&probe) == COMMENT_PLAN;
            text_skip_line(&probe);
        }
        ply_data_close(&data);
    }
    file_reader_close(&reader);
    return found;
}

/* ---- writing ------------------------------------------------------------------------------------------- */

/* The bytes of one vertex, face, region or component. */
typedef struct file_row {
    unsigned char bytes[96];
    size_t size;
} file_row;

static void put_bits(file_row *r, uint64_t bits, size_t size) {
    for (size_t i = 0; i < size; i++) r->bytes[r->size++] = (unsigned char)(bits >> (8 * i) & 0xff);
}

static void put_double(file_row *r, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_bits(r, bits, sizeof bits);
}

static void write_row(FILE *file, const file_row *r) {
    fwrite(r->bytes, 1, r->size, file);
}

static void write_header(FILE *file, const cscd_mesh *mesh, const cscd_plan *plan) {
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\n"
            "comment cscd plan 1\ncomment cscd version %s\ncomment cscd method %s\n"
            "comment cscd mesh %016" PRIx64 "\n",
            cscd_version_string(), cscd_method_name(cscd_plan_method(plan)), cscd_mesh_hash(mesh));
    const cscd_plan_info info = cscd_plan_describe(plan);
    if (info.origin != NULL) fprintf(file, "comment cscd made %s\n", info.origin);
    fprintf(file, "element vertex %" PRIu32 "\nproperty double x\nproperty double y\nproperty double z\n",
            cscd_mesh_vertex_count(mesh));
    fprintf(file,
            "element face %" PRIu32 "\nproperty list uchar uint vertex_indices\nproperty double charge\n"
            "property uint region\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n",
            cscd_mesh_triangle_count(mesh));
    fprintf(file,
            "element region %" PRIu32 "\nproperty double x\nproperty double y\nproperty double z\n"
            "property double visible_share\nproperty double area\nproperty uint triangle_count\n"
            "property uint component\n",
            cscd_plan_region_count(plan));
    fprintf(file, "element component %" PRIu32 "\nproperty double capacitance\nend_header\n",
            cscd_mesh_component_count(mesh));
}

static void write_vertices(FILE *file, const cscd_mesh *mesh, const double *positions) {
    for (uint32_t v = 0; v < cscd_mesh_vertex_count(mesh); v++) {
        file_row r = {.size = 0};
        for (size_t k = 0; k < 3; k++) put_double(&r, positions[(size_t)v * 3 + k]);
        write_row(file, &r);
    }
}

static void write_faces(FILE *file, const cscd_mesh *mesh, const cscd_plan *plan, const uint8_t *colours) {
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++) {
        file_row r = {.size = 0};
        uint32_t corners[3];
        cscd_mesh_triangle(mesh, t, corners);
        put_bits(&r, 3, 1);
        for (size_t i = 0; i < 3; i++) put_bits(&r, corners[i], 4);
        put_double(&r, cscd_plan_triangle_charge(plan, t));
        put_bits(&r, cscd_plan_triangle_region(plan, t), 4);
        for (size_t i = 0; i < 3; i++) put_bits(&r, colours[(size_t)t * 3 + i], 1);
        write_row(file, &r);
    }
}

static void write_regions(FILE *file, const cscd_plan *plan) {
    for (uint32_t i = 0; i < cscd_plan_region_count(plan); i++) {
        file_row r = {.size = 0};
        cscd_region region = cscd_plan_region(plan, i);
        for (size_t k = 0; k < 3; k++) put_double(&r, region.detector_point[k]);
        put_double(&r, region.visible_share);
        put_double(&r, region.area);
        put_bits(&r, region.triangle_count, 4);
        put_bits(&r, region.component, 4);
        write_row(file, &r);
    }
}

static void write_components(FILE *file, const cscd_mesh *mesh, const cscd_plan *plan) {
    for (uint32_t c = 0; c < cscd_mesh_component_count(mesh); c++) {
        file_row r = {.size = 0};
        put_double(&r, cscd_plan_capacitance(plan, c));
        write_row(file, &r);
    }
}

bool plan_file_write(const char *path, const cscd_mesh *mesh, const double *positions, const cscd_plan *plan,
                     const uint8_t *colours, io_error *error) {
    output_file out;
    if (!output_file_open(path, &out)) return io_fail_write(error, path);
    write_header(out.file, mesh, plan);
    write_vertices(out.file, mesh, positions);
    write_faces(out.file, mesh, plan, colours);
    write_regions(out.file, plan);
    write_components(out.file, mesh, plan);
    return output_file_close(&out, OUTPUT_WHOLE) || io_fail_write(error, path);
}
