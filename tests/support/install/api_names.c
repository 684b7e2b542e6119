/* Lists the names of the functions that the public headers declare. */
#include "tests/support/install/api_names.h"

#include "tests/support/shell.h"

/* A declaration may go over several lines, but its name and the parenthesis after it stand together. */
#define NAMES                                                                                                \
    "cat include/cscd/%s | tr '\\n' ' ' | grep -oE 'CSCD_API [^;(]*cscd_[a-z_0-9]+\\(' | "                   \
    "grep -oE 'cscd_[a-z_0-9]+\\($' | tr -d '(' | "

char *api_symbols(const char *header) {
    return shell_output(0, NAMES "LC_ALL=C sort", header);
}

char *api_functions(const char *header) {
    return shell_output(0, NAMES "sed 's/_sized$//' | LC_ALL=C sort", header);
}
