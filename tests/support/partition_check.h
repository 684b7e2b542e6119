/* What holds for every partition; used inside cmocka tests. */
#ifndef CSCD_TEST_PARTITION_CHECK_H
#define CSCD_TEST_PARTITION_CHECK_H

#include "src/partition.h"
#include "tests/support/region_check.h"

/* Each vertex with a triangle is in one cell of a part that has most of its triangles; cells are not empty,
 * are numbered part by part and connected; all lists agree. */
void check_partition(const cscd_partition *partition);

#endif
