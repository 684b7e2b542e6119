/* Where the charge library is. Compiled twice: with CHARGE_LINKED it is linked, in libcscd.a, in the tool and in tests;
 * without, it is opened at the first call that needs it, by libcscd.so and by builds with CHARGE=0; Windows has none. */
#include "preprocess/charge_call.h"

#ifdef CHARGE_LINKED

cscd_status charge_library_find(cscd_context *context, const charge_functions **out) {
    (void)context;
    *out = charge_functions_of(CHARGE_INTERFACE);
    return CSCD_OK;
}

#elif defined(_WIN32)

/* Its solver, LAPACKE, is not built for Windows; the charges are needed for making a plan, and not for using it. */
cscd_status charge_library_find(cscd_context *context, const charge_functions **out) {
    *out = NULL;
    return context_fail(
        context, CSCD_SYSTEM_ERROR,
        "method charge makes no plans on Windows: make the plan on Linux and load its file here, "
        "or take kmeans or single, which need nothing");
}

#else

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define TEXT_OF_VALUE(x) #x
#define TEXT_OF(x)       TEXT_OF_VALUE(x)
#define LIBRARY_NAME     "libcscd-charge.so." TEXT_OF(CSCD_VERSION_MAJOR)

enum { PATH_SIZE = 4096 };

/* Writes where the library is if it stands in the folder of the file that this function is in. */
static bool path_beside(char path[PATH_SIZE]) {
    Dl_info here;
    if (dladdr((void *)(uintptr_t)path_beside, &here) == 0 || here.dli_fname == NULL) return false;
    const char *slash = strrchr(here.dli_fname, '/');
    if (slash == NULL) return false;
    int folder = (int)(slash - here.dli_fname);
    int length = snprintf(path, PATH_SIZE, "%.*s/" LIBRARY_NAME, folder, here.dli_fname);
    return length > 0 && length < PATH_SIZE;
}

/* RTLD_NODELETE: it stays when it is closed, so nothing has to be remembered here, and the threads of its BLAS never
 * lose their code. RTLD_LOCAL: its BLAS does not become that of the program. */
static void *open_library(void) {
    const int flags = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE;
    char path[PATH_SIZE];
    bool beside = path_beside(path) && access(path, F_OK) == 0;
    return dlopen(beside ? path : LIBRARY_NAME, flags);
}

cscd_status charge_library_find(cscd_context *context, const charge_functions **out) {
    void *library = open_library();
    if (library == NULL)
        return context_fail(
            context, CSCD_SYSTEM_ERROR,
            "method charge needs " LIBRARY_NAME
            " beside libcscd.so (a build with CHARGE=1 makes it; kmeans and single need nothing): %s",
            dlerror());
    charge_entry *entry;
    void *symbol = dlsym(library, CHARGE_ENTRY_NAME);
    memcpy(&entry, &symbol, sizeof entry);
    *out = entry != NULL ? entry(CHARGE_INTERFACE) : NULL;
    dlclose(library);
    if (*out != NULL) return CSCD_OK;
    return context_fail(context, CSCD_SYSTEM_ERROR,
                        LIBRARY_NAME " and libcscd are of different versions: install both of one build");
}

#endif
