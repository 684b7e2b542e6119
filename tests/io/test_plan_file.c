/* Plan files: what is written comes back bit for bit; other meshes and damaged files are refused. */
#include "tests/support/calls.h"
#include "tests/support/files.h"
#include "tests/support/io/recordings.h"
#include "tests/support/test.h"
#include "tool/io/io.h"
#include "tool/io/mesh_file.h"
#include "tool/io/ply.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXTS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* A mesh with its plan, and the file that holds it. */
typedef struct saved {
    recorded shape;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    temp_path path;
} saved;

static cscd_mesh *mesh_of(cscd_context *context, const recorded *shape) {
    cscd_mesh *mesh = NULL;
    cscd_object_desc desc =
        cscd_object_of_triangles(shape->vertex_count, shape->triangle_count, shape->triangles);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    return mesh;
}

static saved save_plan(recorded shape, cscd_method method) {
    saved s = {.shape = shape, .path = temp_file_path(&own_folder, "a.plan.ply")};
    assert_int_equal(cscd_context_create(NULL, &s.context), CSCD_OK);
    s.mesh = mesh_of(s.context, &shape);
    cscd_plan_options options = cscd_plan_defaults();
    options.method = method;
    assert_int_equal(plan_create_packed(s.mesh, shape.frames, &options, &s.plan), CSCD_OK);
    uint8_t *colours = calloc(shape.triangle_count, 3);
    io_error error = {""};
    for (uint32_t i = 0; i < shape.triangle_count * 3; i++) colours[i] = (uint8_t)(i * 7);
    if (!plan_file_write(s.path.text, s.mesh, shape.frames, s.plan, colours, &error))
        fail_msg("%s", error.text);
    free(colours);
    return s;
}

static void saved_free(saved *s) {
    cscd_plan_destroy(s->plan);
    cscd_mesh_destroy(s->mesh);
    cscd_context_destroy(s->context);
    recorded_free(&s->shape);
}

static void assert_same_bits(double a, double b) {
    assert_memory_equal(&a, &b, sizeof a);
}

static void assert_same_plan(const cscd_mesh *mesh, const cscd_plan *a, const cscd_plan *b) {
    assert_int_equal(cscd_plan_method(a), cscd_plan_method(b));
    assert_int_equal(cscd_plan_region_count(a), cscd_plan_region_count(b));
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++) {
        assert_int_equal(cscd_plan_triangle_region(a, t), cscd_plan_triangle_region(b, t));
        assert_same_bits(cscd_plan_triangle_charge(a, t), cscd_plan_triangle_charge(b, t));
    }
    for (uint32_t i = 0; i < cscd_plan_region_count(a); i++) {
        cscd_region left = cscd_plan_region(a, i), right = cscd_plan_region(b, i);
        for (int k = 0; k < 3; k++) assert_same_bits(left.detector_point[k], right.detector_point[k]);
        assert_same_bits(left.area, right.area);
        assert_same_bits(left.visible_share, right.visible_share);
        assert_int_equal(left.component, right.component);
        assert_int_equal(left.triangle_count, right.triangle_count);
    }
    for (uint32_t c = 0; c < cscd_mesh_component_count(mesh); c++)
        assert_same_bits(cscd_plan_capacitance(a, c), cscd_plan_capacitance(b, c));
}

static cscd_plan *read_back(const saved *s) {
    cscd_plan *plan = NULL;
    io_error error = {""};
    if (!plan_file_read(s->path.text, s->context, s->mesh, &plan, &error)) fail_msg("%s", error.text);
    return plan;
}

TEST(comes_back_bit_for_bit) {
    static const cscd_method methods[] = {CSCD_METHOD_CHARGE, CSCD_METHOD_KMEANS, CSCD_METHOD_SINGLE};
    for (int shape = 0; shape < 3; shape++) {
        for (int i = 0; i < 3; i++) {
            saved s = save_plan(shape == 0   ? recorded_torus(24, 12)
                                : shape == 1 ? recorded_cube(false)
                                             : recorded_fold(16, 4, 1),
                                methods[i]);
            cscd_plan *plan = read_back(&s);
            assert_same_plan(s.mesh, s.plan, plan);
            assert_true(plan_file_is_plan(s.path.text));
            cscd_plan_destroy(plan);
            saved_free(&s);
        }
    }
}

TEST(reads_as_a_mesh) {
    saved s = save_plan(recorded_cube(true), CSCD_METHOD_CHARGE);
    mesh_file mesh = {0};
    io_error error = {""};
    if (!mesh_file_read(s.path.text, &mesh, &error)) fail_msg("%s", error.text);
    assert_int_equal(mesh.vertex_count, s.shape.vertex_count);
    assert_int_equal(mesh.triangle_count, s.shape.triangle_count);
    assert_memory_equal(mesh.positions, s.shape.frames, mesh.vertex_count * sizeof(double[3]));
    assert_memory_equal(mesh.triangles, s.shape.triangles, mesh.triangle_count * sizeof(uint32_t[3]));
    mesh_file_free(&mesh);
    saved_free(&s);
}

/* ---- refused --------------------------------------------------------------------------------------- */

static void expect_refused(const saved *s, const char *path, const char *const *texts) {
    cscd_plan *plan = NULL;
    io_error error = {""};
    if (plan_file_read(path, s->context, s->mesh, &plan, &error)) {
        cscd_plan_destroy(plan);
        fail_msg("accepted, expected '%s'", texts[0]);
    }
    assert_null(plan);
    assert_memory_equal(error.text, path, strlen(path));
    assert_null(strpbrk(error.text, "\r\n"));
    for (; *texts != NULL; texts++) {
        if (strstr(error.text, *texts) == NULL) fail_msg("no '%s' in '%s'", *texts, error.text);
    }
}

/* Reads a plan file for another mesh than its own. */
static void expect_other_mesh(saved *s, recorded other, const char *const *texts) {
    saved reader = {.shape = other, .context = s->context, .mesh = mesh_of(s->context, &other)};
    expect_refused(&reader, s->path.text, texts);
    cscd_mesh_destroy(reader.mesh);
    recorded_free(&reader.shape);
}

TEST(another_mesh_is_refused) {
    saved s = save_plan(recorded_cube(false), CSCD_METHOD_SINGLE);
    expect_other_mesh(
        &s, recorded_cube(true),
        TEXTS("another mesh: it has 12 vertices and 16 triangles, expected 28 and 16", "the same --weld"));
    recorded turned = recorded_cube(false);
    uint32_t first = turned.triangles[15];
    turned.triangles[15] = turned.triangles[16];
    turned.triangles[16] = first;
    char text[200];
    const uint32_t *v = turned.triangles + 15;
    snprintf(text, sizeof text, "triangle 5 has the vertices %u %u %u, expected %u %u %u", v[1], v[0], v[2],
             v[0], v[1], v[2]);
    expect_other_mesh(&s, turned, TEXTS("another mesh", text));
    saved_free(&s);
}

TEST(nothing_to_read_is_refused) {
    saved s = save_plan(recorded_cube(false), CSCD_METHOD_SINGLE);
    temp_path mesh = recorded_write_mesh(&own_folder, "mesh.ply", &s.shape, 0);
    expect_refused(&s, temp_file_path(&own_folder, "none.ply").text, TEXTS("No such file"));
    expect_refused(&s, own_folder.path, TEXTS("directory"));
    expect_refused(&s, mesh.text, TEXTS("lacks 'comment cscd plan'", "expected a plan"));
    assert_false(plan_file_is_plan(mesh.text));
    assert_false(plan_file_is_plan("/dev/null"));
    assert_false(plan_file_is_plan(temp_file_path(&own_folder, "none.ply").text));
    saved_free(&s);
}

/* Every prefix of the file is refused. The error names a line when it ends in the header, a byte or a number
 * when it ends behind it. */
TEST(every_truncation_is_refused) {
    saved s = save_plan(recorded_tetrahedra(1), CSCD_METHOD_CHARGE);
    size_t size, line = 1;
    char *bytes = temp_file_read(s.path.text, &size), *end = strstr(bytes, "end_header");
    for (size_t cut = 0; cut < size; line += bytes[cut++] == '\n') {
        char place[40];
        temp_path path = temp_file_write(&own_folder, "cut.ply", bytes, cut);
        snprintf(place, sizeof place, "cut.ply:%zu: ", line);
        expect_refused(&s, path.text,
                       bytes + cut < end + 10 ? TEXTS(place) : TEXTS(": byte ", "file ends inside"));
    }
    free(bytes);
    saved_free(&s);
}

/* A file with one flipped bit is either refused or gives a plan whose numbers are all in range. */
TEST(every_flipped_bit_is_survived) {
    saved s = save_plan(recorded_tetrahedra(1), CSCD_METHOD_CHARGE);
    size_t size;
    char *bytes = temp_file_read(s.path.text, &size);
    for (size_t i = 0; i < size * 8; i++) {
        bytes[i / 8] = (char)(bytes[i / 8] ^ 1 << i % 8);
        temp_path path = temp_file_write(&own_folder, "bit.ply", bytes, size);
        bytes[i / 8] = (char)(bytes[i / 8] ^ 1 << i % 8);
        cscd_plan *plan = NULL;
        io_error error = {""};
        if (!plan_file_read(path.text, s.context, s.mesh, &plan, &error)) {
            assert_true(strstr(error.text, "bit.ply") != NULL && strpbrk(error.text, "\r\n") == NULL);
        } else {
            for (uint32_t t = 0; t < s.shape.triangle_count; t++)
                assert_true(cscd_plan_triangle_region(plan, t) < cscd_plan_region_count(plan));
        }
        cscd_plan_destroy(plan);
    }
    free(bytes);
    saved_free(&s);
}

/* ---- text ------------------------------------------------------------------------------------------ */

#define HEAD      "ply\nformat ascii 1.0\n"
#define COMMENTS  "comment cscd plan 1\ncomment cscd method charge\ncomment cscd mesh %s\n"
#define VERTEX    "element vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
#define FACE      "element face 4\nproperty list uchar uint vertex_indices\n"
#define CHARGE    "property double charge\n"
#define REGION    "property uint region\n"
#define REGIONS   "element region 1\nproperty double x\nproperty double y\nproperty double z\n"
#define COMPONENT "element component 1\nproperty double capacitance\n"
#define END       "end_header\n"
#define HEADER    HEAD COMMENTS VERTEX FACE CHARGE REGION REGIONS COMPONENT END /* 20 lines */
#define VERTICES  "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
#define FACES     "3 0 2 1 .5 0\n3 0 1 3 .25 0\n3 0 3 2 1 0\n3 1 2 3 2 0\n"
#define REST      ".25 .25 .25\n1.5\n"

/* Writes the text to a file, with the mesh's hash in place of its %s. */
static temp_path write_text(const saved *s, const char *text) {
    char bytes[2000], hash[17];
    const char *mark = strstr(text, "%s");
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)cscd_mesh_hash(s->mesh));
    if (mark == NULL) mark = text + strlen(text);
    int size = snprintf(bytes, sizeof bytes, "%.*s%s%s", (int)(mark - text), text, *mark != '\0' ? hash : "",
                        *mark != '\0' ? mark + 2 : "");
    return temp_file_write(&own_folder, "text.ply", bytes, (size_t)size);
}

static saved tetrahedron_mesh(void) {
    static const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    saved s = {.shape = {.vertex_count = 4, .triangle_count = 4}};
    s.shape.triangles = malloc(sizeof triangles);
    memcpy(s.shape.triangles, triangles, sizeof triangles);
    assert_int_equal(cscd_context_create(NULL, &s.context), CSCD_OK);
    s.mesh = mesh_of(s.context, &s.shape);
    return s;
}

TEST(text_is_read_too) {
    saved s = tetrahedron_mesh();
    s.path = write_text(&s, HEADER VERTICES FACES REST);
    cscd_plan *plan = read_back(&s);
    assert_int_equal(cscd_plan_region_count(plan), 1);
    assert_true(cscd_plan_triangle_charge(plan, 1) == 0.25 && cscd_plan_capacitance(plan, 0) == 1.5);
    assert_true(cscd_plan_region(plan, 0).detector_point[2] == 0.25);
    cscd_plan_destroy(plan);
    saved_free(&s);
}

static void expect_all_refused(const char *const (*cases)[3], size_t count) {
    saved s = tetrahedron_mesh();
    for (size_t i = 0; i < count; i++) {
        temp_path path = write_text(&s, cases[i][0]);
        expect_refused(&s, path.text, TEXTS(cases[i][1], cases[i][2]));
    }
    saved_free(&s);
}

TEST(bad_headers_are_refused) {
    static const char *const cases[][3] = {
        {HEAD "comment cscd plan 2\n" VERTEX FACE REGION REGIONS END, ":3: found '2'", "expected 1"},
        {HEAD "comment cscd plan\n" VERTEX FACE REGION REGIONS END, ":3: found ''", "expected 1"},
        {HEAD "comment cscd plan 1\ncomment cscd method none\n" VERTEX FACE END, ":4: found 'none'",
         "charge, kmeans, single or published"},
        {HEAD "comment cscd plan 1\ncomment cscd mesh 12g\n" VERTEX FACE END, ":4: found '12g'",
         "16 hexadecimal digits"},
        {HEAD "comment cscd plan 1\ncomment cscd method single\n" VERTEX FACE END,
         "lacks 'comment cscd mesh'", "expected"},
        {HEAD COMMENTS VERTEX FACE CHARGE REGIONS COMPONENT END, "'face' lacks the property 'region'", "one"},
        {HEAD COMMENTS VERTEX FACE REGION REGIONS COMPONENT END, "'face' lacks the property 'charge'", "one"},
        {HEAD COMMENTS VERTEX FACE CHARGE REGION COMPONENT END, "0 elements 'region'", "expected one"},
        {HEAD COMMENTS VERTEX FACE CHARGE REGION REGIONS REGIONS COMPONENT END, "2 elements 'region'",
         "expected one"},
        {HEAD COMMENTS VERTEX FACE CHARGE REGION REGIONS END, "0 elements 'component'", "expected one"},
        {HEAD COMMENTS VERTEX FACE "property list uchar uint region\n" CHARGE REGIONS COMPONENT END,
         "'face' lacks the property 'region'", "one number"},
        {HEAD COMMENTS VERTEX FACE CHARGE REGION "element region 5\nproperty double x\nproperty double y\n"
                                                 "property double z\n" COMPONENT END,
         "5 regions", "expected 1 to 4"},
        {HEAD COMMENTS VERTEX FACE CHARGE REGION REGIONS
         "element component 2\nproperty double capacitance\n" END,
         "2 components", "expected the 1"},
        {HEAD COMMENTS
         "element vertex 5\nproperty double x\nproperty double y\nproperty double z\n" FACE CHARGE REGION
             REGIONS COMPONENT END,
         "5 vertices", "expected 4"},
        {"ply\nformat ascii 1.0\n" COMMENTS "element vertex 4\n", ":7: file ends inside the header",
         "end_header"},
    };
    expect_all_refused(cases, sizeof cases / sizeof *cases);
}

TEST(bad_rows_are_refused) {
    static const char *const cases[][3] = {
        {HEADER "0 0 nan\n", ":21: 'z' of vertex 0 is nan", "finite"},
        {HEADER VERTICES "4 0 2 1 3 .5 0\n", ":25: a face of 4 corners", "expected 3"},
        {HEADER VERTICES "3 0 2 1 inf 0\n", ":25: 'charge' of face 0 is inf", "finite"},
        {HEADER VERTICES "3 0 2 1 .5 1\n", ":25: face 0 is in region 1", "one of the 1 regions"},
        {HEADER VERTICES FACES "0 0 nan\n", ":29: 'z' of region 0 is nan", "finite"},
        {HEADER VERTICES FACES ".25 .25 .25\n-inf\n", ":30: 'capacitance' of component 0 is -inf", "finite"},
        {HEADER VERTICES FACES ".25 .25 .25\n", ":30: file ends inside component 1 of 1", ""},
        {HEADER VERTICES FACES REST "7\n", ":31: found '7' after the last element", "end of the file"},
        {HEADER VERTICES "3 0 2 1 .5 0\n3 0 1 2 .25 0\n3 0 3 1 1 0\n3 1 2 3 2 0\n" REST,
         "triangle 1 has the vertices 0 1 2, expected 0 1 3", ""},
        {HEADER "0 0 1e-310\n1 0 0\n0 1 0\n0 0 1\n" FACES REST, "text.ply: ", "vertex 0"},
        {HEAD
         "comment cscd plan 1\ncomment cscd method single\ncomment cscd mesh 0123456789abcdef\n" VERTEX FACE
             REGION REGIONS END VERTICES "3 0 2 1 0\n3 0 1 3 0\n3 0 3 2 0\n3 1 2 3 0\n.25 .25 .25\n",
         "the header gives the mesh's hash as 0123456789abcdef, but", "the file was changed"},
    };
    expect_all_refused(cases, sizeof cases / sizeof *cases);
}

TEST(memory_that_runs_out_is_an_error) {
    saved s = save_plan(recorded_cube(false), CSCD_METHOD_CHARGE);
    int failures = 0;
    for (bool read; io_allocations_go_on(failures); failures++) {
        cscd_plan *plan = NULL;
        io_error error = {""};
        read = plan_file_read(s.path.text, s.context, s.mesh, &plan, &error);
        io_allocations_left = -1;
        if (!read) assert_non_null(strstr(error.text, "out of memory"));
        cscd_plan_destroy(plan);
    }
    assert_true(failures >= 6);
    saved_free(&s);
}

TEST(what_cannot_be_written_is_not_left) {
    saved s = save_plan(recorded_cube(false), CSCD_METHOD_SINGLE);
    uint8_t colours[48] = {0};
    io_error error = {""};
    temp_path nowhere = temp_file_path(&own_folder, "no/such.ply");
    assert_false(plan_file_write(nowhere.text, s.mesh, s.shape.frames, s.plan, colours, &error));
    assert_non_null(strstr(error.text, "no/such.ply: cannot write: No such file"));
    assert_false(plan_file_write("/dev/full", s.mesh, s.shape.frames, s.plan, colours, &error));
    assert_non_null(strstr(error.text, "/dev/full: cannot write: No space left"));
    saved_free(&s);
}

AROUND_ALL(own_folder_make, own_folder_remove)
