/* The program `cscd`. */
#include "tool/common/plans.h"
#include "tool/tool.h"

#include <fcntl.h>
#include <unistd.h>

/* A standard file that is closed would be the number of the next file that is opened, which would then get
 * what is printed. These stand in for it, and using them fails as it would without. */
static void hold_standard_files(void) {
    for (int file = STDIN_FILENO; file <= STDERR_FILENO; file++)
        if (fcntl(file, F_GETFD) < 0) open("/dev/null", file == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

int main(int argument_count, char **arguments) {
    hold_standard_files();
    blas_kernels_own_process();
    return tool_run(argument_count, arguments);
}
