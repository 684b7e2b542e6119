/* The services of the operating system that the library needs: Linux, Windows, macOS, FreeBSD,
 * WebAssembly. */

/* Before every header: a machine may lack those of 32-bit systems, and its complaint would hide this one. */
#if __SIZEOF_POINTER__ < 8 && !defined(_WIN64) && !defined(__wasm__)
#error "cscd runs on 64-bit systems and on WebAssembly: the sizes of other 32-bit systems are not tested"
#endif

#include "src/core/system.h"

#include <stdlib.h>

#ifdef _WIN32

#include <malloc.h>
#include <windows.h>

void *system_memory(size_t size, size_t alignment) {
    return _aligned_malloc(size, alignment);
}

void system_memory_free(void *block) {
    _aligned_free(block);
}

/* Windows also limits the memory that it promises to programs, in memory and on disk. */
size_t system_memory_left(void) {
    MEMORYSTATUSEX memory = {.dwLength = sizeof memory};
    if (!GlobalMemoryStatusEx(&memory)) return SIZE_MAX;
    return (size_t)(memory.ullAvailPhys < memory.ullAvailPageFile ? memory.ullAvailPhys
                                                                  : memory.ullAvailPageFile);
}

uint32_t system_processors(void) {
    const DWORD count = GetActiveProcessorCount(ALL_PROCESSOR_GROUPS);
    return count < 1 ? 1 : (uint32_t)count;
}

/* The mask is that of one group of processors, and 0 where a process has threads in several groups. */
uint32_t system_processors_for_us(void) {
    DWORD_PTR ours = 0, all = 0;
    if (!GetProcessAffinityMask(GetCurrentProcess(), &ours, &all) || ours == 0 || ours == all)
        return system_processors();
    return (uint32_t)__builtin_popcountll(ours);
}

bool system_has_threads(void) {
    return true;
}

uint32_t system_forks(void) {
    return 0;
}

#else

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <unistd.h>
#ifdef __EMSCRIPTEN__
#include <emscripten/heap.h>
#endif
#ifdef __linux__
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#endif

/* aligned_alloc of C11 came late to macOS. */
void *system_memory(size_t size, size_t alignment) {
    void *block = NULL;
    return posix_memalign(&block, alignment, size) == 0 ? block : NULL;
}

void system_memory_free(void *block) {
    free(block);
}

#if defined(__linux__)

/* The number after key in a file of lines "key number"; key "" takes the first number. False when there is none. */
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

/* A group's file cache counts as free, since it can be dropped. */
uint64_t system_group_memory_left(const char *limit_path, const char *usage_path, const char *stat_path) {
    uint64_t limit, usage, cache = 0;
    if (!read_number(limit_path, "", &limit) || !read_number(usage_path, "", &usage)) return UINT64_MAX;
    read_number(stat_path, "inactive_file ", &cache);
    usage -= cache < usage ? cache : usage;
    return limit > usage ? limit - usage : 0;
}

size_t system_memory_left(void) {
    uint64_t available = UINT64_MAX, kilobytes;
    long pages = sysconf(_SC_AVPHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    if (read_number("/proc/meminfo", "MemAvailable:", &kilobytes)) {
        available = kilobytes * 1024;
    } else if (pages > 0 && page_size > 0) {
        available = (uint64_t)pages * (uint64_t)page_size;
    }
    const uint64_t groups[] = {system_group_memory_left("/sys/fs/cgroup/memory.max",
                                                        "/sys/fs/cgroup/memory.current",
                                                        "/sys/fs/cgroup/memory.stat"),
                               system_group_memory_left("/sys/fs/cgroup/memory/memory.limit_in_bytes",
                                                        "/sys/fs/cgroup/memory/memory.usage_in_bytes",
                                                        "/sys/fs/cgroup/memory/memory.stat")};
    for (int i = 0; i < 2; i++) available = groups[i] < available ? groups[i] : available;
    return available < SIZE_MAX ? (size_t)available : SIZE_MAX;
}

#elif defined(__EMSCRIPTEN__)

/* All that the module may ever have, because nobody tells how much of it malloc has taken back. */
size_t system_memory_left(void) {
    return emscripten_get_heap_max();
}

#else

size_t system_memory_left(void) {
    return SIZE_MAX;
}

#endif

uint32_t system_processors(void) {
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online < 1 ? 1 : (uint32_t)online;
}

uint32_t system_processors_for_us(void) {
#ifdef __linux__
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0) return (uint32_t)CPU_COUNT(&set);
#endif
    return system_processors();
}

bool system_has_threads(void) {
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
    return false;
#else
    return true;
#endif
}

/* A process number would not do: a child in a namespace of its own may have that of its parent. */
static atomic_uint forks;

static void count_fork(void) {
    atomic_fetch_add(&forks, 1);
}

static void watch_forks(void) {
    pthread_atfork(NULL, NULL, count_fork);
}

uint32_t system_forks(void) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, watch_forks);
    return atomic_load_explicit(&forks, memory_order_relaxed);
}

#endif

/* ---- vector instructions of the processor -------------------------------------------------------------- */

#if defined(CSCD_WITH_AVX)

bool processor_has_simd(cscd_simd simd) {
    __builtin_cpu_init();
    if (simd == CSCD_SIMD_AVX512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    if (simd == CSCD_SIMD_AVX2) return __builtin_cpu_supports("avx2");
    return simd == CSCD_SIMD_SCALAR;
}

#elif defined(CSCD_WITH_NEON)

/* Every aarch64 processor has NEON. */
bool processor_has_simd(cscd_simd simd) {
    return simd == CSCD_SIMD_SCALAR || simd == CSCD_SIMD_NEON;
}

#else

bool processor_has_simd(cscd_simd simd) {
    return simd == CSCD_SIMD_SCALAR;
}

#endif

cscd_simd processor_best_simd(void) {
    cscd_simd simd = SIMD_LAST;
    while (!processor_has_simd(simd)) simd = (cscd_simd)(simd - 1);
    return simd;
}
