/* Which axis of a model points up in pictures and pages. */
#pragma once

#include <stdbool.h>

/* As --up has it. */
typedef enum up_axis { UP_BY_FORMAT, UP_Y, UP_Z } up_axis;

/* Reads the value y or z of an option; place points to an up_axis. */
bool read_up(const char *text, void *place);

/* What was given, else what the format of the model's file says or its programs do: y of glTF, which defines it, and of OBJ,
 * as exporters write it; z of STL and PLY, which come from printers and scanners, and of all others. */
up_axis up_axis_choose(up_axis given, const char *model_path);
