/* Changes of curves: which contacts of an interval let the points of intersection curves come and go. Part of
 * cscd/cscd.h, which says what holds for every function.
 *
 * A curve (cscd/curves.h) has its points where an edge passes through a triangle. Such a point comes or goes only at a
 * contact: of a vertex of the edge with the triangle, or of the edge with an edge of the triangle. So the contacts of an
 * interval are the causes of the curves that are there at its end. Theory: docs/theory/curves.md, Lemma 10. */
#ifndef CSCD_CURVE_CHANGES_API_H
#define CSCD_CURVE_CHANGES_API_H

#include <cscd/curves.h>
#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A point that curves have at one end of the interval only: a cscd_curve_point with this edge and triangle. It never
 * grows. */
typedef struct cscd_curve_change {
    uint32_t edge, triangle;
    size_t first_cause, cause_count; /* in the list of all causes: its contacts, by toi */
    bool comes;          /* it is there at x1, and not at x0; else it is there at x0, and not at x1 */
    uint8_t reserved[7]; /* 0 */
} cscd_curve_change;

/* Changes sorted by (edge, triangle), and what each contact has to do with them. The lists belong to the detector and
 * live until its next call. */
typedef struct cscd_curve_changes {
    const cscd_curve_change *items;
    size_t count;
    const size_t *causes; /* places in the given list of contacts */
    size_t cause_count;

    /* The changes that contact i is a cause of are those of_contacts[k] of the items, for k from contact_first[i] to
     * contact_first[i + 1] - 1; ascending. */
    const size_t *contact_first; /* contact_count + 1 of them */
    const size_t *of_contacts;   /* cause_count of them */
} cscd_curve_changes;

/* Finds the points of curves that come or go between x0 and x1 at the given contacts: those of a step, or any selection
 * from them, in any order. Whether a point is there is decided exactly, as for curves. A point may have several causes;
 * when it comes, goes and comes again, all contacts on the way are listed.
 *
 * The list of cscd_detector_step in the mode ALL from x0 to x1 is complete: then every point that comes or goes is here,
 * but for what is left out, whose contacts are left out, too. Of contacts with wires, points and half-spaces, which have
 * no curves, nothing comes. Lists that earlier calls gave out stay. INVALID_ARGUMENT: a contact is not of this mesh, or a
 * coordinate is not as positions have to be. An example, one vertex of a sheet that is pulled through another sheet,
 * which prints "14 points come at 8 contacts":
 *
 *     cscd_curve_changes changes;
 *     for (uint32_t v = SHEET; v < n; v++) x1[3 * v + 2] = v == SHEET + 5 ? -0.5 : 0.5;
 *     cscd_view from = cscd_view_doubles(x0, n), to = cscd_view_doubles(x1, n);
 *     cscd_status status = cscd_detector_step(detector, &from, &to, &contacts);
 *     if (status == CSCD_OK)
 *         status = cscd_detector_curve_changes(detector, &from, &to, contacts.items, contacts.count, &changes);
 *     if (status == CSCD_OK)
 *         printf("%d points come at %d contacts\n", (int)changes.count, (int)contacts.count);
 */
CSCD_API cscd_status cscd_detector_curve_changes(cscd_detector *detector, const cscd_view *x0,
                                                 const cscd_view *x1, const cscd_contact *contacts,
                                                 size_t contact_count, cscd_curve_changes *out);

#ifdef __cplusplus
}
#endif

#endif
