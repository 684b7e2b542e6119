/* Files that come late. */
#include "tool/common/late_files.h"

#include "tool/common/terminal.h"

#include <time.h>

/* Of a clock that nobody sets. */
static double now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

late_files late_files_begin(double seconds) {
    return (late_files){seconds, seconds > 0.0 ? now_ms() : 0.0};
}

bool late_files_again(const late_files *late) {
    const struct timespec rest = {.tv_nsec = 50 * 1000 * 1000};
    if (late->seconds <= 0.0 || now_ms() - late->began_ms >= late->seconds * 1e3) return false;
    if (interrupt_ends_wait()) return false;
    nanosleep(&rest, NULL);
    return true;
}
