/* Frames one after the other are one span of a list. */
#include "tests/support/test.h"
#include "tool/common/frame_range.h"

TEST(neighbours_join) {
    static const uint32_t frames[] = {0, 1, 2, 4, 6, 7}, spans[][2] = {{0, 2}, {4, 4}, {6, 7}};
    frame_list list = {0};
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) assert_true(frame_list_add(&list, frames[i]));
    assert_int_equal(list.count, 3);
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(list.spans[i].first, spans[i][0]);
        assert_int_equal(list.spans[i].last, spans[i][1]);
    }
    assert_int_equal(frame_list_frames(&list), 6);
    frame_list_free(&list);
}
