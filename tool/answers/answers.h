/* The answers of check and replay: what intersects in each frame, between which parts, how deep, and the events that
 * these frames make up. */
#pragma once

#include "tool/answers/shown_depths.h"
#include "tool/answers/turned_parts.h"
#include "tool/io/io.h"

/* What was found in a frame. */
typedef struct frame_answer {
    uint32_t frame;          /* its index in the recording */
    bool checked;            /* else nothing was looked for, and only contacts are known */
    bool spaces_known;       /* it was looked at whether parts share space, and how deep */
    bool unlisted;           /* pairs are counted only, so nothing is known of faces, parts and depths */
    size_t crossing;         /* pairs of triangles that cross, */
    size_t touching;         /* that meet otherwise, duplicates aside, */
    size_t duplicates;       /* and that are one and the same */
    size_t contacts;         /* of the interval that ends here */
    uint32_t crossing_faces; /* so many triangles cross another one */
    size_t
        overlapping; /* pairs of parts without such pairs whose interiors meet: they share space and touch, */
    size_t same;     /* or both are copies of one solid; */
    size_t inside;   /* and parts of which something lies inside another one that they do not even touch */
    double depth, bound; /* the greatest depth, 0: none is known; and no point is deeper than the bound */
    bool without_area;   /* no triangle has an area, so that nothing could be looked at */
    uint32_t worst_parts
        [2]; /* of the worst, in the order of events (event_order.h); NO_PART: nobody knows, or there is none */
    double ms; /* how long it took */
} frame_answer;

/* How much what is found in a frame may take; 0: the library's defaults. */
typedef struct answer_limits {
    size_t memory; /* bytes */
    size_t work;   /* as cscd_intersection_options.max_work */
} answer_limits;

typedef struct answers {
    recording *recording;
    const part_names *parts;
    bool depths;        /* curves and depths are looked for */
    double depth_limit; /* until each is known to be above this or not; INFINITY: nobody asks */
    cscd_orientation orientation;
    answer_limits limits;
    shown_depths shown; /* of the frame found last */
    turned_parts turned;
    collapsed_parts collapsed; /* parts without a surface; their frames are places in `frames` */
    growable frames;           /* frame_answer, in their order */
    cscd_event *events;        /* when finished: by their first frames; frames are indices */
    size_t event_count;
    size_t *worst_first; /* places of events */
    cscd_event_tracker *tracker;
    uint32_t *seen;          /* per triangle: counted in the frame with this number in `frames`, from 1, */
    uint32_t *seen_parts;    /* and per part; the last is for what is in no part */
    size_t waiting_contacts; /* of an interval whose end has not come yet */
    size_t wanted;           /* so many frames are asked for; 0: nobody has said so */
    io_error unfinished;     /* why not all was looked at that was asked for; "": all was */
} answers;

/* The ignored pairs, which have the parts, outlive the answers. Without depths there are neither curves nor depths. What does not
 * fit the limits is left out, and the answers are unfinished. On false *out holds nothing to close. */
bool answers_open(recording *r, const ignore_pairs *ignored, bool depths, answer_limits limits, answers *out,
                  io_error *error);
void answers_close(answers *a); /* a zeroed struct is fine */

/* Is it known how deep an event is? If it has no depth, it is if somebody looked in all of its frames. */
bool answers_event_depth_known(const answers *a, const cscd_event *event);

/* Says how many frames are asked for: all of the recording, or those of a range. */
void answers_expect(answers *a, size_t frame_count);

/* Says that something was asked for and not looked at, and why: "frame 2 could not be read (...)". The first reason stays. From then
 * on no output calls the recording clean, and the exit code is not 0. Before answers_finish, whether frames follow or not. */
void answers_leave_unfinished(answers *a, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Why not all was looked at that was asked for; NULL: all was. */
const char *answers_unfinished(const answers *a);

/* Depths are to be known well enough to say whether they are above this. */
void answers_decide_depth(answers *a, double limit);

/* Makes the detector sum up by these parts. Once, before the first frame. */
bool answers_prepare(const answers *a, cscd_detector *detector, io_error *error);

/* The contacts of an interval, before the frame at its end. */
bool answers_add_contacts(answers *a, const cscd_contacts *contacts, io_error *error);

/* There are more contacts in the interval from a frame on than fit the memory; for answers_add_contacts there are none. */
void answers_leave_out_contacts(answers *a, uint32_t frame, size_t count);

/* Finds what intersects in a frame, for answers_add_found. *found is the detector's. If there are more pairs than fit the memory,
 * it counts those of each kind, and has no list: count is 0. The error does not name the frame. */
bool answers_find(const answers *a, cscd_detector *detector, const double *positions,
                  cscd_intersection_pairs *found, io_error *error);

/* Adds what was found in a frame, which comes after those before, and how long that took. *found is the detector's and ours
 * from then on, until the next call: what is not looked at with each other is left out. */
bool answers_add_found(answers *a, uint32_t frame, cscd_intersection_pairs *found, double ms,
                       io_error *error);

/* Adds what of a frame that was added is inside out, as cscd_patches says; NULL: nothing is, or nobody looked. */
void answers_add_turned(answers *a, uint32_t frame, const bool *turned);

/* Adds a frame in which nothing is looked for. */
bool answers_skip_frame(answers *a, uint32_t frame, io_error *error);

/* The last frame has come, be it earlier than expected: finds the events. Those of duplicates alone are left out,
 * and those that only follow from others (consequences.h). */
bool answers_finish(answers *a, io_error *error);

/* The frames so far, and how many there are. */
const frame_answer *answers_frames(const answers *a);
size_t answers_frame_count(const answers *a);

/* How many of the frames pass. */
typedef bool frame_test(const frame_answer *frame);
size_t answers_count(const answers *a, frame_test *test);

/* Is there one frame, and was no other one asked for? */
static inline bool answers_single(const answers *a) {
    return answers_frame_count(a) == 1 && a->wanted <= 1;
}

/* What stands behind the x of "A x B", or of "A x itself". */
static inline const char *answers_second_name(const answers *a, uint32_t first, uint32_t second) {
    return first == second ? "itself" : part_names_at(a->parts, second);
}

/* What the artist calls a frame, given by its index. */
static inline int32_t answers_frame_number(const answers *a, uint64_t frame) {
    return a->recording->frame_numbers[frame];
}

/* Was there anything to look at, and was it looked at? */
static inline bool frame_answer_checked(const frame_answer *frame) {
    return frame->checked && !frame->without_area;
}

static inline bool frame_answer_without_area(const frame_answer *frame) {
    return frame->without_area;
}

/* Does any pair of triangles in the frame intersect or touch, duplicates aside? */
static inline bool frame_answer_meets(const frame_answer *frame) {
    return frame->crossing + frame->touching > 0;
}

/* Do triangles cross, or do the interiors of two parts meet although none do? */
static inline bool frame_answer_crosses(const frame_answer *frame) {
    return frame->crossing + frame->overlapping + frame->inside + frame->same > 0;
}

/* Was the frame looked at, and nothing found in it: no pair of triangles, no triangle that is there twice, nothing inside of anything? */
static inline bool frame_answer_clean(const frame_answer *frame) {
    return frame_answer_checked(frame) && !frame_answer_meets(frame) && !frame_answer_crosses(frame) &&
           frame->duplicates == 0;
}
