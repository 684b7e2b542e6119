/* The surface of tetrahedra: the faces that only one of them has, with the maps back to vertices and tetrahedra. */
#include "src/mesh/mesh.h"

#include "src/core/entry.h"
#include "src/core/sort.h"

#include <string.h>

/* The faces of a tetrahedron, outwards if its vertices are in positive order. */
static const uint8_t FACE_CORNERS[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

/* Faces are numbered 4 t + i, for face i of tetrahedron t. */
enum { TETRAHEDRA_MAX = (1 << 30) - 1 };

struct cscd_tet_surface {
    reference_count references; /* the caller alone */
    cscd_context *context;
    cscd_tet_surface_arrays arrays;
    uint32_t *triangles, *vertices, *tetrahedra; /* what the arrays show */
};

/* A face, with what it is sorted by. */
typedef struct face_key {
    uint64_t number, face;
} face_key;

/* A search for the surface, and its memory. */
typedef struct tet_search {
    cscd_context *context;
    const uint32_t (*tetrahedra)[4];
    uint32_t tetrahedron_count, vertex_count;
    face_key *keys, *spare_keys;
    bool *outer;       /* per face: no other tetrahedron has it */
    uint32_t *numbers; /* per vertex: its number on the surface, from 1 on; 0: it is not on the surface */
    size_t outer_count, surface_vertex_count;
} tet_search;

static array_list search_arrays(tet_search *s) {
    const size_t faces = 4 * (size_t)s->tetrahedron_count;
    return (array_list){{ARRAY(s->keys, faces), ARRAY(s->spare_keys, faces), ARRAY(s->outer, faces),
                         ARRAY(s->numbers, s->vertex_count)}};
}

static void load_face(const tet_search *s, uint64_t face, uint32_t out[3]) {
    for (int i = 0; i < 3; i++) out[i] = s->tetrahedra[face / 4][FACE_CORNERS[face % 4][i]];
}

/* Sorts the vertices of a face. Returns whether that turns it over. */
static bool sort_face(uint32_t v[3]) {
    bool turned = false;
    for (int i = 0; i < 3; i++) {
        const int at = i % 2; /* 0 and 1, 1 and 2, 0 and 1 */
        if (v[at] <= v[at + 1]) continue;
        const uint32_t kept = v[at];
        v[at] = v[at + 1];
        v[at + 1] = kept;
        turned = !turned;
    }
    return turned;
}

/* ---- what is wrong ------------------------------------------------------------------------------------- */

static cscd_status check_tetrahedron(const tet_search *s, uint32_t t) {
    const uint32_t *v = s->tetrahedra[t];
    for (int i = 0; i < 4; i++) {
        if (v[i] >= s->vertex_count)
            return context_fail(s->context, CSCD_INVALID_MESH,
                                "tetrahedron %u has the vertex %u, but there are only %u", t, v[i],
                                s->vertex_count);
        for (int j = 0; j < i; j++) {
            if (v[i] == v[j])
                return context_fail(s->context, CSCD_INVALID_MESH, "tetrahedron %u has the vertex %u twice",
                                    t, v[i]);
        }
    }
    return CSCD_OK;
}

static cscd_status check_tetrahedra(const tet_search *s) {
    cscd_status status = CSCD_OK;
    for (uint32_t t = 0; t < s->tetrahedron_count && status == CSCD_OK; t++) status = check_tetrahedron(s, t);
    return status;
}

static uint32_t tetrahedron_of(const face_key *key) {
    return (uint32_t)(key->face / 4);
}

static cscd_status fail_with_three(const tet_search *s, const face_key *keys) {
    uint32_t v[3];
    load_face(s, keys[0].face, v);
    return context_fail(s->context, CSCD_INVALID_MESH,
                        "the tetrahedra %u, %u and %u have the face of the vertices %u, %u and %u; at most "
                        "two may",
                        tetrahedron_of(&keys[0]), tetrahedron_of(&keys[1]), tetrahedron_of(&keys[2]), v[0],
                        v[1], v[2]);
}

static cscd_status fail_with_one_side(const tet_search *s, const face_key *keys) {
    uint32_t v[3];
    load_face(s, keys[0].face, v);
    return context_fail(s->context, CSCD_INVALID_MESH,
                        "the tetrahedra %u and %u lie on one side of their face of the vertices %u, %u and "
                        "%u; exchange two vertices of the one with a negative volume",
                        tetrahedron_of(&keys[0]), tetrahedron_of(&keys[1]), v[0], v[1], v[2]);
}

/* ---- faces --------------------------------------------------------------------------------------------- */

/* Sorts the faces by their three vertices, in two passes of a stable sort; those of three equal vertices then follow each
 * other in the order of their tetrahedra. */
static void sort_faces(tet_search *s) {
    const size_t count = 4 * (size_t)s->tetrahedron_count;
    uint32_t v[3];
    for (size_t face = 0; face < count; face++) {
        load_face(s, face, v);
        sort_face(v);
        s->keys[face] = (face_key){v[2], face};
    }
    sort_by_number(s->keys, s->spare_keys, count, sizeof *s->keys);
    for (size_t i = 0; i < count; i++) {
        load_face(s, s->keys[i].face, v);
        sort_face(v);
        s->keys[i].number = (uint64_t)v[0] << 32 | v[1];
    }
    sort_by_number(s->keys, s->spare_keys, count, sizeof *s->keys);
}

static bool same_face(const tet_search *s, const face_key *a, const face_key *b) {
    uint32_t v[3], w[3];
    if (a->number != b->number) return false;
    load_face(s, a->face, v);
    load_face(s, b->face, w);
    sort_face(v);
    sort_face(w);
    return v[2] == w[2];
}

static bool face_is_turned(const tet_search *s, const face_key *key) {
    uint32_t v[3];
    load_face(s, key->face, v);
    return sort_face(v);
}

static cscd_status mark_outer(tet_search *s) {
    const size_t count = 4 * (size_t)s->tetrahedron_count;
    for (size_t begin = 0, end = 0; begin < count; begin = end) {
        const face_key *keys = s->keys + begin;
        while (end < count && same_face(s, keys, &s->keys[end])) end++;
        if (end - begin > 2) return fail_with_three(s, keys);
        if (end - begin == 2 && face_is_turned(s, &keys[0]) == face_is_turned(s, &keys[1]))
            return fail_with_one_side(s, keys);
        s->outer[keys[0].face] = end - begin == 1;
        s->outer_count += end - begin == 1;
    }
    return CSCD_OK;
}

static void number_vertices(tet_search *s) {
    for (size_t face = 0; face < 4 * (size_t)s->tetrahedron_count; face++) {
        uint32_t v[3];
        if (!s->outer[face]) continue;
        load_face(s, face, v);
        for (int i = 0; i < 3; i++) s->numbers[v[i]] = 1;
    }
    for (uint32_t v = 0; v < s->vertex_count; v++)
        if (s->numbers[v] != 0) s->numbers[v] = (uint32_t)++s->surface_vertex_count;
}

/* ---- the object ---------------------------------------------------------------------------------------- */

static array_list surface_arrays(cscd_tet_surface *s) {
    const size_t triangles = s->arrays.triangle_count;
    return (array_list){{ARRAY(s->triangles, 3 * triangles), ARRAY(s->tetrahedra, triangles),
                         ARRAY(s->vertices, s->arrays.vertex_count)}};
}

static void free_surface(reference_count *references) {
    cscd_tet_surface *surface = (cscd_tet_surface *)references;
    cscd_context *context = surface->context;
    context_free_all(context, surface_arrays(surface));
    context_free(context, surface);
    context_release(context);
}

static void fill_surface(const tet_search *s, cscd_tet_surface *to) {
    size_t count = 0;
    for (size_t face = 0; face < 4 * (size_t)s->tetrahedron_count; face++) {
        uint32_t v[3];
        if (!s->outer[face]) continue;
        load_face(s, face, v);
        for (size_t i = 0; i < 3; i++) to->triangles[3 * count + i] = s->numbers[v[i]] - 1;
        to->tetrahedra[count++] = (uint32_t)(face / 4);
    }
    for (uint32_t v = 0; v < s->vertex_count; v++)
        if (s->numbers[v] != 0) to->vertices[s->numbers[v] - 1] = v;
    to->arrays.triangles = to->triangles;
    to->arrays.vertices = to->vertices;
    to->arrays.tetrahedra = to->tetrahedra;
}

static cscd_status make_surface(const tet_search *s, cscd_tet_surface **out) {
    cscd_tet_surface *surface = context_allocate(s->context, 1, sizeof *surface);
    if (surface == NULL) return CSCD_OUT_OF_MEMORY;
    surface->context = s->context;
    surface->arrays.triangle_count = (uint32_t)s->outer_count;
    surface->arrays.vertex_count = (uint32_t)s->surface_vertex_count;
    if (!context_allocate_all(s->context, surface_arrays(surface))) {
        context_free(s->context, surface);
        return CSCD_OUT_OF_MEMORY;
    }
    fill_surface(s, surface);
    context_add_object(s->context, &surface->references, free_surface);
    *out = surface;
    return CSCD_OK;
}

static cscd_status find_surface(tet_search *s, cscd_tet_surface **out) {
    cscd_status status = check_tetrahedra(s);
    if (status != CSCD_OK) return status;
    if (!context_allocate_all(s->context, search_arrays(s))) return CSCD_OUT_OF_MEMORY;
    sort_faces(s);
    status = mark_outer(s);
    if (status == CSCD_OK && s->outer_count > UINT32_MAX / 3)
        status = context_fail(s->context, CSCD_INVALID_MESH, "the surface has %zu triangles, at most %u fit",
                              s->outer_count, UINT32_MAX / 3);
    number_vertices(s);
    if (status == CSCD_OK) status = make_surface(s, out);
    context_free_all(s->context, search_arrays(s));
    return status;
}

static cscd_status create_surface(cscd_context *context, const uint32_t *tetrahedra, size_t tetrahedron_count,
                                  uint32_t vertex_count, cscd_tet_surface **out) {
    if (out == NULL || tetrahedra == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_tet_surface_create: %s is NULL",
                            out == NULL ? "out" : "tetrahedra");
    if (tetrahedron_count == 0 || tetrahedron_count > TETRAHEDRA_MAX)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "tetrahedron_count is %zu, expected a number from 1 to %d", tetrahedron_count,
                            TETRAHEDRA_MAX);
    tet_search search = {.context = context,
                         .tetrahedra = (const uint32_t(*)[4])tetrahedra,
                         .tetrahedron_count = (uint32_t)tetrahedron_count,
                         .vertex_count = vertex_count};
    cscd_status status = find_surface(&search, out);
    return status == CSCD_OUT_OF_MEMORY ? context_out_of_memory(context) : status;
}

cscd_status cscd_tet_surface_create(cscd_context *context, const uint32_t *tetrahedra,
                                    size_t tetrahedron_count, uint32_t vertex_count, cscd_tet_surface **out) {
    if (context == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, create_surface(context, tetrahedra, tetrahedron_count, vertex_count, out));
}

void cscd_tet_surface_destroy(cscd_tet_surface *surface) {
    if (surface != NULL) context_destroy_object(surface->context, &surface->references);
}

cscd_tet_surface_arrays cscd_tet_surface_get(const cscd_tet_surface *surface) {
    return surface->arrays;
}
