/* Pairs of features that only triangles with a common vertex contain. */
#include "runtime/narrow_phase/narrow_phase.h"

#include <stdatomic.h>
#include <string.h>

typedef struct growing_list {
    uint32_t (*items)[2];
    size_t count, capacity;
} growing_list;

typedef struct orphan_search {
    const cscd_mesh *mesh;
    growing_list vf, ee;
    size_t most;
    atomic_size_t
        *grown; /* what the lists of all that share a search held whenever one grew, added up: at most twice
                           * what they hold now; NULL: nobody shares it */
    size_t looks, noted,
        looks_most;           /* triangles and stars that were looked at; how many *all_looks knows of */
    atomic_size_t *all_looks; /* of all that share the search; NULL: nobody shares it */
    bool out_of_memory;
    uint8_t *features;        /* per triangle, as orphan_search_features says; or NULL */
    uint32_t (*opposites)[2]; /* per edge: the corners opposite it; or NULL */
    bool *even;               /* per edge: orphan_edges_of finds its pairs with others of these; or NULL */

    /* In a mesh that was made from another one: pairs of features that are what they were are known. */
    const cscd_mesh_change *change; /* NULL: nothing is known */
    uint8_t *marks;                 /* per vertex, of objects that have changed */
} orphan_search;

/* If a vertex has very many triangles, the search takes the square of their number, whatever it finds. Then
 * it is given up as well: steps test pairs of adjacent triangles instead, of which the traversal leaves out
 * most there. An ordinary mesh takes some twenty looks for each triangle. */
enum { ORPHANS_PER_TRIANGLE = 8, LOOKS_PER_TRIANGLE = 256 };

/* In the place of an opposite corner: an edge of one triangle has no second one, and an edge of more than
 * two has many. */
enum { NO_CORNER = UINT32_MAX, MANY_CORNERS = UINT32_MAX - 1 };

/* Does every triangle at vertex v share a vertex with triangle f? */
static bool orphan_search_says_vertex(const cscd_mesh *mesh, uint32_t v, uint32_t f) {
    for (uint32_t i = mesh->vertex_star_offsets[v]; i < mesh->vertex_star_offsets[v + 1]; i++) {
        if (!triangles_share_vertex(mesh->triangles[mesh->vertex_stars[i]], mesh->triangles[f])) return false;
    }
    return true;
}

static bool are_orphan_edges(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    for (uint32_t i = mesh->edge_star_offsets[a]; i < mesh->edge_star_offsets[a + 1]; i++) {
        for (uint32_t j = mesh->edge_star_offsets[b]; j < mesh->edge_star_offsets[b + 1]; j++) {
            if (!triangles_share_vertex(mesh->triangles[mesh->edge_stars[i]],
                                        mesh->triangles[mesh->edge_stars[j]]))
                return false;
        }
    }
    return true;
}

/* ---- by the corners opposite edges ------------------------------------------------------------------------ */

/* Writes the corners opposite an edge: NO_CORNER in the second place for an edge of one triangle,
 * MANY_CORNERS for one of more than two. */
static void orphan_search_opposites(const cscd_mesh *mesh, uint32_t edge, uint32_t out[2]) {
    uint32_t begin = mesh->edge_star_offsets[edge], count = mesh->edge_star_offsets[edge + 1] - begin;
    out[0] = out[1] = NO_CORNER;
    for (uint32_t i = 0; i < count && i < 2; i++) {
        const uint32_t *corners = mesh->triangles[mesh->edge_stars[begin + i]], *ends = mesh->edges[edge];
        for (int k = 0; k < 3; k++) {
            if (corners[k] != ends[0] && corners[k] != ends[1]) out[i] = corners[k];
        }
    }
    if (count > 2) out[1] = MANY_CORNERS;
}

static bool is_end(const uint32_t edge[2], uint32_t vertex) {
    return edge[0] == vertex || edge[1] == vertex;
}

/* Two triangles at edges that share no vertex share one if the corner opposite the one edge is an end of the
 * other, or both corners are the same. As are_orphan_edges, without a look at the triangles. */
static bool opposites_say_orphan(const orphan_search *f, uint32_t a, uint32_t b) {
    const uint32_t *ends_a = f->mesh->edges[a], *ends_b = f->mesh->edges[b], *p = f->opposites[a],
                   *q = f->opposites[b];
    if (p[1] == MANY_CORNERS || q[1] == MANY_CORNERS) return are_orphan_edges(f->mesh, a, b);
    for (int i = 0; i < 2; i++) {
        if (p[i] == NO_CORNER || is_end(ends_b, p[i])) continue;
        for (int j = 0; j < 2; j++) {
            if (q[j] != NO_CORNER && !is_end(ends_a, q[j]) && p[i] != q[j]) return false;
        }
    }
    return true;
}

/* Is every triangle at edge a adjacent to every triangle at edge b, which shares no vertex with a? */
static bool orphan_search_says(const orphan_search *f, uint32_t a, uint32_t b) {
    return f->opposites != NULL ? opposites_say_orphan(f, a, b) : are_orphan_edges(f->mesh, a, b);
}

/* ---- the search --------------------------------------------------------------------------------------------- */

static bool all_have_enough(const orphan_search *f) {
    return f->grown != NULL && atomic_load_explicit(f->grown, memory_order_relaxed) > 2 * f->most;
}

static bool takes_too_long(const orphan_search *f) {
    return f->looks > f->looks_most ||
           (f->all_looks != NULL && atomic_load_explicit(f->all_looks, memory_order_relaxed) > f->looks_most);
}

/* There are too many, it takes too long, memory has run out, or the call is cancelled. */
static bool orphan_search_has_enough(const orphan_search *f) {
    return f->out_of_memory || f->vf.count + f->ee.count > f->most || all_have_enough(f) || takes_too_long(f);
}

enum { LOOKS_NOTED = 1 << 14 };

/* Counts looks at a number of triangles. */
static void orphan_search_look(orphan_search *f, size_t triangles) {
    f->looks += triangles;
    if (f->all_looks == NULL || f->looks - f->noted < LOOKS_NOTED) return;
    atomic_fetch_add_explicit(f->all_looks, f->looks - f->noted, memory_order_relaxed);
    f->noted = f->looks;
}

static void orphan_search_add(orphan_search *f, growing_list *list, uint32_t a, uint32_t b) {
    if (list->count == list->capacity) {
        size_t capacity = list->capacity * 2 + 64;
        uint32_t(*grown)[2] =
            context_grow(f->mesh->context, list->items, list->count, capacity, sizeof *list->items);
        f->out_of_memory |= grown == NULL;
        if (grown == NULL) return;
        if (f->grown != NULL) atomic_fetch_add(f->grown, list->count);
        list->items = grown;
        list->capacity = capacity;
    }
    list->items[list->count][0] = a;
    list->items[list->count++][1] = b;
}

/* Vertices whose triangles are not what they were, and those that have a triangle in common with one. */
enum { VERTEX_CHANGED = 1, VERTEX_NEAR = 2 };

static bool vertex_is_same(const orphan_search *f, uint32_t vertex) {
    return (f->marks[vertex] & VERTEX_CHANGED) == 0;
}

/* Its triangles are at both of its ends. */
static bool edge_is_same(const orphan_search *f, uint32_t edge) {
    const uint32_t *ends = f->mesh->edges[edge];
    return vertex_is_same(f, ends[0]) || vertex_is_same(f, ends[1]);
}

static bool vf_is_known(const orphan_search *f, uint32_t v, uint32_t t) {
    return f->change != NULL && vertex_is_same(f, v) && mesh_change_keeps(f->change, t);
}

static bool ee_is_known(const orphan_search *f, uint32_t a, uint32_t b) {
    return f->change != NULL && edge_is_same(f, a) && edge_is_same(f, b);
}

/* The features whose stars begin with a triangle: bit i for its vertex i, bit 3 + i for its edge i. */
static uint32_t orphan_search_features(const cscd_mesh *mesh, uint32_t t) {
    uint32_t features = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t vertex = mesh->triangles[t][i], edge = mesh->triangle_edges[t][i];
        features |= (uint32_t)(mesh->vertex_stars[mesh->vertex_star_offsets[vertex]] == t) << i;
        features |= (uint32_t)(mesh->edge_stars[mesh->edge_star_offsets[edge]] == t) << (3 + i);
    }
    return features;
}

/* The search of a whole mesh knows the features of all triangles beforehand. */
static uint32_t features_of(const orphan_search *f, uint32_t t) {
    return f->features != NULL ? f->features[t] : orphan_search_features(f->mesh, t);
}

static void find_edges_between(orphan_search *f, uint32_t t, uint32_t edges_t, uint32_t u, uint32_t edges_u) {
    const cscd_mesh *mesh = f->mesh;
    for (int i = 0; i < 9; i++) {
        if ((edges_t >> i / 3 & edges_u >> i % 3 & 1) == 0) continue;
        uint32_t a = mesh->triangle_edges[t][i / 3], b = mesh->triangle_edges[u][i % 3];
        if (f->even != NULL && f->even[a] && f->even[b]) continue;
        if (ee_is_known(f, a, b) || edges_share_vertex(mesh->edges[a], mesh->edges[b])) continue;
        if (orphan_search_says(f, a, b)) orphan_search_add(f, &f->ee, a < b ? a : b, a < b ? b : a);
    }
}

/* Pairs the features of t, whose stars begin with it, with features of triangle u; for edges u is the first
 * of the other star, too. So each pair is looked at once. */
static void find_between(orphan_search *f, uint32_t t, uint32_t features, uint32_t u) {
    const cscd_mesh *mesh = f->mesh;
    for (int i = 0; i < 3; i++) {
        uint32_t v = mesh->triangles[t][i];
        if ((features >> i & 1) != 0 && !vf_is_known(f, v, u) && !triangle_contains(mesh->triangles[u], v) &&
            orphan_search_says_vertex(mesh, v, u))
            orphan_search_add(f, &f->vf, v, u);
    }
    if (t < u && features >> 3 != 0) find_edges_between(f, t, features >> 3, u, features_of(f, u) >> 3);
}

static uint8_t marks_of(const orphan_search *f, uint32_t t) {
    const uint32_t *v = f->mesh->triangles[t];
    return f->marks[v[0]] | f->marks[v[1]] | f->marks[v[2]];
}

/* Has neither triangle a vertex that has changed? */
static bool pairs_are_known(const orphan_search *f, uint32_t t, uint32_t u) {
    return f->change != NULL && ((marks_of(f, t) | marks_of(f, u)) & VERTEX_CHANGED) == 0;
}

/* Looks at the pairs of one triangle with those adjacent to it. */
static void orphan_search_around(orphan_search *f, uint32_t t) {
    const cscd_mesh *mesh = f->mesh;
    const uint32_t *corners = mesh->triangles[t];
    uint32_t features = features_of(f, t);
    for (int i = 0; features != 0 && i < 3; i++) {
        uint32_t begin = mesh->vertex_star_offsets[corners[i]];
        uint32_t end = mesh->vertex_star_offsets[corners[i] + 1];
        orphan_search_look(f, end - begin);
        for (uint32_t s = begin; s < end; s++) {
            uint32_t u = mesh->vertex_stars[s];
            const uint32_t *other = mesh->triangles[u];
            bool seen = (i > 0 && triangle_contains(other, corners[0])) ||
                        (i > 1 && triangle_contains(other, corners[1]));
            if (u != t && !seen && !pairs_are_known(f, t, u)) find_between(f, t, features, u);
        }
        if (orphan_search_has_enough(f)) return;
    }
}

/* ---- where each edge has two triangles ------------------------------------------------------------------ */

/* Orphan pairs where each edge has two triangles, by the few features that can be one.
 *
 * Let a and b be edges without a common vertex, p and p' the corners opposite a, q and q' those opposite b. They are an orphan
 * pair if each triangle at a shares a vertex with each one at b: for every choice of one of p, p' and one of q, q' the first
 * lies in b, or the second in a, or they are the same. With p != p' and q != q' this leaves three cases:
 * - p and p' are the ends of b;
 * - q and q' are the ends of a;
 * - else one of p, p' is not in b, say p', and one of q, q' is not in a, say q'. So p' = q'. By p and q', p lies in b; by p' and
 *   q, q lies in a. So b is an edge at p of a triangle (p, q, x) that follows the triangle (a, p) across its edge (p, q), and
 *   the other corner opposite b is p'.
 *
 * A triangle f that shares a vertex with every triangle at a vertex v, and has not v itself, has a vertex on each of them. Each
 * vertex of f lies on at most two triangles at v, so v has at most six. */
enum { NO_EDGE = UINT32_MAX, TRIANGLES_AT_MOST = 6 };

static bool has_two_triangles(const uint32_t opposites[2]) {
    return opposites[0] < MANY_CORNERS && opposites[1] < MANY_CORNERS && opposites[0] != opposites[1];
}

static void mark_corners(const uint32_t triangle[3], bool *vertices) {
    for (int i = 0; i < 3; i++) vertices[triangle[i]] = true;
}

/* Marks the corners of triangles one of whose edges is not in the set. */
static void mark_beside(const cscd_mesh *mesh, const bool *edges, bool *vertices) {
    memset(vertices, 0, mesh->vertex_count * sizeof *vertices);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *e = mesh->triangle_edges[t];
        if (!edges[e[0]] || !edges[e[1]] || !edges[e[2]]) mark_corners(mesh->triangles[t], vertices);
    }
}

/* Fills in f->even: the edges of which the search below finds the pairs with one another. An edge is even if
 * it and all edges of the triangles at its ends have two triangles each. uneven: of vertices, those of
 * triangles that have another edge. f->opposites is known. */
static void orphan_edges_mark(const orphan_search *f, bool *uneven) {
    const cscd_mesh *mesh = f->mesh;
    for (uint32_t e = 0; e < mesh->edge_count; e++) f->even[e] = has_two_triangles(f->opposites[e]);
    mark_beside(mesh, f->even, uneven);
    for (uint32_t e = 0; e < mesh->edge_count; e++)
        f->even[e] = f->even[e] && !uneven[mesh->edges[e][0]] && !uneven[mesh->edges[e][1]];
    mark_beside(mesh, f->even, uneven);
}

/* Is a triangle near an edge that is not even, so that all of its pairs with adjacent triangles have to be
 * looked at? */
static bool orphan_edges_near(const cscd_mesh *mesh, const bool *uneven, uint32_t t) {
    const uint32_t *v = mesh->triangles[t];
    return uneven[v[0]] || uneven[v[1]] || uneven[v[2]];
}

/* Returns the edge of a triangle that joins two of its corners. */
static uint32_t edge_in(const cscd_mesh *mesh, uint32_t triangle, uint32_t v, uint32_t w) {
    for (int i = 0; i < 3; i++) {
        const uint32_t *ends = mesh->edges[mesh->triangle_edges[triangle][i]];
        if ((ends[0] == v && ends[1] == w) || (ends[0] == w && ends[1] == v))
            return mesh->triangle_edges[triangle][i];
    }
    return NO_EDGE;
}

static uint32_t edge_between(const cscd_mesh *mesh, uint32_t v, uint32_t w) {
    for (uint32_t i = mesh->vertex_star_offsets[v]; i < mesh->vertex_star_offsets[v + 1]; i++) {
        uint32_t triangle = mesh->vertex_stars[i];
        if (triangle_contains(mesh->triangles[triangle], w)) return edge_in(mesh, triangle, v, w);
    }
    return NO_EDGE;
}

static uint32_t star_size(const cscd_mesh *mesh, uint32_t vertex) {
    return mesh->vertex_star_offsets[vertex + 1] - mesh->vertex_star_offsets[vertex];
}

static uint32_t other_of(const uint32_t two[2], uint32_t one) {
    return two[0] == one ? two[1] : two[0];
}

static void add_edges(orphan_search *f, uint32_t a, uint32_t b) {
    orphan_search_add(f, &f->ee, a < b ? a : b, a < b ? b : a);
}

/* The corners opposite a are the ends of b. If the same holds the other way round, the pair is found
 * twice. */
static void find_across(orphan_search *f, uint32_t a) {
    const uint32_t *ends = f->mesh->edges[a], *p = f->opposites[a];
    orphan_search_look(f, star_size(f->mesh, p[0]));
    uint32_t b = edge_between(f->mesh, p[0], p[1]);
    if (b == NO_EDGE || !f->even[b]) return;
    const uint32_t *q = f->opposites[b];
    bool both = (q[0] == ends[0] && q[1] == ends[1]) || (q[0] == ends[1] && q[1] == ends[0]);
    if (!both || a < b) add_edges(f, a, b);
}

/* The third case, for one corner p opposite a, in this triangle, and one end q of a. Each pair is found from
 * both edges. */
static void find_beside(orphan_search *f, uint32_t a, uint32_t triangle, uint32_t p, uint32_t q) {
    const cscd_mesh *mesh = f->mesh;
    uint32_t shared = edge_in(mesh, triangle, p, q);
    uint32_t next = other_of(mesh->edge_stars + mesh->edge_star_offsets[shared], triangle);
    uint32_t x = other_of(f->opposites[shared], other_of(mesh->edges[a], q));
    uint32_t b = edge_in(mesh, next, p, x);
    if (a < b && f->even[b] && other_of(f->opposites[b], q) == other_of(f->opposites[a], p))
        add_edges(f, a, b);
}

static void find_pairs_of(orphan_search *f, uint32_t a) {
    const cscd_mesh *mesh = f->mesh;
    const uint32_t *triangles = mesh->edge_stars + mesh->edge_star_offsets[a];
    find_across(f, a);
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 2; k++) find_beside(f, a, triangles[i], f->opposites[a][i], mesh->edges[a][k]);
    }
}

/* Adds the pairs of even edges with one another, for the edges whose stars begin with a triangle. */
static void orphan_edges_of(orphan_search *f, uint32_t t) {
    for (int i = 0; i < 3; i++) {
        uint32_t edge = f->mesh->triangle_edges[t][i];
        if ((f->features[t] >> (3 + i) & 1) != 0 && f->even[edge]) find_pairs_of(f, edge);
    }
}

/* Looks at the triangles at one corner of a triangle at v that have neither v nor the other corner, if there
 * is one. */
static void find_faces_at(orphan_search *f, uint32_t v, uint32_t corner, uint32_t other) {
    const cscd_mesh *mesh = f->mesh;
    orphan_search_look(f, star_size(mesh, corner));
    for (uint32_t i = mesh->vertex_star_offsets[corner]; i < mesh->vertex_star_offsets[corner + 1]; i++) {
        uint32_t u = mesh->vertex_stars[i];
        const uint32_t *corners = mesh->triangles[u];
        if (!triangle_contains(corners, v) && !triangle_contains(corners, other) &&
            orphan_search_says_vertex(mesh, v, u))
            orphan_search_add(f, &f->vf, v, u);
    }
}

/* Adds the pairs of the vertices whose stars begin with a triangle that is not near an uneven edge. A
 * triangle of an orphan pair shares a vertex with the first triangle at v, so one of its other two corners. */
static void orphan_edges_vertices(orphan_search *f, uint32_t t) {
    const cscd_mesh *mesh = f->mesh;
    for (int i = 0; i < 3; i++) {
        uint32_t v = mesh->triangles[t][i];
        if ((f->features[t] >> i & 1) == 0) continue;
        if (mesh->vertex_star_offsets[v + 1] - mesh->vertex_star_offsets[v] > TRIANGLES_AT_MOST) continue;
        uint32_t p = mesh->triangles[t][(i + 1) % 3], q = mesh->triangles[t][(i + 2) % 3];
        find_faces_at(f, v, p, UINT32_MAX);
        find_faces_at(f, v, q, p);
    }
}

/* ---- a whole mesh, on all threads ---------------------------------------------------------------------- */

enum { TRIANGLES_PER_ASK = 256, TRIANGLES_PER_TASK = 1 << 14, EDGES_PER_TASK = 3 * TRIANGLES_PER_TASK / 2 };

/* Each task looks at some triangles. All tasks know the same, and each has lists of its own. */
typedef struct whole_search {
    const cscd_mesh *mesh;
    orphan_search *tasks;
    bool *uneven;
    uint32_t task_count;
    atomic_size_t grown, looks;
} whole_search;

typedef struct feature_range {
    uint32_t begin, end;
} feature_range;

static feature_range range_of_task(uint32_t task, uint32_t each, uint32_t count) {
    uint32_t begin = task * each < count ? task * each : count;
    return (feature_range){begin, count - begin < each ? count : begin + each};
}

static void find_features(void *data, uint32_t task) {
    const whole_search *whole = data;
    feature_range range = range_of_task(task, TRIANGLES_PER_TASK, whole->mesh->triangle_count);
    for (uint32_t t = range.begin; t < range.end; t++)
        whole->tasks[0].features[t] = (uint8_t)orphan_search_features(whole->mesh, t);
}

static void find_corners(void *data, uint32_t task) {
    const whole_search *whole = data;
    feature_range range = range_of_task(task, EDGES_PER_TASK, whole->mesh->edge_count);
    for (uint32_t e = range.begin; e < range.end; e++)
        orphan_search_opposites(whole->mesh, e, whole->tasks[0].opposites[e]);
}

static void search_triangles(void *data, uint32_t task) {
    const whole_search *whole = data;
    orphan_search *f = &whole->tasks[task];
    feature_range range = range_of_task(task, TRIANGLES_PER_TASK, whole->mesh->triangle_count);
    progress *p = &whole->mesh->context->progress;
    for (uint32_t t = range.begin; t < range.end && !orphan_search_has_enough(f); t++) {
        if ((t - range.begin) % TRIANGLES_PER_ASK == 0 && !progress_go_on(p, 0.0)) return;
        if (triangle_of_obstacle(whole->mesh, t)) continue;
        if (orphan_edges_near(whole->mesh, whole->uneven, t))
            orphan_search_around(f, t);
        else
            orphan_edges_vertices(f, t);
        orphan_edges_of(f, t);
    }
}

static void append_list(growing_list *list, uint32_t (*all)[2], size_t *count) {
    for (size_t i = 0; i < list->count; i++) copy_vertices(list->items[i], 2, all[(*count)++]);
}

/* Joins the lists in the order of the tasks. */
static cscd_status join_lists(const whole_search *whole, orphan_pairs *out) {
    orphan_pairs all = {.vf = NULL};
    size_t vf = 0, ee = 0;
    for (uint32_t i = 0; i < whole->task_count; i++) {
        vf += whole->tasks[i].vf.count;
        ee += whole->tasks[i].ee.count;
    }
    array_list lists = {{ARRAY(all.vf, vf), ARRAY(all.ee, ee)}};
    if (!context_reserve_all(whole->mesh->context, lists)) return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < whole->task_count; i++) {
        append_list(&whole->tasks[i].vf, all.vf, &all.vf_count);
        append_list(&whole->tasks[i].ee, all.ee, &all.ee_count);
    }
    *out = all;
    return CSCD_OK;
}

static cscd_status end_whole(const whole_search *whole, orphan_pairs *out, bool *too_many) {
    cscd_context *context = whole->mesh->context;
    size_t count = 0, looks = 0;
    bool failed = false, enough = false;
    for (uint32_t i = 0; i < whole->task_count; i++) {
        const orphan_search *f = &whole->tasks[i];
        count += f->vf.count + f->ee.count;
        looks += f->looks;
        failed |= f->out_of_memory;
        enough |= orphan_search_has_enough(f);
    }
    *too_many = !failed && (enough || count > whole->tasks[0].most || looks > whole->tasks[0].looks_most);
    cscd_status status = failed ? CSCD_OUT_OF_MEMORY : CSCD_OK;
    if (status == CSCD_OK && !*too_many) status = join_lists(whole, out);
    for (uint32_t i = 0; i < whole->task_count; i++) {
        context_free(context, whole->tasks[i].vf.items);
        context_free(context, whole->tasks[i].ee.items);
    }
    return status;
}

static void search_whole(whole_search *whole, const orphan_search *known) {
    parallel *threads = whole->mesh->context->threads;
    uint32_t edge_tasks = (whole->mesh->edge_count + EDGES_PER_TASK - 1) / EDGES_PER_TASK;
    for (uint32_t i = 0; i < whole->task_count; i++) whole->tasks[i] = *known;
    parallel_run(threads, whole->task_count, find_features, whole);
    parallel_run(threads, edge_tasks, find_corners, whole);
    orphan_edges_mark(known, whole->uneven);
    parallel_run(threads, whole->task_count, search_triangles, whole);
}

cscd_status orphan_pairs_create(const cscd_mesh *mesh, orphan_pairs *out, bool *too_many) {
    whole_search whole = {.mesh = mesh, .task_count = mesh->triangle_count / TRIANGLES_PER_TASK + 1};
    orphan_search known = {.mesh = mesh,
                           .most = (size_t)mesh->triangle_count * ORPHANS_PER_TRIANGLE,
                           .looks_most = (size_t)mesh->triangle_count * LOOKS_PER_TRIANGLE,
                           .grown = &whole.grown,
                           .all_looks = &whole.looks};
    atomic_init(&whole.grown, 0);
    atomic_init(&whole.looks, 0);
    *out = (orphan_pairs){.vf = NULL};
    array_list arrays = {{ARRAY(known.features, mesh->triangle_count),
                          ARRAY(known.opposites, mesh->edge_count), ARRAY(known.even, mesh->edge_count),
                          ARRAY(whole.uneven, mesh->vertex_count), ARRAY(whole.tasks, whole.task_count)}};
    /* Zeros say of a triangle or an edge that a host's loop has left out that nothing is to be found there. */
    if (!context_allocate_all(mesh->context, arrays)) return CSCD_OUT_OF_MEMORY;
    progress_outer outer = progress_enter(&mesh->context->progress, "orphan pairs");
    search_whole(&whole, &known);
    progress_leave(&mesh->context->progress, outer);
    cscd_status status = end_whole(&whole, out, too_many);
    if (status == CSCD_OK) status = context_progress_status(mesh->context);
    if (status != CSCD_OK) orphan_pairs_free(mesh->context, out);
    context_free_all(mesh->context, arrays);
    return status;
}

/* ---- a mesh that was made from another one --------------------------------------------------------------- */

/* An obstacle has no pairs, so nothing is known of an object that was one. */
static bool was_obstacle(const cscd_mesh_change *change, const object_range *range) {
    uint32_t origin = change->objects.to_old[cscd_mesh_vertex_object(change->mesh, range->vertex)];
    return origin != UINT32_MAX && change->old_mesh->objects[origin].obstacle;
}

/* A vertex is what it was if all its triangles are, and if it has as many. */
static void mark_changed(orphan_search *f, const object_range *range) {
    const cscd_mesh_change *change = f->change;
    bool all = was_obstacle(change, range);
    for (uint32_t v = range->vertex; v < range->vertex + range->vertex_count; v++) {
        uint32_t origin = change->vertices.to_old[v];
        bool same = !all && origin != UINT32_MAX && change->vertices.to_new[origin] == v &&
                    star_size(change->old_mesh, origin) == star_size(f->mesh, v);
        if (!same) f->marks[v] |= VERTEX_CHANGED;
    }
    for (uint32_t t = range->triangle; t < range->triangle + range->triangle_count; t++) {
        if (mesh_change_keeps(change, t)) continue;
        for (int i = 0; i < 3; i++) f->marks[f->mesh->triangles[t][i]] |= VERTEX_CHANGED;
    }
}

/* A pair that is not known has a feature at changed vertices only, or a triangle whose vertices have
 * changed. So one of its two adjacent triangles has a changed vertex, and both have a vertex that is near. */
static void find_in_object(orphan_search *f, const object_range *range) {
    uint32_t end = range->triangle + range->triangle_count;
    mark_changed(f, range);
    for (uint32_t t = range->triangle; t < end; t++) {
        for (int i = 0; (marks_of(f, t) & VERTEX_CHANGED) != 0 && i < 3; i++)
            f->marks[f->mesh->triangles[t][i]] |= VERTEX_NEAR;
    }
    for (uint32_t t = range->triangle; t < end && !orphan_search_has_enough(f); t++) {
        if ((marks_of(f, t) & VERTEX_NEAR) != 0 && !triangle_of_obstacle(f->mesh, t))
            orphan_search_around(f, t);
    }
}

static void keep_vf(orphan_search *f, uint32_t v, uint32_t t) {
    if (v != UINT32_MAX && t != UINT32_MAX && vf_is_known(f, v, t) && !triangle_of_obstacle(f->mesh, t))
        orphan_search_add(f, &f->vf, v, t);
}

static void keep_ee(orphan_search *f, uint32_t a, uint32_t b) {
    if (a == UINT32_MAX || b == UINT32_MAX || !ee_is_known(f, a, b)) return;
    if (!triangle_of_obstacle(f->mesh, f->mesh->edge_stars[f->mesh->edge_star_offsets[a]]))
        orphan_search_add(f, &f->ee, a < b ? a : b, a < b ? b : a);
}

/* Objects that have not changed keep all of their pairs. */
static void keep_known(orphan_search *f, const orphan_pairs *pairs) {
    const number_map *vertices = &f->change->vertices, *edges = &f->change->edges,
                     *triangles = &f->change->triangles;
    for (size_t i = 0; i < pairs->vf_count && !orphan_search_has_enough(f); i++) {
        uint32_t v = pairs->vf[i][0], t = pairs->vf[i][1];
        if (number_map_run(triangles, t) != NULL)
            orphan_search_add(f, &f->vf, number_map_to_new(vertices, v), number_map_to_new(triangles, t));
        else
            keep_vf(f, vertices->to_new[v], triangles->to_new[t]);
    }
    for (size_t i = 0; i < pairs->ee_count && !orphan_search_has_enough(f); i++) {
        uint32_t a = pairs->ee[i][0], b = pairs->ee[i][1];
        if (number_map_run(edges, a) != NULL)
            orphan_search_add(f, &f->ee, number_map_to_new(edges, a), number_map_to_new(edges, b));
        else
            keep_ee(f, edges->to_new[a], edges->to_new[b]);
    }
}

static cscd_status end_search(const orphan_search *f, orphan_pairs *out, bool *too_many) {
    *out = (orphan_pairs){f->vf.items, f->ee.items, f->vf.count, f->ee.count};
    *too_many = orphan_search_has_enough(f) && !f->out_of_memory;
    if (orphan_search_has_enough(f)) orphan_pairs_free(f->mesh->context, out);
    return f->out_of_memory ? CSCD_OUT_OF_MEMORY : CSCD_OK;
}

cscd_status orphan_pairs_move(const orphan_pairs *pairs, const cscd_mesh *mesh,
                              const cscd_mesh_change *change, orphan_pairs *out, bool *too_many) {
    orphan_search f = {.mesh = mesh,
                       .most = (size_t)mesh->triangle_count * ORPHANS_PER_TRIANGLE,
                       .looks_most = (size_t)mesh->triangle_count * LOOKS_PER_TRIANGLE,
                       .change = change,
                       .marks = context_allocate(mesh->context, mesh->vertex_count, sizeof *f.marks)};
    if (f.marks == NULL) return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < change->described_count; i++) {
        if (change->described[i].triangle_count > 0) find_in_object(&f, &change->described[i]);
    }
    keep_known(&f, pairs);
    context_free(mesh->context, f.marks);
    return end_search(&f, out, too_many);
}

cscd_status orphan_pairs_copy(const orphan_pairs *pairs, cscd_context *context, orphan_pairs *out) {
    orphan_pairs copy = *pairs;
    array_list list = {{ARRAY(copy.vf, copy.vf_count), ARRAY(copy.ee, copy.ee_count)}};
    if (!context_copy_all(context, list)) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}

void orphan_pairs_free(cscd_context *context, orphan_pairs *pairs) {
    context_free(context, pairs->vf);
    context_free(context, pairs->ee);
    *pairs = (orphan_pairs){.vf_count = 0};
}
