/* Objects of a mesh that are not of triangles: wires, points and half-spaces. */
#include "src/core/floating.h"
#include "src/core/sort.h"
#include "src/mesh/mesh.h"

#include <math.h>
#include <string.h>

/* A point has no data behind it that would show that its count is meant; this many cost a quarter of a second. */
enum { POINTS_MAX = 1 << 26, VERTICES_OF_WIRE = 256 };

/* ---- descriptions -------------------------------------------------------------------------------------- */

static cscd_status check_wire(cscd_context *context, const cscd_object_desc *desc, uint32_t wire,
                              const char *object) {
    const uint32_t *v = desc->wires + (size_t)wire * 2;
    for (int i = 0; i < 2; i++) {
        if (v[i] >= desc->vertex_count)
            return context_fail(context, CSCD_INVALID_MESH,
                                "%swire %u names vertex %u, but there are %u vertices", object, wire, v[i],
                                desc->vertex_count);
    }
    if (v[0] == v[1])
        return context_fail(
            context, CSCD_INVALID_MESH,
            "%swire %u (%u %u) joins a vertex with itself; remove it, or make the vertex a point", object,
            wire, v[0], v[1]);
    return CSCD_OK;
}

static cscd_status check_wires(cscd_context *context, const cscd_object_desc *desc, const char *object) {
    if (desc->wire_count == 0)
        return context_fail(context, CSCD_INVALID_MESH, "%sthe mesh is empty: %u vertices, 0 wires", object,
                            desc->vertex_count);
    if (desc->wires == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%swires is NULL, but there are to be %u", object,
                            desc->wire_count);
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; i < desc->wire_count && status == CSCD_OK; i++)
        status = check_wire(context, desc, i, object);
    return status;
}

static bool has_normal(const cscd_object_desc *desc) {
    return desc->normal[0] != 0.0 || desc->normal[1] != 0.0 || desc->normal[2] != 0.0;
}

static cscd_status check_half_space(cscd_context *context, const cscd_object_desc *desc, const char *object) {
    const double *n = desc->normal;
    if (desc->vertex_count != 1)
        return context_fail(context, CSCD_INVALID_MESH,
                            "%sa half-space has %u vertices, expected 1: a point of its plane", object,
                            desc->vertex_count);
    for (int k = 0; k < 3; k++) {
        if (!is_length(fabs(n[k])))
            return context_fail(
                context, CSCD_INVALID_MESH,
                "%sa half-space has a normal with %c = %g, expected 0 or a magnitude from 2^-300 "
                "to 2^300",
                object, "xyz"[k], n[k]);
    }
    if (!has_normal(desc))
        return context_fail(context, CSCD_INVALID_MESH,
                            "%sa half-space has the normal 0, expected one out of it", object);
    return CSCD_OK;
}

/* Members that belong to another kind of object. */
static cscd_status check_members(cscd_context *context, const cscd_object_desc *desc, const char *object) {
    if (desc->kind != CSCD_OBJECT_WIRES && (desc->wire_count > 0 || desc->wires != NULL))
        return context_fail(context, CSCD_INVALID_MESH,
                            "%san object that is not of wires has wires; make them an object of their own",
                            object);
    if (desc->kind != CSCD_OBJECT_HALF_SPACE && has_normal(desc))
        return context_fail(context, CSCD_INVALID_MESH,
                            "%san object that is no half-space has a normal; leave it at 0", object);
    if (desc->kind != CSCD_OBJECT_TRIANGLES && (desc->triangle_count > 0 || desc->triangles != NULL))
        return context_fail(
            context, CSCD_INVALID_MESH,
            "%san object that is not of triangles has triangles; make them an object of their own", object);
    return CSCD_OK;
}

cscd_status loose_desc_check(cscd_context *context, const cscd_object_desc *desc, const char *object) {
    if ((unsigned)desc->kind > CSCD_OBJECT_HALF_SPACE)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%sunknown kind %d", object, (int)desc->kind);
    cscd_status status = check_members(context, desc, object);
    if (status != CSCD_OK || desc->kind == CSCD_OBJECT_TRIANGLES) return status;
    if (desc->vertex_count == 0)
        return context_fail(context, CSCD_INVALID_MESH, "%sthe mesh is empty: 0 vertices", object);
    if (desc->kind == CSCD_OBJECT_WIRES) return check_wires(context, desc, object);
    return desc->kind == CSCD_OBJECT_HALF_SPACE ? check_half_space(context, desc, object) : CSCD_OK;
}

void loose_totals_add(loose_totals *totals, const cscd_object_desc *desc) {
    if (desc->kind == CSCD_OBJECT_WIRES) totals->wires += desc->wire_count;
    if (desc->kind == CSCD_OBJECT_POINTS) totals->points += desc->vertex_count;
}

uint64_t loose_totals_vertices(const loose_totals *totals) {
    return totals->points + totals->wires * VERTICES_OF_WIRE;
}

/* So the number of an edge fits in 32 bits, and with it the number of an element. */
cscd_status loose_totals_check(cscd_context *context, const loose_totals *totals, uint64_t triangles) {
    if (totals->points > POINTS_MAX)
        return context_fail(context, CSCD_INVALID_MESH, "%llu points are too many: the ceiling is 2^26",
                            (unsigned long long)totals->points);
    uint64_t edges = 3 * triangles + totals->wires + totals->points;
    if (edges > UINT32_MAX)
        return context_fail(context, CSCD_INVALID_MESH,
                            "%llu sides of triangles, wires and points are too many: the ceiling is 2^32 - 1",
                            (unsigned long long)edges);
    return CSCD_OK;
}

/* ---- edges --------------------------------------------------------------------------------------------- */

/* The edges of all objects, while wires are put among those of triangles. */
typedef struct edge_merge {
    cscd_mesh *mesh;
    uint32_t (*edges)[2];
    uint32_t *star_offsets;
    uint64_t *keys, *spare; /* of one object's wires */
    uint32_t from, to;      /* so many edges of triangles have been taken, so many of all have been put */
} edge_merge;

static void put_edge(edge_merge *m, uint32_t a, uint32_t b, uint32_t star_begin) {
    m->edges[m->to][0] = a;
    m->edges[m->to][1] = b;
    m->star_offsets[m->to++] = star_begin;
}

/* Edges are sorted by their smaller vertices, and objects follow each other. */
static void take_triangle_edges(edge_merge *m, const cscd_object *object) {
    const cscd_mesh *mesh = m->mesh;
    uint32_t shift = m->to - m->from, end = object->first_vertex + object->vertex_count;
    for (; m->from < mesh->edge_count && mesh->edges[m->from][0] < end; m->from++)
        put_edge(m, mesh->edges[m->from][0], mesh->edges[m->from][1], mesh->edge_star_offsets[m->from]);
    for (uint32_t t = object->first_triangle; t < object->first_triangle + object->triangle_count; t++) {
        for (int i = 0; i < 3; i++) m->mesh->triangle_edges[t][i] += shift;
    }
}

static void take_wires(edge_merge *m, const cscd_object_desc *desc, uint32_t first_vertex) {
    uint32_t star_begin = m->mesh->edge_star_offsets[m->from];
    for (uint32_t i = 0; i < desc->wire_count; i++) {
        uint64_t a = first_vertex + desc->wires[2 * (size_t)i],
                 b = first_vertex + desc->wires[2 * (size_t)i + 1];
        m->keys[i] = a < b ? a << 32 | b : b << 32 | a;
    }
    sort_by_number(m->keys, m->spare, desc->wire_count, sizeof *m->keys);
    for (uint32_t i = 0; i < desc->wire_count; i++) {
        if (i > 0 && m->keys[i] == m->keys[i - 1]) continue;
        put_edge(m, (uint32_t)(m->keys[i] >> 32), (uint32_t)m->keys[i], star_begin);
    }
}

static void merge_edges(edge_merge *m, const cscd_object_desc *objects) {
    cscd_mesh *mesh = m->mesh;
    uint32_t star_end = mesh->edge_star_offsets[mesh->edge_count];
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        if (objects[i].kind == CSCD_OBJECT_TRIANGLES) take_triangle_edges(m, &mesh->objects[i]);
        if (objects[i].kind == CSCD_OBJECT_WIRES) take_wires(m, &objects[i], mesh->objects[i].first_vertex);
    }
    m->star_offsets[m->to] = star_end;
}

cscd_status mesh_add_wires(cscd_mesh *mesh, const cscd_object_desc *objects) {
    cscd_context *context = mesh->context;
    edge_merge m = {.mesh = mesh};
    loose_totals totals = {0};
    size_t most = 0;
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        loose_totals_add(&totals, &objects[i]);
        if (objects[i].wire_count > most) most = objects[i].wire_count;
    }
    if (totals.wires + totals.points == 0) return CSCD_OK;
    size_t edges = (size_t)(mesh->edge_count + totals.wires);
    array_list kept = {{ARRAY(m.edges, edges + (size_t)totals.points), ARRAY(m.star_offsets, edges + 1)}};
    array_list scratch = {{ARRAY(m.keys, most), ARRAY(m.spare, most)}};
    if (!context_allocate_all(context, kept)) return CSCD_OUT_OF_MEMORY;
    if (!context_allocate_all(context, scratch)) {
        context_free_all(context, kept);
        return CSCD_OUT_OF_MEMORY;
    }
    merge_edges(&m, objects);
    context_free_all(context, scratch);
    context_free(context, mesh->edges);
    context_free(context, mesh->edge_star_offsets);
    mesh->edges = m.edges;
    mesh->edge_star_offsets = m.star_offsets;
    mesh->edge_count = m.to;
    return CSCD_OK;
}

/* ---- stars of wires ------------------------------------------------------------------------------------ */

static void list_wire_stars(cscd_mesh *mesh) {
    uint32_t *offsets = mesh->loose.wire_star_offsets, sum = 0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        for (int k = 0; k < 2 && edge_star_size(mesh, e) == 0; k++) offsets[mesh->edges[e][k]]++;
    }
    for (uint32_t v = 0; v <= mesh->vertex_count; v++) {
        uint32_t size = offsets[v];
        offsets[v] = sum;
        sum += size;
    }
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        for (int k = 0; k < 2 && edge_star_size(mesh, e) == 0; k++)
            mesh->loose.wire_stars[offsets[mesh->edges[e][k]]++] = e;
    }
    for (uint32_t v = mesh->vertex_count; v > 0; v--) offsets[v] = offsets[v - 1];
    offsets[0] = 0;
}

static cscd_status add_wire_stars(cscd_mesh *mesh) {
    loose_objects *loose = &mesh->loose;
    if (loose->wire_count == 0) return CSCD_OK;
    array_list stars = {{ARRAY(loose->wire_star_offsets, (size_t)mesh->vertex_count + 1),
                         ARRAY(loose->wire_stars, 2 * (size_t)loose->wire_count)}};
    if (!context_allocate_all(mesh->context, stars)) return CSCD_OUT_OF_MEMORY;
    list_wire_stars(mesh);
    return CSCD_OK;
}

/* ---- all of it ----------------------------------------------------------------------------------------- */

static void count_objects(cscd_mesh *mesh) {
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        const cscd_object *object = &mesh->objects[i];
        if (object->kind == CSCD_OBJECT_WIRES) mesh->loose.wire_count += object->edge_count;
        if (object->kind == CSCD_OBJECT_POINTS) mesh->loose.point_count += object->vertex_count;
        mesh->loose.half_space_count += object->kind == CSCD_OBJECT_HALF_SPACE;
    }
}

static void list_points(cscd_mesh *mesh) {
    uint32_t place = mesh->edge_count;
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        const cscd_object *object = &mesh->objects[i];
        for (uint32_t v = 0; object->kind == CSCD_OBJECT_POINTS && v < object->vertex_count; v++, place++)
            mesh->edges[place][0] = mesh->edges[place][1] = object->first_vertex + v;
    }
}

cscd_status mesh_list_loose_objects(cscd_mesh *mesh) {
    loose_objects *loose = &mesh->loose;
    count_objects(mesh);
    list_points(mesh);
    if (loose->half_space_count > 0) {
        loose->normals = context_allocate(mesh->context, mesh->object_count, sizeof *loose->normals);
        if (loose->normals == NULL) return CSCD_OUT_OF_MEMORY;
    }
    return add_wire_stars(mesh);
}

/* Points are in ascending order. */
uint32_t mesh_edge_of_point(const cscd_mesh *mesh, uint32_t vertex) {
    uint32_t low = mesh->edge_count, high = low + mesh->loose.point_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (mesh->edges[middle][0] <= vertex)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void mesh_objects_of_pair(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b,
                          uint32_t out[2]) {
    bool edge_a = kind == CSCD_CONTACT_EE || kind == CSCD_CONTACT_EV;
    uint32_t of_a = edge_a                    ? mesh->edges[a][0]
                    : kind == CSCD_CONTACT_TT ? mesh->triangles[a][0]
                                              : a,
             of_b = b;
    if (kind == CSCD_CONTACT_VF || kind == CSCD_CONTACT_TT) of_b = mesh->triangles[b][0];
    if (kind == CSCD_CONTACT_EE) of_b = mesh->edges[b][0];
    out[0] = cscd_mesh_vertex_object(mesh, of_a);
    out[1] = kind == CSCD_CONTACT_VH ? b : cscd_mesh_vertex_object(mesh, of_b);
}
