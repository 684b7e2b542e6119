/* Changes of curves in the C++ interface against the function of C: by change and by contact. */
#include "tests/cpp/twin_detectors.hpp"

namespace {

/* The panels after half of their way, the second one bent so that it crosses the first one. */
std::vector<float> half_of_the_way(const twins &t) {
    std::vector<float> x = t.x0;
    for (std::size_t i = 2; i < x.size(); i += 3) x[i] = 0.5f * (t.x0[i] + t.x1[i]);
    for (std::size_t i = x.size() / 2 + 2; i < x.size(); i += 3) x[i] -= 0.1f * float(i % 7);
    return x;
}

TEST(compare_with_c) {
    twins t;
    const std::vector<float> x1 = half_of_the_way(t);
    const cscd_view v1 = cscd::view_of(x1);
    cscd_contacts touching;
    cscd_curve_changes expected;
    assert_int_equal(cscd_detector_step(t.c, &t.v0, &v1, &touching), CSCD_OK);
    assert_int_equal(cscd_detector_curve_changes(t.c, &t.v0, &v1, touching.items, touching.count, &expected),
                     CSCD_OK);
    const cscd::contacts contacts = t.ours.step(t.x0, x1);
    const cscd::curve_changes found = t.ours.find_curve_changes(t.x0, x1, {contacts.data(), contacts.size()});
    assert_true(found.size() == expected.count && found.size() > 10);
    assert_memory_equal(found.data(), expected.items, expected.count * sizeof *expected.items);
    std::size_t listed = 0;
    for (std::size_t i = 0; i < contacts.size(); i++) {
        for (std::size_t change : cscd::changes_of_contact(found, i)) {
            std::size_t times = 0;
            for (std::size_t cause : cscd::causes(found, found[change])) times += cause == i;
            assert_int_equal(times, 1);
            listed++;
        }
    }
    assert_int_equal(listed, expected.cause_count);
}

TEST(what_is_refused) {
    twins t;
    cscd_contact none = {};
    none.kind = CSCD_CONTACT_TT;
    assert_int_equal(error_of([&] {
                         t.ours.find_curve_changes(t.x0, t.x1, {&none, 1});
                     }).status(),
                     CSCD_INVALID_ARGUMENT);
    assert_true(t.ours.find_curve_changes(t.x0, t.x1, {}).empty());
}

} // namespace
