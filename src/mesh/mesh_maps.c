/* Maps from the features of a mesh to those of one that was made from it, and back; which components are untouched. */
#include "src/mesh/mesh_change.h"

#include "src/core/sort.h"

#include <string.h>

/* ---- objects that have not changed ---------------------------------------------------------------------- */

static void map_range(number_map *map, uint32_t from, uint32_t to, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) map->to_new[from + i] = to + i;
    for (uint32_t i = 0; i < count; i++) map->to_old[to + i] = from + i;
}

static bool range_follows(const object_range *range, const object_range *next) {
    return next->vertex == range->vertex + range->vertex_count &&
           next->edge == range->edge + range->edge_count &&
           next->triangle == range->triangle + range->triangle_count &&
           next->component == range->component + range->component_count;
}

static void extend_range(object_range *range, const object_range *next) {
    range->vertex_count += next->vertex_count;
    range->edge_count += next->edge_count;
    range->triangle_count += next->triangle_count;
    range->component_count += next->component_count;
}

/* The object goes on with the last run, if it follows that in both meshes. */
static void add_to_runs(cscd_mesh_change *change, const object_move *m) {
    object_run *last = change->run_count > 0 ? &change->runs[change->run_count - 1] : NULL;
    if (last != NULL && range_follows(&last->from, &m->from) && range_follows(&last->to, &m->to)) {
        extend_range(&last->from, &m->from);
        extend_range(&last->to, &m->to);
    } else {
        change->runs[change->run_count++] = (object_run){m->from, m->to};
    }
}

static void add_run(number_map *map, uint32_t from, uint32_t to, uint32_t count) {
    if (count > 0) map->runs[map->run_count++] = (number_run){from, to, count};
}

static void map_run(cscd_mesh_change *change, const object_run *m) {
    add_run(&change->vertices, m->from.vertex, m->to.vertex, m->from.vertex_count);
    add_run(&change->edges, m->from.edge, m->to.edge, m->from.edge_count);
    add_run(&change->triangles, m->from.triangle, m->to.triangle, m->from.triangle_count);
    map_range(&change->components, m->from.component, m->to.component, m->from.component_count);
}

/* The caller has it as one that does not change, since nobody sees that it does. */
void mesh_change_make_whole(const cscd_mesh_change *change, const number_map *map) {
    cscd_mesh_change *own = (cscd_mesh_change *)change;
    number_map *filled = (number_map *)map;
    pthread_mutex_lock(&own->lock);
    for (uint32_t i = 0; !filled->whole && i < map->run_count; i++)
        map_range(filled, map->runs[i].from, map->runs[i].to, map->runs[i].count);
    filled->whole = true;
    pthread_mutex_unlock(&own->lock);
}

/* ---- objects that have ---------------------------------------------------------------------------------- */

static void unmap_new(number_map *map, uint32_t begin, uint32_t count) {
    memset(map->to_old + begin, 0xff, count * sizeof *map->to_old);
}

static void unmap_old(number_map *map, uint32_t begin, uint32_t count) {
    memset(map->to_new + begin, 0xff, count * sizeof *map->to_new);
}

static void unmap_old_object(cscd_mesh_change *change, const object_range *old) {
    unmap_old(&change->vertices, old->vertex, old->vertex_count);
    unmap_old(&change->edges, old->edge, old->edge_count);
    unmap_old(&change->triangles, old->triangle, old->triangle_count);
    unmap_old(&change->components, old->component, old->component_count);
}

static void unmap_new_object(cscd_mesh_change *change, const object_range *now) {
    unmap_new(&change->vertices, now->vertex, now->vertex_count);
    unmap_new(&change->edges, now->edge, now->edge_count);
    unmap_new(&change->triangles, now->triangle, now->triangle_count);
    unmap_new(&change->components, now->component, now->component_count);
}

/* Of several that came from one, the first is what has become of it: new features are joined in ascending order. */
static void join_features(number_map *map, uint32_t now, uint32_t old) {
    map->to_old[now] = old;
    if (map->to_new[old] == UINT32_MAX) map->to_new[old] = now;
}

/* origins: in the numbering of the object; NULL: the same numbers. */
static void map_by_origins(number_map *map, const uint32_t *origins, uint32_t old_begin, uint32_t old_count,
                           uint32_t begin, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        uint32_t origin = origins != NULL ? origins[i] : i < old_count ? i : UINT32_MAX;
        if (origin != UINT32_MAX) join_features(map, begin + i, old_begin + origin);
    }
}

static bool joins_both(const uint32_t *corners, int side, uint32_t a, uint32_t b) {
    uint32_t c = corners[side], d = corners[(side + 1) % 3];
    return (c == a && d == b) || (c == b && d == a);
}

/* The edge that joins vertices of the old mesh, if it is one of this triangle. */
static uint32_t edge_of_triangle(const cscd_mesh *old, uint32_t triangle, uint32_t a, uint32_t b) {
    for (int side = 0; triangle != UINT32_MAX && side < 3; side++) {
        if (joins_both(old->triangles[triangle], side, a, b)) return old->triangle_edges[triangle][side];
    }
    return UINT32_MAX;
}

static bool edge_is_below(const uint32_t edge[2], uint32_t a, uint32_t b) {
    return edge[0] != a ? edge[0] < a : edge[1] < b;
}

/* The edge that joins vertices a and b of one object, if there is one. */
static uint32_t find_edge(const cscd_mesh *mesh, const object_range *range, uint32_t a, uint32_t b) {
    uint32_t low = range->edge, end = range->edge + range->edge_count, high = end;
    uint32_t least = a < b ? a : b, greatest = a < b ? b : a;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (edge_is_below(mesh->edges[middle], least, greatest))
            low = middle + 1;
        else
            high = middle;
    }
    bool found = low < end && mesh->edges[low][0] == least && mesh->edges[low][1] == greatest;
    return found ? low : UINT32_MAX;
}

/* An edge was the one that joined the origins of its vertices. Mostly a triangle at it was a triangle at that one. */
static void map_edges(cscd_mesh_change *change, const object_range *old, const object_range *now) {
    const cscd_mesh *mesh = change->mesh, *before = change->old_mesh;
    for (uint32_t edge = now->edge; edge < now->edge + now->edge_count; edge++) {
        uint32_t a = change->vertices.to_old[mesh->edges[edge][0]];
        uint32_t b = change->vertices.to_old[mesh->edges[edge][1]];
        if (a == UINT32_MAX || b == UINT32_MAX) continue;
        uint32_t origin = UINT32_MAX;
        if (edge_star_size(mesh, edge) > 0) {
            uint32_t triangle = mesh->edge_stars[mesh->edge_star_offsets[edge]];
            origin = edge_of_triangle(before, change->triangles.to_old[triangle], a, b);
        }
        if (origin == UINT32_MAX) origin = find_edge(before, old, a, b);
        if (origin != UINT32_MAX) join_features(&change->edges, edge, origin);
    }
}

/* ---- components of such objects ----------------------------------------------------------------------- */

/* Each old component is a candidate for the new one of its first triangle. */
static void propose_components(cscd_mesh_change *change, const object_range *now) {
    for (uint32_t t = now->triangle; t < now->triangle + now->triangle_count; t++) {
        uint32_t component = change->mesh->triangle_components[t], origin = change->triangles.to_old[t];
        if (change->components.to_old[component] == UINT32_MAX && origin != UINT32_MAX)
            change->components.to_old[component] = change->old_mesh->triangle_components[origin];
    }
}

/* Refuses those of which one triangle differs. */
static void refuse_components(cscd_mesh_change *change, const object_range *now) {
    uint32_t *proposed = change->components.to_old;
    for (uint32_t t = now->triangle; t < now->triangle + now->triangle_count; t++) {
        uint32_t component = change->mesh->triangle_components[t], origin = change->triangles.to_old[t];
        if (proposed[component] == UINT32_MAX) continue;
        bool same = mesh_change_keeps(change, t) &&
                    change->old_mesh->triangle_components[origin] == proposed[component];
        if (!same) proposed[component] = UINT32_MAX;
    }
}

/* As many triangles, all of them the same: the whole component. */
static void accept_components(cscd_mesh_change *change, const object_range *now) {
    for (uint32_t c = now->component; c < now->component + now->component_count; c++) {
        uint32_t origin = change->components.to_old[c];
        if (origin == UINT32_MAX) continue;
        const cscd_component *before = &change->old_mesh->components[origin];
        bool same = before->triangle_count == change->mesh->components[c].triangle_count &&
                    component_is_obstacle(change->old_mesh, origin) == component_is_obstacle(change->mesh, c);
        if (same)
            change->components.to_new[origin] = c;
        else
            change->components.to_old[c] = UINT32_MAX;
    }
}

static void map_changed_object(cscd_mesh_change *change, const object_range *old, const object_range *now,
                               const object_origin *origin) {
    map_by_origins(&change->vertices, origin->vertex_origins, old->vertex, old->vertex_count, now->vertex,
                   now->vertex_count);
    map_by_origins(&change->triangles, origin->triangle_origins, old->triangle, old->triangle_count,
                   now->triangle, now->triangle_count);
    map_edges(change, old, now);
    propose_components(change, now);
    refuse_components(change, now);
    accept_components(change, now);
}

/* ---- all of them ---------------------------------------------------------------------------------------- */

void mesh_change_map(cscd_mesh_change *change, const object_range *old_ranges, const object_move *moves,
                     const object_origin *origins) {
    unmap_old(&change->objects, 0, change->objects.old_count);
    for (uint32_t i = 0; i < change->objects.new_count; i++) {
        change->objects.to_old[i] = origins[i].old_object;
        if (origins[i].old_object != UINT32_MAX) change->objects.to_new[origins[i].old_object] = i;
    }
    for (uint32_t i = 0; i < change->objects.old_count; i++) {
        uint32_t now = change->objects.to_new[i];
        if (now == UINT32_MAX || origins[now].changed) unmap_old_object(change, &old_ranges[i]);
    }
    for (uint32_t i = 0; i < change->objects.new_count; i++) {
        if (!origins[i].changed) {
            add_to_runs(change, &moves[i]);
            continue;
        }
        change->described[change->described_count++] = moves[i].to;
        unmap_new_object(change, &moves[i].to);
        if (origins[i].old_object != UINT32_MAX)
            map_changed_object(change, &old_ranges[origins[i].old_object], &moves[i].to, &origins[i]);
    }
    for (uint32_t i = 0; i < change->run_count; i++) map_run(change, &change->runs[i]);
    change->objects.whole = change->components.whole = true;
}

/* ---- all successors of a feature -------------------------------------------------------------------------------- */

/* Features of objects that have changed, of the kind of the map. */
static number_run described_numbers(const cscd_mesh_change *change, const number_map *map, uint32_t i) {
    const object_range *range = &change->described[i];
    if (map == &change->vertices) return (number_run){0, range->vertex, range->vertex_count};
    if (map == &change->edges) return (number_run){0, range->edge, range->edge_count};
    return (number_run){0, range->triangle, range->triangle_count};
}

static bool is_another(const number_map *map, uint32_t now) {
    return map->to_old[now] != UINT32_MAX && map->to_new[map->to_old[now]] != now;
}

/* Lists them where there is room for them, and returns how many there are. Objects have one successor. */
static size_t list_others(const cscd_mesh_change *change, const number_map *map, uint64_t *out) {
    size_t count = 0;
    for (uint32_t i = 0; map != &change->objects && i < change->described_count; i++) {
        number_run run = described_numbers(change, map, i);
        for (uint32_t now = run.to; now < run.to + run.count; now++) {
            if (!is_another(map, now)) continue;
            if (out != NULL) out[count] = (uint64_t)map->to_old[now] << 32 | now;
            count++;
        }
    }
    return count;
}

cscd_status mesh_successors_find(cscd_context *context, const cscd_mesh_change *change, const number_map *map,
                                 mesh_successors *out) {
    mesh_successors h = {.map = map, .other_count = list_others(change, map, NULL)};
    uint64_t *spare;
    array_list list = {{ARRAY(h.others, h.other_count), ARRAY(spare, h.other_count)}};
    *out = (mesh_successors){.map = NULL};
    if (!context_allocate_all(context, list)) return CSCD_OUT_OF_MEMORY;
    list_others(change, map, h.others);
    sort_by_number(h.others, spare, h.other_count, sizeof *h.others);
    context_free(context, spare);
    *out = h;
    return CSCD_OK;
}

void mesh_successors_free(cscd_context *context, mesh_successors *h) {
    context_free(context, h->others);
    *h = (mesh_successors){.map = NULL};
}

static size_t first_other(const mesh_successors *h, uint64_t least) {
    size_t low = 0, high = h->other_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (h->others[middle] < least)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

successor_list mesh_successors_of(const mesh_successors *h, uint32_t old) {
    successor_list list = {.first = number_map_to_new(h->map, old)};
    if (list.first == UINT32_MAX) return list;
    size_t begin = first_other(h, (uint64_t)old << 32);
    list.others = h->others + begin;
    for (size_t i = begin; i < h->other_count && h->others[i] >> 32 == old; i++) list.count++;
    list.count++;
    return list;
}
