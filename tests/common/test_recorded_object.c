/* The hash of a model, by which results of another one are refused. */
#include "tests/support/test.h"
#include "tool/common/recording.h"

#include <string.h>

TEST(models_differ_by_triangles_and_by_positions) {
    uint32_t triangles[2][6] = {{0, 1, 2, 2, 1, 3}, {0, 1, 2, 2, 3, 1}};
    double positions[2][12] = {{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}};
    uint64_t hashes[4];
    memcpy(positions[1], positions[0], sizeof positions[0]);
    positions[1][11] = 0x1p-40;
    for (int i = 0; i < 4; i++) {
        const recorded_object model = {.file = {.vertex_count = 4,
                                                .triangle_count = 2,
                                                .triangles = triangles[i % 2],
                                                .positions = positions[i / 2]}};
        hashes[i] = recorded_object_hash_model(&model);
        for (int k = 0; k < i; k++) assert_true(hashes[i] != hashes[k]);
    }
}
