/* Events that only follow from others are left out. */
#include "tests/support/test.h"
#include "tool/answers/answers.h"

#include <string.h>

/* What lies in itself while another part cuts it is no event of its own; at any other time it is. */
TEST(what_follows_is_left_out) {
    cscd_event events[] = {
        {.a = 1, .b = 2, .first_frame = 4, .last_frame = 5, .pairs = 1},
        {.a = 1, .b = 2, .first_frame = 1, .last_frame = 9, .pairs = 3},
        {.a = 1, .b = 1, .first_frame = 9, .last_frame = 12, .depth = 0.1},  /* follows */
        {.a = 2, .b = 2, .first_frame = 0, .last_frame = 1, .depth = 0.2},   /* follows */
        {.a = 2, .b = 2, .first_frame = 10, .last_frame = 11, .depth = 0.3}, /* at another time */
        {.a = 3, .b = 3, .first_frame = 4, .last_frame = 5, .depth = 0.4},   /* of another part */
        {.a = 1, .b = 1, .first_frame = 4, .last_frame = 5, .contacts = 1},  /* with a contact */
        {.a = 0, .b = 1, .first_frame = 4, .last_frame = 5, .depth = 0.5},   /* of two parts */
        {.a = 1, .b = 1, .first_frame = 4, .last_frame = 5, .depth = 0.6, .kinds = CSCD_EVENT_IN_OTHER_BODY},
    };
    const size_t expected[] = {0, 1, 4, 5, 6, 7, 8};
    cscd_event all[9];
    memcpy(all, events, sizeof all);
    size_t count = 9;
    assert_true(consequences_leave_out(events, &count));
    assert_int_equal(count, 7);
    for (size_t i = 0; i < count; i++) assert_memory_equal(&events[i], &all[expected[i]], sizeof *events);
}
