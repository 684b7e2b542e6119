/* Events: what intersects or touches somewhere for some time, followed through the frames of a recording.
 *
 * An *event* is what two parts have to do with each other at one place: it begins in one frame of a recording and ends in
 * a later one or in the same. (In docs/theory/curves.md the word stands for an edge that passes through a face.) A tracker
 * is given what a detector finds, frame by frame, and gives out the events. Four things make one up:
 *   pairs      of triangles that intersect or touch in a frame, of any kind
 *   curves     each piece, in the parts of its two triangles
 *   depths     each point, in the part that it is in and the part that has its nearest point
 *   contacts   of the interval that ends in a frame. They count for this frame
 * Each has some triangles: a pair and a piece their two, a depth those at its vertex or edge, a contact those of its two
 * features. A vertex of a wire, or a point, counts like a triangle, and a half-space has none. Two things belong to one
 * event if they are of the same pair of parts, not more than `gap` frames were given between theirs, and a triangle of
 * one is within `rings` rings of a triangle of the other; so do things that are joined by others. Triangles are within 0
 * rings if they are the same, within 1 if they share a vertex, and within k if between a vertex of one and a vertex of the
 * other lie at most k - 1 edges of the mesh. Vertices that seams unite are one.
 *
 * So events that meet are one from their beginnings on, and one that splits stays one while its pieces last. Where depths are asked for, what is buried joins the curves around it, and a body that
 * is wholly inside another one stays an event.
 *
 * A tracker needs memory for what is open and for events that nobody has taken yet, not for the recording. It holds one
 * mesh: where a mesh changes, the events end with cscd_event_tracker_finish, and another tracker goes on. */
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
    uint32_t gap;         /* so many frames without it do not end an event; 0 by default */

    /* Labels of triangles, as for cscd_detector_set_parts; NULL and 0, the default: objects are the parts. */
    uint32_t part_count;
    const uint32_t *labels;

    /* Pairs of vertices that count as one, as for a detector; none by default. */
    const uint32_t *seams;
    size_t seam_count;

    /* The most bytes that one frame may take, 0, the default: a quarter of the memory that is free when the tracker is made. See
     * cscd_event_tracker_add_frame. */
    size_t max_memory;
} cscd_event_options;

/* The default options. */
CSCD_API void cscd_event_defaults_sized(cscd_event_options *out, size_t size);
static inline cscd_event_options cscd_event_defaults(void) {
    cscd_event_options options;
    cscd_event_defaults_sized(&options, sizeof options);
    return options;
}

/* Creates a tracker that has no frames yet, and keeps the mesh. options may be NULL. INVALID_ARGUMENT: a label is too
 * large, or a seam names a vertex that there is not. */
CSCD_API cscd_status cscd_event_tracker_create(cscd_context *context, const cscd_mesh *mesh,
                                               const cscd_event_options *options, cscd_event_tracker **out);

/* Gives the tracker back, and its lists. */
CSCD_API void cscd_event_tracker_destroy(cscd_event_tracker *tracker);

/* ---- what goes in --------------------------------------------------------------------------------------- */

/* Adds contacts of the interval that ends in the next frame: a list of a step, or any part of it. The list is copied, so
 * the detector may be asked for the intersections of that frame afterwards. INVALID_ARGUMENT: a contact is not of this
 * mesh. */
CSCD_API cscd_status cscd_event_tracker_add_contacts(cscd_event_tracker *tracker,
                                                     const cscd_contact *contacts, size_t contact_count);

/* Adds a frame, whose number is larger than that of the frame before, and what was found in it; NULL: nothing was looked
 * for. Which events there are follows from pairs, depths and contacts; without curves or depths lengths or depths
 * are 0. INVALID_ARGUMENT: the number is not larger, *found has no list, or it is not of this mesh. LIST_TOO_LONG:
 * what was found would take more than max_memory; the frame is added as one in which nothing was looked for, without
 * the contacts that waited for it. */
CSCD_API cscd_status cscd_event_tracker_add_frame(cscd_event_tracker *tracker, uint64_t frame,
                                                  const cscd_intersection_pairs *found);

/* ---- what comes out ------------------------------------------------------------------------------------- */

/* Beside the kinds of its pairs, an event is of this kind where its parts are two copies of one solid (cscd_part_pair): found was
 * given with sums by the tracker's parts. */
#define CSCD_EVENT_SAME_SOLID ((uint64_t)1 << 63)

/* The same of a part with itself where something of it lies within another body than its own (cscd_part_pair). */
#define CSCD_EVENT_IN_OTHER_BODY ((uint64_t)1 << 62)

/* An event. What it has in one frame may be in several places; those that are joined within the frame are a *group*. The
 * worst group has the greatest depth; of several the greatest length, then the most pairs, where there are
 * neither depths nor pairs the most contacts, then the first frame. It never grows. */
typedef struct cscd_event {
    uint32_t a, b;        /* parts; a <= b */
    uint64_t first_frame; /* the number of the first frame that has something of it, */
    uint64_t last_frame;  /* of the last one, */
    uint64_t worst_frame; /* and of the one that has its worst group */
    uint64_t kinds;       /* of all its pairs: a set of cscd_intersection_kind, and the two above */
    uint64_t pairs;       /* so many, all frames together */
    uint64_t depths;      /* the same of points with a depth */
    uint64_t contacts;    /* and of contacts */
    double depth;         /* the greatest; 0: none is known */
    double length;        /* the greatest length of the curves of a group, up to rounding */

    /* A place to look at in the worst frame: the deepest point, else one of the first curve, else the earliest contact,
     * else none: NaN, since pairs alone have no positions. The triangle is there; UINT32_MAX: a contact of loose
     * features. */
    double x[3];
    uint32_t triangle;

    /* The least one of the first frame; UINT32_MAX: loose features alone. With the first frame and the parts it tells events
     * apart. */
    uint32_t first_triangle;
} cscd_event;

/* Events, sorted by (first_frame, a, b, first_triangle). The list belongs to the tracker and lives until its next call. */
typedef struct cscd_events {
    const cscd_event *items;
    size_t count;
    size_t open; /* so many events may go on, and are not in the list */
} cscd_events;

/* Gives out the events that have ended since the last call. What is never taken comes with cscd_event_tracker_finish. */
CSCD_API cscd_status cscd_event_tracker_take(cscd_event_tracker *tracker, cscd_events *out);

/* The recording has ended: gives out all events that are left, those that may go on included. The tracker then has no
 * frames, and may follow another recording of the mesh. INVALID_ARGUMENT: contacts wait for the frame that ends their
 * interval. An example, the upper sheet on its way down through the lower one, which prints "1 event, frames 6 to 8":
 *
 *     cscd_event_tracker *tracker = NULL;
 *     cscd_intersection_pairs found;
 *     cscd_events events = {0};
 *     cscd_status status = cscd_event_tracker_create(context, mesh, NULL, &tracker);
 *     for (uint32_t frame = 0; status == CSCD_OK && frame < 12; frame++) {
 *         for (uint32_t v = SHEET; v < n; v++) x1[3 * v + 2] = 0.55 - 0.1 * frame + 0.1 * (v % SIDE);
 *         status = cscd_detector_find_intersections(detector, CSCD_DOUBLES(x1, n), NULL, &found);
 *         if (status == CSCD_OK) status = cscd_event_tracker_add_frame(tracker, frame, &found);
 *     }
 *     if (status == CSCD_OK) status = cscd_event_tracker_finish(tracker, &events);
 *     for (size_t i = 0; i < events.count; i++)
 *         printf("%d event, frames %d to %d", (int)events.count, (int)events.items[i].first_frame,
 *                (int)events.items[i].last_frame);
 *     cscd_event_tracker_destroy(tracker);
 */
CSCD_API cscd_status cscd_event_tracker_finish(cscd_event_tracker *tracker, cscd_events *out);

#ifdef __cplusplus
}
#endif

#endif
