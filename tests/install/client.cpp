/* The same program as client.c in C++17, with the classes of cscd/cscd.hpp. */
#include <cscd/cscd.hpp>

#include <array>
#include <cstdio>

namespace {

using triple = std::array<std::uint32_t, 3>;
using point = std::array<double, 3>;

constexpr std::array<triple, 8> triangles{triple{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3},
                                          {4, 6, 5},       {4, 5, 7}, {5, 6, 7}, {6, 4, 7}};
constexpr std::array<point, 8> start{point{0, 0, 0}, {4, 0, 0},  {0, 4, 0},  {0, 0, 4},
                                     {1, 1, -1},     {2, 1, -2}, {1, 2, -2}, {1, 1, -3}};

void print_contacts() {
    cscd::context_options options;
    options.thread_count = 2;
    const cscd::context context(options);
    const cscd::mesh mesh(context, {cscd::object_of_triangles(8, triangles)});
    cscd::detector detector(context, mesh, cscd::plan(context, mesh, start));
    auto end = start;
    for (std::size_t i = 4; i < end.size(); i++) end[i][2] += 1.5;
    for (const cscd_contact &contact : detector.step(start, end))
        std::printf("%s %u %u at t = %.3f\n", cscd_contact_kind_name(contact.kind), contact.a, contact.b,
                    contact.toi);
}

} // namespace

int main() {
    std::printf("cscd %s\n", cscd_version_string());
    try {
        print_contacts();
    } catch (const std::exception &failure) {
        std::fprintf(stderr, "%s\n", failure.what());
        return 1;
    }
    return 0;
}
