/* Positions of C++ programs: every form gives the contacts of packed doubles, read and written in place. */
#include "tests/cpp/panel_scene.hpp"
#include "tests/support/test.h"

namespace {

/* A point as a library of vectors may have it: three floats behind functions. */
class eigen_like {
  public:
    using Scalar = float;
    float x() const {
        return c_[0];
    }
    float c_[3];
};

/* A point that only its owner can describe. */
struct own_point {
    double coordinates[4];
};

} // namespace

template <> struct cscd::scalar_of<own_point> { using type = double; };

namespace {

struct node {
    char name;
    double rest[3];
    eigen_like shown;
    std::array<double, 3> now;
    own_point next;
};

struct forms_scene {
    panel_scene panels{10};
    cscd::context context;
    cscd::mesh mesh{context, panels.objects()};
    cscd::detector detector{context, mesh};
    std::vector<double> x0, x1;
    std::vector<cscd_contact> expected;

    forms_scene() {
        for (float c : packed(panels.particles)) x0.push_back(static_cast<double>(c));
        for (float c : packed(panels.moved())) x1.push_back(static_cast<double>(c));
        const cscd::contacts found = detector.step(x0, x1);
        expected.assign(found.begin(), found.end());
        assert_true(expected.size() > 50);
    }
    std::size_t vertex_count() const {
        return x0.size() / 3;
    }
    void expect(const cscd::positions &from, const cscd::positions &to) {
        assert_true(same_contacts(detector.step(from, to), expected));
    }
};

/* ---- forms that are read ----------------------------------------------------------------------------------- */

TEST(packed_scalars) {
    forms_scene s;
    const std::vector<float> f0 = packed(s.panels.particles), f1 = packed(s.panels.moved());
    s.expect(f0, s.x1);
    s.expect(s.x0, f1);
    s.expect(cscd::span<const float>(f0), cscd::span<const double>(s.x1.data(), s.x1.size()));
    double array[600];
    assert_int_equal(std::size(array), s.x0.size());
    std::copy(s.x0.begin(), s.x0.end(), array);
    s.expect(array, s.x1);
}

TEST(points_and_members) {
    forms_scene s;
    const std::vector<particle> end = s.panels.moved();
    std::vector<vec3> points;
    std::vector<std::array<double, 3>> arrays;
    std::vector<node> nodes(s.vertex_count());
    for (std::size_t i = 0; i < s.vertex_count(); i++) {
        points.push_back(end[i].position);
        arrays.push_back({s.x0[3 * i], s.x0[3 * i + 1], s.x0[3 * i + 2]});
        for (std::size_t c = 0; c < 3; c++) {
            nodes[i].rest[c] = nodes[i].now[c] = s.x0[3 * i + c];
            nodes[i].shown.c_[c] = static_cast<float>(s.x0[3 * i + c]);
            nodes[i].next.coordinates[c] = s.x1[3 * i + c];
        }
    }
    s.expect(cscd::view_of(s.panels.particles, &particle::position), points);
    s.expect(arrays, cscd::view_of(end, &particle::position));
    s.expect(cscd::view_of(nodes, &node::rest), cscd::view_of(nodes, &node::next));
    s.expect(cscd::view_of(nodes, &node::now), points);
    s.expect(cscd::view_of(nodes, &node::shown), points);
}

/* A vector as Eigen has it. */
struct eigen_vector : std::vector<double> {
    using vector::vector;
    enum { IsRowMajor = 0, IsVectorAtCompileTime = 1, InnerStrideAtCompileTime = 1 };
};

TEST(vectors_of_eigen) {
    forms_scene s;
    const eigen_vector start(s.x0.begin(), s.x0.end());
    eigen_vector reached(start.size());
    std::vector<double> expected(start.size());
    s.expect(start, s.x1);
    s.detector.max_step(start, s.x1, reached);
    s.detector.max_step(s.x0, s.x1, expected);
    assert_true(std::equal(reached.begin(), reached.end(), expected.begin()));
}

TEST(columns) {
    forms_scene s;
    const std::size_t n = s.vertex_count();
    std::vector<float> matrix(3 * n);
    for (std::size_t i = 0; i < matrix.size(); i++) matrix[i % 3 * n + i / 3] = static_cast<float>(s.x0[i]);
    s.expect(cscd::view_of_columns(matrix), s.x1);
}

/* Objects in arrays of their own. */
TEST(several_views) {
    forms_scene s;
    const std::size_t half = s.x0.size() / 2;
    const std::vector<double> lower(s.x0.begin(), s.x0.begin() + static_cast<std::ptrdiff_t>(half));
    const std::vector<float> floats = packed(s.panels.particles);
    cscd_view first = cscd::view_of(lower);
    first.object_count = 1;
    const cscd_view rest = cscd::view_of(cscd::span<const float>(floats.data() + half, half));
    s.expect(std::array<cscd_view, 2>{first, rest}, s.x1);
    s.expect(std::vector<cscd_view>{first, rest}, s.x1);
}

/* ---- forms that are written -------------------------------------------------------------------------------- */

TEST(outputs) {
    forms_scene s;
    std::vector<double> expected(s.x0.size());
    const double fraction = s.detector.max_step(s.x0, s.x1, expected).fraction;
    assert_true(fraction > 0.0 && fraction < 1.0);
    std::vector<particle> particles = s.panels.particles;
    std::vector<float> floats(s.x0.size()), columns(s.x0.size());
    assert_true(s.detector.max_step(s.x0, s.x1, cscd::view_of(particles, &particle::position)).moved);
    s.detector.max_step(s.x0, s.x1, floats);
    s.detector.max_step(s.x0, s.x1, cscd::view_of_columns(columns));
    assert_true(packed(particles) == floats);
    for (std::size_t i = 0; i < floats.size(); i++) {
        assert_true(std::fabs(static_cast<double>(floats[i]) - expected[i]) < 1e-5);
        assert_true(columns[i % 3 * s.vertex_count() + i / 3] == floats[i]);
    }
    for (std::size_t i = 0; i < particles.size(); i++) assert_true(particles[i].mass == 1.0f);
    std::vector<double> in_place = s.x1;
    s.detector.max_step(s.x0, in_place, in_place);
    assert_true(in_place == expected);

    cscd_mutable_view lower = cscd::view_of(cscd::span<double>(in_place.data(), in_place.size() / 2));
    lower.object_count = 1;
    const cscd_mutable_view upper = cscd::view_of(cscd::span<float>(floats.data(), floats.size() / 2));
    s.detector.max_step(s.x0, s.x1, std::array<cscd_mutable_view, 2>{lower, upper});
    for (std::size_t i = 0; i < floats.size() / 2; i++) {
        assert_true(std::fabs(static_cast<double>(floats[i]) - expected[i + floats.size() / 2]) < 1e-5);
        assert_true(std::fabs(in_place[i] - expected[i]) < 1e-5);
    }
}

/* ---- mistakes -------------------------------------------------------------------------------------------- */

template <class Call> std::string sentence_of(Call &&call) {
    try {
        call();
    } catch (const cscd::error &refused) {
        assert_int_equal(refused.status(), CSCD_INVALID_ARGUMENT);
        return refused.what();
    }
    fail();
    return "";
}

TEST(mistakes) {
    forms_scene s;
    const std::vector<float> empty, half(s.x0.size() / 2);
    cscd_view first = cscd::view_of(s.x0);
    first.object_count = 1;
    const std::vector<cscd_view> none, one{first};
    assert_true(sentence_of([&] { s.detector.step(empty, s.x1); }).find("x0") != std::string::npos);
    assert_true(sentence_of([&] { s.detector.step(s.x0, half); }).find("x1") != std::string::npos);
    assert_string_equal(sentence_of([&] { s.detector.step(first, s.x1); }).c_str(),
                        "the views hold 1 of the mesh's 2 objects");
    assert_string_equal(sentence_of([&] { s.detector.step(one, s.x1); }).c_str(),
                        "the views hold 1 of the mesh's 2 objects");
    assert_string_equal(sentence_of([&] { s.detector.step(none, s.x1); }).c_str(), "there is no view");
    const std::vector<particle> no_particles;
    assert_true(cscd::view_of(no_particles, &particle::position).size == 0);
}

/* A constant container is no output. What cannot be positions is refused with a sentence: tests/install/test_headers.py. */
static_assert(!std::is_convertible_v<int, cscd::positions>);
static_assert(!std::is_convertible_v<const std::vector<double> &, cscd::mutable_positions>);
static_assert(std::is_convertible_v<std::vector<double> &, cscd::mutable_positions>);
static_assert(std::is_convertible_v<std::vector<eigen_like>, cscd::positions>);

} // namespace
