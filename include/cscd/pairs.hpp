/* Single pairs in C++. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_PAIRS_HPP
#define CSCD_PAIRS_HPP

#include <cscd/context.hpp>
#include <cscd/solver.h>
#include <cscd/view.hpp>

#include <vector>

namespace cscd {

/* Pairs of one kind: four points each, by their numbers below point_count. */
inline cscd_pairs pairs_of(cscd_contact_kind kind, std::uint32_t point_count,
                           span<const std::array<std::uint32_t, 4>> points) noexcept {
    return {kind, point_count, points.size(), points.empty() ? nullptr : points.data()->data()};
}

namespace detail {

template <class Result, class Call>
std::vector<Result> for_each_pair(const context &context, const cscd_pairs &pairs, Call &&call) {
    std::vector<Result> results(pairs.pair_count + 1);
    make_call(context.state(), [&] { return call(results.data()); });
    results.pop_back();
    return results;
}

} // namespace detail

/* Each pair in motion. */
inline std::vector<cscd_pair_contact> step_pairs(const context &context, const cscd_pairs &pairs,
                                                 const positions &x0, const positions &x1,
                                                 double min_separation = 0.0, double tolerance = 0.0) {
    const cscd_view *from = x0.covering(1), *to = x1.covering(1);
    return detail::for_each_pair<cscd_pair_contact>(context, pairs, [&](cscd_pair_contact *out) {
        return cscd_pairs_step(context.get(), &pairs, from, to, min_separation, tolerance, out);
    });
}

/* Each pair at rest. */
inline std::vector<cscd_pair_contact> check_pairs(const context &context, const cscd_pairs &pairs,
                                                  const positions &x, double min_separation = 0.0,
                                                  double tolerance = 0.0) {
    const cscd_view *at = x.covering(1);
    return detail::for_each_pair<cscd_pair_contact>(context, pairs, [&](cscd_pair_contact *out) {
        return cscd_pairs_step(context.get(), &pairs, at, nullptr, min_separation, tolerance, out);
    });
}

/* The nearest points of each pair at rest, as far as `distance`. */
inline std::vector<cscd_pair_distance> measure_pairs(const context &context, const cscd_pairs &pairs,
                                                     const positions &x, double distance) {
    const cscd_view *at = x.covering(1);
    return detail::for_each_pair<cscd_pair_distance>(context, pairs, [&](cscd_pair_distance *out) {
        return cscd_pairs_find_near(context.get(), &pairs, at, distance, out);
    });
}

} // namespace cscd

#endif
