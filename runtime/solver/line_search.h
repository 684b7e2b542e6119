/* A line search: the candidates of one motion serve every shorter step and every moment on it. */
#pragma once

#include "runtime/solver/free_step.h"

/* Sets the scalar of each object's positions on the line; doubles until then. Comes before cscd_line_search_begin, which collects
 * candidates for it. */
void line_search_store_in(cscd_line_search *line, const cscd_scalar *scalars);
