/* The detector of the public API: its life, what its calls share, and what it reports. */
#include "runtime/detector/detector.h"

#include "runtime/detector/surface_answers.h"
#include "src/core/floating.h"
#include "src/core/least_sizes.h"
#include "src/core/sort.h"
#include "src/core/vec3.h"
#include "src/mesh/parts.h"

#include <math.h>
#include <string.h>

/* ---- options ------------------------------------------------------------------------------------------- */

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

/* ---- parts --------------------------------------------------------------------------------------------- */

array_list detector_arrays(cscd_detector *d) {
    size_t components = d->mesh->component_count, workers = d->space.traversal.worker_count;
    return (array_list){
        {ARRAY(d->interval.culled, components), ARRAY(d->interval.closes, components),
         ARRAY(d->interval.touched, components), ARRAY(d->interval.incomplete, components),
         ARRAY(d->interval.earliest, components), ARRAY(d->interval.kept, components),
         ARRAY_IF(d->config.rules.where_it_pays, d->interval.kept_by_workers, components * workers),
         ARRAY(d->results.guarantees, components), ARRAY(d->reached_scalars, d->mesh->object_count),
         ARRAY(d->interval.contacts_seen, workers), ARRAY(d->config.never_culled, components)}};
}

void detector_choose_regions(cscd_detector *d) {
    const culling *c = &d->interval.culling;
    d->rebuild = (bvh_rebuild){
        .mesh = d->mesh,
        .regions = {c->triangle_regions, c->triangle_weights, c->region_count},
        .axis_count = d->config.options.volume == CSCD_VOLUME_KDOP14 ? KDOP_AXES : BOX_AXES,
    };
}

cscd_status detector_create_baseline(cscd_detector *d) {
    const method_stages *stages = d->config.stages;
    if (stages->search != NULL)
        return stages->search->create(d->context, d->config.options.ours, &d->config.baseline_state);
    if (stages->hider == NULL) return CSCD_OK;
    d->config.baseline_state = stages->hider->create(d->context);
    return d->config.baseline_state != NULL ? CSCD_OK : context_out_of_memory(d->context);
}

static void destroy_baseline(cscd_detector *d) {
    const method_stages *stages = d->config.stages;
    if (d->config.baseline_state == NULL) return;
    (stages->search != NULL ? stages->search->destroy : stages->hider->destroy)(d->context,
                                                                                d->config.baseline_state);
}

static cscd_status create_parts(cscd_detector *d, const cscd_plan *plan) {
    bool own_regions = d->config.options.method == CSCD_METHOD_SINGLE && plan != NULL &&
                       plan->method != d->config.options.method;
    cscd_status status = search_space_create(d->mesh, &d->space);
    if (status == CSCD_OK) status = culling_create(d->mesh, own_regions ? NULL : plan, &d->interval.culling);
    if (status == CSCD_OK) detector_choose_regions(d);
    if (status == CSCD_OK) status = start_states_create(d->mesh, &d->known.starts);
    d->known.starts.adapts = d->config.rules.where_it_pays;
    if (status == CSCD_OK)
        status = static_check_create(d->mesh, d->space.traversal.worker_count, &d->known.check);
    if (status == CSCD_OK) status = rollback_create(d->mesh, &d->known.before);
    if (status == CSCD_OK) status = collapsed_create(d->mesh, &d->known.collapsed);
    if (status == CSCD_OK && !context_allocate_all(d->context, detector_arrays(d)))
        status = CSCD_OUT_OF_MEMORY;
    return status;
}

void detector_free(cscd_detector *d) {
    cscd_context *context = d->context;
    destroy_baseline(d);
    if (d->interval.culling.mesh != NULL) culling_destroy(&d->interval.culling);
    if (d->known.starts.mesh != NULL) start_states_destroy(&d->known.starts);
    static_check_destroy(&d->known.check);
    verlet_list_free(context, &d->known.verlet);
    collapsed_free(&d->known.collapsed);
    search_space_destroy(&d->space);
    bvh_free(&d->rebuild.kept);
    exclusions_free(context, &d->config.exclusions);
    waiting_pairs_free(d->mesh, &d->config.waiting);
    pair_rules_free(d->mesh, &d->config.pair_rules);
    rollback_free(context, &d->known.before);
    result_buffer_free(context, &d->results.contacts);
    result_buffer_free(context, &d->results.proximities);
    result_buffer_free(context, &d->results.intersections);
    near_list_free(context, &d->results.near);
    result_buffer_free(context, &d->results.repetitions);
    surface_answers_free(context, d->results.answers);
    part_labels_free(context, &d->config.parts);
    part_labels_free(context, &d->config.grouping);
    part_sums_free(context, &d->results.part_sums);
    result_buffer_free(context, &d->results.contact_parts);
    rest_shape_free(context, &d->config.rest);
    result_buffer_free(context, &d->results.candidates);
    result_buffer_free(context, &d->results.lenses);
    result_buffer_free(context, &d->results.lens_points);
    context_free_all(context, detector_arrays(d));
    context_free(context, d->unpacked[0]);
    context_free(context, d->unpacked[1]);
    context_free(context, d->reached);
    context_free(context, d->interval.cap.tainted);
    context_free(context, d->pair_scratch);
    context_free(context, d->vertex_scratch);
    context_free(context, d->scalars);
    context_free(context, d->response.vertices);
    active_set_free(context, &d->response.focus);
    context_free(context, d->response.stops);
    context_free(context, d->response.held);
    context_free(context, d->response.divided);
    context_free(context, d->seen);
    context_free(context, d);
}

/* ---- life ---------------------------------------------------------------------------------------------- */

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
    d->interval.space = &d->space;
    d->interval.exclusions = &d->config.exclusions;
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
    d->config.options = from->config.options;
    d->config.memory_most = from->config.memory_most;
    d->config.limit = from->config.limit;
    d->config.traits = from->config.traits;
    d->config.stages = from->config.stages;
    d->config.rules = from->config.rules;
}

/* Creates a detector with checked options. */
static cscd_status create_detector(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                   cscd_detector_options chosen, cscd_detector **out) {
    cscd_detector *d = detector_begin(context, mesh);
    if (d == NULL) return context_out_of_memory(context);
    d->config.options = chosen;
    d->config.traits = method_traits_of(chosen.method);
    d->config.stages = method_stages_of(chosen.method);
    d->config.rules = *d->config.stages->rules;
    if ((chosen.ours & CSCD_OURS_STARTS) != 0) d->config.rules.assumes_clean = false;
    d->config.limit = separation_limit(chosen.min_separation, chosen.tolerance);
    cscd_status status = exclusions_create(d->mesh, &chosen, &d->config.exclusions);
    d->config.exclusions.waiting = &d->config.waiting.pairs;
    if (status == CSCD_OK && create_parts(d, plan) != CSCD_OK) status = context_out_of_memory(context);
    if (status == CSCD_OK) status = detector_create_baseline(d);
    const given_rules given = {chosen.rules, chosen.rule_count, chosen.thickness_matrix,
                               chosen.thickness_class_count};
    if (status == CSCD_OK) status = detector_set_rules(d, &given);
    if (status == CSCD_OK) status = detector_set_longest_list(d, chosen.longest_list);
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

/* ---- a call -------------------------------------------------------------------------------------------- */

static double largest_coordinate(const double *x, size_t count) {
    double largest = 0.0;
    for (size_t i = 0; i < count; i++) largest = max_of(largest, fabs(x[i]));
    return largest;
}

/* A pair exceeds its floor surely when it exceeds it by the tolerance and 2^-40 of its extent, which is at most twice
 * the largest coordinate C. 2^-37 C is more. */
double detector_floors_beyond(const cscd_detector *d, double distance, const double *x0, const double *x1) {
    size_t count = (size_t)d->mesh->vertex_count * 3;
    double greatest = max_of(distance, d->config.pair_rules.greatest);
    if (greatest == 0.0) return 0.0;
    double largest = max_of(largest_coordinate(x0, count), largest_coordinate(x1, count));
    return separation_limit(greatest, d->config.options.tolerance).tolerance + 0x1p-37 * largest;
}

interval_search detector_search_floors(cscd_detector *d, const double *x0, const double *x1) {
    interval_search search = config_search_begin(&d->config, &d->space, x0, x1);
    search.interval.beyond = detector_floors_beyond(d, d->config.limit.distance, x0, x1);
    search.interval.floor_ratio = search.interval.beyond > 0.0 ? d->config.options.floor_ratio : 0.0;
    if (d->config.limit.distance > 0.0) search.interval.filter.seam_names = d->config.exclusions.names;
    return search;
}

void detector_find_collapsed(cscd_detector *d, const double *x0, const double *x1) {
    collapsed_begin(&d->known.collapsed);
    collapsed_add(&d->known.collapsed, x0, d->config.exclusions.names);
    if (x1 != x0) collapsed_add(&d->known.collapsed, x1, d->config.exclusions.names);
}

cscd_status detector_leave_collapsed(cscd_detector *d, collapsed_trees which) {
    const bool *collapsed = which != COLLAPSED_FOUND ? collapsed_marks(&d->known.collapsed) : NULL;
    d->space.traversal.collapsed = COLLAPSED_FOUND;
    if (collapsed == NULL) return CSCD_OK;
    if (!bvh_mark_collapsed(&d->space.bvh, collapsed)) return CSCD_OUT_OF_MEMORY;
    d->space.traversal.collapsed = which;
    return CSCD_OK;
}

bool cscd_detector_collapsed(const cscd_detector *detector, uint32_t component) {
    return component < detector->mesh->component_count && detector->known.collapsed.marks[component];
}

void detector_begin_call(cscd_detector *d) {
    d->config.exclusions.marked_wait = false;
    progress_begin(&d->context->progress);
    rollback_save(&d->known.before, &d->known.starts, &d->rebuild);
    verlet_list_begin_call(&d->known.verlet);
}

cscd_status detector_fail_call(cscd_detector *d, cscd_status status) {
    if (status == CSCD_IN_CONTACT) return status;
    rollback_restore(&d->known.before, &d->known.starts, &d->rebuild);
    verlet_list_undo(&d->known.verlet);
    return status == CSCD_LIST_TOO_LONG ? status : context_explain(d->context, status);
}

/* ---- what it reports ----------------------------------------------------------------------------------- */

cscd_timings cscd_detector_timings(const cscd_detector *detector) {
    return detector->results.timings;
}

cscd_counters cscd_detector_counters(const cscd_detector *detector) {
    return detector->results.counters;
}

cscd_guarantee cscd_detector_guarantee(const cscd_detector *detector, uint32_t component) {
    return detector->results.guarantees[component];
}

const cscd_mesh *cscd_detector_mesh(const cscd_detector *detector) {
    return mesh_of_creator(detector->mesh);
}

int cscd_detector_orientation(const cscd_detector *detector, uint32_t triangle) {
    uint8_t flag = detector->interval.culling.facing[triangle];
    return flag == ORIENTATION_PLUS ? 1 : flag == ORIENTATION_MINUS ? -1 : 0;
}

bool cscd_detector_region_point(const cscd_detector *detector, uint32_t region, double p0[3], double p1[3]) {
    if (region >= detector_region_count(detector)) return false;
    const double(*points)[3] = (const double(*)[3])detector->interval.culling.detector_points[region];
    memcpy(p0, points[0], sizeof(double[3]));
    memcpy(p1, points[1], sizeof(double[3]));
    return true;
}

cscd_waiting cscd_detector_waiting(const cscd_detector *detector) {
    return (cscd_waiting){.features = waiting_features(&detector->config.waiting),
                          .triangles = detector->config.waiting.pairs.triangle_pairs};
}

/* ---- contacts by parts --------------------------------------------------------------------------------- */

/* A pair of parts, and the place of a contact of the two. */
typedef struct contact_part_key {
    uint64_t parts, place;
} contact_part_key;

static void add_contact(const cscd_contact *contacts, size_t place, cscd_contact_part_pair *out) {
    if (out->count == 0 || contacts[place].toi < out->toi) {
        out->earliest = place;
        out->toi = contacts[place].toi;
    }
    out->count++;
}

/* Keys are sorted, those of one pair of parts in the order of the contacts. */
static size_t sum_contacts(const contact_part_key *keys, size_t count, const cscd_contact *contacts,
                           cscd_contact_part_pair *items) {
    size_t made = 0;
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || keys[i].parts != keys[i - 1].parts)
            items[made++] =
                (cscd_contact_part_pair){.a = (uint32_t)(keys[i].parts >> 32), .b = (uint32_t)keys[i].parts};
        add_contact(contacts, (size_t)keys[i].place, &items[made - 1]);
    }
    return made;
}

static cscd_status contact_parts(cscd_detector *d, const cscd_contact *contacts, size_t count,
                                 cscd_contact_part_pairs *out) {
    if (out == NULL)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT, "cscd_detector_contact_parts: out is NULL");
    cscd_status status =
        given_contacts_check(d->context, d->mesh, "cscd_detector_contact_parts", contacts, count);
    if (status != CSCD_OK) return status;
    result_buffer *buffer = &d->results.contact_parts;
    status = result_buffer_reserve(d->context, buffer, count, sizeof(cscd_contact_part_pair),
                                   sizeof(contact_part_key));
    if (status != CSCD_OK) return context_explain(d->context, status);
    contact_part_key *keys = buffer->keys;
    for (size_t i = 0; i < count; i++) {
        const cscd_contact *c = &contacts[i];
        keys[i] = (contact_part_key){parts_of_contact(&d->config.parts, d->mesh, c->kind, c->a, c->b), i};
    }
    sort_by_number(keys, buffer->spare_keys, count, sizeof *keys);
    const cscd_contact_part_pairs sums = {buffer->items, sum_contacts(keys, count, contacts, buffer->items)};
    *out = sums;
    return CSCD_OK;
}

cscd_status cscd_detector_contact_parts(cscd_detector *detector, const cscd_contact *contacts,
                                        size_t contact_count, cscd_contact_part_pairs *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, contact_parts(detector, contacts, contact_count, out));
}

/* ---- the validator: regions ---------------------------------------------------------------------------- */

static const char *check_regions(const cscd_detector *d) {
    const culling *c = &d->interval.culling;
    const bool *obstacles = d->mesh->obstacles;
    for (uint32_t t = 0; t < d->mesh->triangle_count; t++) {
        if (c->triangle_regions[t] >= c->region_count) return "a triangle is in a region that there is not";
        if (!(c->triangle_weights[t] >= 0.0 && c->triangle_weights[t] <= 1.0 + 0x1p-40))
            return "a triangle has no weight in its region";
        if (c->facing[t] > ORIENTATION_ZERO) return "a triangle has an unknown orientation";
    }
    for (uint32_t i = 0; i < c->region_count; i++) {
        for (int k = 0; k < 3; k++) {
            if (!isfinite(c->detector_offsets[i][k])) return "a detector point is nowhere";
        }
    }
    for (uint32_t i = 0; i < d->mesh->component_count; i++) {
        if (obstacles != NULL && obstacles[i] && d->interval.culled[i])
            return "the pairs of an obstacle are culled";
    }
    return NULL;
}

/* ---- what is known of the start -------------------------------------------------------------------------- */

static const char *check_states(const start_states *s) {
    const cscd_mesh *mesh = s->mesh;
    for (uint32_t c = 0; s->counted && c < mesh->component_count; c++) {
        const component_start *start = &s->of[c];
        uint64_t sum = (uint64_t)start->unknown + start->crossing + start->clean;
        if (sum > mesh->components[c].triangle_count)
            return "a component has more states than triangles at its start";
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (s->triangles[t] > TRIANGLE_CLEAN) return "a triangle has an unknown state at its start";
        if (s->triangles[t] != TRIANGLE_UNKNOWN && !s->known)
            return "a triangle has a state at a start that nobody has seen";
    }
    return NULL;
}

/* ---- pairs to leave out, rules --------------------------------------------------------------------------- */

static const char *check_exclusions(const exclusions *e) {
    for (size_t i = 0; i < e->ignored_count; i++) {
        uint64_t a = e->ignored[i] >> 32, b = e->ignored[i] & UINT32_MAX;
        if (a > b || b >= e->mesh->triangle_count) return "a pair to leave out names no two triangles";
        if (i > 0 && e->ignored[i - 1] > e->ignored[i]) return "the pairs to leave out are not sorted";
    }
    for (uint32_t v = 0; e->names != NULL && v < e->mesh->vertex_count; v++) {
        if (e->names[v] > v || e->names[e->names[v]] != e->names[v])
            return "the seams do not name their vertices";
    }
    return NULL;
}

static const char *check_rules(const cscd_detector *d) {
    const pair_rules *r = &d->config.pair_rules;
    if ((r->sets != NULL) != (d->space.rules != NULL) || r->sets != d->rebuild.objects ||
        r->sets != d->known.check.objects)
        return "the parts of a detector have different rules";
    if (r->sets == NULL) return NULL;
    if (r->object_count != d->mesh->object_count) return "the rules are of another number of objects";
    for (uint32_t i = 0; i < r->object_count; i++) {
        double reach = r->reaches[i];
        if (!(reach >= 0.0 && reach <= r->greatest)) return "an object's distance is not within the greatest";
        if (r->matrix != NULL && r->classes[i] >= r->class_count)
            return "an object's thickness class is none";
    }
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        if (r->component_objects[c] >= r->object_count)
            return "a component is of an object that there is not";
    }
    return NULL;
}

static const char *check_active(const cscd_detector *d) {
    const search_space *s = &d->space;
    const char *fault = active_set_validate(&s->active, d->mesh);
    if (fault == NULL && d->rebuild.active != s->active.triangles)
        fault = "the trees and their detector have different active sets";
    return fault != NULL || s->bvh.mesh == NULL ? fault : bvh_check_active(&s->bvh, s->active.triangles);
}

/* ---- the validator: all of it -------------------------------------------------------------------------- */

static const char *check_parts(const cscd_detector *d) {
    const cscd_mesh *mesh = d->mesh;
    if (mesh != d->seen || d->space.mesh != mesh || d->known.starts.mesh != mesh ||
        d->interval.culling.mesh != mesh || d->rebuild.mesh != mesh || d->config.exclusions.mesh != mesh)
        return "the parts of a detector are of different meshes";
    if (mesh->shared != NULL && mesh_of_creator(mesh)->triangle_count != mesh->triangle_count)
        return "the mesh of a detector has changed";
    if (!(d->config.limit.distance >= 0.0) || !(d->config.limit.tolerance >= 0.0) ||
        d->config.limit.distance != d->config.options.min_separation)
        return "the distance of a detector is not that of its options";
    if (d->interval.cap.longest != d->config.options.longest_list)
        return "the cap of a detector's lists is not that of its options";
    return NULL;
}

const char *detector_validate(const cscd_detector *d) {
    const char *fault = check_parts(d);
    if (fault == NULL) fault = check_regions(d);
    if (fault == NULL) fault = check_states(&d->known.starts);
    if (fault == NULL) fault = check_exclusions(&d->config.exclusions);
    if (fault == NULL) fault = check_rules(d);
    if (fault == NULL && d->space.bvh.mesh != NULL) fault = bvh_validate(&d->space.bvh, false);
    if (fault == NULL) fault = check_active(d);
    if (fault == NULL) fault = part_labels_validate(&d->config.parts, d->mesh);
    if (fault == NULL) fault = part_labels_validate(&d->config.grouping, d->mesh);
    return fault;
}
