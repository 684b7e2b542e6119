/* The tool sees to it that OpenBLAS starts on one thread, with kernels for the processor. A library that is loaded before it plays an
 * OpenBLAS that does not know the processor: it names old kernels unless the variable says otherwise. */
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
    "    char *told = getenv(\"OPENBLAS_CORETYPE\"), *threads = getenv(\"OPENBLAS_NUM_THREADS\");\n"
    "    fprintf(stderr, \"asked with %s, %s threads\\n\", told != NULL ? told : \"nothing\", threads);\n"
    "    return told != NULL ? told : (char *)\"Prescott\";\n"
    "}\n";

static int make_files(void **state) {
    char command[4096];
    (void)state;
    unsetenv("OPENBLAS_CORETYPE");
    unsetenv("OPENBLAS_NUM_THREADS");
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

TEST(the_processor_decides) {
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

static tool_run preprocess_with_old_openblas(const char *method, const char *solver) {
    setenv("LD_PRELOAD", library.text, 1);
    tool_run run =
        RUN_TOOL("preprocess", model.text, "-o", plan.text, "--method", method, "--charge", solver);
    unsetenv("LD_PRELOAD");
    return run;
}

static bool has_avx2(void) {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

/* Another process finds out; this one asks with better kernels from the first time on, so there is nothing to warn of. */
static void expect_choice(const char *method) {
    tool_run run = preprocess_with_old_openblas(method, "dense");
    assert_int_equal(run.code, 0);
    const char *last = run.error, *line = run.error;
    assert_ptr_equal(strstr(line, "asked with nothing, 1 threads\n"), line);
    for (; (line = strstr(line, "asked with ")) != NULL; line++) last = line;
    assert_true(strncmp(last, "asked with SkylakeX, 1 threads\n", 31) == 0 ||
                strncmp(last, "asked with Haswell, 1 threads\n", 30) == 0);
    assert_null(strstr(run.error, "warning"));
    assert_non_null(strstr(run.out, "written: "));
    tool_run_free(&run);
}

TEST(it_chooses_kernels) {
    if (!has_avx2()) skip();
    expect_choice("charge");
    expect_choice("auto");
}

TEST(a_choice_of_the_user_stays) {
    if (!has_avx2()) skip();
    setenv("OPENBLAS_CORETYPE", "Prescott", 1);
    setenv("OPENBLAS_NUM_THREADS", "2", 1);
    tool_run run = preprocess_with_old_openblas("charge", "dense");
    unsetenv("OPENBLAS_CORETYPE");
    unsetenv("OPENBLAS_NUM_THREADS");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.error, "warning: OpenBLAS runs its kernels for Prescott"));
    assert_non_null(strstr(run.error, "asked with Prescott, 2 threads\n"));
    assert_null(strstr(run.error, "1 threads"));
    tool_run_free(&run);
}

/* Other ways to solve for the charge ask nobody, and warn of nothing. */
TEST(others_need_none) {
    tool_run run = preprocess_with_old_openblas("auto", "tree");
    assert_int_equal(run.code, 0);
    assert_string_equal(run.error, "");
    tool_run_free(&run);
}

#endif

AROUND_ALL(make_files, remove_files)
