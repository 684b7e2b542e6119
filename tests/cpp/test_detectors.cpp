/* Detectors and line searches of the C++ interface against the functions of C that they stand for. */
#include "cscd/research.h"
#include "tests/cpp/twin_detectors.hpp"

namespace {

TEST(steps) {
    twins t;
    assert_true(t.compare_steps() > 50);
    assert_ptr_equal(t.ours.mesh().get(), t.mesh.get());
    assert_int_equal(t.ours.guarantee(1).reason, cscd_detector_guarantee(t.c, 1).reason);
    assert_false(t.ours.collapsed(1));
    assert_int_equal(t.ours.counters().tests, cscd_detector_counters(t.c).tests);
    assert_true(t.ours.timings().total_ms > 0.0);
    cscd_intersections crossing;
    std::vector<float> between = t.x0;
    for (std::size_t i = 2; i < between.size(); i += 3) between[i] = 0.5f * (t.x0[i] + t.x1[i]);
    for (std::size_t i = between.size() / 2 + 2; i < between.size(); i += 3) between[i] -= 0.5f;
    const cscd_view x = cscd::view_of(std::as_const(between));
    assert_int_equal(cscd_detector_check(t.c, &x, &crossing), CSCD_OK);
    const cscd::intersections found = t.ours.check(between);
    assert_int_equal(found.count, crossing.count);
    assert_true(!found.empty() && found[0].a == crossing.items[0].a && found.data() == found.begin());
}

TEST(kinds) {
    twins t;
    cscd_intersection_options options = cscd_intersection_defaults();
    std::vector<double> lower(t.x0.begin(), t.x0.end());
    for (std::size_t i = lower.size() / 2 + 2; i < lower.size(); i += 3)
        lower[i] = lower[2] + 0.01 * double(i % 7);
    const cscd_view x = cscd::view_of(std::as_const(lower));
    for (std::size_t stop : {0u, 3u}) {
        cscd_intersections expected;
        options.stop_after = stop;
        assert_int_equal(cscd_detector_find_intersections(t.c, &x, &options, &expected), CSCD_OK);
        const cscd::intersections found = t.ours.find_intersections(lower, options);
        assert_true(found.size() == expected.count && found.size() > 2 &&
                    found.crossing == expected.crossing);
        std::size_t i = 0;
        for (const cscd_intersection &pair : found)
            assert_memory_equal(&pair, &expected.items[i++], sizeof pair);
    }
    const std::size_t all = t.ours.find_intersections(lower).size();
    options = cscd_intersection_defaults();
    options.overlaps = options.depths = true;
    const cscd::intersections answered = t.ours.find_intersections(lower, options);
    std::size_t pieces = 0, numbers = 0;
    for (const cscd_curve &curve : cscd::curves(answered)) {
        pieces += cscd::pieces(answered, curve).size();
        assert_int_equal(cscd::points(answered, curve).size(), curve.point_count);
    }
    for (const cscd_patch &patch : cscd::patches(answered)) numbers += cscd::windings(answered, patch).size();
    assert_true(pieces > 0 && pieces == answered.curves->piece_count);
    assert_int_equal(numbers, answered.patches->winding_count);
    assert_int_equal(cscd::overlaps(answered).size(), answered.overlaps->count);
    assert_int_equal(cscd::depths(answered).size(), answered.depths->count);
    options = cscd_intersection_defaults();
    options.answer = CSCD_ANSWER_COUNT;
    const cscd::intersections counted = t.ours.find_intersections(lower, options);
    assert_true(counted.size() == all && counted.begin() == counted.end());
    options.kinds = 0;
    assert_int_equal(error_of([&] { t.ours.find_intersections(lower, options); }).status(),
                     CSCD_INVALID_ARGUMENT);
}

/* The same labels, by component and by region, for both. */
TEST(parts) {
    twins t;
    cscd_intersection_options options = cscd_intersection_defaults();
    options.curves = options.parts = true;
    cscd::plan_options clusters;
    clusters.method = CSCD_METHOD_KMEANS;
    const cscd::plan plan(t.context, t.mesh, t.x0, clusters);
    const std::vector<std::uint32_t> regions = plan.region_labels(t.mesh.triangle_count());
    const std::vector<std::uint32_t> components = t.mesh.component_labels();
    for (std::uint32_t i = 0; i < t.mesh.triangle_count(); i++)
        assert_true(regions[i] == plan.triangle_region(i) && components[i] == t.mesh.triangle_component(i));
    for (int which = 0; which < 3; which++) {
        const std::vector<std::uint32_t> &labels = which == 1 ? components : regions;
        const std::uint32_t count = which == 1 ? t.mesh.component_count() : plan.region_count();
        which == 0 ? t.ours.set_parts() : t.ours.set_parts(labels, count);
        assert_int_equal(
            cscd_detector_set_parts(t.c, which == 0 ? nullptr : labels.data(), which == 0 ? 0 : count),
            CSCD_OK);
        std::vector<std::uint32_t> bodies(t.mesh.triangle_count());
        assert_int_equal(cscd_detector_body_labels(t.c, bodies.data()), cscd_mesh_object_count(t.mesh.get()));
        assert_true(t.ours.body_labels() == bodies);
        which == 0 ? t.ours.set_bodies() : t.ours.set_bodies(labels, count);
        assert_int_equal(
            cscd_detector_set_bodies(t.c, which == 0 ? nullptr : labels.data(), which == 0 ? 0 : count),
            CSCD_OK);
        cscd_detector_body_labels(t.c, bodies.data());
        assert_true(t.ours.body_labels() == bodies);
        cscd_contacts touching;
        cscd_contact_part_pairs sums;
        assert_int_equal(cscd_detector_step(t.c, &t.v0, &t.v1, &touching), CSCD_OK);
        assert_int_equal(cscd_detector_contact_parts(t.c, touching.items, touching.count, &sums), CSCD_OK);
        const cscd::contacts contacts = t.ours.step(t.x0, t.x1);
        const cscd::contact_part_pairs ours = t.ours.contact_parts({contacts.data(), contacts.size()});
        assert_true(ours.size() == sums.count && !ours.empty());
        assert_memory_equal(ours.data(), sums.items, sums.count * sizeof *sums.items);
        cscd_intersections expected;
        assert_int_equal(cscd_detector_find_intersections(t.c, &t.v1, &options, &expected), CSCD_OK);
        const cscd::intersections found = t.ours.find_intersections(t.x1, options);
        assert_int_equal(cscd::parts(found).size(), expected.parts->count);
        assert_memory_equal(cscd::parts(found).data(), expected.parts->items,
                            expected.parts->count * sizeof *expected.parts->items);
    }
    assert_true(cscd::parts(t.ours.find_intersections(t.x1)).empty());
    assert_int_equal(error_of([&] {
                         t.ours.set_parts({components.data(), 1}, 1);
                     }).status(),
                     CSCD_INVALID_ARGUMENT);
    assert_int_equal(error_of([&] {
                         t.ours.set_bodies({components.data(), 1}, 1);
                     }).status(),
                     CSCD_INVALID_ARGUMENT);
}

TEST(culling) {
    const cscd::context context;
    const cscd::mesh mesh(context, {cscd::object_of_triangles(8, body_triangles)});
    cscd::detector detector(context, mesh, cscd::plan(context, mesh, body_positions));
    std::vector<double> moved = body_positions;
    for (std::size_t i = 0; i < moved.size(); i += 3) moved[i] += 0.5;
    assert_true(detector.step(body_positions, moved).empty());
    double start[3], end[3];
    assert_true(cscd_detector_region_point(detector.get(), 0, start, end));
    assert_true(std::fabs(end[0] - start[0] - 0.5) < 1e-9 && start[1] == end[1]);
    assert_true(cscd_detector_orientation(detector.get(), 0) != 0);
}

TEST(proximity) {
    twins t;
    for (int form = CSCD_NEAR_PAIRS; form <= CSCD_NEAR_UNIQUE; form++) {
        cscd_proximities expected;
        for (int rest = 0; rest < 2; rest++) {
            if (rest == 1) t.ours.set_rest(t.x0);
            assert_int_equal(cscd_detector_set_rest(t.c, rest ? &t.v0 : nullptr), CSCD_OK);
            const cscd::proximities found = t.ours.find_near(t.x0, 1.2, static_cast<cscd_near_form>(form));
            assert_int_equal(
                cscd_detector_find_near(t.c, &t.v0, 1.2, static_cast<cscd_near_form>(form), &expected),
                CSCD_OK);
            assert_int_equal(found.size(), expected.count);
            assert_true(!found.empty());
            for (std::size_t i = 0; i < found.size(); i++) {
                assert_true(found[i].distance == expected.items[i].distance);
                assert_true(found[i].threshold == expected.items[i].threshold);
            }
        }
        t.ours.forget_rest();
    }
    const cscd::proximities found = t.ours.find_near(t.x0, 1.2);
    const cscd::stencils stencils = cscd::stencils_of(found);
    assert_int_equal(stencils.vertices.size(), 4 * found.size());
    for (std::size_t i = 0; i < found.size(); i++) {
        assert_int_equal(stencils.vertices[4 * i + 3], found[i].vertices[3]);
        assert_true(stencils.weights[4 * i + 1] == found[i].weights[1]);
    }
}

TEST(contact_stencils) {
    twins t;
    const cscd::contacts found = t.ours.step(t.x0, t.x1);
    const cscd::stencils stencils = cscd::stencils_of(found);
    for (std::size_t i = 0; i < found.size(); i++) {
        const cscd_stencil one =
            t.mesh.stencil(found[i].kind, found[i].a, found[i].b, found[i].u, found[i].v);
        assert_memory_equal(&stencils.vertices[4 * i], one.vertices, sizeof one.vertices);
        assert_memory_equal(&stencils.weights[4 * i], one.weights, sizeof one.weights);
    }
}

/* ---- what options leave out -------------------------------------------------------------------------------- */

TEST(options) {
    twins plain;
    const std::size_t all = plain.compare_steps();
    cscd::detector_options o;
    const std::vector<std::array<std::uint32_t, 2>> ignored{{0, 200}, {1, 201}, {2, 202}, {30, 190}};
    const std::vector<std::array<std::uint32_t, 2>> seams{{0, 100}, {55, 155}};
    o.set_ignored(ignored);
    o.set_seams(seams);
    o.seam_reach = HUGE_VAL;
    o.mode = CSCD_MODE_EARLIEST;
    twins left_out(o);
    assert_true(left_out.compare_steps() < all);
    o.ignore_if = [](cscd_contact_kind kind, std::uint32_t, std::uint32_t) {
        return kind == CSCD_CONTACT_EE;
    };
    cscd::detector without_edges(plain.context, plain.mesh, o);
    for (const cscd_contact &contact : without_edges.step(plain.x0, plain.x1))
        assert_int_equal(contact.kind, CSCD_CONTACT_VF);
}

/* Seams and ignored pairs come and go; what was sewn and touches waits. */
TEST(live_changes) {
    twins t;
    const std::size_t all = t.compare_steps();
    std::vector<std::array<std::uint32_t, 2>> ignored;
    const cscd_contact first = t.ours.step(t.x0, t.x1)[0];
    if (first.kind == CSCD_CONTACT_VF) {
        for (std::uint32_t triangle : t.mesh.vertex_triangles(first.a))
            ignored.push_back({triangle, first.b});
    } else {
        for (std::uint32_t triangle : t.mesh.edge_triangles(first.a))
            ignored.push_back({triangle, t.mesh.edge_triangles(first.b)[0]});
    }
    t.ours.set_ignored(ignored);
    assert_int_equal(cscd_detector_set_ignored(t.c, ignored[0].data(), ignored.size()), CSCD_OK);
    assert_true(t.compare_steps() < all);
    t.ours.set_ignored({});
    assert_int_equal(cscd_detector_set_ignored(t.c, nullptr, 0), CSCD_OK);
    assert_int_equal(t.compare_steps(), all);

    std::vector<std::array<std::uint32_t, 2>> seams;
    for (std::uint32_t v = 0; v < 100; v++) seams.push_back({v, 100 + v});
    std::copy(t.x0.begin(), t.x0.begin() + 300, t.x0.begin() + 300);
    t.ours.set_seams(seams);
    assert_true(t.ours.step(t.x0, t.x0).empty());
    t.ours.set_seams({});
    const cscd::contacts none = t.ours.step(t.x0, t.x0);
    assert_true(none.empty() && t.ours.waiting().features > 0);
    assert_true(t.ours.check(t.x0).empty() && t.ours.waiting().triangles > 0);
    const std::vector<std::array<std::uint32_t, 2>> wrong{{3, 3}};
    assert_int_equal(error_of([&] { t.ours.set_seams(wrong); }).status(), CSCD_INVALID_ARGUMENT);
}

TEST(rules) {
    std::vector<cscd_object_rule> rules(2, cscd_object_rule_default());
    cscd::detector_options o;
    o.set_rules(rules);
    twins t(o);
    t.compare_steps();
    const double touching = t.first_time();
    rules[0].mask = 0;
    t.ours.set_rules(rules);
    assert_int_equal(cscd_detector_set_rules(t.c, rules.data(), 2, nullptr, 0), CSCD_OK);
    assert_int_equal(t.compare_steps(), 0);
    rules[0] = cscd_object_rule_default();
    rules[1].thickness_class = 1;
    const std::vector<double> matrix{0.0, 0.1, 0.1, 0.0};
    t.ours.set_rules(rules, matrix);
    assert_int_equal(cscd_detector_set_rules(t.c, rules.data(), 2, matrix.data(), 2), CSCD_OK);
    t.compare_steps();
    assert_true(t.first_time() < touching);
    const std::vector<double> odd{0.0, 0.1, 0.1};
    assert_int_equal(error_of([&] { t.ours.set_rules(rules, odd); }).status(), CSCD_INVALID_ARGUMENT);
}

/* What is too long says how long it is. */
TEST(long_lists) {
    twins t;
    const std::size_t all = t.compare_steps(), near = t.ours.find_near(t.x0, 1.2, CSCD_NEAR_PAIRS).size();
    t.ours.set_longest_list(10);
    const cscd::error step = error_of([&] { t.ours.step(t.x0, t.x1); });
    assert_int_equal(step.status(), CSCD_LIST_TOO_LONG);
    assert_int_equal(step.count(), all);
    cscd::line_search search(t.ours);
    search.begin(t.x0, t.x1, 1.2);
    assert_int_equal(error_of([&] { search.find_near(0.0, 1.2, CSCD_NEAR_PAIRS); }).count(), near);
    std::vector<double> bounds(t.mesh.vertex_count());
    assert_true(error_of([&] { t.ours.displacement_bounds(t.x0, 1.2, bounds); }).count() > 10);
    assert_true(error_of([&] { t.ours.truncate(t.x0, t.x1, 1.2); }).count() > 10);
    t.ours.set_longest_list(0);
    assert_int_equal(t.ours.step(t.x0, t.x1).size(), all);
}

/* Only one vertex may move, then none, then all. */
TEST(active_vertices) {
    twins t;
    const std::size_t all = t.compare_steps();
    std::uint32_t one = 0;
    while (t.x1[3 * one + 2] == t.x0[3 * one + 2]) one++;
    const std::vector<std::uint32_t> alone{one};
    t.ours.set_active(alone);
    assert_int_equal(error_of([&] { t.ours.step(t.x0, t.x1); }).status(), CSCD_INVALID_ARGUMENT);
    std::vector<float> end = t.x0;
    end[3 * one + 2] = t.x1[3 * one + 2];
    t.ours.step(t.x0, end);
    t.ours.set_active(std::vector<std::uint32_t>{});
    assert_int_equal(error_of([&] { t.ours.step(t.x0, end); }).status(), CSCD_INVALID_ARGUMENT);
    assert_int_equal(t.ours.step(t.x0, t.x0).size(), 0);
    t.ours.set_active();
    assert_int_equal(t.ours.step(t.x0, t.x1).size(), all);
}

TEST(separation) {
    twins t;
    t.compare_steps();
    const double touching = t.first_time();
    t.ours.set_separation(0.05);
    assert_int_equal(cscd_detector_set_separation(t.c, 0.05, 0.0), CSCD_OK);
    t.compare_steps();
    assert_true(t.first_time() < touching);
    assert_int_equal(error_of([&] { t.ours.set_separation(-1.0); }).status(), CSCD_INVALID_ARGUMENT);
}

/* ---- motions ----------------------------------------------------------------------------------------------- */

TEST(motions) {
    twins t;
    std::vector<float> reached(t.x0.size()), expected(t.x0.size());
    const cscd_mutable_view out = cscd::view_of(expected);
    cscd_free_step step;
    assert_int_equal(cscd_detector_max_step(t.c, &t.v0, &t.v1, &out, &step), CSCD_OK);
    assert_true(t.ours.max_step(t.x0, t.x1).fraction > 0.0);
    assert_true(t.ours.max_step(t.x0, t.x1, reached).fraction == step.fraction);
    assert_true(reached == expected);
    cscd_truncation cut;
    assert_int_equal(cscd_detector_truncate(t.c, &t.v0, &t.v1, 1.0, &out, &cut), CSCD_OK);
    assert_int_equal(t.ours.truncate(t.x0, t.x1, 1.0, reached).shortened, cut.shortened);
    assert_true(reached == expected && cut.shortened > 0);
    assert_int_equal(t.ours.truncate(t.x0, t.x1, 1.0).shortened, cut.shortened);
    assert_int_equal(cscd::held_pairs(cut).size(), 0);
    cscd_safe_motion safe;
    assert_int_equal(cscd_detector_make_safe(t.c, &t.v0, &t.v1, nullptr, &out, &safe), CSCD_OK);
    assert_true(t.ours.make_safe(t.x0, t.x1, reached).mean_share == safe.mean_share);
    assert_true(reached == expected && safe.rounds > 1);
    assert_int_equal(cscd::held_pairs(safe).size(), 0);
}

TEST(untangling) {
    twins t;
    std::vector<float> reached(t.x0.size()), expected(t.x0.size());
    const cscd_mutable_view out = cscd::view_of(expected);
    cscd_untangled found;
    assert_int_equal(cscd_detector_untangle(t.c, &t.v1, nullptr, &out, &found), CSCD_OK);
    assert_true(t.ours.untangle(t.x1, reached).pairs_after == found.pairs_after);
    assert_true(reached == expected && found.moved == (found.pairs_before > 0));
}

TEST(lenses) {
    twins t;
    cscd_lenses found;
    assert_int_equal(cscd_detector_find_lenses(t.c, &t.v1, nullptr, &found), CSCD_OK);
    const cscd::lenses ours = t.ours.find_lenses(t.x1);
    assert_int_equal(ours.size(), found.count);
    assert_true(ours.thickness == found.thickness && ours.pairs == found.pairs);
    std::size_t points = 0;
    for (const cscd_lens &lens : ours) {
        for (const cscd_lens_point &point : cscd::points(ours, lens)) {
            assert_true(point.thickness <= lens.thickness);
            points++;
        }
    }
    assert_int_equal(points, found.point_count);
    assert_int_equal(cscd::points(ours).size(), points);
}

TEST(bounds) {
    twins t;
    std::vector<float> floats(t.mesh.vertex_count()), expected(floats.size());
    std::vector<double> doubles(floats.size());
    cscd_displacement_bounds found;
    assert_int_equal(cscd_detector_displacement_bounds(t.c, &t.v0, 1.0, CSCD_SCALAR_FLOAT, expected.data(),
                                                       expected.size() * sizeof(float), &found),
                     CSCD_OK);
    assert_int_equal(t.ours.displacement_bounds(t.x0, 1.0, floats).near_count, found.near_count);
    assert_true(floats == expected && found.near_count > 0);
    assert_int_equal(t.ours.displacement_bounds(t.x0, 1.0, doubles).limited, found.limited);
    assert_true(doubles[0] >= static_cast<double>(floats[0]) && doubles[0] > 0.0);
    t.ours.set_separation(1e9);
    const cscd_displacement_bounds none = t.ours.displacement_bounds(t.x0, 1.0, doubles);
    assert_true(cscd::blocked_pairs(none).size() == none.blocked_count && none.blocked_count > 0);
}

/* A start that touches: the error has the pair. */
TEST(touching_starts) {
    const cscd::context context;
    const cscd::mesh mesh(context, {cscd::object_of_triangles(8, body_triangles)});
    cscd::detector detector(context, mesh);
    std::vector<double> touching = body_positions, up = body_positions;
    touching[14] = 0.0;
    up[14] = 1.0;
    const cscd::error refused = error_of([&] { detector.max_step(touching, up); });
    assert_int_equal(refused.status(), CSCD_IN_CONTACT);
    assert_non_null(refused.contact());
    assert_int_equal(refused.contact()->kind, CSCD_CONTACT_VF);
    assert_int_equal(refused.contact()->a, 4);
    assert_int_equal(refused.count(), 0);
    const cscd::error other = error_of([&] { detector.set_separation(-1.0); });
    assert_null(other.contact());
}

TEST(line_searches) {
    twins t;
    cscd_line_search *c;
    cscd::line_search ours(t.ours);
    assert_int_equal(cscd_line_search_create(t.c, &c), CSCD_OK);
    assert_ptr_equal(ours.mesh().get(), t.mesh.get());
    ours.begin(t.x0, t.x1, 1.2);
    assert_int_equal(cscd_line_search_begin(c, &t.v0, &t.v1, 1.2), CSCD_OK);
    assert_int_equal(ours.candidate_count(), cscd_line_search_candidate_count(c));
    cscd_candidates pairs;
    assert_int_equal(cscd_line_search_candidates(c, &pairs), CSCD_OK);
    const cscd::candidates listed = ours.candidates();
    assert_int_equal(listed.size(), pairs.count);
    assert_true(listed.size() > 0 && listed.size() <= ours.candidate_count());
    assert_memory_equal(listed.data(), pairs.items, pairs.count * sizeof *pairs.items);
    std::vector<float> reached(t.x0.size()), expected(t.x0.size());
    const cscd_mutable_view out = cscd::view_of(expected);
    ours.positions(0.25, reached);
    assert_int_equal(cscd_line_search_positions(c, 0.25, &out), CSCD_OK);
    assert_true(reached == expected);
    cscd_free_step step;
    assert_int_equal(cscd_line_search_max_step(c, 0.75, &out, &step), CSCD_OK);
    assert_true(ours.max_step(0.75, reached).fraction == step.fraction && reached == expected);
    assert_true(ours.max_step().fraction <= 1.0);
    cscd_proximities near;
    assert_int_equal(cscd_line_search_find_near(c, 0.25, 1.0, CSCD_NEAR_UNIQUE, &near), CSCD_OK);
    assert_int_equal(ours.find_near(0.25, 1.0).size(), near.count);
    assert_true(near.count > 0);
    assert_int_equal(error_of([&] { ours.find_near(0.25, 2.0); }).status(), CSCD_INVALID_ARGUMENT);
    cscd_line_search_destroy(c);
}

/* ---- measures and tetrahedra ---------------------------------------------------------------------------- */

static void same_measures(const cscd::measures &found, const cscd_measures &expected) {
    assert_int_equal(found.size(), expected.count);
    assert_true(found.sum == expected.sum && found.unknown == expected.unknown);
    assert_int_equal(cscd::gradients(found).size(), expected.gradient_count);
    for (std::size_t i = 0; i < found.size(); i++)
        assert_int_equal(cscd::gradients(found, found[i]).size(), expected.items[i].gradient_count);
}

TEST(measures) {
    twins t;
    std::vector<float> lower = t.x0;
    for (std::size_t i = 2; i < lower.size() / 2; i += 3) lower[i] -= 0.4F;
    const cscd_view x = cscd::view_of(std::as_const(lower));
    cscd_measures expected;
    assert_int_equal(cscd_detector_curve_lengths(t.c, &x, nullptr, &expected), CSCD_OK);
    same_measures(t.ours.curve_lengths(lower), expected);
    assert_int_equal(cscd_detector_overlap_volumes(t.c, &x, nullptr, &expected), CSCD_OK);
    same_measures(t.ours.overlap_volumes(lower), expected);
    cscd_intersection_options options = cscd_intersection_defaults();
    options.stop_after = 1;
    assert_int_equal(error_of([&] { t.ours.curve_lengths(lower, options); }).status(), CSCD_INVALID_ARGUMENT);
}

TEST(surfaces_of_tetrahedra) {
    const cscd::context context;
    const std::vector<std::array<std::uint32_t, 4>> two = {{1, 2, 3, 4}, {1, 3, 2, 6}};
    const cscd::tet_surface surface(context, two, 7);
    assert_int_equal(surface.triangle_count(), 6);
    assert_int_equal(surface.vertex_count(), 5);
    assert_int_equal(surface.triangles().size(), 18);
    assert_int_equal(surface.vertices()[4], 6);
    assert_int_equal(surface.tetrahedra()[5], 1);
    const cscd::mesh mesh(context, {cscd::object_of_triangles(surface.vertex_count(), surface.triangles())});
    assert_true(mesh.component(0).closed_manifold);
    assert_int_equal(error_of([&] { cscd::tet_surface(context, two, 6); }).status(), CSCD_INVALID_MESH);
}

} // namespace
