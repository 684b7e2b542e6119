/* What is asked about intersecting surfaces beside their pairs of triangles: curves, patches, overlaps, depths. */
#include "runtime/detector/surface_answers.h"

#include "runtime/intersections/touching_curves.h"

const char *cscd_curve_end_name(cscd_curve_end end) {
    static const char *const names[] = {"none", "vertex", "border", "junction", "left out"};
    return (unsigned)end < sizeof names / sizeof *names ? names[end] : "unknown";
}

void surface_answers_free(cscd_context *context, surface_answers *a) {
    if (a == NULL) return;
    same_solids_free(&a->same_solids);
    depth_finder_free(&a->depth_finder);
    overlap_finder_free(&a->overlap_finder);
    cut_off_finder_free(&a->cut_off_finder);
    patch_finder_free(&a->patch_finder);
    orientation_finder_free(&a->orientations);
    placed_names_free(&a->names);
    left_out_pairs_free(&a->left_out);
    curve_joiner_free(&a->joiner);
    context_free(context, a);
}

bool surface_answers_wanted(const cscd_intersection_options *options) {
    return options->curves || options->patches || options->overlaps || options->depths || options->cut_offs;
}

/* Returns the detector's answers, made if need be; NULL: no memory. */
static surface_answers *make_answers(cscd_detector *d) {
    if (d->answers != NULL) return d->answers;
    cscd_context *context = d->context;
    surface_answers *a = context_allocate(context, 1, sizeof *a);
    if (a == NULL) return NULL;
    a->names.context = a->left_out.context = a->joiner.context = context;
    a->cut_off_finder =
        (cut_off_finder){.context = context, .links = {.context = context}, .sides = {.context = context}};
    a->overlap_finder =
        (overlap_finder){.context = context, .cuts = {.context = context}, .gaps = {.context = context}};
    a->same_solids.context = context;
    a->depth_finder.context = a->depth_finder.outer.context = a->depth_finder.outer.cuts.context =
        a->depth_finder.deepest.context = context;
    if (!orientation_finder_create(d->mesh, &a->orientations) ||
        patch_finder_create(d->mesh, d->space.traversal.lane_count, &a->patch_finder) != CSCD_OK) {
        surface_answers_free(context, a);
        return NULL;
    }
    d->answers = a;
    return a;
}

left_out_pairs *surface_answers_begin(cscd_detector *d) {
    surface_answers *a = make_answers(d);
    if (a == NULL) return NULL;
    a->left_out.count = 0;
    a->left_out.out_of_memory = false;
    return &a->left_out;
}

static cscd_status find_patches(cscd_detector *d, named_surface *surface, cscd_orientation orientation) {
    surface_answers *a = d->answers;
    a->patch_finder.objects = d->pair_rules.sets;
    progress_stage(&d->context->progress, "patches", 0.8, 0.9);
    const part_labels *parts = orientation == CSCD_ORIENTATION_BY_PART ? &d->parts : NULL;
    if (orientation != CSCD_ORIENTATION_AS_GIVEN &&
        !orientation_finder_run(&a->orientations, surface, &d->space.bvh, parts, a->joiner.found,
                                a->joiner.piece_count))
        return CSCD_OUT_OF_MEMORY;
    return patch_finder_run(&a->patch_finder, surface, &d->space.bvh, a->joiner.found, a->joiner.piece_count,
                            &a->patches);
}

static cscd_status find_depths(cscd_detector *d, const surface_cuts *cuts, double limit,
                               const cscd_intersection_pairs *found) {
    surface_answers *a = d->answers;
    progress_stage(&d->context->progress, "depths", 0.9, 1.0);
    const depth_request request = {&d->space.bvh, &d->parts, found->items, found->count, limit};
    cscd_status status = depth_finder_run(&a->depth_finder, cuts, &request, &a->depths);
    if (status == CSCD_OK)
        touching_curves_mark(&a->joiner, cuts->surface, found->items, &a->patches, &a->depths);
    return status;
}

/* The overlaps that are given out, if any are, must be found after these. */
static cscd_status find_same_solids(surface_answers *a, const surface_cuts *cuts,
                                    const cscd_intersection_pairs *found) {
    return same_solids_find(&a->same_solids, cuts, found->items, found->count, &a->depths, &a->overlap_finder,
                            &a->left_out);
}

cscd_status surface_answers_find(cscd_detector *d, const double *positions,
                                 const cscd_intersection_options *options, cscd_intersection_pairs *found) {
    surface_answers *a = d->answers;
    if (a->left_out.out_of_memory) return CSCD_OUT_OF_MEMORY;
    named_surface surface = {.mesh = d->mesh,
                             .positions = positions,
                             .bodies = options->part_bodies ? &d->parts.bodies : NULL,
                             .collapsed = d->check.collapsed};
    if (!placed_names_find(&a->names, d->mesh, positions, d->exclusions.names, &surface.names))
        return CSCD_OUT_OF_MEMORY;
    const surface_cuts cuts = {&surface, &a->joiner, &a->patch_finder};
    progress_stage(&d->context->progress, "curves", 0.7, 0.8);
    cscd_status status = curve_joiner_run(&a->joiner, &surface, found->items, found->count, &a->curves);
    if (status != CSCD_OK) return status;
    found->curves = &a->curves;
    if (!options->patches && !options->overlaps && !options->cut_offs && !options->depths) return CSCD_OK;
    status = find_patches(d, &surface, options->orientation);
    if (status != CSCD_OK) return status;
    found->patches = &a->patches;
    if (options->cut_offs) {
        status = cut_off_finder_run(&a->cut_off_finder, &cuts, &a->cut_offs);
        if (status != CSCD_OK) return status;
        found->cut_offs = &a->cut_offs;
    }
    if (options->depths) {
        status = find_depths(d, &cuts, options->depth_limit, found);
        if (status != CSCD_OK) return status;
        found->depths = &a->depths;
        status = find_same_solids(a, &cuts, found);
        if (status != CSCD_OK) return status;
    }
    if (options->overlaps) {
        status = overlap_finder_run(&a->overlap_finder, &cuts, &a->left_out, &a->overlaps);
        if (status != CSCD_OK) return status;
        found->overlaps = &a->overlaps;
    }
    return CSCD_OK;
}
