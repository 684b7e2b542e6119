/* Lists the names of the functions that the public headers declare. */
#include "tests/support/install/api_names.h"

#include "tests/support/shell.h"

char *api_names(const char *header) {
    /* A declaration may go over several lines, but its name and the parenthesis after it stand together. */
    return shell_output(0,
                        "cat include/cscd/%s | tr '\\n' ' ' | grep -oE 'CSCD_API [^;(]*cscd_[a-z_0-9]+\\(' | "
                        "grep -oE 'cscd_[a-z_0-9]+\\($' | tr -d '(' | LC_ALL=C sort",
                        header);
}
