/* Readers of option values that more than one command has. */
#include "tool/common/option_values.h"

#include "tool/common/command.h"
#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/common/recording.h"
#include "tool/picture/scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

bool read_flag(const char *text, void *place) {
    (void)text;
    *(bool *)place = true;
    return true;
}

bool read_text(const char *text, void *place) {
    *(const char **)place = text;
    return true;
}

bool read_unsigned(const char *text, void *place) {
    return parse_unsigned(text, place);
}

bool read_positive(const char *text, void *place) {
    uint32_t *out = place;
    return parse_unsigned(text, out) && *out > 0;
}

bool read_length(const char *text, void *place) {
    double value;
    if (!parse_double(text, &value) || value < 0.0) return false;
    if (value != 0.0 && (value < 0x1p-300 || value > 0x1p300)) return false;
    *(double *)place = value;
    return true;
}

bool read_threads(const char *text, void *place) {
    uint32_t *out = place;
    return parse_unsigned(text, out) && *out <= 256;
}

bool read_frame_number(const char *text, void *place) {
    frame_number *out = place;
    out->given = parse_integer(text, &out->value);
    return out->given;
}

bool read_frames(const char *text, void *place) {
    return frame_range_parse(text, place);
}

bool read_weld(const char *text, void *place) {
    weld_choice *choice = place;
    *choice = (weld_choice){.rule = strcmp(text, "none") == 0 ? WELD_NOTHING : WELD_WITHIN};
    return choice->rule == WELD_NOTHING || strcmp(text, "exact") == 0 ||
           (parse_double(text, &choice->epsilon) && choice->epsilon > 0.0);
}

bool read_parts_by(const char *text, void *place) {
    int kind;
    if (!parse_choice(text, (const char *const[]){"object", "group", "material"}, 3, &kind)) return false;
    *(mesh_parts_by *)place = (mesh_parts_by)(MESH_PARTS_BY_OBJECT + kind);
    return true;
}

bool read_rest(const char *text, void *place) {
    ignore_options *options = place;
    options->rest = text == NULL ? REST_PAIRS : REST_PARTS;
    return text == NULL || strcmp(text, "parts") == 0;
}

bool read_part_pairs(const char *text, void *place) {
    part_pairs_list *list = place;
    if (text[0] == '\0' || text[0] == ',' || list->count == PART_RULES_MAX) return false;
    list->items[list->count++] = text;
    return true;
}

bool read_size(const char *text, void *place) {
    static const char units[] = "KMGT";
    const char *end;
    double number;
    if (text[0] < '0' || text[0] > '9' || !parse_decimal(text, &number, &end)) return false;
    const char *unit = *end != '\0' ? strchr(units, *end) : NULL;
    if (*end != '\0' && (unit == NULL || end[1] != '\0')) return false;
    const double bytes = unit != NULL ? ldexp(number, 10 * (int)(unit - units + 1)) : number;
    if (!(bytes >= 1.0 && bytes < ldexp(1.0, 8 * sizeof(size_t) - 1))) return false;
    *(size_t *)place = (size_t)bytes;
    return true;
}

bool read_seconds(const char *text, void *place) {
    double value;
    if (!parse_double(text, &value) || value <= 0.0 || value > 1e9) return false;
    *(double *)place = value;
    return true;
}

bool read_fps(const char *text, void *place) {
    double value;
    if (!parse_double(text, &value) || value <= 0.0 || value > 1e6) return false;
    *(double *)place = value;
    return true;
}

bool read_named_path(const char *text, void *place) {
    named_paths *list = place;
    const char *equals = strchr(text, '=');
    if (equals == NULL || equals == text || equals[1] == '\0' || list->count == RECORDING_OBJECTS_MAX)
        return false;
    named_path *named = &list->items[list->count];
    const size_t length = (size_t)(equals - text);
    if (length >= sizeof named->name || memchr(text, ':', length) != NULL ||
        memchr(text, ',', length) != NULL)
        return false;
    *named = (named_path){.path = equals + 1};
    memcpy(named->name, text, length);
    list->count++;
    return true;
}

bool read_obstacle(const char *text, void *place) {
    named_paths *list = place;
    if (!read_named_path(text, place)) return false;
    list->items[list->count - 1].obstacle = true;
    return true;
}

bool read_picture_size(const char *text, void *place) {
    picture_options *picture = place;
    char end = '\0';
    return sscanf(text, "%5ux%5u%c", &picture->width, &picture->height, &end) == 2 && picture->width >= 16 &&
           picture->height >= 16 && picture->width <= 8192 && picture->height <= 8192;
}

bool read_picture_view(const char *text, void *place) {
    picture_options *picture = place;
    char end = '\0';
    return sscanf(text, "%lf,%lf%c", &picture->azimuth, &picture->elevation, &end) == 2 &&
           picture->elevation >= -90.0 && picture->elevation <= 90.0 && picture->azimuth >= -1e6 &&
           picture->azimuth <= 1e6;
}

bool parse_method(const char *text, cscd_method *method, uint32_t *k) {
    uint32_t regions;
    if (strncmp(text, "kmeans:", 7) != 0) return cscd_method_from_name(text, method);
    if (!parse_unsigned(text + 7, &regions) || regions == 0) return false;
    *method = CSCD_METHOD_KMEANS;
    *k = regions;
    return true;
}

bool parse_choice(const char *text, const char *const *names, int count, int *out) {
    for (int i = 0; i < count; i++) {
        if (strcmp(text, names[i]) != 0) continue;
        *out = i;
        return true;
    }
    return false;
}
