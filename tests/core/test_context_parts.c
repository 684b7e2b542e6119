/* Memory and threads of a context: every byte is counted, no size overflows, and every task is run once. */
#include "src/core/context.h"
#include "src/core/system.h"
#include "tests/support/test.h"

#include <stdatomic.h>
#include <string.h>

static cscd_context *make_context(uint32_t threads) {
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context = NULL;
    options.thread_count = threads;
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    return context;
}

/* ---- memory -------------------------------------------------------------------------------------------- */

TEST(what_is_given_back_counts_no_more) {
    cscd_context *context = make_context(1);
    const size_t before = cscd_context_describe(context).bytes;
    void *one = context_allocate(context, 100, 8), *other = context_reserve(context, 3, 1);
    assert_true(one != NULL && other != NULL);
    assert_true(cscd_context_describe(context).bytes >= before + 803);
    uint8_t *grown = context_grow(context, one, 100, 200, 8);
    assert_non_null(grown);
    assert_true(cscd_context_describe(context).bytes >= before + 1603 &&
                cscd_context_describe(context).bytes < before + 2403);
    context_free(context, other);
    context_free(context, grown);
    assert_int_equal(cscd_context_describe(context).bytes, before);
    cscd_context_destroy(context);
}

/* Other processes take and give back memory meanwhile. */
TEST(the_share_of_memory_is_a_quarter_of_what_is_free) {
    cscd_context *context = make_context(1);
    const size_t before = system_memory_left() / 4, share = cscd_context_memory_share(context);
    assert_true(share > before / 2 && share / 2 < before);
    cscd_context_destroy(context);
}

/* There are no such arrays, whatever their sizes are once they have overflowed. */
TEST(sizes_do_not_overflow) {
    static const size_t sizes[] = {2, 8, 24, SIZE_MAX / 2, SIZE_MAX};
    cscd_context *context = make_context(1);
    const size_t before = cscd_context_describe(context).bytes;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const size_t wraps = SIZE_MAX / sizes[i] + 2;
        assert_null(context_allocate(context, wraps, sizes[i]));
        assert_null(context_reserve(context, wraps, sizes[i]));
        assert_null(context_allocate(context, sizes[i], wraps));
    }
    assert_int_equal(cscd_context_describe(context).bytes, before);
    cscd_context_destroy(context);
}

/* ---- threads ------------------------------------------------------------------------------------------- */

enum { TASKS_MOST = 300 };

static atomic_uint runs[TASKS_MOST];

static void count_run(void *data, uint32_t task) {
    (void)data;
    atomic_fetch_add(&runs[task], 1);
}

TEST(every_task_is_run_once) {
    for (uint32_t threads = 1; threads <= 7; threads++) {
        cscd_context *context = make_context(threads);
        for (uint32_t tasks = 0; tasks <= TASKS_MOST; tasks += tasks < 20 ? 1 : 35) {
            for (uint32_t i = 0; i < TASKS_MOST; i++) atomic_store(&runs[i], 0);
            parallel_run(context->threads, tasks, count_run, NULL);
            for (uint32_t i = 0; i < TASKS_MOST; i++) assert_int_equal(atomic_load(&runs[i]), i < tasks);
        }
        cscd_context_destroy(context);
    }
}
