/* Lists the names of the functions that the public headers declare. */
#pragma once

/* Returns the symbols of one header of include/cscd/, or of all ("*.h"), sorted and one per line. The caller frees
 * the text. */
char *api_symbols(const char *header);

/* Returns what programs call: the same names, without the ending _sized of those behind an inline function. */
char *api_functions(const char *header);
