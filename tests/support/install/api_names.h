/* Lists the names of the functions that the public headers declare. */
#pragma once

/* Returns the functions of one header of include/cscd/, or of all ("*.h"), sorted and one per line. The
 * caller frees the text. */
char *api_names(const char *header);
