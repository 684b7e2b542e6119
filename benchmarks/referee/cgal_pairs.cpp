/* Lists the pairs of triangles that CGAL's self_intersections finds. usage: cgal_pairs MESH.off PAIRS.txt */
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using surface = CGAL::Surface_mesh<kernel::Point_3>;
using face = surface::Face_index;
using face_pair = std::pair<face, face>;

/* Reads with strtod, whose doubles are the nearest ones. */
static bool read_mesh(const char *path, surface &out, std::size_t &left_out) {
    std::ifstream in(path);
    std::string word;
    std::size_t vertex_count = 0, face_count = 0, edge_count = 0;
    if (!(in >> word >> vertex_count >> face_count >> edge_count) || word != "OFF") return false;
    for (std::size_t v = 0; v < vertex_count; v++) {
        double x[3];
        for (double &coordinate : x) {
            in >> word;
            coordinate = std::strtod(word.c_str(), nullptr);
        }
        out.add_vertex(kernel::Point_3(x[0], x[1], x[2]));
    }
    for (std::size_t t = 0; t < face_count; t++) {
        std::size_t count = 0;
        surface::size_type corners[3];
        if (!(in >> count >> corners[0] >> corners[1] >> corners[2]) || count != 3) return false;
        face added = out.add_face(surface::Vertex_index(corners[0]), surface::Vertex_index(corners[1]),
                                  surface::Vertex_index(corners[2]));
        left_out += added == surface::null_face();
    }
    return !in.fail();
}

static double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

static bool list_pairs(const char *mesh_path, const char *pairs_path) {
    surface mesh;
    std::size_t left_out = 0;
    double start = processor_seconds();
    if (!read_mesh(mesh_path, mesh, left_out)) {
        std::fprintf(stderr, "cgal_pairs: %s is no triangle mesh in OFF\n", mesh_path);
        return false;
    }
    double read = processor_seconds() - start;
    if (left_out > 0) {
        std::fprintf(stderr, "a Surface_mesh has no place for %zu of the triangles\n", left_out);
        return false;
    }
    start = processor_seconds();
    std::vector<face_pair> pairs;
    CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(pairs));
    double find = processor_seconds() - start;
    std::FILE *out = std::fopen(pairs_path, "w");
    if (out == nullptr) {
        std::fprintf(stderr, "cgal_pairs: %s cannot be written\n", pairs_path);
        return false;
    }
    for (const face_pair &pair : pairs)
        std::fprintf(out, "%u %u\n", static_cast<unsigned>(pair.first), static_cast<unsigned>(pair.second));
    std::printf("{\"pairs\": %zu, \"read_s\": %.6f, \"find_s\": %.6f}\n", pairs.size(), read, find);
    return std::fclose(out) == 0;
}

int main(int argument_count, char **arguments) {
    if (argument_count != 3) {
        std::fputs("usage: cgal_pairs MESH.off PAIRS.txt\n", stderr);
        return 2;
    }
    try {
        return list_pairs(arguments[1], arguments[2]) ? 0 : 1;
    } catch (const std::exception &problem) {
        std::fprintf(stderr, "cgal_pairs: %s\n", problem.what());
        return 1;
    }
}
