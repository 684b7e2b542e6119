/* Makes the labels of vertices connected along edges. */
#pragma once

#include "src/core/context.h"

/* A graph of all vertices, and workspace to connect the labels of a part. */
typedef struct connect_work {
    const uint32_t *offsets, *neighbours; /* of vertices, in their part only */
    uint32_t *labels;                     /* of vertices, changed */
    uint32_t *pieces;                     /* of vertices */
    uint32_t *queue;                      /* one per vertex of a part, as all below */
    uint32_t *piece_offsets;              /* and one more */
    uint32_t *piece_labels;
    bool *settled;  /* per piece */
    uint32_t *best; /* per label: a piece, a count or a number, by the step */
} connect_work;

/* vertices: all of a part, ascending; labels are below label_count. A label keeps its largest connected piece
 * (ties: the first). Another piece joins the neighbouring label with most edges to it (ties: the smaller),
 * and gets a label of its own if it reaches no piece with a label. Then labels are numbered again from
 * 0, by their first vertices; returns how many there are. */
uint32_t connect_labels(const connect_work *work, const uint32_t *vertices, uint32_t count,
                        uint32_t label_count);
