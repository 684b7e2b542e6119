/* Volumes of overlaps and lengths of curves with their gradients, of the public API. */
#include "runtime/detector/detector.h"
#include "runtime/detector/surface_answers.h"

/* Triangles at rest are not compared with each other, so a curve between them may be missing. */
static cscd_status check_active(const cscd_detector *d) {
    if (d->space.active.triangles == NULL) return CSCD_OK;
    return context_fail(
        d->context, CSCD_INVALID_ARGUMENT,
        "cscd_detector_overlap_volumes: inactive triangles are not compared with each other, so "
        "volumes are unknown; call cscd_detector_set_active with NULL first");
}

static cscd_status ask_measure(cscd_detector *d, const cscd_view *positions,
                               const cscd_intersection_options *options, surface_measure measure,
                               cscd_measures *out) {
    const bool volumes = measure == MEASURE_VOLUMES;
    if (out == NULL)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT, "%s: out is NULL",
                            volumes ? "cscd_detector_overlap_volumes" : "cscd_detector_curve_lengths");
    cscd_status status = volumes ? check_active(d) : CSCD_OK;
    return status == CSCD_OK ? surface_measure_ask(d, positions, options, measure, out) : status;
}

cscd_status detector_curve_lengths(cscd_detector *d, const cscd_view *positions,
                                   const cscd_intersection_options *options, cscd_measures *out) {
    return ask_measure(d, positions, options, MEASURE_LENGTHS, out);
}

cscd_status cscd_detector_overlap_volumes(cscd_detector *detector, const cscd_view *positions,
                                          const cscd_intersection_options *options, cscd_measures *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, ask_measure(detector, positions, options, MEASURE_VOLUMES, out));
}

cscd_status cscd_detector_curve_lengths(cscd_detector *detector, const cscd_view *positions,
                                        const cscd_intersection_options *options, cscd_measures *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, detector_curve_lengths(detector, positions, options, out));
}
