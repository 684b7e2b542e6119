/* `cscd untangle`: moves vertices so that a mesh does not intersect itself any more, frame by frame. */
#include "tool/untangle/untangle_run.h"

#include <string.h>

static bool read_length_given(const char *text, void *place) {
    return length_given_parse(text, place);
}

static bool read_length_unit(const char *text, void *place) {
    return length_unit_from_name(text, place);
}

static bool read_pinned(const char *text, void *place) {
    part_pairs_list *list = place;
    if (text[0] == '\0' || list->count == PART_RULES_MAX) return false;
    list->items[list->count++] = text;
    return true;
}

static bool read_steady(const char *text, void *place) {
    double value;
    if (!parse_double(text, &value) || !(value >= 0.0 && value < 1.0)) return false;
    *(double *)place = value;
    return true;
}

static const option_row rows[] = {
    {"o", "OUT", read_input_path, offsetof(untangle_options, output_path),
     "where the positions go: of one frame a mesh as MODEL (" MESH_COPY_FORMATS
     ", with everything else in it), else .obj of its triangles; of several frames .pc2 or .mdd"},
    {"output", "OUT", read_input_path, offsetof(untangle_options, output_path), NULL},
    {"gap", "LENGTH", read_length_given, offsetof(untangle_options, gap),
     "surfaces keep this distance: 1mm, or 0.001 in the files' unit (default 0: they do not touch)"},
    {"unit", "mm|cm|m|in|ft", read_length_unit, offsetof(untangle_options, unit),
     "what one unit of the files is (default: metres of glTF files, else unknown)"},
    {"pin", "PART[,PART...]", read_pinned, offsetof(untangle_options, pinned),
     "these parts stay where they are, bit for bit; as often as needed"},
    {"spread", "LENGTH", read_length_given, offsetof(untangle_options, spread),
     "displacements are spread over so much of the surface: more is smoother and moves more (default: about twice how deep "
     "it is)"},
    {"bending", "LENGTH", read_length_given, offsetof(untangle_options, bending),
     "displacements bend smoothly over this length, which takes about three times as long (default: they may have edges)"},
    {"rest-shape", "FILE", read_input_path, offsetof(untangle_options, rest_path),
     "the same mesh in a shape that is right: where it is tangled, edges are drawn to the lengths and angles that they have there"},
    {"frames", "A:B[:STEP]", read_frames, offsetof(untangle_options, frames),
     "only the frames A to B, both included, or every STEP-th of them"},
    {"steady", "X", read_steady, offsetof(untangle_options, steady),
     "of several frames: from 0 (default) to below 1; near 1 a displacement lasts, against jitter"},
    {"time", "S", read_seconds, offsetof(untangle_options, seconds),
     "a frame takes S seconds at most, and then is the best so far (default: as long as it takes)"},
    {"partial", NULL, read_flag, offsetof(untangle_options, partial),
     "write OUT even if it is not clean: each frame has fewer pairs than before, or is as it was"},
    {"json", "OUT.json", read_output_path, offsetof(untangle_options, json_path),
     "write what was found, frame by frame; - is the standard output, and the text for people then goes to the standard "
     "error"},
    {"report", "OUT.html", read_output_path, offsetof(untangle_options, report_path),
     "write a page that shows it before and after, what crosses, and how far vertices moved"},
    {"quiet", NULL, read_flag, offsetof(untangle_options, quiet),
     "no progress, no warnings, nothing on the standard output"},
};

const option_table untangle_table = {
    "untangle",
    "MODEL [FRAMES...] -o OUT [options]",
    "Moves vertices of MODEL as little and as smoothly as it can, until no two triangles cross or touch, and says how far. It "
    "never makes it worse, and what it calls clean is clean by the exact check of the numbers in the file. A single mesh does "
    "not always become clean (exit code 3: nothing is written without --partial); the frames of a recording do once one of them "
    "is, because each starts from its neighbour. MODEL alone moves; other objects stay where they are. FRAMES as for replay.",
    rows,
    sizeof rows / sizeof *rows,
    .shared = {{&object_rows, offsetof(untangle_options, source)},
               {&frame_rows, offsetof(untangle_options, source)},
               {&pair_rows, offsetof(untangle_options, ignored)}},
    .examples = {
        {"untangle body.obj -o clean.obj",
         "Move the vertices of a mesh until nothing crosses or touches, and write it with all else as it was."},
        {"untangle body.obj body.pc2 -o clean.pc2 --frames 60:120 --steady 0.5 --report clean.html",
         "The same of the frames 60 to 120, without jumps from frame to frame, and a page to look at."},
        {"untangle shirt.obj --obstacle body=body.obj -o start.obj --gap 2mm --unit m",
         "Move the shirt alone, until it is 2 mm from the body and from itself everywhere: a start for a solver."}}};

/* ---- paths ---------------------------------------------------------------------------------------------- */

static bool differs_from(const char *path, const named_paths *inputs, io_error *error) {
    for (uint32_t i = 0; i < inputs->count; i++)
        if (!output_path_differs(path, &inputs->items[i].path, 1, error)) return false;
    return true;
}

/* MODEL and FRAMES may be named as the output in the same words, to have them replaced. No other input is. */
static bool inputs_are_kept(const untangle_options *o, const given_options *given, io_error *error) {
    const char *const lists[] = {o->ignored.path, o->ignored.parts_path};
    if (!output_path_differs(o->output_path, lists, sizeof lists / sizeof *lists, error) ||
        !differs_from(o->output_path, &o->source.objects, error) ||
        !differs_from(o->output_path, &o->source.frames_of, error))
        return false;
    for (size_t i = 0; i < given->input_count; i++) {
        const bool named = strcmp(o->output_path, given->inputs[i]) == 0;
        if (!named && !output_path_differs(o->output_path, &given->inputs[i], 1, error)) return false;
    }
    return true;
}

int command_untangle(int argument_count, char **arguments) {
    untangle_options options = {.frames = frame_range_all()};
    given_options given;
    io_error error;
    int code;
    if (!option_table_read(&untangle_table, argument_count, arguments, &options, &given, &code)) return code;
    if (given.input_count < 1) return fail_usage("untangle", "no MODEL given");
    if (options.output_path == NULL)
        return fail_usage("untangle", "no -o OUT given, where the positions are to go");
    if (!untangle_output_named(options.output_path, &error)) return fail_usage("untangle", "%s", error.text);
    if (!inputs_are_kept(&options, &given, &error)) return fail_usage("untangle", "-o %s", error.text);
    if (!output_paths_are_safe(&untangle_table, &options, &given, &error))
        return fail_usage("untangle", "%s", error.text);
    recording_options_take(&options.source, &given);
    return untangle_run_on(&options);
}
