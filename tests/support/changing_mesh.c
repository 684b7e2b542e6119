/* Scenes of several objects that tear, are refined, lose triangles, are renumbered, come and go; and their meshes. */
#include "tests/support/changing_mesh.h"

#include "tests/support/test.h"

#include <string.h>

/* ---- objects ------------------------------------------------------------------------------------------ */

static void add_piece(random_stream *random, scene *s) {
    double centre[3];
    for (int k = 0; k < 3; k++) centre[k] = stream_between(random, -1.5, 1.5);
    uint32_t kind = stream_below(random, 3), begin = s->vertex_count;
    if (kind == 0) scene_add_sphere(s, centre, 0.7, 4 + (int)stream_below(random, 2), 5);
    if (kind == 1) scene_add_torus(s, centre, 0.8, 0.3, 5, 4, false);
    if (kind == 2) {
        scene_add_sheet(s, 1.5, 1.5, 4, 4);
        for (uint32_t v = begin; v < s->vertex_count; v++) {
            for (size_t k = 0; k < 3; k++) s->x0[3 * v + k] += centre[k];
        }
    }
    for (uint32_t i = begin * 3; i < s->vertex_count * 3; i++)
        s->x0[i] += stream_between(random, -0.02, 0.02);
}

static void flip_triangle(uint32_t *corners) {
    uint32_t first = corners[0];
    corners[0] = corners[1];
    corners[1] = first;
}

static void make_object(random_stream *random, bool with_obstacles, changing_object *out) {
    static scene s;
    scene_clear(&s);
    uint32_t pieces = 1 + stream_below(random, 3);
    for (uint32_t i = 0; i < pieces; i++) add_piece(random, &s);
    *out = (changing_object){.vertex_count = s.vertex_count, .triangle_count = s.triangle_count};
    out->obstacle = with_obstacles && stream_below(random, 4) == 0;
    memcpy(out->triangles, s.triangles, s.triangle_count * sizeof(uint32_t[3]));
    memcpy(out->positions, s.x0, s.vertex_count * sizeof(double[3]));
    if (stream_below(random, 6) == 0)
        flip_triangle(out->triangles + stream_below(random, s.triangle_count) * 3);
}

void changing_scene_make(random_stream *random, bool with_obstacles, changing_scene *out) {
    out->object_count = 3 + stream_below(random, 2);
    for (uint32_t i = 0; i < out->object_count; i++) make_object(random, with_obstacles, &out->objects[i]);
}

void changing_scene_describe(const changing_scene *s, cscd_object_desc *descs) {
    for (uint32_t i = 0; i < s->object_count; i++) {
        const changing_object *o = &s->objects[i];
        descs[i] = cscd_object_of_triangles(o->vertex_count, o->triangle_count, o->triangles);
        descs[i].obstacle = o->obstacle;
    }
}

void changing_scene_join(const changing_scene *from, scene *out) {
    out->vertex_count = out->triangle_count = 0;
    for (uint32_t i = 0; i < from->object_count; i++) {
        const changing_object *o = &from->objects[i];
        for (uint32_t k = 0; k < o->triangle_count * 3; k++)
            out->triangles[out->triangle_count * 3 + k] = out->vertex_count + o->triangles[k];
        memcpy(out->x0 + out->vertex_count * 3, o->positions, o->vertex_count * sizeof(double[3]));
        memcpy(out->x1 + out->vertex_count * 3, o->positions, o->vertex_count * sizeof(double[3]));
        out->vertex_count += o->vertex_count;
        out->triangle_count += o->triangle_count;
    }
}

/* ---- changes of one object ---------------------------------------------------------------------------- */

typedef struct object_edit {
    random_stream *random;
    changing_object *object;
    uint32_t *vertex_origins, *triangle_origins;
} object_edit;

static uint32_t add_vertex(object_edit *e, const double position[3], uint32_t origin) {
    changing_object *o = e->object;
    memcpy(o->positions + o->vertex_count * 3, position, sizeof(double[3]));
    e->vertex_origins[o->vertex_count] = origin;
    return o->vertex_count++;
}

/* Gives some of the triangles at a vertex a copy of it. Afterwards copies move apart, as the caller likes. */
static bool tear_at(object_edit *e, uint32_t vertex) {
    changing_object *o = e->object;
    uint32_t corners[CHANGING_TRIANGLES_MAX], count = 0;
    for (uint32_t i = 0; i < o->triangle_count * 3; i++) {
        if (o->triangles[i] == vertex) corners[count++] = i;
    }
    if (count < 2 || o->vertex_count == CHANGING_VERTICES_MAX) return false;
    uint32_t copy = add_vertex(e, o->positions + vertex * 3, e->vertex_origins[vertex]);
    uint32_t share = 1 + stream_below(e->random, count - 1);
    for (uint32_t i = 0; i < share; i++) o->triangles[corners[i]] = copy;
    return true;
}

static uint32_t random_corner(const object_edit *e) {
    return e->object->triangles[stream_below(e->random, e->object->triangle_count * 3)];
}

static void refine_triangle(object_edit *e) {
    changing_object *o = e->object;
    if (o->triangle_count + 2 > CHANGING_TRIANGLES_MAX || o->vertex_count == CHANGING_VERTICES_MAX) return;
    uint32_t t = stream_below(e->random, o->triangle_count), origin = e->triangle_origins[t];
    uint32_t *corners = o->triangles + t * 3, a = corners[0], b = corners[1], c = corners[2];
    double centre[3];
    for (size_t k = 0; k < 3; k++)
        centre[k] = (o->positions[a * 3 + k] + o->positions[b * 3 + k] + o->positions[c * 3 + k]) / 3;
    uint32_t middle = add_vertex(e, centre, UINT32_MAX);
    bool named = stream_below(e->random, 2) == 0;
    corners[2] = middle;
    memcpy(o->triangles + o->triangle_count * 3, (uint32_t[]){b, c, middle, c, a, middle},
           6 * sizeof(uint32_t));
    e->triangle_origins[t] = named ? origin : UINT32_MAX;
    for (int i = 0; i < 2; i++) e->triangle_origins[o->triangle_count++] = named ? origin : UINT32_MAX;
}

static void remove_triangle(object_edit *e) {
    changing_object *o = e->object;
    if (o->triangle_count < 4) return;
    uint32_t t = stream_below(e->random, o->triangle_count);
    memmove(o->triangles + t * 3, o->triangles + (t + 1) * 3,
            (o->triangle_count - t - 1) * sizeof(uint32_t[3]));
    memmove(e->triangle_origins + t, e->triangle_origins + t + 1,
            (o->triangle_count - t - 1) * sizeof(uint32_t));
    o->triangle_count--;
}

/* Exchanges the numbers of two vertices and of two triangles. */
static void renumber_two(object_edit *e) {
    changing_object *o = e->object;
    uint32_t a = stream_below(e->random, o->vertex_count), b = stream_below(e->random, o->vertex_count);
    for (uint32_t i = 0; i < o->triangle_count * 3; i++) {
        uint32_t v = o->triangles[i];
        o->triangles[i] = v == a ? b : v == b ? a : v;
    }
    uint32_t origin = e->vertex_origins[a];
    e->vertex_origins[a] = e->vertex_origins[b];
    e->vertex_origins[b] = origin;
    for (size_t k = 0; k < 3; k++) {
        double x = o->positions[a * 3 + k];
        o->positions[a * 3 + k] = o->positions[b * 3 + k];
        o->positions[b * 3 + k] = x;
    }
    uint32_t s = stream_below(e->random, o->triangle_count), t = stream_below(e->random, o->triangle_count);
    uint32_t corners[3], from = e->triangle_origins[s];
    memcpy(corners, o->triangles + s * 3, sizeof corners);
    memmove(o->triangles + s * 3, o->triangles + t * 3, sizeof corners);
    memcpy(o->triangles + t * 3, corners, sizeof corners);
    e->triangle_origins[s] = e->triangle_origins[t];
    e->triangle_origins[t] = from;
}

static void edit_object(object_edit *e) {
    uint32_t count = stream_below(e->random, 6);
    uint32_t kind = stream_below(e->random, 5);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t what = kind < 4 ? kind : stream_below(e->random, 4);
        if (what == 0) tear_at(e, random_corner(e));
        if (what == 1) refine_triangle(e);
        if (what == 2) remove_triangle(e);
        if (what == 3) renumber_two(e);
    }
}

/* ---- changes of a scene -------------------------------------------------------------------------------- */

static object_edit begin_edit(random_stream *random, changing_object *o, scene_change *c) {
    object_edit e = {random, o, c->vertex_origins[c->count], c->triangle_origins[c->count]};
    for (uint32_t i = 0; i < CHANGING_VERTICES_MAX; i++) e.vertex_origins[i] = i;
    for (uint32_t i = 0; i < CHANGING_TRIANGLES_MAX; i++) e.triangle_origins[i] = i;
    return e;
}

/* Numbers that have not changed need not be said. */
static bool are_same(const uint32_t *origins, uint32_t count, uint32_t before) {
    for (uint32_t i = 0; i < count; i++) {
        if (origins[i] != (i < before ? i : UINT32_MAX)) return false;
    }
    return true;
}

static void add_change(scene_change *c, uint32_t object, bool removed) {
    c->list[c->count] = (cscd_object_change){.object = object, .desc = removed ? NULL : &c->descs[c->count]};
    c->count++;
}

static void edit_one(random_stream *random, changing_object *o, uint32_t number, scene_change *c) {
    object_edit e = begin_edit(random, o, c);
    uint32_t vertices = o->vertex_count, triangles = o->triangle_count;
    cscd_object_change *change = &c->list[c->count];
    edit_object(&e);
    add_change(c, number, false);
    if (!are_same(e.vertex_origins, o->vertex_count, vertices)) change->vertex_origins = e.vertex_origins;
    if (!are_same(e.triangle_origins, o->triangle_count, triangles))
        change->triangle_origins = e.triangle_origins;
}

static void describe_changes(changing_scene *s, scene_change *c, const uint32_t *places) {
    cscd_object_desc descs[CHANGING_OBJECTS_MAX];
    changing_scene_describe(s, descs);
    for (uint32_t i = 0; i < c->count; i++) {
        if (c->list[i].desc != NULL) c->descs[i] = descs[places[i]];
    }
}

void changing_scene_change(random_stream *random, changing_scene *s, scene_change *out) {
    uint32_t places[2 * CHANGING_OBJECTS_MAX], kept = 0, before = s->object_count;
    bool any_left = stream_below(random, 20) != 0;
    out->count = 0;
    for (uint32_t i = 0; i < before; i++) {
        uint32_t what = stream_below(random, 8);
        changing_object *o = &s->objects[kept];
        memmove(o, &s->objects[i], sizeof *o);
        if (what == 0 && (kept > 0 || !any_left)) {
            add_change(out, i, true);
            continue;
        }
        places[out->count] = kept++;
        if (what == 1) {
            o->obstacle = !o->obstacle;
            begin_edit(random, o, out);
            add_change(out, i, false);
        }
        if (what == 2 || what == 3 || what == 4) edit_one(random, o, i, out);
    }
    s->object_count = kept;
    uint32_t added = kept == 0 ? 1 : stream_below(random, 4) == 0;
    for (uint32_t i = 0; i < added && s->object_count < CHANGING_OBJECTS_MAX; i++) {
        make_object(random, false, &s->objects[s->object_count]);
        places[out->count] = s->object_count++;
        add_change(out, UINT32_MAX, false);
    }
    describe_changes(s, out, places);
}

bool changing_scene_tear(random_stream *random, changing_scene *s, uint32_t object, scene_change *out) {
    uint32_t places[1] = {object};
    out->count = 0;
    object_edit e = begin_edit(random, &s->objects[object], out);
    if (!tear_at(&e, random_corner(&e))) return false;
    add_change(out, object, false);
    out->list[0].vertex_origins = e.vertex_origins;
    describe_changes(s, out, places);
    return true;
}

/* ---- their meshes -------------------------------------------------------------------------------------- */

cscd_mesh *changing_scene_mesh(cscd_context *context, const changing_scene *s) {
    cscd_object_desc descs[CHANGING_OBJECTS_MAX];
    cscd_mesh *mesh = NULL;
    changing_scene_describe(s, descs);
    assert_int_equal(cscd_mesh_create(context, descs, s->object_count, &mesh), CSCD_OK);
    return mesh;
}

#define SAME_ARRAY(a, b, member, count)                                                                      \
    assert_memory_equal((a)->member, (b)->member, (count) * sizeof *(a)->member)

void check_same_mesh(const cscd_mesh *a, const cscd_mesh *b) {
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->edge_count, b->edge_count);
    assert_int_equal(a->triangle_count, b->triangle_count);
    assert_int_equal(a->component_count, b->component_count);
    assert_int_equal(a->object_count, b->object_count);
    size_t corners = (size_t)a->triangle_count * 3;
    SAME_ARRAY(a, b, triangles, a->triangle_count);
    SAME_ARRAY(a, b, edges, a->edge_count);
    SAME_ARRAY(a, b, triangle_edges, a->triangle_count);
    SAME_ARRAY(a, b, vertex_star_offsets, a->vertex_count + 1u);
    SAME_ARRAY(a, b, vertex_stars, corners);
    SAME_ARRAY(a, b, edge_star_offsets, a->edge_count + 1u);
    SAME_ARRAY(a, b, edge_stars, corners);
    SAME_ARRAY(a, b, triangle_components, a->triangle_count);
    SAME_ARRAY(a, b, components, a->component_count);
    SAME_ARRAY(a, b, objects, a->object_count);
    assert_true((a->obstacles == NULL) == (b->obstacles == NULL));
    if (a->obstacles != NULL) SAME_ARRAY(a, b, obstacles, a->component_count);
    assert_true(cscd_mesh_hash(a) == cscd_mesh_hash(b));
}
