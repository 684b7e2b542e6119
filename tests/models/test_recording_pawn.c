/* The whole of pawn-drop is a good recording: soft, of moderate speed, with contacts at times, and
 * healing. */
#include "models/common/motion.h"
#include "models/softbody/softbody.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* Sanitizer builds run only to the first contacts, since the whole takes half a minute there. */
enum { FRAMES = PACED(150, 40) };

/* The measurements, and the frames with intersections. */
typedef struct measured {
    recording_motion totals;
    bool intersects[FRAMES];
    double first_energy, most_energy, last_energy, lowest;
} measured;

static measured m;

static void measure_frame(const recorder *r, uint32_t frame) {
    uint32_t intersecting_before = m.totals.intersecting_frames;
    if (frame > 0) assert_int_equal(recording_motion_add(&m.totals, r->frame), CSCD_OK);
    m.intersects[frame] = m.totals.intersecting_frames > intersecting_before;
    m.last_energy = recorder_energy(r);
    m.most_energy = fmax(m.most_energy, m.last_energy);
    for (uint32_t v = 0; v < r->shape.vertex_count; v++) m.lowest = fmin(m.lowest, r->frame[v * 3 + 2]);
}

static int record_pawn(void **state) {
    (void)state;
    recorder r;
    io_error error;
    const soft_scene *s = soft_scene_find("pawn-drop");
    if (s == NULL || s->frame_count < FRAMES || !recorder_open(s, NULL, &r, &error)) return -1;
    if (recording_motion_begin(r.mesh, r.frame, &m.totals) != CSCD_OK) return -1;
    m.first_energy = recorder_energy(&r);
    measure_frame(&r, 0);
    for (uint32_t frame = 1; frame < FRAMES; frame++) {
        if (!recorder_advance(&r, &error)) return -1;
        measure_frame(&r, frame);
    }
    recording_motion counts = m.totals;
    recording_motion_free(&m.totals);
    m.totals = counts; /* only the numbers remain valid; the memory has been freed */
    recorder_close(&r);
    return 0;
}

TEST(is_visibly_soft) {
    assert_int_equal(m.totals.frame_count, FRAMES);
    assert_true(m.totals.soft_frames * 4 >= FRAMES);
    assert_true(m.totals.largest_residual > 0.05 && m.totals.largest_residual < 0.4);
}

TEST(moves_a_few_edge_lengths_at_most) {
    assert_true(m.totals.largest_motion > 0.5 && m.totals.largest_motion < 5.0);
}

TEST(runs_into_itself_at_times) {
    uint32_t intervals = FRAMES - 1, contacts = m.totals.contact_intervals;
    print_message("contacts in %u of %u intervals, intersections in %u frames\n", contacts, intervals,
                  m.totals.intersecting_frames);
#ifdef SLOW_MACHINE
    assert_true(contacts > 0);
#else
    assert_true(contacts * 100 >= intervals * 15 && contacts * 100 <= intervals * 60);
#endif
}

/* Intersections begin and end. */
TEST(intersections_heal) {
    uint32_t begun = 0, healed = 0;
    assert_false(m.intersects[0]);
    for (uint32_t frame = 1; frame < FRAMES; frame++) {
        begun += m.intersects[frame] && !m.intersects[frame - 1];
        healed += !m.intersects[frame] && m.intersects[frame - 1];
    }
    assert_true(begun > 0);
#ifndef SLOW_MACHINE
    assert_true(healed > 0 && healed + 1 >= begun);
#else
    assert_true(healed <= begun);
#endif
}

/* The body never gains energy, loses a part of that of its height, and ends on the ground. */
TEST(comes_down_on_the_ground) {
    assert_true(m.most_energy <= m.first_energy * (1.0 + 1e-9));
    assert_true(m.last_energy > 0.0 && m.last_energy < 0.9 * m.first_energy);
    assert_true(m.lowest > -1e-9 && m.lowest < 0.01);
}

AROUND_ALL(record_pawn, NULL)
