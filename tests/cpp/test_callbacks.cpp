/* Callbacks that throw: the same exception object arrives, nothing was written, and the context works on. */
#include "tests/cpp/twin_detectors.hpp"

#include <atomic>
#include <thread>

namespace {

/* Counts its copies, so that a test can tell the object. */
struct thrown_object {
    static inline int made = 0;
    int number;
    thrown_object() : number(++made) {
    }
    thrown_object(const thrown_object &) = default;
};

enum source { ALLOCATE, PARALLEL_FOR, PROGRESS, IGNORE, SOURCES };

/* The host throws in one call of one callback. */
struct throwing_host {
    source from;
    std::atomic<unsigned> calls{0};
    unsigned at = 0; /* counted from 1; 0: never */
    const thrown_object *thrown = nullptr;

    explicit throwing_host(source of) : from(of) {
    }
    void reach(source here) {
        if (here != from || ++calls != at) return;
        try {
            throw thrown_object();
        } catch (const thrown_object &object) {
            thrown = &object;
            throw;
        }
    }
    cscd::context_options options(std::uint32_t threads) {
        cscd::context_options o;
        o.thread_count = threads;
        o.allocate = [this](std::size_t size, std::size_t alignment) {
            reach(ALLOCATE);
            return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
        };
        o.release = [](void *block, std::size_t) { std::free(block); };
        o.progress = [this](const char *, double) {
            reach(PROGRESS);
            return true;
        };
        if (from == PARALLEL_FOR) {
            o.parallel_for = [this](std::uint32_t count, cscd::task task) {
                for (std::uint32_t i = 0; i < count; i++) {
                    if (i == count / 2) reach(PARALLEL_FOR);
                    task(i);
                }
            };
        }
        return o;
    }
    cscd::detector_options detector_options() {
        cscd::detector_options o;
        o.ignore_if = [this](cscd_contact_kind, std::uint32_t, std::uint32_t) {
            reach(IGNORE);
            return false;
        };
        return o;
    }
};

/* Calls until the callback is asked no more; returns how often it has thrown. after: what must hold then. */
template <class Call, class After>
unsigned throw_everywhere(throwing_host &host, Call &&call, After &&after) {
    unsigned throws = 0;
    for (unsigned at = 1;; at += 1 + PACED(at / 4, at)) {
        host.calls = 0;
        host.at = at;
        bool arrived = false;
        try {
            call();
        } catch (const thrown_object &object) {
            arrived = true;
            assert_ptr_equal(&object, host.thrown);
            assert_int_equal(object.number, thrown_object::made);
        }
        assert_int_equal(arrived, host.calls >= at);
        host.at = 0;
        after();
        if (!arrived) return throws;
        throws++;
    }
}

/* ---- every callback, in the calls of a solver ------------------------------------------------------------ */

unsigned throw_from(source from, std::uint32_t threads) {
    const panel_scene scene(PACED(16, 10));
    throwing_host host(from);
    const cscd::context context(host.options(threads));
    const cscd::mesh mesh(context, scene.objects());
    const std::vector<particle> end = scene.moved();
    const cscd_view x0 = cscd::view_of(scene.particles, &particle::position);
    const cscd_view x1 = cscd::view_of(end, &particle::position);
    const std::vector<particle> untouched(end.size(), particle{});
    unsigned throws = 0;

    cscd::detector known(context, mesh);
    const cscd::contacts list = known.step(x0, x1);
    const std::vector<cscd_contact> expected(list.begin(), list.end());
    const double fraction = known.max_step(x0, x1).fraction;
    assert_true(expected.size() > 100 && fraction > 0.0 && fraction < 1.0);

    throws += throw_everywhere(
        host, [&] { cscd::detector(context, mesh, host.detector_options()).step(x0, x1); },
        [&] {
            cscd::detector again(context, mesh, host.detector_options());
            assert_true(same_contacts(again.step(x0, x1), expected));
        });
    cscd::detector detector(context, mesh, host.detector_options());
    std::vector<particle> reached = untouched;
    throws += throw_everywhere(
        host,
        [&] {
            reached = untouched;
            detector.max_step(x0, x1, cscd::view_of(reached, &particle::position));
            reached = untouched;
        },
        [&] {
            assert_memory_equal(reached.data(), untouched.data(), reached.size() * sizeof(particle));
            assert_true(detector.max_step(x0, x1).fraction == fraction);
        });
    cscd::line_search search(detector);
    throws += throw_everywhere(
        host,
        [&] {
            search.begin(x0, x1, 0.5);
            search.find_near(0.5, 0.5);
        },
        [&] {
            search.begin(x0, x1);
            assert_true(search.max_step().fraction == fraction);
        });
    throws += throw_everywhere(
        host, [&] { detector.check(x0); }, [&] { assert_true(detector.check(x0).empty()); });
    return throws;
}

TEST(exceptions_arrive) {
    for (std::uint32_t threads = 1; threads <= 3; threads += 2) {
        assert_true(throw_from(ALLOCATE, threads) > 10);
        assert_true(throw_from(IGNORE, threads) > 10);
        if (threads > 1) assert_true(throw_from(PARALLEL_FOR, threads) > 4);
    }
}

/* Progress is asked every few milliseconds alone, so here the host is slow. */
TEST(progress_throws) {
    const panel_scene scene(30);
    throwing_host host(PROGRESS);
    cscd::context_options options = host.options(2);
    const cscd::context context(options);
    const cscd::mesh mesh(context, scene.objects());
    cscd::detector_options slow;
    slow.ignore_if = [](cscd_contact_kind, std::uint32_t, std::uint32_t) {
        std::this_thread::sleep_for(std::chrono::microseconds(20));
        return false;
    };
    const std::vector<float> x0 = packed(scene.particles), x1 = packed(scene.moved());
    cscd::detector detector(context, mesh, slow);
    const std::size_t count = detector.step(x0, x1).size();
    const unsigned throws = throw_everywhere(
        host, [&] { detector.max_step(x0, x1); },
        [&] { assert_int_equal(detector.step(x0, x1).size(), count); });
    assert_true(throws > 0);
}

/* ---- creation, nesting, threads --------------------------------------------------------------------------- */

/* Nothing can be caught by C code in a context that does not exist yet; and everything is freed. */
TEST(creation_throws) {
    const panel_scene scene(8);
    std::size_t live = 0;
    unsigned left = 0, tries = 0;
    for (bool made = false; !made; tries++) {
        left = tries;
        cscd::context_options o;
        o.thread_count = 2;
        o.allocate = [&](std::size_t size, std::size_t alignment) {
            if (left-- == 0) throw thrown_object();
            live++;
            return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
        };
        o.release = [&](void *block, std::size_t) {
            live--;
            std::free(block);
        };
        try {
            const cscd::context context(o);
            const cscd::mesh mesh(context, scene.objects());
            const cscd::detector detector(context, mesh);
            made = true;
        } catch (const thrown_object &) {
        }
        assert_int_equal(live, 0);
    }
    assert_true(tries > 20);
}

/* A callback that calls its own detector is refused, and what it throws then arrives; another context is free. */
TEST(nested_calls) {
    const panel_scene scene(PACED(12, 4));
    const std::vector<particle> end = scene.moved();
    const cscd_view x0 = cscd::view_of(scene.particles, &particle::position);
    const cscd_view x1 = cscd::view_of(end, &particle::position);
    const cscd::context context, other;
    const cscd::mesh mesh(context, scene.objects());
    cscd::detector inner(other, mesh);
    const std::size_t count = inner.step(x0, x1).size();
    cscd::detector *outer = nullptr;
    bool own = true;
    cscd::detector_options options;
    options.ignore_if = [&](cscd_contact_kind, std::uint32_t, std::uint32_t) {
        assert_int_equal(inner.step(x0, x1).size(), count);
        if (own) outer->step(x0, x1);
        return false;
    };
    cscd::detector detector(context, mesh, options);
    outer = &detector;
    try {
        detector.step(x0, x1);
        fail();
    } catch (const cscd::error &refused) {
        assert_int_equal(refused.status(), CSCD_BUSY);
        assert_string_equal(refused.what(), cscd_status_string(CSCD_BUSY));
    }
    own = false;
    assert_int_equal(detector.step(x0, x1).size(), count);
}

/* The allocator throws in a task, and the loop afterwards: the first exception arrives, and not in the call of another
 * thread, which is refused. */
TEST(first_exception_arrives) {
    const panel_scene scene(30);
    const std::vector<float> x0 = packed(scene.particles), x1 = packed(scene.moved());
    bool in_tasks = false, thrown = false, armed = false;
    cscd_status refusal = CSCD_OK;
    std::unique_ptr<cscd::detector> second;
    cscd::context_options options;
    options.thread_count = 3;
    options.allocate = [&](std::size_t size, std::size_t alignment) {
        if (in_tasks && !std::exchange(thrown, true)) throw thrown_object();
        return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    };
    options.release = [](void *block, std::size_t) { std::free(block); };
    options.parallel_for = [&](std::uint32_t count, cscd::task task) {
        in_tasks = armed;
        for (std::uint32_t i = 0; i < count; i++) task(i);
        in_tasks = false;
        if (!thrown) return;
        std::thread([&] { refusal = error_of([&] { second->step(x0, x1); }).status(); }).join();
        throw 7;
    };
    const cscd::context context(options);
    const cscd::mesh mesh(context, scene.objects());
    second = std::make_unique<cscd::detector>(context, mesh);
    cscd::detector detector(context, mesh);
    armed = true;
    bool arrived = false;
    try {
        detector.step(x0, x1);
    } catch (const thrown_object &) {
        arrived = true;
    }
    assert_true(thrown && arrived);
    assert_int_equal(refusal, CSCD_BUSY);
    armed = thrown = false;
    assert_int_equal(detector.step(x0, x1).size(), second->step(x0, x1).size());
}

/* cancel() of another thread ends a call by an error. */
TEST(threads_cancel) {
    const panel_scene scene(12);
    const std::vector<float> x0 = packed(scene.particles), x1 = packed(scene.moved());
    const cscd::context context;
    const cscd::mesh mesh(context, scene.objects());
    cscd::detector_options options;
    bool cancels = true;
    options.ignore_if = [&](cscd_contact_kind, std::uint32_t, std::uint32_t) {
        if (cancels) std::thread([&] { context.cancel(); }).join();
        return false;
    };
    cscd::detector detector(context, mesh, options);
    try {
        detector.step(x0, x1);
        fail();
    } catch (const cscd::error &cancelled) {
        assert_int_equal(cancelled.status(), CSCD_CANCELLED);
    }
    cancels = false;
    assert_true(detector.step(x0, x1).size() > 0);
}

/* ---- lifetimes ------------------------------------------------------------------------------------------- */

/* Callbacks live as long as something may call them, in whatever order objects go. */
TEST(callbacks_outlive_their_context) {
    const panel_scene scene(12);
    const std::vector<float> x0 = packed(scene.particles), x1 = packed(scene.moved());
    auto live = std::make_shared<std::atomic<std::size_t>>(0);
    for (int order = 0; order < 6; order++) {
        cscd::context_options o;
        o.allocate = [live](std::size_t size, std::size_t alignment) {
            ++*live;
            return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
        };
        o.release = [live](void *block, std::size_t) {
            --*live;
            std::free(block);
        };
        auto context = std::make_unique<cscd::context>(o);
        auto other = std::make_unique<cscd::context>();
        auto mesh = std::make_unique<cscd::mesh>(*context, scene.objects());
        cscd::detector_options options;
        options.ignore_if = [live](cscd_contact_kind, std::uint32_t, std::uint32_t) { return *live == 0; };
        auto detector = std::make_unique<cscd::detector>(order % 2 ? *other : *context, *mesh, options);
        auto search = std::make_unique<cscd::line_search>(*detector);
        o = {};
        options = {};
        const auto forget = [&](int which) {
            if (which == 0) context.reset();
            if (which == 1) mesh.reset();
            if (which == 2) detector.reset();
        };
        for (int i = 0; i < 3; i++) forget((order + i * (order < 3 ? 1 : 2)) % 3);
        search->begin(x0, x1);
        assert_true(search->max_step().fraction < 1.0);
        search.reset();
        other.reset();
        assert_int_equal(*live, 0);
        assert_int_equal(live.use_count(), 1);
    }
}

} // namespace
