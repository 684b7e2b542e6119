/* Events: what intersects or touches somewhere for some time, followed through the frames of a recording.
 *
 * An event is what two parts have to do with each other at one place. A tracker takes what a detector finds,
 * frame by frame, and gives out the events (docs/solver/surfaces.md has a program). They are made of
 *   pairs      of triangles that intersect or touch in a frame, of any kind
 *   curves     each piece, in the parts of its two triangles
 *   depths     each point, in the part that it is in and the part that has its nearest point
 *   contacts   of the interval that ends in a frame; they count for this frame
 * Each has triangles: the two of a pair or a piece, those at the vertex or edge of a depth, those of a
 * contact's features. A vertex of a wire, or a point, counts like a triangle; a half-space has none. Two
 * things are of one event if they have the same pair of parts, at most `gap` frames were given between
 * theirs, and triangles of theirs are within `rings` rings; so are things that others join. Rings are 0 for
 * the same triangle, 1 for a common vertex, and k where at most k - 1 edges lie between two of their
 * vertices. Vertices that seams unite are one.
 *
 * So events that meet are one from their beginnings, and one that splits stays one. With depths, what is
 * buried joins the curves around it, and a body wholly inside another one stays an event. A tracker holds one
 * mesh: where it changes, call cscd_event_tracker_finish and take another one. It keeps events that are open
 * or not taken, not the recording. */
#ifndef CSCD_EVENTS_API_H
#define CSCD_EVENTS_API_H

#include <cscd/surface.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Follows events through the frames of a recording. */
typedef struct cscd_event_tracker cscd_event_tracker;

/* Options of a tracker; start from cscd_event_defaults. Arrays are copied. */
typedef struct cscd_event_options {
    uint32_t struct_size; /* set by cscd_event_defaults */
    uint32_t rings;       /* 2 by default */
    uint32_t gap;         /* an event goes on after at most this many frames without it; 0 by default */

    /* Labels of triangles, as for cscd_detector_set_parts; NULL and 0, the default: objects are the parts. */
    uint32_t part_count;
    const uint32_t *labels;

    /* Pairs of vertices that count as one; none by default. */
    const uint32_t *seams;
    size_t seam_count;

    /* The most bytes for one frame; 0, the default: a quarter of the memory that is free when the tracker is
     * made. */
    size_t max_memory;
} cscd_event_options;

/* Returns the default options. */
CSCD_API void cscd_event_defaults_sized(cscd_event_options *out, size_t size);
static inline cscd_event_options cscd_event_defaults(void) {
    cscd_event_options options;
    cscd_event_defaults_sized(&options, sizeof options);
    return options;
}

/* Creates a tracker without frames. It keeps the mesh; options may be NULL. INVALID_ARGUMENT: a label is too
 * large, or a seam names a vertex that does not exist. */
CSCD_API cscd_status cscd_event_tracker_create(cscd_context *context, const cscd_mesh *mesh,
                                               const cscd_event_options *options, cscd_event_tracker **out);

/* Frees the tracker and its lists. */
CSCD_API void cscd_event_tracker_destroy(cscd_event_tracker *tracker);

/* ---- what goes in --------------------------------------------------------------------------------------- */

/* Adds contacts of the interval that ends in the next frame. They are copied, and may be any part of the list
 * of a step. INVALID_ARGUMENT: a contact is not of this mesh. */
CSCD_API cscd_status cscd_event_tracker_add_contacts(cscd_event_tracker *tracker,
                                                     const cscd_contact *contacts, size_t contact_count);

/* Adds a frame, by ascending number, and what was found in it; NULL: nothing was looked for. Pairs, depths
 * and contacts make events; without curves their lengths are 0. INVALID_ARGUMENT: the number does not ascend,
 * *found has no list, or it is not of this mesh. LIST_TOO_LONG: this would take more than max_memory, and the
 * frame counts as one in which nothing was looked for, without its contacts. */
CSCD_API cscd_status cscd_event_tracker_add_frame(cscd_event_tracker *tracker, uint64_t frame,
                                                  const cscd_intersections *found);

/* ---- what comes out ------------------------------------------------------------------------------------- */

/* A kind besides those of the pairs: the two parts are copies of one solid (cscd_part_pair). It needs the
 * sums by the tracker's parts in *found. */
#define CSCD_EVENT_SAME_SOLID ((uint64_t)1 << 63)

/* Another kind, of a part with itself: something of it lies within another body than its own
 * (cscd_part_pair). */
#define CSCD_EVENT_IN_OTHER_BODY ((uint64_t)1 << 62)

/* An event. What is joined within one frame is a *group*. The worst group has the greatest depth, then the
 * greatest length, then the most pairs, then (without depths and pairs) the most contacts, then the first
 * frame. */
typedef struct cscd_event {
    uint32_t a, b;        /* parts; a <= b */
    uint64_t first_frame; /* the number of the first frame that has something of it */
    uint64_t last_frame;  /* that of the last one */
    uint64_t worst_frame; /* that of the frame with its worst group */
    uint64_t kinds;       /* of all its pairs: a set of cscd_intersection_kind, and the two above */
    uint64_t pairs;       /* their number in all frames together */
    uint64_t depths;      /* the number of points with a depth, in all frames */
    uint64_t contacts;    /* the number of contacts, in all frames */
    double depth;         /* the greatest; 0: none is known */
    double length;        /* the greatest length of the curves of a group, up to rounding */

    /* A place in the worst frame: the deepest point, else one of the first curve, else the earliest contact,
     * else NaN. The triangle is there; UINT32_MAX: a contact of loose features. */
    double x[3];
    uint32_t triangle;

    /* The least triangle of the first frame, which tells events of the same parts and frame apart;
     * UINT32_MAX: loose features alone. */
    uint32_t first_triangle;
} cscd_event;

/* Events, sorted by (first_frame, a, b, first_triangle). The list belongs to the tracker and lives until its
 * next call. */
typedef struct cscd_events {
    const cscd_event *items;
    size_t count;
    size_t open; /* the number of events that may go on, and are not in the list */
} cscd_events;

/* Gives out the events that have ended since the last call. All others come with cscd_event_tracker_finish.
 */
CSCD_API cscd_status cscd_event_tracker_take(cscd_event_tracker *tracker, cscd_events *out);

/* Gives out all events that are left, because the recording has ended. The tracker then has no frames, and
 * may follow another recording of the mesh. INVALID_ARGUMENT: contacts wait for the frame that ends their
 * interval. */
CSCD_API cscd_status cscd_event_tracker_finish(cscd_event_tracker *tracker, cscd_events *out);

#ifdef __cplusplus
}
#endif

#endif
