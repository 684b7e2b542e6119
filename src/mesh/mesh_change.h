/* A new mesh from an old one, and the maps between their features. */
#pragma once

#include "src/mesh/mesh.h"

#include <pthread.h>

/* Numbers of objects that have not changed: `from` and those that follow it are `to` and those that follow that. */
typedef struct number_run {
    uint32_t from, to, count;
} number_run;

/* The arrays say what has become of the numbers of objects that have changed, UINT32_MAX: there is none. Of all others
 * the runs say it, in the order of both meshes, and the arrays as soon as somebody has asked for the whole map. */
typedef struct number_map {
    uint32_t *to_new, *to_old;
    uint32_t old_count, new_count;
    number_run *runs;
    uint32_t run_count;
    bool whole;
} number_map;

/* The run that an old number is in; NULL: its object has changed. */
static inline const number_run *number_map_run(const number_map *map, uint32_t old) {
    uint32_t low = 0, high = map->run_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        const number_run *run = &map->runs[middle];
        if (old < run->from)
            high = middle;
        else if (old - run->from >= run->count)
            low = middle + 1;
        else
            return run;
    }
    return NULL;
}

/* The new number of an old one. */
static inline uint32_t number_map_to_new(const number_map *map, uint32_t old) {
    const number_run *run = number_map_run(map, old);
    return run != NULL ? run->to + (old - run->from) : map->to_new[old];
}

/* The places in the arrays of a mesh that belong to one object, or to several that follow each other. */
typedef struct object_range {
    uint32_t vertex, vertex_count, edge, edge_count, triangle, triangle_count, component, component_count;
} object_range;

/* Objects that have not changed: what stood at `from` stands at `to`, in the same order. */
typedef struct object_run {
    object_range from, to;
} object_run;

struct cscd_mesh_change {
    reference_count references; /* the caller alone */
    cscd_context *context;
    pthread_mutex_t lock;             /* of maps that become whole */
    const cscd_mesh *old_mesh, *mesh; /* as their creators see them; held */
    number_map vertices, edges, triangles, objects;
    number_map components; /* the untouched ones; in these, features have one origin and are its only ones */

    object_run *runs; /* all objects of the new mesh that have not changed, in their order */
    uint32_t run_count;
    object_range *described; /* all others */
    uint32_t described_count;
};

/* Fills in what the runs say, once; from any thread. */
void mesh_change_make_whole(const cscd_mesh_change *change, const number_map *map);

/* Tells whether the changed object has kept this triangle of the new mesh whole: it is all that one old triangle has become,
 * and its corners are all that the old corners have become. */
static inline bool mesh_change_keeps(const cscd_mesh_change *change, uint32_t triangle) {
    uint32_t origin = change->triangles.to_old[triangle];
    if (origin == UINT32_MAX || change->triangles.to_new[origin] != triangle) return false;
    for (int i = 0; i < 3; i++) {
        uint32_t corner = change->mesh->triangles[triangle][i];
        uint32_t before = change->old_mesh->triangles[origin][i];
        if (change->vertices.to_old[corner] != before || change->vertices.to_new[before] != corner)
            return false;
    }
    return true;
}

/* Numbers of an object that has moved as a whole. */
static inline void copy_shifted(const uint32_t *restrict from, size_t count, uint32_t by,
                                uint32_t *restrict to) {
    for (size_t i = 0; i < count; i++) to[i] = from[i] + by;
}

/* An object of a mesh that becomes the next object of another one. */
typedef struct object_source {
    const cscd_mesh *mesh;
    uint32_t object;
} object_source;

/* An object on its way from one mesh to another. */
typedef struct object_move {
    object_source source;
    object_range from, to;
} object_move;

/* The origin of an object of the new mesh. */
typedef struct object_origin {
    uint32_t old_object;                               /* UINT32_MAX: a new one */
    bool changed;                                      /* the caller has described it again */
    const uint32_t *vertex_origins, *triangle_origins; /* of the caller; NULL: the same numbers */
} object_origin;

/* Fills in the maps, whose arrays there are; moves and origins: one for each object of the new mesh. */
void mesh_change_map(cscd_mesh_change *change, const object_range *old_ranges, const object_move *moves,
                     const object_origin *origins);

/* ---- all successors of a feature -------------------------------------------------------------------------------- */

/* Most features have one successor, which the map says. The others, of objects that have changed, are sorted: the old number
 * in the upper half, the new one in the lower one. */
typedef struct mesh_successors {
    const number_map *map;
    uint64_t *others;
    size_t other_count;
} mesh_successors;

/* The successors of one old feature. */
typedef struct successor_list {
    uint32_t first;
    const uint64_t *others;
    size_t count; /* with the first */
} successor_list;

/* map: one of the change's. On failure *out holds nothing. */
cscd_status mesh_successors_find(cscd_context *context, const cscd_mesh_change *change, const number_map *map,
                                 mesh_successors *out);
void mesh_successors_free(cscd_context *context, mesh_successors *h);

successor_list mesh_successors_of(const mesh_successors *h, uint32_t old);

/* In ascending order. */
static inline uint32_t successor_at(const successor_list *list, size_t i) {
    return i == 0 ? list->first : (uint32_t)list->others[i - 1];
}
