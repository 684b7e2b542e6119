/* Lets libFuzzer, which follows the paths of the code, make files of one format: READER names it (readings.c). */
#include "tests/fuzz/readings.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerInitialize(int *argument_count, char ***arguments);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static const reading *chosen;
static temp_folder folder;

static void remove_folder(void) {
    temp_folder_remove(&folder);
}

int LLVMFuzzerInitialize(int *argument_count, char ***arguments) {
    (void)argument_count;
    const char *format = getenv("READER");
    chosen = format != NULL ? reading_named(format) : NULL;
    if (chosen == NULL) {
        fprintf(stderr, "%s: READER is %s, which is no format that we read\n", (*arguments)[0],
                format != NULL ? format : "not set");
        exit(2);
    }
    folder = temp_folder_make();
    atexit(remove_folder);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    char name[40];
    snprintf(name, sizeof name, "input%s", chosen->ending);
    reading_try(chosen, &folder, name, reading_tetrahedron(), bytes, size);
    return 0;
}
