/* The options about answers that check and replay have in common. */
#include "tool/answers/answer_options.h"

#include "tool/answers/answer_files.h"
#include "tool/common/command.h"
#include "tool/common/options.h"

static bool read_unit(const char *text, void *place) {
    return length_unit_from_name(text, place);
}

static bool read_fail_depth(const char *text, void *place) {
    return length_given_parse(text, place);
}

static bool read_max_faces(const char *text, void *place) {
    fail_options *options = place;
    options->faces_limited = true;
    return parse_unsigned(text, &options->most_faces);
}

static bool read_orientation(const char *text, void *place) {
    int choice;
    if (!parse_choice(text, (const char *const[]){"found", "as-given"}, 2, &choice)) return false;
    *(bool *)place = choice == 1;
    return true;
}

static const option_row rows[] = {
    {"events", "OUT.csv", read_output_path, offsetof(answer_options, events_path),
     "write the events as a table: which parts, since when, how deep, where; - is the standard output"},
    {"junit", "OUT.xml", read_output_path, offsetof(answer_options, junit_path),
     "write a JUnit file for continuous integration: a test case for each frame"},
    {"fail-depth", "LENGTH", read_fail_depth, offsetof(answer_options, fail.depth),
     "exit with 3 when something is deeper than that: 2mm, or 0.002 in the files' unit"},
    {"max-faces", "N", read_max_faces, offsetof(answer_options, fail),
     "exit with 3 when more than N triangles cross others in one frame"},
    {"unit", "mm|cm|m|in|ft", read_unit, offsetof(answer_options, unit),
     "what one unit of the files is (default: metres of glTF files, else unknown)"},
    {"no-depths", NULL, read_flag, offsetof(answer_options, no_depths),
     "faster: find pairs and events, and neither how deep they are nor what lies inside"},
    {"orientation", "found|as-given", read_orientation, offsetof(answer_options, as_given),
     "found, the default: closed surfaces that are inside out are taken as turned around; as-given: they contain nothing"},
    {"max-memory", "SIZE", read_size, offsetof(answer_options, limits.memory),
     "what is found in one frame may take so much: 500M, 4G (default: a quarter of the memory that is free); what does not "
     "fit is left out, and said first"},
    {"max-work", "NUMBER", read_size, offsetof(answer_options, limits.work),
     "how deep it is in one frame may take so many comparisons: 1G, 16G (default: 256M, which take ten seconds or so); what "
     "would take more is left out, and said first"},
    {"timings", NULL, read_flag, offsetof(answer_options, timings),
     "print more: how long it took, and a row for each frame that is not clean"},
};

const option_list answer_rows = {"Answers:", rows, sizeof rows / sizeof *rows};

bool answer_options_agree(const answer_options *o, io_error *error) {
    if (!o->no_depths) return true;
    if (o->fail.depth.given) return io_fail(error, "--fail-depth needs depths, which --no-depths leaves out");
    return o->fail.kind == FAIL_ON_NOTHING ||
           io_fail(error, "--fail-on counts what lies inside, too, which --no-depths does not look at");
}

length_unit answer_options_unit(const answer_options *o, const recording *r) {
    length_unit unit = o->unit;
    for (uint32_t i = 0; i < r->object_count; i++)
        if (r->objects[i].file.format != MESH_FORMAT_GLTF) return unit;
    if (unit.name == NULL) length_unit_from_name("m", &unit);
    return unit;
}

static bool open_file(const char *path, output_file *out, io_error *error) {
    return path == NULL || output_file_open(path, out) || io_fail_write(error, path);
}

bool answer_outputs_open(const answer_options *o, answer_outputs *out, io_error *error) {
    *out = (answer_outputs){.options = o};
    return open_file(o->events_path, &out->events, error) && open_file(o->junit_path, &out->junit, error);
}

static bool close_file(const char *path, output_file *file, output_ending ending, io_error *error) {
    if (file->file == NULL || output_file_close(file, ending) || ending == OUTPUT_ABANDONED) return true;
    return io_fail_write(error, path);
}

bool answer_outputs_close(answer_outputs *outputs, const answers *a, const fail_rules *rules,
                          const char *suite, io_error *error) {
    const answer_options *o = outputs->options;
    if (o == NULL) return true;
    const output_ending ending = a != NULL ? OUTPUT_WHOLE : OUTPUT_ABANDONED;
    if (a != NULL && outputs->events.file != NULL) answers_write_csv(a, outputs->events.file);
    if (a != NULL && outputs->junit.file != NULL) answers_write_junit(a, rules, suite, outputs->junit.file);
    bool written = close_file(o->events_path, &outputs->events, ending, error);
    written = close_file(o->junit_path, &outputs->junit, ending, written ? error : NULL) && written;
    *outputs = (answer_outputs){0};
    return written;
}
