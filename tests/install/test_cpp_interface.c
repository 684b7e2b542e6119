/* The C++ interface calls every function of C that has to do with an object. */
#include "tests/support/install/api_names.h"
#include "tests/support/shell.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Functions that programs in C++ use as they are. */
static const char plain[] =
    "cscd_contact_kind_name\ncscd_curve_end_name\ncscd_intersection_kind_name\ncscd_left_out_name\ncscd_max_memory_default\ncscd_mesh_context\ncscd_method_from_name\ncscd_method_name\ncscd_mode_from_name\n"
    "cscd_mode_name\ncscd_reason_text\ncscd_simd_from_name\ncscd_simd_name\n"
    "cscd_version_string\ncscd_volume_from_name\ncscd_volume_name\n";

static void every_function_has_a_wrapper(void **state) {
    (void)state;
    char missing[4096] = "", line[128];
    char *functions = api_functions("*.h"), *research = api_functions("research.h"),
         *sensors = api_functions("sensors.h");
    for (char *name = strtok(functions, "\n"); name != NULL; name = strtok(NULL, "\n")) {
        snprintf(line, sizeof line, "%s\n", name);
        if (strstr(research, line) != NULL || strstr(sensors, line) != NULL) continue;
        char *calls =
            shell_output(0, "cat include/cscd/*.hpp | grep -v '^ \\*' | grep -cw '%s' || true", name);
        if (atoi(calls) == 0) strcat(missing, line);
        free(calls);
    }
    free(functions);
    free(research);
    free(sensors);
    char *sorted = shell_output(0, "printf '%s' | LC_ALL=C sort", missing);
    assert_string_equal(sorted, plain);
    free(sorted);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_function_has_a_wrapper)};
    return cmocka_run_group_tests_name("cpp_interface", tests, NULL, NULL);
}
