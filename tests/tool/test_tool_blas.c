/* The tool sees to it that OpenBLAS runs kernels for the processor. A library that is loaded before it plays an OpenBLAS that does
 * not know the processor: it names old kernels unless the variable says otherwise. */
#include "src/blas/blas_choice.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static temp_path library, plan, model;

static const char source[] =
    "#include <stdio.h>\n"
    "#include <stdlib.h>\n"
    "char *openblas_get_corename(void) {\n"
    "    char *told = getenv(\"OPENBLAS_CORETYPE\");\n"
    "    return told != NULL ? told : (char *)\"Prescott\";\n"
    "}\n"
    "__attribute__((constructor)) static void show_start(void) {\n"
    "    const char *told = getenv(\"OPENBLAS_CORETYPE\");\n"
    "    fprintf(stderr, \"started with %s\\n\", told != NULL ? told : \"nothing\");\n"
    "}\n";

static int make_files(void **state) {
    char command[4096];
    (void)state;
    folder = temp_folder_make();
    library = temp_file_path(&folder, "old_openblas.so");
    plan = temp_file_path(&folder, "plan.ply");
    model = temp_file_path(&folder, "model.obj");
    FILE *file = fopen(model.text, "w");
    assert_non_null(file);
    fputs("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n", file);
    assert_int_equal(fclose(file), 0);
    snprintf(command, sizeof command, "${CC:-cc} -xc -shared -fPIC - -o '%s'", library.text);
    file = popen(command, "w");
    assert_non_null(file);
    fputs(source, file);
    assert_int_equal(pclose(file), 0);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static void the_processor_decides(void **state) {
    (void)state;
    assert_string_equal(blas_better_core("Prescott", true, true), "SkylakeX");
    assert_string_equal(blas_better_core("Prescott", true, false), "Haswell");
    assert_string_equal(blas_better_core("Sandybridge", true, false), "Haswell");
    assert_null(blas_better_core("Prescott", false, false));
    assert_null(blas_better_core("Haswell", true, true));
    assert_null(blas_better_core("Zen", true, true));
    assert_null(blas_better_core("Cooperlake", true, true));
    assert_null(blas_better_core("neoversen1", false, false));
    assert_null(blas_better_core("a core to come", true, true));
}

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

static tool_run preprocess_with_old_openblas(const char *method) {
    setenv("LD_PRELOAD", library.text, 1);
    tool_run run = RUN_TOOL("preprocess", model.text, "-o", plan.text, "--method", method);
    unsetenv("LD_PRELOAD");
    return run;
}

static bool has_avx2(void) {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

/* Once, with the same arguments, and without a warning, since the kernels are right then. */
static void it_runs_itself_again(void **state) {
    (void)state;
    if (!has_avx2()) skip();
    tool_run run = preprocess_with_old_openblas("charge");
    assert_int_equal(run.code, 0);
    const char *first = strstr(run.error, "started with nothing\n"),
               *second = strstr(run.error, "started with ");
    assert_true(first != NULL && first == second);
    second = strstr(first + 1, "started with ");
    assert_true(second != NULL && strstr(second, "nothing") == NULL);
    assert_null(strstr(second + 1, "started with "));
    assert_null(strstr(run.error, "warning"));
    assert_non_null(strstr(run.out, "written: "));
    tool_run_free(&run);
}

static void a_choice_of_the_user_stays(void **state) {
    (void)state;
    if (!has_avx2()) skip();
    setenv("OPENBLAS_CORETYPE", "Prescott", 1);
    tool_run run = preprocess_with_old_openblas("charge"), without = preprocess_with_old_openblas("single");
    unsetenv("OPENBLAS_CORETYPE");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.error, "warning: OpenBLAS runs its kernels for Prescott"));
    assert_null(strstr(strstr(run.error, "started with ") + 1, "started with "));
    assert_null(strstr(without.error, "warning"));
    tool_run_free(&run);
    tool_run_free(&without);
}

#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_processor_decides),
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
        cmocka_unit_test(it_runs_itself_again),
        cmocka_unit_test(a_choice_of_the_user_stays),
#endif
    };
    return cmocka_run_group_tests_name("tool_blas", tests, make_files, remove_files);
}
