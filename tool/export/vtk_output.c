/* Frames as .vtp files of ParaView, with the intersection curves as polylines. */
#include "cscd/cscd.h"
#include "tool/export/export_values.h"
#include "tool/io/io.h"
#include "tool/io/output_file.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- intersection curves as polylines of a .vtp file ----------------------------------------------------- */

typedef struct vtk_curves {
    uint64_t count, point_count, corner_count;
    double *points;
    int64_t *corners, *ends; /* a closed curve has its first point at its end, too */
    double *lengths;
    uint32_t *objects[2];
    uint8_t *closed, *touching;
} vtk_curves;

static void vtk_curves_free(vtk_curves *lines) {
    free(lines->points);
    free(lines->corners);
    free(lines->ends);
    free(lines->lengths);
    free(lines->objects[0]);
    free(lines->objects[1]);
    free(lines->closed);
    free(lines->touching);
    *lines = (vtk_curves){0};
}

static bool allocate_lines(vtk_curves *l) {
    const size_t count = l->count + 1; /* never 0 */
    l->points = malloc((l->point_count + 1) * 3 * sizeof *l->points);
    l->corners = malloc((l->corner_count + 1) * sizeof *l->corners);
    l->ends = malloc(count * sizeof *l->ends);
    l->lengths = malloc(count * sizeof *l->lengths);
    l->objects[0] = malloc(count * sizeof *l->objects[0]);
    l->objects[1] = malloc(count * sizeof *l->objects[1]);
    l->closed = malloc(count);
    l->touching = malloc(count);
    return l->points != NULL && l->corners != NULL && l->ends != NULL && l->lengths != NULL &&
           l->objects[0] != NULL && l->objects[1] != NULL && l->closed != NULL && l->touching != NULL;
}

/* Copies what a file needs. On false *out holds nothing to free. */
static bool vtk_curves_collect(const cscd_curves *curves, vtk_curves *out) {
    static const cscd_curves none = {.count = 0};
    if (curves == NULL) curves = &none; /* they did not fit the memory, which the run says */
    vtk_curves l = {
        .count = curves->count, .point_count = curves->point_count, .corner_count = curves->point_count};
    for (size_t i = 0; i < curves->count; i++) l.corner_count += curves->items[i].closed;
    if (!allocate_lines(&l)) {
        vtk_curves_free(&l);
        return false;
    }
    for (size_t i = 0; i < curves->point_count; i++)
        memcpy(l.points + 3 * i, curves->points[i].x, 3 * sizeof *l.points);
    int64_t end = 0;
    for (size_t i = 0; i < curves->count; i++) {
        const cscd_curve *curve = &curves->items[i];
        for (size_t k = 0; k < curve->point_count; k++) l.corners[end++] = (int64_t)(curve->first_point + k);
        if (curve->closed) l.corners[end++] = (int64_t)curve->first_point;
        l.ends[i] = end;
        l.lengths[i] = curve->length;
        for (int k = 0; k < 2; k++) l.objects[k][i] = curve->objects[k];
        l.closed[i] = curve->closed;
        l.touching[i] = curve->touching;
    }
    l.corner_count = (uint64_t)end;
    *out = l;
    return true;
}

/* Adds points, lines, and their arrays: length, closed, touching, object_a and object_b. */
static void vtk_curves_add(const vtk_curves *l, vtp_file *file) {
    vtp_add(file, VTP_CELL_DATA, "length", VTP_FLOAT64, l->count, 1, l->lengths);
    vtp_add(file, VTP_CELL_DATA, "closed", VTP_UINT8, l->count, 1, l->closed);
    vtp_add(file, VTP_CELL_DATA, "touching", VTP_UINT8, l->count, 1, l->touching);
    vtp_add(file, VTP_CELL_DATA, "object_a", VTP_UINT32, l->count, 1, l->objects[0]);
    vtp_add(file, VTP_CELL_DATA, "object_b", VTP_UINT32, l->count, 1, l->objects[1]);
    vtp_add(file, VTP_POINTS, "Points", VTP_FLOAT64, l->point_count, 3, l->points);
    vtp_add(file, VTP_LINES, "connectivity", VTP_INT64, l->corner_count, 1, l->corners);
    vtp_add(file, VTP_LINES, "offsets", VTP_INT64, l->count, 1, l->ends);
}

static bool no_memory(io_error *error) {
    return io_fail(error, "out of memory for the files of --vtk");
}

void vtk_output_free(vtk_output *v) {
    free(v->stem);
    free(v->corners);
    free(v->ends);
    growable_free(&v->part_texts);
    growable_free(&v->object_texts);
    growable_free(&v->frames);
    *v = (vtk_output){0};
}

/* A text and its NUL. */
static bool append_text(growable *texts, const char *text) {
    const size_t size = strlen(text) + 1;
    if (!growable_reserve(texts, texts->count + size)) return false;
    memcpy((char *)texts->data + texts->count, text, size);
    texts->count += size;
    return true;
}

static bool collect_names(vtk_output *v, const part_names *parts) {
    v->part_count = parts->count;
    for (uint32_t i = 0; i < parts->count; i++)
        if (!append_text(&v->part_texts, parts->names[i])) return false;
    for (uint32_t i = 0; i < v->recording->object_count; i++)
        if (!append_text(&v->object_texts, v->recording->objects[i].source.name)) return false;
    return true;
}

static bool collect_triangles(vtk_output *v) {
    const size_t count = v->values->triangles.count;
    const uint32_t *corners = cscd_mesh_array(v->recording->mesh, CSCD_TRIANGLE_VERTICES);
    v->corners = malloc((3 * count + 1) * sizeof *v->corners);
    v->ends = malloc((count + 1) * sizeof *v->ends);
    if (v->corners == NULL || v->ends == NULL) return false;
    for (size_t i = 0; i < 3 * count; i++) v->corners[i] = corners[i];
    for (size_t i = 0; i < count; i++) v->ends[i] = 3 * ((int64_t)i + 1);
    return true;
}

bool vtk_output_open(const char *path, vtk_choice choice, const recording *r, const part_names *parts,
                     const export_values *values, vtk_output *out, io_error *error) {
    vtk_output v = {.choice = choice,
                    .recording = r,
                    .values = values,
                    .part_texts = growable_of(1),
                    .object_texts = growable_of(1),
                    .frames = growable_of(sizeof(int32_t))};
    v.stem = export_names_stem(path, ".pvd");
    if (v.stem == NULL || !collect_names(&v, parts) || !collect_triangles(&v)) {
        vtk_output_free(&v);
        return no_memory(error);
    }
    *out = v;
    return true;
}

static double time_of(const vtk_output *v, int32_t number) {
    return v->choice.fps > 0.0 ? number / v->choice.fps : number;
}

static void add_table(vtp_file *file, vtp_section section, const export_table *table) {
    static const vtp_type types[] = {VTP_UINT8, VTP_INT32, VTP_UINT32, VTP_FLOAT64};
    for (size_t i = 0; i < table->array_count; i++) {
        const export_array *a = &table->arrays[i];
        vtp_add(file, section, a->name, types[a->type], table->count, 1, a->values);
    }
}

/* The number and the time, which ParaView reads from TimeValue, and the names that part and object number. */
static void add_field(const vtk_output *v, vtp_file *file, const int32_t *number, const double *time) {
    vtp_add(file, VTP_FIELD, "frame", VTP_INT32, 1, 1, number);
    vtp_add(file, VTP_FIELD, "TimeValue", VTP_FLOAT64, 1, 1, time);
    vtp_add_texts(file, "part_names", v->part_count, v->part_texts.data, v->part_texts.count);
    vtp_add_texts(file, "object_names", v->recording->object_count, v->object_texts.data,
                  v->object_texts.count);
}

static bool write_numbered(const vtk_output *v, const vtp_file *file, const char *kind, int32_t number,
                           io_error *error) {
    char *stem = export_names_join(v->stem, kind);
    char *path = stem != NULL ? export_names_frame(stem, number, ".vtp") : NULL;
    const bool written = path != NULL ? vtp_write(file, path, error) : no_memory(error);
    free(path);
    free(stem);
    return written;
}

static bool write_surface(const vtk_output *v, int32_t number, const double *positions, io_error *error) {
    const double time = time_of(v, number);
    const uint64_t points = v->values->vertices.count, count = v->values->triangles.count;
    vtp_file file = {.point_count = points, .poly_count = count};
    add_field(v, &file, &number, &time);
    add_table(&file, VTP_POINT_DATA, &v->values->vertices);
    add_table(&file, VTP_CELL_DATA, &v->values->triangles);
    vtp_add(&file, VTP_POINTS, "Points", VTP_FLOAT64, points, 3, positions);
    vtp_add(&file, VTP_POLYS, "connectivity", VTP_INT64, 3 * count, 1, v->corners);
    vtp_add(&file, VTP_POLYS, "offsets", VTP_INT64, count, 1, v->ends);
    return write_numbered(v, &file, "", number, error);
}

static bool write_curves(const vtk_output *v, int32_t number, const cscd_curves *curves, io_error *error) {
    const double time = time_of(v, number);
    vtk_curves lines;
    if (!vtk_curves_collect(curves, &lines)) return no_memory(error);
    vtp_file file = {.point_count = lines.point_count, .line_count = lines.count};
    add_field(v, &file, &number, &time);
    vtk_curves_add(&lines, &file);
    const bool written = write_numbered(v, &file, "_curves", number, error);
    vtk_curves_free(&lines);
    return written;
}

bool vtk_output_add_frame(vtk_output *v, int32_t number, const double *positions, const cscd_curves *curves,
                          io_error *error) {
    if (!write_surface(v, number, positions, error) ||
        (v->choice.curves && !write_curves(v, number, curves, error)))
        return false;
    int32_t *written = growable_push(&v->frames);
    if (written == NULL) return no_memory(error);
    *written = number;
    return true;
}

static void write_escaped(FILE *out, const char *text) {
    for (; *text != '\0'; text++) {
        if (strchr("&<>\"'", *text) != NULL)
            fprintf(out, "&#%d;", *text);
        else
            fputc(*text, out);
    }
}

/* Names of files stand without their folder, so that all may be moved together. */
static void write_collection(FILE *out, const vtk_output *v, const char *stem) {
    fprintf(out, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n");
    for (size_t i = 0; i < v->frames.count; i++) {
        const int32_t number = ((const int32_t *)v->frames.data)[i];
        fprintf(out, "<DataSet timestep=\"%.17g\" group=\"\" part=\"0\" file=\"", time_of(v, number));
        write_escaped(out, path_file_name(stem));
        fprintf(out, "_%04" PRId32 ".vtp\"/>\n", number);
    }
    fprintf(out, "</Collection>\n</VTKFile>\n");
}

static bool finish_kind(const vtk_output *v, const char *kind, io_error *error) {
    char *stem = export_names_join(v->stem, kind);
    char *path = stem != NULL ? export_names_join(stem, ".pvd") : NULL;
    output_file out;
    bool written = path != NULL || no_memory(error);
    if (written && !output_file_open(path, &out)) written = io_fail_write(error, path);
    if (written) {
        write_collection(out.file, v, stem);
        written = output_file_close(&out, OUTPUT_WHOLE) || io_fail_write(error, path);
    }
    free(path);
    free(stem);
    return written;
}

bool vtk_output_finish(vtk_output *v, io_error *error) {
    return finish_kind(v, "", error) && (!v->choice.curves || finish_kind(v, "_curves", error));
}

/* ---- one .vtp file: polygons or lines with arrays, as VTK's XML format for ParaView has them ------------- */

static const char *const type_names[] = {"UInt8", "Int32", "UInt32", "Int64", "Float64", "String"};
static const uint64_t type_sizes[] = {1, 4, 4, 8, 8, 1};
static const char *const section_names[] = {"FieldData", "PointData", "CellData", "Points", "Lines", "Polys"};

static const char *byte_order(void) {
    const uint16_t one = 1;
    return *(const unsigned char *)&one == 1 ? "LittleEndian" : "BigEndian";
}

void vtp_add(vtp_file *file, vtp_section section, const char *name, vtp_type type, uint64_t tuples,
             uint64_t components, const void *data) {
    assert(file->array_count < VTP_ARRAYS_MAX);
    file->arrays[file->array_count++] =
        (vtp_array){section, type, name, tuples, components, data, tuples * components * type_sizes[type]};
}

void vtp_add_texts(vtp_file *file, const char *name, uint64_t count, const char *texts, size_t size) {
    vtp_add(file, VTP_FIELD, name, VTP_STRING, count, 1, texts);
    file->arrays[file->array_count - 1].size = size;
}

/* The arrays of a section, whose data stand behind the XML in the order of the arrays. */
static void write_section(FILE *out, const vtp_file *file, vtp_section section) {
    uint64_t offset = 0;
    fprintf(out, "<%s>\n", section_names[section]);
    for (size_t i = 0; i < file->array_count; i++) {
        const vtp_array *a = &file->arrays[i];
        if (a->section == section) {
            fprintf(out, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%" PRIu64 "\"",
                    type_names[a->type], a->name, a->components);
            if (section == VTP_FIELD) fprintf(out, " NumberOfTuples=\"%" PRIu64 "\"", a->tuples);
            fprintf(out, " format=\"appended\" offset=\"%" PRIu64 "\"/>\n", offset);
        }
        offset += sizeof a->size + a->size;
    }
    fprintf(out, "</%s>\n", section_names[section]);
}

static void write_file(FILE *out, const vtp_file *file) {
    fprintf(out,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%s\" "
            "header_type=\"UInt64\">\n<PolyData>\n",
            byte_order());
    write_section(out, file, VTP_FIELD);
    fprintf(out,
            "<Piece NumberOfPoints=\"%" PRIu64 "\" NumberOfVerts=\"0\" NumberOfLines=\"%" PRIu64
            "\" NumberOfStrips=\"0\" NumberOfPolys=\"%" PRIu64 "\">\n",
            file->point_count, file->line_count, file->poly_count);
    for (vtp_section section = VTP_POINT_DATA; section < VTP_SECTIONS; section++) {
        const bool empty = (section == VTP_LINES && file->line_count == 0) ||
                           (section == VTP_POLYS && file->poly_count == 0);
        if (!empty) write_section(out, file, section);
    }
    fprintf(out, "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
    for (size_t i = 0; i < file->array_count; i++) {
        fwrite(&file->arrays[i].size, sizeof file->arrays[i].size, 1, out);
        if (file->arrays[i].size > 0) fwrite(file->arrays[i].data, 1, file->arrays[i].size, out);
    }
    fprintf(out, "\n</AppendedData>\n</VTKFile>\n");
}

bool vtp_write(const vtp_file *file, const char *path, io_error *error) {
    output_file out;
    if (!output_file_open(path, &out)) return io_fail_write(error, path);
    write_file(out.file, file);
    return output_file_close(&out, OUTPUT_WHOLE) || io_fail_write(error, path);
}
