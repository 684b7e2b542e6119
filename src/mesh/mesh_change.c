/* The change of a mesh, of the public API: checks what is to happen, builds what is new, and joins it with the rest. */
#include "src/mesh/mesh_change.h"

#include "src/core/least_sizes.h"

#include <string.h>

/* What is known of a change on its way. */
typedef struct change_plan {
    cscd_context *context;
    const cscd_mesh *old;
    const cscd_object_change *changes; /* of this library's size */
    cscd_object_desc *
        descs; /* of this library's size: those of objects that are not removed, in the order of the new mesh */
    uint32_t change_count, desc_count, object_count;
    uint32_t *change_of;    /* per old object: its change, UINT32_MAX: none */
    uint32_t *numbers;      /* per description: its object in the new mesh */
    object_origin *origins; /* per object of the new mesh */
    object_move *moves;
    object_range *old_ranges, *built_ranges;
    cscd_mesh *built; /* the described objects alone; NULL: there are none */
} change_plan;

static array_list plan_arrays(change_plan *p) {
    size_t objects = (size_t)p->old->object_count + p->change_count;
    return (array_list){{ARRAY(p->descs, p->change_count), ARRAY(p->change_of, p->old->object_count),
                         ARRAY(p->numbers, p->change_count), ARRAY(p->origins, objects),
                         ARRAY(p->moves, objects), ARRAY(p->old_ranges, p->old->object_count),
                         ARRAY(p->built_ranges, p->change_count)}};
}

/* ---- what the caller says -------------------------------------------------------------------------------- */

static cscd_status check_change(change_plan *p, uint32_t index) {
    const cscd_object_change *change = &p->changes[index];
    bool is_new = change->object == UINT32_MAX;
    if (change->reserved != 0)
        return context_fail(p->context, CSCD_INVALID_ARGUMENT, "change %u has %u in reserved, expected 0",
                            index, change->reserved);
    if (!is_new && change->object >= p->old->object_count)
        return context_fail(p->context, CSCD_INVALID_ARGUMENT,
                            "change %u names object %u, but there are %u; a new object is UINT32_MAX", index,
                            change->object, p->old->object_count);
    if (!is_new && p->change_of[change->object] != UINT32_MAX)
        return context_fail(p->context, CSCD_INVALID_ARGUMENT,
                            "change %u names object %u, as change %u does; put both into one", index,
                            change->object, p->change_of[change->object]);
    if (is_new && change->desc == NULL)
        return context_fail(p->context, CSCD_INVALID_ARGUMENT,
                            "change %u is a new object without a desc, expected what it is", index);
    bool origins = change->vertex_origins != NULL || change->triangle_origins != NULL;
    if (origins && (is_new || change->desc == NULL))
        return context_fail(p->context, CSCD_INVALID_ARGUMENT,
                            "change %u has origins, but its object is %s; leave them NULL", index,
                            is_new ? "new" : "removed");
    if (!is_new) p->change_of[change->object] = index;
    return CSCD_OK;
}

static cscd_status check_origins(const change_plan *p, uint32_t index, const uint32_t *origins,
                                 uint32_t count, uint32_t limit, const char *of, const char *several) {
    for (uint32_t i = 0; origins != NULL && i < count; i++) {
        if (origins[i] >= limit && origins[i] != UINT32_MAX)
            return context_fail(p->context, CSCD_INVALID_ARGUMENT,
                                "change %u says that %s %u was %s %u, but the old object has %u %s", index,
                                of, i, of, origins[i], limit, several);
    }
    return CSCD_OK;
}

static cscd_status check_all_origins(const change_plan *p, uint32_t index, const cscd_object_desc *desc) {
    const cscd_object_change *change = &p->changes[index];
    if (change->object == UINT32_MAX) return CSCD_OK;
    const cscd_object *before = &p->old->objects[change->object];
    cscd_status status = check_origins(p, index, change->vertex_origins, desc->vertex_count,
                                       before->vertex_count, "vertex", "vertices");
    if (status != CSCD_OK) return status;
    return check_origins(p, index, change->triangle_origins, desc->triangle_count, before->triangle_count,
                         "triangle", "triangles");
}

/* ---- the objects of the new mesh ---------------------------------------------------------------------- */

static cscd_status describe_object(change_plan *p, uint32_t index, size_t object_size) {
    const cscd_object_change *change = &p->changes[index];
    cscd_object_desc *desc = &p->descs[p->desc_count];
    cscd_status status = mesh_take_objects(p->context, change->desc, object_size, 1, desc);
    if (status == CSCD_OK) status = check_all_origins(p, index, desc);
    p->numbers[p->desc_count++] = p->object_count;
    p->origins[p->object_count++] = (object_origin){.old_object = change->object,
                                                    .changed = true,
                                                    .vertex_origins = change->vertex_origins,
                                                    .triangle_origins = change->triangle_origins};
    return status;
}

static cscd_status list_objects(change_plan *p, size_t object_size) {
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; i < p->old->object_count && status == CSCD_OK; i++) {
        uint32_t index = p->change_of[i];
        if (index == UINT32_MAX)
            p->origins[p->object_count++] = (object_origin){.old_object = i};
        else if (p->changes[index].desc != NULL)
            status = describe_object(p, index, object_size);
    }
    for (uint32_t i = 0; i < p->change_count && status == CSCD_OK; i++) {
        if (p->changes[i].object == UINT32_MAX) status = describe_object(p, i, object_size);
    }
    if (status == CSCD_OK && p->object_count == 0)
        return context_fail(p->context, CSCD_INVALID_MESH,
                            "every object is removed, and no new one comes: no mesh is left");
    return status;
}

static cscd_status check_descriptions(const change_plan *p) {
    described_objects described = {
        .descs = p->descs, .count = p->desc_count, .numbers = p->numbers, .total = p->object_count};
    for (uint32_t i = 0; i < p->object_count; i++) {
        if (p->origins[i].changed) continue;
        const cscd_object *other = &p->old->objects[p->origins[i].old_object];
        described.other_vertices += other->vertex_count;
        described.other_triangles += other->triangle_count;
        if (other->kind == CSCD_OBJECT_WIRES) described.other_loose.wires += other->edge_count;
        if (other->kind == CSCD_OBJECT_POINTS) described.other_loose.points += other->vertex_count;
    }
    return mesh_check_objects(p->context, &described);
}

static cscd_status read_changes(change_plan *p, size_t object_size) {
    memset(p->change_of, 0xff, p->old->object_count * sizeof *p->change_of);
    for (uint32_t i = 0; i < p->change_count; i++) {
        cscd_status status = check_change(p, i);
        if (status != CSCD_OK) return status;
    }
    cscd_status status = list_objects(p, object_size);
    return status == CSCD_OK ? check_descriptions(p) : status;
}

/* ---- the new mesh ---------------------------------------------------------------------------------------- */

static bool build_described(change_plan *p) {
    if (p->desc_count == 0) return true;
    p->built = mesh_begin(p->context);
    if (p->built == NULL || mesh_build_objects(p->built, p->descs, p->desc_count) != CSCD_OK) return false;
    mesh_find_ranges(p->built, p->built_ranges);
    return true;
}

static void choose_sources(change_plan *p) {
    uint32_t described = 0;
    mesh_find_ranges(p->old, p->old_ranges);
    for (uint32_t i = 0; i < p->object_count; i++) {
        bool changed = p->origins[i].changed;
        uint32_t object = changed ? described++ : p->origins[i].old_object;
        p->moves[i].source = (object_source){changed ? p->built : p->old, object};
        p->moves[i].from = changed ? p->built_ranges[object] : p->old_ranges[object];
    }
}

/* When every object has changed, what was built is the new mesh. */
static cscd_mesh *join_all(change_plan *p) {
    if (!build_described(p)) return NULL;
    choose_sources(p);
    if (p->desc_count == p->object_count) {
        cscd_mesh *mesh = p->built;
        p->built = NULL;
        for (uint32_t i = 0; i < p->object_count; i++) p->moves[i].to = p->moves[i].from;
        return mesh;
    }
    cscd_mesh *mesh = mesh_begin(p->context);
    if (mesh == NULL || mesh_splice(mesh, p->moves, p->object_count) == CSCD_OK) return mesh;
    cscd_mesh_destroy(mesh);
    return NULL;
}

/* ---- the change itself ----------------------------------------------------------------------------------- */

static array_list map_arrays(cscd_mesh_change *c) {
    return (array_list){
        {ARRAY(c->vertices.to_new, c->vertices.old_count), ARRAY(c->vertices.to_old, c->vertices.new_count),
         ARRAY(c->edges.to_new, c->edges.old_count), ARRAY(c->edges.to_old, c->edges.new_count),
         ARRAY(c->triangles.to_new, c->triangles.old_count),
         ARRAY(c->triangles.to_old, c->triangles.new_count), ARRAY(c->objects.to_new, c->objects.old_count),
         ARRAY(c->objects.to_old, c->objects.new_count), ARRAY(c->components.to_new, c->components.old_count),
         ARRAY(c->components.to_old, c->components.new_count), ARRAY(c->runs, c->objects.new_count),
         ARRAY(c->described, c->objects.new_count), ARRAY(c->vertices.runs, c->objects.new_count),
         ARRAY(c->edges.runs, c->objects.new_count), ARRAY(c->triangles.runs, c->objects.new_count)}};
}

static void count_features(cscd_mesh_change *c) {
    const cscd_mesh *old = c->old_mesh, *now = c->mesh;
    c->vertices = (number_map){.old_count = old->vertex_count, .new_count = now->vertex_count};
    c->edges = (number_map){.old_count = old->edge_count, .new_count = now->edge_count};
    c->triangles = (number_map){.old_count = old->triangle_count, .new_count = now->triangle_count};
    c->objects = (number_map){.old_count = old->object_count, .new_count = now->object_count};
    c->components = (number_map){.old_count = old->component_count, .new_count = now->component_count};
}

static void free_change(reference_count *references) {
    cscd_mesh_change *change = (cscd_mesh_change *)references;
    cscd_context *context = change->context;
    const cscd_mesh *old = change->old_mesh, *mesh = change->mesh;
    pthread_mutex_destroy(&change->lock);
    context_free_all(context, map_arrays(change));
    context_free(context, change);
    mesh_release(mesh);
    mesh_release(old);
    context_release(context);
}

/* Maps and the lock. */
static bool reserve_maps(cscd_mesh_change *change) {
    if (!context_reserve_all(change->context, map_arrays(change))) return false;
    if (pthread_mutex_init(&change->lock, NULL) == 0) return true;
    context_free_all(change->context, map_arrays(change));
    return false;
}

/* The change holds the mesh in place of the caller. */
static cscd_status begin_change(change_plan *p, cscd_mesh *mesh, cscd_mesh_change **out) {
    cscd_mesh_change *change = context_allocate(p->context, 1, sizeof *change);
    if (change == NULL) return CSCD_OUT_OF_MEMORY;
    change->context = p->context;
    change->old_mesh = p->old;
    change->mesh = mesh;
    count_features(change);
    if (!reserve_maps(change)) {
        context_free(p->context, change);
        return CSCD_OUT_OF_MEMORY;
    }
    mesh_hold(p->old);
    mesh_hold(mesh);
    context_add_object(p->context, &change->references, free_change);
    mesh_list(mesh);
    mesh_change_map(change, p->old_ranges, p->moves, p->origins);
    *out = change;
    return CSCD_OK;
}

static cscd_status make_change(change_plan *p, cscd_mesh_change **out) {
    cscd_mesh *mesh = join_all(p);
    cscd_status status = mesh != NULL ? begin_change(p, mesh, out) : CSCD_OUT_OF_MEMORY;
    cscd_mesh_destroy(mesh);
    cscd_mesh_destroy(p->built);
    return status == CSCD_OK ? CSCD_OK : context_out_of_memory(p->context);
}

static cscd_status take_changes(change_plan *p, const cscd_object_change *changes, size_t change_size,
                                cscd_object_change *out) {
    const char *bytes = (const char *)changes;
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; i < p->change_count && status == CSCD_OK; i++)
        status = struct_take(p->context, &out[i], sizeof *out, LEAST_SIZE(cscd_object_change),
                             bytes + i * change_size, change_size, "cscd_object_change");
    p->changes = out;
    return status;
}

static cscd_status change_by_list(cscd_context *context, const cscd_mesh *old,
                                  const cscd_object_change *changes, size_t change_size, size_t object_size,
                                  uint32_t count, cscd_mesh_change **out) {
    if (out == NULL || (changes == NULL && count > 0))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_mesh_change_create: %s is NULL",
                            out == NULL ? "out" : "changes");
    change_plan p = {.context = context, .old = old, .change_count = count};
    cscd_object_change *taken = context_allocate(context, count, sizeof *taken);
    if (taken == NULL) return context_out_of_memory(context);
    cscd_status status = take_changes(&p, changes, change_size, taken);
    if (status == CSCD_OK && !context_allocate_all(context, plan_arrays(&p)))
        status = context_out_of_memory(context);
    if (status == CSCD_OK) status = read_changes(&p, object_size);
    if (status == CSCD_OK) status = make_change(&p, out);
    context_free_all(context, plan_arrays(&p));
    context_free(context, taken);
    return status;
}

cscd_status cscd_mesh_change_create_sized(cscd_context *context, const cscd_mesh *old,
                                          const cscd_object_change *changes, size_t change_size,
                                          size_t object_size, uint32_t change_count, cscd_mesh_change **out) {
    if (context == NULL || old == NULL) return context_lacks(context, "cscd_mesh_change_create", "old");
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, change_by_list(context, mesh_of_creator(old), changes, change_size,
                                                object_size, change_count, out));
}

void cscd_mesh_change_destroy(cscd_mesh_change *change) {
    if (change != NULL) context_destroy_object(change->context, &change->references);
}

/* ---- what it says ------------------------------------------------------------------------------------------ */

const cscd_mesh *cscd_mesh_change_mesh(const cscd_mesh_change *change) {
    return change->mesh;
}

static const number_map *map_of(const cscd_mesh_change *change, cscd_element what) {
    const number_map *map = what == CSCD_VERTICES    ? &change->vertices
                            : what == CSCD_EDGES     ? &change->edges
                            : what == CSCD_TRIANGLES ? &change->triangles
                            : what == CSCD_OBJECTS   ? &change->objects
                                                     : &change->components;
    mesh_change_make_whole(change, map);
    return map;
}

const uint32_t *cscd_mesh_change_to_new(const cscd_mesh_change *change, cscd_element what,
                                        uint32_t *old_count) {
    const number_map *map = map_of(change, what);
    if (old_count != NULL) *old_count = map->old_count;
    return map->to_new;
}

const uint32_t *cscd_mesh_change_to_old(const cscd_mesh_change *change, cscd_element what,
                                        uint32_t *new_count) {
    const number_map *map = map_of(change, what);
    if (new_count != NULL) *new_count = map->new_count;
    return map->to_old;
}
