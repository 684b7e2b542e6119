/* Readers of option values, and rows of options, that more than one command has. */
#pragma once

#include "cscd/cscd.h"
#include "tool/common/option_table.h"

#include <stdbool.h>

/* The comment of each says what `place` points to. */
bool read_flag(const char *text, void *place);         /* bool, which becomes true; the option has no value */
bool read_text(const char *text, void *place);         /* const char * */
bool read_unsigned(const char *text, void *place);     /* uint32_t */
bool read_positive(const char *text, void *place);     /* uint32_t, 1 or more */
bool read_length(const char *text, void *place);       /* double: 0, or from 2^-300 to 2^300 */
bool read_threads(const char *text, void *place);      /* uint32_t, 256 at most */
bool read_frame_number(const char *text, void *place); /* frame_number */
bool read_frames(const char *text, void *place);       /* frame_range: A:B[:STEP] */
bool read_weld(const char *text, void *place);         /* weld_choice: exact|none|EPS */
bool read_parts_by(const char *text, void *place);     /* mesh_parts_by: object|group|material */
bool read_rest(const char *text, void *place);         /* ignore_options.rest: nothing, or parts */
bool read_part_pairs(const char *text, void *place);   /* part_pairs_list: A or A,B */
bool read_size(const char *text, void *place); /* size_t: bytes above 0, or with K, M, G or T behind them */
bool read_seconds(const char *text, void *place); /* double above 0 */
bool read_fps(const char *text, void *place);     /* double above 0 */
bool read_named_path(const char *text,
                     void *place);                 /* named_paths: NAME=PATH; a name has no ':' and no ',' */
bool read_obstacle(const char *text, void *place); /* the same, of an obstacle */
bool read_picture_size(const char *text, void *place); /* picture_options: WxH */
bool read_picture_view(const char *text, void *place); /* picture_options: AZ,EL */

/* NAME|kmeans:K of --method. Without a K, *k stays as it is. */
bool parse_method(const char *text, cscd_method *method, uint32_t *k);

/* The place of a text in a list of names; false, and *out untouched, when it is not there. */
bool parse_choice(const char *text, const char *const *names, int count, int *out);

/* Their places count from the command's recording_options. */
extern const option_list object_rows; /* further objects and how they move */
extern const option_list frame_rows;  /* frames, welding, threads */

/* Its places count from the command's ignore_options. */
extern const option_list pair_rows; /* parts, and pairs that are left out */

/* As --up has it. */
typedef enum up_axis { UP_BY_FORMAT, UP_Y, UP_Z } up_axis;

/* Reads the value y or z of an option; place points to an up_axis. */
bool read_up(const char *text, void *place);

/* What was given, else what the format of the model's file says or its programs do: y of glTF, which defines it, and of OBJ,
 * as exporters write it; z of STL and PLY, which come from printers and scanners, and of all others. */
up_axis up_axis_choose(up_axis given, const char *model_path);
