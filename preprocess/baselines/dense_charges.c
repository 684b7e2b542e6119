/* The equations of the charge by a dense system, which libcscd-baselines solves: what it asks of us, and we of it. */
#include "preprocess/baselines/baselines.h"

#include "preprocess/baselines/dense/dense.h"
#include "src/core/baseline_library.h"

static void *allocate_block(void *context, size_t size) {
    void *block = context_allocate(context, size, 1);
    if (block == NULL) context_out_of_memory(context);
    return block;
}

static void release_block(void *context, void *block) {
    context_free(context, block);
}

static void run_tasks(void *context, uint32_t task_count, parallel_task *task, void *data) {
    parallel_run(((cscd_context *)context)->threads, task_count, task, data);
}

static void enter_stage(void *context, const char *name, double begin, double end) {
    progress_stage(&((cscd_context *)context)->progress, name, begin, end);
}

static bool go_on(void *context, double share) {
    return progress_go_on(&((cscd_context *)context)->progress, share);
}

static cscd_status progress_status(void *context) {
    return context_progress_status(context);
}

static void explain_failure(void *context, cscd_status status, const char *sentence) {
    context_fail(context, status, "%s", sentence);
}

static size_t dense_memory(const void *functions, uint32_t count) {
    return ((const dense_functions *)functions)->memory(count);
}

static cscd_status solve_dense(const void *functions, cscd_context *context, const charge_system *system,
                               charge_timings *timings) {
    const dense_host host = {context,         allocate_block,  release_block,
                             run_tasks,       enter_stage,     go_on,
                             progress_status, explain_failure, parallel_thread_count(context->threads)};
    return ((const dense_functions *)functions)->solve(&host, system, timings);
}

static charge_kernels dense_kernels(const void *functions) {
    return ((const dense_functions *)functions)->kernels();
}

/* An entry takes some 10 ns, and a multiplication of the factors a fiftieth of one. */
static double dense_work(double count) {
    return 10.0 * count * count + count * count * count / 150.0;
}

cscd_status dense_charges_find(cscd_context *context, charge_solution *out) {
    const void *functions;
    const cscd_status status = baseline_library_find(
        context, DENSE_ENTRY, DENSE_INTERFACE,
        "charge: the dense solver (the tree, which is the default, does without)", &functions);
    if (status == CSCD_OK)
        *out = (charge_solution){functions, dense_memory, solve_dense, dense_kernels, dense_work};
    return status;
}
