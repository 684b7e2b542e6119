/* Changes of meshes in C++. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_MESH_CHANGE_HPP
#define CSCD_MESH_CHANGE_HPP

#include <cscd/live.h>
#include <cscd/mesh.hpp>

#include <vector>

namespace cscd {

/* What happens to one object; see cscd_object_change. */
struct object_change {
    std::uint32_t object = UINT32_MAX;          /* of the old mesh; UINT32_MAX: a new one */
    std::optional<cscd_object_desc> desc;       /* none: it is removed */
    span<const std::uint32_t> vertex_origins;   /* empty: vertex i was vertex i */
    span<const std::uint32_t> triangle_origins; /* the same of its triangles */
};

/* Two meshes, and what has become of each feature. The arrays and the new mesh belong to it; what is made from the
 * mesh keeps it. */
class mesh_change : public detail::owner<cscd_mesh_change, cscd_mesh_change_destroy> {
  public:
    using indices = span<const std::uint32_t>;

    mesh_change(const context &context, mesh_ref old, span<const object_change> changes)
        : owner(context.state()) {
        const std::vector<cscd_object_change> all = c_changes(changes);
        create([&](cscd_mesh_change **out) {
            return cscd_mesh_change_create(context.get(), old.get(), all.data(),
                                           static_cast<std::uint32_t>(all.size()), out);
        });
    }
    mesh_change(const context &context, mesh_ref old, std::initializer_list<object_change> changes)
        : mesh_change(context, old, span<const object_change>(changes.begin(), changes.size())) {
    }

    mesh_ref mesh() const noexcept {
        return mesh_ref(cscd_mesh_change_mesh(get()));
    }

    /* The new number of each old feature, UINT32_MAX if it is gone. */
    indices vertices() const noexcept {
        return array(cscd_mesh_change_to_new, CSCD_VERTICES);
    }
    indices edges() const noexcept {
        return array(cscd_mesh_change_to_new, CSCD_EDGES);
    }
    indices triangles() const noexcept {
        return array(cscd_mesh_change_to_new, CSCD_TRIANGLES);
    }
    indices objects() const noexcept {
        return array(cscd_mesh_change_to_new, CSCD_OBJECTS);
    }
    /* Those that are untouched. */
    indices components() const noexcept {
        return array(cscd_mesh_change_to_new, CSCD_COMPONENTS);
    }

    /* The old number of each new feature, UINT32_MAX if it is new. */
    indices vertex_origins() const noexcept {
        return array(cscd_mesh_change_to_old, CSCD_VERTICES);
    }
    indices edge_origins() const noexcept {
        return array(cscd_mesh_change_to_old, CSCD_EDGES);
    }
    indices triangle_origins() const noexcept {
        return array(cscd_mesh_change_to_old, CSCD_TRIANGLES);
    }
    indices object_origins() const noexcept {
        return array(cscd_mesh_change_to_old, CSCD_OBJECTS);
    }
    indices component_origins() const noexcept {
        return array(cscd_mesh_change_to_old, CSCD_COMPONENTS);
    }

  private:
    using map = const std::uint32_t *(*)(const cscd_mesh_change *, cscd_element, std::uint32_t *);

    indices array(map of, cscd_element what) const noexcept {
        std::uint32_t count = 0;
        const std::uint32_t *first = of(get(), what, &count);
        return {first, count};
    }

    static void expect_size(const char *name, indices origins, std::uint32_t expected) {
        if (origins.empty() || origins.size() == expected) return;
        throw error(CSCD_INVALID_ARGUMENT, std::string(name) + " has " + std::to_string(origins.size()) +
                                               " items, expected " + std::to_string(expected));
    }

    static std::vector<cscd_object_change> c_changes(span<const object_change> changes) {
        std::vector<cscd_object_change> all;
        for (const object_change &change : changes) {
            const cscd_object_desc *desc = change.desc ? &*change.desc : nullptr;
            expect_size("vertex_origins", change.vertex_origins, desc ? desc->vertex_count : 0);
            expect_size("triangle_origins", change.triangle_origins, desc ? desc->triangle_count : 0);
            all.push_back({change.object, 0, desc,
                           change.vertex_origins.empty() ? nullptr : change.vertex_origins.data(),
                           change.triangle_origins.empty() ? nullptr : change.triangle_origins.data()});
        }
        return all;
    }
};

} // namespace cscd

#endif
