/* The bodies of models/shapes, for tests. */
#include "tests/support/models/body_of.h"
#include "tests/support/test.h"

body body_of(body_kind kind, uint32_t triangle_count) {
    body b;
    io_error error;
    if (!body_make(kind, triangle_count, &b, &error)) fail_msg("%s", error.text);
    return b;
}
