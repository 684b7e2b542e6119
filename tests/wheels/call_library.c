/* Loads the library of a wheel as Python does, and uses it: call_library LIBRARY NAMES [ARGUMENT...]
 *
 * NAMES is a file with the functions that Python calls, one a line; each has to be there. Then a rippled sheet falls through another
 * one, and every contact is printed with all bits of its numbers, so that what two platforms print can be compared. The arguments
 * are those of the tool, which runs in this process, and this ends with its exit code. */
#include "cscd/cscd.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#include <windows.h>
static void *load_library(const char *path) {
    return (void *)LoadLibraryA(path);
}
static void *find_function(void *library, const char *name) {
    return (void *)(uintptr_t)GetProcAddress((HMODULE)library, name);
}
#else
#include <dlfcn.h>
static void *load_library(const char *path) {
    return dlopen(path, RTLD_NOW | RTLD_LOCAL);
}
static void *find_function(void *library, const char *name) {
    return dlsym(library, name);
}
#endif

/* ---- what stands for Python -------------------------------------------------------------------------------- */

static int given_back, taken, asked;

static void *save_thread(void) {
    given_back++;
    return &given_back;
}
static void restore_thread(void *state) {
    taken += state == &given_back;
}
static int check_signals(void) {
    asked++;
    return 0;
}
static void is_never_called(void) {
    fprintf(stderr, "call_library: a function of Python was called that nothing here asks for\n");
    exit(3);
}

/* ---- the library ------------------------------------------------------------------------------------------- */

static void *library;

static void *function_of(const char *name) {
    void *function = find_function(library, name);
    if (function != NULL) return function;
    fprintf(stderr, "call_library: the library has no function %s\n", name);
    exit(3);
}
#define CALL(result, name, types) ((result(*) types)(uintptr_t)function_of(name))

static unsigned find_names(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        perror(path);
        exit(3);
    }
    char line[200];
    unsigned count = 0;
    for (; fgets(line, sizeof line, file) != NULL; count++) {
        line[strcspn(line, "\r\n")] = '\0';
        function_of(line);
    }
    fclose(file);
    return count;
}

static void expect_ok(const char *what, cscd_status status) {
    if (status == CSCD_OK) return;
    fprintf(stderr, "call_library: %s ended with status %d\n", what, (int)status);
    exit(3);
}

/* ---- two sheets -------------------------------------------------------------------------------------------- */

enum { SIDE = 24, SHEET = (SIDE + 1) * (SIDE + 1), VERTICES = 2 * SHEET, TRIANGLES = 4 * SIDE * SIDE };

static double positions[2][VERTICES][3];
static uint32_t triangles[TRIANGLES][3];

static void make_sheets(void) {
    uint32_t t = 0;
    for (uint32_t sheet = 0; sheet < 2; sheet++)
        for (uint32_t i = 0; i <= SIDE; i++)
            for (uint32_t j = 0; j <= SIDE; j++) {
                const uint32_t v = sheet * SHEET + i * (SIDE + 1) + j;
                const double ripple = 0.05 * ((i * 7 + j * 5 + sheet * 3) % 11);
                const double at[3] = {i + 0.3 * sheet, ripple + 1.5 * sheet, j + 0.2 * sheet};
                for (int axis = 0; axis < 3; axis++) positions[0][v][axis] = positions[1][v][axis] = at[axis];
                positions[1][v][1] -= 3.0 * sheet;
                if (i == SIDE || j == SIDE) continue;
                const uint32_t corners[2][3] = {{v, v + 1, v + SIDE + 1},
                                                {v + 1, v + SIDE + 2, v + SIDE + 1}};
                memcpy(triangles[t], corners, sizeof corners);
                t += 2;
            }
}

static void print_number(double number) {
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    printf(" %016" PRIx64, bits);
}

static void step_sheets(void) {
    char reason[200] = "";
    void *host = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    make_sheets();
    expect_ok("cscdpy_host_create", CALL(cscd_status, "cscdpy_host_create",
                                         (uint32_t, uint32_t, void *, void *, char *, size_t, void **))(
                                        2, CSCD_SIMD_AUTO, NULL, NULL, reason, sizeof reason, &host));
    const cscd_object_desc object = cscd_object_of_triangles(VERTICES, TRIANGLES, &triangles[0][0]);
    expect_ok("cscdpy_mesh_create",
              CALL(cscd_status, "cscdpy_mesh_create",
                   (void *, const cscd_object_desc *, uint32_t, cscd_mesh **))(host, &object, 1, &mesh));
    cscd_detector_options options;
    CALL(void, "cscd_detector_defaults_sized", (void *, size_t))(&options, sizeof options);
    expect_ok("cscdpy_detector_create",
              CALL(cscd_status, "cscdpy_detector_create",
                   (void *, const cscd_mesh *, const cscd_plan *, const cscd_detector_options *,
                    cscd_detector **))(host, mesh, NULL, &options, &detector));
    cscd_contacts contacts;
    expect_ok("cscdpy_detector_step",
              CALL(cscd_status, "cscdpy_detector_step",
                   (void *, cscd_detector *, const cscd_view *, const cscd_view *, cscd_contacts *))(
                  host, detector, CSCD_DOUBLES(&positions[0][0][0], VERTICES),
                  CSCD_DOUBLES(&positions[1][0][0], VERTICES), &contacts));
    printf("%zu contacts\n", contacts.count);
    for (size_t i = 0; i < contacts.count; i++) {
        const cscd_contact *c = &contacts.items[i];
        printf("%d %u %u", (int)c->kind, c->a, c->b);
        const double numbers[] = {c->toi,      c->u,         c->v,         c->point[0], c->point[1],
                                  c->point[2], c->normal[0], c->normal[1], c->normal[2]};
        for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) print_number(numbers[n]);
        printf("\n");
    }
    CALL(void, "cscd_detector_destroy", (cscd_detector *))(detector);
    CALL(void, "cscd_mesh_destroy", (cscd_mesh *))(mesh);
    CALL(void, "cscdpy_host_release", (void *))(host);
    if (given_back == 0 || taken != given_back) {
        fprintf(stderr, "call_library: the lock was given back %d times and taken %d times\n", given_back,
                taken);
        exit(3);
    }
}

int main(int count, char **arguments) {
    if (count < 3) {
        fprintf(stderr, "usage: call_library LIBRARY NAMES [ARGUMENT...]\n");
        return 2;
    }
#ifdef _WIN32
    _setmode(1, _O_BINARY); /* the same bytes as elsewhere */
#endif
    library = load_library(arguments[1]);
    if (library == NULL) {
        fprintf(stderr, "call_library: %s cannot be loaded\n", arguments[1]);
        return 3;
    }
    fprintf(stderr, "%u functions\n", find_names(arguments[2]));
    void *const python[] = {(void *)(uintptr_t)save_thread,     (void *)(uintptr_t)restore_thread,
                            (void *)(uintptr_t)check_signals,   (void *)(uintptr_t)is_never_called,
                            (void *)(uintptr_t)is_never_called, (void *)(uintptr_t)is_never_called,
                            (void *)(uintptr_t)is_never_called, (void *)(uintptr_t)is_never_called};
    if (!CALL(bool, "cscdpy_set_interpreter", (void *const *, size_t))(python,
                                                                       sizeof python / sizeof *python)) {
        fprintf(stderr, "call_library: the library wants another number of Python's functions\n");
        return 3;
    }
    step_sheets();
    fflush(stdout);
    if (count == 3) return 0;
    arguments[2] = "cscd";
    return CALL(int, "cscdpy_run_tool", (int, char **))(count - 2, arguments + 2);
}
