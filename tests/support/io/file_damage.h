/* Mesh files with random damage, read as meshes and as animations; used inside cmocka tests and by a fuzzer. */
#pragma once

#include "tests/support/io/mesh_check.h"

#include <stdint.h>

typedef struct file_damage_counts {
    uint32_t read, refused;        /* meshes */
    uint32_t animated, unanimated; /* of those that were read: animations */
} file_damage_counts;

/* Each round damages the file in one to four places, and checks that it is refused in one line, or gives numbers that are in
 * range. */
file_damage_counts file_damage_rounds(file_bytes file, uint32_t round_count, uint64_t seed);
