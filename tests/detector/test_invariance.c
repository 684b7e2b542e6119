/* The pairs that mode all reports do not depend on scale, numbering, direction of time, or bulk motion. */
#include "cscd/cscd.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static scene interval, other; /* large; one test at a time */

/* The pairs of a step as sorted keys, with vertices and triangles mapped back by the permutations. */
typedef struct pair_set {
    uint32_t keys[20000][5];
    size_t count;
} pair_set;

static int compare_keys(const void *left, const void *right) {
    return memcmp(left, right, sizeof(uint32_t[5]));
}

static void sort_two(uint32_t *a, uint32_t *b) {
    if (*a <= *b) return;
    uint32_t swap = *a;
    *a = *b;
    *b = swap;
}

static void collect_pairs(const scene *s, const uint32_t *old_vertex, const uint32_t *old_triangle,
                          pair_set *out) {
    rig r = rig_create(s, 1, NULL);
    cscd_contacts found = rig_step(&r, s);
    out->count = found.count;
    assert_true(found.count <= 20000);
    for (size_t i = 0; i < found.count; i++) {
        const cscd_contact *c = &found.items[i];
        uint32_t key[5] = {(uint32_t)c->kind, c->a, c->b, 0, 0};
        if (c->kind == CSCD_CONTACT_EE) {
            cscd_mesh_edge(r.mesh, c->a, key + 1);
            cscd_mesh_edge(r.mesh, c->b, key + 3);
            for (int k = 1; k < 5; k++) key[k] = old_vertex != NULL ? old_vertex[key[k]] : key[k];
            sort_two(&key[1], &key[2]);
            sort_two(&key[3], &key[4]);
            if (key[1] > key[3]) {
                sort_two(&key[1], &key[3]);
                uint32_t swap = key[2];
                key[2] = key[4];
                key[4] = swap;
            }
        } else if (old_vertex != NULL) {
            key[1] = old_vertex[c->a];
            key[2] = old_triangle[c->b];
        }
        memcpy(out->keys[i], key, sizeof key);
    }
    qsort(out->keys, out->count, sizeof out->keys[0], compare_keys);
    rig_destroy(&r);
}

static pair_set expected_pairs, found_pairs;

static void assert_same_pairs(void) {
    assert_int_equal(found_pairs.count, expected_pairs.count);
    assert_memory_equal(found_pairs.keys, expected_pairs.keys,
                        found_pairs.count * sizeof found_pairs.keys[0]);
}

static const scene_family generic_families[] = {SCENE_NOISY_SPHERE, SCENE_FOLDED_SHEET, SCENE_TWO_SPHERES,
                                                SCENE_LINKED_TORI,  SCENE_BOW_TIE,      SCENE_SOUP};
enum { GENERIC_COUNT = sizeof generic_families / sizeof *generic_families, SEEDS = 8 };

static void for_generic_scenes(void (*change)(scene *), bool reversed) {
    for (int i = 0; i < GENERIC_COUNT; i++) {
        for (uint64_t seed = 100; seed < 100 + SEEDS; seed++) {
            scene_make(generic_families[i], seed, &interval);
            collect_pairs(&interval, NULL, NULL, &expected_pairs);
            other = interval;
            if (reversed) {
                memcpy(other.x0, interval.x1, sizeof other.x0);
                memcpy(other.x1, interval.x0, sizeof other.x1);
            }
            if (change != NULL) change(&other);
            collect_pairs(&other, NULL, NULL, &found_pairs);
            assert_same_pairs();
        }
    }
}

static void scale_up(scene *s) {
    for (uint32_t i = 0; i < s->vertex_count * 3; i++) {
        s->x0[i] *= 0x1p80;
        s->x1[i] *= 0x1p80;
    }
}

static void scale_down(scene *s) {
    for (uint32_t i = 0; i < s->vertex_count * 3; i++) {
        s->x0[i] *= 0x1p-90;
        s->x1[i] *= 0x1p-90;
    }
}

TEST(same_pairs_when_scaled) {
    for_generic_scenes(scale_up, false);
    for_generic_scenes(scale_down, false);
}

TEST(same_pairs_in_reversed_time) {
    for_generic_scenes(NULL, true);
}

/* Rounds to 20 bits below 1, so that moving by whole numbers is exact, and moves x1. */
static void round_positions(scene *s) {
    for (uint32_t i = 0; i < s->vertex_count * 3; i++) {
        s->x0[i] = (s->x0[i] + 0x1p32) - 0x1p32;
        s->x1[i] = (s->x1[i] + 0x1p32) - 0x1p32;
    }
}

TEST(same_pairs_under_bulk_motion) {
    static const double motion[3] = {64.0, -32.0, 17.0};
    for (int i = 0; i < GENERIC_COUNT; i++) {
        scene_make(generic_families[i], 200, &interval);
        round_positions(&interval);
        collect_pairs(&interval, NULL, NULL, &expected_pairs);
        other = interval;
        for (uint32_t k = 0; k < other.vertex_count * 3; k++) other.x1[k] += motion[k % 3];
        collect_pairs(&other, NULL, NULL, &found_pairs);
        assert_same_pairs();
    }
}

/* Vertices and triangles are numbered in reverse order, and corners are rotated. */
TEST(same_pairs_when_renumbered) {
    static uint32_t old_vertex[SCENE_VERTICES_MAX], old_triangle[SCENE_TRIANGLES_MAX];
    for (int i = 0; i < GENERIC_COUNT; i++) {
        scene_make(generic_families[i], 300, &interval);
        collect_pairs(&interval, NULL, NULL, &expected_pairs);
        other = interval;
        for (uint32_t v = 0; v < interval.vertex_count; v++) {
            old_vertex[v] = interval.vertex_count - 1 - v;
            memcpy(other.x0 + (size_t)v * 3, interval.x0 + (size_t)old_vertex[v] * 3, 3 * sizeof(double));
            memcpy(other.x1 + (size_t)v * 3, interval.x1 + (size_t)old_vertex[v] * 3, 3 * sizeof(double));
        }
        for (uint32_t t = 0; t < interval.triangle_count; t++) {
            old_triangle[t] = interval.triangle_count - 1 - t;
            for (uint32_t k = 0; k < 3; k++)
                other.triangles[t * 3 + k] =
                    interval.vertex_count - 1 - interval.triangles[old_triangle[t] * 3 + (k + 1) % 3];
        }
        collect_pairs(&other, old_vertex, old_triangle, &found_pairs);
        assert_same_pairs();
    }
}
