/* The options about answers that check and replay have in common. */
#pragma once

#include "tool/answers/fail_rules.h"
#include "tool/common/options.h"
#include "tool/io/output_file.h"

typedef struct answer_options {
    length_unit unit; /* its name is NULL: what the files say */
    fail_options fail;
    const char *events_path, *junit_path; /* NULL: not given */
    bool no_depths;                       /* pairs only */
    bool as_given;                        /* what is inside out is not turned around */
    answer_limits limits;
    bool timings; /* print what a developer wants to know as well */
} answer_options;

/* Their rows, but --fail-on, of which each command has kinds of its own. Places count from answer_options. */
extern const option_list answer_rows;

/* A rule passes nothing that the run does not look at: false if one would, and the error says which. */
bool answer_options_agree(const answer_options *o, io_error *error);

/* The unit that the options give; else the metre where all files are glTF, else none that anybody knows. */
length_unit answer_options_unit(const answer_options *o, const recording *r);

/* The files that the options ask for. */
typedef struct answer_outputs {
    const answer_options *options;
    output_file events, junit;
} answer_outputs;

/* Before anything is printed, because an output may be the standard output. Whatever this returns, answer_outputs_close is
 * due. */
bool answer_outputs_open(const answer_options *o, answer_outputs *out, io_error *error);

/* Writes them; answers that are not there (NULL) leave older files as they are. A zeroed struct is fine. suite: what the
 * recording is called. */
bool answer_outputs_close(answer_outputs *outputs, const answers *a, const fail_rules *rules,
                          const char *suite, io_error *error);
