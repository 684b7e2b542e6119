/* Opens libcscd-baselines at the first call that needs it, and not before: OpenBLAS, which it brings, starts threads as soon as it is
 * loaded, which takes tens of milliseconds, and hangs where a limit (`ulimit -v`) leaves them no memory. Windows and WebAssembly have
 * no such library. */
#include "src/core/baseline_library.h"

#if defined(_WIN32) || defined(__EMSCRIPTEN__)

cscd_status baseline_library_find(cscd_context *context, const char *entry_name, uint32_t interface,
                                  const char *what, const void **out) {
    (void)entry_name;
    (void)interface;
    *out = NULL;
    return context_fail(context, CSCD_SYSTEM_ERROR,
                        "%s needs libcscd-baselines, which is not built for Windows and WebAssembly", what);
}

#else

#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#define TEXT_OF_VALUE(x) #x
#define TEXT_OF(x)       TEXT_OF_VALUE(x)
#define LIBRARY_NAME     "libcscd-baselines.so." TEXT_OF(CSCD_VERSION_MAJOR)

enum { PATH_SIZE = 4096 };

/* Writes the path that the library has if it stands in the folder of a file, or in one that `beside` leads to
 * from there. Returns whether it does. */
static bool stands_by(const char *file, const char *beside, char path[PATH_SIZE]) {
    const char *slash = strrchr(file, '/');
    if (slash == NULL) return false;
    int length = snprintf(path, PATH_SIZE, "%.*s/%s" LIBRARY_NAME, (int)(slash - file), file, beside);
    return length > 0 && length < PATH_SIZE && access(path, F_OK) == 0;
}

/* Returns the path of a file that was loaded under this name, without links on the way, to be freed; NULL if
 * it is unknown. A program has the name that its caller has typed, so the system tells its path. */
static char *own_path(const char *name) {
#ifdef __GLIBC__
    if (strcmp(name, program_invocation_name) == 0) return realpath("/proc/self/exe", NULL);
#endif
    return realpath(name, NULL);
}

/* A program in PREFIX/bin has it in PREFIX/lib, or wherever a system has the libraries of a prefix. */
static bool stands_in_prefix(const char *file, char path[PATH_SIZE]) {
    const char *slash = strrchr(file, '/');
    if (slash == NULL || slash - file < 4 || strncmp(slash - 4, "/bin", 4) != 0) return false;
#ifdef LIBRARY_FOLDER
    if (stands_by(file, "../lib/" LIBRARY_FOLDER "/", path)) return true;
#endif
    return stands_by(file, "../lib/", path) || stands_by(file, "../lib64/", path);
}

/* Looks in the folder of the file that has this function, under the name by which it was loaded and under its
 * own, and in the folder cscd there, since distributions keep libraries that nothing links out of the folder
 * of all libraries. */
static bool find_library(char path[PATH_SIZE]) {
    Dl_info here;
    if (dladdr((void *)(uintptr_t)find_library, &here) == 0 || here.dli_fname == NULL) return false;
    if (stands_by(here.dli_fname, "", path)) return true;
    char *file = own_path(here.dli_fname);
    bool found = file != NULL && (stands_by(file, "", path) || stands_by(file, "cscd/", path) ||
                                  stands_in_prefix(file, path));
    free(file);
    return found;
}

/* OpenBLAS starts this number of threads when it is loaded, and only these variables change it. */
static size_t blas_threads(void) {
    static const char *const variables[] = {"OPENBLAS_NUM_THREADS", "GOTO_NUM_THREADS", "OMP_NUM_THREADS"};
    long count = 0;
    for (int i = 0; i < 3 && count <= 0; i++) {
        const char *value = getenv(variables[i]);
        if (value != NULL) count = strtol(value, NULL, 10);
    }
    if (count <= 0) count = sysconf(_SC_NPROCESSORS_ONLN);
    return count > 0 ? (size_t)count : 1;
}

/* Measured with OpenBLAS 0.3.21: what it takes of the address space in all, and for each thread that it starts. */
enum { BLAS_MEBIBYTES = 60, BLAS_THREAD_MEBIBYTES = 140 };

/* OpenBLAS hangs while it is loaded if a limit (`ulimit -v`) leaves less. */
static bool has_room(size_t mebibytes) {
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return true;
    void *room = mmap(NULL, mebibytes << 20, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (room != MAP_FAILED) munmap(room, mebibytes << 20);
    return room != MAP_FAILED;
}

/* RTLD_NODELETE: it stays when it is closed, so nothing has to be remembered here, and the threads of its BLAS never
 * lose their code. RTLD_LOCAL: its BLAS does not become that of the program. */
static cscd_status open_library(cscd_context *context, const char *what, void **out) {
    const int flags = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE;
    char path[PATH_SIZE];
    const char *name = find_library(path) ? path : LIBRARY_NAME;
    size_t threads = blas_threads(), needed = BLAS_MEBIBYTES + BLAS_THREAD_MEBIBYTES * (threads - 1);
    *out = dlopen(name, flags | RTLD_NOLOAD);
    if (*out != NULL) return CSCD_OK;
    if (!has_room(needed))
        return context_fail(
            context, CSCD_OUT_OF_MEMORY,
            "%s needs " LIBRARY_NAME
            ", whose OpenBLAS, with %zu threads, takes %zu MiB of address space, and a limit "
            "(ulimit -v) leaves less; raise it, or set OPENBLAS_NUM_THREADS=1 before the program starts",
            what, threads, needed);
    *out = dlopen(name, flags);
    if (*out != NULL) return CSCD_OK;
    return context_fail(
        context, CSCD_SYSTEM_ERROR,
        "%s needs " LIBRARY_NAME
        ", looked for beside libcscd.so or the program and where the system looks (a build with "
        "BASELINES=1, which is the default, makes it): %s",
        what, dlerror());
}

cscd_status baseline_library_find(cscd_context *context, const char *entry_name, uint32_t interface,
                                  const char *what, const void **out) {
    void *library;
    *out = NULL;
    cscd_status status = open_library(context, what, &library);
    if (status != CSCD_OK) return status;
    baseline_entry *entry;
    void *symbol = dlsym(library, entry_name);
    memcpy(&entry, &symbol, sizeof entry);
    if (entry != NULL) *out = entry(interface);
    dlclose(library);
    if (*out != NULL) return CSCD_OK;
    return context_fail(
        context, CSCD_SYSTEM_ERROR,
        "%s: " LIBRARY_NAME " and libcscd are of different versions; install both of one build", what);
}

#endif
