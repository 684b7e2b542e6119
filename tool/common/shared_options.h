/* Rows of options that several commands have: what a recording is read from, and which of its pairs are looked at. */
#pragma once

#include "tool/common/option_table.h"

/* Their places count from the command's recording_options. */
extern const option_list object_rows; /* further objects and how they move */
extern const option_list frame_rows;  /* frames, welding, threads */

/* Its places count from the command's ignore_options. */
extern const option_list pair_rows; /* parts, and pairs that are left out */
