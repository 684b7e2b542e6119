/* Measurements of the thesis: figures 5.2 to 5.4 and 6.4. */
#pragma once

/* Milliseconds, as means per frame; a negative stage is not part of the method. The range of the total
 * over five runs of k-means is that of figure 6.4. k 0: its own method; -1: ICCD. */
typedef struct thesis_row {
    int k;
    double update, orientation, contour, traversal, contact, pcp, total, least, most;
} thesis_row;

enum { THESIS_ROWS = 7 };

typedef struct thesis_experiment {
    const char *scene, *title;
    int regions;
    thesis_row rows[THESIS_ROWS]; /* those without a total are none */
} thesis_experiment;

/* The experiment that a recording of ours stands for; NULL: none. */
const thesis_experiment *thesis_experiment_of(const char *scene);
