/* A plan whose charge was solved for by a dense matrix says with which kernels OpenBLAS has done that. The program runs itself again behind a library that plays an OpenBLAS that
 * does not know the processor. */
#include "preprocess/baselines/dense/blas_choice.h"
#include "tests/support/calls.h"
#include "tests/support/files.h"
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *program;

/* Writes what the plan of a method says, as "charge_kernels better_kernels", with - for NULL. */
static void describe_plan(cscd_method method, cscd_charge_solver solver, char text[128]) {
    body shape = body_of(BODY_SPHERE, 200);
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_plan_options options = cscd_plan_defaults();
    cscd_object_desc desc =
        cscd_object_of_triangles(shape.vertex_count, shape.triangle_count, shape.triangles);
    expect_ok(cscd_context_create(NULL, &context));
    expect_ok(cscd_mesh_create(context, &desc, 1, &mesh));
    options.method = method;
    options.charge_solver = solver;
    expect_ok(plan_create_packed(mesh, shape.positions, &options, &plan));
    cscd_plan_info info = cscd_plan_describe(plan);
    snprintf(text, 128, "%s %s", info.charge_kernels != NULL ? info.charge_kernels : "-",
             info.better_kernels != NULL ? info.better_kernels : "-");
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    body_free(&shape);
}

TEST(charge_names_its_kernels) {
    char text[128], expected[128];
    const char *name = blas_choice_name(), *better = blas_choice_better();
    describe_plan(CSCD_METHOD_CHARGE, CSCD_CHARGE_DENSE, text);
    snprintf(expected, sizeof expected, "%s %s", name != NULL ? name : "-", better != NULL ? better : "-");
    assert_string_equal(text, expected);
}

TEST(others_have_none) {
    char text[128];
    describe_plan(CSCD_METHOD_CHARGE, CSCD_CHARGE_TREE, text);
    assert_string_equal(text, "- -");
    describe_plan(CSCD_METHOD_KMEANS, CSCD_CHARGE_DENSE, text);
    assert_string_equal(text, "- -");
}

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

/* What this program says behind such a library. */
TEST(old_kernels_are_named) {
    char command[8192], text[128] = "";
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) skip();
    temp_folder folder = temp_folder_make();
    temp_path library = temp_file_path(&folder, "old_openblas.so");
    snprintf(command, sizeof command,
             "echo 'char *openblas_get_corename(void) {return \"Prescott\";}' | "
             "${CC:-cc} -xc -shared -fPIC - -o '%s'",
             library.text);
    assert_int_equal(system(command), 0);
    setenv("LD_PRELOAD", library.text, 1);
    snprintf(command, sizeof command, "'%s' describe", program);
    FILE *told = popen(command, "r");
    unsetenv("LD_PRELOAD");
    assert_non_null(told);
    assert_non_null(fgets(text, sizeof text, told));
    pclose(told);
    text[strcspn(text, "\n")] = '\0';
    assert_true(strcmp(text, "Prescott SkylakeX") == 0 || strcmp(text, "Prescott Haswell") == 0);
    temp_folder_remove(&folder);
}

#endif

/* As the program that old_kernels_are_named starts, it describes. */
static int describe_or_test(void) {
    program = room_argument(0);
    if (room_argument_count() != 2 || strcmp(room_argument(1), "describe") != 0)
        return room_run_tests(TEST_FILE);
    char text[128];
    describe_plan(CSCD_METHOD_CHARGE, CSCD_CHARGE_DENSE, text);
    puts(text);
    return 0;
}

FILE_MAIN(describe_or_test)
