/* How much memory the system would give us now. */
#include "preprocess/available_memory.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* The number after key in a file of lines "key number"; key "" takes the first number. False when there is
 * none. */
static bool read_number(const char *path, const char *key, uint64_t *out) {
    FILE *file = fopen(path, "r");
    if (file == NULL) return false;
    char line[256];
    bool found = false;
    size_t length = strlen(key);
    while (!found && fgets(line, sizeof line, file) != NULL) {
        if (strncmp(line, key, length) == 0) found = sscanf(line + length, "%" SCNu64, out) == 1;
    }
    fclose(file);
    return found;
}

/* The memory that a control group's limit leaves; its file cache counts as free, since it can be dropped. */
static uint64_t left_in_group(const char *limit_path, const char *usage_path, const char *stat_path) {
    uint64_t limit, usage, cache = 0;
    if (!read_number(limit_path, "", &limit) || !read_number(usage_path, "", &usage)) return UINT64_MAX;
    read_number(stat_path, "inactive_file ", &cache);
    usage -= cache < usage ? cache : usage;
    return limit > usage ? limit - usage : 0;
}

size_t available_memory(void) {
    uint64_t available = UINT64_MAX, kilobytes;
    long pages = sysconf(_SC_AVPHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    if (read_number("/proc/meminfo", "MemAvailable:", &kilobytes)) {
        available = kilobytes * 1024;
    } else if (pages > 0 && page_size > 0) {
        available = (uint64_t)pages * (uint64_t)page_size;
    }
    const uint64_t groups[] = {left_in_group("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current",
                                             "/sys/fs/cgroup/memory.stat"),
                               left_in_group("/sys/fs/cgroup/memory/memory.limit_in_bytes",
                                             "/sys/fs/cgroup/memory/memory.usage_in_bytes",
                                             "/sys/fs/cgroup/memory/memory.stat")};
    for (int i = 0; i < 2; i++) available = groups[i] < available ? groups[i] : available;
    return available < SIZE_MAX ? (size_t)available : SIZE_MAX;
}
