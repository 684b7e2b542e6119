/* One frame untangled, and the measures and promises of the result. */
#pragma once

#include "benchmarks/untangle/corpus.h"
#include "cscd/cscd.h"
#include "cscd/untangle.h"

/* What the header promises and a result has broken, as bits. */
typedef enum broken_promise {
    BROKEN_WORSE = 1,   /* it is neither the input, bit for bit, nor has fewer pairs */
    BROKEN_CLEAN = 2,   /* it is said to be clean, and is not */
    BROKEN_COUNTS = 4,  /* pairs or displacement are not those that are said */
    BROKEN_PINNED = 8,  /* a pinned vertex has moved */
    BROKEN_START = 16,  /* from a clean start it is not clean */
    BROKEN_SEAM = 32,   /* a seam has come open */
    BROKEN_PROMISES = 6 /* how many there are */
} broken_promise;

typedef struct untangle_case {
    const corpus_entry *entry;
    uint32_t frame, triangle_count;
    bool followed; /* from a clean frame of the recording; else by itself */
    bool clean;    /* by the exact check of the positions as stored */
    size_t pairs_before, pairs_after;
    size_t pairs_as_floats; /* when the result is rounded to floats */
    cscd_untangled found;
    double seconds, displacement;
    double edge;   /* the mean length of an edge */
    double jitter; /* followed: the greatest change of the displacement from the frame before */
    double quality_before, quality_after; /* least: 4 sqrt(3) area / sum of squared edges */
    uint32_t flips;                       /* triangles whose normals turned by more than 90 degrees */
    uint32_t smooth_flips; /* of them, those that were within 90 degrees of all their neighbours */
    uint32_t creases;      /* edges folded by more than 120 degrees that were not so before */
    uint32_t broken;       /* promises */
} untangle_case;

typedef struct untangle_trial {
    const corpus_entry *entry;
    tangle_scene scene;
    cscd_context *context; /* the caller's */
    cscd_mesh *mesh;
    cscd_detector *detector, *judge;
    size_t *pairs;                    /* of each frame */
    bool *tangled;                    /* each frame: it has pairs, or features within the gap */
    uint32_t (*edges)[2], edge_count; /* triangles on both sides; of non-manifold edges, some */
    bool *turned;                     /* per edge: the two triangles are not oriented alike */
    bool floats;                      /* positions are given and stored as floats */
    double gap;                       /* min_separation */
    double steady;
    double max_seconds;
    bool wall_time; /* else the processor time of this process */
    double *reached, *start, *start_input;
    float *narrow[4]; /* with floats: the same three, and the input */
} untangle_trial;

/* The gap is in lengths of a mean edge of the first frame. */
bool untangle_trial_open(const corpus_entry *entry, cscd_context *context, double gap, untangle_trial *out,
                         io_error *error);
void untangle_trial_close(untangle_trial *t);

/* Untangles a frame into t->reached; from_start: from t->start, which belongs to t->start_input. */
bool untangle_trial_run(untangle_trial *t, uint32_t frame, bool from_start, untangle_case *out,
                        io_error *error);

/* Writes FOLDER/SCENE-FRAME-before.obj and -after.obj of the case that ran last. */
bool untangle_trial_write(const untangle_trial *t, const untangle_case *c, const char *folder,
                          io_error *error);
