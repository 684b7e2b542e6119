/* Loaded before a program, refuses memory once: LD_PRELOAD=failing_memory.so FAIL_ALLOCATION=N. The N-th request after main has begun,
 * of whatever library, gets NULL. Requests of json-c are spared, because version 0.16 goes on with a NULL where it copies the name of
 * a member, and those of OpenBLAS, because version 0.3.21 does so in a kernel for small matrices; so are those of libgfortran, which ends
 * the program when it cannot begin. When the program ends, COUNT_ALLOCATIONS names a file for how many requests there were. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef int program_main(int, char **, char **);

static atomic_bool started;
static atomic_long requests;
static long failing = -1;
static program_main *whole_main;

/* Memory for dlsym itself, which asks before it has answered. */
static char early_memory[4096];
static size_t early_size;

static void *take_early(size_t size) {
    void *block = early_memory + early_size;
    early_size += (size + 15) / 16 * 16;
    return early_size <= sizeof early_memory ? block : NULL;
}

static bool is_early(const void *block) {
    return (const char *)block >= early_memory && (const char *)block < early_memory + sizeof early_memory;
}

/* caller: an address in the code that asks. */
static bool is_refused(void *caller) {
    Dl_info object;
    if (!atomic_load(&started)) return false;
    static const char *const spared[] = {"libjson-c", "libopenblas", "libgfortran"};
    const bool known = dladdr(caller, &object) != 0;
    for (int i = 0; known && i < 3; i++)
        if (strstr(object.dli_fname, spared[i]) != NULL) return false;
    if (atomic_fetch_add(&requests, 1) + 1 != failing) return false;
    errno = ENOMEM;
    return true;
}

/* Finds the function of this name in the C library, once. */
#define FIND_NEXT(function)                                                                                  \
    static __typeof__(function) *next;                                                                       \
    if (next == NULL) *(void **)(&next) = dlsym(RTLD_NEXT, #function)

void *malloc(size_t size) {
    FIND_NEXT(malloc);
    return is_refused(__builtin_return_address(0)) ? NULL : next(size);
}

void *calloc(size_t count, size_t size) {
    static bool is_finding;
    static __typeof__(calloc) *next;
    if (next == NULL) {
        if (is_finding) return take_early(count * size);
        is_finding = true;
        *(void **)(&next) = dlsym(RTLD_NEXT, "calloc");
    }
    return is_refused(__builtin_return_address(0)) ? NULL : next(count, size);
}

void *realloc(void *block, size_t size) {
    FIND_NEXT(realloc);
    return is_refused(__builtin_return_address(0)) ? NULL : next(block, size);
}

void *aligned_alloc(size_t alignment, size_t size) {
    FIND_NEXT(aligned_alloc);
    return is_refused(__builtin_return_address(0)) ? NULL : next(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size) {
    FIND_NEXT(posix_memalign);
    return is_refused(__builtin_return_address(0)) ? ENOMEM : next(block, alignment, size);
}

/* Of the C library, which would hide who asks. */
char *strdup(const char *text) {
    FIND_NEXT(malloc);
    const size_t size = strlen(text) + 1;
    char *copy = is_refused(__builtin_return_address(0)) ? NULL : next(size);
    return copy != NULL ? memcpy(copy, text, size) : NULL;
}

void free(void *block) {
    FIND_NEXT(free);
    if (!is_early(block)) next(block);
}

static void write_count(void) {
    const char *path = getenv("COUNT_ALLOCATIONS");
    const long count = atomic_load(&requests);
    atomic_store(&started, false);
    FILE *file = path != NULL ? fopen(path, "w") : NULL;
    if (file == NULL) return;
    fprintf(file, "%ld\n", count);
    fclose(file);
}

static int begin_main(int argument_count, char **arguments, char **environment) {
    const char *number = getenv("FAIL_ALLOCATION");
    if (number != NULL) failing = strtol(number, NULL, 10);
    atexit(write_count);
    atomic_store(&started, true);
    return whole_main(argument_count, arguments, environment);
}

/* What the C library calls to start a program. */
int __libc_start_main(program_main *main, int argument_count, char **arguments, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end);

int __libc_start_main(program_main *main, int argument_count, char **arguments, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end) {
    FIND_NEXT(__libc_start_main);
    whole_main = main;
    return next(begin_main, argument_count, arguments, init, fini, rtld_fini, stack_end);
}
