/* Files for ParaView and PLY files hold what the library says of each frame. */
#include "tests/support/test.h"
#include "tests/support/tool/export_scene.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/vtp_reader.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static temp_path out_path;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    out_path = temp_file_path(&folder, "out");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

enum { WALL = 0, BAR = 1 };

static temp_path path_of(const char *stem, uint32_t frame, const char *ending) {
    char name[64];
    snprintf(name, sizeof name, "%s_%04d%s", stem, FIRST_FRAME + (int)frame, ending);
    return temp_file_path(&folder, name);
}

/* ---- .vtp ------------------------------------------------------------------------------------------------ */

static void expect_bytes(const vtp_reader *file, const char *section, const char *name, const char *type,
                         const void *expected, size_t expected_size) {
    size_t size;
    void *data = vtp_reader_array(file, section, name, type, &size);
    assert_int_equal(size, expected_size);
    if (memcmp(data, expected, size) != 0) fail_msg("%s %s differs", section, name);
    free(data);
}

/* The number of pairs of a kind that a triangle is in, UINT32_MAX for all kinds. */
static uint32_t pairs_of(const cscd_intersection_pairs *found, uint32_t triangle, uint32_t kind) {
    uint32_t count = 0;
    for (size_t i = 0; i < found->count; i++) {
        const cscd_intersection_pair *pair = &found->items[i];
        const bool fits = kind == UINT32_MAX || pair->kind == kind;
        count += fits && (pair->a == triangle || pair->b == triangle);
    }
    return count;
}

static void expect_kinds(const export_scene *s, const vtp_reader *file) {
    static const char *const names[] = {"crossing", "coplanar", "folded", "duplicate", "touching"};
    const uint32_t count = cscd_mesh_triangle_count(s->recording.mesh);
    uint32_t counts[64];
    uint8_t any[64];
    assert_true(count <= 64);
    for (uint32_t kind = 0; kind < 5; kind++) {
        for (uint32_t t = 0; t < count; t++) counts[t] = pairs_of(&s->found, t, kind);
        expect_bytes(file, "CellData", names[kind], "UInt32", counts, count * sizeof *counts);
    }
    for (uint32_t t = 0; t < count; t++)
        any[t] = pairs_of(&s->found, t, CSCD_INTERSECTION_CROSSING) > 0
                     ? 2
                     : pairs_of(&s->found, t, UINT32_MAX) > 0;
    expect_bytes(file, "CellData", "intersecting", "UInt8", any, count);
}

/* What the scene was built for: the triangles of wall, seed and bar are 12 each, and vertices 8 each. */
static void expect_scene(const vtp_reader *file, uint32_t frame) {
    static const double reach[FRAMES] = {0.5, 0.0, 0.25};
    size_t size;
    uint8_t *buried = vtp_reader_array(file, "CellData", "buried", "UInt8", &size);
    double *depth = vtp_reader_array(file, "PointData", "depth", "Float64", &size);
    int32_t *part = vtp_reader_array(file, "CellData", "part", "Int32", &size);
    uint32_t *object = vtp_reader_array(file, "CellData", "object", "UInt32", &size);
    uint32_t *polygon = vtp_reader_array(file, "CellData", "polygon", "UInt32", &size);
    uint32_t *triangle = vtp_reader_array(file, "CellData", "triangle", "UInt32", &size);
    const bool out = frame == FRAME_APART;
    for (uint32_t t = 0; t < 36; t++) {
        const uint32_t side = t % 12 / 2;
        const bool wall_side = t < 12 && side == 3, rod_side = t >= 24 && side != 2 && side != 3;
        const uint8_t expected =
            !out && (wall_side || rod_side) ? 2 : (t >= 12 && t < 24) || (!out && t >= 24 && side == 2);
        assert_int_equal(buried[t], expected);
        assert_int_equal(object[t], t < 24 ? WALL : BAR);
        assert_int_equal(part[t], t < 12 ? 0 : t < 24 ? 1 : 3);
        assert_int_equal(triangle[t], t < 24 ? t : t - 24);
        assert_int_equal(polygon[t], triangle[t] / 2);
    }
    for (uint32_t v = 0; v < 24; v++) {
        const bool end = v >= 16 && (v & 1) == 0;
        const double expected = v < 8 ? 0.0 : v < 16 ? 0.9 : end ? reach[frame] : 0.0;
        assert_true(fabs(depth[v] - expected) < 1e-12);
    }
    free(buried);
    free(depth);
    free(part);
    free(object);
    free(polygon);
    free(triangle);
}

static void expect_contacts(const export_scene *s, const vtp_reader *file) {
    uint32_t counts[24] = {0};
    for (size_t i = 0; i < s->contact_count; i++)
        for (int k = 0; k < 4; k++) counts[s->contacts[i].vertices[k]]++;
    expect_bytes(file, "PointData", "contacts", "UInt32", counts, sizeof counts);
}

static void expect_plan(const export_scene *s, const vtp_reader *file) {
    uint32_t regions[36];
    double charges[36];
    for (uint32_t t = 0; t < 36; t++) {
        regions[t] = cscd_plan_triangle_region(s->plan, t);
        charges[t] = cscd_plan_triangle_charge(s->plan, t);
    }
    assert_true(charges[0] != 0.0);
    expect_bytes(file, "CellData", "region", "UInt32", regions, sizeof regions);
    expect_bytes(file, "CellData", "charge", "Float64", charges, sizeof charges);
}

static void expect_surface(const export_scene *s, uint32_t frame) {
    const temp_path path = path_of("out", frame, ".vtp");
    vtp_reader file = vtp_reader_open(path.text);
    const int32_t number = FIRST_FRAME + (int32_t)frame;
    int64_t corners[108], ends[36];
    for (size_t i = 0; i < 108; i++) corners[i] = cscd_mesh_all_triangles(s->recording.mesh)[i];
    for (size_t i = 0; i < 36; i++) ends[i] = 3 * ((int64_t)i + 1);
    assert_int_equal(vtp_reader_count(&file, "NumberOfPoints"), 24);
    assert_int_equal(vtp_reader_count(&file, "NumberOfPolys"), 36);
    expect_bytes(&file, "Points", "Points", "Float64", s->x1, 72 * sizeof(double));
    expect_bytes(&file, "Polys", "connectivity", "Int64", corners, sizeof corners);
    expect_bytes(&file, "Polys", "offsets", "Int64", ends, sizeof ends);
    expect_bytes(&file, "FieldData", "frame", "Int32", &number, sizeof number);
    expect_bytes(&file, "FieldData", "TimeValue", "Float64", &(double){number / 25.0}, sizeof(double));
    expect_bytes(&file, "FieldData", "part_names", "String", "wall/Box\0wall/Seed\0wall\0bar/Rod\0bar", 36);
    expect_bytes(&file, "FieldData", "object_names", "String", "wall\0bar", 9);
    expect_kinds(s, &file);
    expect_scene(&file, frame);
    expect_contacts(s, &file);
    expect_plan(s, &file);
    vtp_reader_close(&file);
}

static void expect_curves(const export_scene *s, uint32_t frame) {
    const cscd_curves *curves = s->found.curves;
    const temp_path path = path_of("out_curves", frame, ".vtp");
    vtp_reader file = vtp_reader_open(path.text);
    assert_int_equal(curves->count, frame != FRAME_APART ? 1 : 0);
    assert_int_equal(vtp_reader_count(&file, "NumberOfPoints"), curves->point_count);
    assert_int_equal(vtp_reader_count(&file, "NumberOfLines"), curves->count);
    if (curves->count == 0) {
        vtp_reader_close(&file);
        return;
    }
    size_t size;
    double *points = vtp_reader_array(&file, "Points", "Points", "Float64", &size);
    assert_int_equal(size, curves->point_count * 3 * sizeof *points);
    for (size_t i = 0; i < curves->point_count; i++)
        assert_memory_equal(points + 3 * i, curves->points[i].x, 3 * sizeof *points);
    int64_t *corners = vtp_reader_array(&file, "Lines", "connectivity", "Int64", &size);
    assert_int_equal(size, (curves->point_count + 1) * sizeof *corners);
    for (size_t i = 0; i <= curves->point_count; i++) assert_int_equal(corners[i], i % curves->point_count);
    const int64_t end = (int64_t)curves->point_count + 1;
    expect_bytes(&file, "Lines", "offsets", "Int64", &end, sizeof end);
    expect_bytes(&file, "CellData", "length", "Float64", &curves->items[0].length, sizeof(double));
    expect_bytes(&file, "CellData", "closed", "UInt8", "\1", 1);
    expect_bytes(&file, "CellData", "touching", "UInt8", "\0", 1);
    expect_bytes(&file, "CellData", "object_a", "UInt32", curves->items[0].objects, sizeof(uint32_t));
    expect_bytes(&file, "CellData", "object_b", "UInt32", curves->items[0].objects + 1, sizeof(uint32_t));
    assert_true(fabs(curves->items[0].length - 1.3) < 1e-12);
    free(points);
    free(corners);
    vtp_reader_close(&file);
}

static void expect_collection(const char *name, const char *text) {
    const temp_path path = temp_file_path(&folder, name);
    char *found = read_whole_file(path.text, NULL);
    assert_string_equal(found, text);
    free(found);
}

static void vtk_files_hold_what_the_library_says(void **state) {
    (void)state;
    export_scene s;
    export_scene_open(&s, &folder, true);
    s.recording.fps = 25.0;
    export_scene_start(&s, &(export_request){.vtk_path = out_path.text, .contacts = true});
    uint32_t intervals = 0;
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        export_scene_add_frame(&s, frame);
        expect_surface(&s, frame);
        expect_curves(&s, frame);
        intervals += s.contact_count > 0;
    }
    assert_int_equal(intervals, FRAMES - 1);
    export_scene_close(&s);
    expect_collection("out.pvd", "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
                                 "<Collection>\n"
                                 "<DataSet timestep=\"0.28000000000000003\" group=\"\" part=\"0\" "
                                 "file=\"out_0007.vtp\"/>\n"
                                 "<DataSet timestep=\"0.32000000000000001\" group=\"\" part=\"0\" "
                                 "file=\"out_0008.vtp\"/>\n"
                                 "<DataSet timestep=\"0.35999999999999999\" group=\"\" part=\"0\" "
                                 "file=\"out_0009.vtp\"/>\n"
                                 "</Collection>\n</VTKFile>\n");
}

/* Of a run that ends early, the .pvd names what is there; times are frame numbers, and names may have any characters. */
static void a_pvd_names_the_frames_that_exist(void **state) {
    (void)state;
    export_scene s;
    temp_path path = temp_file_path(&folder, "a&b.pvd");
    export_scene_open(&s, &folder, false);
    export_scene_start(&s, &(export_request){.vtk_path = path.text});
    export_scene_add_frame(&s, 0);
    export_scene_close(&s);
    static const char text[] = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
                               "<Collection>\n<DataSet timestep=\"7\" group=\"\" part=\"0\" "
                               "file=\"a&#38;b%s_0007.vtp\"/>\n</Collection>\n</VTKFile>\n";
    char expected[512];
    snprintf(expected, sizeof expected, text, "");
    expect_collection("a&b.pvd", expected);
    snprintf(expected, sizeof expected, text, "_curves");
    expect_collection("a&b_curves.pvd", expected);
    path = temp_file_path(&folder, "a&b_0007.vtp");
    vtp_reader file = vtp_reader_open(path.text);
    assert_false(vtp_reader_has(&file, "CellData", "region"));
    assert_false(vtp_reader_has(&file, "CellData", "charge"));
    assert_false(vtp_reader_has(&file, "PointData", "contacts"));
    vtp_reader_close(&file);
}

/* ---- PLY ------------------------------------------------------------------------------------------------- */

/* The properties of one element in the order of the header; those of faces behind the three corners. */
typedef struct property_list {
    struct {
        char type[16], name[32];
        size_t size, offset;
    } items[24];
    size_t count, row_size;
} property_list;

/* Reads the lines behind that of the element up to the next; returns where that is. */
static const char *read_properties(const char *text, const char *element, property_list *list) {
    const char *line = strstr(text, element);
    assert_non_null(line);
    for (line = strchr(line, '\n') + 1; strncmp(line, "property ", 9) == 0; line = strchr(line, '\n') + 1) {
        if (strncmp(line, "property list uchar uint vertex_indices\n", 40) == 0) {
            list->row_size += 13;
            continue;
        }
        char *type = list->items[list->count].type;
        assert_int_equal(sscanf(line, "property %15s %31s\n", type, list->items[list->count].name), 2);
        const size_t size = strcmp(type, "double") == 0 ? 8 : strcmp(type, "uchar") == 0 ? 1 : 4;
        list->items[list->count].size = size;
        list->items[list->count++].offset = list->row_size;
        list->row_size += size;
    }
    return line;
}

/* Each property has the bytes of the array of the same name in the .vtp file, and each such array is a property. */
static void expect_properties(const vtp_reader *file, const char *section, const property_list *list,
                              const char *rows, size_t count, size_t array_count) {
    size_t compared = 0, size;
    for (size_t i = 0; i < list->count; i++) {
        const char *type = list->items[i].type, *name = list->items[i].name;
        if (strlen(name) == 1) continue; /* coordinates */
        char *data = vtp_reader_array(file, section, name,
                                      strcmp(type, "double") == 0  ? "Float64"
                                      : strcmp(type, "uchar") == 0 ? "UInt8"
                                      : strcmp(type, "int") == 0   ? "Int32"
                                                                   : "UInt32",
                                      &size);
        assert_int_equal(size, count * list->items[i].size);
        for (size_t row = 0; row < count; row++)
            assert_memory_equal(rows + row * list->row_size + list->items[i].offset,
                                data + row * list->items[i].size, list->items[i].size);
        free(data);
        compared++;
    }
    assert_int_equal(compared, array_count);
}

static void expect_ply(const export_scene *s, uint32_t frame) {
    const temp_path path = path_of("out", frame, ".ply"), vtp_path = path_of("out", frame, ".vtp");
    vtp_reader file = vtp_reader_open(vtp_path.text);
    property_list vertices = {.count = 0}, faces = {.count = 0};
    size_t size;
    char *text = read_whole_file(path.text, &size), line[64];
    snprintf(line, sizeof line, "\ncomment frame %d\n", FIRST_FRAME + (int)frame);
    assert_non_null(strstr(text, line));
    assert_non_null(strstr(text, "\ncomment part 1 wall/Seed\n"));
    assert_non_null(strstr(text, "\ncomment object 1 bar\n"));
    const char *end = read_properties(text, "\nelement vertex 24\n" + 1, &vertices);
    end = read_properties(end, "element face 36\n", &faces);
    assert_int_equal(strncmp(end, "end_header\n", 11), 0);
    const char *rows = end + 11;
    assert_int_equal((size_t)(rows - text) + 24 * vertices.row_size + 36 * faces.row_size, size);
    expect_properties(&file, "PointData", &vertices, rows, 24, 3);
    expect_properties(&file, "CellData", &faces, rows + 24 * vertices.row_size, 36, 13);
    free(text);
    vtp_reader_close(&file);
    mesh_file mesh = {0};
    io_error error;
    if (!mesh_file_read(path.text, &mesh, &error)) fail_msg("%s", error.text);
    assert_int_equal(mesh.vertex_count, 24);
    assert_int_equal(mesh.triangle_count, 36);
    assert_memory_equal(mesh.positions, s->x1, 72 * sizeof(double));
    assert_memory_equal(mesh.triangles, cscd_mesh_all_triangles(s->recording.mesh), 108 * sizeof(uint32_t));
    assert_int_equal(mesh.parts.count, 3);
    mesh_file_free(&mesh);
}

static void ply_files_hold_the_same(void **state) {
    (void)state;
    export_scene s;
    const temp_path ply = temp_file_path(&folder, "out.ply");
    export_scene_open(&s, &folder, true);
    export_scene_start(&s,
                       &(export_request){.vtk_path = out_path.text, .ply_path = ply.text, .contacts = true});
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        export_scene_add_frame(&s, frame);
        expect_ply(&s, frame);
    }
    export_scene_close(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vtk_files_hold_what_the_library_says),
        cmocka_unit_test(a_pvd_names_the_frames_that_exist),
        cmocka_unit_test(ply_files_hold_the_same),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
