/* Random scenes of triangles, wires, points and half-spaces, with random rules, and what happens in them: every pair of
 * features by itself, without a tree and without the rules of the library. */
#include "tests/support/loose/loose_scene.h"

#include "tests/support/ccd/wide_numbers.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- objects ------------------------------------------------------------------------------------------- */

static cscd_object_desc *add_object(loose_scene *s, cscd_object_desc desc) {
    assert_true(s->object_count < LOOSE_OBJECTS_MAX);
    assert_true(s->vertex_count + desc.vertex_count <= LOOSE_VERTICES_MAX);
    s->objects[s->object_count] = desc;
    s->vertex_count += desc.vertex_count;
    return &s->objects[s->object_count++];
}

/* Tetrahedra, which are culled, and in every other object a vertex that no triangle has. */
static void add_tetrahedra(loose_scene *s, uint32_t count, bool spare) {
    static const uint32_t corners[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    uint32_t *indices = s->indices[s->object_count];
    for (uint32_t i = 0; i < count * 12; i++) indices[i] = corners[i % 12] + i / 12 * 4;
    add_object(s, cscd_object_of_triangles(4 * count + spare, 4 * count, indices));
}

static void add_sheet(loose_scene *s, uint32_t side) {
    uint32_t *indices = s->indices[s->object_count], n = 0;
    for (uint32_t i = 0; i + 1 < side; i++) {
        for (uint32_t j = 0; j + 1 < side; j++) {
            uint32_t at = i * side + j;
            const uint32_t six[6] = {at, at + 1, at + side, at + 1, at + side + 1, at + side};
            for (int k = 0; k < 6; k++) indices[n++] = six[k];
        }
    }
    add_object(s, cscd_object_of_triangles(side * side, n / 3, indices));
}

/* A strand, a star, a wire that is given twice, and a vertex that no wire has. */
static void add_wires(loose_scene *s, uint32_t strand) {
    uint32_t *indices = s->indices[s->object_count], n = 0;
    for (uint32_t i = 0; i + 1 < strand; i++) {
        indices[n++] = i + (i % 2);
        indices[n++] = i + 1 - (i % 2);
    }
    for (uint32_t i = 1; i < 4; i++) {
        indices[n++] = strand + i;
        indices[n++] = strand;
    }
    indices[n++] = indices[1];
    indices[n++] = indices[0];
    add_object(s, cscd_object_of_wires(strand + 5, n / 2, indices));
}

static void add_half_space(loose_scene *s, random_stream *random) {
    double normal[3] = {0.0, 0.0, 0.0};
    if (s->recipe.grid || stream_below(random, 3) == 0)
        for (int k = 0; k < 3; k++) normal[k] = (double)stream_below(random, 3) - 1.0 + (k == 2 ? 3.0 : 0.0);
    else
        for (int k = 0; k < 3; k++) normal[k] = stream_between(random, -0.5, 0.5) + (k == 1 ? 1.0 : 0.0);
    add_object(s, cscd_object_half_space(normal));
}

static void describe_objects(loose_scene *s, random_stream *random) {
    if (s->recipe.half_spaces) add_half_space(s, random);
    if (s->recipe.points) add_object(s, cscd_object_of_points(4 + stream_below(random, 6)));
    if (s->recipe.triangles) {
        const bool is_obstacle = stream_below(random, 2) == 0;
        add_tetrahedra(s, 1 + stream_below(random, 3), is_obstacle);
    }
    if (s->recipe.wires) add_wires(s, 2 + stream_below(random, 6));
    if (s->recipe.triangles) add_sheet(s, 3);
    if (s->recipe.points) add_object(s, cscd_object_of_points(10 + stream_below(random, 8)));
    if (s->recipe.wires) add_wires(s, 4);
    if (s->recipe.half_spaces) add_half_space(s, random);
    for (uint32_t i = 0; i < s->object_count; i++)
        s->objects[i].obstacle = s->recipe.obstacles && stream_below(random, 3) == 0;
}

static void make_rules(loose_scene *s, random_stream *random) {
    static const double thicknesses[4] = {0.0, 0.05, 0.1, 0.3};
    for (uint32_t i = 0; i < s->object_count; i++) {
        cscd_object_rule *rule = &s->rules[i];
        *rule = cscd_object_rule_default();
        if (s->recipe.rules) {
            rule->category = 1u << stream_below(random, 3);
            rule->mask = 1 + stream_below(random, 7);
            rule->self = stream_below(random, 2) == 0;
            rule->obstacle_pairs = stream_below(random, 2) == 0;
        }
        if (s->recipe.thickness && !s->recipe.matrix) rule->thickness = thicknesses[stream_below(random, 4)];
        if (s->recipe.matrix) rule->thickness_class = i;
        for (uint32_t k = 0; k <= i; k++)
            s->matrix[i * s->object_count + k] = s->matrix[k * s->object_count + i] =
                thicknesses[stream_below(random, 4)];
    }
}

/* ---- positions ----------------------------------------------------------------------------------------- */

static double place_of(const loose_scene *s, random_stream *random, double low, double high) {
    double x = stream_between(random, low, high);
    return s->recipe.grid ? floor(x * 16.0) / 16.0 : x;
}

/* Half-spaces lie below most of the scene. */
void loose_scene_move(loose_scene *s, random_stream *random) {
    double common[3], reach = s->recipe.motion;
    uint32_t vertex = 0;
    bool fast = stream_below(random, 4) == 0;
    for (int k = 0; k < 3; k++) common[k] = fast ? place_of(s, random, -20.0, 20.0) : 0.0;
    for (uint32_t i = 0; i < s->object_count; i++) {
        bool half_space = s->objects[i].kind == CSCD_OBJECT_HALF_SPACE;
        for (uint32_t v = 0; v < s->objects[i].vertex_count; v++, vertex++) {
            for (size_t k = 0; k < 3; k++) {
                double low = half_space ? -1.2 : -1.0, high = half_space ? -0.8 : 1.0;
                double *x0 = &s->x0[vertex * 3 + k], *x1 = &s->x1[vertex * 3 + k];
                *x0 = place_of(s, random, low, high);
                *x1 = *x0 + place_of(s, random, -reach, reach) + common[k];
                if (stream_below(random, 6) == 0) *x1 = *x0 + common[k];
            }
        }
    }
}

void loose_scene_make(loose_scene *s, const loose_recipe *recipe, random_stream *random, uint32_t threads,
                      cscd_simd simd) {
    memset(s, 0, sizeof *s);
    s->recipe = *recipe;
    describe_objects(s, random);
    make_rules(s, random);
    loose_scene_move(s, random);
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = threads;
    options.simd = simd;
    assert_int_equal(cscd_context_create(&options, &s->context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(s->context, s->objects, s->object_count, &s->mesh), CSCD_OK);
}

void loose_scene_free(loose_scene *s) {
    cscd_mesh_destroy(s->mesh);
    cscd_context_destroy(s->context);
}

cscd_detector_options loose_scene_options(const loose_scene *s) {
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = s->recipe.min_separation;
    if (!s->recipe.rules && !s->recipe.thickness) return options;
    options.rules = s->rules;
    options.rule_count = s->object_count;
    if (s->recipe.matrix) {
        options.thickness_matrix = s->matrix;
        options.thickness_class_count = s->object_count;
    }
    return options;
}

cscd_detector *loose_scene_detector(const loose_scene *s, const cscd_detector_options *options) {
    cscd_detector *detector = NULL;
    cscd_status status = cscd_detector_create(s->context, s->mesh, NULL, options, &detector);
    if (status != CSCD_OK) fail_msg("%s", cscd_context_detail(s->context));
    return detector;
}

/* ---- pairs --------------------------------------------------------------------------------------------- */

double loose_scene_distance(const loose_scene *s, uint32_t a, uint32_t b) {
    if (!s->recipe.thickness) return s->recipe.min_separation;
    if (s->recipe.matrix) return s->matrix[a * s->object_count + b];
    return 0.5 * s->rules[a].thickness + 0.5 * s->rules[b].thickness;
}

static bool objects_meet(const loose_scene *s, uint32_t a, uint32_t b) {
    const cscd_object_rule *p = &s->rules[a], *q = &s->rules[b];
    bool both_obstacles = s->objects[a].obstacle && s->objects[b].obstacle;
    if (a == b) return p->self && !s->objects[a].obstacle;
    if (both_obstacles && !(p->obstacle_pairs && q->obstacle_pairs)) return false;
    return (p->category & q->mask) != 0 && (q->category & p->mask) != 0;
}

typedef struct feature {
    uint32_t number, object, count, vertices[3];
} feature;

static bool share_vertex(const feature *a, const feature *b) {
    for (uint32_t i = 0; i < a->count; i++) {
        for (uint32_t k = 0; k < b->count; k++)
            if (a->vertices[i] == b->vertices[k]) return true;
    }
    return false;
}

typedef struct loose_pair_list {
    const loose_scene *s;
    bool at_zero;
    loose_pair *out;
    size_t count;
} loose_pair_list;

static void add_pair(loose_pair_list *list, cscd_contact_kind kind, const feature *a, const feature *b) {
    double distance = loose_scene_distance(list->s, a->object, b->object);
    bool of_points = kind == CSCD_CONTACT_VV || kind == CSCD_CONTACT_EV;
    if (share_vertex(a, b) || !objects_meet(list->s, a->object, b->object)) return;
    if (of_points && distance == 0.0 && !list->at_zero) return;
    assert_true(list->count < LOOSE_LIST_MAX);
    list->out[list->count++] = (loose_pair){kind, a->number, b->number, distance};
}

/* Vertices that triangles, wires, or objects of points have. */
static uint32_t list_vertices(const loose_scene *s, bool points_only, feature *out) {
    uint32_t count = 0, first = 0;
    for (uint32_t i = 0; i < s->object_count; i++) {
        const cscd_object_desc *o = &s->objects[i];
        const uint32_t *indices = o->triangles != NULL ? o->triangles : o->wires;
        uint32_t index_count = o->triangle_count * 3 + o->wire_count * 2;
        for (uint32_t v = 0; v < o->vertex_count; v++) {
            bool used = o->kind == CSCD_OBJECT_POINTS;
            for (uint32_t k = 0; k < index_count; k++) used |= indices[k] == v;
            if (used && (!points_only || o->kind == CSCD_OBJECT_POINTS))
                out[count++] = (feature){first + v, i, 1, {first + v}};
        }
        first += o->vertex_count;
    }
    return count;
}

static uint32_t list_edges(const loose_scene *s, bool wires_only, feature *out) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->object_count; i++) {
        cscd_object object = cscd_mesh_object(s->mesh, i);
        for (uint32_t e = object.first_edge; e < object.first_edge + object.edge_count; e++) {
            out[count] = (feature){.number = e, .object = i, .count = 2};
            cscd_mesh_edge(s->mesh, e, out[count].vertices);
            count += !wires_only || object.kind == CSCD_OBJECT_WIRES;
        }
    }
    return count;
}

static uint32_t list_faces(const loose_scene *s, feature *out) {
    uint32_t count = cscd_mesh_triangle_count(s->mesh);
    for (uint32_t t = 0; t < count; t++) {
        out[t] = (feature){.number = t, .count = 3};
        cscd_mesh_triangle(s->mesh, t, out[t].vertices);
        out[t].object = cscd_mesh_vertex_object(s->mesh, out[t].vertices[0]);
    }
    return count;
}

static uint32_t list_half_spaces(const loose_scene *s, feature *out) {
    uint32_t count = 0, first = 0;
    for (uint32_t i = 0; i < s->object_count; i++) {
        if (s->objects[i].kind == CSCD_OBJECT_HALF_SPACE) out[count++] = (feature){i, i, 1, {first}};
        first += s->objects[i].vertex_count;
    }
    return count;
}

static void add_all(loose_pair_list *list, cscd_contact_kind kind, const feature *a, uint32_t a_count,
                    const feature *b, uint32_t b_count) {
    for (uint32_t i = 0; i < a_count; i++) {
        for (uint32_t k = a == b ? i + 1 : 0; k < b_count; k++) add_pair(list, kind, &a[i], &b[k]);
    }
}

size_t loose_scene_pairs(const loose_scene *s, bool at_zero, loose_pair *out) {
    static feature vertices[LOOSE_VERTICES_MAX], points[LOOSE_VERTICES_MAX], edges[1024], wires[1024],
        faces[512];
    static feature half_spaces[LOOSE_OBJECTS_MAX];
    uint32_t vertex_count = list_vertices(s, false, vertices), point_count = list_vertices(s, true, points);
    uint32_t edge_count = list_edges(s, false, edges), wire_count = list_edges(s, true, wires);
    uint32_t face_count = list_faces(s, faces), half_space_count = list_half_spaces(s, half_spaces);
    loose_pair_list list = {s, at_zero, out, 0};
    add_all(&list, CSCD_CONTACT_VF, vertices, vertex_count, faces, face_count);
    add_all(&list, CSCD_CONTACT_EE, edges, edge_count, edges, edge_count);
    add_all(&list, CSCD_CONTACT_VV, points, point_count, points, point_count);
    add_all(&list, CSCD_CONTACT_EV, wires, wire_count, points, point_count);
    add_all(&list, CSCD_CONTACT_VH, vertices, vertex_count, half_spaces, half_space_count);
    return list.count;
}

/* ---- what they do -------------------------------------------------------------------------------------- */

/* The four points of a pair as those of a vertex and a face or of two edges. */
static cscd_contact_kind points_of(const loose_scene *s, const loose_pair *pair, uint32_t out[4]) {
    cscd_contact_kind kind = pair->kind == CSCD_CONTACT_VF ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
    out[0] = out[1] = pair->a;
    out[2] = out[3] = pair->b;
    if (pair->kind == CSCD_CONTACT_EE || pair->kind == CSCD_CONTACT_EV) cscd_mesh_edge(s->mesh, pair->a, out);
    if (pair->kind == CSCD_CONTACT_EE) cscd_mesh_edge(s->mesh, pair->b, out + 2);
    if (pair->kind == CSCD_CONTACT_VF) cscd_mesh_triangle(s->mesh, pair->b, out + 1);
    return kind;
}

/* With 64 bits more than a double the products are exact, and the sum nearly. */
static long double scaled_height(const loose_scene *s, const loose_pair *pair, const double *x) {
    cscd_object object = cscd_mesh_object(s->mesh, pair->b);
    float113 sum = 0;
    for (size_t k = 0; k < 3; k++) {
        float113 offset = (float113)x[pair->a * 3 + k] - (float113)x[object.first_vertex * 3 + k];
        sum += offset * (float113)s->objects[pair->b].normal[k];
    }
    return (long double)sum;
}

static long double height_of(const loose_scene *s, const loose_pair *pair, const double *x) {
    const double *n = s->objects[pair->b].normal;
    long double squared = (long double)n[0] * n[0] + (long double)n[1] * n[1] + (long double)n[2] * n[2];
    return scaled_height(s, pair, x) / sqrtl(squared);
}

static bool half_space_meets(const loose_scene *s, const loose_pair *pair, const double *x0, const double *x1,
                             double distance, double *toi) {
    long double start = height_of(s, pair, x0) - distance, end = height_of(s, pair, x1) - distance;
    if (start > 0 && end > 0) return false;
    *toi = start <= 0 ? 0.0 : (double)(start / (start - end));
    return true;
}

bool loose_pair_meets(const loose_scene *s, const loose_pair *pair, const double *x0, const double *x1,
                      double distance, double *toi) {
    uint32_t points[4];
    if (pair->kind == CSCD_CONTACT_VH) return half_space_meets(s, pair, x0, x1, distance, toi);
    cscd_pair_contact found;
    cscd_pairs pairs = {points_of(s, pair, points), s->vertex_count, 1, points};
    assert_int_equal(cscd_pairs_step(s->context, &pairs, CSCD_DOUBLES(x0, s->vertex_count),
                                     CSCD_DOUBLES(x1, s->vertex_count), distance, 0.0, &found),
                     CSCD_OK);
    *toi = found.toi;
    return found.contact;
}

double loose_pair_apart(const loose_scene *s, const loose_pair *pair, const double *x) {
    uint32_t points[4];
    if (pair->kind == CSCD_CONTACT_VH) return (double)height_of(s, pair, x);
    cscd_pair_distance found;
    cscd_pairs pairs = {points_of(s, pair, points), s->vertex_count, 1, points};
    assert_int_equal(
        cscd_pairs_find_near(s->context, &pairs, CSCD_DOUBLES(x, s->vertex_count), INFINITY, &found),
        CSCD_OK);
    return found.distance;
}
