/* Paints a picture with a plan, its charge or its regions, and says in a legend what the colours mean. */
#pragma once

#include "tool/render/contact_picture.h"
#include "tool/render/render_options.h"

enum { PLAN_LEGEND_REGIONS = 10, PLAN_LEGEND_LINES = PLAN_LEGEND_REGIONS + 2 };

typedef struct plan_legend {
    picture_legend lines[PLAN_LEGEND_LINES];
    char texts[PLAN_LEGEND_LINES][40];
} plan_legend;

/* Colours a loaded picture by CHARGE, DENSITY or REGION, and writes its caption and legend, which must live until the picture is drawn. */
bool plan_picture_paint(contact_picture *picture, plan_legend *legend, const recording *r,
                        const cscd_plan *plan, colouring by, io_error *error);

/* Adds a dot at each detector point, for the mesh at rest. Call it after plan_picture_paint. */
bool plan_picture_mark(contact_picture *picture, plan_legend *legend, const cscd_plan *plan, io_error *error);
