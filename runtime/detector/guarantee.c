/* What a step promises for the contacts of a component with itself. */
#include "runtime/detector/guarantee.h"

#include <math.h>

/* Returns the reason in a component's guarantee, for a method that culls. */
static cscd_reason culling_reason(const cscd_detector *d, uint32_t component, bool embedded) {
    if (d->never_culled[component]) return CSCD_REASON_METHOD;
    if (!d->mesh->components[component].closed_manifold) return CSCD_REASON_SURFACE;
    if (!embedded) return d->starts.of[component].crossing > 0 ? CSCD_REASON_CROSSING : CSCD_REASON_UNPROVEN;
    return d->touched[component] ? CSCD_REASON_FINISHED : CSCD_REASON_CLEAN;
}

cscd_guarantee guarantee_of(const cscd_detector *d, uint32_t component) {
    bool embedded = d->starts.of[component].clean == d->mesh->components[component].triangle_count;
    if (component_is_obstacle(d->mesh, component))
        return (cscd_guarantee){false, false, CSCD_REASON_OBSTACLE};
    if (detector_masks(d, component)) return (cscd_guarantee){false, false, CSCD_REASON_MASK};
    if (d->leaves_collapsed && d->collapsed.marks[component])
        return (cscd_guarantee){false, embedded, CSCD_REASON_COLLAPSED};
    const bool by_method = detector_culls(d) || detector_hides_pairs(d);
    if (detector_searches_alone(d)) return (cscd_guarantee){false, embedded, CSCD_REASON_PUBLISHED};
    if (d->lists_earliest && d->earliest[component] < INFINITY)
        return (cscd_guarantee){false, embedded, CSCD_REASON_EARLIEST};
    if (!by_method) return (cscd_guarantee){true, embedded, CSCD_REASON_METHOD};
    if (!detector_culls(d)) return (cscd_guarantee){true, embedded, CSCD_REASON_CONTOUR};
    return (cscd_guarantee){true, embedded, culling_reason(d, component, embedded)};
}
