/* Plan files to whose faces somebody has added properties: they are skipped, whatever a mesh would take them for. */
#include "tests/support/files.h"
#include "tests/support/test.h"
#include "tool/io/ply.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define BEFORE_FACES                                                                                         \
    "ply\nformat ascii 1.0\ncomment cscd plan 1\ncomment cscd method charge\ncomment cscd mesh %016" PRIx64  \
    "\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nelement face 4\n"
#define FACES                                                                                                \
    "%sproperty list uchar uint vertex_indices\n%sproperty double charge\n%sproperty uint region\n%s"
#define BEHIND_FACES                                                                                         \
    "element region 1\nproperty double x\nproperty double y\nproperty double z\n"                            \
    "element component 1\nproperty double capacitance\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"

static const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

/* A plan of the tetrahedron with one more property: before the corners, the charge or the region, or at the end. */
static temp_path write_addition(const temp_folder *folder, const cscd_mesh *mesh, const char *addition,
                                int place) {
    char property[60], text[1500];
    const char *properties[4] = {"", "", "", ""};
    snprintf(property, sizeof property, "property %s\n", addition);
    properties[place] = property;
    int end = snprintf(text, sizeof text, BEFORE_FACES FACES BEHIND_FACES, cscd_mesh_hash(mesh),
                       properties[0], properties[1], properties[2], properties[3]);
    for (uint32_t face = 0; face < 4; face++) {
        const uint32_t *corners = triangles + 3 * (size_t)face;
        char value[20];
        const char *values[4] = {"", "", "", ""};
        snprintf(value, sizeof value, strncmp(addition, "list", 4) == 0 ? " 2 9 %u " : " %u ", 100 + face);
        values[place] = value;
        end += snprintf(text + end, sizeof text - (size_t)end, "%s3 %u %u %u%s %u.5 %s0%s\n", values[0],
                        corners[0], corners[1], corners[2], values[1], face, values[2], values[3]);
    }
    end += snprintf(text + end, sizeof text - (size_t)end, ".25 .25 .25\n1.5\n");
    assert_true((size_t)end < sizeof text);
    return temp_file_write(folder, "added.plan.ply", text, (size_t)end);
}

TEST(additions_are_skipped) {
    static const char *const additions[] = {"uchar part",          "int label",     "float part",
                                            "float stiffness",     "int stiffness", "double x",
                                            "list uchar int part", "uchar red"};
    const temp_folder folder = temp_folder_make();
    const cscd_object_desc desc = cscd_object_of_triangles(4, 4, triangles);
    cscd_context *context;
    cscd_mesh *mesh;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    for (size_t i = 0; i < 4 * sizeof additions / sizeof *additions; i++) {
        const temp_path path = write_addition(&folder, mesh, additions[i / 4], (int)(i % 4));
        cscd_plan *plan = NULL;
        io_error error = {""};
        if (!plan_file_read(path.text, context, mesh, &plan, &error)) fail_msg("%s", error.text);
        for (uint32_t face = 0; face < 4; face++)
            assert_true(cscd_plan_triangle_charge(plan, face) == face + 0.5);
        assert_true(cscd_plan_region(plan, 0).detector_point[0] == 0.25);
        cscd_plan_destroy(plan);
    }
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    temp_folder_remove(&folder);
}
