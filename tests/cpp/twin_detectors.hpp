/* Two detectors of one mesh, of which one is asked in C++ and the other in C. */
#pragma once

#include "tests/cpp/panel_scene.hpp"
#include "tests/support/test.h"

#include <string>
#include <utility>

/* What a call throws. */
template <class Call> cscd::error error_of(Call &&call) {
    try {
        call();
    } catch (const cscd::error &thrown) {
        return thrown;
    }
    fail();
    return cscd::error(CSCD_OK, "");
}

struct twins {
    panel_scene scene{10};
    cscd::context context, c_context;
    cscd::mesh mesh{context, scene.objects()};
    std::vector<float> x0 = packed(scene.particles), x1 = packed(scene.moved());
    cscd_view v0 = cscd::view_of(std::as_const(x0)), v1 = cscd::view_of(std::as_const(x1));
    cscd::detector ours;
    cscd_detector *c = nullptr;

    explicit twins(const cscd::detector_options &options = {}) : ours(context, mesh, options) {
        assert_int_equal(cscd_detector_create(c_context.get(), mesh.get(), nullptr, &options, &c), CSCD_OK);
    }
    twins(const twins &) = delete;
    twins &operator=(const twins &) = delete;
    ~twins() {
        cscd_detector_destroy(c);
    }
    double first_time() {
        return ours.step(x0, x1)[0].toi;
    }
    std::size_t compare_steps() {
        cscd_contacts expected;
        assert_int_equal(cscd_detector_step(c, &v0, &v1, &expected), CSCD_OK);
        const cscd::contacts found = ours.step(x0, x1);
        assert_true(same_contacts(found, {expected.items, expected.count}));
        return found.size();
    }
};
