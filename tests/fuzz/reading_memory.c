/* Counts what is allocated, by the hooks of the address sanitizer. */
#include "tests/fuzz/reading_memory.h"

#include <stdbool.h>

/* Programs without the sanitizer lack them. */
extern int __sanitizer_install_malloc_and_free_hooks(void (*allocated)(const volatile void *, size_t),
                                                     void (*freed)(const volatile void *))
    __attribute__((weak));
extern size_t __sanitizer_get_allocated_size(const volatile void *memory) __attribute__((weak));

/* Of the thread that reads. Blocks from before may be freed meanwhile. */
static _Thread_local bool counting;
static _Thread_local ptrdiff_t held, peak;

static void count_allocation(const volatile void *memory, size_t size) {
    (void)memory;
    if (!counting) return;
    held += (ptrdiff_t)size;
    if (held > peak) peak = held;
}

static void count_freeing(const volatile void *memory) {
    if (counting && memory != NULL) held -= (ptrdiff_t)__sanitizer_get_allocated_size(memory);
}

void reading_memory_begin(void) {
    static bool installed;
    if (!installed && __sanitizer_install_malloc_and_free_hooks != NULL)
        __sanitizer_install_malloc_and_free_hooks(count_allocation, count_freeing);
    installed = true;
    held = peak = 0;
    counting = true;
}

size_t reading_memory_peak(void) {
    counting = false;
    return (size_t)peak;
}
