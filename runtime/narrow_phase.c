/* From triangle pairs to contacts: representatives, feature volumes, elementary tests. */
#include "runtime/narrow_phase.h"

#include "runtime/answering.h"

#include <string.h>

void contact_lane_reset(contact_lane *lane) {
    lane->count = 0;
    lane->feature_pairs = 0;
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) lane->decided[i] = 0;
    lane->separations = 0;
    lane->out_of_memory = false;
}

static bool make_room(cscd_context *context, contact_lane *lane) {
    if (lane->count < lane->capacity) return true;
    size_t capacity = lane->capacity == 0 ? 256 : lane->capacity * 2;
    cscd_contact *grown =
        context_grow(context, lane->contacts, lane->count, capacity, sizeof *lane->contacts);
    if (grown == NULL) {
        lane->out_of_memory = true;
        return false;
    }
    lane->contacts = grown;
    lane->capacity = capacity;
    return true;
}

static void add_contact(const swept_interval *interval, contact_lane *lane, cscd_contact_kind kind,
                        uint32_t a, uint32_t b, const elementary_hit *hit, bool bounded) {
    if (!make_room(interval->mesh->context, lane)) return;
    cscd_contact *contact = &lane->contacts[lane->count++];
    memset(contact, 0, sizeof *contact); /* padding too: lists are compared bit for bit */
    contact->kind = kind;
    contact->a = a;
    contact->b = b;
    contact->toi = hit->toi;
    contact->u = hit->u;
    contact->v = hit->v;
    memcpy(contact->point, hit->point, sizeof contact->point);
    memcpy(contact->normal, hit->normal, sizeof contact->normal);
    contact->bounded = bounded;
}

static void test_pair(const swept_interval *interval, cscd_contact_kind kind, uint32_t a, uint32_t b,
                      const elementary_query *query, contact_lane *lane) {
    elementary_hit hit;
    bool vf = kind == CSCD_CONTACT_VF, found, bounded = false;
    if (interval->limit.distance > 0.0) {
        found = (vf ? separation_vf : separation_ee)(query, &interval->limit, &hit, &bounded);
        lane->separations++;
    } else {
        elementary_verdict verdict = (vf ? elementary_vf : elementary_ee)(query, &hit);
        found = verdict.touching;
        lane->decided[verdict.level]++;
    }
    if (found) add_contact(interval, lane, kind, a, b, &hit, bounded);
}

static void load_point(const swept_interval *interval, uint32_t vertex, elementary_query *query, int i) {
    memcpy(query->x0[i], interval->x0 + (size_t)vertex * 3, sizeof query->x0[i]);
    memcpy(query->x1[i], interval->x1 + (size_t)vertex * 3, sizeof query->x1[i]);
}

void narrow_phase_test_vf(const swept_interval *interval, uint32_t vertex, uint32_t triangle,
                          contact_lane *lane) {
    elementary_query query;
    load_point(interval, vertex, &query, 0);
    for (int i = 0; i < 3; i++) load_point(interval, interval->mesh->triangles[triangle][i], &query, i + 1);
    test_pair(interval, CSCD_CONTACT_VF, vertex, triangle, &query, lane);
}

/* Feature a is the edge of the smaller number, whichever way the pair was found: the test's rounding, and so
 * its result, never depends on the traversal. */
void narrow_phase_test_ee(const swept_interval *interval, uint32_t a, uint32_t b, contact_lane *lane) {
    uint32_t edges[2] = {a < b ? a : b, a < b ? b : a};
    elementary_query query;
    for (int i = 0; i < 4; i++) load_point(interval, interval->mesh->edges[edges[i / 2]][i % 2], &query, i);
    test_pair(interval, CSCD_CONTACT_EE, edges[0], edges[1], &query, lane);
}

/* ---- triangle pairs ---------------------------------------------------------------------------------- */

static void test_vertices(const swept_interval *interval, uint32_t of, uint32_t against, const kdop *face,
                          contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    for (int i = 0; i < 3; i++) {
        uint32_t vertex = mesh->triangles[of][i];
        if (!answers_for_vertex(interval, of, i, against)) continue;
        if (triangle_contains(mesh->triangles[against], vertex)) continue;
        lane->feature_pairs++;
        if (kdop_overlap(&interval->vertex_volumes[vertex], face))
            narrow_phase_test_vf(interval, vertex, against, lane);
    }
}

static kdop edge_volume(const swept_interval *interval, uint32_t edge) {
    const uint32_t *ends = interval->mesh->edges[edge];
    return kdop_union(&interval->vertex_volumes[ends[0]], &interval->vertex_volumes[ends[1]]);
}

static void test_edges(const swept_interval *interval, triangle_pair pair, const kdop *face_b,
                       contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    kdop volumes_b[3];
    for (int j = 0; j < 3; j++) volumes_b[j] = edge_volume(interval, mesh->triangle_edges[pair.b][j]);
    for (int i = 0; i < 3; i++) {
        uint32_t a = mesh->triangle_edges[pair.a][i];
        kdop volume_a = edge_volume(interval, a);
        bool near = kdop_overlap(&volume_a, face_b);
        for (int j = 0; j < 3; j++) {
            uint32_t b = mesh->triangle_edges[pair.b][j];
            if (!answers_for_edges(interval, pair, i, j)) continue;
            if (edges_share_vertex(mesh->edges[a], mesh->edges[b])) continue;
            lane->feature_pairs++;
            if (near && kdop_overlap(&volume_a, &volumes_b[j])) narrow_phase_test_ee(interval, a, b, lane);
        }
    }
}

static kdop face_volume(const swept_interval *interval, uint32_t triangle) {
    const uint32_t *v = interval->mesh->triangles[triangle];
    return kdop_triangle(interval->vertex_volumes, v);
}

static bool triangles_share_vertex(const uint32_t a[3], const uint32_t b[3]) {
    return triangle_contains(a, b[0]) || triangle_contains(a, b[1]) || triangle_contains(a, b[2]);
}

void narrow_phase_test(const swept_interval *interval, triangle_pair pair, contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    if (interval->skip_adjacent && triangles_share_vertex(mesh->triangles[pair.a], mesh->triangles[pair.b]))
        return;
    kdop face_a = face_volume(interval, pair.a), face_b = face_volume(interval, pair.b);
    test_vertices(interval, pair.a, pair.b, &face_b, lane);
    test_vertices(interval, pair.b, pair.a, &face_a, lane);
    test_edges(interval, pair, &face_b, lane);
}
