/* The names of the functions that the public headers declare. */
#pragma once

/* Returns the functions of one header of include/cscd/, or of all ("*.h"): sorted, one in a line, to be
 * freed. */
char *api_names(const char *header);
