/* Changes of curves, of the public API: which contacts let a curve's points come and go. */
#include "runtime/detector/detector.h"
#include "src/mesh/given_contacts.h"
#include "src/mesh/positions.h"
#include "src/mesh/views.h"

static cscd_status read_ends(cscd_detector *d, const cscd_view *x0, const cscd_view *x1,
                             const double *ends[2]) {
    const cscd_view *views[2] = {x0, x1};
    static const char *const names[2] = {"x0", "x1"};
    cscd_status status = CSCD_OK;
    for (int i = 0; status == CSCD_OK && i < 2; i++) {
        status = views_read(d->context, d->mesh, views[i], names[i], &d->unpacked[i], &ends[i]);
        if (status == CSCD_OK) status = positions_check(d->context, ends[i], d->mesh->vertex_count, names[i]);
    }
    return status;
}

static cscd_status find_changes(cscd_detector *d, const cscd_view *x0, const cscd_view *x1,
                                const cscd_contact *contacts, size_t contact_count, cscd_curve_changes *out) {
    if (out == NULL)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT, "cscd_detector_curve_changes: out is NULL");
    const double *ends[2];
    cscd_curve_changes found;
    cscd_status status =
        given_contacts_check(d->context, d->mesh, "cscd_detector_curve_changes", contacts, contact_count);
    if (status == CSCD_OK) status = read_ends(d, x0, x1, ends);
    if (status != CSCD_OK) return status;
    d->changes.context = d->context;
    status =
        change_finder_run(&d->changes, d->mesh, ends, d->exclusions.names, contacts, contact_count, &found);
    if (status == CSCD_OK) *out = found;
    return context_explain(d->context, status);
}

cscd_status cscd_detector_curve_changes(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                        const cscd_contact *contacts, size_t contact_count,
                                        cscd_curve_changes *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, find_changes(detector, x0, x1, contacts, contact_count, out));
}
