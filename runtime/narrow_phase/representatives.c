/* Picks the one triangle pair that tests a feature pair, so that no feature pair is tested twice. */
#include "runtime/narrow_phase/representatives.h"

#include "runtime/narrow_phase/narrow_phase.h"
#include "runtime/narrow_phase/narrow_phase_kernels.h"

#include <assert.h>
#include <string.h>

/* The kernel marks the undecided features of up to 256 pairs at a time. */
enum { PAIRS_AT_ONCE = 256 };

/* ---- ring marks --------------------------------------------------------------------------------------- */

/* With patches of 128 vertices, a mark of cloth has 1.7 bits in the mean; with smaller patches it has more
 * of them, and larger ones hold more pairs of triangles that are far from each other. Between 32 and 256
 * vertices it makes little difference. */
enum { PATCH_VERTICES = 128, MARK_BITS = 64 - RING_MARK_FIRST_BIT, UNASSIGNED = 255 };

/* The patches of the vertices of one object. */
typedef struct vertex_patches {
    const cscd_mesh *mesh;
    uint32_t first_vertex;
    uint8_t *bits;   /* of each vertex's patch */
    uint64_t *rings; /* per vertex: those of all triangles at it */
} vertex_patches;

/* Gives a patch to the free vertices around one of it, up to a number of vertices. */
static uint32_t extend_patch(vertex_patches *p, uint32_t vertex, uint8_t bit, uint32_t *members,
                             uint32_t count) {
    const cscd_mesh *mesh = p->mesh;
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        const uint32_t *corners = mesh->triangles[mesh->vertex_stars[i]];
        for (int k = 0; k < 3 && count < PATCH_VERTICES; k++) {
            uint8_t *other = &p->bits[corners[k] - p->first_vertex];
            if (*other != UNASSIGNED) continue;
            *other = bit;
            members[count++] = corners[k];
        }
    }
    return count;
}

/* Lets patches grow from the first free vertex on, one after the other, the nearest vertices first. */
static void cut_patches(vertex_patches *p, uint32_t vertex_count) {
    uint32_t patch = 0, members[PATCH_VERTICES];
    memset(p->bits, UNASSIGNED, vertex_count);
    for (uint32_t v = 0; v < vertex_count; v++) {
        if (p->bits[v] != UNASSIGNED) continue;
        uint8_t bit = (uint8_t)(patch++ % MARK_BITS);
        uint32_t count = 1;
        p->bits[v] = bit;
        members[0] = p->first_vertex + v;
        for (uint32_t next = 0; next < count; next++)
            count = extend_patch(p, members[next], bit, members, count);
    }
}

static uint64_t bit_of_vertex(const vertex_patches *p, uint32_t vertex) {
    return (uint64_t)1 << (RING_MARK_FIRST_BIT + p->bits[vertex - p->first_vertex]);
}

static void collect_rings(vertex_patches *p, const object_range *range, uint64_t *marks) {
    uint32_t begin = range->triangle, end = begin + range->triangle_count;
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])p->mesh->triangles;
    for (uint32_t t = begin; t < end; t++) {
        uint64_t bits = 0;
        for (int k = 0; k < 3; k++) bits |= bit_of_vertex(p, triangles[t][k]);
        for (int k = 0; k < 3; k++) p->rings[triangles[t][k] - p->first_vertex] |= bits;
    }
    for (uint32_t t = begin; t < end; t++) {
        for (int k = 0; k < 3; k++) marks[t] |= p->rings[triangles[t][k] - p->first_vertex];
    }
}

cscd_status ring_marks_add(const cscd_mesh *mesh, const object_range *range, uint64_t *marks) {
    vertex_patches p = {.mesh = mesh, .first_vertex = range->vertex};
    array_list arrays = {{ARRAY(p.bits, range->vertex_count), ARRAY(p.rings, range->vertex_count)}};
    if (range->triangle_count == 0) return CSCD_OK;
    if (!context_allocate_all(mesh->context, arrays)) return CSCD_OUT_OF_MEMORY;
    cut_patches(&p, range->vertex_count);
    collect_rings(&p, range, marks);
    context_free(mesh->context, p.bits);
    context_free(mesh->context, p.rings);
    return CSCD_OK;
}

/* ---- which triangle represents which feature ---------------------------------------------------------- */

static array_list list_arrays(const cscd_mesh *mesh, representatives *r) {
    return (array_list){{ARRAY(r->marks, mesh->triangle_count), ARRAY(r->others, mesh->vertex_count),
                         ARRAY(r->opposite, mesh->edge_count)}};
}

/* Notes which features these triangles represent. */
static void represent_features(const cscd_mesh *mesh, uint32_t begin, uint32_t end, representatives *r) {
    for (uint32_t t = begin; t < end; t++) {
        for (int i = 0; i < 3; i++) {
            const uint32_t *corners = mesh->triangles[t];
            uint32_t vertex = corners[i], edge = mesh->triangle_edges[t][i];
            bool first_at_vertex = mesh->vertex_stars[mesh->vertex_star_offsets[vertex]] == t;
            bool first_at_edge = mesh->edge_stars[mesh->edge_star_offsets[edge]] == t;
            r->marks[t] |= (uint64_t)first_at_vertex << i | (uint64_t)first_at_edge << (3 + i);
            for (int k = 0; first_at_vertex && k < 2; k++) r->others[vertex][k] = corners[(i + 1 + k) % 3];
            if (first_at_edge) r->opposite[edge] = corners[(i + 2) % 3];
        }
    }
}

cscd_status representatives_create(const cscd_mesh *mesh, representatives *out) {
    representatives r;
    const object_range all = {.vertex_count = mesh->vertex_count, .triangle_count = mesh->triangle_count};
    if (!context_allocate_all(mesh->context, list_arrays(mesh, &r))) return CSCD_OUT_OF_MEMORY;
    represent_features(mesh, 0, mesh->triangle_count, &r);
    cscd_status status = ring_marks_add(mesh, &all, r.marks);
    if (status == CSCD_OK)
        *out = r;
    else
        representatives_free(mesh->context, &r);
    return status;
}

static void copy_run(const representatives *r, const object_run *run, representatives *out) {
    uint32_t by = run->to.vertex - run->from.vertex;
    memcpy(out->marks + run->to.triangle, r->marks + run->from.triangle,
           run->from.triangle_count * sizeof *r->marks);
    copy_shifted(r->others[run->from.vertex], (size_t)run->from.vertex_count * 2, by,
                 out->others[run->to.vertex]);
    copy_shifted(r->opposite + run->from.edge, run->from.edge_count, by, out->opposite + run->to.edge);
}

cscd_status representatives_move(const representatives *r, const cscd_mesh *mesh,
                                 const cscd_mesh_change *change, representatives *out) {
    representatives moved;
    cscd_status status = CSCD_OK;
    if (!context_reserve_all(mesh->context, list_arrays(mesh, &moved))) return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < change->run_count; i++) copy_run(r, &change->runs[i], &moved);
    for (uint32_t i = 0; i < change->described_count && status == CSCD_OK; i++) {
        const object_range *range = &change->described[i];
        memset(moved.marks + range->triangle, 0, range->triangle_count * sizeof *moved.marks);
        memset(moved.others + range->vertex, 0, range->vertex_count * sizeof *moved.others);
        represent_features(mesh, range->triangle, range->triangle + range->triangle_count, &moved);
        status = ring_marks_add(mesh, range, moved.marks);
    }
    if (status == CSCD_OK)
        *out = moved;
    else
        representatives_free(mesh->context, &moved);
    return status;
}

cscd_status representatives_copy(const representatives *r, const cscd_mesh *mesh, representatives *out) {
    representatives copy = *r;
    if (!context_copy_all(mesh->context, list_arrays(mesh, &copy))) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}

void representatives_free(cscd_context *context, representatives *r) {
    context_free(context, r->marks);
    context_free(context, r->others);
    context_free(context, r->opposite);
    *r = (representatives){.marks = NULL};
}

/* ---- without culling ----------------------------------------------------------------------------------- */

/* Pairs of adjacent triangles may not be reached. So the first pair in the order of the stars that shares no
 * vertex tests the features: the pair of the representatives, or, where these are adjacent, a later one. */

/* Does every triangle before `of` in the star share a vertex with the face? */
static bool first_at_vertex(const cscd_mesh *mesh, uint32_t of, uint32_t vertex, const uint32_t face[3]) {
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        uint32_t s = mesh->vertex_stars[i];
        if (s == of) return true;
        if (!triangles_share_vertex(mesh->triangles[s], face)) return false;
    }
    return false;
}

/* pair.a contains the edge of the smaller number. */
static bool first_at_edges(const cscd_mesh *mesh, triangle_pair pair, uint32_t a, uint32_t b) {
    for (uint32_t i = mesh->edge_star_offsets[a]; i < mesh->edge_star_offsets[a + 1]; i++) {
        for (uint32_t j = mesh->edge_star_offsets[b]; j < mesh->edge_star_offsets[b + 1]; j++) {
            uint32_t s = mesh->edge_stars[i], t = mesh->edge_stars[j];
            if (s == pair.a && t == pair.b) return true;
            if (!triangles_share_vertex(mesh->triangles[s], mesh->triangles[t])) return false;
        }
    }
    return false;
}

/* Does the pair test a pair of features whose representatives are adjacent? */
static bool first_without_shared_vertex(const cscd_mesh *mesh, triangle_pair pair, int bit) {
    const uint32_t *a = mesh->triangles[pair.a], *b = mesh->triangles[pair.b];
    if (bit < FEATURE_VERTEX_B) return first_at_vertex(mesh, pair.a, a[bit], b);
    if (bit < FEATURE_EDGES) return first_at_vertex(mesh, pair.b, b[bit - FEATURE_VERTEX_B], a);
    int i = (bit - FEATURE_EDGES) / 3, j = (bit - FEATURE_EDGES) % 3;
    uint32_t edge_a = mesh->triangle_edges[pair.a][i], edge_b = mesh->triangle_edges[pair.b][j];
    if (edge_a < edge_b) return first_at_edges(mesh, pair, edge_a, edge_b);
    return first_at_edges(mesh, (triangle_pair){pair.b, pair.a}, edge_b, edge_a);
}

static void select_represented(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                               uint16_t *features) {
    const cscd_mesh *mesh = interval->mesh;
    assert(count <= PAIRS_AT_ONCE);
    uint16_t undecided[PAIRS_AT_ONCE];
    narrow_phase_kernels_of(mesh->context)
        ->represent(mesh, interval->representatives, pairs, count, features, undecided);
    if (!interval->skip_adjacent) return;
    for (uint32_t p = 0; p < count; p++) {
        for (uint32_t rest = undecided[p]; rest != 0; rest &= rest - 1) {
            int bit = __builtin_ctz(rest);
            features[p] |= (uint16_t)(first_without_shared_vertex(mesh, pairs[p], bit) << bit);
        }
    }
}

/* ---- with culling -------------------------------------------------------------------------------------- */

/* The first pair in the order of the stars that the flags keep tests the features. It is reached, because its
 * volumes contain those of the features. In a closing pass no pair tests them if the earlier flags kept one:
 * then they have been tested already. */
static bool first_kept_vertex(const swept_interval *interval, uint32_t of, int corner, uint32_t against) {
    const cscd_mesh *mesh = interval->mesh;
    uint32_t vertex = mesh->triangles[of][corner], first = UINT32_MAX;
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        uint32_t s = mesh->vertex_stars[i];
        if (first == UINT32_MAX && culling_keeps(interval->culling, s, against)) {
            first = s;
            if (first != of || !interval->closing_pass) break;
        }
        if (interval->closing_pass && culling_kept(interval->culling, s, against)) return false;
    }
    return first == of;
}

/* pair.a contains the edge of the smaller number. */
static bool first_kept_edges(const swept_interval *interval, triangle_pair pair, uint32_t a, uint32_t b) {
    const cscd_mesh *mesh = interval->mesh;
    uint32_t begin_a = mesh->edge_star_offsets[a], end_a = mesh->edge_star_offsets[a + 1];
    uint32_t begin_b = mesh->edge_star_offsets[b], end_b = mesh->edge_star_offsets[b + 1];
    bool found = false;
    for (uint32_t i = begin_a; i < end_a; i++) {
        for (uint32_t j = begin_b; j < end_b; j++) {
            uint32_t s = mesh->edge_stars[i], t = mesh->edge_stars[j];
            if (!found && culling_keeps(interval->culling, s, t)) {
                if (s != pair.a || t != pair.b) return false;
                if (!interval->closing_pass) return true;
                found = true;
            }
            if (interval->closing_pass && culling_kept(interval->culling, s, t)) return false;
        }
    }
    return found;
}

static bool first_kept(const swept_interval *interval, triangle_pair pair, int bit) {
    if (bit < FEATURE_VERTEX_B) return first_kept_vertex(interval, pair.a, bit, pair.b);
    if (bit < FEATURE_EDGES) return first_kept_vertex(interval, pair.b, bit - FEATURE_VERTEX_B, pair.a);
    int i = (bit - FEATURE_EDGES) / 3, j = (bit - FEATURE_EDGES) % 3;
    uint32_t a = interval->mesh->triangle_edges[pair.a][i], b = interval->mesh->triangle_edges[pair.b][j];
    if (a < b) return first_kept_edges(interval, pair, a, b);
    return first_kept_edges(interval, (triangle_pair){pair.b, pair.a}, b, a);
}

static uint32_t select_kept(const swept_interval *interval, triangle_pair pair, uint32_t features) {
    uint32_t kept = 0;
    for (uint32_t rest = features; rest != 0; rest &= rest - 1) {
        int bit = __builtin_ctz(rest);
        kept |= (uint32_t)first_kept(interval, pair, bit) << bit;
    }
    return kept;
}

/* ---- either -------------------------------------------------------------------------------------------- */

/* Pairs that the flags do not choose among, and the places that their features go to. */
typedef struct other_pairs {
    triangle_pair pairs[PAIRS_AT_ONCE];
    uint16_t features[PAIRS_AT_ONCE], *places[PAIRS_AT_ONCE];
    uint32_t count;
} other_pairs;

static void select_others(const swept_interval *interval, other_pairs *others) {
    select_represented(interval, others->pairs, others->count, others->features);
    for (uint32_t i = 0; i < others->count; i++) *others->places[i] = others->features[i];
    others->count = 0;
}

/* Two triangles of one component that is culled. */
static bool flags_choose(const swept_interval *interval, triangle_pair pair) {
    const uint32_t *components = interval->mesh->triangle_components;
    return !interval->skip_adjacent ||
           (components[pair.a] == components[pair.b] && interval->culled[components[pair.a]]);
}

/* Bits 0, 1 and 2 go to places 0, 3 and 6. */
static uint32_t spread_by_three(uint32_t edges) {
    return (edges & 1u) | (edges & 2u) << 2 | (edges & 4u) << 4;
}

pair_selection representatives_select_early(const swept_interval *interval, triangle_pair pair) {
    const representatives *r = interval->representatives;
    if (interval->culling != NULL && flags_choose(interval, pair))
        return (pair_selection){FEATURE_ALL, false};
    if (interval->skip_adjacent && rings_may_touch(r->marks[pair.a], r->marks[pair.b]))
        return (pair_selection){FEATURE_ALL, false};
    uint32_t a = represented_features(r, pair.a), b = represented_features(r, pair.b);
    uint32_t features =
        (a & 7u) | (b & 7u) << FEATURE_VERTEX_B | (spread_by_three(a >> 3) * (b >> 3)) << FEATURE_EDGES;
    return (pair_selection){(uint16_t)features, interval->skip_adjacent};
}

void representatives_select(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                            uint16_t *features) {
    if (interval->culling == NULL) {
        for (uint32_t p = 0; p < count; p += PAIRS_AT_ONCE)
            select_represented(interval, pairs + p, count - p < PAIRS_AT_ONCE ? count - p : PAIRS_AT_ONCE,
                               features + p);
        return;
    }
    other_pairs others = {.count = 0};
    for (uint32_t p = 0; p < count; p++) {
        if (flags_choose(interval, pairs[p])) {
            features[p] = (uint16_t)select_kept(interval, pairs[p], features[p]);
            continue;
        }
        others.pairs[others.count] = pairs[p];
        others.features[others.count] = features[p];
        others.places[others.count++] = &features[p];
        if (others.count == PAIRS_AT_ONCE) select_others(interval, &others);
    }
    select_others(interval, &others);
}
