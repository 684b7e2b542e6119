/* The tool sees to it that OpenBLAS starts as it should: on one thread, and with kernels for the
 * processor. */
#include "tool/common/plans.h"

#include "cscd/cscd.h"
#include "tool/common/command.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define CORE_VARIABLE "OPENBLAS_CORETYPE"

/* Names of kernels, "" where there is nothing to say. */
typedef struct kernel_names {
    char used[64], better[64];
} kernel_names;

static void describe_plan(const cscd_plan *plan, kernel_names *out) {
    cscd_plan_info info = cscd_plan_describe(plan);
    if (info.charge_kernels == NULL || info.better_kernels == NULL) return;
    snprintf(out->used, sizeof out->used, "%s", info.charge_kernels);
    snprintf(out->better, sizeof out->better, "%s", info.better_kernels);
}

/* Makes the plan of a tetrahedron, which says with which kernels it was made. */
static kernel_names kernels_of_small_plan(void) {
    static const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    kernel_names names = {"", ""};
    cscd_context_options one_thread = cscd_context_defaults();
    cscd_plan_options options = cscd_plan_defaults();
    cscd_object_desc tetrahedron = cscd_object_of_triangles(4, 4, triangles);
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    one_thread.thread_count = 1;
    options.method = CSCD_METHOD_CHARGE;
    options.charge_solver = CSCD_CHARGE_DENSE;
    if (cscd_context_create(&one_thread, &context) == CSCD_OK &&
        cscd_mesh_create(context, &tetrahedron, 1, &mesh) == CSCD_OK &&
        cscd_plan_create(context, mesh, CSCD_DOUBLES(positions, 4), &options, &plan) == CSCD_OK)
        describe_plan(plan, &names);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return names;
}

/* Asks in a process of its own, in which OpenBLAS may choose badly. */
static bool ask_another_process(kernel_names *out) {
    int ends[2];
    if (pipe(ends) != 0) return false;
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        kernel_names names = kernels_of_small_plan();
        bool written = write(ends[1], &names, sizeof names) == (ssize_t)sizeof names;
        _exit(written ? EXIT_SUCCESS : EXIT_FAILURE);
    }
    close(ends[1]);
    ssize_t got = 0;
    while (child > 0 && (got = read(ends[0], out, sizeof *out)) < 0 && errno == EINTR) continue;
    close(ends[0]);
    while (child > 0 && waitpid(child, NULL, 0) < 0 && errno == EINTR) continue;
    return got == (ssize_t)sizeof *out;
}

/* Is there something to prepare? Once, in a process of our own. */
static bool to_prepare;

void blas_kernels_own_process(void) {
    to_prepare = true;
}

void blas_kernels_prepare(bool warns) {
    kernel_names names;
    if (!to_prepare) return;
    to_prepare = false;
    setenv("OPENBLAS_NUM_THREADS", "1", 0);
    bool chosen = getenv(CORE_VARIABLE) != NULL; /* by the user */
    if (chosen && !warns) return;
    if (!ask_another_process(&names) || names.better[0] == '\0') return;
    if (!chosen)
        setenv(CORE_VARIABLE, names.better, 1);
    else
        warn("OpenBLAS runs its kernels for %s, which are slow on this processor: with " CORE_VARIABLE
             "=%s it takes about a third of the time",
             names.used, names.better);
}
