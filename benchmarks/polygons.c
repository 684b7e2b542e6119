/* The time in which one face with many corners is cut into triangles. */
#include "tool/io/polygon.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char help[] =
    "usage: polygons [CORNERS [REPEATS]]\n"
    "\n"
    "Cuts polygons of CORNERS corners (default 500,000) into triangles: a star whose radii follow a sine, and one\n"
    "whose radii are random; a spiral; a comb; and two skylines, one above the other, of random heights. Seconds of\n"
    "processor time, the least of REPEATS runs (default 3), and nanoseconds per corner.\n";

typedef struct polygon_rig {
    uint32_t count;
    double *positions; /* three a corner */
    uint32_t *corners, (*triangles)[3];
} polygon_rig;

typedef struct polygon_shape {
    const char *name;
    void (*place)(uint32_t corner, uint32_t count, double point[2]);
} polygon_shape;

static const double pi = 3.14159265358979323846;

/* Noise in 0..1, the same in every run. */
static double noise_at(uint32_t index) {
    uint32_t h = index * 2654435769u + 0x9e3779b9u;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return (double)(h ^ h >> 16) / 4294967295.0;
}

static void place_around(double angle, double radius, double point[2]) {
    point[0] = radius * cos(angle);
    point[1] = radius * sin(angle);
}

static void place_smooth_star(uint32_t i, uint32_t n, double point[2]) {
    const double angle = 2.0 * pi * i / n;
    place_around(angle, 1.0 + 0.5 * sin(40.0 * angle), point);
}

static void place_random_star(uint32_t i, uint32_t n, double point[2]) {
    place_around(2.0 * pi * i / n, 0.2 + noise_at(i), point);
}

/* Outwards in 50 turns, and back between them. */
static void place_spiral(uint32_t i, uint32_t n, double point[2]) {
    const uint32_t half = n / 2, along = i < half ? i : n - 1 - i;
    const double turns = 50.0 * along / half;
    place_around(2.0 * pi * turns, 1.0 + turns + (i < half ? 0.0 : -0.5), point);
}

static void place_comb(uint32_t i, uint32_t n, double point[2]) {
    point[0] = i + 1 < n ? (double)i : 0.5 * n;
    point[1] = i + 1 < n ? (i % 2 == 0 ? 0.0 : -1000.0) : 1000.0;
}

static void place_skyline(uint32_t i, uint32_t n, double point[2]) {
    const uint32_t half = n / 2;
    point[0] = i < half ? (double)i : (double)(n - 1 - i);
    point[1] = i < half ? -0.1 - 100.0 * noise_at(i) : 0.1 + 100.0 * noise_at(i);
}

/* Whether the triangles have the area of the polygon, and none is reversed. */
static bool is_filled(const polygon_rig *r) {
    double filled = 0.0, area = 0.0;
    for (uint32_t t = 0; t < r->count; t++) {
        const double *a = r->positions + 3 * (size_t)t, *b = r->positions + 3 * (size_t)((t + 1) % r->count);
        area += a[0] * b[1] - a[1] * b[0];
        if (t + 2 >= r->count) continue;
        const double *p[3];
        for (int k = 0; k < 3; k++) p[k] = r->positions + 3 * (size_t)r->triangles[t][k];
        const double doubled =
            (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
        if (doubled < -1e-9 * (fabs(p[0][0]) + fabs(p[0][1]))) return false;
        filled += doubled;
    }
    return fabs(filled - area) <= 1e-6 * area;
}

static bool measure_shape(polygon_rig *r, const polygon_shape *shape, int repeats) {
    for (uint32_t i = 0; i < r->count; i++) {
        shape->place(i, r->count, r->positions + 3 * (size_t)i);
        r->positions[3 * (size_t)i + 2] = 0.0;
        r->corners[i] = i;
    }
    double least = INFINITY;
    polygon_result result = POLYGON_FILLED;
    for (int i = 0; i < repeats; i++) {
        const clock_t start = clock();
        result = polygon_fill(r->positions, r->corners, r->count, r->triangles);
        least = fmin(least, (double)(clock() - start) / CLOCKS_PER_SEC);
    }
    const bool good = result == POLYGON_FILLED && is_filled(r);
    printf("  %-12s %8.2f %8.0f%s\n", shape->name, least, 1e9 * least / r->count, good ? "" : "  WRONG");
    fflush(stdout);
    return good;
}

int main(int argument_count, char **arguments) {
    static const polygon_shape shapes[] = {{"smooth star", place_smooth_star},
                                           {"random star", place_random_star},
                                           {"spiral", place_spiral},
                                           {"comb", place_comb},
                                           {"skylines", place_skyline}};
    if (argument_count > 3 || (argument_count > 1 && strcmp(arguments[1], "--help") == 0)) {
        fputs(help, argument_count > 3 ? stderr : stdout);
        return argument_count > 3 ? 2 : 0;
    }
    const long count = argument_count > 1 ? strtol(arguments[1], NULL, 10) : 500000,
               repeats = argument_count > 2 ? strtol(arguments[2], NULL, 10) : 3;
    if (count < 100 || count > 100000000 || count % 2 != 0 || repeats < 1 || repeats > 1000) {
        fputs("polygons: CORNERS is an even number from 100 to 100,000,000, REPEATS from 1 to 1,000\n",
              stderr);
        return 2;
    }
    polygon_rig r = {.count = (uint32_t)count,
                     .positions = malloc((size_t)count * sizeof(double[3])),
                     .corners = malloc((size_t)count * sizeof(uint32_t)),
                     .triangles = malloc((size_t)count * sizeof(uint32_t[3]))};
    bool good = r.positions != NULL && r.corners != NULL && r.triangles != NULL;
    if (!good) fputs("polygons: out of memory\n", stderr);
    printf("%ld corners\n  %-12s %8s %8s\n", count, "shape", "seconds", "ns each");
    for (size_t i = 0; good && i < sizeof shapes / sizeof *shapes; i++)
        good = measure_shape(&r, &shapes[i], (int)repeats);
    free(r.positions);
    free(r.corners);
    free(r.triangles);
    return good ? 0 : 1;
}
