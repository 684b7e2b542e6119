/* Answers about intersecting surfaces besides their pairs of triangles: curves, patches, overlaps, depths. */
#include "runtime/detector/surface_answers.h"

void surface_answers_free(cscd_context *context, surface_answers *a) {
    if (a == NULL) return;
    same_solids_free(&a->same_solids);
    depth_finder_destroy(a->depth_finder);
    overlap_finder_destroy(a->overlap_finder);
    cut_off_finder_destroy(a->cut_off_finder);
    measure_finder_destroy(a->measure_finder);
    patch_finder_free(&a->patch_finder);
    orientation_finder_destroy(a->orientations);
    placed_names_free(&a->names);
    left_out_pairs_free(&a->left_out);
    curve_joiner_free(&a->joiner);
    context_free(context, a);
}

bool surface_answers_wanted(const cscd_intersection_options *options) {
    return options->curves || options->patches || options->overlaps || options->depths || options->cut_offs;
}

static bool patches_wanted(const cscd_intersection_options *options) {
    return options->patches || options->overlaps || options->cut_offs || options->depths;
}

static surface_answers *make_answers(const cscd_mesh *mesh) {
    cscd_context *context = mesh->context;
    surface_answers *a = context_allocate(context, 1, sizeof *a);
    if (a == NULL) return NULL;
    a->names.context = a->left_out.context = a->joiner.context = context;
    a->same_solids.context = context;
    a->orientations = orientation_finder_create(mesh);
    a->overlap_finder = overlap_finder_create(context);
    a->cut_off_finder = cut_off_finder_create(context);
    a->depth_finder = depth_finder_create(context);
    a->measure_finder = measure_finder_create(context);
    if (a->depth_finder == NULL || a->orientations == NULL || a->overlap_finder == NULL ||
        a->cut_off_finder == NULL || a->measure_finder == NULL) {
        surface_answers_free(context, a);
        return NULL;
    }
    return a;
}

/* It is not there in the first call, nor after one in which patches did not fit. */
static bool make_patch_finder(const search_space *space, surface_answers *a) {
    return a->patch_finder.mesh != NULL ||
           patch_finder_create(space->mesh, space->traversal.worker_count, &a->patch_finder) == CSCD_OK;
}

left_out_pairs *surface_answers_begin(const search_space *space, surface_answers **answers) {
    const size_t before = memory_bytes(&space->context->memory);
    if (*answers == NULL) *answers = make_answers(space->mesh);
    surface_answers *a = *answers;
    if (a == NULL || !make_patch_finder(space, a)) return NULL;
    a->kept += memory_bytes(&space->context->memory) - before;
    a->left_out.count = 0;
    a->left_out.out_of_memory = false;
    return &a->left_out;
}

/* ---- what does not fit --------------------------------------------------------------------------------- */

void surface_answers_leave_out(memory_budget *budget, cscd_left_out what, cscd_intersections *found) {
    size_t wanted = budget->wanted < SIZE_MAX / 2 ? budget->wanted + budget->wanted / 3 + 1 : SIZE_MAX;
    if (found->left_out == 0 && budget->wanted_work == 0)
        found->wanted_memory = wanted; /* with the quarter that is for what is kept */
    if (found->left_out == 0) found->wanted_work = budget->wanted_work;
    budget->wanted_work = 0;
    found->left_out |= (uint64_t)1 << what;
    budget->exceeded = false;
}

void surface_answers_shrink(cscd_context *context, surface_answers **answers, size_t most) {
    if (*answers == NULL || (*answers)->kept <= most) return;
    surface_answers_free(context, *answers);
    *answers = NULL;
}

/* Leaves out answers that the call asks for; one that needs another that is left out goes with it. */
static void leave_out_all(const cscd_intersection_options *o, memory_budget *budget,
                          cscd_intersections *found) {
    const bool asked[] = {[CSCD_LEFT_OUT_CURVES] = surface_answers_wanted(o) && found->curves == NULL,
                          [CSCD_LEFT_OUT_PATCHES] = patches_wanted(o),
                          [CSCD_LEFT_OUT_OVERLAPS] = o->overlaps,
                          [CSCD_LEFT_OUT_CUT_OFFS] = o->cut_offs,
                          [CSCD_LEFT_OUT_DEPTHS] = o->depths};
    for (int what = CSCD_LEFT_OUT_CURVES; what <= CSCD_LEFT_OUT_DEPTHS; what++) {
        if (asked[what]) surface_answers_leave_out(budget, (cscd_left_out)what, found);
    }
}

void surface_answers_leave_out_list(const cscd_intersection_options *options, cscd_intersections *found) {
    memory_budget none = {.most = 0};
    surface_answers_leave_out(&none, CSCD_LEFT_OUT_PAIRS, found);
    leave_out_all(options, &none, found);
    if (options->parts) surface_answers_leave_out(&none, CSCD_LEFT_OUT_PARTS, found);
}

/* ---- one after the other ------------------------------------------------------------------------------- */

typedef struct answer_search {
    surface_answers *answers;
    const surface_scene *scene;
    const cscd_intersection_options *options;
    memory_budget *budget;
    named_surface *surface; /* that of the cuts; orientations are found for patches */
    const surface_cuts *cuts;
    cscd_intersections *found;
} answer_search;

/* An answer that did not fit takes nothing of the budget, nor of memory. */
static bool did_not_fit(const answer_search *s, cscd_status status, size_t taken_before) {
    if (status != CSCD_OUT_OF_MEMORY || !s->budget->exceeded) return false;
    s->budget->taken = taken_before;
    return true;
}

static cscd_status find_curves(const answer_search *s) {
    surface_answers *a = s->answers;
    progress_stage(&s->scene->space->context->progress, "curves", 0.7, 0.8);
    if (!memory_budget_take(s->budget, 1, curve_joiner_size(s->found->count))) return CSCD_OUT_OF_MEMORY;
    cscd_status status =
        curve_joiner_run(&a->joiner, s->cuts->surface, s->found->items, s->found->count, &a->curves);
    if (status == CSCD_OK) s->found->curves = &a->curves;
    return status;
}

/* Bodies go by parts, and so do their shells. */
static bool shells_have_labels(const cscd_intersection_options *o) {
    return o->part_bodies || o->orientation == CSCD_ORIENTATION_BY_PART;
}

static cscd_status find_patches(const answer_search *s) {
    const surface_scene *scene = s->scene;
    surface_answers *a = s->answers;
    a->patch_finder.objects = scene->config->pair_rules.sets;
    a->patch_finder.budget = s->budget;
    progress_stage(&scene->space->context->progress, "patches", 0.8, 0.9);
    const orientation_request shells = {
        .labels = shells_have_labels(s->options) ? config_grouping(scene->config)->triangles : NULL,
        .by_component =
            s->options->part_bodies && config_bodies_are_components(scene->config, scene->space->mesh),
        .as_given = s->options->orientation == CSCD_ORIENTATION_AS_GIVEN,
        .pairs = s->found->items,
        .pair_count = s->found->count};
    if ((s->options->part_bodies || !shells.as_given) &&
        !orientation_finder_run(a->orientations, s->surface, &scene->space->bvh, &shells))
        return CSCD_OUT_OF_MEMORY;
    cscd_status status = patch_finder_run(&a->patch_finder, s->cuts->surface, &scene->space->bvh,
                                          a->joiner.found, a->joiner.piece_count, &a->patches);
    if (status == CSCD_OK) s->found->patches = &a->patches;
    return status;
}

static cscd_status find_overlaps(const answer_search *s) {
    surface_answers *a = s->answers;
    const size_t before = s->budget->taken;
    cscd_status status = overlap_finder_run(a->overlap_finder, s->cuts, &a->left_out, &a->overlaps);
    if (status == CSCD_OK) s->found->overlaps = &a->overlaps;
    if (!did_not_fit(s, status, before)) return status;
    overlap_finder_clear(a->overlap_finder);
    surface_answers_leave_out(s->budget, CSCD_LEFT_OUT_OVERLAPS, s->found);
    return CSCD_OK;
}

static cscd_status find_cut_offs(const answer_search *s) {
    surface_answers *a = s->answers;
    const size_t before = s->budget->taken;
    cscd_status status = cut_off_finder_run(a->cut_off_finder, s->cuts, &a->cut_offs);
    if (status == CSCD_OK) s->found->cut_offs = &a->cut_offs;
    if (!did_not_fit(s, status, before)) return status;
    cut_off_finder_clear(a->cut_off_finder);
    surface_answers_leave_out(s->budget, CSCD_LEFT_OUT_CUT_OFFS, s->found);
    return CSCD_OK;
}

/* Finds the bodies that are copies, by the finder of overlaps. */
static cscd_status find_same_solids(const answer_search *s) {
    surface_answers *a = s->answers;
    return same_solids_find(&a->same_solids, s->cuts, s->found->items, s->found->count, &a->depths,
                            a->overlap_finder, &a->left_out);
}

static cscd_status find_depths(const answer_search *s) {
    const surface_scene *scene = s->scene;
    surface_answers *a = s->answers;
    const size_t before = s->budget->taken;
    progress_stage(&scene->space->context->progress, "depths", 0.9, 1.0);
    const depth_request request = {&scene->space->bvh, &scene->config->parts, s->found->items,
                                   s->found->count, s->options->depth_limit};
    cscd_status status = depth_finder_run(a->depth_finder, s->cuts, &request, &a->depths);
    if (status == CSCD_OK) status = find_same_solids(s);
    if (did_not_fit(s, status, before)) {
        depth_finder_clear(a->depth_finder);
        same_solids_free(&a->same_solids);
        overlap_finder_clear(a->overlap_finder);
        surface_answers_leave_out(s->budget, CSCD_LEFT_OUT_DEPTHS, s->found);
        return CSCD_OK;
    }
    if (status != CSCD_OK) return status;
    touching_curves_mark(&a->joiner, s->cuts->surface, s->found->items, &a->patches, &a->depths);
    s->found->depths = &a->depths;
    return CSCD_OK;
}

static cscd_status find_measure(const answer_search *s) {
    surface_answers *a = s->answers;
    const bool volumes = s->scene->measure == MEASURE_VOLUMES;
    const size_t before = s->budget->taken;
    cscd_status status = volumes ? overlap_volumes_run(a->measure_finder, s->cuts, &a->left_out, &a->measures)
                                 : curve_lengths_run(a->measure_finder, s->cuts, &a->measures);
    if (!did_not_fit(s, status, before)) return status;
    measure_finder_clear(a->measure_finder);
    surface_answers_leave_out(s->budget, volumes ? CSCD_LEFT_OUT_OVERLAPS : CSCD_LEFT_OUT_CURVES, s->found);
    return CSCD_OK;
}

/* Curves and patches, which all others need. */
static cscd_status find_base(const answer_search *s) {
    surface_answers *a = s->answers;
    const size_t before = s->budget->taken;
    const bool patches = patches_wanted(s->options);
    cscd_status status = find_curves(s);
    if (did_not_fit(s, status, before)) {
        curve_joiner_free(&a->joiner);
        leave_out_all(s->options, s->budget, s->found);
        return CSCD_OK;
    }
    const size_t with_curves = s->budget->taken;
    if (status == CSCD_OK && patches) status = find_patches(s);
    if (did_not_fit(s, status, with_curves)) {
        patch_finder_free(&a->patch_finder);
        leave_out_all(s->options, s->budget, s->found);
        return CSCD_OK;
    }
    return status;
}

static cscd_status find_answers(const answer_search *s) {
    const cscd_intersection_options *o = s->options;
    cscd_status status = find_base(s);
    if (status == CSCD_OK && s->scene->measure != MEASURE_NOTHING && s->found->left_out == 0)
        return find_measure(s);
    if (s->found->patches == NULL) return status;
    if (status == CSCD_OK && o->cut_offs) status = find_cut_offs(s);
    if (status == CSCD_OK && o->depths) status = find_depths(s);
    if (status == CSCD_OK && o->overlaps)
        status = find_overlaps(s); /* after the depths, which use its finder */
    return status;
}

cscd_status surface_answers_find(surface_answers *a, const surface_scene *scene,
                                 const cscd_intersection_options *options, memory_budget *budget,
                                 cscd_intersections *found) {
    const detector_config *config = scene->config;
    const cscd_mesh *mesh = scene->space->mesh;
    const host_memory *memory = &scene->space->context->memory;
    const size_t before = memory_bytes(memory);
    if (a->left_out.out_of_memory) return CSCD_OUT_OF_MEMORY;
    named_surface surface = {.mesh = mesh,
                             .positions = scene->positions,
                             .bodies = options->part_bodies ? &config_grouping(config)->bodies : NULL,
                             .collapsed = scene->collapsed};
    if (!placed_names_find(&a->names, mesh, scene->positions, config->exclusions.names, &surface.names))
        return CSCD_OUT_OF_MEMORY;
    const surface_cuts cuts = {&surface, &a->joiner, &a->patch_finder, budget};
    const answer_search search = {a, scene, options, budget, &surface, &cuts, found};
    cscd_status status = find_answers(&search);
    a->kept += memory_bytes(memory) - before; /* may be fewer than before */
    return status;
}
