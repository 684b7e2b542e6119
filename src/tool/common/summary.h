/* The JSON summary of a replay, written interval by interval, and the table at its end. */
#pragma once

#include "src/tool/common/plan_source.h"

/* What is known of a frame after its static check. */
typedef enum frame_state { FRAME_UNCHECKED, FRAME_EMBEDDED, FRAME_CROSSING } frame_state;

typedef enum interval_state {
    INTERVAL_CLEAN,
    INTERVAL_CONTACT,
    INTERVAL_PENETRATING,
    INTERVAL_UNKNOWN
} interval_state;

const char *interval_state_name(interval_state state);

/* One interval's results, as the summary and the table need them. */
typedef struct interval_result {
    uint32_t frame;
    interval_state state;
    size_t contact_count;
    double earliest_toi;           /* of the contacts, where there are any */
    const cscd_detector *detector; /* for the guarantees of this, its last step */
    cscd_timings timings;          /* check_ms: of the frame at the interval's end */
    cscd_counters counters;
} interval_result;

typedef struct column {
    double sum, max;
} column;

/* Sums over the intervals so far. */
typedef struct totals {
    uint32_t intervals, intervals_with_contact, states[4];
    uint32_t frames_checked, frames_crossing, first_contact_frame;
    uint32_t contradictions;     /* clean intervals that end crossing: contacts that were lost */
    uint32_t intervals_complete; /* every component's contacts are complete */
    uint64_t vf, ee, bounded, static_checks;
    column update, orientation, contour, traversal, contact, proof, check, total, pcp, tests, plus, minus,
        clean, passes;
} totals;

void totals_add(totals *t, const interval_result *result, const cscd_mesh *mesh);
void totals_print_table(const totals *t, cscd_method method);

typedef struct summary_writer summary_writer;

/* path NULL: no file. keep_text: summary_close can give all of it. */
bool summary_open(const char *path, bool keep_text, const cscd_mesh *mesh, summary_writer **out,
                  io_error *error);
/* Each interval reaches the system at once. */
bool summary_add_interval(summary_writer *w, const interval_result *result, io_error *error);
bool summary_add_frame(summary_writer *w, uint32_t frame, frame_state state, io_error *error);

typedef struct summary_ending {
    const totals *totals;
    const recording *recording;
    const plan_choice *plan;
    const char *mode, *model_path;
    cscd_volume volume;
    const char *const *frame_paths;
    size_t frame_path_count;
    int argument_count;
    char **arguments;
    double min_separation;
    const char *stopped_by; /* why not every interval is there; NULL when all are */
} summary_ending;

/* Writes the frames, the summary and the provenance, and closes. text NULL, or with keep_text: all that was
 * written, to be freed, also when the file could not be; NULL when there was no memory for it. */
bool summary_close(summary_writer *w, const summary_ending *ending, char **text, io_error *error);
