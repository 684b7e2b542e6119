/* Asserts the invariants of every partition, and makes bodies to divide. */
#pragma once

#include "cscd/sensors.h"
#include "sensors/partition.h"
#include "tests/support/preprocess/region_check.h"

/* Checks that each vertex with a triangle is in one cell of a part that has most of its triangles, that
 * cells are not empty, are numbered part by part and are connected, and that all lists agree. */
void check_partition(const cscd_partition *partition);

/* Makes a partition and checks it; the test fails when it cannot be made. */
cscd_partition *partition_of(const cscd_mesh *mesh, const cscd_plan *plan, const double *positions,
                             const cscd_partition_options *options);

/* Bodies of about 600 triangles stand beside each other as the components of one mesh, scaled; and its
 * partition. */
typedef struct partition_row {
    body b;
    cscd_mesh *mesh;
    cscd_partition *partition;
} partition_row;

partition_row row_of(uint32_t count, const body_kind *kinds, const double *scales,
                     const cscd_partition_options *options);
void row_free(partition_row *r);
