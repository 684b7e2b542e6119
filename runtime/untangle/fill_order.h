/* Orders of elimination that keep the factors of sparse symmetric matrices sparse. */
#pragma once

#include "src/core/context.h"

/* A symmetric pattern: the neighbours of each row, without the row itself and without repetition. */
typedef struct row_graph {
    uint32_t row_count;
    const size_t *begins; /* row_count + 1 */
    const uint32_t *neighbours;
} row_graph;

/* Writes the rows in an order of little fill, by approximate minimum degree (Amestoy, Davis and Duff 1996). It depends on the graph
 * alone. CSCD_OUT_OF_MEMORY, or CSCD_CANCELLED; then nothing has been written. */
cscd_status fill_order_find(cscd_context *context, const row_graph *graph, uint32_t *order);
