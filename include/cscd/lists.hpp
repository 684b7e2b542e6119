/* Lists that the library gives out, as ranges. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_LISTS_HPP
#define CSCD_LISTS_HPP

#include <cscd/context.hpp>
#include <cscd/solver.h>
#include <cscd/surface.h>
#include <cscd/untangle.h>
#include <cscd/view.hpp>

#include <algorithm>
#include <vector>

/* UNIQUE and BEYOND together. */
inline constexpr cscd_near_form operator|(cscd_near_form a, cscd_near_form b) noexcept {
    return static_cast<cscd_near_form>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}

namespace cscd {

/* A list of the library with its items as a range. It belongs to the detector, and lives until the next call of
 * it or of one of its line searches. */
template <class List> struct list : List {
    using value_type = std::remove_cv_t<std::remove_pointer_t<decltype(List::items)>>;

    list() noexcept : List{} {
    }
    const value_type *data() const noexcept {
        return this->items;
    }
    const value_type *begin() const noexcept {
        return this->items;
    }
    /* Where only a number was asked for, there are no items. */
    const value_type *end() const noexcept {
        return this->items != nullptr ? this->items + this->count : nullptr;
    }
    std::size_t size() const noexcept {
        return this->count;
    }
    bool empty() const noexcept {
        return this->count == 0;
    }
    const value_type &operator[](std::size_t i) const noexcept {
        return this->items[i];
    }
};

using contacts = list<cscd_contacts>;
using intersections = list<cscd_intersections>;
using proximities = list<cscd_proximities>;
using contact_part_pairs = list<cscd_contact_part_pairs>;
using measures = list<cscd_measures>;
using candidates = list<cscd_candidates>;
using lenses = list<cscd_lenses>;

/* The gradient of one value, by ascending vertex; all of them. */
inline span<const cscd_vertex_gradient> gradients(const cscd_measures &found,
                                                  const cscd_measure &of) noexcept {
    return {found.gradients + of.first_gradient, of.gradient_count};
}
inline span<const cscd_vertex_gradient> gradients(const cscd_measures &found) noexcept {
    return {found.gradients, found.gradient_count};
}

/* The points of one lens, and of all. */
inline span<const cscd_lens_point> points(const cscd_lenses &found, const cscd_lens &of) noexcept {
    return {found.points + of.first_point, of.point_count};
}
inline span<const cscd_lens_point> points(const cscd_lenses &found) noexcept {
    return {found.points, found.point_count};
}

/* What cscd_detector_find_intersections finds beside pairs, where the options ask for it; else empty. */
inline span<const cscd_curve> curves(const cscd_intersections &found) noexcept {
    if (found.curves == nullptr) return {};
    return {found.curves->items, found.curves->count};
}
inline span<const cscd_curve_point> points(const cscd_intersections &found,
                                           const cscd_curve &curve) noexcept {
    return {found.curves->points + curve.first_point, curve.point_count};
}
inline span<const cscd_curve_piece> pieces(const cscd_intersections &found,
                                           const cscd_curve &curve) noexcept {
    return {found.curves->pieces + curve.first_piece, curve.piece_count};
}
inline span<const cscd_patch> patches(const cscd_intersections &found) noexcept {
    if (found.patches == nullptr) return {};
    return {found.patches->items, found.patches->count};
}
inline span<const cscd_winding> windings(const cscd_intersections &found, const cscd_patch &patch) noexcept {
    return {found.patches->windings + patch.first_winding, patch.winding_count};
}
inline span<const cscd_overlap> overlaps(const cscd_intersections &found) noexcept {
    if (found.overlaps == nullptr) return {};
    return {found.overlaps->items, found.overlaps->count};
}
inline span<const cscd_depth> depths(const cscd_intersections &found) noexcept {
    if (found.depths == nullptr) return {};
    return {found.depths->items, found.depths->count};
}
inline span<const cscd_cut_off> cut_offs(const cscd_intersections &found) noexcept {
    if (found.cut_offs == nullptr) return {};
    return {found.cut_offs->items, found.cut_offs->count};
}
inline span<const std::uint32_t> patches(const cscd_intersections &found,
                                         const cscd_cut_off &cut_off) noexcept {
    return {found.cut_offs->patches + cut_off.first_patch, cut_off.patch_count};
}
inline span<const cscd_part_pair> parts(const cscd_intersections &found) noexcept {
    if (found.parts == nullptr) return {};
    return {found.parts->items, found.parts->count};
}

/* The lists beside bounds, truncations and safe motions. */
inline span<const cscd_proximity> blocked_pairs(const cscd_displacement_bounds &bounds) noexcept {
    return {bounds.blocked, bounds.blocked_count};
}
inline span<const cscd_proximity> held_pairs(const cscd_truncation &truncation) noexcept {
    return {truncation.held, truncation.held_count};
}

inline span<const cscd_contact> held_pairs(const cscd_safe_motion &motion) noexcept {
    return {motion.held, motion.held_count};
}

/* ---- stencils ------------------------------------------------------------------------------------------- */

/* Four vertices, and as many weights, for each item of a list. */
struct stencils {
    std::vector<std::uint32_t> vertices;
    std::vector<double> weights;
};
inline stencils stencils_of(span<const cscd_contact> items) {
    stencils all{std::vector<std::uint32_t>(4 * items.size()), std::vector<double>(4 * items.size())};
    for (std::size_t i = 0; i < items.size(); i++) {
        std::copy_n(items[i].vertices, 4, &all.vertices[4 * i]);
        cscd_stencil_weights(items[i].kind, items[i].u, items[i].v, &all.weights[4 * i]);
    }
    return all;
}
inline stencils stencils_of(span<const cscd_proximity> items) {
    stencils all{std::vector<std::uint32_t>(4 * items.size()), std::vector<double>(4 * items.size())};
    for (std::size_t i = 0; i < items.size(); i++) {
        std::copy_n(items[i].vertices, 4, &all.vertices[4 * i]);
        std::copy_n(items[i].weights, 4, &all.weights[4 * i]);
    }
    return all;
}

/* ---- for the other classes ------------------------------------------------------------------------------ */

namespace detail {

/* Makes a call that gives a list out. */
template <class List, class Call> List find_list(const state_pointer &state, Call &&call) {
    List found;
    cscd_status status = try_call(state, [&] { return call(&found); });
    if (status != CSCD_OK) fail(state, status, found.size());
    return found;
}

/* Makes a call that finds how far a motion may go. */
template <class Call> cscd_free_step find_step(const state_pointer &state, Call &&call) {
    cscd_free_step found{};
    cscd_status status = try_call(state, [&] { return call(&found); });
    if (status == CSCD_IN_CONTACT) throw error(status, state->sentence_of(status), found.limit);
    if (status != CSCD_OK) fail(state, status);
    return found;
}

} // namespace detail

} // namespace cscd

#endif
