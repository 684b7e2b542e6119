/* Marks that have nothing in common are of triangles whose rings share no vertex. */
#include "runtime/narrow_phase/narrow_phase.h"
#include "src/mesh/mesh.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <string.h>

enum { WORDS = (SCENE_VERTICES_MAX + 63) / 64 };

/* Sets of vertices: of all triangles at a vertex, and of all triangles that share a vertex with one. */
static uint64_t stars[SCENE_VERTICES_MAX][WORDS], rings[SCENE_TRIANGLES_MAX][WORDS];
static uint64_t marks[SCENE_TRIANGLES_MAX];

static void collect_sets(const cscd_mesh *mesh) {
    memset(stars, 0, sizeof stars);
    memset(rings, 0, sizeof rings);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->triangles[t];
        for (int i = 0; i < 9; i++)
            stars[corners[i / 3]][corners[i % 3] / 64] |= (uint64_t)1 << corners[i % 3] % 64;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3 * WORDS; i++)
            rings[t][i % WORDS] |= stars[mesh->triangles[t][i / WORDS]][i % WORDS];
    }
}

static bool rings_share_vertex(uint32_t a, uint32_t b) {
    for (int i = 0; i < WORDS; i++) {
        if ((rings[a][i] & rings[b][i]) != 0) return true;
    }
    return false;
}

/* Returns how many pairs have nothing in common. */
static size_t check_marks(const cscd_mesh *mesh) {
    const object_range all = {.vertex_count = mesh->vertex_count, .triangle_count = mesh->triangle_count};
    const uint64_t owned = 0x2a;
    size_t disjoint = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) marks[t] = owned;
    assert_int_equal(ring_marks_add(mesh, &all, marks), CSCD_OK);
    collect_sets(mesh);
    for (uint32_t a = 0; a < mesh->triangle_count; a++) {
        assert_int_equal(marks[a] & 0x3f, owned);
        for (uint32_t b = a + 1; b < mesh->triangle_count; b++) {
            bool touch = rings_may_touch(marks[a], marks[b]);
            disjoint += !touch;
            assert_true(touch || !rings_share_vertex(a, b));
        }
    }
    return disjoint;
}

TEST(all_scenes) {
    static scene s;
    cscd_context *context = NULL;
    size_t disjoint = 0;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        cscd_mesh *mesh = NULL;
        scene_make((scene_family)family, 1, &s);
        const cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
        assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
        disjoint += check_marks(mesh);
        cscd_mesh_destroy(mesh);
    }
    print_message("%zu pairs of triangles have nothing in common\n", disjoint);
    assert_true(disjoint > 30000);
    cscd_context_destroy(context);
}
