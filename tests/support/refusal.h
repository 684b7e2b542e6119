/* Calls that are refused, with a sentence that says why. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/test.h"

#include <string.h>

/* The call in this context was refused as INVALID_ARGUMENT, and its sentence has these words. */
static inline void expect_invalid(const cscd_context *context, cscd_status status, const char *words) {
    const char *detail = cscd_context_detail(context);
    assert_int_equal(status, CSCD_INVALID_ARGUMENT);
    if (strstr(detail, words) == NULL) fail_msg("\"%s\" does not say \"%s\"", detail, words);
}
