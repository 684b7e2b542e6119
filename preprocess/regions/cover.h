/* Covers a component by regions, each of which a point sees: as few as pay, with borders that are short and run where the charge is
 * low. docs/theory/charge.md explains the rules. */
#pragma once

#include "preprocess/regions/labelling.h"

/* Starts from one region, and leaves the best labelling that it finds. CANCELLED: the labelling means nothing. */
cscd_status cover_find(tile_labelling *l);
