/* One .vtp file: polygons or lines with arrays, as VTK's XML format for ParaView has them. */
#include "tool/export/vtp_file.h"

#include "tool/io/output_file.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>

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
