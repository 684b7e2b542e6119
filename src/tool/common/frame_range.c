/* The frames that --frames A:B:STEP chooses. */
#include "src/tool/common/frame_range.h"

#include "src/tool/common/command.h"

#include <string.h>

frame_range frame_range_all(void) {
    return (frame_range){0, UINT32_MAX, 1};
}

/* Splits a text at its colons, in place. Returns the number of parts, 0 if there are more than three. */
static int split_range(char *text, char *parts[3]) {
    int count = 0;
    for (char *next = text; next != NULL; count++) {
        if (count == 3) return 0;
        parts[count] = next;
        next = strchr(next, ':');
        if (next != NULL) *next++ = '\0';
    }
    return count;
}

bool frame_range_parse(const char *text, frame_range *out) {
    char copy[48], *parts[3];
    if (strlen(text) >= sizeof copy) return false;
    memcpy(copy, text, strlen(text) + 1);
    frame_range range = frame_range_all();
    int count = split_range(copy, parts);
    if (count == 0 || (count < 3 && parts[0][0] == '\0' && parts[count - 1][0] == '\0')) return false;
    if (parts[0][0] != '\0' && !parse_unsigned(parts[0], &range.first)) return false;
    if (count == 1) range.last = range.first;
    if (count > 1 && parts[1][0] != '\0' && !parse_unsigned(parts[1], &range.last)) return false;
    if (count > 2 && (!parse_unsigned(parts[2], &range.step) || range.step == 0)) return false;
    if (range.first > range.last) return false;
    *out = range;
    return true;
}

bool frame_range_close(frame_range *range, uint32_t frame_count, io_error *error) {
    uint32_t last = range->last == UINT32_MAX ? frame_count - 1 : range->last;
    if (range->first >= frame_count || last >= frame_count)
        return io_fail(error, "--frames: there is no frame %u, the recording has the frames 0 to %u",
                       range->first >= frame_count ? range->first : last, frame_count - 1);
    range->last = last;
    return true;
}

uint32_t frame_range_count(const frame_range *range) {
    return (range->last - range->first) / range->step + 1;
}
