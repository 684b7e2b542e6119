/* A program with cloth, in C++: a scene, a thread pool of its own, and a solver that goes only where cscd certifies the way. */
#pragma once

#include <cscd/cscd.hpp>

#include <array>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace panels {

/* ---- vectors of three floats --------------------------------------------------------------------------- */

struct vec3 {
    float x = 0.0f, y = 0.0f, z = 0.0f;
};

inline vec3 operator+(vec3 a, vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline vec3 operator-(vec3 a, vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline vec3 operator*(float s, vec3 a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline vec3 &operator+=(vec3 &a, vec3 b) {
    return a = a + b;
}
inline float dot(vec3 a, vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float length(vec3 a) {
    return std::sqrt(dot(a, a));
}

/* ---- the scene ----------------------------------------------------------------------------------------- */

struct particle {
    vec3 position, velocity, rest;
    float inverse_mass; /* 0: it is held, or belongs to the floor */
};

using triple = std::array<std::uint32_t, 3>;
using pair = std::array<std::uint32_t, 2>;

/* The points and triangles of one object, by its own vertices. */
struct object {
    std::vector<vec3> points;
    std::vector<triple> triangles;
};

/* A length that is kept. */
struct spring {
    std::uint32_t a, b;
    float length;
};

enum object_name : std::uint32_t { LEFT_PANEL, RIGHT_PANEL, BALL, FLOOR, OBJECTS };

/* In metres; cloth and what is near it keep this distance. */
constexpr float separation = 0.01f;

struct scene {
    std::array<object, OBJECTS> objects;
    std::array<std::uint32_t, OBJECTS + 1> first; /* vertex of each object; and their number */
    std::vector<particle> particles;
    std::vector<pair> seams;
    std::vector<spring> springs;  /* of the panels */
    std::vector<vec3> ball_shape; /* seen from its centre */
};

/* side: squares along a panel's side. */
scene make_scene(std::uint32_t side);

/* The changes that a tear has made to a panel. */
struct tear {
    std::vector<std::uint32_t> origins; /* which vertex of the panel each one was */
    std::vector<pair> sides;            /* vertices of the panel that were one: towards -y, and towards y */
};

/* Tears the right panel in its middle, from the seam two thirds of the way to its held side. It has more
 * vertices then, and the caller places the particles again. */
tear tear_panel(scene &s);

/* Numbers the vertices of all objects, and makes the springs of the panels from the particles' rest. */
void number_vertices(scene &s);
void make_springs(scene &s);

/* Returns the displacement of the floor after these seconds. */
vec3 floor_sway(float seconds);

/* ---- a host's thread pool ------------------------------------------------------------------------------ */

class thread_pool {
  public:
    explicit thread_pool(unsigned thread_count);
    ~thread_pool();
    thread_pool(const thread_pool &) = delete;
    thread_pool &operator=(const thread_pool &) = delete;

    /* Calls task(i) for every i below count, on all threads and on this one, and returns when all have returned. */
    void run(std::uint32_t count, cscd::task task);

    std::uint64_t tasks_run() const {
        return tasks_run_;
    }

  private:
    void work();
    bool run_next(std::unique_lock<std::mutex> &hold);

    std::vector<std::thread> threads_;
    std::mutex lock_;
    std::condition_variable changed_, finished_;
    std::optional<cscd::task> task_; /* none: there is no work */
    std::uint32_t next_ = 0, count_ = 0, running_ = 0;
    std::uint64_t tasks_run_ = 0;
    bool ends_ = false;
};

/* ---- the solver ---------------------------------------------------------------------------------------- */

/* The events since the last report. */
struct report {
    std::size_t waiting =
        0; /* pairs that have not been apart since their seam was opened, most at one time */
    unsigned steps = 0;
    double motion = 0.0;      /* the sum of the shares of the wanted motions that were free */
    std::size_t near = 0;     /* pairs, most at one time */
    double least = HUGE_VAL;  /* the least distance of a pair, in separations, while none waits */
    std::uint64_t culled = 0; /* triangles of the ball that no pair is looked at for, least in a step */
};

class simulation {
  public:
    /* certified: false: it goes where it wants, and what keeps pairs apart is left out. */
    simulation(std::uint32_t side, unsigned thread_count, bool certified = true);

    /* Goes on by one frame. Throws cscd::error. */
    void advance(report &out);

    /* The panels are no longer sewn together. */
    void open_seam();

    /* The right panel tears in its middle. */
    void tear_right_panel();

    /* Every pair of triangles that intersect, but neighbours at the seam, and pairs of an opened one that wait. */
    std::size_t count_intersections();

    /* Every pair, by a detector that knows of no seam and of no earlier step. */
    std::size_t count_all_intersections();

    const std::vector<particle> &particles() const {
        return scene_.particles;
    }
    std::uint64_t tasks_run() const {
        return pool_.tasks_run();
    }
    std::uint32_t triangle_count() const {
        return detector_.mesh().triangle_count();
    }
    std::size_t waiting() const {
        return waiting_;
    }
    float seconds() const {
        return seconds_;
    }

  private:
    /* Two points, sums of four particles with weights, that shall stay so far apart along a normal. */
    struct barrier {
        std::array<std::uint32_t, 4> vertices;
        std::array<float, 4> weights;
        vec3 normal;
        float distance;
    };

    cscd::context_options host_options(unsigned thread_count);
    cscd::detector_options options_of() const;
    void take_step(report &out);
    void want_motion();
    void collect_barriers(report &out);
    void add_barrier(const cscd_contact &limit);
    void project();
    void keep_length(const spring &s);
    void keep_ball();
    void keep_apart(const barrier &b);
    void sew_seams();
    double go_as_far();
    void take_reached();

    scene scene_;
    thread_pool pool_;
    cscd::context context_;
    cscd::mesh mesh_;
    cscd::detector detector_;
    bool certified_;
    std::vector<particle> wanted_, reached_;
    std::vector<barrier> barriers_, opening_;
    std::size_t waiting_ = 0; /* pairs, at the last step */
    float seconds_ = 0.0f;
};

} // namespace panels
