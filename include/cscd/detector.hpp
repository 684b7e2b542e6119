/* Detectors in C++. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_DETECTOR_HPP
#define CSCD_DETECTOR_HPP

#include <cscd/lists.hpp>
#include <cscd/live.h>
#include <cscd/mesh_change.hpp>
#include <cscd/plan.hpp>
#include <cscd/untangle.h>

/* Some hosts, as the Unreal Engine, have a macro of this name. */
#pragma push_macro("check")
#undef check

namespace cscd {

/* ---- options --------------------------------------------------------------------------------- */

/* Leaves out pairs; see cscd_detector_options. It may throw. */
using ignore_function = std::function<bool(cscd_contact_kind kind, std::uint32_t a, std::uint32_t b)>;

namespace detail {

inline const std::uint32_t *indices_of(span<const std::array<std::uint32_t, 2>> pairs) noexcept {
    return pairs.empty() ? nullptr : pairs.data()->data();
}

} // namespace detail

/* The members of cscd_detector_options, at their defaults. Set arrays by the functions; they are read when the
 * detector is made. */
struct detector_options : cscd_detector_options {
    ignore_function ignore_if; /* goes before `ignore` */

    detector_options() noexcept : cscd_detector_options(cscd_detector_defaults()) {
    }
    void set_ignored(span<const std::array<std::uint32_t, 2>> triangles) noexcept {
        ignored = detail::indices_of(triangles);
        ignored_count = triangles.size();
    }
    void set_seams(span<const std::array<std::uint32_t, 2>> vertices) noexcept {
        seams = detail::indices_of(vertices);
        seam_count = vertices.size();
    }

    /* matrix: thickness_class_count rows of as many lengths, or empty. */
    void set_rules(span<const cscd_object_rule> of_objects, span<const double> matrix = {});
};

namespace detail {

/* How many classes the matrix has. */
inline std::uint32_t class_count(span<const double> matrix) {
    std::uint32_t count = 0;
    while (std::size_t{count} * count < matrix.size()) count++;
    if (std::size_t{count} * count == matrix.size()) return count;
    throw error(CSCD_INVALID_ARGUMENT, "the matrix of thicknesses has " + std::to_string(matrix.size()) +
                                           " numbers, which is no square");
}

inline std::uint32_t rule_count(span<const cscd_object_rule> rules) {
    if (rules.size() <= UINT32_MAX) return static_cast<std::uint32_t>(rules.size());
    throw error(CSCD_INVALID_ARGUMENT, "there are too many rules");
}

/* Called on the thread of a call, which is one of a detector here, or of one that C code has made from it. */
inline bool call_ignore(void *user, cscd_contact_kind kind, std::uint32_t a, std::uint32_t b) {
    context_state *state = context_state::current();
    if (state != nullptr && state->host().thrown()) return false;
    try {
        return (*static_cast<const ignore_function *>(user))(kind, a, b);
    } catch (...) {
        if (state == nullptr) throw;
        state->host().keep_exception();
    }
    return false;
}

} // namespace detail

inline void detector_options::set_rules(span<const cscd_object_rule> of_objects, span<const double> matrix) {
    rules = of_objects.data();
    rule_count = detail::rule_count(of_objects);
    thickness_matrix = matrix.empty() ? nullptr : matrix.data();
    thickness_class_count = detail::class_count(matrix);
}

/* ---- the detector ---------------------------------------------------------------------------------------- */

/* Finds the contacts of one mesh. */
class detector : public detail::owner<cscd_detector, cscd_detector_destroy> {
  public:
    detector(const context &context, mesh_ref mesh, const detector_options &options = {})
        : owner(context.state()) {
        create_from(context, mesh, nullptr, options);
    }
    detector(const context &context, mesh_ref mesh, const plan &plan, const detector_options &options = {})
        : owner(context.state()) {
        create_from(context, mesh, plan.get(), options);
    }

    /* A second detector on the same mesh, which has all that this one has. */
    detector clone(const context &of) const {
        detector made(of.state(), ignore_);
        made.create([&](cscd_detector **out) { return cscd_detector_clone(of.get(), get(), out); });
        return made;
    }

    mesh_ref mesh() const noexcept {
        return mesh_ref(cscd_detector_mesh(get()));
    }

    /* ---- what may change between calls */

    void set_separation(double min_separation, double tolerance = 0.0) {
        call([&] { return cscd_detector_set_separation(get(), min_separation, tolerance); });
    }
    /* The error of a list that is longer has its count(). */
    void set_longest_list(std::size_t longest_list) {
        call([&] { return cscd_detector_set_longest_list(get(), longest_list); });
    }
    void set_rules(span<const cscd_object_rule> rules, span<const double> matrix = {}) {
        std::uint32_t classes = detail::class_count(matrix), count = detail::rule_count(rules);
        call([&] {
            return cscd_detector_set_rules(get(), rules.data(), count,
                                           matrix.empty() ? nullptr : matrix.data(), classes);
        });
    }
    /* Pairs that come to be looked at again, and are too near, wait. */
    void set_seams(span<const std::array<std::uint32_t, 2>> vertices) {
        call([&] { return cscd_detector_set_seams(get(), detail::indices_of(vertices), vertices.size()); });
    }
    void set_ignored(span<const std::array<std::uint32_t, 2>> triangles) {
        call([&] {
            return cscd_detector_set_ignored(get(), detail::indices_of(triangles), triangles.size());
        });
    }
    /* Only these may move, and features near them are looked at; without an argument, all. */
    void set_active(span<const std::uint32_t> vertices) {
        const std::uint32_t none = 0, *first = vertices.empty() ? &none : vertices.data();
        call([&] { return cscd_detector_set_active(get(), first, vertices.size()); });
    }
    void set_active() {
        call([&] { return cscd_detector_set_active(get(), nullptr, 0); });
    }
    /* Goes over to the new mesh of a change of its own mesh. */
    void change_mesh(const mesh_change &change) {
        call([&] { return cscd_detector_change_mesh(get(), change.get()); });
    }
    void set_rest(const positions &rest) {
        const cscd_view *views = covering(rest);
        call([&] { return cscd_detector_set_rest(get(), views); });
    }
    void forget_rest() {
        call([&] { return cscd_detector_set_rest(get(), nullptr); });
    }
    /* The body of each triangle; there are so many as the greatest says, and one more for each object without triangles. */
    std::vector<std::uint32_t> body_labels() const {
        std::vector<std::uint32_t> labels(mesh().triangle_count());
        cscd_detector_body_labels(get(), labels.data());
        return labels;
    }
    /* A label for each triangle; without an argument, the objects are the parts. */
    void set_parts(span<const std::uint32_t> labels, std::uint32_t part_count) {
        const std::uint32_t *first = first_label(labels);
        call([&] { return cscd_detector_set_parts(get(), first, part_count); });
    }
    void set_parts() {
        call([&] { return cscd_detector_set_parts(get(), nullptr, 0); });
    }
    /* The same of what belongs together; without an argument, the parts say so. */
    void set_bodies(span<const std::uint32_t> labels, std::uint32_t label_count) {
        const std::uint32_t *first = first_label(labels);
        call([&] { return cscd_detector_set_bodies(get(), first, label_count); });
    }
    void set_bodies() {
        call([&] { return cscd_detector_set_bodies(get(), nullptr, 0); });
    }

    /* ---- contacts, intersections, proximity */

    contacts step(const positions &x0, const positions &x1) {
        const cscd_view *from = covering(x0), *to = covering(x1);
        return find<contacts>([&](contacts *out) { return cscd_detector_step(get(), from, to, out); });
    }
    intersections check(const positions &x) {
        const cscd_view *at = covering(x);
        return find<intersections>([&](intersections *out) { return cscd_detector_check(get(), at, out); });
    }
    /* By kind; the options are those of C. */
    intersections
    find_intersections(const positions &x,
                       const cscd_intersection_options &options = cscd_intersection_defaults()) {
        const cscd_view *at = covering(x);
        return find<intersections>(
            [&](intersections *out) { return cscd_detector_find_intersections(get(), at, &options, out); });
    }
    /* With their gradients. */
    measures overlap_volumes(const positions &x,
                             const cscd_intersection_options &options = cscd_intersection_defaults()) {
        const cscd_view *at = covering(x);
        return find<measures>(
            [&](measures *out) { return cscd_detector_overlap_volumes(get(), at, &options, out); });
    }
    measures curve_lengths(const positions &x,
                           const cscd_intersection_options &options = cscd_intersection_defaults()) {
        const cscd_view *at = covering(x);
        return find<measures>(
            [&](measures *out) { return cscd_detector_curve_lengths(get(), at, &options, out); });
    }
    /* Contacts of a list, summed up by pair of parts. */
    contact_part_pairs contact_parts(span<const cscd_contact> items) {
        return find<contact_part_pairs>([&](contact_part_pairs *out) {
            return cscd_detector_contact_parts(get(), items.data(), items.size(), out);
        });
    }
    proximities find_near(const positions &x, double distance, cscd_near_form form = CSCD_NEAR_UNIQUE) {
        const cscd_view *at = covering(x);
        return find<proximities>(
            [&](proximities *out) { return cscd_detector_find_near(get(), at, distance, form, out); });
    }

    /* ---- motions without contact */

    /* reached may be x1. Where the start touches, error::contact() is the pair. */
    cscd_free_step max_step(const positions &x0, const positions &x1, const mutable_positions &reached) {
        return max_step_to(x0, x1, reached.covering(object_count()));
    }
    cscd_free_step max_step(const positions &x0, const positions &x1) {
        return max_step_to(x0, x1, nullptr);
    }
    cscd_displacement_bounds displacement_bounds(const positions &x0, double search_radius,
                                                 span<double> bounds) {
        return bounds_of(x0, search_radius, CSCD_SCALAR_DOUBLE, bounds.data(),
                         bounds.size() * sizeof(double));
    }
    cscd_displacement_bounds displacement_bounds(const positions &x0, double search_radius,
                                                 span<float> bounds) {
        return bounds_of(x0, search_radius, CSCD_SCALAR_FLOAT, bounds.data(), bounds.size() * sizeof(float));
    }
    cscd_truncation truncate(const positions &x0, const positions &x1, double search_radius,
                             const mutable_positions &reached) {
        return truncate_to(x0, x1, search_radius, reached.covering(object_count()));
    }
    cscd_truncation truncate(const positions &x0, const positions &x1, double search_radius) {
        return truncate_to(x0, x1, search_radius, nullptr);
    }
    /* reached may be x1 or x0. */
    cscd_safe_motion make_safe(const positions &x0, const positions &x1, const mutable_positions &reached,
                               const cscd_response_options &options = cscd_response_defaults()) {
        const cscd_view *from = covering(x0), *to = covering(x1);
        const cscd_mutable_view *end = reached.covering(object_count());
        cscd_safe_motion found{};
        call([&] { return cscd_detector_make_safe(get(), from, to, &options, end, &found); });
        return found;
    }

    lenses find_lenses(const positions &x,
                       const cscd_intersection_options &options = cscd_intersection_defaults()) {
        const cscd_view *at = covering(x);
        return find<lenses>([&](lenses *out) { return cscd_detector_find_lenses(get(), at, &options, out); });
    }
    /* reached may be x. */
    cscd_untangled untangle(const positions &x, const mutable_positions &reached,
                            const cscd_untangle_options &options = cscd_untangle_defaults()) {
        const cscd_view *from = covering(x);
        const cscd_mutable_view *end = reached.covering(object_count());
        cscd_untangled found{};
        call([&] { return cscd_detector_untangle(get(), from, &options, end, &found); });
        return found;
    }

    /* ---- of the last step */

    cscd_guarantee guarantee(std::uint32_t component) const noexcept {
        return cscd_detector_guarantee(get(), component);
    }
    bool collapsed(std::uint32_t component) const noexcept {
        return cscd_detector_collapsed(get(), component);
    }
    /* How many pairs wait: cscd/live.h. */
    cscd_waiting waiting() const noexcept {
        return cscd_detector_waiting(get());
    }
    cscd_timings timings() const noexcept {
        return cscd_detector_timings(get());
    }
    cscd_counters counters() const noexcept {
        return cscd_detector_counters(get());
    }

    /* ---- what is known of the start of the next one */

  private:
    friend class line_search;

    detector(detail::state_pointer state, std::shared_ptr<const ignore_function> ignore)
        : owner(std::move(state)), ignore_(std::move(ignore)) {
    }

    void create_from(const context &context, mesh_ref mesh, const cscd_plan *plan,
                     const detector_options &options) {
        cscd_detector_options c = options;
        if (options.ignore_if) {
            ignore_ = std::make_shared<const ignore_function>(options.ignore_if);
            c.ignore = detail::call_ignore;
            c.ignore_user = const_cast<ignore_function *>(ignore_.get());
        }
        create([&](cscd_detector **out) {
            return cscd_detector_create(context.get(), mesh.get(), plan, &c, out);
        });
    }
    std::uint32_t object_count() const noexcept {
        return get() != nullptr ? mesh().object_count() : 0;
    }
    const cscd_view *covering(const positions &x) const {
        return x.covering(object_count());
    }
    const std::uint32_t *first_label(span<const std::uint32_t> labels) const {
        static const std::uint32_t none = 0;
        std::uint32_t count = mesh().triangle_count();
        if (labels.size() != count)
            throw error(CSCD_INVALID_ARGUMENT, "labels has " + std::to_string(labels.size()) +
                                                   " items, expected " + std::to_string(count));
        return labels.empty() ? &none : labels.data();
    }
    template <class Call> void call(Call &&of_c) {
        detail::make_call(state_, of_c);
    }
    /* The near pairs of the result may be too many. */
    template <class Result, class Call> void call_near(const Result &found, Call &&of_c) {
        cscd_status status = detail::try_call(state_, of_c);
        if (status != CSCD_OK) detail::fail(state_, status, found.near_count);
    }
    template <class List, class Call> List find(Call &&of_c) {
        return detail::find_list<List>(state_, of_c);
    }
    cscd_free_step max_step_to(const positions &x0, const positions &x1, const cscd_mutable_view *reached) {
        const cscd_view *from = covering(x0), *to = covering(x1);
        return detail::find_step(state_, [&](cscd_free_step *out) {
            return cscd_detector_max_step(get(), from, to, reached, out);
        });
    }
    cscd_displacement_bounds bounds_of(const positions &x0, double search_radius, cscd_scalar scalar,
                                       void *bounds, std::size_t size) {
        const cscd_view *from = covering(x0);
        cscd_displacement_bounds found{};
        call_near(found, [&] {
            return cscd_detector_displacement_bounds(get(), from, search_radius, scalar, bounds, size,
                                                     &found);
        });
        return found;
    }
    cscd_truncation truncate_to(const positions &x0, const positions &x1, double search_radius,
                                const cscd_mutable_view *reached) {
        const cscd_view *from = covering(x0), *to = covering(x1);
        cscd_truncation found{};
        call_near(found,
                  [&] { return cscd_detector_truncate(get(), from, to, search_radius, reached, &found); });
        return found;
    }

    std::shared_ptr<const ignore_function> ignore_;
};

} // namespace cscd

#pragma pop_macro("check")

#endif
