/* Readers of option values, and rows of options, that more than one command has. */
#include "tool/common/options.h"

#include "tool/common/command.h"
#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/common/recording.h"
#include "tool/io/format_reader.h"
#include "tool/io/io.h"
#include "tool/picture/picture.h"

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

static bool read_threads(const char *text, void *place) {
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

static bool read_rest(const char *text, void *place) {
    ignore_options *options = place;
    options->rest = text == NULL ? REST_PAIRS : REST_PARTS;
    return text == NULL || strcmp(text, "parts") == 0;
}

static bool read_part_pairs(const char *text, void *place) {
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

static bool read_fps(const char *text, void *place) {
    double value;
    if (!parse_double(text, &value) || value <= 0.0 || value > 1e6) return false;
    *(double *)place = value;
    return true;
}

static bool read_named_path(const char *text, void *place) {
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

static bool read_obstacle(const char *text, void *place) {
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
    if (strncmp(text, "kmeans:", 7) != 0) return cscd_from_name(CSCD_METHODS, text, (uint32_t *)method);
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

/* ---- rows of options that several commands have, so that each has one text ----------------------------- */

static const option_row of_objects[] = {
    {"object", "NAME=MODEL", read_named_path, offsetof(recording_options, objects),
     "another object, as often as needed: body and shirt, prop and hand"},
    {"obstacle", "NAME=MODEL", read_obstacle, offsetof(recording_options, objects),
     "the same, of something that is not looked at with itself and with other obstacles: ground, walls"},
    {"frames-of", "NAME=FRAMES", read_named_path, offsetof(recording_options, frames_of),
     "how that object moves: a point cache, a pattern or a folder, of as many frames; without it, it rests, or moves as its "
     "own file says"},
    {"rest", NULL, read_flag, offsetof(recording_options, rest),
     "of files that hold an animation (glTF), look at the rest pose alone, unless they are given as FRAMES"},
    {"parts-by", "object|group|material", read_parts_by, offsetof(recording_options, parts_by),
     "what the parts are: objects (lines o of an OBJ, nodes of a glTF), groups (lines g of an OBJ), or materials (of an OBJ and a glTF); "
     "what is found stays the same, and how deep (default: what the file names: objects with their groups, or nodes)"},
};

static const option_row of_frames[] = {
    {"first-frame", "N", read_frame_number, offsetof(recording_options, first_frame),
     "what the first frame is called (default: the number in its file's name, the start of a PC2, or 0)"},
    {"fps", "N", read_fps, offsetof(recording_options, frames.fps),
     "frames a second: of a glTF file, which has seconds only (default 24), and of the page's seconds"},
    {"animation", "NAME", read_text, offsetof(recording_options, frames.animation_name),
     "which animation of a glTF file (default: the first)"},
    {"allow-gaps", NULL, read_flag, offsetof(recording_options, frames.allow_gaps),
     "of numbered files, some may be missing; an interval then goes on to the next that exists"},
    {"wait-for-files", "S", read_seconds, offsetof(recording_options, wait_seconds),
     "try again for up to S seconds where a file cannot be read, as a network file system shows it late (default: not at all)"},
    {"weld", "exact|none|EPS", read_weld, offsetof(recording_options, weld),
     "join vertices that coincide, or lie within EPS, in all frames; of a file for each frame, in the first (default: exact for STL "
     "and glTF, else none)"},
    {"threads", "N", read_threads, offsetof(recording_options, thread_count),
     "default 0: one per processor, and one for a mesh of less than 1,000 triangles; the results are the same"},
};

static const option_row of_pairs[] = {
    {"parts", "TABLE.csv", read_input_path, offsetof(ignore_options, parts_path),
     "which part each triangle, face or vertex is in (default: the parts that the files name, else "
     "components)"},
    {"only", "A[,B]", read_part_pairs, offsetof(ignore_options, only),
     "look at part A with part B only, or at A with everything; as often as needed"},
    {"ignore-parts", "A[,B]", read_part_pairs, offsetof(ignore_options, ignored),
     "leave out part A with part B, or with everything; as often as needed"},
    {"ignore-rest", "[=parts]", read_rest, 0,
     "leave out triangle pairs that intersect or touch in the first frame; =parts: all pairs of parts that do, "
     "as of an eye in its socket"},
    {"ignore", "LIST", read_input_path, offsetof(ignore_options, path),
     "leave out the pairs of a file: lines 'A B' (triangles) or 'components A B'"},
};

const option_list object_rows = {"Several objects, and parts of each:", of_objects,
                                 sizeof of_objects / sizeof *of_objects};
const option_list frame_rows = {"Frames, welding, threads:", of_frames, sizeof of_frames / sizeof *of_frames};
const option_list pair_rows = {"Parts, and which pairs are looked at:", of_pairs,
                               sizeof of_pairs / sizeof *of_pairs};

/* ---- which axis of a model points up in pictures and pages --------------------------------------------- */

bool read_up(const char *text, void *place) {
    int axis;
    if (!parse_choice(text, (const char *const[]){"y", "z"}, 2, &axis)) return false;
    *(up_axis *)place = axis == 0 ? UP_Y : UP_Z;
    return true;
}

up_axis up_axis_choose(up_axis given, const char *model_path) {
    if (given != UP_BY_FORMAT) return given;
    return gltf_recognise_path(model_path) || path_has_extension(model_path, ".obj") ? UP_Y : UP_Z;
}
