/* Events in C++ are those of C, from one tracker and from two chunks. */
#include "tests/cpp/twin_detectors.hpp"

#include <vector>

namespace {

constexpr std::uint64_t FRAMES = 6;

/* The panels go through each other, frame by frame; add says what becomes of each. */
template <class Add> void follow(twins &t, Add &&add) {
    std::vector<float> before = t.x0, x = t.x0;
    for (std::uint64_t f = 0; f < FRAMES; f++) {
        for (std::size_t i = 0; i < x.size(); i++)
            x[i] = t.x0[i] + static_cast<float>(f + 1) / FRAMES * (t.x1[i] - t.x0[i]);
        add(f, before, x);
        before = x;
    }
}

void add_frame(twins &t, cscd::event_tracker &to, std::uint64_t f, const std::vector<float> &before,
               const std::vector<float> &x) {
    const cscd::contacts contacts = t.ours.step(before, x);
    to.add_contacts({contacts.data(), contacts.size()});
    to.add_frame(f, t.ours.find_intersections(x));
}

void expect_events(const cscd::events &found, const cscd_events &expected) {
    assert_int_equal(found.size(), expected.count);
    assert_memory_equal(found.data(), expected.items, expected.count * sizeof *expected.items);
}

TEST(events) {
    twins t;
    cscd_event_tracker *c = nullptr;
    assert_int_equal(cscd_event_tracker_create(t.c_context.get(), t.mesh.get(), nullptr, &c), CSCD_OK);
    cscd::event_tracker whole(t.context, t.mesh), parts(t.context, t.mesh);
    follow(t, [&](std::uint64_t f, const std::vector<float> &before, const std::vector<float> &x) {
        cscd_contacts contacts;
        cscd_intersections pairs;
        const cscd_view from = cscd::view_of(std::as_const(before)), to = cscd::view_of(std::as_const(x));
        assert_int_equal(cscd_detector_step(t.c, &from, &to, &contacts), CSCD_OK);
        assert_int_equal(cscd_event_tracker_add_contacts(c, contacts.items, contacts.count), CSCD_OK);
        assert_int_equal(cscd_detector_find_intersections(t.c, &to, nullptr, &pairs), CSCD_OK);
        assert_int_equal(cscd_event_tracker_add_frame(c, f, &pairs), CSCD_OK);
        add_frame(t, whole, f, before, x);
        add_frame(t, parts, f, before, x);
    });
    cscd_events expected;
    assert_int_equal(cscd_event_tracker_finish(c, &expected), CSCD_OK);
    assert_true(expected.count > 0);
    const std::size_t taken = parts.take().size();
    assert_int_equal(taken + parts.finish().size(), expected.count);
    expect_events(whole.finish(), expected);
    cscd_event_tracker_destroy(c);
}

TEST(mistakes) {
    twins t;
    const std::vector<std::uint32_t> labels(t.mesh.triangle_count() - 1);
    const std::vector<std::array<std::uint32_t, 2>> seams{{0, UINT32_MAX}};
    cscd::event_options few, far;
    few.set_labels(labels, 1);
    far.set_seams(seams);
    const auto make = [&](const cscd::event_options &options) {
        return [&] { cscd::event_tracker(t.context, t.mesh, options); };
    };
    assert_int_equal(error_of(make(few)).status(), CSCD_INVALID_ARGUMENT);
    assert_int_equal(error_of(make(far)).status(), CSCD_INVALID_ARGUMENT);
    cscd::event_tracker tracker(t.context, t.mesh);
    tracker.add_frame(3);
    assert_int_equal(error_of([&] { tracker.add_frame(3); }).status(), CSCD_INVALID_ARGUMENT);
}

} // namespace
