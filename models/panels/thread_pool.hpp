/* A host's thread pool, as a program has one for its own work: cscd runs its tasks on it. */
#pragma once

#include <cscd/cscd.hpp>

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace panels {

class thread_pool {
  public:
    explicit thread_pool(unsigned thread_count);
    ~thread_pool();
    thread_pool(const thread_pool &) = delete;
    thread_pool &operator=(const thread_pool &) = delete;

    /* Calls task(i) for every i below count, on all threads and on this one, and returns when all have returned. */
    void run(std::uint32_t count, cscd::task task);

    std::uint64_t tasks_run() const {
        return tasks_run_;
    }

  private:
    void work();
    bool run_next(std::unique_lock<std::mutex> &hold);

    std::vector<std::thread> threads_;
    std::mutex lock_;
    std::condition_variable changed_, finished_;
    std::optional<cscd::task> task_; /* none: there is no work */
    std::uint32_t next_ = 0, count_ = 0, running_ = 0;
    std::uint64_t tasks_run_ = 0;
    bool ends_ = false;
};

} // namespace panels
