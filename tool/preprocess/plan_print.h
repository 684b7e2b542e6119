/* What a plan consists of, and what it was compared with, for people to read. */
#pragma once

#include <cscd/cscd.h>

/* Prints components, regions and seconds on the standard output. */
void plan_print(const char *model_path, const cscd_mesh *mesh, const cscd_plan *plan);
