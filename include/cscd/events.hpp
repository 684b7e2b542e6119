/* Events in C++. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_EVENTS_HPP
#define CSCD_EVENTS_HPP

#include <cscd/detector.hpp>
#include <cscd/events.h>

namespace cscd {

/* The members of cscd_event_options, at their defaults. Set arrays by the functions; they are read when the tracker is
 * made. */
struct event_options : cscd_event_options {
    event_options() noexcept : cscd_event_options(cscd_event_defaults()) {
    }
    /* A label for each triangle. */
    void set_labels(span<const std::uint32_t> of_triangles, std::uint32_t count) noexcept {
        labels = of_triangles.data();
        label_count = of_triangles.size();
        part_count = count;
    }
    void set_seams(span<const std::array<std::uint32_t, 2>> vertices) noexcept {
        seams = detail::indices_of(vertices);
        seam_count = vertices.size();
    }
    std::size_t label_count = 0;
};

using events = list<cscd_events>;

/* Follows events through the frames of a recording. Its lists live until its next call. */
class event_tracker : public detail::owner<cscd_event_tracker, cscd_event_tracker_destroy> {
  public:
    event_tracker(const context &context, mesh_ref mesh, const event_options &options = {})
        : owner(context.state()) {
        std::size_t count = mesh.triangle_count();
        if (options.labels != nullptr && options.label_count != count)
            throw error(CSCD_INVALID_ARGUMENT, "labels has " + std::to_string(options.label_count) +
                                                   " items, expected " + std::to_string(count));
        create([&](cscd_event_tracker **out) {
            return cscd_event_tracker_create(context.get(), mesh.get(), &options, out);
        });
    }

    /* Of the interval that ends in the next frame. */
    void add_contacts(span<const cscd_contact> items) {
        call([&] { return cscd_event_tracker_add_contacts(get(), items.data(), items.size()); });
    }
    void add_frame(std::uint64_t frame, const cscd_intersections &found) {
        call([&] { return cscd_event_tracker_add_frame(get(), frame, &found); });
    }
    /* A frame in which nothing was looked for. */
    void add_frame(std::uint64_t frame) {
        call([&] { return cscd_event_tracker_add_frame(get(), frame, nullptr); });
    }

    /* Those that have ended since the last call, and those that are left. */
    events take() {
        return detail::find_list<events>(state_,
                                         [&](events *out) { return cscd_event_tracker_take(get(), out); });
    }
    events finish() {
        return detail::find_list<events>(state_,
                                         [&](events *out) { return cscd_event_tracker_finish(get(), out); });
    }

    /* A later chunk of the recording. */
  private:
    template <class Call> void call(Call &&made) {
        detail::make_call(state_, made);
    }
};

} // namespace cscd

#endif
