/* Shades each triangle that a pixel sees once, at the middle of the samples it owns there (as multisampling
 * does), and averages in linear light. */
#include "tool/picture/shade.h"

#include "tool/picture/picture.h"

#include <math.h>
#include <string.h>

static double dot_product(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalise_vector(double v[3]) {
    double length = sqrt(dot_product(v, v));
    if (!(length > 0.0)) return;
    for (int i = 0; i < 3; i++) v[i] /= length;
}

/* Weights a triangle's normal at each corner by the angle there. So the parts of a flat side count as one,
 * however it is cut, and a large side of a box counts no more than a small one. */
static void add_face_normal(const double *positions, const uint32_t corners[3], float *out) {
    double edge[3][3];
    for (int k = 0; k < 3; k++) {
        const double *from = positions + 3 * (size_t)corners[k],
                     *to = positions + 3 * (size_t)corners[(k + 1) % 3];
        for (int i = 0; i < 3; i++) edge[k][i] = to[i] - from[i];
        normalise_vector(edge[k]);
    }
    double normal[3] = {edge[0][1] * edge[1][2] - edge[0][2] * edge[1][1],
                        edge[0][2] * edge[1][0] - edge[0][0] * edge[1][2],
                        edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0]};
    normalise_vector(normal);
    for (int k = 0; k < 3; k++) {
        double angle = acos(fmin(fmax(-dot_product(edge[k], edge[(k + 2) % 3]), -1.0), 1.0));
        for (int i = 0; i < 3; i++) out[3 * (size_t)corners[k] + (size_t)i] += (float)(angle * normal[i]);
    }
}

void picture_vertex_normals(const picture_camera *camera, const double *positions, uint32_t vertex_count,
                            const uint32_t *triangles, uint32_t triangle_count, float *out) {
    memset(out, 0, 3 * (size_t)vertex_count * sizeof *out);
    for (uint32_t triangle = 0; triangle < triangle_count; triangle++)
        add_face_normal(positions, triangles + 3 * (size_t)triangle, out);
    for (uint32_t vertex = 0; vertex < vertex_count; vertex++) {
        float *normal = out + 3 * (size_t)vertex;
        double turned[3];
        picture_camera_turn(camera, (const double[3]){normal[0], normal[1], normal[2]}, turned);
        normalise_vector(turned);
        for (int i = 0; i < 3; i++) normal[i] = (float)turned[i];
    }
}

/* Lights in camera space (right, down, forward), so that every view is lit alike: a warm key light from the
 * upper left, a cool fill from the right, a rim light from above and behind. */
typedef struct light {
    double direction[3]; /* towards the light, unit */
    double colour[3];
    double wrap; /* how far the light reaches around the terminator */
} light;

static const light lights[] = {
    {{-0.4243, -0.6364, -0.6442}, {0.86, 0.83, 0.78}, 0.15},
    {{0.8165, 0.0000, -0.5774}, {0.18, 0.20, 0.24}, 0.30},
    {{0.2425, -0.7276, 0.6417}, {0.36, 0.38, 0.42}, 0.00},
};

/* Ambient light from the sky above and from the ground. */
static const double sky[3] = {0.26, 0.27, 0.29}, ground[3] = {0.13, 0.12, 0.12};

static void light_surface(const double normal[3], const double view[3], double gloss, double colour[3]) {
    double upward = 0.5 - 0.5 * normal[1];
    double sum[3], half[3];
    for (int i = 0; i < 3; i++) sum[i] = sky[i] * upward + ground[i] * (1.0 - upward);
    for (size_t n = 0; n < sizeof lights / sizeof lights[0]; n++) {
        double cosine = (dot_product(normal, lights[n].direction) + lights[n].wrap) / (1.0 + lights[n].wrap);
        for (int i = 0; i < 3 && cosine > 0.0; i++) sum[i] += lights[n].colour[i] * cosine;
    }
    for (int i = 0; i < 3; i++) half[i] = lights[0].direction[i] + view[i];
    normalise_vector(half);
    double glint = gloss * pow(fmax(dot_product(normal, half), 0.0), 40.0);
    /* Darkens towards the outline, which could hardly be seen on a white background otherwise. */
    double facing = fmin(fmax(dot_product(normal, view), 0.0), 1.0);
    double outline = 1.0 - 0.45 * pow(1.0 - facing, 3.0);
    for (int i = 0; i < 3; i++) colour[i] = (colour[i] * sum[i] + glint) * outline;
}

typedef struct shading_pass {
    const picture_visibility *visibility;
    const picture_surface *surfaces;
    const picture_camera *camera;
    picture_gamma gamma;
} shading_pass;

static const uint8_t plain_colour[3] = {150, 172, 204}, back_tint[3] = {214, 138, 92};
static const uint8_t scenery_colour[3] = {190, 186, 177};

/* The triangle's colour with the given barycentric weights, linear. */
static void surface_colour(const shading_pass *pass, const picture_surface *surface, uint32_t triangle,
                           const double weights[3], bool front, double out[3]) {
    const uint32_t *corners = surface->triangles + 3 * (size_t)triangle;
    const uint8_t *flat = surface->triangle_colours != NULL ? surface->triangle_colours + 3 * (size_t)triangle
                          : surface->ground != NULL         ? scenery_colour
                          : surface->vertex_colours == NULL ? plain_colour
                                                            : NULL;
    bool tinted = !front && surface->ground == NULL && surface->shading != PICTURE_UNLIT;
    for (int i = 0; i < 3; i++) {
        out[i] = 0.0;
        if (flat != NULL) out[i] = pass->gamma.linear[flat[i]];
        for (int k = 0; k < 3 && flat == NULL; k++)
            out[i] +=
                weights[k] * pass->gamma.linear[surface->vertex_colours[3 * (size_t)corners[k] + (size_t)i]];
        if (tinted) out[i] = 0.35 * out[i] + 0.65 * pass->gamma.linear[back_tint[i]];
    }
}

/* The normal of the side that is seen. The edge functions, each the cross product of two corners, add up to
 * it; the transpose of the projection takes their sum from pixels to camera space. */
static void seen_normal(const picture_camera *camera, const picture_edges *edges, double out[3]) {
    double sum[3];
    for (int i = 0; i < 3; i++) sum[i] = -(edges->edge[0][i] + edges->edge[1][i] + edges->edge[2][i]);
    out[0] = camera->focal * sum[0];
    out[1] = camera->focal * sum[1];
    out[2] = camera->centre[0] * sum[0] + camera->centre[1] * sum[1] + sum[2];
    normalise_vector(out);
}

/* Cosine of the angle between a corner's normal and the face beyond which the edge is meant to be sharp: 40
 * degrees, less than along the edges of a box. */
static const double crease_cosine = 0.766;

static void interpolate_normal(const picture_surface *surface, const uint32_t corners[3],
                               const double weights[3], bool front, double normal[3]) {
    const double face[3] = {normal[0], normal[1], normal[2]};
    double side = front ? 1.0 : -1.0;
    double sum[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 3; k++) {
        const float *at = surface->normals + 3 * (size_t)corners[k];
        const double smooth[3] = {side * at[0], side * at[1], side * at[2]};
        const double *chosen = dot_product(smooth, face) >= crease_cosine ? smooth : face;
        for (int i = 0; i < 3; i++) sum[i] += weights[k] * chosen[i];
    }
    normalise_vector(sum);
    memcpy(normal, sum, sizeof sum);
}

/* The darkness that the wires give the point: a line one and a half pixels wide along the edges, fading
 * out where triangles are only a few pixels high. An edge function over its gradient is the distance in
 * pixels. */
static double wire_darkness(const picture_edges *edges, const double *projected, const uint32_t corners[3],
                            double x, double y) {
    double nearest = HUGE_VAL, height = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        double gradient = hypot(edges->edge[k][0], edges->edge[k][1]);
        if (!(gradient > 0.0)) return 0.0;
        double value = edges->edge[k][0] * x + edges->edge[k][1] * y + edges->edge[k][2];
        double depth = projected[3 * (size_t)corners[k] + 2];
        nearest = fmin(nearest, fabs(value) / gradient);
        if (depth > 0.0) height = fmin(height, edges->volume / (depth * gradient));
    }
    double line = fmin(fmax(1.1 - nearest, 0.0), 1.0);
    double fade = fmin(fmax((height - 3.0) / 6.0, 0.0), 1.0);
    return 0.55 * line * fade;
}

/* Lights the colour by the surface's normal at pixel coordinates (x, y), at the depth 1 / inverse_depth. */
static void light_point(const shading_pass *pass, const picture_surface *surface, const uint32_t corners[3],
                        const picture_edges *edges, const double weights[3], double x, double y,
                        double inverse_depth, double colour[3]) {
    const picture_camera *camera = pass->camera;
    double normal[3];
    double view[3] = {(camera->centre[0] - x) / camera->focal, (camera->centre[1] - y) / camera->focal, -1.0};
    normalise_vector(view);
    seen_normal(camera, edges, normal);
    if (surface->normals != NULL) interpolate_normal(surface, corners, weights, edges->front, normal);
    light_surface(normal, view, surface->ground == NULL ? 0.10 : 0.0, colour);
    if (surface->ground == NULL || !(inverse_depth > 0.0)) return;
    double share = picture_ground_light(surface->ground, camera, normal, view, x, y, 1.0 / inverse_depth);
    for (int i = 0; i < 3; i++) colour[i] *= share;
}

/* The linear colour of the triangle at pixel coordinates (x, y). */
static void shade_point(const shading_pass *pass, uint32_t number, double x, double y, double out[3]) {
    const picture_surface *surface = pass->surfaces;
    while (number >= surface->triangle_count) number -= surface++->triangle_count;
    const uint32_t *corners = surface->triangles + 3 * (size_t)number;
    picture_edges edges;
    picture_edges_set(surface->projected, corners, &edges);
    double weights[3], total = 0.0;
    for (int k = 0; k < 3; k++) {
        weights[k] = fmax(edges.edge[k][0] * x + edges.edge[k][1] * y + edges.edge[k][2], 0.0);
        total += weights[k];
    }
    for (int k = 0; k < 3; k++) weights[k] = total > 0.0 ? weights[k] / total : 1.0 / 3.0;
    surface_colour(pass, surface, number, weights, edges.front, out);
    if (surface->shading != PICTURE_UNLIT)
        light_point(pass, surface, corners, &edges, weights, x, y, total / edges.volume, out);
    if (!surface->wire) return;
    double light_left = 1.0 - wire_darkness(&edges, surface->projected, corners, x, y);
    for (int i = 0; i < 3; i++) out[i] *= light_left;
}

/* The triangles that one pixel sees, and where. */
typedef struct pixel_samples {
    uint32_t triangle[PICTURE_SAMPLES_MAX * PICTURE_SAMPLES_MAX];
    double x[PICTURE_SAMPLES_MAX * PICTURE_SAMPLES_MAX], y[PICTURE_SAMPLES_MAX * PICTURE_SAMPLES_MAX];
    double share[PICTURE_SAMPLES_MAX * PICTURE_SAMPLES_MAX]; /* x and y are sums over as many samples */
    uint32_t count;
} pixel_samples;

static void gather_samples(const picture_visibility *visibility, uint32_t column, uint32_t row,
                           pixel_samples *out) {
    uint32_t samples = visibility->samples;
    out->count = 0;
    for (uint32_t j = row * samples; j < (row + 1) * samples; j++) {
        const uint32_t *line = visibility->triangle + (size_t)j * visibility->width * samples;
        for (uint32_t i = column * samples; i < (column + 1) * samples; i++) {
            if (line[i] == PICTURE_NO_TRIANGLE) continue;
            uint32_t n = 0;
            while (n < out->count && out->triangle[n] != line[i]) n++;
            if (n == out->count) {
                out->triangle[out->count++] = line[i];
                out->x[n] = out->y[n] = out->share[n] = 0.0;
            }
            out->x[n] += (i + 0.5) / samples;
            out->y[n] += (j + 0.5) / samples;
            out->share[n] += 1.0;
        }
    }
}

static void shade_pixel(const shading_pass *pass, uint32_t column, uint32_t row, bool transparent,
                        uint8_t pixel[4]) {
    pixel_samples seen;
    gather_samples(pass->visibility, column, row, &seen);
    double sum[3] = {0.0, 0.0, 0.0}, covered = 0.0;
    for (uint32_t n = 0; n < seen.count; n++) {
        double colour[3], share = seen.share[n];
        shade_point(pass, seen.triangle[n], seen.x[n] / share, seen.y[n] / share, colour);
        for (int i = 0; i < 3; i++) sum[i] += share * fmin(colour[i], 1.0);
        covered += share;
    }
    double all = pass->visibility->samples * pass->visibility->samples;
    double white = transparent ? 0.0 : all - covered;
    double weight = transparent ? fmax(covered, 1.0) : all;
    for (int i = 0; i < 3; i++) pixel[i] = picture_gamma_encode(&pass->gamma, (sum[i] + white) / weight);
    pixel[3] = transparent ? (uint8_t)(255.0 * covered / all + 0.5) : 255;
}

void picture_shade(const picture_visibility *visibility, const picture_surface *surfaces,
                   const picture_camera *camera, bool transparent, picture_image *image) {
    shading_pass pass = {.visibility = visibility, .surfaces = surfaces, .camera = camera};
    picture_gamma_set(&pass.gamma);
    for (uint32_t row = 0; row < image->height; row++)
        for (uint32_t column = 0; column < image->width; column++)
            shade_pixel(&pass, column, row, transparent,
                        image->pixels + 4 * ((size_t)row * image->width + column));
}
