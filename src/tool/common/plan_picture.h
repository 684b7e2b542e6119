/* Colours of a plan: charge by rank, regions as hues; per triangle, and as a scene with its legend. */
#pragma once

#include "src/tool/render/contact_picture.h"

/* Red, green, blue per triangle: those of its region. */
void plan_colour_regions(const cscd_plan *plan, uint32_t triangle_count, uint8_t *colours);

/* The rank of the triangle's charge in its component, dark violet the least and yellow the most; equal
 * charges have one colour. */
bool plan_colour_charge(const cscd_plan *plan, const cscd_mesh *mesh, uint8_t *colours, io_error *error);

enum { PLAN_LEGEND_REGIONS = 10, PLAN_LEGEND_LINES = PLAN_LEGEND_REGIONS + 2 };

typedef struct plan_legend {
    picture_legend lines[PLAN_LEGEND_LINES];
    char texts[PLAN_LEGEND_LINES][40];
} plan_legend;

/* Colours a loaded picture, with a caption, and a legend that lives as long as the picture is drawn. */
bool plan_picture_paint(contact_picture *picture, plan_legend *legend, const recording *r,
                        const cscd_plan *plan, bool by_charge, io_error *error);

/* After it: a dot at each detector point, for the mesh at rest. */
bool plan_picture_mark(contact_picture *picture, plan_legend *legend, const cscd_plan *plan, io_error *error);
