/* glTF files with random damage, read as meshes and as animations; used inside cmocka tests and by a fuzzer. */
#pragma once

#include "tests/support/io/mesh_check.h"

#include <stdint.h>

typedef struct gltf_damage_counts {
    uint32_t read, refused;        /* meshes */
    uint32_t animated, unanimated; /* of those that were read: animations */
} gltf_damage_counts;

/* Each round damages the file in one to four places, and checks that it is refused in one line, or gives numbers that are in
 * range. */
gltf_damage_counts gltf_damage_rounds(file_bytes file, uint32_t round_count, uint64_t seed);
