/* Takes parts as spheres of their areas: a part gets as many cells as other spheres can touch it at once. */
#include "sensors/cells.h"

#include "src/mesh/surface.h"

enum { KISSING_NUMBER = 12 };

static const double pi = 3.14159265358979323846, equal_within = 0.01;

uint32_t kissing_number(double radius, double other, uint32_t most) {
    double count = KISSING_NUMBER;
    if (!(fabs(radius - other) <= equal_within * fmax(radius, other))) {
        double sine = other / (radius + other);
        double cosine = sqrt(1.0 - sine * sine);
        count = floor(2.0 * (1.0 + cosine) / (sine * sine)); /* 2 / (1 - cosine), the ratio of areas */
    }
    return count < 1.0 ? 1 : count < most ? (uint32_t)count : most;
}

void find_radii(const sensor_partition *partition, const double *positions, double *radii) {
    const cscd_mesh *mesh = partition->mesh;
    for (uint32_t p = 0; p < partition->part_count; p++) radii[p] = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        radii[partition->triangle_parts[t]] += surface_area(mesh, positions, t);
    for (uint32_t p = 0; p < partition->part_count; p++) radii[p] = sqrt(radii[p] / (4.0 * pi));
}

/* ---- the smallest sphere that is watched --------------------------------------------------------------- */

/* The two smallest radii with different keys. */
typedef struct smallest {
    uint32_t keys[2];
    double radii[2];
} smallest;

static const smallest none = {{PARTITION_NONE, PARTITION_NONE}, {INFINITY, INFINITY}};

static void add_radius(smallest *s, uint32_t key, double radius) {
    if (radius < s->radii[0]) {
        if (key != s->keys[0]) {
            s->keys[1] = s->keys[0];
            s->radii[1] = s->radii[0];
        }
        s->keys[0] = key;
        s->radii[0] = radius;
    } else if (key != s->keys[0] && radius < s->radii[1]) {
        s->keys[1] = key;
        s->radii[1] = radius;
    }
}

static double smallest_but(const smallest *s, uint32_t key) {
    return s->radii[s->keys[0] == key];
}

typedef struct spheres {
    smallest all, bodies; /* by object; `bodies` leaves out obstacles */
    smallest *own;        /* per object, by its parts */
} spheres;

/* Parts without an area or a vertex of their own are left out, since nothing touches them. */
static void collect_radii(const sensor_partition *partition, const double *radii, spheres *s) {
    s->all = s->bodies = none;
    for (uint32_t object = 0; object < partition->object_count; object++) s->own[object] = none;
    for (uint32_t p = 0; p < partition->part_count; p++) {
        uint32_t object = partition->parts[p].object;
        if (radii[p] == 0.0 || partition->part_vertex_offsets[p] == partition->part_vertex_offsets[p + 1])
            continue;
        add_radius(&s->all, object, radii[p]);
        if (!partition->object_obstacles[object]) add_radius(&s->bodies, object, radii[p]);
        add_radius(&s->own[object], p, radii[p]);
    }
}

/* The radius of the smallest sphere that is watched with a part; INFINITY if there is none. */
static double smallest_watched(const sensor_partition *partition, const spheres *s, uint32_t part) {
    uint32_t object = partition->parts[part].object;
    bool obstacle = partition->object_obstacles[object];
    double radius = smallest_but(obstacle ? &s->bodies : &s->all, object);
    if (partition->options->within && !obstacle) radius = fmin(radius, smallest_but(&s->own[object], part));
    return radius;
}

/* ---- cells --------------------------------------------------------------------------------------------- */

static uint32_t count_for_part(const sensor_partition *partition, const spheres *s, double radius,
                               bool two_convex, uint32_t part) {
    if (partition->options->cells > 0) return partition->options->cells;
    double other = smallest_watched(partition, s, part);
    if (two_convex || isinf(other)) return 1;
    return kissing_number(radius, other, partition->options->cells_max);
}

cscd_status count_cells(const sensor_partition *partition, const double *radii, const bool *convex,
                        uint32_t *counts) {
    spheres s = {.own = context_allocate(partition->context, partition->object_count, sizeof *s.own)};
    if (s.own == NULL) return context_out_of_memory(partition->context);
    collect_radii(partition, radii, &s);
    bool two_convex = partition->object_count == 2 && partition->part_count == 2 && convex[0] && convex[1];
    const uint32_t *offsets = partition->part_vertex_offsets;
    for (uint32_t p = 0; p < partition->part_count; p++) {
        uint32_t count = count_for_part(partition, &s, radii[p], two_convex, p);
        uint32_t vertices = offsets[p + 1] - offsets[p];
        counts[p] = count < vertices ? count : vertices;
    }
    context_free(partition->context, s.own);
    return CSCD_OK;
}
