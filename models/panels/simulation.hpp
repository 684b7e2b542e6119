/* A cloth solver that works on positions, in floats, and goes only where cscd certifies the way. */
#pragma once

#include "models/panels/scene.hpp"
#include "models/panels/thread_pool.hpp"

#include <cscd/cscd.hpp>

namespace panels {

/* What happened since the last report. */
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
