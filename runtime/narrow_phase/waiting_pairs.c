/* Pairs that a change has uncovered while they touched: they are left out until they have once been apart. */
#include "runtime/narrow_phase/exclusions.h"
#include "runtime/narrow_phase/pair_filter.h"
#include "src/core/sort.h"

#include <assert.h>

/* ---- sets of pairs ------------------------------------------------------------------------------------- */

void named_pair_set_free(cscd_context *context, named_pair_set *set) {
    context_free(context, set->items);
    *set = (named_pair_set){.items = NULL};
}

bool named_pair_set_add(cscd_context *context, named_pair_set *set, cscd_contact_kind kind, uint32_t a,
                        uint32_t b) {
    if (set->count == set->capacity) {
        size_t capacity = 2 * set->capacity + 64;
        named_pair *grown = context_grow(context, set->items, set->count, capacity, sizeof *grown);
        if (grown == NULL) return false;
        set->items = grown;
        set->capacity = capacity;
    }
    set->items[set->count++] = (named_pair){(uint32_t)kind, a, b, 0};
    return true;
}

static int compare_pairs(const void *left, const void *right) {
    const named_pair *l = left, *r = right;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

static void count_triangle_pairs(named_pair_set *set) {
    set->triangle_pairs = 0;
    for (size_t i = 0; i < set->count; i++) set->triangle_pairs += set->items[i].kind == CSCD_CONTACT_TT;
}

bool named_pair_set_sort(cscd_context *context, named_pair_set *set) {
    size_t kept = 0;
    if (set->count > 1) {
        named_pair *scratch = context_allocate(context, set->count, sizeof *scratch);
        if (scratch == NULL) return false;
        sort_items(set->items, scratch, set->count, sizeof *scratch, compare_pairs);
        context_free(context, scratch);
    }
    for (size_t i = 0; i < set->count; i++) {
        if (i == 0 || compare_pairs(&set->items[i], &set->items[kept - 1]) != 0)
            set->items[kept++] = set->items[i];
    }
    set->count = kept;
    count_triangle_pairs(set);
    return true;
}

void named_pair_set_keep_marked(named_pair_set *set) {
    size_t kept = 0;
    for (size_t i = 0; i < set->count; i++) {
        if (set->items[i].marked == 0) continue;
        set->items[kept] = set->items[i];
        set->items[kept++].marked = 0;
    }
    set->count = kept;
    count_triangle_pairs(set);
}

named_pair *named_pair_set_find(const named_pair_set *set, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const named_pair wanted = {(uint32_t)kind, a, b, 0};
    size_t low = 0, high = set->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (compare_pairs(&set->items[middle], &wanted) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < set->count && compare_pairs(&set->items[low], &wanted) == 0 ? &set->items[low] : NULL;
}

/* ---- changes ------------------------------------------------------------------------------------------- */

static void forget_former(const cscd_mesh *mesh, former_exclusions **link) {
    former_exclusions *former = *link;
    *link = former->next;
    exclusions_free(mesh->context, &former->exclusions);
    context_free(mesh->context, former->sets);
    context_free(mesh->context, former);
}

void waiting_pairs_settled(const cscd_mesh *mesh, waiting_pairs *w) {
    while (w->former != NULL) forget_former(mesh, &w->former);
}

void waiting_pairs_free(const cscd_mesh *mesh, waiting_pairs *w) {
    waiting_pairs_settled(mesh, w);
    context_free(mesh->context, w->spare);
    named_pair_set_free(mesh->context, &w->pairs);
    named_pair_set_free(mesh->context, &w->torn);
}

cscd_status waiting_pairs_reserve(const cscd_mesh *mesh, waiting_pairs *w) {
    if (w->spare == NULL) w->spare = context_allocate(mesh->context, 1, sizeof *w->spare);
    return w->spare != NULL ? CSCD_OK : context_out_of_memory(mesh->context);
}

/* Does the first one leave out all that the second one does? */
static bool covers_former(const cscd_mesh *mesh, const former_exclusions *a, const former_exclusions *b) {
    if ((a->sets == NULL) != (b->sets == NULL)) return false;
    if (a->sets == NULL) return !exclusions_uncover(&b->exclusions, &a->exclusions);
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        if (!object_sets_are_alike(&a->sets[i], &b->sets[i])) return false;
    }
    return true;
}

static void remember_former(const cscd_mesh *mesh, waiting_pairs *w, former_exclusions former) {
    assert(w->spare != NULL);
    *w->spare = former;
    for (former_exclusions **link = &w->former; *link != NULL;) {
        if (covers_former(mesh, w->spare, *link))
            forget_former(mesh, link);
        else
            link = &(*link)->next;
    }
    w->spare->next = w->former;
    w->former = w->spare;
    w->spare = NULL;
}

static bool is_remembered(const cscd_mesh *mesh, const waiting_pairs *w, const former_exclusions *former) {
    for (const former_exclusions *f = w->former; f != NULL; f = f->next) {
        if (covers_former(mesh, f, former)) return true;
    }
    return false;
}

void waiting_pairs_uncover(const cscd_mesh *mesh, waiting_pairs *w, exclusions *before) {
    const former_exclusions former = {.exclusions = exclusions_listed(before)};
    if (is_remembered(mesh, w, &former))
        exclusions_free(mesh->context, before);
    else
        remember_former(mesh, w, former);
    *before = (exclusions){.mesh = NULL};
}

void waiting_pairs_uncover_objects(const cscd_mesh *mesh, waiting_pairs *w, object_set *before) {
    const former_exclusions former = {.sets = before};
    if (is_remembered(mesh, w, &former))
        context_free(mesh->context, before);
    else
        remember_former(mesh, w, former);
}

/* ---- what was left out --------------------------------------------------------------------------------- */

static bool objects_left_out(const object_set *sets, const uint32_t of[2]) {
    const object_set *a = &sets[of[0]], *b = &sets[of[1]];
    return a->kinds != 0 && b->kinds != 0 && !object_sets_may_meet(a, b);
}

bool waiting_pairs_uncovered(const cscd_mesh *mesh, const waiting_pairs *w, cscd_contact_kind kind,
                             uint32_t a, uint32_t b, const double *positions) {
    uint32_t objects[2];
    mesh_objects_of_pair(mesh, kind, a, b, objects);
    for (const former_exclusions *f = w->former; f != NULL; f = f->next) {
        if (f->sets != NULL) {
            if (objects_left_out(f->sets, objects)) return true;
        } else if (exclusions_cover(&f->exclusions, kind, a, b, positions)) {
            return true;
        }
    }
    return false;
}

/* ---- another mesh: pairs that wait already --------------------------------------------------------------------------- */

typedef struct successors_of_kinds {
    mesh_successors vertices, edges, triangles, objects;
} successors_of_kinds;

static bool share_vertex(const uint32_t *a, int a_count, const uint32_t *b, int b_count) {
    for (int i = 0; i < a_count; i++) {
        for (int j = 0; j < b_count; j++) {
            if (a[i] == b[j]) return true;
        }
    }
    return false;
}

static bool are_neighbours(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (kind == CSCD_CONTACT_VF) return share_vertex(&a, 1, mesh->triangles[b], 3);
    if (kind == CSCD_CONTACT_EE) return share_vertex(mesh->edges[a], 2, mesh->edges[b], 2);
    return a == b && (kind == CSCD_CONTACT_VV || kind == CSCD_CONTACT_TT);
}

static uint32_t star_size(const cscd_mesh *mesh, uint32_t vertex) {
    return mesh->vertex_star_offsets[vertex + 1] - mesh->vertex_star_offsets[vertex];
}

/* Edges at a vertex have the numbers 0 to this one; some are listed twice. */
static uint32_t sides_at(const cscd_mesh *mesh, uint32_t vertex) {
    return 3 * star_size(mesh, vertex) + wires_at_vertex(mesh, vertex);
}

/* No triangle has the vertex, no wire, and it is no point: it may have lost its last triangle by the change. */
static bool is_of_nothing(const cscd_mesh *mesh, uint32_t vertex) {
    return sides_at(mesh, vertex) == 0 &&
           mesh->objects[cscd_mesh_vertex_object(mesh, vertex)].kind != CSCD_OBJECT_POINTS;
}

/* A vertex in common, and a vertex of nothing. */
static bool is_never_looked_at(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if ((kind == CSCD_CONTACT_VF || kind == CSCD_CONTACT_VH) && is_of_nothing(mesh, a)) return true;
    return are_neighbours(mesh, kind, a, b);
}

/* Adds a pair, unless it is one that is never looked at. */
static bool add_pair(const cscd_mesh *mesh, named_pair_set *set, cscd_contact_kind kind, uint32_t a,
                     uint32_t b) {
    bool alike = kind == CSCD_CONTACT_EE || kind == CSCD_CONTACT_VV || kind == CSCD_CONTACT_TT;
    bool ordered = !alike || a < b;
    return is_never_looked_at(mesh, kind, a, b) ||
           named_pair_set_add(mesh->context, set, kind, ordered ? a : b, ordered ? b : a);
}

static bool move_pair(const named_pair *pair, const successors_of_kinds *h, const cscd_mesh *mesh,
                      named_pair_set *out) {
    cscd_contact_kind kind = (cscd_contact_kind)pair->kind;
    bool of_edge = kind == CSCD_CONTACT_EE || kind == CSCD_CONTACT_EV;
    const mesh_successors *first = of_edge                   ? &h->edges
                                   : kind == CSCD_CONTACT_TT ? &h->triangles
                                                             : &h->vertices;
    const mesh_successors *second = kind == CSCD_CONTACT_EE                              ? &h->edges
                                    : kind == CSCD_CONTACT_EV || kind == CSCD_CONTACT_VV ? &h->vertices
                                    : kind == CSCD_CONTACT_VH                            ? &h->objects
                                                                                         : &h->triangles;
    successor_list of_a = mesh_successors_of(first, pair->a), of_b = mesh_successors_of(second, pair->b);
    for (size_t i = 0; i < of_a.count; i++) {
        for (size_t j = 0; j < of_b.count; j++) {
            if (!add_pair(mesh, out, kind, successor_at(&of_a, i), successor_at(&of_b, j))) return false;
        }
    }
    return true;
}

static bool move_set(const named_pair_set *set, const successors_of_kinds *h, const cscd_mesh *mesh,
                     named_pair_set *out) {
    for (size_t i = 0; i < set->count; i++) {
        if (!move_pair(&set->items[i], h, mesh, out)) return false;
    }
    return true;
}

static cscd_status move_sets(const waiting_pairs *w, const cscd_mesh *mesh, const cscd_mesh_change *change,
                             waiting_pairs *out) {
    if (w->pairs.count == 0 && w->torn.count == 0) return CSCD_OK;
    successors_of_kinds h = {.vertices = {.map = NULL}};
    cscd_context *context = mesh->context;
    cscd_status status = mesh_successors_find(context, change, &change->vertices, &h.vertices);
    if (status == CSCD_OK) status = mesh_successors_find(context, change, &change->edges, &h.edges);
    if (status == CSCD_OK) status = mesh_successors_find(context, change, &change->triangles, &h.triangles);
    if (status == CSCD_OK) status = mesh_successors_find(context, change, &change->objects, &h.objects);
    bool moved = status == CSCD_OK && move_set(&w->pairs, &h, mesh, &out->pairs) &&
                 move_set(&w->torn, &h, mesh, &out->torn) && named_pair_set_sort(mesh->context, &out->pairs);
    mesh_successors_free(mesh->context, &h.vertices);
    mesh_successors_free(mesh->context, &h.edges);
    mesh_successors_free(mesh->context, &h.triangles);
    mesh_successors_free(mesh->context, &h.objects);
    return moved ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

/* ---- neighbours that have parted ------------------------------------------------------------------------- */

/* Vertices that were one vertex, or one seam, some of which have come apart: a name in the upper half, the
 * vertex in the lower one. */
typedef struct parted_vertices {
    uint64_t *items;
    size_t count, capacity;
} parted_vertices;

static bool add_vertex(cscd_context *context, parted_vertices *p, uint32_t name, uint32_t vertex) {
    if (p->count == p->capacity) {
        size_t capacity = p->capacity * 2 + 64;
        uint64_t *grown = context_grow(context, p->items, p->count, capacity, sizeof *grown);
        if (grown == NULL) return false;
        p->items = grown;
        p->capacity = capacity;
    }
    p->items[p->count++] = (uint64_t)name << 32 | vertex;
    return true;
}

/* Without seams: vertices that are not the first to come from their origin, and those that are. */
static bool list_copies(const cscd_mesh_change *change, cscd_context *context, parted_vertices *p) {
    for (uint32_t i = 0; i < change->described_count; i++) {
        const object_range *range = &change->described[i];
        for (uint32_t v = range->vertex; v < range->vertex + range->vertex_count; v++) {
            uint32_t origin = change->vertices.to_old[v];
            if (origin == UINT32_MAX || change->vertices.to_new[origin] == v) continue;
            if (!add_vertex(context, p, origin, v) ||
                !add_vertex(context, p, origin, change->vertices.to_new[origin]))
                return false;
        }
    }
    return true;
}

/* With seams: everything that came from a seam one of whose vertices has come apart. */
static bool list_seams(const cscd_mesh_change *change, const uint32_t *names, cscd_context *context,
                       parted_vertices *p) {
    bool *parted = context_allocate(context, change->vertices.old_count, sizeof *parted);
    bool made = parted != NULL;
    mesh_change_make_whole(change, &change->vertices);
    for (size_t i = 0; made && i < p->count; i++) parted[names[p->items[i] >> 32]] = true;
    p->count = 0;
    for (uint32_t v = 0; made && v < change->vertices.new_count; v++) {
        uint32_t origin = change->vertices.to_old[v];
        if (origin != UINT32_MAX && parted[names[origin]]) made = add_vertex(context, p, names[origin], v);
    }
    context_free(context, parted);
    return made;
}

/* Sides of its triangles, and wires; UINT32_MAX: a side that the vertex is not on. */
static uint32_t side_at(const cscd_mesh *mesh, uint32_t vertex, uint32_t i) {
    uint32_t sides = 3 * star_size(mesh, vertex);
    if (i >= sides) return mesh->loose.wire_stars[mesh->loose.wire_star_offsets[vertex] + i - sides];
    uint32_t triangle = mesh->vertex_stars[mesh->vertex_star_offsets[vertex] + i / 3];
    uint32_t edge = mesh->triangle_edges[triangle][i % 3];
    return share_vertex(&vertex, 1, mesh->edges[edge], 2) ? edge : UINT32_MAX;
}

static bool part_edges(const cscd_mesh *mesh, uint32_t v, uint32_t w, named_pair_set *out) {
    for (uint32_t i = 0; i < sides_at(mesh, v); i++) {
        uint32_t a = side_at(mesh, v, i);
        for (uint32_t j = 0; a != UINT32_MAX && j < sides_at(mesh, w); j++) {
            uint32_t b = side_at(mesh, w, j);
            if (b != UINT32_MAX && !add_pair(mesh, out, CSCD_CONTACT_EE, a, b)) return false;
        }
    }
    return true;
}

static bool part_triangles(const cscd_mesh *mesh, uint32_t v, uint32_t w, named_pair_set *out) {
    for (uint32_t i = mesh->vertex_star_offsets[v]; i < mesh->vertex_star_offsets[v + 1]; i++) {
        for (uint32_t j = mesh->vertex_star_offsets[w]; j < mesh->vertex_star_offsets[w + 1]; j++) {
            if (!add_pair(mesh, out, CSCD_CONTACT_TT, mesh->vertex_stars[i], mesh->vertex_stars[j]))
                return false;
        }
    }
    return true;
}

/* The vertex itself, from the features at another one. */
static bool part_vertex(const cscd_mesh *mesh, uint32_t v, uint32_t w, named_pair_set *out) {
    uint32_t of_w = cscd_mesh_vertex_object(mesh, w);
    bool is_point = mesh->objects[cscd_mesh_vertex_object(mesh, v)].kind == CSCD_OBJECT_POINTS;
    for (uint32_t i = mesh->vertex_star_offsets[w]; i < mesh->vertex_star_offsets[w + 1]; i++) {
        if (!add_pair(mesh, out, CSCD_CONTACT_VF, v, mesh->vertex_stars[i])) return false;
    }
    for (uint32_t i = 0; is_point && i < wires_at_vertex(mesh, w); i++) {
        if (!add_pair(mesh, out, CSCD_CONTACT_EV, side_at(mesh, w, i), v)) return false;
    }
    cscd_object_kind kind = mesh->objects[of_w].kind;
    if (is_point && kind == CSCD_OBJECT_POINTS) return add_pair(mesh, out, CSCD_CONTACT_VV, v, w);
    return kind != CSCD_OBJECT_HALF_SPACE || add_pair(mesh, out, CSCD_CONTACT_VH, v, of_w);
}

static bool part_vertices(const cscd_mesh *mesh, uint32_t v, uint32_t w, named_pair_set *out) {
    return part_vertex(mesh, v, w, out) && part_vertex(mesh, w, v, out) && part_edges(mesh, v, w, out) &&
           part_triangles(mesh, v, w, out);
}

static bool part_groups(const cscd_mesh *mesh, const parted_vertices *p, named_pair_set *out) {
    for (size_t begin = 0, end; begin < p->count; begin = end) {
        for (end = begin + 1; end < p->count && p->items[end] >> 32 == p->items[begin] >> 32;) end++;
        for (size_t i = begin; i < end; i++) {
            for (size_t j = begin; j < i; j++) {
                uint32_t v = (uint32_t)p->items[i], w = (uint32_t)p->items[j];
                if (!part_vertices(mesh, v, w, out)) return false;
            }
        }
    }
    return true;
}

/* The first of several copies has been listed with each of the others. */
static bool sort_vertices(cscd_context *context, parted_vertices *p) {
    uint64_t *scratch = context_allocate(context, p->count, sizeof *scratch);
    if (scratch == NULL) return false;
    sort_by_number(p->items, scratch, p->count, sizeof *p->items);
    context_free(context, scratch);
    size_t kept = 0;
    for (size_t i = 0; i < p->count; i++) {
        if (i == 0 || p->items[i] != p->items[i - 1]) p->items[kept++] = p->items[i];
    }
    p->count = kept;
    return true;
}

static cscd_status part_neighbours(const exclusions *e, const cscd_mesh *mesh, const cscd_mesh_change *change,
                                   named_pair_set *out) {
    parted_vertices p = {.items = NULL};
    bool made = list_copies(change, mesh->context, &p);
    if (made && p.count > 0 && e->names != NULL) made = list_seams(change, e->names, mesh->context, &p);
    if (made && p.count > 0) made = sort_vertices(mesh->context, &p) && part_groups(mesh, &p, out);
    context_free(mesh->context, p.items);
    return made && named_pair_set_sort(mesh->context, out) ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

/* ---- changes whose positions have not been seen ------------------------------------------------------------ */

/* Makes the new former_exclusions from one of the old ones. */
typedef struct former_maker {
    const cscd_mesh *mesh;
    const cscd_mesh_change *change; /* NULL: it is copied */
} former_maker;

/* Objects as they were; what comes was not there. */
static object_set *move_sets_of_objects(const object_set *sets, const former_maker *m) {
    uint32_t count = m->mesh->object_count;
    object_set *moved = context_allocate(m->mesh->context, count, sizeof *moved);
    for (uint32_t i = 0; moved != NULL && i < count; i++) {
        uint32_t origin = m->change != NULL ? m->change->objects.to_old[i] : i;
        if (origin == UINT32_MAX) continue;
        moved[i] = sets[origin];
        moved[i].first = moved[i].last = i;
    }
    return moved;
}

static cscd_status make_former(const former_maker *m, const former_exclusions *from, former_exclusions *to) {
    if (from->sets != NULL) {
        to->sets = move_sets_of_objects(from->sets, m);
        return to->sets != NULL ? CSCD_OK : CSCD_OUT_OF_MEMORY;
    }
    if (m->change == NULL) return exclusions_copy(&from->exclusions, m->mesh, &to->exclusions);
    return exclusions_move_former(&from->exclusions, m->mesh, m->change, &to->exclusions);
}

static cscd_status make_formers(const former_maker *m, const former_exclusions *from, waiting_pairs *out) {
    former_exclusions **next = &out->former;
    for (; from != NULL; from = from->next) {
        former_exclusions *made = context_allocate(m->mesh->context, 1, sizeof *made);
        if (made == NULL) return CSCD_OUT_OF_MEMORY;
        *next = made;
        next = &made->next;
        cscd_status status = make_former(m, from, made);
        if (status != CSCD_OK) return status;
    }
    return CSCD_OK;
}

/* ---- another mesh, and copies ------------------------------------------------------------------------------------------- */

static cscd_status give_pairs(cscd_status status, const cscd_mesh *mesh, waiting_pairs *made,
                              waiting_pairs *out) {
    if (status != CSCD_OK) {
        waiting_pairs_free(mesh, made);
        *made = (waiting_pairs){.former = NULL};
    }
    *out = *made;
    return status;
}

/* Is an object an obstacle no more? */
static bool frees_obstacles(const cscd_mesh_change *change) {
    for (uint32_t i = 0; i < change->objects.new_count; i++) {
        uint32_t origin = change->objects.to_old[i];
        if (origin != UINT32_MAX && change->old_mesh->objects[origin].obstacle &&
            !change->mesh->objects[i].obstacle)
            return true;
    }
    return false;
}

/* Then what the objects left out in the old mesh is remembered as if their rules had changed. */
static cscd_status free_obstacles(const former_maker *m, const cscd_mesh *old, const pair_rules *rules,
                                  waiting_pairs *out) {
    if (!frees_obstacles(m->change)) return CSCD_OK;
    cscd_status status = waiting_pairs_reserve(m->mesh, out);
    object_set *before = pair_rules_copy_sets(old, rules);
    object_set *sets = before != NULL ? move_sets_of_objects(before, m) : NULL;
    context_free(old->context, before);
    if (sets == NULL || status != CSCD_OK) {
        context_free(m->mesh->context, sets);
        return CSCD_OUT_OF_MEMORY;
    }
    waiting_pairs_uncover_objects(m->mesh, out, sets);
    return CSCD_OK;
}

cscd_status waiting_pairs_move(const waiting_pairs *w, const left_out_before *before, const cscd_mesh *mesh,
                               const cscd_mesh_change *change, waiting_pairs *out) {
    waiting_pairs moved = {.former = NULL};
    const former_maker maker = {mesh, change};
    cscd_status status = move_sets(w, mesh, change, &moved);
    if (status == CSCD_OK) status = part_neighbours(before->exclusions, mesh, change, &moved.torn);
    if (status == CSCD_OK) status = make_formers(&maker, w->former, &moved);
    if (status == CSCD_OK) status = free_obstacles(&maker, before->mesh, before->rules, &moved);
    return give_pairs(status, mesh, &moved, out);
}

static bool copy_set(cscd_context *context, const named_pair_set *from, named_pair_set *to) {
    *to = *from;
    array_list list = {{ARRAY(to->items, to->capacity)}};
    if (context_copy_all(context, list)) return true;
    *to = (named_pair_set){.items = NULL};
    return false;
}

cscd_status waiting_pairs_copy(const waiting_pairs *w, const cscd_mesh *mesh, waiting_pairs *out) {
    waiting_pairs copy = {.former = NULL};
    const former_maker maker = {mesh, NULL};
    bool sets =
        copy_set(mesh->context, &w->pairs, &copy.pairs) && copy_set(mesh->context, &w->torn, &copy.torn);
    cscd_status status = sets ? make_formers(&maker, w->former, &copy) : CSCD_OUT_OF_MEMORY;
    return give_pairs(status, mesh, &copy, out);
}
