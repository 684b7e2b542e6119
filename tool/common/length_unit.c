/* Units of length: what one unit of a recording's coordinates is, and lengths as people write and read them. */
#include "tool/common/length_unit.h"

#include "tool/common/command.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const length_unit units[] = {{"um", 1e-6}, {"mm", 1e-3}, {"cm", 1e-2},   {"dm", 0.1},
                                    {"m", 1.0},   {"km", 1e3},  {"in", 0.0254}, {"ft", 0.3048}};

bool length_unit_from_name(const char *text, length_unit *out) {
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(text, units[i].name) != 0) continue;
        *out = units[i];
        return true;
    }
    return false;
}

bool length_given_parse(const char *text, length_given *out) {
    const char *end;
    length_given length = {.given = true};
    if (!parse_decimal(text, &length.value, &end) || length.value < 0.0) return false;
    end += strspn(end, " ");
    if (*end != '\0' && !length_unit_from_name(end, &length.unit)) return false;
    *out = length;
    return true;
}

bool length_given_convert(const length_given *length, const length_unit *files, double *out,
                          io_error *error) {
    if (length->unit.name == NULL) {
        *out = length->value;
        return true;
    }
    if (files->name == NULL)
        return io_fail(error,
                       "%g %s: the files do not say what one unit of them is; say it with --unit mm, cm, m, "
                       "in or ft, or give the length without a unit",
                       length->value, length->unit.name);
    *out = length->value * length->unit.metres / files->metres;
    return true;
}

const char *length_text(double length, const length_unit *files, char text[LENGTH_TEXT_SIZE]) {
    if (files->name == NULL) {
        snprintf(text, LENGTH_TEXT_SIZE, "%.3g", length);
        return text;
    }
    if (strcmp(files->name, "in") == 0 || strcmp(files->name, "ft") == 0) {
        snprintf(text, LENGTH_TEXT_SIZE, "%.3g %s", length, files->name);
        return text;
    }
    static const char *const steps[] = {"um", "mm", "m", "km"};
    double metres = length * files->metres, scale = 1e-6;
    int step = 0;
    for (; step < 3 && fabs(metres) >= 0.9995 * scale * 1e3; step++) scale *= 1e3;
    snprintf(text, LENGTH_TEXT_SIZE, "%.3g %s", metres / scale, steps[step]);
    return text;
}
