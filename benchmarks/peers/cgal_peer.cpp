/* CGAL's check of one moment: PMP::self_intersections (boxes in order, then exact predicates) on the calling thread. */
#include "benchmarks/peers/cgal_peer.h"

#include "benchmarks/peers/peer_clock.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/version.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <new>
#include <string>
#include <utility>
#include <vector>

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using surface = CGAL::Surface_mesh<kernel::Point_3>;
using face = surface::Face_index;
using face_pair = std::pair<face, face>;

const char cgal_peer_version[] = CGAL_VERSION_STR;

/* Returns how many triangles have no place. */
static uint32_t fill_surface(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                             uint32_t triangle_count, surface &out) {
    uint32_t left_out = 0;
    out.reserve(vertex_count, 3 * triangle_count / 2 + 1, triangle_count);
    for (std::size_t v = 0; v < vertex_count; v++)
        out.add_vertex(kernel::Point_3(positions[v * 3], positions[v * 3 + 1], positions[v * 3 + 2]));
    for (std::size_t t = 0; t < triangle_count; t++) {
        const uint32_t *corners = triangles + t * 3;
        face added = out.add_face(surface::Vertex_index(corners[0]), surface::Vertex_index(corners[1]),
                                  surface::Vertex_index(corners[2]));
        left_out += added == surface::null_face();
    }
    return left_out;
}

static void find_pairs(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                       uint32_t triangle_count, cgal_pairs &out) {
    surface mesh;
    double since = peer_clock_ms();
    out.left_out = fill_surface(positions, vertex_count, triangles, triangle_count, mesh);
    out.setup_ms = peer_clock_ms() - since;
    if (out.left_out > 0) return;
    std::vector<face_pair> pairs;
    since = peer_clock_ms();
    CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(pairs));
    out.find_ms = peer_clock_ms() - since;
    std::vector<std::pair<uint32_t, uint32_t>> sorted;
    for (const face_pair &pair : pairs) {
        uint32_t a = pair.first, b = pair.second;
        sorted.emplace_back(std::min(a, b), std::max(a, b));
    }
    std::sort(sorted.begin(), sorted.end());
    out.items = static_cast<uint32_t(*)[2]>(std::malloc((sorted.size() + 1) * sizeof *out.items));
    if (out.items == nullptr) throw std::bad_alloc();
    for (const auto &pair : sorted) {
        out.items[out.count][0] = pair.first;
        out.items[out.count++][1] = pair.second;
    }
}

const char *cgal_peer_check(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                            uint32_t triangle_count, cgal_pairs *out) {
    static std::string said;
    *out = cgal_pairs{};
    try {
        find_pairs(positions, vertex_count, triangles, triangle_count, *out);
        return nullptr;
    } catch (const std::exception &problem) {
        said = problem.what();
        return said.c_str();
    }
}
