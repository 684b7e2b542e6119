/* A frame of a recording as a scene, with the contacts of its interval if they are wanted, or painted with a
 * plan. */
#include "tool/render/render.h"

#include "tool/common/plans.h"
#include "tool/picture/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- contacts ------------------------------------------------------------------------------------------ */

static const uint8_t plain_colour[3] = {176, 190, 207};
static const uint8_t contact_colour[3] = {255, 176, 66};
static const uint8_t kind_colours[2][4] = {{0, 90, 181, 255}, {220, 50, 32, 255}};
static const picture_legend kinds[] = {{{0, 90, 181}, "vertex-face contact"},
                                       {{220, 50, 32}, "edge-edge contact"},
                                       {{255, 176, 66}, "triangles in contact"}};

bool contact_picture_load(contact_picture *p, const recording *r, io_error *error) {
    const cscd_mesh *mesh = r->mesh;
    size_t vertex_count = cscd_mesh_vertex_count(mesh), triangle_count = cscd_mesh_triangle_count(mesh);
    p->positions = malloc(vertex_count * 3 * sizeof *p->positions);
    p->triangles = malloc(triangle_count * 3 * sizeof *p->triangles);
    p->colours = malloc(triangle_count * 3);
    if (p->positions == NULL || p->triangles == NULL || p->colours == NULL)
        return io_fail(error, "out of memory");
    for (uint32_t t = 0; t < triangle_count; t++) cscd_mesh_triangle(mesh, t, p->triangles + (size_t)t * 3);
    p->scene.vertex_count = cscd_mesh_vertex_count(mesh);
    p->scene.triangle_count = cscd_mesh_triangle_count(mesh);
    p->scene.positions = p->positions;
    p->scene.triangles = p->triangles;
    p->scene.triangle_colours = p->colours;
    p->scene.caption = p->caption;
    contact_picture_clear(p);
    return true;
}

/* Colours the triangles that contain a feature in contact. */
static bool colour_features(contact_picture *p, const cscd_mesh *mesh, const cscd_contacts *contacts,
                            io_error *error) {
    unsigned char *vertices = calloc(cscd_mesh_vertex_count(mesh), 1);
    unsigned char *edges = calloc(cscd_mesh_edge_count(mesh), 1);
    unsigned char *faces = calloc(cscd_mesh_triangle_count(mesh), 1);
    bool allocated = vertices != NULL && edges != NULL && faces != NULL;
    for (size_t i = 0; allocated && i < contacts->count; i++) {
        const cscd_contact *contact = &contacts->items[i];
        bool vf = contact->kind == CSCD_CONTACT_VF;
        (vf ? vertices : edges)[contact->a] = 1;
        (vf ? faces : edges)[contact->b] = 1;
    }
    for (uint32_t t = 0; allocated && t < cscd_mesh_triangle_count(mesh); t++) {
        const uint32_t *v = p->triangles + (size_t)t * 3;
        bool touches = faces[t] != 0;
        for (int i = 0; i < 3; i++)
            touches |= vertices[v[i]] != 0 || edges[recording_find_edge(mesh, v[i], v[(i + 1) % 3])] != 0;
        if (touches) memcpy(p->colours + (size_t)t * 3, contact_colour, 3);
    }
    free(vertices);
    free(edges);
    free(faces);
    return allocated || io_fail(error, "out of memory");
}

static bool place_markers(contact_picture *p, const cscd_contacts *contacts, io_error *error) {
    p->markers = calloc(contacts->count + 1, sizeof *p->markers);
    if (p->markers == NULL) return io_fail(error, "out of memory");
    float radius = contacts->count > 500 ? 3.0f : contacts->count > 50 ? 4.0f : 6.0f;
    for (size_t i = 0; i < contacts->count; i++) {
        picture_marker *marker = &p->markers[i];
        memcpy(marker->position, contacts->items[i].point, sizeof marker->position);
        memcpy(marker->colour, kind_colours[contacts->items[i].kind], sizeof marker->colour);
        marker->radius_pixels = radius;
    }
    p->scene.markers = p->markers;
    p->scene.marker_count = contacts->count;
    return true;
}

static bool create_detector(contact_picture *p, const recording *r, io_error *error) {
    if (p->detector != NULL) return true;
    cscd_detector_options options = cscd_detector_defaults();
    if (p->ignored != NULL) ignore_pairs_choose(p->ignored, &options);
    p->end = malloc((size_t)cscd_mesh_vertex_count(r->mesh) * 3 * sizeof *p->end);
    return (p->end != NULL &&
            cscd_detector_create(r->context, r->mesh, NULL, &options, &p->detector) == CSCD_OK) ||
           io_fail(error, "out of memory");
}

static bool mark_contacts(contact_picture *p, recording *r, uint32_t frame, io_error *error) {
    cscd_contacts contacts;
    if (!create_detector(p, r, error) || !recording_read(r, frame + 1, p->end, error)) return false;
    if (cscd_detector_step(p->detector, CSCD_DOUBLES(p->positions, cscd_mesh_vertex_count(r->mesh)),
                           CSCD_DOUBLES(p->end, cscd_mesh_vertex_count(r->mesh)), &contacts) != CSCD_OK)
        return io_fail(error, "frame %d: %s", r->frame_numbers[frame], cscd_context_detail(r->context));
    cscd_counters counters = cscd_detector_counters(p->detector);
    p->vf_count = counters.vf;
    p->ee_count = counters.ee;
    snprintf(p->caption, sizeof p->caption, "frame %d to %d: %llu VF and %llu EE contacts",
             r->frame_numbers[frame], r->frame_numbers[frame + 1], (unsigned long long)p->vf_count,
             (unsigned long long)p->ee_count);
    p->scene.legend = kinds;
    p->scene.legend_count = sizeof kinds / sizeof *kinds;
    return colour_features(p, r->mesh, &contacts, error) && place_markers(p, &contacts, error);
}

bool contact_picture_show(contact_picture *p, recording *r, uint32_t frame, bool contacts, io_error *error) {
    if (!recording_read(r, frame, p->positions, error)) return false;
    snprintf(p->caption, sizeof p->caption, "frame %d", r->frame_numbers[frame]);
    if (!contacts) return true;
    contact_picture_clear(p);
    return mark_contacts(p, r, frame, error);
}

void contact_picture_clear(contact_picture *p) {
    for (uint32_t t = 0; t < p->scene.triangle_count; t++)
        memcpy(p->colours + (size_t)t * 3, plain_colour, 3);
    free(p->markers);
    p->markers = NULL;
    p->scene.markers = NULL;
    p->scene.marker_count = p->scene.legend_count = 0;
    p->vf_count = p->ee_count = 0;
}

void contact_picture_kind_colour(int kind, uint8_t rgb[3]) {
    memcpy(rgb, kind_colours[kind], 3);
}

/* The longest side of the body's box. */
static double body_size(const contact_picture *p) {
    double size = 0.0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t v = 0; v < p->scene.vertex_count; v++) {
            low = fmin(low, p->positions[(size_t)v * 3 + (size_t)k]);
            high = fmax(high, p->positions[(size_t)v * 3 + (size_t)k]);
        }
        size = fmax(size, high - low);
    }
    return size;
}

void contact_picture_focus(const contact_picture *p, picture_options *options) {
    if (p->scene.marker_count == 0) return;
    double widest = 0.0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < p->scene.marker_count; i++) {
            low = fmin(low, p->markers[i].position[k]);
            high = fmax(high, p->markers[i].position[k]);
        }
        options->focus_min[k] = low;
        options->focus_max[k] = high;
        widest = fmax(widest, high - low);
    }
    const double margin = fmax(0.5 * widest, 0.05 * body_size(p));
    for (int k = 0; k < 3; k++) {
        options->focus_min[k] -= margin;
        options->focus_max[k] += margin;
    }
    options->focus = true;
}

void contact_picture_free(contact_picture *p) {
    free(p->positions);
    free(p->triangles);
    free(p->colours);
    free(p->markers);
    free(p->end);
    cscd_detector_destroy(p->detector);
    *p = (contact_picture){0};
}

/* ---- plans --------------------------------------------------------------------------------------------- */

/* A white dot and what it stands for. */
static void add_line(contact_picture *picture, plan_legend *legend, const char *text) {
    size_t i = picture->scene.legend_count++;
    memset(legend->lines[i].colour, 255, 3);
    snprintf(legend->texts[i], sizeof legend->texts[i], "%s", text);
    legend->lines[i].text = legend->texts[i];
}

static void legend_of_charge(contact_picture *picture, plan_legend *legend) {
    static const char *const texts[] = {"least", "25 %", "50 %", "75 %", "most"};
    picture->scene.legend_count = 5;
    for (int i = 0; i < 5; i++) {
        picture_colour_map(0.25 * i, legend->lines[i].colour);
        legend->lines[i].text = texts[i];
    }
}

static void legend_of_regions(contact_picture *picture, plan_legend *legend, const cscd_plan *plan) {
    uint32_t count = cscd_plan_region_count(plan);
    uint32_t shown = count > PLAN_LEGEND_REGIONS ? PLAN_LEGEND_REGIONS : count;
    for (uint32_t i = 0; i < shown; i++) {
        picture_colour_category(i, legend->lines[i].colour);
        snprintf(legend->texts[i], sizeof legend->texts[i], "region %u, %.1f %% seen", i,
                 100.0 * cscd_plan_region(plan, i).visible_share);
        legend->lines[i].text = legend->texts[i];
    }
    picture->scene.legend_count = shown;
    if (shown == count) return;
    char text[32];
    snprintf(text, sizeof text, "and %u more", count - shown);
    add_line(picture, legend, text);
}

bool plan_picture_paint(contact_picture *picture, plan_legend *legend, const recording *r,
                        const cscd_plan *plan, colouring by, io_error *error) {
    uint32_t count = cscd_mesh_triangle_count(r->mesh), regions = cscd_plan_region_count(plan);
    bool frame_shown = recording_moves(r);
    size_t used = frame_shown ? strlen(picture->caption) : 0;
    const char *colon = frame_shown ? ": " : "";
    picture->scene.legend = legend->lines;
    if (by != COLOUR_REGION) {
        const bool ranks = by == COLOUR_CHARGE;
        snprintf(picture->caption + used, sizeof picture->caption - used, "%scharge%s", colon,
                 ranks ? " by rank" : " density");
        legend_of_charge(picture, legend);
        return (ranks ? plan_colour_charge : plan_colour_density)(plan, r->mesh, picture->colours) ||
               io_fail(error, "out of memory");
    }
    snprintf(picture->caption + used, sizeof picture->caption - used, "%s%u region%s, %s", colon, regions,
             regions == 1 ? "" : "s", cscd_method_name(cscd_plan_method(plan)));
    legend_of_regions(picture, legend, plan);
    plan_colour_regions(plan, count, picture->colours);
    return true;
}

bool plan_picture_mark(contact_picture *picture, plan_legend *legend, const cscd_plan *plan,
                       io_error *error) {
    uint32_t count = cscd_plan_region_count(plan);
    picture->markers = calloc(count, sizeof *picture->markers);
    if (picture->markers == NULL) return io_fail(error, "out of memory");
    for (uint32_t i = 0; i < count; i++) {
        picture_marker *marker = &picture->markers[i];
        cscd_region region = cscd_plan_region(plan, i);
        memcpy(marker->position, region.detector_point, sizeof marker->position);
        memset(marker->colour, 255, sizeof marker->colour);
        marker->radius_pixels = count > 50 ? 4.0f : 7.0f;
    }
    picture->scene.markers = picture->markers;
    picture->scene.marker_count = count;
    add_line(picture, legend, "detector points");
    return true;
}
