/* Which triangle answers for a feature, so that each pair of features is tested once. */
#ifndef CSCD_REPRESENTATIVES_H
#define CSCD_REPRESENTATIVES_H

#include "src/mesh.h"

/* One byte per triangle: bit i says that it represents its vertex i, bit 3 + i its edge i. A feature's
 * representative is the first triangle of its star (Tang et al. 2009). Complete as long as every overlapping
 * triangle pair is reached: the representatives' volumes contain the features'. NULL when out of memory. */
uint8_t *representatives_create(const cscd_mesh *mesh);

#endif
