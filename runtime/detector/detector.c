/* The detector of the public API: options, parts, and what they report. */
#include "runtime/detector/detector.h"

#include "runtime/detector/detector_rules.h"
#include "runtime/detector/detector_validate.h"
#include "runtime/detector/list_cap.h"
#include "runtime/detector/surface_answers.h"
#include "runtime/narrow_phase/narrow_phase.h"
#include "src/core/floating.h"
#include "src/core/least_sizes.h"
#include "src/core/names.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

static const cscd_detector_options default_options = {.step_factor = 0.8, .floor_ratio = 0.9};

void cscd_detector_defaults_sized(cscd_detector_options *out, size_t size) {
    struct_give_options(out, size, &default_options, sizeof default_options);
}

static cscd_status check_options(cscd_context *context, const cscd_detector_options *options) {
    if (method_traits_of(options->method) == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown method %d", (int)options->method);
    if ((unsigned)options->mode > CSCD_MODE_EARLIEST)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown mode %d", (int)options->mode);
    if ((unsigned)options->start > CSCD_START_UNKNOWN)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown start %d", (int)options->start);
    if ((unsigned)options->volume > CSCD_VOLUME_KDOP14)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown volume %d", (int)options->volume);
    if ((unsigned)options->coherence > CSCD_COHERENCE_OFF)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown coherence %d", (int)options->coherence);
    if (!(options->step_factor > 0.0 && options->step_factor < 1.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "step_factor is %g, expected a number in (0,1)",
                            options->step_factor);
    if (!(options->floor_ratio > 0.0 && options->floor_ratio <= 0.999))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "floor_ratio is %g, expected a number in (0,0.999]", options->floor_ratio);
    if (!(is_length(options->seam_reach) || options->seam_reach == INFINITY))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "seam_reach is %g, expected 0 (the default), a length from 2^-300 to 2^300 or "
                            "INFINITY",
                            options->seam_reach);
    return separation_check(context, options->min_separation, options->tolerance);
}

static bool any_may_be_culled(const cscd_mesh *mesh) {
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        if (mesh->components[c].closed_manifold && !component_is_obstacle(mesh, c)) return true;
    }
    return false;
}

/* Without a plan only SINGLE and AUTO cull, with a region for each component; a plan must be the mesh's, and of the method asked for. */
static cscd_status choose_method(const cscd_mesh *mesh, const cscd_plan *plan,
                                 cscd_detector_options *options) {
    cscd_context *context = mesh->context;
    if (plan != NULL && plan->mesh_hash != cscd_mesh_hash(mesh))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "the plan was made for another mesh (hash %016llx, this one has %016llx)",
                            (unsigned long long)plan->mesh_hash, (unsigned long long)cscd_mesh_hash(mesh));
    cscd_method method = options->method;
    if (method == CSCD_METHOD_AUTO && plan == NULL && !any_may_be_culled(mesh)) method = CSCD_METHOD_NONE;
    options->method = method;
    if (method_stages_of(method)->rules == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "method %s is a baseline, and this library was built without runtime/baselines",
                            cscd_method_name(method));
    if ((options->ours & ~method_stages_of(method)->ours) != 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "ours has steps that a detector of method %s does not take: 0x%llx; CSCD_OURS_ "
                            "in cscd/research.h says which it takes",
                            cscd_method_name(method),
                            (unsigned long long)(options->ours & ~method_stages_of(method)->ours));
    if (method_traits_of(method)->needs_plan && (plan == NULL || plan->method != method))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "method %s wants a plan of that method%s%s",
                            cscd_method_name(method), plan != NULL ? ", not " : "",
                            plan != NULL ? cscd_method_name(plan->method) : "");
    return CSCD_OK;
}

array_list detector_arrays(cscd_detector *d) {
    size_t components = d->mesh->component_count, lanes = d->space.traversal.lane_count;
    return (array_list){{ARRAY(d->culled, components), ARRAY(d->closes, components),
                         ARRAY(d->touched, components), ARRAY(d->incomplete, components),
                         ARRAY(d->earliest, components), ARRAY(d->kept, components),
                         ARRAY_IF(d->rules.where_it_pays, d->kept_by_lanes, components * lanes),
                         ARRAY(d->guarantees, components), ARRAY(d->reached_scalars, d->mesh->object_count),
                         ARRAY(d->contacts_seen, lanes), ARRAY(d->never_culled, components)}};
}

void detector_choose_regions(cscd_detector *d) {
    const culling *c = &d->culling;
    d->rebuild = (bvh_rebuild){
        .mesh = d->mesh,
        .regions = {c->triangle_regions, c->triangle_weights, c->region_count},
        .axis_count = d->options.volume == CSCD_VOLUME_KDOP14 ? KDOP_AXES : BOX_AXES,
    };
}

cscd_status detector_create_baseline(cscd_detector *d) {
    const method_stages *stages = d->stages;
    if (stages->search != NULL)
        return stages->search->create(d->context, d->options.ours, &d->baseline_state);
    if (stages->hider == NULL) return CSCD_OK;
    d->baseline_state = stages->hider->create(d->context);
    return d->baseline_state != NULL ? CSCD_OK : context_out_of_memory(d->context);
}

static void destroy_baseline(cscd_detector *d) {
    const method_stages *stages = d->stages;
    if (d->baseline_state == NULL) return;
    (stages->search != NULL ? stages->search->destroy : stages->hider->destroy)(d->context,
                                                                                d->baseline_state);
}

static cscd_status create_parts(cscd_detector *d, const cscd_plan *plan) {
    bool own_regions =
        d->options.method == CSCD_METHOD_SINGLE && plan != NULL && plan->method != d->options.method;
    cscd_status status = search_space_create(d->mesh, &d->space);
    if (status == CSCD_OK) status = culling_create(d->mesh, own_regions ? NULL : plan, &d->culling);
    if (status == CSCD_OK) detector_choose_regions(d);
    if (status == CSCD_OK) status = start_states_create(d->mesh, &d->starts);
    d->starts.adapts = d->rules.where_it_pays;
    if (status == CSCD_OK) status = static_check_create(d->mesh, d->space.traversal.lane_count, &d->check);
    if (status == CSCD_OK) status = rollback_create(d->mesh, &d->before);
    if (status == CSCD_OK) status = collapsed_create(d->mesh, &d->collapsed);
    if (status == CSCD_OK && !context_allocate_all(d->context, detector_arrays(d)))
        status = CSCD_OUT_OF_MEMORY;
    return status;
}

void detector_free(cscd_detector *d) {
    cscd_context *context = d->context;
    destroy_baseline(d);
    if (d->culling.mesh != NULL) culling_destroy(&d->culling);
    if (d->starts.mesh != NULL) start_states_destroy(&d->starts);
    static_check_destroy(&d->check);
    verlet_list_free(context, &d->verlet);
    collapsed_free(&d->collapsed);
    search_space_destroy(&d->space);
    bvh_free(&d->rebuild.kept);
    exclusions_free(context, &d->exclusions);
    waiting_pairs_free(d->mesh, &d->waiting);
    pair_rules_free(d->mesh, &d->pair_rules);
    rollback_free(context, &d->before);
    result_buffer_free(context, &d->contacts);
    result_buffer_free(context, &d->proximities);
    result_buffer_free(context, &d->pairs);
    result_buffer_free(context, &d->names);
    surface_answers_free(context, d->answers);
    part_labels_free(context, &d->parts);
    part_labels_free(context, &d->grouping);
    part_sums_free(context, &d->part_sums);
    result_buffer_free(context, &d->contact_parts);
    edge_rest_free(context, &d->rest);
    context_free_all(context, detector_arrays(d));
    context_free(context, d->unpacked[0]);
    context_free(context, d->unpacked[1]);
    context_free(context, d->reached);
    context_free(context, d->cap.tainted);
    context_free(context, d->pair_scratch);
    context_free(context, d->vertex_scratch);
    context_free(context, d->scalars);
    context_free(context, d->seen);
    context_free(context, d);
}

static void free_detector(reference_count *references) {
    cscd_detector *d = (cscd_detector *)references;
    cscd_context *context = d->context;
    cscd_mesh mesh = *d->seen;
    detector_free(d);
    mesh_release(&mesh);
    context_release(context);
}

static const char *validate_listed(const reference_count *object) {
    return detector_validate((const cscd_detector *)object);
}

void detector_list(cscd_detector *d) {
    context_list_object(d->context, &d->references, validate_listed);
}

cscd_detector *detector_allocate(cscd_context *context, const cscd_mesh *mesh) {
    cscd_detector *d = context_allocate(context, 1, sizeof *d);
    cscd_mesh *seen = context_allocate(context, 1, sizeof *seen);
    if (d == NULL || seen == NULL) {
        context_free(context, d);
        context_free(context, seen);
        return NULL;
    }
    d->context = context;
    *seen = mesh_seen_from(context, mesh);
    d->mesh = d->seen = seen;
    return d;
}

cscd_detector *detector_begin(cscd_context *context, const cscd_mesh *mesh) {
    cscd_detector *d = detector_allocate(context, mesh);
    if (d == NULL) return NULL;
    mesh_hold(mesh);
    context_add_object(context, &d->references, free_detector);
    return d;
}

void detector_take_options(cscd_detector *d, const cscd_detector *from) {
    d->options = from->options;
    d->memory_most = from->memory_most;
    d->limit = from->limit;
    d->traits = from->traits;
    d->stages = from->stages;
    d->rules = from->rules;
}

/* Creates a detector with checked options. */
static cscd_status create_detector(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                   cscd_detector_options chosen, cscd_detector **out) {
    cscd_detector *d = detector_begin(context, mesh);
    if (d == NULL) return context_out_of_memory(context);
    d->options = chosen;
    d->traits = method_traits_of(chosen.method);
    d->stages = method_stages_of(chosen.method);
    d->rules = *d->stages->rules;
    if ((chosen.ours & CSCD_OURS_STARTS) != 0) d->rules.assumes_clean = false;
    d->limit = separation_limit(chosen.min_separation, chosen.tolerance);
    cscd_status status = exclusions_create(d->mesh, &chosen, &d->exclusions);
    d->exclusions.waiting = &d->waiting.pairs;
    if (status == CSCD_OK && create_parts(d, plan) != CSCD_OK) status = context_out_of_memory(context);
    if (status == CSCD_OK) status = detector_create_baseline(d);
    const given_rules given = {chosen.rules, chosen.rule_count, chosen.thickness_matrix,
                               chosen.thickness_class_count};
    if (status == CSCD_OK) status = detector_set_rules(d, &given);
    if (status == CSCD_OK) status = list_cap_set(d, chosen.longest_list);
    if (status != CSCD_OK) {
        cscd_detector_destroy(d);
        return status;
    }
    detector_list(d);
    *out = d;
    return CSCD_OK;
}

static cscd_status take_options(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                const cscd_detector_options *options, cscd_detector **out) {
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_create: out is NULL");
    cscd_detector_options chosen = default_options;
    cscd_status status = CSCD_OK;
    if (options != NULL)
        status = struct_take_options(context, &chosen, sizeof chosen, LEAST_SIZE(cscd_detector_options),
                                     options, "cscd_detector_defaults");
    if (status == CSCD_OK) status = check_options(context, &chosen);
    cscd_mesh seen = mesh_seen_from(context, mesh);
    if (status == CSCD_OK) status = choose_method(&seen, plan, &chosen);
    return status == CSCD_OK ? create_detector(context, mesh, plan, chosen, out) : status;
}

cscd_status cscd_detector_create(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                 const cscd_detector_options *options, cscd_detector **out) {
    if (context == NULL || mesh == NULL) return context_lacks(context, "cscd_detector_create", "mesh");
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, take_options(context, mesh, plan, options, out));
}

void detector_hold(cscd_detector *d) {
    reference_add(&d->references);
}

void detector_release(cscd_detector *d) {
    context_drop_object(d->context, &d->references);
}

void cscd_detector_destroy(cscd_detector *d) {
    if (d != NULL) context_destroy_object(d->context, &d->references);
}

static cscd_status set_separation(cscd_detector *detector, double min_separation, double tolerance) {
    cscd_detector_options changed = detector->options;
    changed.min_separation = min_separation;
    changed.tolerance = tolerance;
    cscd_status status = separation_check(detector->context, min_separation, tolerance);
    if (status == CSCD_OK)
        status = detector_check_distances(detector, min_separation, detector->pair_rules.greatest);
    if (status != CSCD_OK) return status;
    detector->options = changed;
    detector->limit = separation_limit(min_separation, tolerance);
    return CSCD_OK;
}

cscd_status cscd_detector_set_separation(cscd_detector *detector, double min_separation, double tolerance) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, set_separation(detector, min_separation, tolerance));
}

interval_search detector_search_begin(cscd_detector *d, const double *x0, const double *x1) {
    interval_search search = interval_search_begin(&d->space, x0, x1, d->limit);
    search.interval.thick = detector_thick(d);
    search.interval.tolerance = d->options.tolerance;
    return search;
}

static double largest_coordinate(const double *x, size_t count) {
    double largest = 0.0;
    for (size_t i = 0; i < count; i++) largest = max_of(largest, fabs(x[i]));
    return largest;
}

/* A pair exceeds its floor surely when it exceeds it by the tolerance and 2^-40 of its extent, which is at most twice
 * the largest coordinate C. 2^-37 C is more. */
double detector_floors_beyond(const cscd_detector *d, double distance, const double *x0, const double *x1) {
    size_t count = (size_t)d->mesh->vertex_count * 3;
    double greatest = max_of(distance, d->pair_rules.greatest);
    if (greatest == 0.0) return 0.0;
    double largest = max_of(largest_coordinate(x0, count), largest_coordinate(x1, count));
    return separation_limit(greatest, d->options.tolerance).tolerance + 0x1p-37 * largest;
}

interval_search detector_search_floors(cscd_detector *d, const double *x0, const double *x1) {
    interval_search search = detector_search_begin(d, x0, x1);
    search.interval.beyond = detector_floors_beyond(d, d->limit.distance, x0, x1);
    search.interval.floor_ratio = search.interval.beyond > 0.0 ? d->options.floor_ratio : 0.0;
    return search;
}

void detector_find_collapsed(cscd_detector *d, const double *x0, const double *x1) {
    collapsed_begin(&d->collapsed);
    collapsed_add(&d->collapsed, x0, d->exclusions.names);
    if (x1 != x0) collapsed_add(&d->collapsed, x1, d->exclusions.names);
}

cscd_status detector_leave_collapsed(cscd_detector *d, collapsed_trees which) {
    const bool *collapsed = which != COLLAPSED_FOUND ? collapsed_marks(&d->collapsed) : NULL;
    d->space.traversal.collapsed = COLLAPSED_FOUND;
    if (collapsed == NULL) return CSCD_OK;
    if (!bvh_mark_collapsed(&d->space.bvh, collapsed)) return CSCD_OUT_OF_MEMORY;
    d->space.traversal.collapsed = which;
    return CSCD_OK;
}

bool cscd_detector_collapsed(const cscd_detector *detector, uint32_t component) {
    return component < detector->mesh->component_count && detector->collapsed.marks[component];
}

void detector_begin_call(cscd_detector *d) {
    d->exclusions.marked_wait = false;
    progress_begin(&d->context->progress);
    rollback_save(&d->before, &d->starts, &d->rebuild);
    verlet_list_begin_call(&d->verlet);
}

cscd_status detector_fail_call(cscd_detector *d, cscd_status status) {
    if (status == CSCD_IN_CONTACT) return status;
    rollback_restore(&d->before, &d->starts, &d->rebuild);
    verlet_list_undo(&d->verlet);
    return status == CSCD_LIST_TOO_LONG ? status : context_explain(d->context, status);
}

cscd_timings cscd_detector_timings(const cscd_detector *detector) {
    return detector->timings;
}

cscd_counters cscd_detector_counters(const cscd_detector *detector) {
    return detector->counters;
}

cscd_guarantee cscd_detector_guarantee(const cscd_detector *detector, uint32_t component) {
    return detector->guarantees[component];
}

const cscd_mesh *cscd_detector_mesh(const cscd_detector *detector) {
    return mesh_of_creator(detector->mesh);
}

int cscd_detector_orientation(const cscd_detector *detector, uint32_t triangle) {
    uint8_t flag = detector->culling.facing[triangle];
    return flag == ORIENTATION_PLUS ? 1 : flag == ORIENTATION_MINUS ? -1 : 0;
}

bool cscd_detector_region_point(const cscd_detector *detector, uint32_t region, double p0[3], double p1[3]) {
    if (region >= detector_region_count(detector)) return false;
    const double(*points)[3] = (const double(*)[3])detector->culling.detector_points[region];
    memcpy(p0, points[0], sizeof(double[3]));
    memcpy(p1, points[1], sizeof(double[3]));
    return true;
}

cscd_waiting cscd_detector_waiting(const cscd_detector *detector) {
    return (cscd_waiting){.features = waiting_features(&detector->waiting),
                          .triangles = detector->waiting.pairs.triangle_pairs};
}
