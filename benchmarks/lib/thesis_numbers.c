/* Measurements of the thesis: figures 5.2 to 5.4 and 6.4. */
#include "benchmarks/lib/thesis_numbers.h"

#include <stdio.h>
#include <string.h>

/* Milliseconds, as means per frame; a negative stage is not part of the method. The range of the total
 * over five runs of k-means is that of figure 6.4. */
typedef struct thesis_row {
    const char *method;
    double update, orientation, contour, traversal, contact, pcp, total, least, most;
} thesis_row;

typedef struct thesis_experiment {
    const char *scene, *title;
    thesis_row rows[8]; /* up to one without a method */
} thesis_experiment;

static const thesis_experiment experiments[] = {
    {"pawn-drop",
     "Pawn, 5,130 triangles (figure 5.2)",
     {{"ours (3)", 3.0, 0.9, -1, 1.1, 1.8, 2281, 8.3, 8.3, 8.3},
      {"K = 1", 3.0, 0.8, -1, 1.5, 1.5, 1925, 8.4, 8.3, 8.4},
      {"K = 2", 3.0, 0.8, -1, 1.0, 1.3, 1580, 7.6, 7.5, 7.8},
      {"K = 3", 3.0, 0.8, -1, 1.3, 1.4, 1725, 8.1, 8.0, 8.1},
      {"K = 4", 3.0, 0.8, -1, 1.6, 1.6, 1892, 8.6, 8.5, 8.7},
      {"K = 5", 3.0, 0.8, -1, 1.6, 1.7, 1956, 8.6, 8.4, 9.1},
      {"ICCD", 3.1, -1, 7.3, 3.2, 2.7, 3089, 17.1, 17.1, 17.1}}},
    {"dumbbell-stairs",
     "Dumbbell, 1,710 triangles (figure 5.3)",
     {{"ours (2)", 1.0, 0.3, -1, 0.2, 0.3, 339, 2.3, 2.3, 2.3},
      {"K = 1", 1.1, 0.3, -1, 0.1, 0.1, 132, 2.3, 2.1, 2.4},
      {"K = 2", 1.0, 0.3, -1, 0.2, 0.3, 296, 2.4, 2.2, 2.5},
      {"K = 3", 1.1, 0.3, -1, 0.4, 0.4, 374, 2.8, 2.5, 3.1},
      {"K = 4", 1.1, 0.3, -1, 0.5, 0.5, 427, 2.9, 2.7, 3.3},
      {"ICCD", 0.9, -1, 2.3, 0.5, 0.5, 473, 4.5, 4.5, 4.5}}},
    {"figure-balls",
     "Luigi, 4,014 triangles (figure 5.4)",
     {{"ours (5)", 2.3, 0.6, -1, 0.9, 0.7, 766, 5.9, 5.9, 5.9},
      {"K = 3", 2.3, 0.6, -1, 1.0, 0.8, 800, 6.0, 5.8, 6.0},
      {"K = 4", 2.3, 0.6, -1, 1.1, 0.8, 806, 6.1, 6.1, 6.2},
      {"K = 5", 2.4, 0.6, -1, 1.1, 0.8, 824, 6.2, 5.8, 6.5},
      {"K = 6", 2.4, 0.6, -1, 1.1, 0.8, 810, 6.3, 5.9, 6.6},
      {"K = 7", 2.4, 0.6, -1, 1.1, 0.9, 845, 6.3, 6.2, 6.5},
      {"ICCD", 2.4, -1, 6.5, 1.9, 1.5, 1432, 12.9, 12.9, 12.9}}},
};

static void print_stage(double ms) {
    if (ms < 0.0)
        printf(" %7s", "X");
    else
        printf(" %7.1f", ms);
}

void thesis_numbers_print(const char *scene) {
    for (size_t i = 0; i < sizeof experiments / sizeof *experiments; i++) {
        const thesis_experiment *e = &experiments[i];
        if (strcmp(e->scene, scene) != 0) continue;
        printf(
            "  the thesis: %s; Core 2 Quad Q9400, 2.66 GHz; another mesh and recording, adjacent triangles\n"
            "  have no contact, contacts may be lost, TTCD counts more than these stages\n",
            e->title);
        for (const thesis_row *row = e->rows; row < e->rows + 8 && row->method != NULL; row++) {
            printf("  %-16s", row->method);
            print_stage(row->update);
            print_stage(row->orientation);
            print_stage(row->contour);
            print_stage(row->traversal);
            print_stage(row->contact);
            printf(" %7s %8.0f %8s %8s %6s %6s %7.1f %6.1f-%-6.1f\n", "X", row->pcp, "", "", "", "",
                   row->total, row->least, row->most);
        }
    }
}
