/* The names of the functions that the public headers declare. */
#ifndef CSCD_TEST_API_NAMES_H
#define CSCD_TEST_API_NAMES_H

/* Of one header of include/cscd/ or of all ("*.h"): sorted, one a line, to be freed. */
char *api_names(const char *header);

#endif
