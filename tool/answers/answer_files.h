/* The answers as files: members of a JSON object, a CSV file of the events, and a JUnit file for continuous integration. */
#pragma once

#include "tool/answers/fail_rules.h"
#include "tool/io/json.h"

/* Writes the member "events", and "unit": what one unit of lengths is, or null. Frames have the artist's numbers, triangles and
 * faces those of their model files. */
void answers_write_json(const answers *a, const length_unit *unit, json *out);

/* Writes the members of a frame that was checked: "crossing" (do any triangles cross?), "clean" (was nothing found, not even what
 * touches, is there twice or lies inside?), how many pairs of each sort, how many triangles cross another one, their share, and
 * the greatest depth. */
void answers_write_frame(const answers *a, const frame_answer *frame, json *out);

/* Writes a row for each event, in the order of their first frames. */
void answers_write_csv(const answers *a, FILE *file);

/* Writes a test case for each frame. It fails by the rules; without rules it fails if the frame crosses. A frame is an error if no triangle
 * in it has an area, or if nobody knows whether it fails, because what says so did not fit the limits. Where not all was looked at
 * (answers_unfinished), a last case is an error. suite: what the recording is called. */
void answers_write_junit(const answers *a, const fail_rules *rules, const char *suite, FILE *file);
