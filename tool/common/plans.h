/* Plans: where a command finds one, how stiff the triangles of a recording are, the colours that show a plan,
 * and OpenBLAS. */
#pragma once

#include "cscd/cscd.h"
#include "tool/common/recording.h"

#include <stdbool.h>

/* A plan of method auto takes as long as 100 to 500 intervals of a replay of the same triangles. It is made
 * without being asked for where that is a tenth of all intervals of the recording, and for few triangles,
 * where it is a fraction of a second. */
enum { PLAN_PRICE_INTERVALS = 400, PLAN_FEW_TRIANGLES = 6000 };

/* pawn.obj -> pawn.plan.ply, in the same folder; to be freed, NULL when out of memory. */
char *plan_path_of_model(const char *model_path);

typedef struct plan_request {
    const char *model_path;
    const char *plan_path; /* NULL: the model's own, if there is one that fits */
    cscd_method method;    /* AUTO: whatever is best */
    uint32_t k;            /* with KMEANS; 0: the default */
    uint64_t ours;         /* with PUBLISHED: of a plan that is made */
    double min_separation;
    bool insists_on_plan; /* AUTO: makes a plan even where nothing can be culled */
} plan_request;

typedef enum plan_source { PLAN_FROM_NONE, PLAN_FROM_FILE, PLAN_FROM_MEMORY } plan_source;

/* "none", "file", "memory". */
const char *plan_source_name(plan_source source);

typedef struct plan_choice {
    cscd_plan *plan;      /* NULL: none */
    cscd_method method;   /* for the detector */
    cscd_method steps_by; /* the same, or AUTO: culled by it where that pays */
    plan_source source;
    char *path;       /* of the file */
    double made_ms;   /* in memory */
    char remark[600]; /* a sentence for people: why no better plan was taken; "" if there is nothing to say */
} plan_choice;

/* On false *out holds nothing. */
bool plan_choose(const plan_request *request, const recording *r, plan_choice *out, io_error *error);
void plan_choice_free(plan_choice *choice);

/* "charge, 4 regions, from pawn.plan.ply", and the remark. */
void plan_choice_print(const plan_choice *choice);

/* The stiffness of a recording's material, where its model files say it. */
typedef struct recorded_stiffness {
    double *of_triangle; /* of the mesh; NULL: no model says */
    const char *path;    /* of the first model that does */
    double least, greatest;
} recorded_stiffness;

/* Objects whose models do not say are as stiff everywhere. False: a value is not positive and finite, and
 * there is nothing to free. */
bool recorded_stiffness_read(const recording *r, recorded_stiffness *out, io_error *error);
void recorded_stiffness_free(recorded_stiffness *s);

/* ---- colours ------------------------------------------------------------------------------------------- */

/* One double per triangle, which the caller frees: the rank of the triangle's charge in its component, 0 for
 * the least and 1 for the most. Equal charges have equal ranks; in a component of one triangle the rank is 0.
 * NULL when out of memory. */
double *charge_ranks(const cscd_plan *plan, const cscd_mesh *mesh);

/* Red, green, blue per triangle: the colour of its charge's rank, dark violet for the least and yellow for
 * the most. False when out of memory. */
bool plan_colour_charge(const cscd_plan *plan, const cscd_mesh *mesh, uint8_t *colours);

/* The same by the density itself, from the least to the most of the component. */
bool plan_colour_density(const cscd_plan *plan, const cscd_mesh *mesh, uint8_t *colours);

/* Red, green, blue per triangle: the colour of its region. */
void plan_colour_regions(const cscd_plan *plan, uint32_t triangle_count, uint8_t *colours);

/* ---- OpenBLAS ------------------------------------------------------------------------------------------ */

/* The process is the tool's own, not one that has the tool as a library: it may change its environment. */
void blas_kernels_own_process(void);

/* Called before charge is solved for by a dense matrix, which loads OpenBLAS. That starts its threads and
 * chooses its kernels when it is loaded, and listens to the environment alone. So in a process of our own
 * this sets OPENBLAS_NUM_THREADS to 1, because the threads are ours, and lets another process find out which
 * kernels would be chosen: if these are below the processor's, it sets OPENBLAS_CORETYPE to what is better. A
 * variable that is set already is the user's choice and stays; warns: says on stderr when that leaves kernels
 * below the processor's. */
void blas_kernels_prepare(bool warns);
