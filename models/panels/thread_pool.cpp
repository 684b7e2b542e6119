/* A host's thread pool, as a program has one for its own work. */
#include "models/panels/thread_pool.hpp"

namespace panels {

thread_pool::thread_pool(unsigned thread_count) {
    for (unsigned i = 1; i < thread_count; i++) threads_.emplace_back([this] { work(); });
}

thread_pool::~thread_pool() {
    {
        std::lock_guard<std::mutex> hold(lock_);
        ends_ = true;
    }
    changed_.notify_all();
    for (std::thread &thread : threads_) thread.join();
}

/* Runs one task without the lock; false: there is none to be taken. */
bool thread_pool::run_next(std::unique_lock<std::mutex> &hold) {
    if (!task_ || next_ == count_) return false;
    const cscd::task task = *task_;
    const std::uint32_t index = next_++;
    running_++;
    hold.unlock();
    task(index);
    hold.lock();
    tasks_run_++;
    if (--running_ == 0 && next_ == count_) finished_.notify_one();
    return true;
}

void thread_pool::work() {
    std::unique_lock<std::mutex> hold(lock_);
    while (!ends_) {
        if (!run_next(hold)) changed_.wait(hold);
    }
}

void thread_pool::run(std::uint32_t count, cscd::task task) {
    std::unique_lock<std::mutex> hold(lock_);
    task_ = task;
    next_ = 0;
    count_ = count;
    changed_.notify_all();
    while (run_next(hold)) {
    }
    finished_.wait(hold, [this] { return running_ == 0; });
    task_.reset();
}

} // namespace panels
