/* The context in C++, and its callbacks, which may throw. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_CONTEXT_HPP
#define CSCD_CONTEXT_HPP

#include <cscd/detector.h>
#include <cscd/error.hpp>

#include <atomic>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace cscd {

/* What a parallel loop calls once with each index, on any thread. It never throws. */
class task {
  public:
    task(void (*run)(void *data, std::uint32_t index), void *data) noexcept : run_(run), data_(data) {
    }
    void operator()(std::uint32_t index) const noexcept {
        run_(data_, index);
    }

  private:
    void (*run_)(void *data, std::uint32_t index);
    void *data_;
};

/* Options of a context; see cscd_context_options. Callbacks that are empty are not called. All but release may throw. */
struct context_options {
    std::uint32_t thread_count = 1;
    cscd_simd simd = CSCD_SIMD_AUTO;
    std::function<void(std::uint32_t task_count, task)> parallel_for;
    std::function<bool(const char *stage, double fraction)> progress;
    std::function<void *(std::size_t size, std::size_t alignment)> allocate;
    std::function<void(void *block, std::size_t size)> release; /* must not throw */
};

namespace detail {

/* What the library calls, and what that has thrown. It lives as long as the library may call it: until the context
 * gives its last block back, if the allocator is the host's, and else until the last object of the context here. */
class callbacks {
  public:
    explicit callbacks(context_options &&options) : options_(std::move(options)) {
    }

    void drop() noexcept {
        if (holders_.fetch_sub(1, std::memory_order_acq_rel) == 1) delete this;
    }

    cscd_context_options c_options() noexcept {
        cscd_context_options c = cscd_context_defaults();
        c.thread_count = options_.thread_count;
        c.simd = options_.simd;
        c.progress = {report, this};
        if (options_.parallel_for) c.parallel_for = {run_tasks, this};
        c.allocator = {options_.allocate ? allocate_block : nullptr,
                       options_.release ? release_block : nullptr, this};
        return c;
    }

    void set_context(cscd_context *context) noexcept {
        context_ = context;
    }

    /* Around each call. */
    void begin_call() noexcept {
        calls_.fetch_add(1);
    }
    void end_call() noexcept {
        calls_.fetch_sub(1);
    }

    /* After a call with this status. One that was refused because another is running leaves to that what was thrown. */
    void throw_kept(cscd_status status) {
        if (status == CSCD_BUSY || !thrown_.load()) return;
        std::exception_ptr first;
        {
            std::lock_guard<std::mutex> hold(lock_);
            first = std::exchange(first_, nullptr);
            thrown_ = false;
        }
        if (first) std::rethrow_exception(first);
    }

    /* Keeps the exception that is being handled, to be thrown again, and ends the call. One that C code has made
     * by itself is no place to catch. */
    void keep_exception() {
        if (calls_.load() == 0) throw;
        {
            std::lock_guard<std::mutex> hold(lock_);
            if (!first_) first_ = std::current_exception();
            thrown_ = true;
        }
        cscd_context_cancel(context_);
    }
    bool thrown() const noexcept {
        return thrown_.load(std::memory_order_relaxed);
    }

  private:
    ~callbacks() = default;

    static void run_tasks(void *user, std::uint32_t task_count, void (*run)(void *, std::uint32_t),
                          void *data) {
        auto *self = static_cast<callbacks *>(user);
        try {
            self->options_.parallel_for(task_count, task(run, data));
        } catch (...) {
            self->keep_exception();
        }
    }

    static bool report(void *user, const char *stage, double fraction) {
        auto *self = static_cast<callbacks *>(user);
        try {
            return !self->options_.progress || self->options_.progress(stage, fraction);
        } catch (...) {
            self->keep_exception();
        }
        return false;
    }

    static void *allocate_block(void *user, std::size_t size, std::size_t alignment) {
        auto *self = static_cast<callbacks *>(user);
        void *block = nullptr;
        try {
            block = self->options_.allocate(size, alignment);
        } catch (...) {
            self->keep_exception();
        }
        if (block != nullptr) self->holders_.fetch_add(1, std::memory_order_relaxed);
        return block;
    }

    static void release_block(void *user, void *block, std::size_t size) noexcept {
        auto *self = static_cast<callbacks *>(user);
        self->options_.release(block, size);
        self->drop();
    }

    context_options options_;
    std::atomic<std::size_t> holders_{1}; /* blocks, and the context_state */
    std::atomic<cscd_context *> context_{nullptr};
    std::atomic<int> calls_{0};
    std::atomic<bool> thrown_{false};
    std::mutex lock_; /* of first_ */
    std::exception_ptr first_;
};

/* The context for all objects made in it, so that each can read the sentence of its failures. */
class context_state {
  public:
    explicit context_state(context_options &&options) : callbacks_(new callbacks(std::move(options))) {
        try {
            create();
        } catch (...) {
            cscd_context_destroy(context_);
            callbacks_->drop();
            throw;
        }
    }
    ~context_state() {
        cscd_context_destroy(context_);
        callbacks_->drop();
    }
    context_state(const context_state &) = delete;
    context_state &operator=(const context_state &) = delete;

    cscd_context *get() const noexcept {
        return context_;
    }
    callbacks &host() noexcept {
        return *callbacks_;
    }

    /* The state whose call runs on this thread, for `ignore`. */
    static context_state *&current() noexcept {
        static thread_local context_state *state = nullptr;
        return state;
    }

    std::string sentence_of(cscd_status status) const {
        if (status == CSCD_NULL_OBJECT) return "an object that the call needs has been moved from";
        const char *sentence = status == CSCD_BUSY ? "" : cscd_context_detail(context_);
        return *sentence != '\0' ? sentence : cscd_status_string(status);
    }

  private:
    void create() {
        char reason[512] = "";
        cscd_context_options options = callbacks_->c_options();
        options.reason = reason;
        options.reason_size = sizeof reason;
        callbacks_->begin_call();
        cscd_status status = cscd_context_create(&options, &context_);
        callbacks_->end_call();
        callbacks_->throw_kept(status);
        if (status != CSCD_OK) throw error(status, *reason != '\0' ? reason : cscd_status_string(status));
        callbacks_->set_context(context_);
    }

    callbacks *callbacks_;
    cscd_context *context_ = nullptr;
};

using state_pointer = std::shared_ptr<context_state>;

/* A call that runs on this thread. */
class running_call {
  public:
    explicit running_call(context_state &state)
        : state_(state), outer_(std::exchange(context_state::current(), &state)) {
        state.host().begin_call();
    }
    ~running_call() {
        state_.host().end_call();
        context_state::current() = outer_;
    }
    running_call(const running_call &) = delete;
    running_call &operator=(const running_call &) = delete;

  private:
    context_state &state_;
    context_state *outer_;
};

/* Makes a call of C, and returns its status; what callbacks have thrown in it is thrown again. */
template <class Call> cscd_status try_call(const state_pointer &state, Call &&call) {
    if (!state) return CSCD_NULL_OBJECT;
    cscd_status status = CSCD_OK;
    {
        running_call running(*state);
        status = call();
    }
    state->host().throw_kept(status);
    return status;
}

[[noreturn]] inline void fail(const state_pointer &state, cscd_status status, std::size_t count = 0) {
    if (!state) throw error(CSCD_NULL_OBJECT, "an object that the call needs has been moved from");
    throw error(status, state->sentence_of(status), count);
}

/* The same, and every status but CSCD_OK is thrown. */
template <class Call> void make_call(const state_pointer &state, Call &&call) {
    cscd_status status = try_call(state, call);
    if (status != CSCD_OK) fail(state, status);
}

/* Owns an object of the library. */
template <class T, void (*destroy)(T *)> class owner {
  public:
    /* The object for functions of C; NULL after it was moved from. */
    T *get() const noexcept {
        return object_.get();
    }
    explicit operator bool() const noexcept {
        return object_ != nullptr;
    }

  protected:
    struct destroyer {
        void operator()(T *owned) const noexcept {
            destroy(owned);
        }
    };

    owner() = default;
    explicit owner(state_pointer state) : state_(std::move(state)) {
    }

    /* create: a call of C that writes the object to its argument. */
    template <class Create> void create(Create &&call) {
        make_call(state_, [&] {
            T *made = nullptr;
            cscd_status status = call(&made);
            object_.reset(made);
            return status;
        });
    }

    state_pointer state_;
    std::unique_ptr<T, destroyer> object_;
};

} // namespace detail

/* Allocator, threads, instruction set. Objects made in it keep it, so it may go before them. */
class context {
  public:
    explicit context(context_options options = {})
        : state_(std::make_shared<detail::context_state>(std::move(options))) {
    }
    context(context &&) noexcept = default;
    context &operator=(context &&) noexcept = default;

    cscd_context *get() const noexcept {
        return state_ ? state_->get() : nullptr;
    }
    explicit operator bool() const noexcept {
        return state_ != nullptr;
    }
    cscd_context_info info() const noexcept {
        return cscd_context_describe(get());
    }
    std::size_t memory_share() const noexcept {
        return cscd_context_memory_share(get());
    }
    /* Ends the call that is running, with CSCD_CANCELLED; from another thread. */
    void cancel() const noexcept {
        cscd_context_cancel(get());
    }

    /* For the other classes. */
    const detail::state_pointer &state() const noexcept {
        return state_;
    }

  private:
    detail::state_pointer state_;
};

} // namespace cscd

#endif
