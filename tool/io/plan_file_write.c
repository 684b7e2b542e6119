/* Writes a plan as a binary PLY file. */
#include "tool/io/output_file.h"
#include "tool/io/plan_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

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
