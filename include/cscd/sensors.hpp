/* Particle sensors in C++; cscd/cscd.hpp, which says what holds for all, does not include this header. */
#ifndef CSCD_SENSORS_HPP
#define CSCD_SENSORS_HPP

#include <cscd/lists.hpp>
#include <cscd/plan.hpp>
#include <cscd/sensors.h>

namespace cscd {

/* The members of cscd_sensor_options, at their defaults. */
struct sensor_options : cscd_sensor_options {
    sensor_options() noexcept : cscd_sensor_options(cscd_sensor_defaults()) {
    }
};

using warnings = list<cscd_warnings>;

/* The particles on the objects of one mesh, and their cells; warnings live until their next step. */
class sensors : public detail::owner<cscd_sensors, cscd_sensors_destroy> {
  public:
    sensors(const context &context, mesh_ref mesh, const positions &rest, const sensor_options &options = {})
        : owner(context.state()), object_count_(mesh.object_count()) {
        create_from(context, mesh, nullptr, rest, options);
    }
    sensors(const context &context, mesh_ref mesh, const plan &plan, const positions &rest,
            const sensor_options &options = {})
        : owner(context.state()), object_count_(mesh.object_count()) {
        create_from(context, mesh, plan.get(), rest, options);
    }

    std::uint32_t part_count() const noexcept {
        return cscd_sensors_part_count(get());
    }
    cscd_sensor_part part(std::uint32_t index) const noexcept {
        return cscd_sensors_part(get(), index);
    }
    std::uint32_t cell_count() const noexcept {
        return cscd_sensors_cell_count(get());
    }
    std::uint32_t vertex_cell(std::uint32_t vertex) const noexcept {
        return cscd_sensors_vertex_cell(get(), vertex);
    }

    /* New cells for one part, or for all. */
    void renew(const positions &x, std::uint32_t part = UINT32_MAX) {
        const cscd_view *at = x.covering(object_count_);
        detail::make_call(state_, [&] { return cscd_sensors_renew(get(), at, part); });
    }

    warnings step(const positions &x0, const positions &x1) {
        const cscd_view *from = x0.covering(object_count_), *to = x1.covering(object_count_);
        return detail::find_list<warnings>(
            state_, [&](warnings *out) { return cscd_sensors_step(get(), from, to, out); });
    }

    cscd_renewal renewal(std::uint32_t part) const noexcept {
        return cscd_sensors_renewal(get(), part);
    }
    std::uint32_t particle_count() const noexcept {
        return cscd_sensors_particle_count(get());
    }
    std::uint32_t particle(std::uint32_t index) const noexcept {
        return cscd_sensors_particle(get(), index);
    }
    cscd_sensor_timings timings() const noexcept {
        return cscd_sensors_timings(get());
    }
    cscd_sensor_counters counters() const noexcept {
        return cscd_sensors_counters(get());
    }

  private:
    void create_from(const context &context, mesh_ref mesh, const cscd_plan *plan, const positions &rest,
                     const sensor_options &options) {
        const cscd_view *views = rest.covering(object_count_);
        create([&](cscd_sensors **out) {
            return cscd_sensors_create(context.get(), mesh.get(), plan, views, &options, out);
        });
    }

    std::uint32_t object_count_; /* of the mesh */
};

} // namespace cscd

#endif
