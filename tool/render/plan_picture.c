/* Paints a picture with a plan, its charge or its regions, and says in a legend what the colours mean. */
#include "tool/render/plan_picture.h"

#include "tool/common/plans.h"
#include "tool/picture/picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
