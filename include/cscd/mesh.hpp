/* Meshes in C++. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_MESH_HPP
#define CSCD_MESH_HPP

#include <cscd/context.hpp>
#include <cscd/detector.h>
#include <cscd/solver.h>
#include <cscd/surface.h>
#include <cscd/view.hpp>

#include <initializer_list>
#include <vector>

namespace cscd {

/* ---- objects to make a mesh of --------------------------------------------------------------------------- */

/* A moving object of triangles; set other members of the result as in C. The indices are read when the mesh is made. */
inline cscd_object_desc object_of_triangles(std::uint32_t vertex_count, span<const std::uint32_t> indices) {
    if (indices.size() % 3 != 0 || indices.size() / 3 > UINT32_MAX)
        throw error(CSCD_INVALID_ARGUMENT,
                    "triangles have three indices each, but there are " + std::to_string(indices.size()));
    return cscd_object_of_triangles(vertex_count, static_cast<std::uint32_t>(indices.size() / 3),
                                    indices.data());
}
inline cscd_object_desc object_of_triangles(std::uint32_t vertex_count,
                                            span<const std::array<std::uint32_t, 3>> triangles) {
    const std::uint32_t *indices = triangles.empty() ? nullptr : triangles.data()->data();
    return object_of_triangles(vertex_count, span<const std::uint32_t>(indices, 3 * triangles.size()));
}

/* The same of wires, points, and a half-space, whose normal points out of it. */
inline cscd_object_desc object_of_wires(std::uint32_t vertex_count,
                                        span<const std::array<std::uint32_t, 2>> wires) {
    if (wires.size() > UINT32_MAX) throw error(CSCD_INVALID_ARGUMENT, "there are too many wires");
    return cscd_object_of_wires(vertex_count, static_cast<std::uint32_t>(wires.size()),
                                wires.empty() ? nullptr : wires.data()->data());
}
inline cscd_object_desc object_of_points(std::uint32_t vertex_count) noexcept {
    return cscd_object_of_points(vertex_count);
}
inline cscd_object_desc object_half_space(const std::array<double, 3> &normal) noexcept {
    return cscd_object_half_space(normal.data());
}

/* Triangles for an obstacle, which the caller moves. */
template <class Triangles>
cscd_object_desc obstacle_of_triangles(std::uint32_t vertex_count, const Triangles &triangles) {
    cscd_object_desc desc = object_of_triangles(vertex_count, triangles);
    desc.obstacle = true;
    return desc;
}

/* ---- what a mesh knows ----------------------------------------------------------------------------------- */

/* The functions of cscd/detector.h, which check nothing and may be called from any thread. Arrays live as long as the mesh. */
template <class Mesh> class mesh_functions {
  public:
    using pair = std::array<std::uint32_t, 2>;
    using triple = std::array<std::uint32_t, 3>;
    using indices = span<const std::uint32_t>;

    std::uint32_t object_count() const noexcept {
        return cscd_mesh_object_count(c());
    }
    cscd_object object(std::uint32_t index) const noexcept {
        return cscd_mesh_object(c(), index);
    }
    std::uint32_t vertex_object(std::uint32_t vertex) const noexcept {
        return cscd_mesh_vertex_object(c(), vertex);
    }
    std::uint32_t vertex_count() const noexcept {
        return cscd_mesh_vertex_count(c());
    }
    std::uint32_t triangle_count() const noexcept {
        return cscd_mesh_triangle_count(c());
    }
    std::uint32_t edge_count() const noexcept {
        return cscd_mesh_edge_count(c());
    }
    triple triangle(std::uint32_t index) const noexcept {
        triple vertices;
        cscd_mesh_triangle(c(), index, vertices.data());
        return vertices;
    }
    pair edge(std::uint32_t index) const noexcept {
        pair vertices;
        cscd_mesh_edge(c(), index, vertices.data());
        return vertices;
    }
    triple triangle_edges(std::uint32_t index) const noexcept {
        triple edges;
        cscd_mesh_triangle_edges(c(), index, edges.data());
        return edges;
    }
    indices all_triangles() const noexcept {
        return {cscd_mesh_array(c(), CSCD_TRIANGLE_VERTICES), std::size_t{3} * triangle_count()};
    }
    indices all_edges() const noexcept {
        return {cscd_mesh_array(c(), CSCD_EDGE_VERTICES), std::size_t{2} * edge_count()};
    }
    indices all_triangle_edges() const noexcept {
        return {cscd_mesh_array(c(), CSCD_TRIANGLE_EDGES), std::size_t{3} * triangle_count()};
    }
    indices vertex_triangles(std::uint32_t index) const noexcept {
        std::uint32_t count = 0;
        const std::uint32_t *triangles = cscd_mesh_vertex_triangles(c(), index, &count);
        return {triangles, count};
    }
    indices edge_triangles(std::uint32_t index) const noexcept {
        std::uint32_t count = 0;
        const std::uint32_t *triangles = cscd_mesh_edge_triangles(c(), index, &count);
        return {triangles, count};
    }
    std::uint32_t component_count() const noexcept {
        return cscd_mesh_component_count(c());
    }
    cscd_component component(std::uint32_t index) const noexcept {
        return cscd_mesh_component(c(), index);
    }
    std::uint32_t triangle_component(std::uint32_t triangle) const noexcept {
        return cscd_mesh_triangle_component(c(), triangle);
    }
    /* As labels of parts; there are component_count() parts. */
    std::vector<std::uint32_t> component_labels() const {
        const std::uint32_t *labels = cscd_mesh_array(c(), CSCD_TRIANGLE_COMPONENTS);
        return {labels, labels + triangle_count()};
    }
    std::uint64_t hash() const noexcept {
        return cscd_mesh_hash(c());
    }
    cscd_stencil stencil(cscd_contact_kind kind, std::uint32_t a, std::uint32_t b, double u,
                         double v) const noexcept {
        return cscd_mesh_stencil(c(), kind, a, b, u, v);
    }

  private:
    const cscd_mesh *c() const noexcept {
        return static_cast<const Mesh *>(this)->get();
    }
};

/* ---- meshes ---------------------------------------------------------------------------------------------- */

/* A mesh that somebody else owns. */
class mesh_ref : public mesh_functions<mesh_ref> {
  public:
    explicit mesh_ref(const cscd_mesh *mesh) noexcept : mesh_(mesh) {
    }
    const cscd_mesh *get() const noexcept {
        return mesh_;
    }

  private:
    const cscd_mesh *mesh_;
};

/* A mesh of objects, which never changes. What is made from it keeps it. */
class mesh : public detail::owner<cscd_mesh, cscd_mesh_destroy>, public mesh_functions<mesh> {
  public:
    mesh(const context &context, span<const cscd_object_desc> objects) : owner(context.state()) {
        if (objects.size() > UINT32_MAX) throw error(CSCD_INVALID_ARGUMENT, "there are too many objects");
        create([&](cscd_mesh **out) {
            return cscd_mesh_create(context.get(), objects.data(), static_cast<std::uint32_t>(objects.size()),
                                    out);
        });
    }
    mesh(const context &context, std::initializer_list<cscd_object_desc> objects)
        : mesh(context, span<const cscd_object_desc>(objects.begin(), objects.size())) {
    }
    operator mesh_ref() const noexcept {
        return mesh_ref(get());
    }
};

/* ---- surfaces of tetrahedra ------------------------------------------------------------------------------ */

/* The boundary of tetrahedra, and the maps from its vertices and triangles back to theirs. Arrays live as long as it. */
class tet_surface : public detail::owner<cscd_tet_surface, cscd_tet_surface_destroy> {
  public:
    using indices = span<const std::uint32_t>;

    tet_surface(const context &context, span<const std::array<std::uint32_t, 4>> tetrahedra,
                std::uint32_t vertex_count)
        : owner(context.state()) {
        const std::uint32_t *first = tetrahedra.empty() ? nullptr : tetrahedra.data()->data();
        create([&](cscd_tet_surface **out) {
            return cscd_tet_surface_create(context.get(), first, tetrahedra.size(), vertex_count, out);
        });
    }
    std::uint32_t vertex_count() const noexcept {
        return arrays().vertex_count;
    }
    std::uint32_t triangle_count() const noexcept {
        return arrays().triangle_count;
    }
    /* Three for each triangle, for object_of_triangles. */
    indices triangles() const noexcept {
        return {arrays().triangles, std::size_t{3} * triangle_count()};
    }
    indices vertices() const noexcept {
        return {arrays().vertices, vertex_count()};
    }
    indices tetrahedra() const noexcept {
        return {arrays().tetrahedra, triangle_count()};
    }

  private:
    cscd_tet_surface_arrays arrays() const noexcept {
        return cscd_tet_surface_get(get());
    }
};

} // namespace cscd

#endif
