/* The change of a mesh, of the public API: checks what is to happen, builds what is new, and joins it with the rest. */
#include "src/mesh/mesh_change.h"

#include "src/core/least_sizes.h"

#include <string.h>

/* ---- a mesh of objects of others --------------------------------------------------------------------------- */

/* No component spans two objects, and those of one object are consecutive. */
static uint32_t end_of_components(const cscd_mesh *mesh, const object_range *range, uint32_t begin) {
    uint32_t next = range->triangle + range->triangle_count;
    if (range->triangle_count == 0) return begin;
    return next < mesh->triangle_count ? mesh->triangle_components[next] : mesh->component_count;
}

/* Finds the ranges of all objects of a mesh. */
static void find_ranges(const cscd_mesh *mesh, object_range *out) {
    uint32_t component = 0;
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        const cscd_object *object = &mesh->objects[i];
        out[i] = (object_range){.vertex = object->first_vertex,
                                .vertex_count = object->vertex_count,
                                .edge = object->first_edge,
                                .edge_count = object->edge_count,
                                .triangle = object->first_triangle,
                                .triangle_count = object->triangle_count,
                                .component = component};
        component = end_of_components(mesh, &out[i], component);
        out[i].component_count = component - out[i].component;
    }
}

/* ---- places ------------------------------------------------------------------------------------------- */

static void place_objects(cscd_mesh *mesh, object_move *moves, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const object_range *from = &moves[i].from;
        moves[i].to = *from;
        moves[i].to.vertex = mesh->vertex_count;
        moves[i].to.edge = mesh->edge_count;
        moves[i].to.triangle = mesh->triangle_count;
        moves[i].to.component = mesh->component_count;
        mesh->vertex_count += from->vertex_count;
        mesh->edge_count += from->edge_count;
        mesh->triangle_count += from->triangle_count;
        mesh->component_count += from->component_count;
    }
    mesh->object_count = count;
}

static bool any_obstacle(const object_move *moves, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        if (moves[i].source.mesh->objects[moves[i].source.object].obstacle) return true;
    }
    return false;
}

/* Points stand behind the edges. */
static size_t count_points(const object_move *moves, uint32_t count) {
    size_t points = 0;
    for (uint32_t i = 0; i < count; i++) {
        const cscd_object *object = &moves[i].source.mesh->objects[moves[i].source.object];
        if (object->kind == CSCD_OBJECT_POINTS) points += object->vertex_count;
    }
    return points;
}

static bool allocate_arrays(cscd_mesh *mesh, bool obstacles, size_t points) {
    size_t vertices = mesh->vertex_count, edges = mesh->edge_count, triangles = mesh->triangle_count;
    array_list list = {
        {ARRAY(mesh->triangles, triangles), ARRAY(mesh->edges, edges + points),
         ARRAY(mesh->triangle_edges, triangles), ARRAY(mesh->vertex_star_offsets, vertices + 1),
         ARRAY(mesh->vertex_stars, triangles * 3), ARRAY(mesh->edge_star_offsets, edges + 1),
         ARRAY(mesh->edge_stars, triangles * 3), ARRAY(mesh->triangle_components, triangles),
         ARRAY(mesh->components, mesh->component_count), ARRAY(mesh->objects, mesh->object_count),
         ARRAY_IF(obstacles, mesh->obstacles, mesh->component_count)}};
    return context_reserve_all(mesh->context, list);
}

/* ---- copies ------------------------------------------------------------------------------------------- */

static void copy_stars(const cscd_mesh *from, const object_move *m, cscd_mesh *to) {
    uint32_t by = m->to.triangle - m->from.triangle;
    size_t begin = (size_t)m->from.triangle * 3, end = (size_t)m->to.triangle * 3;
    size_t corners = (size_t)m->from.triangle_count * 3;
    copy_shifted(from->vertex_star_offsets + m->from.vertex, m->from.vertex_count, by * 3,
                 to->vertex_star_offsets + m->to.vertex);
    copy_shifted(from->vertex_stars + begin, corners, by, to->vertex_stars + end);
    copy_shifted(from->edge_star_offsets + m->from.edge, m->from.edge_count, by * 3,
                 to->edge_star_offsets + m->to.edge);
    copy_shifted(from->edge_stars + begin, corners, by, to->edge_stars + end);
}

static void copy_features(const cscd_mesh *from, const object_move *m, cscd_mesh *to) {
    uint32_t vertices = m->to.vertex - m->from.vertex, edges = m->to.edge - m->from.edge;
    size_t corners = (size_t)m->from.triangle_count * 3;
    copy_shifted(from->triangles[m->from.triangle], corners, vertices, to->triangles[m->to.triangle]);
    copy_shifted(from->edges[m->from.edge], (size_t)m->from.edge_count * 2, vertices, to->edges[m->to.edge]);
    copy_shifted(from->triangle_edges[m->from.triangle], corners, edges, to->triangle_edges[m->to.triangle]);
}

static void shift_feature(uint32_t *first, uint32_t by) {
    if (*first != UINT32_MAX) *first += by;
}

static void copy_components(const cscd_mesh *from, const object_move *m, cscd_mesh *to) {
    uint32_t vertices = m->to.vertex - m->from.vertex, edges = m->to.edge - m->from.edge;
    copy_shifted(from->triangle_components + m->from.triangle, m->from.triangle_count,
                 m->to.component - m->from.component, to->triangle_components + m->to.triangle);
    for (uint32_t i = 0; i < m->from.component_count; i++) {
        cscd_component *component = &to->components[m->to.component + i];
        memcpy(component, &from->components[m->from.component + i], sizeof *component);
        shift_feature(&component->first_open_edge, edges);
        shift_feature(&component->first_non_manifold_edge, edges);
        shift_feature(&component->first_inconsistent_edge, edges);
        shift_feature(&component->first_non_manifold_vertex, vertices);
        if (to->obstacles != NULL)
            to->obstacles[m->to.component + i] = component_is_obstacle(from, m->from.component + i);
    }
}

static void copy_object(const object_move *m, uint32_t index, cscd_mesh *to) {
    const cscd_mesh *from = m->source.mesh;
    cscd_object *object = &to->objects[index];
    memcpy(object, &from->objects[m->source.object], sizeof *object);
    object->first_vertex = m->to.vertex;
    object->first_edge = m->to.edge;
    object->first_triangle = m->to.triangle;
    copy_features(from, m, to);
    copy_stars(from, m, to);
    copy_components(from, m, to);
}

static void copy_normal(const object_source *source, double normal[3]) {
    const double(*normals)[3] = (const double(*)[3])source->mesh->loose.normals;
    if (normals != NULL) memcpy(normal, normals[source->object], sizeof normals[0]);
}

/* Fills an empty mesh with copies of objects of others: all arrays, with other offsets, so the mesh is what
 * mesh_build_objects makes of their descriptions. Fills in where they go to. On failure, which is OUT_OF_MEMORY without a
 * sentence, the caller destroys the mesh. */
static cscd_status splice_objects(cscd_mesh *mesh, object_move *moves, uint32_t count) {
    place_objects(mesh, moves, count);
    if (!allocate_arrays(mesh, any_obstacle(moves, count), count_points(moves, count)))
        return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < count; i++) copy_object(&moves[i], i, mesh);
    mesh->vertex_star_offsets[mesh->vertex_count] = mesh->triangle_count * 3;
    mesh->edge_star_offsets[mesh->edge_count] = mesh->triangle_count * 3;
    cscd_status status = mesh_list_loose_objects(mesh);
    for (uint32_t i = 0; status == CSCD_OK && mesh->loose.normals != NULL && i < count; i++)
        copy_normal(&moves[i].source, mesh->loose.normals[i]);
    return status;
}

/* ---- a change on its way ------------------------------------------------------------------------------------ */

typedef struct change_plan {
    cscd_context *context;
    const cscd_mesh *old;
    const cscd_object_change *changes; /* of this library's size */

    /* The descriptions, of this library's size, of the objects that are not removed, in the order of the new mesh. */
    cscd_object_desc *descs;

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
    find_ranges(p->built, p->built_ranges);
    return true;
}

static void choose_sources(change_plan *p) {
    uint32_t described = 0;
    find_ranges(p->old, p->old_ranges);
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
    if (mesh == NULL || splice_objects(mesh, p->moves, p->object_count) == CSCD_OK) return mesh;
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
