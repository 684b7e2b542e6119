/* What is said of each mesh among many: a line for people, and a line of JSON. */
#pragma once

#include "src/tool/each/mesh_job.h"

#include <stdio.h>

/* "shirt.obj: 34 pairs of triangles cross, 2 touch; 0.8 % of the faces", or ": clean", or why it was not checked. */
void answer_print(FILE *out, const char *path, const mesh_answer *answer);

/* One object and a line end: docs/formats.md. */
void answer_write_json(FILE *out, const char *path, const mesh_answer *answer);

/* So many meshes of a run. As in `check`, what lies in one plane or is folded touches, and duplicates do neither. */
typedef struct answer_sums {
    uint32_t clean, crossing, touching, duplicate,
        failed; /* each mesh is one of these, the worst that it is */
} answer_sums;

void answer_sums_add(answer_sums *sums, const mesh_answer *answer);

/* "1000 meshes: 940 clean, 58 with intersections, 2 failed". */
void answer_sums_print(FILE *out, const answer_sums *sums);
