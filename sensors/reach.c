/* The distance mu below which particles give a warning, and the distance R_eff within which they feel each
 * other. Both are derived in docs/theory/sensors.md, whose lemmas are cited below. */
#include "sensors/reach.h"

#include "src/core/floating.h"
#include "src/core/vec3.h"

/* The sums and roots of mu lose less than this to rounding. */
static const double rounding = 1.0 + 0x1p-40;

cscd_status sensor_reach_create(const sensor_partition *partition, double mu_given, sensor_reach *reach) {
    reach->mu_given = mu_given;
    reach->parts = context_allocate(partition->context, partition->part_count, sizeof *reach->parts);
    return reach->parts != NULL ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

void sensor_reach_free(cscd_context *context, sensor_reach *reach) {
    context_free(context, reach->parts);
}

static double squared_distance(const double *x, uint32_t a, uint32_t b) {
    return vec3_squared_distance(x + (size_t)a * 3, x + (size_t)b * 3);
}

/* Finds the longest sides of each part's triangles, as squares. */
static void measure_edges(sensor_reach *reach, const sensor_partition *partition, const double *x0,
                          const double *x1) {
    const cscd_mesh *mesh = partition->mesh;
    double sum = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->triangles[t];
        double longest = 0.0;
        for (int k = 0; k < 3; k++) {
            uint32_t a = corners[k], b = corners[(k + 1) % 3];
            double at_start = squared_distance(x0, a, b);
            double side = max_of(at_start, squared_distance(x1, a, b));
            longest = max_of(longest, side);
            if (partition->vertex_cells[a] == partition->vertex_cells[b])
                reach->longest_inside = max_of(reach->longest_inside, side);
            sum += at_start;
        }
        for (int k = 0; k < 3; k++) {
            double *of_part = &reach->parts[partition->vertex_parts[corners[k]]].longest_edge;
            *of_part = max_of(*of_part, longest);
        }
    }
    reach->typical_edge = sqrt(sum / (3.0 * mesh->triangle_count));
}

static void measure_motion(part_reach *part, const sensor_partition *partition, uint32_t p, const double *x0,
                           const double *x1) {
    uint32_t begin = partition->part_vertex_offsets[p], end = partition->part_vertex_offsets[p + 1];
    for (uint32_t i = begin; i < end; i++) {
        size_t v = (size_t)partition->part_vertices[i] * 3;
        double d[3];
        vec3_subtract(x1 + v, x0 + v, d);
        for (int k = 0; k < 3; k++) {
            part->low[k] = i == begin ? d[k] : min_of(part->low[k], d[k]);
            part->high[k] = i == begin ? d[k] : max_of(part->high[k], d[k]);
        }
    }
}

/* mu for two parts with these longest edges and boxes of displacements: Lemma 3. */
static double mu_of(const part_reach *a, const part_reach *b) {
    double squares = a->longest_edge * a->longest_edge + b->longest_edge * b->longest_edge;
    double longest = max_of(a->longest_edge, b->longest_edge), relative = 0.0;
    for (int k = 0; k < 3; k++) {
        double most = max_of(a->high[k] - b->low[k], b->high[k] - a->low[k]);
        relative += most * most;
    }
    double nearest = max_of(sqrt(squares) / 2.0, longest / sqrt(3.0)); /* Lemmas 1 and 2 */
    return (nearest + sqrt(relative) / 2.0) * rounding;
}

double sensor_reach_mu(const sensor_reach *reach, uint32_t part_a, uint32_t part_b) {
    if (reach->mu_given > 0.0) return reach->mu_given;
    return mu_of(&reach->parts[part_a], &reach->parts[part_b]);
}

/* Takes all parts as one, which moves relative to itself as much as any two of them do. */
static double largest_mu(const sensor_reach *reach, const sensor_partition *partition) {
    if (reach->mu_given > 0.0) return reach->mu_given;
    part_reach all = {0};
    bool first = true;
    for (uint32_t p = 0; p < partition->part_count; p++) {
        if (partition->part_vertex_offsets[p] == partition->part_vertex_offsets[p + 1]) continue;
        const part_reach *part = &reach->parts[p];
        all.longest_edge = max_of(all.longest_edge, part->longest_edge);
        for (int k = 0; k < 3; k++) {
            all.low[k] = first ? part->low[k] : min_of(all.low[k], part->low[k]);
            all.high[k] = first ? part->high[k] : max_of(all.high[k], part->high[k]);
        }
        first = false;
    }
    return max_of(mu_of(&all, &all), LENGTH_MIN);
}

/* ---- R_eff -------------------------------------------------------------------------------------------- */

/* Returns an upper bound of the diameter: twice the distance of the farthest vertex from the centre of the
 * box. */
static double diameter_bound(const uint32_t *vertices, uint32_t count, const double *x) {
    double low[3] = {0}, high[3] = {0}, centre[3], farthest = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const double *at = x + (size_t)vertices[i] * 3;
        for (int k = 0; k < 3; k++) {
            low[k] = i == 0 ? at[k] : min_of(low[k], at[k]);
            high[k] = i == 0 ? at[k] : max_of(high[k], at[k]);
        }
    }
    for (int k = 0; k < 3; k++) centre[k] = low[k] + (high[k] - low[k]) / 2.0;
    for (uint32_t i = 0; i < count; i++) {
        double d[3];
        vec3_subtract(x + (size_t)vertices[i] * 3, centre, d);
        farthest = max_of(farthest, vec3_dot(d, d));
    }
    return 2.0 * sqrt(farthest);
}

/* Two particles whose areas touch are no farther apart than the two largest diameters. */
static double largest_two_diameters(const walk_areas *areas, const double *x0, const double *x1) {
    double first = 0.0, second = 0.0;
    for (uint32_t i = 0; i < areas->count; i++) {
        const uint32_t *vertices = areas->vertices + areas->offsets[i];
        uint32_t count = areas->offsets[i + 1] - areas->offsets[i];
        double diameter = max_of(diameter_bound(vertices, count, x0), diameter_bound(vertices, count, x1));
        second = max_of(second, min_of(first, diameter));
        first = max_of(first, diameter);
    }
    return first + second;
}

void sensor_reach_measure(sensor_reach *reach, const sensor_partition *partition, const walk_areas *areas,
                          const double *x0, const double *x1, double radius_given) {
    memset(reach->parts, 0, partition->part_count * sizeof *reach->parts);
    reach->longest_edge = reach->longest_inside = 0.0;
    measure_edges(reach, partition, x0, x1);
    reach->longest_inside = sqrt(reach->longest_inside) * rounding;
    for (uint32_t p = 0; p < partition->part_count; p++) {
        reach->parts[p].longest_edge = sqrt(reach->parts[p].longest_edge) * rounding;
        reach->longest_edge = max_of(reach->longest_edge, reach->parts[p].longest_edge);
        measure_motion(&reach->parts[p], partition, p, x0, x1);
    }
    reach->mu_most = largest_mu(reach, partition);
    double automatic = radius_given > 0.0 ? 0.0 : largest_two_diameters(areas, x0, x1);
    reach->radius = radius_given > 0.0 ? max_of(radius_given, reach->mu_most) : reach->mu_most + automatic;
}
