/* Marks on the mesh, by which events find each other: the edges at each vertex, where vertices that seams unite are one, and who has
 * been at a vertex or triangle, with which pair of parts, and when. */
#include "runtime/events/events.h"
#include "src/core/sort.h"

#include <assert.h>
#include <string.h>

/* ---- what is near ------------------------------------------------------------------------------------------ */

static array_list ring_arrays(const cscd_mesh *mesh, mesh_rings *r) {
    return (array_list){{ARRAY(r->names, mesh->vertex_count),
                         ARRAY(r->offsets, (size_t)mesh->vertex_count + 1),
                         ARRAY(r->neighbours, (size_t)mesh->edge_count * 2)}};
}

static void name_vertices(const cscd_mesh *mesh, const uint32_t *seams, size_t seam_count, uint32_t *names) {
    sets_begin(names, mesh->vertex_count);
    for (size_t i = 0; i < seam_count; i++) set_unite(names, seams[2 * i], seams[2 * i + 1]);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) names[v] = set_root(names, v);
}

/* Counts in offsets[name + 1], adds up, and fills in, which moves each offset to the beginning of the next one. */
static void list_neighbours(const cscd_mesh *mesh, mesh_rings *r) {
    size_t *next = r->offsets + 1, sum = 0;
    for (uint32_t v = 0; v <= mesh->vertex_count; v++) r->offsets[v] = 0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        for (int k = 0; k < 2; k++) next[r->names[mesh->edges[e][k]]]++;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        size_t count = next[v];
        next[v] = sum;
        sum += count;
    }
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        for (int k = 0; k < 2; k++)
            r->neighbours[next[r->names[mesh->edges[e][k]]]++] = r->names[mesh->edges[e][1 - k]];
    }
}

cscd_status mesh_rings_create(const cscd_mesh *mesh, uint32_t rings, const uint32_t *seams, size_t seam_count,
                              mesh_rings *out) {
    mesh_rings r = {.same = rings == 0};
    if (!r.same) {
        r.radius = (rings - 1) / 2;
        r.odd = (rings - 1) % 2 == 1;
        if (!context_reserve_all(mesh->context, ring_arrays(mesh, &r))) return CSCD_OUT_OF_MEMORY;
        name_vertices(mesh, seams, seam_count, r.names);
        list_neighbours(mesh, &r);
    }
    *out = r;
    return CSCD_OK;
}

void mesh_rings_free(cscd_context *context, mesh_rings *r) {
    context_free(context, r->names);
    context_free(context, r->offsets);
    context_free(context, r->neighbours);
    *r = (mesh_rings){.names = NULL};
}

/* ---- stamps ------------------------------------------------------------------------------------------------ */

static array_list table_arrays(stamp_table *t) {
    return (array_list){{ARRAY(t->stamps, t->capacity), ARRAY(t->places, (size_t)t->place_mask + 1)}};
}

/* The multiplier of Fibonacci hashing, twice: the upper bits depend on all of parts and element. */
static uint32_t hash_of(uint64_t parts, uint32_t element) {
    const uint64_t golden = 0x9e3779b97f4a7c15u;
    uint64_t mixed = (parts * golden ^ element) * golden;
    return (uint32_t)(mixed >> 32);
}

static void place_stamp(stamp_table *t, size_t number) {
    const stamp *s = &t->stamps[number];
    uint32_t place = hash_of(s->parts, s->element) & t->place_mask;
    while (t->places[place] != 0) place = (place + 1) & t->place_mask;
    t->places[place] = (uint32_t)number + 1;
}

static void place_all(stamp_table *t) {
    for (size_t i = 0; i < t->count; i++) place_stamp(t, i);
}

bool stamp_table_reserve(cscd_context *context, stamp_table *t, size_t more) {
    if (more <= t->capacity - t->count) return true;
    stamp_table grown = {.count = t->count};
    const size_t needed = t->count + more, wanted = 2 * needed + 16;
    if (needed > UINT32_MAX / 4 - 8) return false;
    uint64_t places = 64; /* up to 2^32 */
    while (places < 2 * (uint64_t)wanted) places *= 2;
    grown.capacity = wanted;
    grown.place_mask = (uint32_t)(places - 1);
    if (!context_allocate_all(context, table_arrays(&grown))) return false;
    if (t->count > 0) memcpy(grown.stamps, t->stamps, t->count * sizeof *t->stamps);
    place_all(&grown);
    stamp_table_free(context, t);
    *t = grown;
    return true;
}

void stamp_table_free(cscd_context *context, stamp_table *t) {
    context_free(context, t->stamps);
    context_free(context, t->places);
    *t = (stamp_table){.stamps = NULL};
}

stamp *stamp_table_find(const stamp_table *t, uint64_t parts, uint32_t element) {
    if (t->count == 0) return NULL;
    uint32_t place = hash_of(parts, element) & t->place_mask;
    for (; t->places[place] != 0; place = (place + 1) & t->place_mask) {
        stamp *s = &t->stamps[t->places[place] - 1];
        if (s->element == element && s->parts == parts) return s;
    }
    return NULL;
}

void stamp_table_add(stamp_table *t, stamp added) {
    assert(t->count < t->capacity);
    t->stamps[t->count] = added;
    place_stamp(t, t->count++);
}

void stamp_table_clear(stamp_table *t) {
    stamp_table_shrink(t, 0);
}

void stamp_table_shrink(stamp_table *t, size_t count) {
    if (t->count == 0) return;
    t->count = count;
    memset(t->places, 0, ((size_t)t->place_mask + 1) * sizeof *t->places);
    place_all(t);
}
