/* Reports: one HTML page that shows a replay, a plan, replays side by side, or what was untangled, or lists many
 * jobs, and needs no network. */
#pragma once

#include "cscd/cscd.h"
#include "tool/common/options.h"
#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- options ------------------------------------------------------------------------------------------- */

/* The options of a command about the report that it writes. */
typedef struct report_request {
    const char *path;                               /* NULL: no report */
    const char *scenery_path, *scenery_frames_path; /* NULL: none */
    const char *title;                              /* NULL: the model's file */
    up_axis up;
} report_request;

/* False, with the reason, if the options contradict each other. */
bool report_request_agrees(const report_request *r, io_error *error);

/* ---- orientations of an interval ----------------------------------------------------------------------- */

/* The orientations of triangles towards their regions' detector points in one interval, and the places of
 * these points. */
typedef struct orientation_row {
    uint32_t triangle_count,
        region_count;    /* no regions: the method has no detector points, and there are no orientations */
    double (*points)[6]; /* per region: where it is at the start, and at the end */
    uint8_t *facing;     /* two bits a triangle, four to a byte, the first lowest: 0: neither, 1: S+, 2: S- */
} orientation_row;

/* Bytes of facing. */
static inline size_t orientation_row_size(uint32_t triangle_count) {
    return ((size_t)triangle_count + 3) / 4;
}

/* Room for the rows of a detector, filled by _take. False: out of memory; *out then holds nothing to free. */
bool orientation_row_create(const cscd_detector *detector, const cscd_mesh *mesh, orientation_row *out);
void orientation_row_free(orientation_row *row); /* a zeroed struct is fine */

/* Those of the detector's last step. */
void orientation_row_take(orientation_row *row, const cscd_detector *detector);

/* Those of a step that has none: no triangle faces any point. */
void orientation_row_forget(orientation_row *row);

/* ---- reports ------------------------------------------------------------------------------------------- */

typedef enum report_kind { REPORT_REPLAY, REPORT_PREPROCESS, REPORT_COMPARE, REPORT_UNTANGLED } report_kind;

enum {
    REPORT_POSITIONS_MAX = 4000000,      /* of vertices, over all frames kept, the scenery's included */
    REPORT_INTERVAL_CONTACTS_MAX = 4000, /* kept of one interval: the earliest */
    REPORT_CONTACTS_MAX = 100000,        /* all contacts that are kept; each interval has room for its
                                          * share at least */
    REPORT_ANSWER_TRIANGLES_MAX =
        400000, /* intersecting, over all frames; each has room for its share at least */
    REPORT_ANSWER_POINTS_MAX = 200000, /* the same, of curves */
    REPORT_ANSWER_DEPTHS_MAX = 200000, /* and of vertices with a depth */
    REPORT_EVENTS_MAX = 2000,          /* the worst are kept */
    REPORT_PART_NAME_SIZE = 160,
    REPORT_MARKS_MAX = 16 * 1024 * 1024, /* bytes of orientations, and of detector points: else left out */
};

/* A surface that is only drawn. */
typedef struct report_scenery {
    uint32_t vertex_count, triangle_count;
    const uint32_t *triangles; /* NULL: there is none */
    bool moves;                /* has positions of its own for every frame */
} report_scenery;

/* Options of a report. Everything that they point to outlives the report. */
typedef struct report_options {
    report_kind kind;
    const char *title, *generator;
    const cscd_mesh *mesh;        /* NULL for REPORT_COMPARE, which shows no surface */
    const cscd_plan *plan;        /* NULL: none */
    const int32_t *frame_numbers; /* what frames are called, by index; NULL: their indices */
    uint32_t first, last;    /* the frames to come; what is kept follows from them; of a preprocess 0, 0 */
    bool oriented;           /* the detector's method has detector points and orientations */
    int up_axis;             /* of the picture: 1: y, 2: z; 0 stands for z */
    double fps;              /* frames a second; 0: nobody knows */
    const char *length_unit; /* "mm": of the files' coordinates; NULL: nobody knows */
    report_scenery scenery;

    /* The vertices of a contact as the model file numbers them. VF: the vertex, the face's three; EE: those
     * of a, those of b. NULL: the file has the mesh's own numbers. */
    void (*file_vertices)(void *user, const cscd_contact *contact, uint32_t vertices[4]);
    void *file_vertices_user;
} report_options;

typedef struct report report;

/* Call in this order: _create, _begin, _add_interval for every interval, the scenery, _write. Without a
 * mesh, leave out _begin and the two after it. After a failure only _destroy may follow: a report is
 * whole, or there is none. */
bool report_create(const report_options *options, report **out, io_error *error);
void report_destroy(report *r);

/* The positions of the first frame. */
bool report_begin(report *r, const double *positions, io_error *error);

/* The next interval: how its triangles faced their detector points (NULL where the options say that there are
 * no orientations), its contacts, and the positions of the frame at its end. The report ends with the last
 * frame that it was given here, be it earlier than expected. */
bool report_add_interval(report *r, const orientation_row *orientations, const cscd_contacts *contacts,
                         const double *end, io_error *error);

/* The next frame of REPORT_UNTANGLED, in place of _begin and _add_interval: where the vertices were, and where they
 * are. All frames are kept: their number has to fit report_untangled_frames. */
bool report_add_untangled(report *r, const double *before, const double *after, io_error *error);

/* How many frames of a mesh a page has room for, before and after; 1 at least. */
uint32_t report_untangled_frames(uint32_t vertex_count);

/* Adds what intersects in a frame: pairs and, if they were asked for, curves and depths of vertices. Frames
 * come in their order, those that were not checked are left out. Of REPORT_UNTANGLED, 2 i is the i-th frame before,
 * and 2 i + 1 after. */
bool report_add_answers(report *r, uint32_t frame, const cscd_intersections *found, io_error *error);

/* The name of a part, in the buffer or elsewhere; UINT32_MAX stands for what is in no part. */
typedef const char *(*report_part_name)(void *user, uint32_t part, char buffer[REPORT_PART_NAME_SIZE]);

/* The events, by the indices of frames; they are copied. name must live as long as the report. Once. */
bool report_set_events(report *r, const cscd_event *events, size_t count, report_part_name name, void *user,
                       io_error *error);

/* The frames that are kept, ascending, the first and the last among them: final after the last interval. */
uint32_t report_frame_count(const report *r);
uint32_t report_frame(const report *r, uint32_t index);

/* The scenery's positions: once if it stands still, else for each frame kept, in their order. */
bool report_add_scenery(report *r, const double *positions, io_error *error);

/* The text that `--json` wrote; any `<` in it is escaped here. */
typedef struct report_summary {
    const char *name, *text;
} report_summary;

/* Puts the page at path in one go: until it is complete, and if that fails, an older file stays as it is. A
 * pipe or a device is written to directly. made: a JSON object as text, of REPORT_PREPROCESS or REPORT_UNTANGLED what
 * it has made, or NULL. Once. */
bool report_write(report *r, const char *path, const report_summary *summaries, size_t summary_count,
                  const char *made, io_error *error);

/* ---- the page of many jobs ----------------------------------------------------------------------------- */

/* A table of all jobs, the worst first. */

/* The numbers of a job; NaN: not known. A column that no job has is not shown. */
typedef enum jobs_page_number {
    JOBS_PAGE_CROSSING_FRAMES,
    JOBS_PAGE_FRAMES, /* that were looked at */
    JOBS_PAGE_EVENTS,
    JOBS_PAGE_DEPTH,
    JOBS_PAGE_PAIRS,
    JOBS_PAGE_SECONDS,
    JOBS_PAGE_NUMBERS
} jobs_page_number;

typedef struct jobs_page_row {
    uint8_t outcome; /* one of the page's outcomes */
    bool found;      /* what the rules of the run ask for */
    const char *name, *answer;
    const char *report; /* the path of its page, from the current folder; "": it has none */
    double numbers[JOBS_PAGE_NUMBERS];
} jobs_page_row;

typedef struct jobs_page_options {
    const char *path; /* of the page: links to others are relative to its folder */
    const char *title, *generator;
    const char *const
        *outcomes; /* their names, up to a NULL; the page has words for those of docs/artist/formats.md */
    const char *missing; /* the jobs that are not done, in words; "": none */
    uint64_t list;       /* the hash of the list */
} jobs_page_options;

typedef struct jobs_page jobs_page;

/* Everything that the options point to outlives the page. */
bool jobs_page_create(const jobs_page_options *options, jobs_page **out, io_error *error);
void jobs_page_destroy(jobs_page *page);

/* The next job, in the order of the list; the row is copied. */
bool jobs_page_add(jobs_page *page, const jobs_page_row *row, io_error *error);

/* Puts the page at its path in one go. Once. */
bool jobs_page_write(jobs_page *page, io_error *error);
