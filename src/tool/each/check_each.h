/* `cscd check --each`: checks many different meshes, each alone. */
#pragma once

#include "src/tool/common/ignore_pairs.h"
#include "src/tool/common/option_table.h"
#include "src/tool/common/recording.h"

/* Of the options of `check`, those that make sense for each mesh alone. */
typedef struct each_request {
    weld_choice weld;
    ignore_options ignored;                  /* pairs of parts */
    const char *json_path;                   /* JSON Lines; NULL: none are written */
    uint32_t thread_count;                   /* 0: one per processor */
    bool fail_on_crossing, fail_on_touching; /* exit with 3; touching: crossing as well */
    bool quiet;
} each_request;

/* Checks the inputs, in their order; returns the exit code. Options that were given and are none of the request's are
 * refused by name. */
int check_each(const option_table *table, const given_options *given, const each_request *request);
