/* Line searches in C++. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_SOLVER_HPP
#define CSCD_SOLVER_HPP

#include <cscd/detector.hpp>
#include <cscd/solver.h>

namespace cscd {

/* One motion that is asked about many times. It keeps its detector. */
class line_search : public detail::owner<cscd_line_search, cscd_line_search_destroy> {
  public:
    explicit line_search(const detector &of)
        : owner(of.state_), ignore_(of.ignore_), mesh_(cscd_detector_mesh(of.get())) {
        create([&](cscd_line_search **out) { return cscd_line_search_create(of.get(), out); });
    }

    mesh_ref mesh() const noexcept {
        return mesh_ref(mesh_);
    }
    void begin(const cscd::positions &x0, const cscd::positions &x1, double reach = 0.0) {
        const cscd_view *from = x0.covering(object_count()), *to = x1.covering(object_count());
        detail::make_call(state_, [&] { return cscd_line_search_begin(get(), from, to, reach); });
    }
    std::size_t candidate_count() const noexcept {
        return cscd_line_search_candidate_count(get());
    }
    cscd::candidates candidates() {
        return detail::find_list<cscd::candidates>(
            state_, [&](cscd::candidates *out) { return cscd_line_search_candidates(get(), out); });
    }
    void positions(double fraction, const mutable_positions &out) {
        const cscd_mutable_view *views = out.covering(object_count());
        detail::make_call(state_, [&] { return cscd_line_search_positions(get(), fraction, views); });
    }
    cscd_free_step max_step(double longest, const mutable_positions &reached) {
        return max_step_to(longest, reached.covering(object_count()));
    }
    cscd_free_step max_step(double longest = 1.0) {
        return max_step_to(longest, nullptr);
    }
    proximities find_near(double fraction, double distance, cscd_near_form form = CSCD_NEAR_UNIQUE) {
        return detail::find_list<proximities>(state_, [&](proximities *out) {
            return cscd_line_search_find_near(get(), fraction, distance, form, out);
        });
    }

  private:
    std::uint32_t object_count() const noexcept {
        return get() != nullptr ? mesh().object_count() : 0;
    }
    cscd_free_step max_step_to(double longest, const cscd_mutable_view *reached) {
        return detail::find_step(state_, [&](cscd_free_step *out) {
            return cscd_line_search_max_step(get(), longest, reached, out);
        });
    }

    std::shared_ptr<const ignore_function> ignore_;
    const cscd_mesh *mesh_;
};

} // namespace cscd

#endif
