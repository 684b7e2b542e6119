/* Detectors whose scenes tear, are refined, come and go, with all that they have been told; and the pairs that wait
 * after a tear. */
#include "tests/support/moving_scene.h"

#include "src/mesh/mesh_change.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
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

/* ---- scenes and their detectors ------------------------------------------------------------------------ */

moving_scene moving;
scene moving_joined;
scene_change moving_change;

const cscd_mesh *moving_mesh_now(void) {
    return cscd_detector_mesh(moving.detector);
}

/* ---- what the detector is told ------------------------------------------------------------------------- */

static void make_rules(void) {
    for (int i = 0; i < CHANGING_OBJECTS_MAX; i++) {
        cscd_object_rule rule = cscd_object_rule_default();
        if (moving.rules) {
            rule.category = 1u << stream_below(&moving.random, 3);
            rule.mask = 1 + stream_below(&moving.random, 7);
            rule.self = stream_below(&moving.random, 3) > 0;
            if (moving.options.min_separation == 0.0 && stream_below(&moving.random, 2) == 0)
                rule.thickness = 0.02;
        }
        moving.object_rules[i] = rule;
    }
}

static uint32_t seam_pairs(uint32_t (*pairs)[2]) {
    uint32_t count = 0;
    for (uint32_t v = 0; v < moving_joined.vertex_count; v++) {
        for (uint32_t w = 0; w < v && moving.labels[v] != UINT32_MAX; w++) {
            if (moving.labels[w] != moving.labels[v]) continue;
            pairs[count][0] = v;
            pairs[count++][1] = w;
            break;
        }
    }
    return count;
}

static void make_pairs(void) {
    memset(moving.labels, 0xff, sizeof moving.labels);
    for (uint32_t i = 0; moving.seams && i < 30; i++)
        moving.labels[stream_below(&moving.random, moving_joined.vertex_count)] = i % 10;
    moving.ignored_count = moving.ignored ? 300 : 0;
    moving.ignored_pairs = malloc(400 * sizeof *moving.ignored_pairs);
    for (size_t i = 0; i < moving.ignored_count; i++) {
        moving.ignored_pairs[i][0] = stream_below(&moving.random, moving_joined.triangle_count);
        moving.ignored_pairs[i][1] = (moving.ignored_pairs[i][0] + 1 +
                                      stream_below(&moving.random, moving_joined.triangle_count - 1)) %
                                     moving_joined.triangle_count;
    }
}

/* A detector that begins with all that was said, in the numbering of now. */
cscd_detector *moving_new_detector(const cscd_mesh *mesh, const cscd_plan *plan) {
    static uint32_t pairs[MOVING_VERTICES][2];
    cscd_detector_options options = moving.options;
    cscd_detector *made = NULL;
    options.seams = pairs[0];
    options.seam_count = seam_pairs(pairs);
    options.seam_reach = INFINITY;
    options.ignored = moving.ignored_count > 0 ? moving.ignored_pairs[0] : NULL;
    options.ignored_count = moving.ignored_count;
    options.rules = moving.rules ? moving.object_rules : NULL;
    options.rule_count = moving.rules ? moving.shape.object_count : 0;
    expect_ok(cscd_detector_create(moving.context, mesh, plan, &options, &made));
    return made;
}

/* ---- what becomes of it -------------------------------------------------------------------------------- */

static void map_rules(const uint32_t *objects, uint32_t count) {
    cscd_object_rule moved[CHANGING_OBJECTS_MAX];
    for (uint32_t i = 0; i < count; i++)
        moved[i] = objects[i] != UINT32_MAX ? moving.object_rules[objects[i]] : cscd_object_rule_default();
    memcpy(moving.object_rules, moved, count * sizeof *moved);
}

static void map_labels(const uint32_t *vertices, uint32_t old_count) {
    uint32_t moved[MOVING_VERTICES];
    memset(moved, 0xff, sizeof moved);
    for (uint32_t v = 0; v < old_count; v++) {
        if (vertices[v] != UINT32_MAX) moved[vertices[v]] = moving.labels[v];
    }
    memcpy(moving.labels, moved, sizeof moved);
}

static void map_ignored(const uint32_t *origins, uint32_t count) {
    size_t capacity = 100, found = 0;
    uint32_t(*moved)[2] = malloc(capacity * sizeof *moved);
    for (size_t i = 0; i < moving.ignored_count; i++) {
        for (uint32_t a = 0; a < count; a++) {
            for (uint32_t b = 0; b < count && origins[a] == moving.ignored_pairs[i][0]; b++) {
                if (origins[b] != moving.ignored_pairs[i][1]) continue;
                if (found == capacity) moved = realloc(moved, (capacity *= 2) * sizeof *moved);
                moved[found][0] = a;
                moved[found++][1] = b;
            }
        }
    }
    free(moving.ignored_pairs);
    moving.ignored_pairs = moved;
    moving.ignored_count = found;
}

/* Copies of a vertex move a little apart, so that nothing touches what it was a neighbour of. */
static void part_copies(const uint32_t *vertices, const uint32_t *origins) {
    uint32_t vertex = 0;
    for (uint32_t i = 0; i < moving.shape.object_count; i++) {
        changing_object *o = &moving.shape.objects[i];
        for (uint32_t v = 0; v < o->vertex_count; v++, vertex++) {
            if (origins[vertex] == UINT32_MAX || vertices[origins[vertex]] == vertex) continue;
            for (size_t k = 0; k < 3; k++)
                o->positions[3 * v + k] += stream_between(&moving.random, -0.05, 0.05);
        }
    }
}

void moving_take_change(cscd_mesh_change *made) {
    uint32_t old_count, new_count;
    const uint32_t *vertices = cscd_mesh_change_to_new(made, CSCD_VERTICES, &old_count);
    torn_model_change(made, moving.labels);
    map_labels(vertices, old_count);
    map_rules(cscd_mesh_change_to_old(made, CSCD_OBJECTS, NULL), moving.shape.object_count);
    const uint32_t *triangles = cscd_mesh_change_to_old(made, CSCD_TRIANGLES, &new_count);
    map_ignored(triangles, new_count);
    if (stream_below(&moving.random, 2) == 0)
        part_copies(vertices, cscd_mesh_change_to_old(made, CSCD_VERTICES, NULL));
    changing_scene_join(&moving.shape, &moving_joined);
    cscd_mesh_change_destroy(moving.last);
    moving.last = made;
}

void moving_change_scene(void) {
    cscd_mesh_change *made = NULL;
    changing_scene_change(&moving.random, &moving.shape, &moving_change);
    expect_ok(cscd_mesh_change_create(moving.context, moving_mesh_now(), moving_change.list,
                                      moving_change.count, &made));
    expect_ok(cscd_detector_change_mesh(moving.detector, made));
    assert_ptr_equal(moving_mesh_now(), cscd_mesh_change_mesh(made));
    moving_take_change(made);
}

/* A clone goes on in place of the detector, whatever that has come to. */
void moving_replace_by_clone(void) {
    cscd_detector *clone = NULL;
    expect_ok(cscd_detector_clone(moving.context, moving.detector, &clone));
    cscd_detector_destroy(moving.detector);
    moving.detector = clone;
}

/* ---- motions ------------------------------------------------------------------------------------------- */

void moving_move_scene(double speed) {
    uint32_t vertex = 0;
    memcpy(moving.x0, moving_joined.x0, moving_joined.vertex_count * sizeof(double[3]));
    for (uint32_t i = 0; i < moving.shape.object_count; i++) {
        changing_object *o = &moving.shape.objects[i];
        double by[3];
        bool rests = stream_below(&moving.random, 4) == 0;
        for (int k = 0; k < 3; k++) by[k] = stream_between(&moving.random, -speed, speed);
        for (uint32_t v = 0; v < o->vertex_count; v++, vertex++) {
            for (size_t k = 0; k < 3; k++) {
                double noise = stream_between(&moving.random, -0.05, 0.05) * speed;
                moving.x1[3 * vertex + k] = moving.x0[3 * vertex + k] + (rests ? 0.0 : by[k] + noise);
            }
        }
    }
}

/* The end becomes the start. */
void moving_go_on(void) {
    uint32_t vertex = 0;
    expect_one_number(moving.detector, "a changing scene");
    for (uint32_t i = 0; i < moving.shape.object_count; i++) {
        changing_object *o = &moving.shape.objects[i];
        memcpy(o->positions, moving.x1 + 3 * vertex, o->vertex_count * sizeof(double[3]));
        vertex += o->vertex_count;
    }
    changing_scene_join(&moving.shape, &moving_joined);
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

void moving_begin_scene(cscd_context *context, uint64_t seed, bool plain) {
    moving =
        (moving_scene){.random = stream_start(seed), .context = context, .options = cscd_detector_defaults()};
    torn_model_begin();
    changing_scene_make(&moving.random, !plain, &moving.shape);
    changing_scene_join(&moving.shape, &moving_joined);
    moving.first = changing_scene_mesh(context, &moving.shape);
    uint32_t method = stream_below(&moving.random, 3);
    cscd_plan *plan = NULL;
    if (method == 1) moving.options.method = CSCD_METHOD_SINGLE;
    if (method == 2) {
        cscd_plan_options plan_options = cscd_plan_defaults();
        plan_options.method = CSCD_METHOD_KMEANS;
        plan_options.k = 12;
        expect_ok(plan_create_packed(moving.first, moving_joined.x0, &plan_options, &plan));
    }
    if (!plain) {
        moving.rules = stream_below(&moving.random, 3) == 0;
        moving.seams = stream_below(&moving.random, 3) == 0;
        moving.ignored = stream_below(&moving.random, 3) == 0;
        if (!moving.rules && stream_below(&moving.random, 4) == 0) moving.options.min_separation = 0.03;
        if (stream_below(&moving.random, 4) == 0) moving.options.volume = CSCD_VOLUME_KDOP14;
    }
    moving.earliest = seed % 4 == 1;
    if (moving.earliest) moving.options.mode = CSCD_MODE_EARLIEST;
    make_rules();
    make_pairs();
    moving.detector = moving_new_detector(moving.first, plan);
    moving.options.method = CSCD_METHOD_AUTO;
    moving.options.mode = CSCD_MODE_ALL;
    cscd_plan_destroy(plan);
}

void moving_end_scene(void) {
    cscd_detector_destroy(moving.detector);
    cscd_mesh_change_destroy(moving.last);
    cscd_mesh_destroy(moving.first);
    free(moving.ignored_pairs);
}
