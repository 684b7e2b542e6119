/* Energies of the public API: options, lists of items, and the calls. */
#include "runtime/energy/energy.h"

#include "src/core/floating.h"
#include "src/core/least_sizes.h"
#include "src/mesh/positions.h"

#include <math.h>
#include <string.h>

struct cscd_energy {
    reference_count references;
    cscd_context *context;
    cscd_mesh mesh; /* as objects of the context see it */
    double *unpacked[2];
    sum_memory memory;
    owned_pattern pattern;

    friction_term *frozen;
    size_t frozen_count, frozen_capacity;
    double slip;
};

static const cscd_energy_options default_options = {.struct_size = sizeof default_options, .stiffness = 1.0};

void cscd_energy_defaults_sized(cscd_energy_options *out, size_t size) {
    struct_give_options(out, size, &default_options, sizeof default_options);
}

/* ---- creation ------------------------------------------------------------------------------------------ */

static void free_energy(reference_count *references) {
    cscd_energy *e = (cscd_energy *)references;
    cscd_context *context = e->context;
    cscd_mesh mesh = e->mesh;
    for (int i = 0; i < 2; i++) context_free(context, e->unpacked[i]);
    sum_memory_free(context, &e->memory);
    owned_pattern_free(context, &e->pattern);
    context_free(context, e->frozen);
    context_free(context, e);
    mesh_release(&mesh);
    context_release(context);
}

static const char *validate_listed(const reference_count *object) {
    const cscd_energy *e = (const cscd_energy *)object;
    if (e->frozen_count > e->frozen_capacity) return "an energy has frozen more pairs than it has room for";
    for (size_t i = 0; i < e->frozen_count; i++) {
        for (int j = 0; j < 4; j++) {
            if (e->frozen[i].vertices[j] >= e->mesh.vertex_count)
                return "an energy has frozen a vertex that there is not";
        }
    }
    return NULL;
}

cscd_status energy_create(cscd_context *context, const cscd_mesh *mesh, cscd_energy **out) {
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_energy_create: out is NULL");
    cscd_energy *e = context_allocate(context, 1, sizeof *e);
    if (e == NULL) return context_out_of_memory(context);
    e->context = context;
    e->mesh = mesh_seen_from(context, mesh);
    mesh_hold(mesh);
    context_add_object(context, &e->references, free_energy);
    context_list_object(context, &e->references, validate_listed);
    *out = e;
    return CSCD_OK;
}

cscd_status cscd_energy_create(cscd_context *context, const cscd_mesh *mesh, cscd_energy **out) {
    if (context == NULL || mesh == NULL) return context_lacks(context, "cscd_energy_create", "mesh");
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, energy_create(context, mesh, out));
}

void cscd_energy_destroy(cscd_energy *energy) {
    if (energy != NULL) context_destroy_object(energy->context, &energy->references);
}

/* ---- arguments ----------------------------------------------------------------------------------------- */

/* Finite, and not below 0; false for NaN. */
static bool is_amount(double x) {
    return x >= 0.0 && x < INFINITY;
}

static cscd_status check_options(cscd_context *context, const cscd_energy_options *o) {
    if ((unsigned)o->law > CSCD_ENERGY_CUBIC)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown law %d, expected one of cscd_energy_law",
                            (int)o->law);
    if (!is_positive_length(o->reach))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "reach is %g, expected a length from 2^-300 to 2^300", o->reach);
    if (!is_amount(o->stiffness))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "stiffness is %g, expected 0 or more",
                            o->stiffness);
    return CSCD_OK;
}

static cscd_status take_options(cscd_context *context, const cscd_energy_options *options,
                                cscd_energy_options *out) {
    *out = default_options;
    if (options == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "options are NULL, but a reach is needed");
    cscd_status status = struct_take_options(context, out, sizeof *out, LEAST_SIZE(cscd_energy_options),
                                             options, "cscd_energy_defaults");
    return status == CSCD_OK ? check_options(context, out) : status;
}

/* The weights of a's vertices are from 0 to 1, those of b's from -1 to 0, and they add up to 0, up to rounding; those that the kind
 * does not have are 0. Every item is looked at in every call, and kinds come in any order, so nothing here is a branch. */
static bool weights_fit(const cscd_proximity *p) {
    static const double of_edge[] = {
        [CSCD_CONTACT_EE] = 1.0, [CSCD_CONTACT_EV] = 1.0, [CSCD_CONTACT_VH] = 0.0};
    const int size = energy_vertices_of(p->kind);
    const double in_a = of_edge[p->kind], first = p->weights[0], second = (2.0 * in_a - 1.0) * p->weights[1];
    const double third = -p->weights[2], last = -p->weights[3];
    const double a = first + in_a * second, b = (1.0 - in_a) * second + third + last;
    return (first >= 0.0) & (second >= 0.0) & (third >= 0.0) & (last >= 0.0) & (fabs(a - 1.0) <= 1e-9) &
           (fabs(b - 1.0) <= 1e-9) & ((third == 0.0) | (size > 2)) & ((last == 0.0) | (size > 3));
}

static const char *fault_of_item(const cscd_mesh *mesh, const cscd_proximity *p) {
    if ((unsigned)p->kind > CSCD_CONTACT_VH || p->kind == CSCD_CONTACT_TT)
        return "has a kind without an energy";
    const uint32_t *v = p->vertices, end = mesh->vertex_count;
    if (!((v[0] < end) & (v[1] < end) & (v[2] < end) & (v[3] < end)))
        return "names a vertex that the mesh does not have";
    if (!weights_fit(p)) return "has weights that are not those of its kind (cscd_stencil)";
    if (!is_amount(p->weight)) return "has a weight below 0 or without an end";
    if (!is_amount(p->separation)) return "has a separation below 0 or without an end";
    return p->threshold >= 0.0 ? NULL : "has a threshold below 0";
}

static cscd_status check_list(const cscd_energy *e, const cscd_proximities *items) {
    if (items == NULL || (items->items == NULL && items->count > 0))
        return context_fail(e->context, CSCD_INVALID_ARGUMENT, "items are NULL");
    if (items->count > (size_t)UINT32_MAX * 64)
        return context_fail(e->context, CSCD_INVALID_ARGUMENT,
                            "there are %zu items, expected at most 2^38 - 2^6", items->count);
    return CSCD_OK;
}

static cscd_status check_items(const cscd_energy *e, const cscd_proximities *items) {
    cscd_status status = check_list(e, items);
    if (status != CSCD_OK) return status;
    for (size_t i = 0; i < items->count; i++) {
        energy_item_prefetch(&items->items[i]);
        const char *fault = fault_of_item(&e->mesh, &items->items[i]);
        if (fault != NULL) return context_fail(e->context, CSCD_INVALID_ARGUMENT, "item %zu %s", i, fault);
    }
    return CSCD_OK;
}

static cscd_status read_positions(cscd_energy *e, const cscd_view *views, const char *name, int place,
                                  const double **out) {
    cscd_status status = views_read(e->context, &e->mesh, views, name, &e->unpacked[place], out);
    return status == CSCD_OK ? positions_check(e->context, *out, e->mesh.vertex_count, name) : status;
}

/* ---- near pairs ---------------------------------------------------------------------------------------- */

static void evaluate_near(const void *of, size_t i, energy_term *term) {
    const near_terms *n = of;
    energy_pair_evaluate(&n->options, &n->items[i], n->x, term);
}

/* The values of items that nobody has looked at are NaN where one of a batch has a fault, so that a long list comes from memory once. */
static bool batch_fits(const near_terms *n, size_t first, size_t count, const energy_outputs *out) {
    bool fits = true;
    for (size_t i = first; n->unchecked != NULL && i < first + count; i++)
        fits &= fault_of_item(n->unchecked, &n->items[i]) == NULL;
    for (size_t i = 0; !fits && i < count; i++) out->values[i] = out->gaps[i] = NAN;
    return fits;
}

/* Of pairs whose points are in one place a kernel does not know the normal. */
static void evaluate_near_batch(const void *of, size_t first, size_t count, const energy_outputs *out) {
    const near_terms *n = of;
    if (!batch_fits(n, first, count, out)) return;
    if (out->gradients == NULL) {
        n->kernels->values(n, first, count, out);
        return;
    }
    uint64_t left = n->kernels->gradients(n, first, count, out);
    for (size_t i = 0; left != 0 && i < count; i++) {
        energy_term term = {.gradient = out->gradients[i]};
        if ((left >> i & 1) != 0) evaluate_near(of, first + i, &term);
    }
}

static energy_terms terms_of_items(const near_terms *near, size_t count) {
    return (energy_terms){evaluate_near,      evaluate_near_batch, near, count, near->items->vertices,
                          &near->items->kind, sizeof *near->items};
}

static energy_terms terms_of_friction(const cscd_energy *e, const friction_motion *motion) {
    return (energy_terms){
        friction_term_evaluate, NULL, motion, e->frozen_count, e->frozen->vertices, &e->frozen->kind,
        sizeof *e->frozen};
}

cscd_status energy_evaluate(cscd_energy *e, const cscd_proximities *items, const cscd_view *positions,
                            const cscd_energy_options *options, const cscd_energy_targets *targets,
                            cscd_energy_sum *out) {
    near_terms near = {.kernels = energy_kernels_of(e->context)};
    const bool written =
        targets != NULL && (targets->gradient != NULL || targets->blocks != NULL || targets->matrix != NULL);
    cscd_energy_sum sum;
    if (out == NULL)
        return context_fail(e->context, CSCD_INVALID_ARGUMENT, "cscd_energy_evaluate: out is NULL");
    cscd_status status = take_options(e->context, options, &near.options);
    if (status == CSCD_OK) status = written ? check_items(e, items) : check_list(e, items);
    if (status == CSCD_OK) status = read_positions(e, positions, "positions", 0, &near.x);
    if (status == CSCD_OK && targets != NULL) status = energy_targets_check(e->context, &e->mesh, targets);
    if (status != CSCD_OK) return status;
    near.items = items->items;
    near.unchecked = written ? NULL : &e->mesh;
    energy_terms terms = items->count > 0 ? terms_of_items(&near, items->count) : (energy_terms){NULL};
    status = energy_sum_terms(e->context, &e->mesh, &terms, targets, &e->memory, &sum);
    if (status == CSCD_OK && isnan(sum.value)) status = check_items(e, items);
    if (status == CSCD_OK) *out = sum;
    return status;
}

cscd_status cscd_energy_evaluate(cscd_energy *energy, const cscd_proximities *items,
                                 const cscd_view *positions, const cscd_energy_options *options,
                                 const cscd_energy_targets *targets, cscd_energy_sum *out) {
    if (energy == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(energy, &entry)) return entry.status;
    return context_leave(&entry, energy_evaluate(energy, items, positions, options, targets, out));
}

/* ---- patterns ------------------------------------------------------------------------------------------ */

static cscd_status make_pattern(cscd_energy *e, const cscd_proximities *items,
                                const cscd_energy_pattern *others, cscd_energy_pattern *out) {
    if (out == NULL)
        return context_fail(e->context, CSCD_INVALID_ARGUMENT, "cscd_energy_make_pattern: out is NULL");
    cscd_status status = check_items(e, items);
    if (status == CSCD_OK && others != NULL) status = energy_pattern_check(e->context, &e->mesh, others);
    if (status != CSCD_OK) return status;
    const near_terms near = {.items = items->items};
    energy_terms lists[2] = {{NULL}, {NULL}};
    if (items->count > 0) lists[0] = terms_of_items(&near, items->count);
    if (e->frozen_count > 0) lists[1] = terms_of_friction(e, NULL);
    status = owned_pattern_make(e->context, &e->mesh, lists, others, &e->pattern);
    if (status != CSCD_OK) return status;
    *out = (cscd_energy_pattern){e->pattern.rows, e->pattern.columns, e->pattern.rows[e->mesh.vertex_count]};
    return CSCD_OK;
}

cscd_status cscd_energy_make_pattern(cscd_energy *energy, const cscd_proximities *items,
                                     const cscd_energy_pattern *others, cscd_energy_pattern *out) {
    if (energy == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(energy, &entry)) return entry.status;
    return context_leave(&entry, make_pattern(energy, items, others, out));
}

/* ---- friction ------------------------------------------------------------------------------------------ */

static double coefficient_of(const cscd_energy *e, const cscd_energy_options *o, const cscd_proximity *items,
                             size_t i) {
    if (o->item_friction != NULL) return o->item_friction[i];
    if (o->object_friction == NULL) return o->friction;
    const cscd_proximity *p = &items[i];
    int other = p->kind == CSCD_CONTACT_EE || p->kind == CSCD_CONTACT_EV ? 2 : 1;
    double a = o->object_friction[cscd_mesh_vertex_object(&e->mesh, p->vertices[0])];
    double b = o->object_friction[cscd_mesh_vertex_object(&e->mesh, p->vertices[other])];
    return a == b ? a : sqrt(a * b);
}

static cscd_status check_object_friction(const cscd_energy *e, const cscd_energy_options *o) {
    for (uint32_t i = 0; o->object_friction != NULL && i < e->mesh.object_count; i++) {
        if (is_amount(o->object_friction[i])) continue;
        return context_fail(e->context, CSCD_INVALID_ARGUMENT,
                            "object_friction[%u] is %g, expected 0 or more", i, o->object_friction[i]);
    }
    return CSCD_OK;
}

static cscd_status check_friction(const cscd_energy *e, const cscd_energy_options *o,
                                  const cscd_proximities *items) {
    if (!is_positive_length(o->slip))
        return context_fail(e->context, CSCD_INVALID_ARGUMENT,
                            "slip is %g, expected a length from 2^-300 to 2^300", o->slip);
    if (!is_amount(o->friction))
        return context_fail(e->context, CSCD_INVALID_ARGUMENT, "friction is %g, expected 0 or more",
                            o->friction);
    for (size_t i = 0; o->item_friction != NULL && i < items->count; i++) {
        if (is_amount(o->item_friction[i])) continue;
        return context_fail(e->context, CSCD_INVALID_ARGUMENT, "item_friction[%zu] is %g, expected 0 or more",
                            i, o->item_friction[i]);
    }
    return check_object_friction(e, o);
}

/* False: the item is infinite. */
static bool freeze_item(const cscd_energy *e, const near_terms *near, size_t i, friction_term *out) {
    const cscd_proximity *item = &near->items[i];
    pair_frame frame;
    double force = energy_pair_force(&near->options, item, near->x, &frame);
    memset(out, 0, sizeof *out);
    out->kind = item->kind;
    out->force = force * coefficient_of(e, &near->options, near->items, i);
    memcpy(out->vertices, item->vertices, sizeof out->vertices);
    memcpy(out->weights, frame.weights, sizeof out->weights);
    memcpy(out->tangents, frame.tangents, sizeof out->tangents);
    return force < INFINITY;
}

static cscd_status reserve_frozen(cscd_energy *e, size_t count) {
    if (count <= e->frozen_capacity && e->frozen != NULL) return CSCD_OK;
    size_t room = room_with_spare(count);
    friction_term *frozen = context_grow(e->context, e->frozen, e->frozen_count, room, sizeof *frozen);
    if (frozen == NULL) return context_out_of_memory(e->context);
    e->frozen = frozen;
    e->frozen_capacity = room;
    return CSCD_OK;
}

static cscd_status check_finite(cscd_energy *e, const near_terms *near, size_t count) {
    friction_term unused;
    for (size_t i = 0; i < count; i++) {
        if (freeze_item(e, near, i, &unused)) continue;
        return context_fail(e->context, CSCD_INVALID_ARGUMENT,
                            "item %zu is at most its separation apart, so its normal force is infinite", i);
    }
    return CSCD_OK;
}

static cscd_status freeze_friction(cscd_energy *e, const cscd_proximities *items, const cscd_view *positions,
                                   const cscd_energy_options *options) {
    near_terms near;
    cscd_status status = take_options(e->context, options, &near.options);
    if (status == CSCD_OK) status = check_items(e, items);
    if (status == CSCD_OK) status = check_friction(e, &near.options, items);
    if (status == CSCD_OK) status = read_positions(e, positions, "positions", 0, &near.x);
    near.items = status == CSCD_OK ? items->items : NULL;
    if (status == CSCD_OK) status = check_finite(e, &near, items->count);
    if (status == CSCD_OK) status = reserve_frozen(e, items->count);
    if (status != CSCD_OK) return status;
    for (size_t i = 0; i < items->count; i++) freeze_item(e, &near, i, &e->frozen[i]);
    e->frozen_count = items->count;
    e->slip = near.options.slip;
    return CSCD_OK;
}

cscd_status cscd_energy_freeze_friction(cscd_energy *energy, const cscd_proximities *items,
                                        const cscd_view *positions, const cscd_energy_options *options) {
    if (energy == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(energy, &entry)) return entry.status;
    return context_leave(&entry, freeze_friction(energy, items, positions, options));
}

static cscd_status evaluate_friction(cscd_energy *e, const cscd_view *x0, const cscd_view *x1,
                                     const cscd_energy_targets *targets, cscd_energy_sum *out) {
    friction_motion motion = {.terms = e->frozen, .slip = e->slip};
    if (out == NULL)
        return context_fail(e->context, CSCD_INVALID_ARGUMENT, "cscd_energy_evaluate_friction: out is NULL");
    cscd_status status = read_positions(e, x0, "x0", 0, &motion.x0);
    if (status == CSCD_OK) status = read_positions(e, x1, "x1", 1, &motion.x1);
    if (status == CSCD_OK && targets != NULL) status = energy_targets_check(e->context, &e->mesh, targets);
    if (status != CSCD_OK) return status;
    energy_terms terms = e->frozen_count > 0 ? terms_of_friction(e, &motion) : (energy_terms){NULL};
    return energy_sum_terms(e->context, &e->mesh, &terms, targets, &e->memory, out);
}

cscd_status cscd_energy_evaluate_friction(cscd_energy *energy, const cscd_view *x0, const cscd_view *x1,
                                          const cscd_energy_targets *targets, cscd_energy_sum *out) {
    if (energy == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(energy, &entry)) return entry.status;
    return context_leave(&entry, evaluate_friction(energy, x0, x1, targets, out));
}
