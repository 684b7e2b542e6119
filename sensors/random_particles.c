/* The older method: a fixed number of particles on every object, from random vertices (Senin et al. 2003). */
#include "sensors/random_particles.h"

#include "sensors/cell_particles.h"

/* Lists vertices by object, in the order of their parts. */
static void list_objects(const sensor_partition *partition, random_particles *r) {
    for (uint32_t p = 0; p < partition->part_count; p++) {
        uint32_t count = partition->part_vertex_offsets[p + 1] - partition->part_vertex_offsets[p];
        r->object_offsets[partition->parts[p].object + 1] += count;
    }
    for (uint32_t o = 0; o < r->object_count; o++) r->object_offsets[o + 1] += r->object_offsets[o];
    for (uint32_t p = partition->part_count; p-- > 0;) { /* fills from the end: ends go down to beginnings, */
        uint32_t *end = &r->object_offsets[partition->parts[p].object + 1];
        uint32_t i = partition->part_vertex_offsets[p + 1];
        while (i > partition->part_vertex_offsets[p])
            r->object_vertices[--*end] = partition->part_vertices[--i];
    }
    uint32_t total = partition->part_vertex_offsets[partition->part_count];
    for (uint32_t o = 0; o < r->object_count; o++) r->object_offsets[o] = r->object_offsets[o + 1];
    r->object_offsets[r->object_count] = total; /* which are in their places now */
}

/* Edges are sorted, so neighbours come in order. */
static void list_neighbours(const cscd_mesh *mesh, random_particles *r) {
    uint32_t *offsets = r->neighbour_offsets;
    for (uint32_t e = 0; e < mesh->edge_count; e++)
        for (int k = 0; k < 2; k++) offsets[mesh->edges[e][k] + 1]++;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) offsets[v + 1] += offsets[v];
    for (uint32_t e = mesh->edge_count; e-- > 0;)
        for (int k = 1; k >= 0; k--) r->neighbours[--offsets[mesh->edges[e][k] + 1]] = mesh->edges[e][1 - k];
    for (uint32_t v = 0; v < mesh->vertex_count; v++) offsets[v] = offsets[v + 1];
    offsets[mesh->vertex_count] = 2 * mesh->edge_count;
}

static array_list list_arrays(random_particles *r) {
    return (array_list){
        {ARRAY(r->object_offsets, (size_t)r->object_count + 1), ARRAY(r->object_vertices, r->vertex_count),
         ARRAY(r->neighbour_offsets, (size_t)r->vertex_count + 1), ARRAY(r->neighbours, r->neighbour_count)}};
}

cscd_status random_particles_create(const sensor_partition *partition, random_particles *out) {
    const cscd_mesh *mesh = partition->mesh;
    out->object_count = partition->object_count;
    out->neighbour_count = (size_t)mesh->edge_count * 2;
    out->vertex_count = mesh->vertex_count;
    if (!context_allocate_all(partition->context, list_arrays(out))) return CSCD_OUT_OF_MEMORY;
    list_objects(partition, out);
    list_neighbours(mesh, out);
    return CSCD_OK;
}

void random_particles_free(cscd_context *context, random_particles *r) {
    context_free_all(context, list_arrays(r));
}

/* A number below count, from SplitMix64 (Steele et al. 2014). */
static uint32_t draw_below(uint64_t *state, uint32_t count) {
    uint64_t z = *state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return (uint32_t)((((z ^ z >> 31) >> 32) * count) >> 32);
}

static uint32_t particles_of(const random_particles *r, uint32_t object, uint32_t per_object) {
    uint32_t count = r->object_offsets[object + 1] - r->object_offsets[object];
    return per_object < count ? per_object : count;
}

cscd_status random_particles_place(const random_particles *r, const sensor_partition *partition,
                                   uint32_t per_object, uint32_t seed, particles *p) {
    uint32_t count = 0;
    for (uint32_t o = 0; o < r->object_count; o++) count += particles_of(r, o, per_object);
    cscd_status status = particles_reserve(p, count);
    if (status != CSCD_OK) return status;
    uint64_t state = seed;
    for (uint32_t o = 0; o < r->object_count; o++) {
        uint32_t *vertices = r->object_vertices + r->object_offsets[o];
        uint32_t left = r->object_offsets[o + 1] - r->object_offsets[o];
        for (uint32_t i = particles_of(r, o, per_object); i-- > 0;) {
            uint32_t k = draw_below(&state, left--), drawn = vertices[k];
            vertices[k] = vertices[left];
            vertices[left] = drawn; /* behind those that can still be drawn */
            p->vertices[p->count] = drawn;
            p->objects[p->count] = o;
            p->groups[p->count++] = particle_group(partition, partition->vertex_parts[drawn], false);
        }
    }
    return CSCD_OK;
}
