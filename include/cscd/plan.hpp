/* Plans in C++. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_PLAN_HPP
#define CSCD_PLAN_HPP

#include <cscd/mesh.hpp>
#include <cscd/plan.h>
#include <cscd/surface.h>

namespace cscd {

/* The members of cscd_plan_options, at their defaults. */
struct plan_options : cscd_plan_options {
    plan_options() noexcept : cscd_plan_options(cscd_plan_defaults()) {
    }
};

/* What a plan consists of; see cscd_plan_parts. */
struct plan_parts {
    cscd_method method = CSCD_METHOD_SINGLE;
    span<const std::uint32_t> triangle_regions;
    span<const std::array<double, 3>> detector_points;
    span<const double> charges;      /* empty without CHARGE */
    span<const double> capacitances; /* empty without CHARGE */
};

/* The regions of a mesh and their detector points. */
class plan : public detail::owner<cscd_plan, cscd_plan_destroy> {
  public:
    /* rest: the positions of the mesh at rest. */
    plan(const context &context, mesh_ref mesh, const positions &rest, const plan_options &options = {})
        : owner(context.state()) {
        const cscd_view *views = rest.covering(mesh.object_count());
        create([&](cscd_plan **out) {
            return cscd_plan_create(context.get(), mesh.get(), views, &options, out);
        });
    }

    /* From the parts of an earlier plan of the same mesh. */
    plan(const context &context, mesh_ref mesh, const positions &rest, const plan_parts &parts)
        : owner(context.state()) {
        const cscd_view *views = rest.covering(mesh.object_count());
        expect_size("triangle_regions", parts.triangle_regions.size(), mesh.triangle_count());
        if (!parts.charges.empty()) expect_size("charges", parts.charges.size(), mesh.triangle_count());
        if (!parts.capacitances.empty())
            expect_size("capacitances", parts.capacitances.size(), mesh.component_count());
        cscd_plan_parts c{};
        c.method = parts.method;
        c.region_count = static_cast<std::uint32_t>(parts.detector_points.size());
        c.triangle_regions = parts.triangle_regions.data();
        c.detector_points = parts.detector_points.empty() ? nullptr : parts.detector_points.data()->data();
        c.charges = parts.charges.empty() ? nullptr : parts.charges.data();
        c.capacitances = parts.capacitances.empty() ? nullptr : parts.capacitances.data();
        create([&](cscd_plan **out) {
            return cscd_plan_create_from_parts(context.get(), mesh.get(), views, &c, out);
        });
    }

    cscd_method method() const noexcept {
        return cscd_plan_method(get());
    }
    std::uint32_t region_count() const noexcept {
        return cscd_plan_region_count(get());
    }
    cscd_region region(std::uint32_t index) const noexcept {
        return cscd_plan_region(get(), index);
    }
    std::uint32_t triangle_region(std::uint32_t triangle) const noexcept {
        return cscd_plan_triangle_region(get(), triangle);
    }
    /* As labels of parts of the plan's mesh, which has so many triangles; there are region_count() parts. */
    std::vector<std::uint32_t> region_labels(std::uint32_t triangle_count) const {
        const std::uint32_t *labels = cscd_plan_triangle_regions(get());
        return {labels, labels + triangle_count};
    }
    double triangle_charge(std::uint32_t triangle) const noexcept {
        return cscd_plan_triangle_charge(get(), triangle);
    }
    double capacitance(std::uint32_t component) const noexcept {
        return cscd_plan_capacitance(get(), component);
    }
    cscd_preprocess_timings timings() const noexcept {
        return cscd_plan_timings(get());
    }
    cscd_plan_info info() const noexcept {
        return cscd_plan_describe(get());
    }
    /* What CSCD_METHOD_AUTO has compared; failure lives as long as the plan. */
    std::vector<cscd_compared_plan> compared() const {
        std::vector<cscd_compared_plan> found(info().compared_count);
        for (std::uint32_t i = 0; i < found.size(); i++) found[i] = cscd_plan_compared(get(), i);
        return found;
    }

  private:
    static void expect_size(const char *name, std::size_t size, std::uint32_t expected) {
        if (size == expected) return;
        throw error(CSCD_INVALID_ARGUMENT, std::string(name) + " has " + std::to_string(size) +
                                               " items, expected " + std::to_string(expected));
    }
};

} // namespace cscd

#endif
