/* The patches into which intersection curves cut a surface, and how often bodies wind around them. */
#include "runtime/intersections/named_surface.h"

#include "src/core/context.h"
#include "src/core/sort.h"

#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

enum { CUT_TRIANGLE = 8 };

static size_t node_count(const cscd_mesh *mesh) {
    return (size_t)mesh->vertex_count + 2 * (size_t)mesh->edge_count;
}

static array_list list_arrays(patch_finder *p) {
    size_t vertices = p->mesh->vertex_count, triangles = p->mesh->triangle_count;
    return (array_list){{ARRAY(p->cut_edges, p->mesh->edge_count), ARRAY(p->split_vertices, vertices),
                         ARRAY(p->crossed_components, p->mesh->component_count),
                         ARRAY(p->triangle_cuts, triangles), ARRAY(p->parents, node_count(p->mesh)),
                         ARRAY(p->node_patches, node_count(p->mesh)),
                         ARRAY(p->component_patch, p->mesh->component_count),
                         ARRAY(p->vertex_patches, vertices), ARRAY(p->triangle_patches, triangles),
                         ARRAY(p->corner_patches, 3 * triangles), ARRAY(p->workers, p->worker_count)}};
}

static array_list list_worker(winding_worker *worker, size_t bodies) {
    winding_tally *t = &worker->tally;
    return (array_list){{ARRAY(t->numbers, bodies), ARRAY(t->is_touched, bodies), ARRAY(t->touched, bodies),
                         ARRAY(worker->spare, bodies)}};
}

static void free_tallies(patch_finder *p) {
    for (uint32_t i = 0; i < p->worker_count; i++)
        context_free_all(p->mesh->context, list_worker(&p->workers[i], 0));
    p->tally_capacity = 0;
}

/* Tallies begin with zeros, and end so. */
static bool reserve_tallies(patch_finder *p, uint32_t bodies) {
    if (bodies <= p->tally_capacity) return true;
    free_tallies(p);
    for (uint32_t i = 0; i < p->worker_count; i++) {
        if (context_allocate_all(p->mesh->context, list_worker(&p->workers[i], bodies))) continue;
        free_tallies(p);
        return false;
    }
    p->tally_capacity = bodies;
    return true;
}

cscd_status patch_finder_create(const cscd_mesh *mesh, uint32_t worker_count, patch_finder *out) {
    patch_finder p = {.mesh = mesh, .worker_count = worker_count};
    if (!context_allocate_all(mesh->context, list_arrays(&p))) return CSCD_OUT_OF_MEMORY;
    if (!reserve_tallies(&p, mesh->object_count)) {
        patch_finder_free(&p);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = p;
    return CSCD_OK;
}

void patch_finder_free(patch_finder *p) {
    if (p->mesh == NULL) return;
    cscd_context *context = p->mesh->context;
    free_tallies(p);
    for (uint32_t i = 0; i < p->worker_count; i++) context_free(context, p->workers[i].items);
    context_free_all(context, list_arrays(p));
    context_free(context, p->patches);
    context_free(context, p->windings);
    *p = (patch_finder){0};
}

/* Grows an array to twice its capacity. NULL: no memory, and the array is as it was. */
static void *grow_twice(cscd_context *context, void *items, size_t *capacity, size_t count, size_t size) {
    size_t larger = *capacity == 0 ? 64 : *capacity * 2;
    void *grown = context_grow(context, items, count, larger, size);
    if (grown != NULL) *capacity = larger;
    return grown;
}

/* ---- what curves cut ----------------------------------------------------------------------------------- */

typedef struct patch_work {
    patch_finder *finder;
    const named_surface *surface;
    const bvh *bvh;
    size_t most_windings;    /* the number that fits the budget, for all threads together */
    atomic_size_t *windings; /* their number by now */
} patch_work;

static void mark_crossed(patch_finder *p, uint32_t triangle) {
    p->crossed_components[p->mesh->triangle_components[triangle]] = true;
}

/* A piece ends at the corner of this name. */
static void split_corner(const patch_work *work, uint32_t triangle, uint32_t name) {
    patch_finder *p = work->finder;
    for (int i = 0; i < 3; i++) {
        uint32_t vertex = p->mesh->triangles[triangle][i];
        if (surface_name(work->surface, vertex) != name) continue;
        p->split_vertices[vertex] = true;
        p->triangle_cuts[triangle] |= (uint8_t)(1 << i);
    }
}

static void mark_piece(const patch_work *work, const curve_piece *piece) {
    patch_finder *p = work->finder;
    const uint32_t both[2] = {piece->a, piece->b};
    for (int i = 0; i < 2; i++) {
        surface_piercing piercing = piece->ends[i];
        if (piercing.edge != NO_EDGE)
            p->cut_edges[piercing.edge] = true;
        else
            for (int j = 0; j < 2; j++)
                split_corner(work, both[j], surface_name(work->surface, piercing.triangle));
        p->triangle_cuts[both[i]] |= CUT_TRIANGLE;
        mark_crossed(p, both[i]);
    }
}

static void mark_pieces(const patch_work *work, const curve_piece *pieces, size_t piece_count) {
    patch_finder *p = work->finder;
    const cscd_mesh *mesh = p->mesh;
    memset(p->cut_edges, false, mesh->edge_count * sizeof *p->cut_edges);
    memset(p->split_vertices, false, mesh->vertex_count * sizeof *p->split_vertices);
    memset(p->crossed_components, false, mesh->component_count * sizeof *p->crossed_components);
    memset(p->triangle_cuts, 0, mesh->triangle_count * sizeof *p->triangle_cuts);
    for (size_t i = 0; i < piece_count; i++) mark_piece(work, &pieces[i]);
}

/* ---- connecting ---------------------------------------------------------------------------------------- */

/* The node of an edge at its vertex. */
static uint32_t node_at(const patch_finder *p, uint32_t edge, uint32_t vertex) {
    if (!p->split_vertices[vertex]) return vertex;
    return p->mesh->vertex_count + 2 * edge + (p->mesh->edges[edge][1] == vertex);
}

uint32_t patch_node(const patch_finder *p, uint32_t edge, uint32_t vertex) {
    return set_root(p->parents, node_at(p, edge, vertex));
}

static void begin_nodes(patch_finder *p, uint32_t triangle) {
    for (int i = 0; i < 3; i++) {
        uint32_t from = p->mesh->triangles[triangle][i], to = p->mesh->triangles[triangle][(i + 1) % 3];
        uint32_t edge = p->mesh->triangle_edges[triangle][i];
        const uint32_t nodes[2] = {node_at(p, edge, from), node_at(p, edge, to)};
        for (int j = 0; j < 2; j++) {
            p->parents[nodes[j]] = nodes[j];
            p->node_patches[nodes[j]] = UINT32_MAX;
        }
    }
}

/* Both ends of an edge that is not cut are in one patch, and both edges at a corner unless a curve ends there. */
static void connect_triangle(patch_finder *p, uint32_t triangle) {
    const uint32_t *vertices = p->mesh->triangles[triangle], *edges = p->mesh->triangle_edges[triangle];
    for (int i = 0; i < 3; i++) {
        uint32_t from = vertices[i], to = vertices[(i + 1) % 3];
        if (!p->cut_edges[edges[i]])
            set_unite(p->parents, node_at(p, edges[i], from), node_at(p, edges[i], to));
        if (p->split_vertices[from] && (p->triangle_cuts[triangle] >> i & 1) == 0)
            set_unite(p->parents, node_at(p, edges[i], from), node_at(p, edges[(i + 2) % 3], from));
    }
}

static void connect_nodes(patch_finder *p) {
    const cscd_mesh *mesh = p->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (p->crossed_components[mesh->triangle_components[t]]) begin_nodes(p, t);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (p->crossed_components[mesh->triangle_components[t]]) connect_triangle(p, t);
    }
}

/* ---- patches ------------------------------------------------------------------------------------------- */

static bool add_patch(patch_finder *p, uint32_t triangle, uint32_t corner, uint32_t *place) {
    const cscd_mesh *mesh = p->mesh;
    if (!memory_budget_take(p->budget, 1, MEMORY_WHILE_DOUBLING * sizeof *p->patches)) return false;
    if (p->patch_count == p->patch_capacity) {
        void *grown =
            grow_twice(mesh->context, p->patches, &p->patch_capacity, p->patch_count, sizeof *p->patches);
        if (grown == NULL) return false;
        p->patches = grown;
    }
    *place = (uint32_t)p->patch_count;
    p->patches[p->patch_count++] =
        (cscd_patch){.component = mesh->triangle_components[triangle],
                     .object = cscd_mesh_vertex_object(mesh, mesh->triangles[triangle][0]),
                     .body = body_of_triangle(p->bodies, mesh, triangle),
                     .triangle = triangle,
                     .corner = corner};
    return true;
}

/* Returns the place that keeps the patch of a corner, on the side of the edge that begins there. */
static uint32_t *patch_of_corner(patch_finder *p, uint32_t triangle, uint32_t corner) {
    uint32_t component = p->mesh->triangle_components[triangle];
    if (!p->crossed_components[component]) return &p->component_patch[component];
    uint32_t node =
        node_at(p, p->mesh->triangle_edges[triangle][corner], p->mesh->triangles[triangle][corner]);
    return &p->node_patches[set_root(p->parents, node)];
}

/* An example must have sides. It is the first corner that has. */
static void improve_example(const patch_work *work, cscd_patch *patch, uint32_t triangle, uint32_t corner) {
    if (work->surface->names == NULL || patch->triangle == triangle) return;
    if (!winding_is_collapsed(work->surface, patch->triangle) ||
        winding_is_collapsed(work->surface, triangle))
        return;
    patch->triangle = triangle;
    patch->corner = corner;
}

static bool name_patches_of(const patch_work *work, uint32_t triangle) {
    patch_finder *p = work->finder;
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t vertex = p->mesh->triangles[triangle][i], *place = patch_of_corner(p, triangle, i);
        if (*place == UINT32_MAX && !add_patch(p, triangle, i, place)) return false;
        improve_example(work, &p->patches[*place], triangle, i);
        p->corner_patches[(size_t)triangle * 3 + i] = *place;
        if (p->split_vertices[vertex] || p->vertex_patches[vertex] != UINT32_MAX) continue;
        p->vertex_patches[vertex] = *place;
        p->patches[*place].vertex_count++;
    }
    bool whole = (p->triangle_cuts[triangle] & CUT_TRIANGLE) == 0;
    p->triangle_patches[triangle] = whole ? p->corner_patches[(size_t)triangle * 3] : UINT32_MAX;
    if (whole) p->patches[p->triangle_patches[triangle]].triangle_count++;
    return true;
}

static bool name_patches(const patch_work *work) {
    patch_finder *p = work->finder;
    const cscd_mesh *mesh = p->mesh;
    p->patch_count = 0;
    memset(p->component_patch, 0xff, mesh->component_count * sizeof *p->component_patch);
    memset(p->vertex_patches, 0xff, mesh->vertex_count * sizeof *p->vertex_patches);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!name_patches_of(work, t)) return false;
    }
    return true;
}

/* ---- numbers ------------------------------------------------------------------------------------------- */

/* Without rules, obstacles are not looked at with each other, nor with themselves. */
bool patch_bodies_look(const patch_finder *p, uint32_t body_a, uint32_t body_b) {
    uint32_t a = object_of_body(p->bodies, body_a), b = object_of_body(p->bodies, body_b);
    if (p->objects != NULL) return object_sets_may_meet(&p->objects[a], &p->objects[b]);
    return !(p->mesh->objects[a].obstacle && p->mesh->objects[b].obstacle);
}

double patch_times_within(const patch_finder *p, uint32_t body, int32_t number) {
    if (!patch_bodies_look(p, body, body)) return number;
    return number >= 1 ? 1.0 : 0.0;
}

static int compare_numbers(const void *a, const void *b) {
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* A number is in the list of a worker, and then in that of all. */
enum { WINDING_SIZE = (MEMORY_WHILE_DOUBLING + 2) * sizeof(cscd_winding) };

/* Workers stop when all of them together have too many, which is so whenever the number of all is too large. */
static bool keep_number(const patch_work *work, winding_worker *worker, cscd_winding number) {
    const patch_finder *p = work->finder;
    if (atomic_fetch_add_explicit(work->windings, 1, memory_order_relaxed) >= work->most_windings)
        return false;
    if (worker->count == worker->capacity) {
        void *grown = grow_twice(p->mesh->context, worker->items, &worker->capacity, worker->count,
                                 sizeof *worker->items);
        if (grown == NULL) return false;
        worker->items = grown;
    }
    worker->items[worker->count++] = number;
    return true;
}

/* Adds the numbers of a patch to the worker's; first_winding counts within the worker. */
static bool number_patch(const patch_work *work, winding_worker *worker, cscd_patch *patch) {
    patch_finder *p = work->finder;
    winding_tally *tally = &worker->tally;
    winding_tally_clear(tally);
    winding_find(work->surface, work->bvh, (corner_side){patch->triangle, (uint8_t)patch->corner, true},
                 tally);
    sort_items(tally->touched, worker->spare, tally->count, sizeof *tally->touched, compare_numbers);
    patch->first_winding = (uint32_t)worker->count;
    for (uint32_t i = 0; i < tally->count; i++) {
        cscd_winding number = {tally->touched[i], tally->numbers[tally->touched[i]]};
        if (number.number == 0 || !patch_bodies_look(p, patch->body, number.body)) continue;
        if (number.body == patch->body) patch->own = number.number;
        if (!keep_number(work, worker, number)) return false;
        patch->winding_count++;
    }
    return true;
}

/* A worker has patches that follow each other. */
static void number_patches(void *data, uint32_t index) {
    const patch_work *work = data;
    patch_finder *p = work->finder;
    winding_worker *worker = &p->workers[index];
    size_t begin = parallel_share(p->patch_count, index, p->worker_count);
    size_t end = parallel_share(p->patch_count, index + 1, p->worker_count);
    worker->count = 0;
    worker->out_of_memory = false;
    for (size_t i = begin; i < end && !worker->out_of_memory; i++) {
        double share = (double)(i - begin) / (double)(end - begin);
        if (!progress_go_on(&p->mesh->context->progress, share)) return;
        worker->out_of_memory = !number_patch(work, worker, &p->patches[i]);
    }
}

static bool join_numbers(patch_finder *p) {
    size_t total = 0;
    for (uint32_t i = 0; i < p->worker_count; i++) {
        if (p->workers[i].out_of_memory) return false;
        total += p->workers[i].count;
    }
    while (total > p->winding_capacity) {
        void *grown = grow_twice(p->mesh->context, p->windings, &p->winding_capacity, 0, sizeof *p->windings);
        if (grown == NULL) return false;
        p->windings = grown;
    }
    p->winding_count = 0;
    for (uint32_t i = 0; i < p->worker_count; i++) {
        size_t begin = parallel_share(p->patch_count, i, p->worker_count),
               end = parallel_share(p->patch_count, i + 1, p->worker_count);
        for (size_t k = begin; k < end; k++) p->patches[k].first_winding += (uint32_t)p->winding_count;
        if (p->workers[i].count > 0)
            memcpy(p->windings + p->winding_count, p->workers[i].items,
                   p->workers[i].count * sizeof *p->windings);
        p->winding_count += p->workers[i].count;
    }
    return true;
}

cscd_status patch_finder_run(patch_finder *p, const named_surface *s, const bvh *hierarchy,
                             const curve_piece *pieces, size_t piece_count, cscd_patches *out) {
    atomic_size_t windings = 0;
    patch_work work = {.finder = p, .surface = s, .bvh = hierarchy, .windings = &windings};
    p->bodies = s->bodies;
    if (!reserve_tallies(p, body_count(s->bodies, s->mesh))) return CSCD_OUT_OF_MEMORY;
    mark_pieces(&work, pieces, piece_count);
    connect_nodes(p);
    if (!name_patches(&work)) return CSCD_OUT_OF_MEMORY;
    work.most_windings = memory_budget_room(p->budget, WINDING_SIZE);
    parallel_run(p->mesh->context->threads, p->worker_count, number_patches, &work);
    if (progress_cancelled(&p->mesh->context->progress)) return CSCD_CANCELLED;
    /* how many more workers have counted before they stopped depends on their number */
    size_t counted = windings > work.most_windings ? work.most_windings + 1 : windings;
    if (!memory_budget_take(p->budget, counted, WINDING_SIZE)) return CSCD_OUT_OF_MEMORY;
    if (!join_numbers(p)) return CSCD_OUT_OF_MEMORY;
    *out = (cscd_patches){p->patches,        p->patch_count,      p->windings,       p->winding_count,
                          p->vertex_patches, p->triangle_patches, p->corner_patches, s->turned};
    return context_progress_status(p->mesh->context);
}
