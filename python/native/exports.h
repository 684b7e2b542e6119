/* Marks what Python calls; everything else stays within the library. */
#pragma once

#define PYTHON_API __attribute__((visibility("default")))

/* Python finds these functions by name, and no C file calls them, so there is nobody to declare them for. Their types
 * stand in python/cscd/_prototypes.py. */
#pragma GCC diagnostic ignored "-Wmissing-prototypes"
