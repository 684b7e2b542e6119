/* Measures a step of particle sensors by size and by number of objects. */
#pragma once

#include "tool/io/io.h"

/* Prints two tables on the standard output. */
bool sensor_cost_print(io_error *error);
