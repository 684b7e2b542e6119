/* Values of options that more than one command has. */
#include "src/tool/common/option_values.h"

#include "src/tool/common/command.h"

#include <stdio.h>
#include <string.h>

bool parse_weld(const char *text, bool *weld, double *epsilon) {
    *weld = true;
    *epsilon = 0.0;
    return strcmp(text, "exact") == 0 || (parse_double(text, epsilon) && *epsilon > 0.0);
}

bool parse_method(const char *text, cscd_method *method, uint32_t *k) {
    uint32_t regions;
    if (strncmp(text, "kmeans:", 7) != 0) return cscd_method_from_name(text, method);
    if (!parse_unsigned(text + 7, &regions) || regions == 0) return false;
    *method = CSCD_METHOD_KMEANS;
    *k = regions;
    return true;
}

bool parse_length(const char *text, double *out) {
    double value;
    if (!parse_double(text, &value) || value < 0.0) return false;
    if (value != 0.0 && (value < 0x1p-300 || value > 0x1p300)) return false;
    *out = value;
    return true;
}

bool parse_picture_size(const char *text, picture_options *picture) {
    char end = '\0';
    return sscanf(text, "%5ux%5u%c", &picture->width, &picture->height, &end) == 2 && picture->width >= 16 &&
           picture->height >= 16 && picture->width <= 8192 && picture->height <= 8192;
}

bool parse_picture_view(const char *text, picture_options *picture) {
    char end = '\0';
    return sscanf(text, "%lf,%lf%c", &picture->azimuth, &picture->elevation, &end) == 2 &&
           picture->elevation >= -90.0 && picture->elevation <= 90.0 && picture->azimuth >= -1e6 &&
           picture->azimuth <= 1e6;
}

bool parse_picture_up(const char *text, picture_options *picture) {
    picture->y_up = strcmp(text, "y") == 0;
    return picture->y_up || strcmp(text, "z") == 0;
}
