/* The bodies that other tests use are closed, oriented and embedded, at any size. */
#include "runtime/triangle_intersection.h"
#include "tests/support/region_check.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static bool boxes_apart(const body *b, const uint32_t *s, const uint32_t *t) {
    for (uint32_t k = 0; k < 3; k++) {
        const double *p = b->positions + k;
        double s0 = p[s[0] * 3], s1 = p[s[1] * 3], s2 = p[s[2] * 3];
        double t0 = p[t[0] * 3], t1 = p[t[1] * 3], t2 = p[t[2] * 3];
        if (fmin(fmin(s0, s1), s2) > fmax(fmax(t0, t1), t2) ||
            fmin(fmin(t0, t1), t2) > fmax(fmax(s0, s1), s2))
            return true;
    }
    return false;
}

static void assert_embedded(const body *b) {
    for (uint32_t i = 0; i < b->triangle_count; i++) {
        const uint32_t *s = b->triangles + (size_t)i * 3;
        for (uint32_t j = i + 1; j < b->triangle_count; j++) {
            const uint32_t *t = b->triangles + (size_t)j * 3;
            assert_true(boxes_apart(b, s, t) || !triangles_intersect(s, t, b->positions));
        }
    }
}

static void bodies_are_embedded(void **state) {
    (void)state;
    for (int kind = 0; kind < BODY_KIND_COUNT; kind++) {
        for (uint32_t size = 1500; size <= 3000; size += 500) {
            body b = body_make_sized((body_kind)kind, size);
            assert_true(b.triangle_count > size - size / 10 && b.triangle_count < size + size / 6);
            cscd_mesh *mesh = body_mesh(&b, 1);
            assert_true(mesh->component_count == 1 && mesh->components[0].closed_manifold);
            assert_int_equal(mesh->components[0].euler_characteristic, 2);
            body_mesh_destroy(mesh);
            if (size <= 2000) assert_embedded(&b);
            body_free(&b);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(bodies_are_embedded)};
    return cmocka_run_group_tests_name("body shapes", tests, NULL, NULL);
}
