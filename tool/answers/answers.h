/* The answers of check and replay: what was found in each frame, the events that frames make up, the rules by
 * which a run fails, and the sentences, tables and files that say it. */
#pragma once

#include "cscd/events.h"
#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/common/options.h"
#include "tool/common/part_names.h"
#include "tool/io/io.h"
#include "tool/io/json.h"
#include "tool/io/output_file.h"

#include <stdbool.h>
#include <stdio.h>

/* ---- lengths and their units --------------------------------------------------------------------------- */

/* One unit of a recording's coordinates. */
typedef struct length_unit {
    const char *name; /* "mm"; NULL: nobody knows */
    double metres;    /* of one of them */
} length_unit;

/* um, mm, cm, dm, m, km, in, ft; false, and *out untouched, for another text. */
bool length_unit_from_name(const char *text, length_unit *out);

/* A length of the command line: `2mm`, or `2`, which is in the files' unit. */
typedef struct length_given {
    bool given;
    double value;
    length_unit unit; /* its name is NULL: that of the files */
} length_given;

/* False for a text that is no length, or a negative one. */
bool length_given_parse(const char *text, length_given *out);

/* The length in the unit of the files. The error says that nobody knows what that is. */
bool length_given_convert(const length_given *length, const length_unit *files, double *out, io_error *error);

enum { LENGTH_TEXT_SIZE = 40 };

/* A length of the files for people, three digits of it: "12.4 mm", or "0.0124" where nobody knows the unit.
 * Metric lengths are given in um, mm, m or km, whichever suits. Returns the text. */
const char *length_text(double length, const length_unit *files, char text[LENGTH_TEXT_SIZE]);

/* ---- events -------------------------------------------------------------------------------------------- */

/* Sorts pointers into one array. What crosses or overlaps comes before what touches, then contacts. What is
 * only in itself comes after all others: some other part cuts it, and the nearest surface to what that buries
 * happens to be its own. Of one rank the deeper events come first, then those with longer curves, more pairs,
 * more contacts, and of those that have all of these in common the one that stands first in the array. */
void event_order_sort(const cscd_event **events, size_t count);

/* Leaves out the events of duplicates alone, and those of one part in itself, without a pair or a contact,
 * that happen while another event of the part has pairs: some part cuts this one, and the surface nearest to
 * what that buries happens to be its own. What lies in itself at any other time stays. The others keep their
 * order. Returns false, and changes nothing, when out of memory. */
bool consequences_leave_out(cscd_event *events, size_t *count);

/* ---- depths that are shown ----------------------------------------------------------------------------- */

/* Depths of what is looked at with each other. The library leaves out pairs of triangles, but not what lies
 * inside of what: where curves are left out, a patch goes on into the other object, and whether it counts as
 * inside is chance. */
typedef struct shown_depths {
    const ignore_pairs *ignored;
    growable items, patches; /* cscd_depth, cscd_patch_depth: what is left */
    cscd_depths list;        /* of these */
    const cscd_depths *all;  /* the library's, until its next call */
} shown_depths;

shown_depths shown_depths_of(const ignore_pairs *ignored); /* of a whole recording; they outlive it */
void shown_depths_free(shown_depths *s);

/* Leaves out what ignored pairs say of a frame: found->depths is this list from now on, until the next call.
 * False when out of memory. */
bool shown_depths_choose(shown_depths *s, cscd_intersections *found);

/* ---- parts that are inside out, or have no surface ----------------------------------------------------- */

/* A number of frames, and the indices of the first and the last of them. */
typedef struct turned_frames {
    uint32_t count, first, last;
} turned_frames;

/* Parts that are inside out, and are taken as turned around. */
typedef struct turned_parts {
    const recording *recording;
    const part_names *names;
    turned_frames *components; /* of each component */
    uint32_t *parts;           /* of each component: that of its first triangle */
    turned_frames any;         /* frames in which some component was */
    uint32_t frame_count;      /* that were looked at */
} turned_parts;

/* False: out of memory, and *out holds nothing. names outlive it. */
bool turned_parts_open(const recording *r, const part_names *names, turned_parts *out);
void turned_parts_close(turned_parts *t); /* a zeroed struct is fine */

/* Adds a frame, of which the library says per component what was turned; NULL: nothing. */
void turned_parts_add(turned_parts *t, uint32_t frame, const bool *turned);

/* A note for people, if there was something: "part wheel is inside out; it was taken as turned around". */
void turned_parts_tell(const turned_parts *t);

/* The member "inside_out": an item for each component that ever was. */
void turned_parts_write(const turned_parts *t, json *out);

/* The frames of a part: in `whole` all of its triangles had no area, in `partly` those of some pieces of
 * it. */
typedef struct collapsed_part {
    frame_list whole, partly;
} collapsed_part;

/* Parts without a surface. */
typedef struct collapsed_parts {
    const recording *recording;
    const part_names *names;
    collapsed_part *parts; /* per part; NULL: no frame has any */
    uint32_t *sizes;       /* per part: its triangles, */
    uint32_t *without;     /* and those in collapsed components of the present frame */
    bool *components;      /* per component: it is collapsed in the present frame */
} collapsed_parts;

collapsed_parts collapsed_parts_of(const recording *r, const part_names *names);
void collapsed_parts_free(collapsed_parts *c);

/* Adds what was found in a frame. frame: a number of the caller's, above those before. False: no memory. */
bool collapsed_parts_add(collapsed_parts *c, uint32_t frame, const cscd_intersections *found);

/* The frames of a part; NULL: it always had a surface. */
const collapsed_part *collapsed_parts_at(const collapsed_parts *c, uint32_t part);

/* ---- answers ------------------------------------------------------------------------------------------- */

/* The findings of a frame. */
typedef struct frame_answer {
    uint32_t frame;          /* its index in the recording */
    bool checked;            /* else nothing was looked for, and only contacts are known */
    bool spaces_known;       /* it was looked at whether parts share space, and how deep */
    bool unlisted;           /* pairs are counted only, so nothing is known of faces, parts and depths */
    size_t crossing;         /* pairs of triangles that cross, */
    size_t touching;         /* that meet otherwise, duplicates aside, */
    size_t duplicates;       /* and that are one and the same */
    size_t contacts;         /* of the interval that ends here */
    uint32_t crossing_faces; /* triangles that cross another one */
    size_t
        overlapping; /* pairs of parts without such pairs whose interiors meet: they share space and touch, */
    size_t same;     /* or both are copies of one solid; */
    size_t inside;   /* and parts of which something lies inside another one that they do not even touch */
    double depth, bound; /* the greatest depth, 0: none is known; and no point is deeper than the bound */
    bool without_area;   /* no triangle has an area, so that nothing could be looked at */
    uint32_t
        worst_parts[2]; /* of the worst, in the order of events; NO_PART: nobody knows, or there is none */
    double ms;          /* how long it took */
} frame_answer;

/* Limits of what is found in a frame; 0: the library's defaults. */
typedef struct answer_limits {
    size_t memory; /* bytes */
    size_t work;   /* as cscd_intersection_options.max_work */
} answer_limits;

/* All that is known of a run. */
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
    size_t wanted;           /* frames that are asked for; 0: nobody has said how many */
    io_error unfinished;     /* why not all was looked at that was asked for; "": all was */
} answers;

/* The ignored pairs, which have the parts, outlive the answers. Without depths there are neither curves nor
 * depths. What does not fit the limits is left out, and the answers are unfinished. On false *out holds
 * nothing to close. */
bool answers_open(recording *r, const ignore_pairs *ignored, bool depths, answer_limits limits, answers *out,
                  io_error *error);
void answers_close(answers *a); /* a zeroed struct is fine */

/* True if it is known how deep an event is. Without a depth, it is known if somebody looked in all of its
 * frames. */
bool answers_event_depth_known(const answers *a, const cscd_event *event);

/* Says how many frames are asked for: all of the recording, or those of a range. */
void answers_expect(answers *a, size_t frame_count);

/* Says that something was asked for and not looked at, and why: "frame 2 could not be read (...)". The first
 * reason stays. From then on no output calls the recording clean, and the exit code is not 0. Before
 * answers_finish, whether frames follow or not. */
void answers_leave_unfinished(answers *a, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The reason why not all was looked at that was asked for; NULL: all was. */
const char *answers_unfinished(const answers *a);

/* Depths are to be known well enough to say whether they are above this. */
void answers_decide_depth(answers *a, double limit);

/* Makes the detector sum up by these parts. Once, before the first frame. */
bool answers_prepare(const answers *a, cscd_detector *detector, io_error *error);

/* The contacts of an interval, before the frame at its end. */
bool answers_add_contacts(answers *a, const cscd_contacts *contacts, io_error *error);

/* There are more contacts in the interval from a frame on than fit the memory; for answers_add_contacts there
 * are none. */
void answers_leave_out_contacts(answers *a, uint32_t frame, size_t count);

/* Finds what intersects in a frame, for answers_add_found. *found is the detector's. If there are more pairs
 * than fit the memory, it counts those of each kind, and has no list: count is 0. The error does not name the
 * frame. */
bool answers_find(const answers *a, cscd_detector *detector, const double *positions,
                  cscd_intersections *found, io_error *error);

/* Adds what was found in a frame, which comes after those before, and how long that took. *found is the
 * detector's and ours from then on, until the next call: what is not looked at with each other is left
 * out. */
bool answers_add_found(answers *a, uint32_t frame, cscd_intersections *found, double ms, io_error *error);

/* Adds what of a frame that was added is inside out, as cscd_patches says; NULL: nothing is, or nobody
 * looked. */
void answers_add_turned(answers *a, uint32_t frame, const bool *turned);

/* Adds a frame in which nothing is looked for. */
bool answers_skip_frame(answers *a, uint32_t frame, io_error *error);

/* The last frame has come, be it earlier than expected: finds the events. Those of duplicates alone are left
 * out, and those that only follow from others. */
bool answers_finish(answers *a, io_error *error);

/* The frames so far, and how many there are. */
const frame_answer *answers_frames(const answers *a);
size_t answers_frame_count(const answers *a);

/* Counts the frames that pass the test. */
typedef bool frame_test(const frame_answer *frame);
size_t answers_count(const answers *a, frame_test *test);

/* True if there is one frame, and no other one was asked for. */
static inline bool answers_single(const answers *a) {
    return answers_frame_count(a) == 1 && a->wanted <= 1;
}

/* The name behind the x of "A x B", or of "A x itself". */
static inline const char *answers_second_name(const answers *a, uint32_t first, uint32_t second) {
    return first == second ? "itself" : part_names_at(a->parts, second);
}

/* The artist's number of a frame, which is given by its index. */
static inline int32_t answers_frame_number(const answers *a, uint64_t frame) {
    return a->recording->frame_numbers[frame];
}

/* True if there was something to look at, and it was looked at. */
static inline bool frame_answer_checked(const frame_answer *frame) {
    return frame->checked && !frame->without_area;
}

static inline bool frame_answer_without_area(const frame_answer *frame) {
    return frame->without_area;
}

/* True if any pair of triangles in the frame intersects or touches, duplicates aside. */
static inline bool frame_answer_meets(const frame_answer *frame) {
    return frame->crossing + frame->touching > 0;
}

/* True if triangles cross, or the interiors of two parts meet although none do. */
static inline bool frame_answer_crosses(const frame_answer *frame) {
    return frame->crossing + frame->overlapping + frame->inside + frame->same > 0;
}

/* True if the frame was looked at and nothing was found in it: no pair of triangles, no triangle that is
 * there twice, nothing inside of anything. */
static inline bool frame_answer_clean(const frame_answer *frame) {
    return frame_answer_checked(frame) && !frame_answer_meets(frame) && !frame_answer_crosses(frame) &&
           frame->duplicates == 0;
}

/* ---- rules --------------------------------------------------------------------------------------------- */

/* A run counts as failed (exit code 3) by what --fail-on, --fail-depth and --max-faces say. */

/* The values of --fail-on; each includes those before it. */
typedef enum fail_kind {
    FAIL_ON_NOTHING,
    FAIL_ON_CROSSING, /* triangles that cross */
    FAIL_ON_TOUCHING, /* or meet otherwise, or are there twice */
    FAIL_ON_CONTACT   /* or come into contact between two frames */
} fail_kind;

/* As the command line has them; zeroed: nothing fails. */
typedef struct fail_options {
    fail_kind kind;
    length_given depth;  /* a point deeper than this fails */
    bool faces_limited;  /* more triangles that cross another one */
    uint32_t most_faces; /* than this, in one frame, fail */
} fail_options;

typedef struct fail_rules {
    fail_options options;
    length_unit unit; /* of the files */
    double depth;     /* that of the options, in it */
} fail_rules;

/* The error says that a depth has a unit and the files have none. */
bool fail_rules_create(const fail_options *options, const length_unit *unit, fail_rules *out,
                       io_error *error);

/* True if there is any rule. */
bool fail_rules_any(const fail_rules *rules);

enum { FAIL_TEXT_SIZE = 400 };

/* True if a frame fails. The text then says what of it does. */
bool fail_rules_meet(const fail_rules *rules, const answers *a, const frame_answer *frame,
                     char text[FAIL_TEXT_SIZE]);

/* The reason why a frame can neither pass nor fail: no triangle in it has an area. */
#define FAIL_WITHOUT_AREA "no triangle has an area, so there was nothing to look at"

/* The reason why a frame that does not fail does not pass, either: nothing was looked at, or what a rule asks
 * for did not fit the memory. NULL: it passes. */
const char *fail_rules_unknown(const fail_rules *rules, const answers *a, const frame_answer *frame);

/* True if there is a rule that no frame meets, although something may hide in frames in which no triangle has
 * an area. */
bool fail_rules_undecided(const fail_rules *rules, const answers *a);

/* True if a frame that was looked at fails. Says so on standard error. */
bool fail_rules_failed(const fail_rules *rules, const answers *a);

/* Says on standard error why a run came to no end, and returns EXIT_BAD_INPUT. Where the first line has
 * been printed and gives this reason, and standard output goes to the same terminal or file, it is not
 * said again. */
int fail_unfinished(const answers *a, bool printed, const char *reason);

/* The exit code of a run that ended without an error: EXIT_CONTACT if any frame fails, and then it says on
 * stderr how many do and what the first does wrong; else EXIT_BAD_INPUT if not all was looked at that was
 * asked for, which is said by fail_unfinished. */
int fail_rules_exit_code(const fail_rules *rules, const answers *a, bool printed);

/* ---- for people ---------------------------------------------------------------------------------------- */

/* A sentence, which comes first, and tables of events and frames. */

/* Prints which frames cross or touch, how many events there are and which one is the worst:
 *
 *     Frames 17 to 43 cross (27 of 48). 5 events, worst: forearm.L x forearm.R, frames 21 to 29, 12.4 mm deep at frame 24.
 *
 * Of a single frame, how many triangles cross. Where not all was looked at that was asked for (answers_unfinished), that comes
 * first, and nothing is called clean; where less was asked for than the recording has, the frames are named. After
 * answers_finish. */
void answers_print_sentence(FILE *out, const answers *a, const length_unit *unit);

/* A run that passes because pairs are left out says so: " As asked, 3 of 6 pairs of parts were not looked
 * at.", or nothing. */
void ignored_pairs_say(FILE *out, const ignore_pairs *ignored);

/* Prints on the standard output a row for each event, as many as a screen holds; nothing where there is
 * none. */
void answers_print_events(const answers *a, const length_unit *unit);

/* The same for each frame that crosses or touches (pairs, share of the triangles that cross another one,
 * depth, milliseconds), and how many are clean. */
void answers_print_frames(const answers *a, const length_unit *unit);

/* ---- options ------------------------------------------------------------------------------------------- */

typedef struct answer_options {
    length_unit unit; /* its name is NULL: what the files say */
    fail_options fail;
    const char *events_path, *junit_path; /* NULL: not given */
    bool no_depths;                       /* pairs only */
    bool as_given;                        /* what is inside out is not turned around */
    answer_limits limits;
    bool timings; /* print what a developer wants to know as well */
} answer_options;

/* Their rows, but --fail-on, of which each command has kinds of its own. Places count from answer_options. */
extern const option_list answer_rows;

/* A rule passes nothing that the run does not look at: false if one would, and the error says which. */
bool answer_options_agree(const answer_options *o, io_error *error);

/* The unit that the options give; else the metre where all files are glTF, else none that anybody knows. */
length_unit answer_options_unit(const answer_options *o, const recording *r);

/* The files that the options ask for. */
typedef struct answer_outputs {
    const answer_options *options;
    output_file events, junit;
} answer_outputs;

/* Before anything is printed, because an output may be the standard output. Whatever this returns,
 * answer_outputs_close is due. */
bool answer_outputs_open(const answer_options *o, answer_outputs *out, io_error *error);

/* Writes them; answers that are not there (NULL) leave older files as they are. A zeroed struct is fine.
 * suite: what the recording is called. */
bool answer_outputs_close(answer_outputs *outputs, const answers *a, const fail_rules *rules,
                          const char *suite, io_error *error);

/* ---- files --------------------------------------------------------------------------------------------- */

/* Members of a JSON object, a CSV file of the events, and a JUnit file for continuous integration. */

/* Writes the member "events", and "unit": what one unit of lengths is, or null. Frames have the artist's
 * numbers, triangles and faces those of their model files. */
void answers_write_json(const answers *a, const length_unit *unit, json *out);

/* Writes the members of a frame that was checked: "crossing" (do any triangles cross?), "clean" (was nothing
 * found, not even what touches, is there twice or lies inside?), how many pairs of each sort, how many
 * triangles cross another one, their share, and the greatest depth. */
void answers_write_frame(const answers *a, const frame_answer *frame, json *out);

/* Writes a row for each event, in the order of their first frames. */
void answers_write_csv(const answers *a, FILE *file);

/* Writes a test case for each frame. It fails by the rules; without rules it fails if the frame crosses. A
 * frame is an error if no triangle in it has an area, or if nobody knows whether it fails, because what says
 * so did not fit the limits. Where not all was looked at (answers_unfinished), a last case is an error.
 * suite: what the recording is called. */
void answers_write_junit(const answers *a, const fail_rules *rules, const char *suite, FILE *file);
