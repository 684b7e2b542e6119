/* Reads the saved state of an event tracker. */
#pragma once

#include "tool/io/io_error.h"

#include <stdbool.h>

/* The file holds what cscd_event_tracker_save gives for a tracker of two tetrahedra. Its magic number, the hash of the options and the
 * sum at its end are made right first, since no damage gets past these. What is accepted must be saved, merged and given out. */
bool tracker_reading(const char *path, io_error *error);
