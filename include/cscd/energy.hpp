/* Energies in C++. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_ENERGY_HPP
#define CSCD_ENERGY_HPP

#include <cscd/detector.hpp>
#include <cscd/energy.h>

namespace cscd {

/* The members of cscd_energy_options, at their defaults. */
struct energy_options : cscd_energy_options {
    energy_options() noexcept : cscd_energy_options(cscd_energy_defaults()) {
    }
    explicit energy_options(double reach_of_pairs, double stiffness_of_pairs = 1.0) noexcept
        : energy_options() {
        reach = reach_of_pairs;
        stiffness = stiffness_of_pairs;
    }
};

/* Sums over the pairs of one mesh. Its pattern lives until it makes the next one. */
class energy : public detail::owner<cscd_energy, cscd_energy_destroy> {
  public:
    energy(const context &context, mesh_ref mesh) : owner(context.state()), mesh_(mesh) {
        create([&](cscd_energy **out) { return cscd_energy_create(context.get(), mesh.get(), out); });
    }

    /* others: NULL, or a pattern whose blocks this one shall have, too. */
    cscd_energy_pattern make_pattern(span<const cscd_proximity> items,
                                     const cscd_energy_pattern *others = nullptr) {
        const cscd_proximities list = list_of(items);
        cscd_energy_pattern pattern{};
        detail::make_call(state_, [&] { return cscd_energy_make_pattern(get(), &list, others, &pattern); });
        return pattern;
    }
    cscd_energy_sum evaluate(span<const cscd_proximity> items, const cscd::positions &x,
                             const energy_options &options, const cscd_energy_targets &targets = {}) {
        const cscd_view *at = x.covering(mesh_.object_count());
        const cscd_proximities list = list_of(items);
        cscd_energy_sum sum{};
        detail::make_call(state_,
                          [&] { return cscd_energy_evaluate(get(), &list, at, &options, &targets, &sum); });
        return sum;
    }
    void freeze_friction(span<const cscd_proximity> items, const cscd::positions &x,
                         const energy_options &options) {
        const cscd_view *at = x.covering(mesh_.object_count());
        const cscd_proximities list = list_of(items);
        detail::make_call(state_, [&] { return cscd_energy_freeze_friction(get(), &list, at, &options); });
    }
    cscd_energy_sum evaluate_friction(const cscd::positions &x0, const cscd::positions &x1,
                                      const cscd_energy_targets &targets = {}) {
        const cscd_view *from = x0.covering(mesh_.object_count()), *to = x1.covering(mesh_.object_count());
        cscd_energy_sum sum{};
        detail::make_call(state_,
                          [&] { return cscd_energy_evaluate_friction(get(), from, to, &targets, &sum); });
        return sum;
    }

  private:
    static cscd_proximities list_of(span<const cscd_proximity> items) noexcept {
        return {items.data(), items.size()};
    }

    mesh_ref mesh_;
};

} // namespace cscd

#endif
