/* Points of wrong patches: the place of each on the other sheet, and the way there. */
#include "runtime/untangle/lenses.h"

#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* Points that are nearer than this to their places, in edge lengths, go along the normal there. */
static const double near_place = 1e-3;

/* The way out of a closed component has at least this share along the normal. */
static const double least_slope = 0.1;

/* The vector area of a patch is at least this share of its area, if it means something. */
static const double least_vector_area = 0.05;

static double sign_outwards(const lens_finder *f, uint32_t triangle) {
    return f->turned != NULL && f->turned[f->w->mesh->triangle_components[triangle]] ? -1.0 : 1.0;
}

void lens_normal(const lens_finder *f, const double *x, uint32_t triangle, double out[3]) {
    const uint32_t *corners = f->w->mesh->triangles[triangle];
    double u[3], v[3];
    vec3_subtract(x + 3 * (size_t)corners[1], x + 3 * (size_t)corners[0], u);
    vec3_subtract(x + 3 * (size_t)corners[2], x + 3 * (size_t)corners[0], v);
    vec3_cross(u, v, out);
    const double length = sqrt(vec3_dot(out, out)), sign = sign_outwards(f, triangle);
    for (int k = 0; k < 3; k++) out[k] = length > 0.0 ? sign * out[k] / length : 0.0;
}

static bool triangle_is_closed(const lens_finder *f, uint32_t triangle) {
    const cscd_mesh *mesh = f->w->mesh;
    return mesh->components[mesh->triangle_components[triangle]].closed_manifold;
}

/* Writes the place, and the way there from a point at `from`. The way out of a closed component leads along its normals, and from
 * where it is inside out against them; side is that of the point. */
void lens_take_place(const lens_finder *f, const double *x, const double *from, const set_place *place,
                     int side, lens_point *out) {
    const uint32_t *corners = f->w->mesh->triangles[place->triangle];
    double normal[3], way[3] = {-from[0], -from[1], -from[2]};
    lens_normal(f, x, place->triangle, normal);
    for (int i = 0; i < 3; i++) {
        out->vertices[2 + i] = corners[i];
        out->weights[2 + i] = -place->weights[i];
        vec3_add_scaled(way, place->weights[i], x + 3 * (size_t)corners[i], way);
    }
    const double length = sqrt(vec3_dot(way, way));
    const bool far = length > near_place * f->w->graph.edge_length;
    for (int k = 0; k < 3; k++) out->direction[k] = far ? way[k] / length : normal[k];
    out->thickness = length;
    out->along_normal = !far;
    out->triangle = place->triangle;
    if (side == 0 || !triangle_is_closed(f, place->triangle)) return;
    if (side * vec3_dot(out->direction, normal) < least_slope) {
        for (int k = 0; k < 3; k++) out->direction[k] = side * normal[k];
        out->thickness = 0.0;
        out->along_normal = true;
    }
}

bool lens_vector_area(const lens_finder *f, const double *x, uint32_t patch, bool *closed, double out[3]) {
    const cscd_mesh *mesh = f->w->mesh;
    double sum[3] = {0.0, 0.0, 0.0}, area = 0.0;
    *closed = false;
    for (size_t i = lens_finder_first(f, OF_VERTICES, patch);
         i < f->entry_counts[OF_VERTICES] && entry_patch(f->entries[OF_VERTICES][i]) == patch; i++) {
        const uint32_t v = entry_number(f->entries[OF_VERTICES][i]);
        for (uint32_t s = mesh->vertex_star_offsets[v]; s < mesh->vertex_star_offsets[v + 1]; s++) {
            const uint32_t t = mesh->vertex_stars[s], *corners = mesh->triangles[t];
            const bool whole = f->patches[corners[0]] == patch && f->patches[corners[1]] == patch &&
                               f->patches[corners[2]] == patch;
            double u[3], w[3], across[3];
            if (!whole || corners[0] != v) continue; /* each once */
            vec3_subtract(x + 3 * (size_t)corners[1], x + 3 * (size_t)corners[0], u);
            vec3_subtract(x + 3 * (size_t)corners[2], x + 3 * (size_t)corners[0], w);
            vec3_cross(u, w, across);
            vec3_add_scaled(sum, 0.5 * sign_outwards(f, t), across, sum);
            area += 0.5 * sqrt(vec3_dot(across, across));
            *closed = triangle_is_closed(f, t);
        }
    }
    const double length = sqrt(vec3_dot(sum, sum));
    if (!(length > least_vector_area * area)) return false;
    for (int k = 0; k < 3; k++) out[k] = sum[k] / length;
    return true;
}

/* The axis of a patch, if it has one: towards the other sheet, or for patches of closed components in others into the component,
 * and where that is inside out, out of it. */
static bool patch_axis(const lens_finder *f, const double *x, size_t first, size_t end, double out[3]) {
    const cscd_mesh *mesh = f->w->mesh;
    double own[3] = {0.0, 0.0, 0.0}, others[3] = {0.0, 0.0, 0.0};
    double towards = f->sides[entry_number(f->entries[OF_VERTICES][first])] < 0 ? 1.0 : -1.0;
    bool closed;
    if (!lens_vector_area(f, x, entry_patch(f->entries[OF_VERTICES][first]), &closed, out)) return false;
    if (!closed || f->set.count == 0 || !triangle_is_closed(f, f->set.items[0])) {
        for (size_t i = first; i < end; i++)
            vec3_add_scaled(own, 1.0 / (double)(end - first),
                            x + 3 * (size_t)entry_number(f->entries[OF_VERTICES][i]), own);
        for (uint32_t i = 0; i < f->set.count; i++) {
            const uint32_t *corners = mesh->triangles[f->set.items[i]];
            for (int k = 0; k < 3; k++)
                vec3_add_scaled(others, 1.0 / (3.0 * f->set.count), x + 3 * (size_t)corners[k], others);
        }
        vec3_subtract(others, own, others);
        towards = vec3_dot(others, out) >= 0.0 ? 1.0 : -1.0;
    }
    for (int k = 0; k < 3; k++) out[k] *= towards;
    return true;
}

/* Along the axis, as far as the other sheet reaches; a point that meets nothing goes as far as its nearest place. */
static void follow_axis(const lens_finder *f, const double *x, const double *from, const double axis[3],
                        lens_point *point) {
    const set_place hit = triangle_set_farthest_hit(&f->set, from, axis);
    if (hit.triangle != UINT32_MAX) {
        lens_take_place(f, x, from, &hit, 0, point);
        point->thickness = hit.distance;
    } else {
        point->thickness =
            min_of(point->thickness, max_of(point->thickness * vec3_dot(point->direction, axis), 0.0));
    }
    memcpy(point->direction, axis, sizeof(double[3]));
}

static bool has_vertex(const lens_finder *f, const lens_point *point, uint32_t vertex) {
    const uint32_t *names = f->w->graph.names;
    for (int i = 2; i < 5; i++) {
        if (names[point->vertices[i]] == names[vertex]) return true;
    }
    return false;
}

/* The curves of a patch with points. */
static bool decide_curves(lens_finder *f, uint32_t patch) {
    for (size_t i = lens_finder_first(f, OF_CURVES, patch);
         i < f->entry_counts[OF_CURVES] && entry_patch(f->entries[OF_CURVES][i]) == patch; i++) {
        if (!lens_finder_add(f, DECIDED, entry_number(f->entries[OF_CURVES][i]) / 2, 0)) return false;
    }
    return true;
}

bool lens_points_add(lens_finder *f, const cscd_curves *curves, const double *x, const lens_rules *rules,
                     size_t first, size_t end) {
    double axis[3];
    const uint32_t patch = entry_patch(f->entries[OF_VERTICES][first]);
    if (!lens_triangles_choose(f, curves, patch, rules->rings)) return false;
    if (f->triangle_count == 0) return true;
    if (!triangle_set_make(&f->set, f->w->mesh, x, f->triangles, (uint32_t)f->triangle_count, end - first))
        return false;
    const bool along = rules->along_axis && patch_axis(f, x, first, end, axis);
    const size_t before = f->point_count;
    for (size_t i = first; i < end; i++) {
        const uint32_t v = entry_number(f->entries[OF_VERTICES][i]);
        const double *from = x + 3 * (size_t)v;
        const set_place place = triangle_set_nearest(&f->set, from);
        lens_point point = {.vertices = {v, v},
                            .weights = {1.0, 0.0},
                            .reason = (cscd_lens_reason)f->reasons[v],
                            .group = patch,
                            .edge = UINT32_MAX};
        lens_take_place(f, x, from, &place, f->sides[v], &point);
        if (along) follow_axis(f, x, from, axis, &point);
        if (has_vertex(f, &point, v)) continue;
        if (!lens_finder_add_point(f, &point)) return false;
    }
    return f->point_count == before || decide_curves(f, patch);
}
