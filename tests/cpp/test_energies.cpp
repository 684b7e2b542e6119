/* Energies in C++ are those of C. */
#include "tests/cpp/twin_detectors.hpp"

#include <algorithm>
#include <vector>

namespace {

struct sums {
    std::vector<double> gradient, blocks, matrix;
    cscd_energy_targets targets{};

    sums(std::size_t vertices, std::size_t items, const cscd_energy_pattern &pattern)
        : gradient(3 * vertices), blocks(144 * items), matrix(9 * pattern.block_count) {
        targets.gradient = gradient.data();
        targets.blocks = blocks.data();
        targets.matrix = matrix.data();
        targets.pattern = &pattern;
        targets.project = true;
    }
    bool operator==(const sums &other) const {
        return gradient == other.gradient && blocks == other.blocks && matrix == other.matrix;
    }
};

bool same_pattern(const cscd_energy_pattern &a, const cscd_energy_pattern &b, std::size_t vertices) {
    return a.block_count == b.block_count && std::equal(a.rows, a.rows + vertices + 1, b.rows) &&
           std::equal(a.columns, a.columns + a.block_count, b.columns);
}

TEST(energies) {
    twins t;
    cscd_energy *c = nullptr;
    cscd::energy_options options(2.5, 7.0);
    options.law = CSCD_ENERGY_QUADRATIC;
    options.friction = 0.3;
    options.slip = 0.01;
    assert_int_equal(cscd_energy_create(t.c_context.get(), t.mesh.get(), &c), CSCD_OK);
    cscd::energy energy(t.context, t.mesh);
    const cscd::proximities near = t.ours.find_near(t.x0, options.reach);
    const cscd_proximities list{near.data(), near.size()};
    assert_true(near.size() > 0);

    cscd_energy_pattern pattern{};
    const cscd_energy_pattern made = energy.make_pattern(near);
    assert_int_equal(cscd_energy_make_pattern(c, &list, nullptr, &pattern), CSCD_OK);
    const std::size_t vertices = t.mesh.vertex_count();
    assert_true(same_pattern(made, pattern, vertices));

    sums expected(vertices, near.size(), pattern), found(vertices, near.size(), made);
    cscd_energy_sum sum{};
    assert_int_equal(cscd_energy_evaluate(c, &list, &t.v0, &options, &expected.targets, &sum), CSCD_OK);
    assert_true(energy.evaluate(near, t.x0, options, found.targets).value == sum.value && sum.value > 0.0);
    assert_true(found == expected);
    assert_true(energy.evaluate(near, t.x0, options).value == sum.value);

    assert_int_equal(cscd_energy_freeze_friction(c, &list, &t.v0, &options), CSCD_OK);
    energy.freeze_friction(near, t.x0, options);
    assert_int_equal(cscd_energy_evaluate_friction(c, &t.v0, &t.v1, &expected.targets, &sum), CSCD_OK);
    assert_true(energy.evaluate_friction(t.x0, t.x1, found.targets).value == sum.value && sum.value > 0.0);
    assert_true(found == expected);
    assert_true(same_pattern(energy.make_pattern({}, &made), energy.make_pattern({}), vertices));
    cscd_energy_destroy(c);
}

TEST(mistakes) {
    twins t;
    cscd::energy energy(t.context, t.mesh);
    const cscd::energy_options none;
    assert_int_equal(error_of([&] { energy.evaluate({}, t.x0, none); }).status(), CSCD_INVALID_ARGUMENT);
    cscd::energy moved(std::move(energy));
    assert_int_equal(error_of([&] { energy.make_pattern({}); }).status(), CSCD_NULL_OBJECT);
}

} // namespace
