/* Which pairs wait after a mesh has torn, told by brute force over all pairs of features. */
#include "tests/support/torn_model.h"

#include "src/mesh/mesh_change.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <string.h>

enum { PAIRS_MAX = 40000, NO_NAME = -1 };

typedef struct model_pair {
    cscd_contact_kind kind;
    uint32_t a, b;
} model_pair;

typedef struct model_list {
    size_t count;
    model_pair items[PAIRS_MAX];
} model_list;

/* Pairs that wait, and those that a change has parted since positions were last seen. */
static model_list waiting, parted, scratch;

/* Objects that were obstacles before a change since positions were last seen. */
enum { OBJECTS_MAX = 16, FORMER_MAX = 16 };

static bool former[FORMER_MAX][OBJECTS_MAX];
static size_t former_count;
static const cscd_mesh *mesh_now;

void torn_model_begin(void) {
    waiting.count = parted.count = former_count = 0;
}

static void add_pair(model_list *list, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    assert_true(list->count < PAIRS_MAX);
    bool ordered = kind == CSCD_CONTACT_VF || a < b;
    list->items[list->count++] = (model_pair){kind, ordered ? a : b, ordered ? b : a};
}

static bool has_pair(const model_list *list, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    for (size_t i = 0; i < list->count; i++) {
        if (list->items[i].kind == kind && list->items[i].a == a && list->items[i].b == b) return true;
    }
    return false;
}

static int vertices_of(const cscd_mesh *mesh, cscd_contact_kind kind, bool second, uint32_t feature,
                       uint32_t *out) {
    if (kind == CSCD_CONTACT_VF && !second) {
        out[0] = feature;
        return 1;
    }
    bool edge = kind == CSCD_CONTACT_EE;
    memcpy(out, edge ? mesh->edges[feature] : mesh->triangles[feature], (edge ? 2 : 3) * sizeof *out);
    return edge ? 2 : 3;
}

/* Have the two a vertex in common; or, with names, two vertices of one name? */
static bool have_common(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b,
                        const int64_t *names) {
    uint32_t v[3], w[3];
    int v_count = vertices_of(mesh, kind, false, a, v), w_count = vertices_of(mesh, kind, true, b, w);
    for (int i = 0; i < v_count; i++) {
        for (int j = 0; j < w_count; j++) {
            if (names == NULL ? v[i] == w[j]
                              : v[i] != w[j] && names[v[i]] != NO_NAME && names[v[i]] == names[w[j]])
                return true;
        }
    }
    return false;
}

static bool is_pair(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return kind == CSCD_CONTACT_TT ? a != b : !have_common(mesh, kind, a, b, NULL);
}

/* All pairs of features of the new mesh that came from a pair. */
static void follow_pairs(const cscd_mesh_change *made, model_list *list) {
    const cscd_mesh *mesh = cscd_mesh_change_mesh(made);
    const uint32_t *origins[3] = {cscd_mesh_change_to_old(made, CSCD_VERTICES, NULL),
                                  cscd_mesh_change_to_old(made, CSCD_EDGES, NULL),
                                  cscd_mesh_change_to_old(made, CSCD_TRIANGLES, NULL)};
    const uint32_t counts[3] = {mesh->vertex_count, mesh->edge_count, mesh->triangle_count};
    scratch.count = 0;
    for (size_t i = 0; i < list->count; i++) {
        model_pair p = list->items[i];
        int first = p.kind == CSCD_CONTACT_VF ? 0 : p.kind == CSCD_CONTACT_EE ? 1 : 2;
        int second = p.kind == CSCD_CONTACT_EE ? 1 : 2;
        for (uint32_t a = 0; a < counts[first]; a++) {
            if (origins[first][a] != p.a) continue;
            for (uint32_t b = 0; b < counts[second]; b++) {
                if (origins[second][b] == p.b && is_pair(mesh, p.kind, a, b))
                    add_pair(&scratch, p.kind, a, b);
            }
        }
    }
    memcpy(list->items, scratch.items, scratch.count * sizeof *scratch.items);
    list->count = scratch.count;
}

/* What was one vertex, or one seam, has one name if it is torn. */
static void name_vertices(const cscd_mesh_change *made, const uint32_t *labels, int64_t *names) {
    static bool torn[2 * SCENE_VERTICES_MAX];
    uint32_t count;
    const uint32_t *origins = cscd_mesh_change_to_old(made, CSCD_VERTICES, &count),
                   *to_new = cscd_mesh_change_to_new(made, CSCD_VERTICES, NULL);
    memset(torn, 0, sizeof torn);
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t v = 0; v < count; v++) {
            uint32_t o = origins[v];
            names[v] = NO_NAME;
            if (o == UINT32_MAX) continue;
            int64_t name = labels[o] != UINT32_MAX ? SCENE_VERTICES_MAX + (int64_t)labels[o] : (int64_t)o;
            if (pass == 0) torn[name] |= to_new[o] != v;
            if (torn[name]) names[v] = name;
        }
    }
}

static void part_kind(const cscd_mesh *mesh, cscd_contact_kind kind, const int64_t *names) {
    uint32_t edges = mesh->edge_count, triangles = mesh->triangle_count;
    uint32_t a_count = kind == CSCD_CONTACT_VF   ? mesh->vertex_count
                       : kind == CSCD_CONTACT_EE ? edges
                                                 : triangles;
    uint32_t b_count = kind == CSCD_CONTACT_EE ? edges : triangles;
    for (uint32_t a = 0; a < a_count; a++) {
        uint32_t v[3];
        int count = vertices_of(mesh, kind, false, a, v);
        bool any = false;
        for (int i = 0; i < count; i++) any |= names[v[i]] != NO_NAME;
        for (uint32_t b = kind == CSCD_CONTACT_VF ? 0 : a + 1; any && b < b_count; b++) {
            if (have_common(mesh, kind, a, b, names) && is_pair(mesh, kind, a, b))
                add_pair(&parted, kind, a, b);
        }
    }
}

static void follow_obstacles(const cscd_mesh_change *made) {
    const uint32_t *origins = cscd_mesh_change_to_old(made, CSCD_OBJECTS, NULL);
    assert_true(former_count < FORMER_MAX && mesh_now->object_count <= OBJECTS_MAX);
    for (uint32_t i = 0; i < made->old_mesh->object_count; i++)
        former[former_count][i] = made->old_mesh->objects[i].obstacle;
    former_count++;
    for (size_t k = 0; k < former_count; k++) {
        bool before[OBJECTS_MAX];
        memcpy(before, former[k], sizeof before);
        for (uint32_t i = 0; i < mesh_now->object_count; i++)
            former[k][i] = origins[i] != UINT32_MAX && before[origins[i]];
    }
}

void torn_model_change(const cscd_mesh_change *made, const uint32_t *labels) {
    static int64_t names[SCENE_VERTICES_MAX];

    mesh_now = cscd_mesh_change_mesh(made);
    follow_obstacles(made);
    follow_pairs(made, &waiting);
    follow_pairs(made, &parted);
    name_vertices(made, labels, names);
    part_kind(cscd_mesh_change_mesh(made), CSCD_CONTACT_VF, names);
    part_kind(cscd_mesh_change_mesh(made), CSCD_CONTACT_EE, names);
    part_kind(cscd_mesh_change_mesh(made), CSCD_CONTACT_TT, names);
}

/* A pair of obstacles that are looked at now. */
static bool was_of_obstacles(cscd_contact_kind kind, uint32_t a, uint32_t b) {
    uint32_t of[2];
    if (former_count > 0) mesh_objects_of_pair(mesh_now, kind, a, b, of);
    for (size_t k = 0; k < former_count; k++) {
        if (former[k][of[0]] && former[k][of[1]]) return true;
    }
    return false;
}

static void keep_pair(cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (has_pair(&waiting, kind, a, b) || has_pair(&parted, kind, a, b) || was_of_obstacles(kind, a, b))
        add_pair(&scratch, kind, a, b);
}

void torn_model_settle(const cscd_contacts *at_rest, const cscd_intersections *crossing) {

    scratch.count = 0;
    for (size_t i = 0; i < at_rest->count; i++)
        keep_pair(at_rest->items[i].kind, at_rest->items[i].a, at_rest->items[i].b);
    for (size_t i = 0; i < crossing->count; i++)
        keep_pair(CSCD_CONTACT_TT, crossing->items[i].a, crossing->items[i].b);
    memcpy(waiting.items, scratch.items, scratch.count * sizeof *scratch.items);
    waiting.count = scratch.count;
    parted.count = former_count = 0;
}

bool torn_model_waits(cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return has_pair(&waiting, kind, a, b);
}

size_t torn_model_count(void) {
    size_t count = 0;
    for (size_t i = 0; i < waiting.count; i++) count += waiting.items[i].kind != CSCD_CONTACT_TT;
    return count;
}
