/* Soft bodies of Bullet, whose frames are kept free of contact by each way that cscd has, and by Bullet alone. After each frame
 * a detector that knows nothing yet and culls nothing says what has touched. */
#include "tests/engine/bullet_scenes.hpp"
#include "tests/engine/frame_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>

namespace {

enum class driver { none, max_step, truncate, make_safe, alone };
constexpr std::array<const char *, 5> driver_names{"none", "max_step", "truncate", "make_safe", "alone"};

constexpr const char *help =
    "usage: soft_bodies [--frames N] [--triangles N] [--scene NAME] [--driver NAME] [--json FILE] [--record FOLDER]\n"
    "\n"
    "Moves soft bodies of Bullet, and keeps each frame free of contact by each driver: none, which is Bullet's own\n"
    "collisions; after these cscd_detector_max_step, cscd_detector_truncate, or cscd_detector_make_safe; and alone, which\n"
    "is make_safe without Bullet's collisions. Crossing: frames in which something touches on the way, and in which\n"
    "triangles cross at the end. Frozen: frames in which vertices made less than a hundredth of their ways in the mean.\n"
    "Share: the mean of what vertices made of their ways, along them. Late: frames by which obstacles are. Ends with 1 if\n"
    "make_safe let anything touch, or froze, or if nothing touches without it.\n";

struct tally {
    double ms = 0.0, worst_ms = 0.0, engine_ms = 0.0, shares = 0.0, least = 1.0, late = 0.0, rounds = 0.0;
    unsigned frames = 0, crossing = 0, intersecting = 0, frozen = 0;
    std::array<double, CSCD_RESPONSE_COUNT> responses{};
};

/* The time of this process: others beside it do not count. */
double cpu_now_ms() {
    return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

const btVector3 &point_in(const cscd_view &view, std::size_t vertex) {
    return *reinterpret_cast<const btVector3 *>(static_cast<const unsigned char *>(view.data) +
                                                vertex * view.stride);
}
btVector3 &point_in(const cscd_mutable_view &view, std::size_t vertex) {
    return *reinterpret_cast<btVector3 *>(static_cast<unsigned char *>(view.data) + vertex * view.stride);
}

/* ---- one scene by one driver --------------------------------------------------------------------------- */

class engine_trial {
  public:
    engine_trial(bullet_kind kind, unsigned triangle_count, driver by)
        : scene_(kind, triangle_count, by != driver::alone), by_(by),
          safe_(scene_.soft_bodies(), scene_.obstacles(), 0.05 * scene_.spacing(), 0.4),
          wanted_(safe_.to.size()) {
        for (std::uint32_t o = 0; o < wanted_.size(); o++)
            wanted_[o].resize(cscd_mesh_object(safe_.mesh->get(), o).vertex_count);
    }

    void run_frame() {
        double begin = cpu_now_ms();
        scene_.step();
        sum_.engine_ms += cpu_now_ms() - begin;
        for (std::size_t o = 0; o < wanted_.size(); o++)
            for (std::size_t v = 0; v < wanted_[o].size(); v++) wanted_[o][v] = point_in(safe_.reached[o], v);
        begin = cpu_now_ms();
        const double obstacle_share = drive_motion();
        const double ms = cpu_now_ms() - begin;
        sum_.ms += ms;
        sum_.worst_ms = std::max(sum_.worst_ms, ms);
        sum_.late += 1.0 - obstacle_share;
        sum_.frames++;
        compare_motions();
        judge_frame();
        scene_.end_frame(obstacle_share);
    }

    const tally &sum() const {
        return sum_;
    }
    const safe_bodies &bodies() const {
        return safe_;
    }

  private:
    double longest_motion() const {
        double longest = 0.0;
        for (std::size_t o = 0; o < wanted_.size(); o++)
            for (std::size_t v = 0; v < wanted_[o].size(); v++)
                longest = std::max(longest, double((wanted_[o][v] - point_in(safe_.from[o], v)).length()));
        return longest;
    }

    void take_velocities() {
        for (const auto &nodes : safe_.bodies)
            for (btSoftBody::Node &node : nodes)
                node.m_v = (node.m_x - node.m_q) / bullet_scene::frame_seconds;
    }

    /* Obstacles that cannot get through go back as a whole, and all others have their way once more. */
    double truncate_motion() {
        const double radius = 2.0001 * longest_motion();
        double share = 1.0;
        if (radius == 0.0) return share;
        for (int round = 0; round < 2; round++) {
            const cscd_truncation cut = safe_.detector->truncate(safe_.from, safe_.to, radius, safe_.reached);
            if (cut.obstacle_fraction == 1.0) break;
            share *= cut.obstacle_fraction * (1.0 - 1e-6);
            if (round == 1) break;
            for (std::size_t o = 0; o < wanted_.size(); o++) {
                for (std::size_t v = 0; v < wanted_[o].size(); v++) {
                    const btVector3 start = point_in(safe_.from[o], v), way = wanted_[o][v] - start;
                    const bool given = o >= safe_.bodies.size();
                    point_in(safe_.reached[o], v) =
                        given ? start + static_cast<btScalar>(share) * way : wanted_[o][v];
                }
            }
        }
        return share;
    }

    double drive_motion() {
        double share = 1.0;
        if (by_ == driver::none) return share;
        if (by_ == driver::make_safe || by_ == driver::alone) {
            const cscd_safe_motion safe = safe_.end_step(bullet_scene::frame_seconds);
            for (std::size_t i = 0; i < sum_.responses.size(); i++)
                sum_.responses[i] += safe.response_counts[i];
            sum_.rounds += safe.rounds;
            return safe.obstacle_share;
        }
        if (by_ == driver::max_step)
            share = safe_.detector->max_step(safe_.from, safe_.to, safe_.reached).fraction;
        if (by_ == driver::truncate) share = truncate_motion();
        take_velocities();
        return share;
    }

    void compare_motions() {
        double shares = 0.0;
        std::size_t count = 0;
        for (std::size_t o = 0; o < safe_.bodies.size(); o++) {
            for (std::size_t v = 0; v < wanted_[o].size(); v++) {
                const btVector3 start = point_in(safe_.from[o], v);
                const btVector3 wanted = wanted_[o][v] - start, made = point_in(safe_.reached[o], v) - start;
                const double squared = double(wanted.length2());
                if (!(squared > 0.0) || safe_.bodies[o][v].m_im == 0) continue;
                const double share = std::clamp(double(made.dot(wanted)) / squared, 0.0, 1.0);
                shares += share;
                count++;
                sum_.least = std::min(sum_.least, share);
            }
        }
        const double mean = count > 0 ? shares / double(count) : 1.0;
        sum_.shares += mean;
        sum_.frozen += mean < 0.01;
    }

    void judge_frame() {
        cscd::detector_options exact;
        exact.method = CSCD_METHOD_NONE;
        cscd::detector judge(safe_.context, *safe_.mesh, exact);
        sum_.crossing += judge.step(safe_.from, safe_.to).size() > 0;
        sum_.intersecting += judge.find_intersections(safe_.to).crossing > 0;
    }

    bullet_scene scene_;
    driver by_;
    safe_bodies safe_;
    std::vector<std::vector<btVector3>> wanted_;
    tally sum_;
};

/* ---- options and tables -------------------------------------------------------------------------------- */

struct engine_options {
    unsigned frames = 360, triangles = 3000;
    std::string scene, driver, json, record;
};

bool read_options(int count, char **words, engine_options &out) {
    for (int i = 1; i < count; i += 2) {
        const std::string name = words[i], value = i + 1 < count ? words[i + 1] : "";
        if (value.empty()) return false;
        if (name == "--frames")
            out.frames = static_cast<unsigned>(std::strtoul(value.c_str(), nullptr, 10));
        else if (name == "--triangles")
            out.triangles = static_cast<unsigned>(std::strtoul(value.c_str(), nullptr, 10));
        else if (name == "--scene")
            out.scene = value;
        else if (name == "--driver")
            out.driver = value;
        else if (name == "--json")
            out.json = value;
        else if (name == "--record")
            out.record = value;
        else
            return false;
    }
    return out.frames > 0 && out.triangles >= 100;
}

void print_trial(const char *scene, const char *by, unsigned triangle_count, const tally &sum,
                 std::FILE *json) {
    const double frames = sum.frames;
    std::printf("%-7s %9u %-10s %8u %12u %7u %7.3f %7.3f %6.1f %8.2f %8.2f %9.2f\n", scene, triangle_count,
                by, sum.crossing, sum.intersecting, sum.frozen, sum.shares / frames, sum.least, sum.late,
                sum.ms / frames, sum.worst_ms, sum.engine_ms / frames);
    if (json == nullptr) return;
    std::fprintf(
        json,
        "{\"scene\": \"%s\", \"triangles\": %u, \"driver\": \"%s\", \"frames\": %u, \"crossing\": %u, "
        "\"intersecting\": %u, \"frozen\": %u, \"mean_share\": %.4f, \"least_share\": %.4f, \"late\": %.2f, "
        "\"ms\": %.3f, \"worst_ms\": %.2f, \"engine_ms\": %.3f, \"rounds\": %.2f, \"responses\": [",
        scene, triangle_count, by, sum.frames, sum.crossing, sum.intersecting, sum.frozen,
        sum.shares / frames, sum.least, sum.late, sum.ms / frames, sum.worst_ms, sum.engine_ms / frames,
        sum.rounds / frames);
    for (std::size_t i = 0; i < sum.responses.size(); i++)
        std::fprintf(json, "%s%.2f", i > 0 ? ", " : "", sum.responses[i] / frames);
    std::fputs("]}\n", json);
}

tally run_trial(bullet_kind kind, driver by, const engine_options &o, std::FILE *json) {
    const char *scene = bullet_kind_names[static_cast<std::size_t>(kind)],
               *name = driver_names[static_cast<std::size_t>(by)];
    engine_trial trial(kind, o.triangles, by);
    std::optional<frame_files> record;
    if (!o.record.empty()) record.emplace(o.record + "/" + scene + "-" + name, trial.bodies(), o.frames + 1);
    for (unsigned frame = 0; frame < o.frames; frame++) {
        if (record) record->add(trial.bodies().from);
        trial.run_frame();
    }
    if (record) record->add(trial.bodies().to);
    print_trial(scene, name, cscd_mesh_triangle_count(trial.bodies().mesh->get()), trial.sum(), json);
    return trial.sum();
}

/* Returns whether the drivers kept what they promise, and had something to do. */
bool run_all(const engine_options &o, std::FILE *json) {
    bool good = true, any_alone = false;
    unsigned crossing_alone = 0;
    std::puts(
        "scene   triangles driver     crossing intersecting  frozen   share   least   late       ms    worst Bullet, ms");
    for (std::size_t i = 0; i < bullet_kind_names.size() * driver_names.size(); i++) {
        const std::size_t kind = i / driver_names.size(), by = i % driver_names.size();
        if (!o.scene.empty() && o.scene != bullet_kind_names[kind]) continue;
        if (!o.driver.empty() && o.driver != driver_names[by]) continue;
        const driver chosen = static_cast<driver>(by);
        const tally sum = run_trial(static_cast<bullet_kind>(kind), chosen, o, json);
        any_alone |= chosen == driver::none;
        if (chosen == driver::none) crossing_alone += sum.crossing;
        if (chosen != driver::none && sum.crossing + sum.intersecting > 0) {
            std::printf("%s, %s: something touches\n", bullet_kind_names[kind], driver_names[by]);
            good = false;
        }
        if ((chosen == driver::make_safe || chosen == driver::alone) && sum.frozen > 0) {
            std::printf("%s, %s: frames are frozen\n", bullet_kind_names[kind], driver_names[by]);
            good = false;
        }
    }
    if (any_alone && o.scene.empty() && crossing_alone == 0)
        std::puts("nothing touches by Bullet alone, so nothing is tested");
    return good && !(any_alone && o.scene.empty() && crossing_alone == 0);
}

} // namespace

int main(int count, char **words) {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    engine_options o;
    if (!read_options(count, words, o)) {
        std::fputs(help, stderr);
        return 2;
    }
    std::FILE *json = o.json.empty() ? nullptr : std::fopen(o.json.c_str(), "w");
    if (!o.json.empty() && json == nullptr) {
        std::fprintf(stderr, "%s cannot be written\n", o.json.c_str());
        return 1;
    }
    try {
        const bool good = run_all(o, json);
        return (json == nullptr || std::fclose(json) == 0) && good ? 0 : 1;
    } catch (const cscd::error &trouble) {
        std::fprintf(stderr, "%s: %s\n", cscd_status_string(trouble.status()), trouble.what());
        return 1;
    }
}
