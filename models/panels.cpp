/* Two sewn panels of cloth, a seam that opens, a tear, a ball and a floor, by a C++ program: it uses cscd/cscd.hpp, has its
 * positions as floats in an array of structs, and runs cscd on its own threads. It checks itself in every frame, and ends
 * with 1 if anything passes through anything. */
#include "models/panels/panels.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

struct options {
    std::uint32_t side = 12, threads = 2, frames = 150;
    bool certified = true;
};

constexpr unsigned frames_per_row = 15, opening_frame = 61, tear_frame = 106;

/* A number for the bits of all positions, to compare runs. */
std::uint64_t digest_of(const std::vector<panels::particle> &particles) {
    std::uint64_t digest = 14695981039346656037u;
    for (const panels::particle &p : particles) {
        for (float c : {p.position.x, p.position.y, p.position.z}) {
            std::uint32_t bits;
            std::memcpy(&bits, &c, sizeof bits);
            digest = (digest ^ bits) * 1099511628211u;
        }
    }
    return digest;
}

void print_row(const panels::simulation &s, const panels::report &r, std::size_t intersections) {
    std::printf("%7.2f  %8.2f %%  %6zu  %8.3f  %7zu  %6llu  %13zu\n", static_cast<double>(s.seconds()),
                100.0 * r.motion / r.steps, r.near, r.least, r.waiting,
                static_cast<unsigned long long>(r.culled), intersections);
}

/* Something is wrong with this frame: what, or "". */
std::string fault_of(const panels::report &r, std::size_t intersections) {
    if (intersections > 0) return "triangles intersect";
    if (r.least < 1.0) return "a pair is nearer than the separation";
    return "";
}

int run(const options &o) {
    panels::simulation s(o.side, o.threads, o.certified);
    std::printf("%u triangles on %u threads of the program; separation %g m\n", s.triangle_count(), o.threads,
                static_cast<double>(panels::separation));
    std::puts("seconds  motion free   pairs   nearest  pairs    culled  intersections\n"
              "                       near    in sep.  waiting  triang.");
    panels::report row;
    std::string fault;
    for (unsigned frame = 1; frame <= o.frames && fault.empty(); frame++) {
        if (frame == opening_frame) {
            s.open_seam();
            std::puts("the seam is opened");
        }
        if (frame == tear_frame) {
            const std::size_t before = s.particles().size();
            s.tear_right_panel();
            std::printf("the right panel tears: %zu vertices more\n", s.particles().size() - before);
        }
        s.advance(row);
        const std::size_t intersections = s.count_intersections();
        fault = fault_of(row, intersections);
        if (frame % frames_per_row > 0 && frame < o.frames && fault.empty()) continue;
        print_row(s, row, intersections);
        row = {};
    }
    if (fault.empty() && o.frames >= opening_frame && s.waiting() == 0 && s.count_all_intersections() > 0)
        fault = "triangles intersect, seam or not";
    if (!fault.empty()) {
        std::fprintf(stderr, "panels: after %g s %s\n", static_cast<double>(s.seconds()), fault.c_str());
        return 1;
    }
    std::printf("the program's threads ran %s; digest %016llx\n",
                s.tasks_run() > 0 ? "tasks of cscd" : "no task",
                static_cast<unsigned long long>(digest_of(s.particles())));
    return 0;
}

bool parse_number(const char *text, std::uint32_t least, std::uint32_t most, std::uint32_t *out) {
    char *end = nullptr;
    const unsigned long value = std::strtoul(text, &end, 10);
    if (end == text || *end != '\0' || value < least || value > most) {
        std::fprintf(stderr, "panels: '%s': a number from %u to %u is wanted\n", text, least, most);
        return false;
    }
    *out = static_cast<std::uint32_t>(value);
    return true;
}

bool parse_option(const char *name, const char *value, options *out) {
    if (std::strcmp(name, "--side") == 0) return parse_number(value, 4, 64, &out->side);
    if (std::strcmp(name, "--threads") == 0) return parse_number(value, 1, 256, &out->threads);
    if (std::strcmp(name, "--frames") == 0) return parse_number(value, 1, 100000, &out->frames);
    std::fprintf(stderr, "panels: unknown option '%s'; see panels --help\n", name);
    return false;
}

} // namespace

int main(int argc, char **argv) {
    options o;
    if (argc == 2 && std::strcmp(argv[1], "--help") == 0) {
        std::puts(
            "usage: panels [--side N] [--threads N] [--frames N] [--uncertified]\n"
            "Two sewn panels of cloth, a ball and a floor, by a C++ program that checks itself in every frame.\n"
            "  --side N     squares along a panel's side (12)\n"
            "  --threads N  threads of the program, on which cscd runs (2)\n"
            "  --frames N   sixtieths of a second (150)\n"
            "  --uncertified  goes where the solver wants, to show that the checks see what comes of it\n"
            "exit: 0 all is well, 1 something has passed through something, or a call has failed, 2 usage");
        return 0;
    }
    for (int i = 1; i < argc; i++) {
        if (std::strcmp(argv[i], "--uncertified") == 0)
            o.certified = false;
        else if (!parse_option(argv[i], i + 1 < argc ? argv[i + 1] : "", &o))
            return 2;
        else
            i++;
    }
    try {
        return run(o);
    } catch (const std::exception &failure) {
        std::fprintf(stderr, "panels: %s\n", failure.what());
        return 1;
    }
}
