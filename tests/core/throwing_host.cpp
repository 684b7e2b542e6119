/* C++ for tests in C: throws, catches, and has a pool of threads that passes on what its tasks throw. */
#include "tests/core/throwing_host.h"

#include <atomic>
#include <exception>
#include <stdexcept>
#include <thread>
#include <vector>

void throw_exception(void) {
    throw std::runtime_error("thrown by the host");
}

bool call_catching(void (*work)(void *data), void *data) {
    try {
        work(data);
    } catch (const std::exception &) {
        return true;
    }
    return false;
}

void run_on_pool(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index), void *data) {
    std::vector<std::exception_ptr> thrown(3);
    std::atomic<uint32_t> next(0);
    std::vector<std::thread> threads;
    for (std::exception_ptr &own : thrown) {
        threads.emplace_back([&] {
            for (uint32_t i; (i = next++) < task_count;) {
                try {
                    task(data, i);
                } catch (...) {
                    own = std::current_exception();
                }
            }
        });
    }
    for (std::thread &thread : threads) thread.join();
    for (const std::exception_ptr &own : thrown) {
        if (own && !*static_cast<bool *>(user)) std::rethrow_exception(own);
    }
}
