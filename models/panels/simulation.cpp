/* A cloth solver that works on positions (Müller et al. 2007), in floats, and goes only where cscd certifies the way. */
#include "models/panels/panels.hpp"

#include <algorithm>

namespace panels {

/* ---- the host's thread pool ---------------------------------------------------------------------------- */

thread_pool::thread_pool(unsigned thread_count) {
    for (unsigned i = 1; i < thread_count; i++) threads_.emplace_back([this] { work(); });
}

thread_pool::~thread_pool() {
    {
        std::lock_guard<std::mutex> hold(lock_);
        ends_ = true;
    }
    changed_.notify_all();
    for (std::thread &thread : threads_) thread.join();
}

/* Runs one task without the lock; false: there is none to be taken. */
bool thread_pool::run_next(std::unique_lock<std::mutex> &hold) {
    if (!task_ || next_ == count_) return false;
    const cscd::task task = *task_;
    const std::uint32_t index = next_++;
    running_++;
    hold.unlock();
    task(index);
    hold.lock();
    tasks_run_++;
    if (--running_ == 0 && next_ == count_) finished_.notify_one();
    return true;
}

void thread_pool::work() {
    std::unique_lock<std::mutex> hold(lock_);
    while (!ends_) {
        if (!run_next(hold)) changed_.wait(hold);
    }
}

void thread_pool::run(std::uint32_t count, cscd::task task) {
    std::unique_lock<std::mutex> hold(lock_);
    task_ = task;
    next_ = 0;
    count_ = count;
    changed_.notify_all();
    while (run_next(hold)) {
    }
    finished_.wait(hold, [this] { return running_ == 0; });
    task_.reset();
}

/* ---- constants and views ------------------------------------------------------------------------------- */

namespace {

constexpr int steps_per_frame = 4, passes = 20, rounds = 6;
constexpr float step_seconds = 1.0f / 240.0f, damping = 0.998f;

/* The distance below which pairs are kept apart, and the distance that they are kept at. */
constexpr float reach = 3.0f * separation, margin = 1.5f * separation;

const vec3 gravity{0.0f, 0.0f, -9.8f};

/* The mesh of all objects. */
std::vector<cscd_object_desc> describe(const scene &s) {
    std::vector<cscd_object_desc> all;
    for (const object &o : s.objects)
        all.push_back(cscd::object_of_triangles(static_cast<std::uint32_t>(o.points.size()), o.triangles));
    all[FLOOR].obstacle = true;
    return all;
}

std::vector<vec3> points_of(const std::vector<particle> &particles) {
    std::vector<vec3> all;
    for (const particle &p : particles) all.push_back(p.position);
    return all;
}

cscd_view positions_of(const std::vector<particle> &particles) {
    return cscd::view_of(particles, &particle::position);
}

} // namespace

/* ---- what cscd is told once ---------------------------------------------------------------------------- */

cscd::context_options simulation::host_options(unsigned thread_count) {
    cscd::context_options options;
    options.thread_count = thread_count;
    options.parallel_for = [this](std::uint32_t count, cscd::task task) { pool_.run(count, task); };
    return options;
}

/* All keep their distance but the ball from itself: so it is culled by its plan, and still must not touch itself. */
cscd::detector_options simulation::options_of() const {
    static const std::vector<cscd_object_rule> rules = [] {
        std::vector<cscd_object_rule> all(OBJECTS, cscd_object_rule_default());
        all[BALL].thickness_class = 1;
        return all;
    }();
    static const std::vector<double> distances{separation, separation, separation, 0.0};
    cscd::detector_options options;
    options.set_rules(rules, distances);
    options.set_seams(scene_.seams);
    return options;
}

simulation::simulation(std::uint32_t side, unsigned thread_count, bool certified)
    : scene_(make_scene(side)), pool_(thread_count), context_(host_options(thread_count)),
      mesh_(context_, describe(scene_)),
      detector_(context_, mesh_, cscd::plan(context_, mesh_, points_of(scene_.particles)), options_of()),
      certified_(certified) {
    reached_ = scene_.particles;
}

/* ---- the motion that the solver wants ------------------------------------------------------------------ */

void simulation::want_motion() {
    const vec3 sway = floor_sway(seconds_ + step_seconds);
    wanted_ = scene_.particles;
    for (particle &p : wanted_) {
        if (p.inverse_mass == 0.0f) continue;
        p.velocity += step_seconds * gravity;
        p.position += step_seconds * p.velocity;
    }
    for (std::uint32_t v = scene_.first[FLOOR]; v < scene_.first[OBJECTS]; v++)
        wanted_[v].position = scene_.objects[FLOOR].points[v - scene_.first[FLOOR]] + sway;
}

void simulation::keep_length(const spring &s) {
    particle &a = wanted_[s.a], &b = wanted_[s.b];
    const float masses = a.inverse_mass + b.inverse_mass;
    const vec3 across = b.position - a.position;
    const float now = length(across);
    if (masses == 0.0f || now == 0.0f) return;
    const vec3 change = ((now - s.length) / (now * masses)) * across;
    a.position += a.inverse_mass * change;
    b.position += -b.inverse_mass * change;
}

/* The ball keeps its shape, and does not turn. */
void simulation::keep_ball() {
    const std::uint32_t first = scene_.first[BALL], count = scene_.first[BALL + 1] - first;
    vec3 centre;
    for (std::uint32_t i = 0; i < count; i++) centre += wanted_[first + i].position;
    centre = (1.0f / static_cast<float>(count)) * centre;
    for (std::uint32_t i = 0; i < count; i++) {
        vec3 &x = wanted_[first + i].position;
        x += 0.5f * (centre + scene_.ball_shape[i] - x);
    }
}

void simulation::keep_apart(const barrier &b) {
    float distance = 0.0f, masses = 0.0f;
    for (std::size_t i = 0; i < 4; i++) {
        const particle &p = wanted_[b.vertices[i]];
        distance += b.weights[i] * dot(b.normal, p.position);
        masses += b.weights[i] * b.weights[i] * p.inverse_mass;
    }
    if (distance >= b.distance || masses == 0.0f) return;
    const float push = (b.distance - distance) / masses;
    for (std::size_t i = 0; i < 4; i++) {
        particle &p = wanted_[b.vertices[i]];
        p.position += (push * b.weights[i] * p.inverse_mass) * b.normal;
    }
}

/* Sewn vertices are at one place. */
void simulation::sew_seams() {
    for (const pair &seam : scene_.seams) {
        particle &a = wanted_[seam[0]], &b = wanted_[seam[1]];
        a.position = b.position = 0.5f * (a.position + b.position);
    }
}

void simulation::project() {
    for (int pass = 0; pass < passes; pass++) {
        for (const spring &s : scene_.springs) keep_length(s);
        keep_ball();
        for (const barrier &b : opening_) keep_apart(b);
        for (const barrier &b : barriers_) keep_apart(b);
        sew_seams();
    }
}

/* ---- what keeps it apart ------------------------------------------------------------------------------- */

void simulation::collect_barriers(report &out) {
    const cscd::proximities near = detector_.find_near(positions_of(scene_.particles), reach);
    barriers_.clear();
    for (const cscd_proximity &p : near) {
        if (opening_.empty()) out.least = std::min(out.least, p.distance / static_cast<double>(separation));
        if (!certified_) continue;
        barrier b;
        for (std::size_t i = 0; i < 4; i++) {
            b.vertices[i] = p.vertices[i];
            b.weights[i] = static_cast<float>(p.weights[i]);
        }
        b.normal = {static_cast<float>(p.normal[0]), static_cast<float>(p.normal[1]),
                    static_cast<float>(p.normal[2])};
        b.distance = std::min(margin, static_cast<float>(p.distance) + 0.1f * separation);
        barriers_.push_back(b);
    }
    out.near = std::max(out.near, near.size());
}

/* The pair that has limited a motion, if none of the barriers did. */
void simulation::add_barrier(const cscd_contact &limit) {
    const cscd_stencil stencil = detector_.mesh().stencil(limit.kind, limit.a, limit.b, limit.u, limit.v);
    barrier b;
    for (std::size_t i = 0; i < 4; i++) {
        b.vertices[i] = stencil.vertices[i];
        b.weights[i] = static_cast<float>(stencil.weights[i]);
    }
    b.normal = {static_cast<float>(limit.normal[0]), static_cast<float>(limit.normal[1]),
                static_cast<float>(limit.normal[2])};
    b.distance = margin;
    barriers_.push_back(b);
}

/* ---- steps --------------------------------------------------------------------------------------------- */

/* The pair that limits the motion becomes a barrier, and the motion is planned again; the last one goes as
 * far as it may. */
double simulation::go_as_far() {
    for (int round = 1;; round++) {
        project();
        if (!certified_) break;
        const cscd_free_step step = detector_.max_step(positions_of(scene_.particles), positions_of(wanted_),
                                                       cscd::view_of(reached_, &particle::position));
        waiting_ = detector_.waiting().features;
        if (!step.limited || round == rounds) return step.fraction;
        add_barrier(step.limit);
    }
    reached_ = wanted_;
    return 1.0;
}

void simulation::take_reached() {
    for (std::size_t v = 0; v < reached_.size(); v++) {
        particle &p = scene_.particles[v];
        p.velocity = (damping / step_seconds) * (reached_[v].position - p.position);
        p.position = reached_[v].position;
    }
}

void simulation::take_step(report &out) {
    want_motion();
    collect_barriers(out);
    out.motion += go_as_far();
    out.steps++;
    const cscd_counters counters = detector_.counters();
    const std::uint64_t culled = counters.plus + counters.minus;
    out.culled = out.steps == 1 ? culled : std::min(out.culled, culled);
    if (waiting_ == 0) opening_.clear();
    out.waiting = std::max(out.waiting, waiting_);
    take_reached();
    seconds_ += step_seconds;
}

void simulation::advance(report &out) {
    for (int i = 0; i < steps_per_frame; i++) take_step(out);
}

/* The vertices that were sewn are drawn apart, along x, until they have parted for good. */
void simulation::open_seam() {
    detector_.set_seams({});
    for (const pair &seam : scene_.seams)
        opening_.push_back(
            {{seam[1], seam[0], seam[0], seam[0]}, {1.0f, -1.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, margin});
    scene_.seams.clear();
}

/* The detector moves over to a new mesh, in which the left panel, the ball and the floor are what they were; the two
 * sides of the tear are drawn apart, along y. */
void simulation::tear_right_panel() {
    const tear done = panels::tear_panel(scene_);
    const object &panel = scene_.objects[RIGHT_PANEL];
    const cscd::object_change torn{
        RIGHT_PANEL,
        cscd::object_of_triangles(static_cast<std::uint32_t>(panel.points.size()), panel.triangles),
        done.origins,
        {}};
    const cscd::mesh_change change(context_, detector_.mesh(), {torn});
    detector_.change_mesh(change);
    std::vector<particle> particles;
    for (std::uint32_t origin : change.vertex_origins()) particles.push_back(scene_.particles[origin]);
    scene_.particles = reached_ = particles;
    make_springs(scene_);
    for (const pair &side : done.sides) {
        const std::uint32_t lower = scene_.first[RIGHT_PANEL] + side[0],
                            upper = scene_.first[RIGHT_PANEL] + side[1];
        opening_.push_back(
            {{upper, lower, lower, lower}, {1.0f, -1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, margin});
    }
}

std::size_t simulation::count_all_intersections() {
    const cscd::context context;
    cscd::detector fresh(context, detector_.mesh());
    return fresh.check(positions_of(scene_.particles)).size();
}

std::size_t simulation::count_intersections() {
    return detector_.check(positions_of(scene_.particles)).size();
}

} // namespace panels
