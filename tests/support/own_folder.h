/* A folder for the files of a test program, made before its tests and removed after them. */
#pragma once

#include "tests/support/temp_file.h"

extern temp_folder folder;

/* For cmocka_run_group_tests. */
int own_folder_make(void **state);
int own_folder_remove(void **state);
