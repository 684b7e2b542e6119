/* The order of events that everything names the worst by: of each rule a pair that nothing else tells apart. */
#include "tests/support/test.h"
#include "tool/answers/answers.h"

#include <stddef.h>
#include <stdint.h>

#define KIND(kind) (UINT64_C(1) << CSCD_INTERSECTION_##kind)

/* The worst first. */
static const cscd_event ordered[] = {
    {.a = 0, .b = 1, .depth = 0.2, .pairs = 1, .kinds = KIND(CROSSING)},
    {.a = 0, .b = 1, .depth = 0.1, .pairs = 1, .length = 9.0, .kinds = KIND(CROSSING)},
    {.a = 0, .b = 1, .pairs = 1, .length = 2.0, .kinds = KIND(CROSSING)},
    {.a = 0, .b = 1, .pairs = 9, .length = 1.0, .kinds = KIND(CROSSING) | KIND(TOUCHING)},
    {.a = 0, .b = 1, .pairs = 8, .length = 1.0, .contacts = 2, .kinds = KIND(CROSSING)},
    {.a = 0, .b = 1, .pairs = 8, .length = 1.0, .contacts = 1, .kinds = KIND(CROSSING)},
    {.a = 0, .b = 1, .pairs = 2, .kinds = CSCD_EVENT_SAME_SOLID | KIND(COPLANAR)},
    {.a = 0, .b = 1, .pairs = 3, .length = 8.0, .kinds = KIND(TOUCHING)},
    {.a = 0, .b = 1, .pairs = 3, .kinds = KIND(COPLANAR)},
    {.a = 0, .b = 1, .contacts = 5},
    {.a = 1, .b = 1, .contacts = 4},
    {.a = 1, .b = 1, .depth = 3.0},
};

enum { COUNT = sizeof ordered / sizeof *ordered };

TEST(the_worst_comes_first) {
    for (size_t turn = 0; turn < COUNT; turn++) { /* begun at each of them, forwards and backwards */
        const cscd_event *events[COUNT];
        for (size_t i = 0; i < COUNT; i++)
            events[turn % 2 == 0 ? i : COUNT - 1 - i] = &ordered[(i + turn) % COUNT];
        event_order_sort(events, COUNT);
        for (size_t i = 0; i < COUNT; i++) assert_int_equal(events[i] - ordered, i);
    }
}

/* Whatever order they are handed over in. */
TEST(equal_events_stay_as_they_are) {
    const cscd_event equal[3] = {{.pairs = 1}, {.pairs = 1}, {.pairs = 1}};
    const cscd_event *events[] = {&equal[2], &equal[0], &equal[1]};
    event_order_sort(events, 3);
    for (size_t i = 0; i < 3; i++) assert_int_equal(events[i] - equal, i);
}
