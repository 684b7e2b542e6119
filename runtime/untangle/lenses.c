/* Wrong points and the places on the other sheet where they belong. A lens is what two sheets that pass through each other bound
 * together; a curve bounds a patch of each. The way out of a wrong patch leads through the lens to the patch beyond the curve. */
#include "runtime/untangle/lenses.h"

#include "runtime/untangle/wrong_sides.h"
#include "src/core/vec3.h"

cscd_status lenses_find(lens_finder *f, const cscd_intersections *found, const double *x,
                        const lens_rules *rules) {
    f->point_count = 0;
    f->thickness = 0.0;
    f->turned = found->patches->turned;
    if (!wrong_sides_find(f, found)) return CSCD_OUT_OF_MEMORY;
    lens_folds_halve(f, found->curves);
    if (!lens_patches_list(f, found->curves)) return CSCD_OUT_OF_MEMORY;
    const size_t count = f->entry_counts[OF_VERTICES];
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i; end < count &&
                      entry_patch(f->entries[OF_VERTICES][end]) == entry_patch(f->entries[OF_VERTICES][i]);)
            end++;
        if (!lens_points_add(f, found->curves, x, rules, i, end)) return CSCD_OUT_OF_MEMORY;
    }
    if (!lens_edges_add(f, found->curves, x) || !flush_pairs_add(f, found, x)) return CSCD_OUT_OF_MEMORY;
    if (!lens_finder_sort(f, DECIDED)) return CSCD_OUT_OF_MEMORY;
    lens_finder_unify(f, DECIDED);
    f->undecided = found->curves->count - f->entry_counts[DECIDED];
    for (size_t i = 0; i < f->point_count; i++) f->thickness = max_of(f->thickness, f->points[i].thickness);
    return CSCD_OK;
}
