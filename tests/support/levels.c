/* A context for each level of vector instructions that this processor has. */
#include "tests/support/levels.h"
#include "tests/support/test.h"

cscd_context *contexts[LEVEL_COUNT];

int open_levels(void **state) {
    (void)state;
    for (int i = 0; i < LEVEL_COUNT; i++) {
        cscd_context_options options = cscd_context_defaults();
        options.simd = (cscd_simd)(CSCD_SIMD_SCALAR + i);
        bool created = cscd_context_create(&options, &contexts[i]) == CSCD_OK;
        if (created != processor_has_simd(options.simd)) return 1;
        if (!created) contexts[i] = NULL;
        print_message("%s: %s\n", cscd_name(CSCD_SIMDS, options.simd),
                      contexts[i] != NULL ? "compared" : "absent");
    }
    return 0;
}

int close_levels(void **state) {
    (void)state;
    for (int i = 0; i < LEVEL_COUNT; i++) cscd_context_destroy(contexts[i]);
    return 0;
}
