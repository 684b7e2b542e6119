/* A folder for the files of a test program. */
#include "tests/support/own_folder.h"

temp_folder folder;

int own_folder_make(void **state) {
    (void)state;
    folder = temp_folder_make();
    return 0;
}

int own_folder_remove(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}
