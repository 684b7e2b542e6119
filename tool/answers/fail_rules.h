/* When a run counts as failed (exit code 3): what --fail-on, --fail-depth and --max-faces say. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/common/length_unit.h"

/* What --fail-on takes; each includes those before it. */
typedef enum fail_kind {
    FAIL_ON_NOTHING,
    FAIL_ON_CROSSING, /* triangles that cross */
    FAIL_ON_TOUCHING, /* or meet otherwise, or are there twice */
    FAIL_ON_CONTACT   /* or come into contact between two frames */
} fail_kind;

/* As the command line has them; zeroed: nothing fails. */
typedef struct fail_options {
    fail_kind kind;
    length_given depth;  /* a point deeper than this fails */
    bool faces_limited;  /* more triangles that cross another one */
    uint32_t most_faces; /* than this, in one frame, fail */
} fail_options;

typedef struct fail_rules {
    fail_options options;
    length_unit unit; /* of the files */
    double depth;     /* that of the options, in it */
} fail_rules;

/* The error says that a depth has a unit and the files have none. */
bool fail_rules_create(const fail_options *options, const length_unit *unit, fail_rules *out,
                       io_error *error);

/* Is there any rule? */
bool fail_rules_any(const fail_rules *rules);

enum { FAIL_TEXT_SIZE = 400 };

/* Does a frame fail? The text then says what of it does. */
bool fail_rules_meet(const fail_rules *rules, const answers *a, const frame_answer *frame,
                     char text[FAIL_TEXT_SIZE]);

/* Why a frame can neither pass nor fail: nothing was looked at, because no triangle in it has an area. */
#define FAIL_WITHOUT_AREA "no triangle has an area, so there was nothing to look at"

/* Why a frame that does not fail does not pass, either: nothing was looked at, or what a rule asks for did not fit the memory. NULL: it
 * passes. */
const char *fail_rules_unknown(const fail_rules *rules, const answers *a, const frame_answer *frame);

/* Is there a rule that no frame meets, although something may hide in frames in which no triangle has an area? */
bool fail_rules_undecided(const fail_rules *rules, const answers *a);

/* Does a frame fail that was looked at? Says so on standard error. */
bool fail_rules_failed(const fail_rules *rules, const answers *a);

/* Says on standard error why a run came to no end, and returns EXIT_BAD_INPUT. Where the first line has been printed and gives this
 * reason, and standard output goes to the same terminal or file, it is not said again. */
int fail_unfinished(const answers *a, bool printed, const char *reason);

/* The exit code of a run that ended without an error: EXIT_CONTACT if any frame fails, and then it says on stderr how many do and what
 * the first does wrong; else EXIT_BAD_INPUT if not all was looked at that was asked for, which is said by fail_unfinished. */
int fail_rules_exit_code(const fail_rules *rules, const answers *a, bool printed);
