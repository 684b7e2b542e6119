/* The options of `cscd sense`. */
#include "sensors/tool/sense.h"

#include "tool/common/command.h"
#include "tool/common/options.h"

#include <string.h>

static bool read_sensor_method(const char *text, void *place) {
    cscd_sensor_method *method = place;
    *method = strcmp(text, "random") == 0 ? CSCD_SENSORS_RANDOM : CSCD_SENSORS_CELLS;
    return *method == CSCD_SENSORS_RANDOM || strcmp(text, "cells") == 0;
}

static bool read_no_exact(const char *text, void *place) {
    (void)text;
    *(bool *)place = false;
    return true;
}

static const option_row rows[] = {
    {"compare", NULL, read_flag, offsetof(sense_options, compare),
     "also find all contacts (cscd replay, method none): recall and precision of the pairs of objects, and "
     "the time of both"},
    {"method", "cells", read_sensor_method, offsetof(sense_options, sensors.method),
     "one particle in every cell of a part (default)"},
    {"method", "random", .help = "the same number on each object, from random vertices: to compare with"},
    {"mu", "D", read_length, offsetof(sense_options, sensors.collision_distance),
     "warn of particles that come nearer than this, a length in the files' unit (default 0: by the longest "
     "edges and the motion)"},
    {"reff", "D", read_length, offsetof(sense_options, sensors.effective_radius),
     "how far particles feel each other, a length, at least --mu (default 0: mu and the two largest cells)"},
    {"cells", "N", read_unsigned, offsetof(sense_options, sensors.cells),
     "cells of each part (default 0: as many as spheres of the smallest part fit around the sphere of this one)"},
    {"particles", "N", read_positive, offsetof(sense_options, sensors.particles),
     "with random: on each object (default 5)"},
    {"seed", "N", read_unsigned, offsetof(sense_options, sensors.seed), "with random: default 1"},
    {"plan", "PLAN.ply|none", read_input_path, offsetof(sense_options, plan_path),
     "whose regions are the parts of concave objects (default as for replay); none: every component is one part"},
    {"within", NULL, read_flag, offsetof(sense_options, sensors.within),
     "with cells: parts of one object are watched for each other, too"},
    {"no-exact", NULL, read_no_exact, offsetof(sense_options, sensors.exact),
     "warnings are not checked by elementary tests"},
    {"csv", "OUT.csv", read_output_path, offsetof(sense_options, csv_path),
     "write each warning: frame, parts, objects, vertices, distance, contact; - is the standard output"},
    {"json", "OUT.json", read_output_path, offsetof(sense_options, json_path),
     "write a summary: every interval, counts, timings, provenance; - is the standard output"},
    {"picture", "OUT.png", read_output_path, offsetof(sense_options, picture_path),
     "draw cells, particles and where they have been"},
    {"frame", "K", read_frame_number, offsetof(sense_options, frame), "of the picture (default: the last)"},
    {"size", "WxH", read_picture_size, offsetof(sense_options, picture),
     "of the picture: pixels (default 1280x960)"},
    {"view", "AZ,EL", read_picture_view, offsetof(sense_options, picture),
     "of the picture: degrees around the vertical axis, degrees above the horizon"},
    {"up", "y|z", read_up, offsetof(sense_options, up),
     "of the picture: which axis points up (default: y of OBJ and glTF, else z)"},
    {"frames", "A:B", read_frames, offsetof(sense_options, frames),
     "only from frame A to frame B, both included (A: and :B are open ends)"},
    {"quiet", NULL, read_flag, offsetof(sense_options, quiet), "no progress, no warnings, no table"},
};

const option_table sense_table = {
    "sense",
    "MODEL FRAMES... [options]",
    "Watches every pair of objects (components of MODEL) with particles that walk on their surfaces, and warns "
    "where two come near: an early warning, which can miss contacts. FRAMES as for replay.",
    rows,
    sizeof rows / sizeof *rows,
    .shared = {{&frame_rows, offsetof(sense_options, source)}},
    .examples = {{"sense scene.obj scene.pc2",
                  "Warn, for each interval, where two objects of a scene come near each other."},
                 {"sense scene.obj scene.pc2 --compare --json summary.json",
                  "Also find all contacts, and say which of them the warnings miss."},
                 {"sense scene.obj scene.pc2 --picture particles.png --frame 24",
                  "Draw the particles as they are at frame 24."}}};

/* Options that contradict each other. */
static int check_options(const sense_options *o, const given_options *given) {
    static const char *const of_picture[] = {"frame", "size", "view", "up"}, *const of_random[] = {
                                                                                 "particles", "seed"};
    const cscd_sensor_options *s = &o->sensors;
    bool random = s->method == CSCD_SENSORS_RANDOM;
    for (int i = 0; i < 4; i++)
        if (o->picture_path == NULL && option_given(&sense_table, given, of_picture[i]))
            return fail_usage("sense", "--%s is of a picture; say which with --picture OUT.png",
                              of_picture[i]);
    for (int i = 0; i < 2; i++)
        if (!random && option_given(&sense_table, given, of_random[i]))
            return fail_usage("sense", "--%s is of --method random; cells has one particle in each cell",
                              of_random[i]);
    if (random && option_given(&sense_table, given, "cells"))
        return fail_usage("sense", "--cells is of --method cells; random takes --particles");
    if (random && s->within)
        return fail_usage("sense", "--within is of --method cells; random watches whole objects");
    if (s->effective_radius > 0.0 && s->effective_radius < s->collision_distance)
        return fail_usage("sense", "--reff %g is below --mu %g: particles would not feel what they warn of",
                          s->effective_radius, s->collision_distance);
    if (o->frames.step != 1)
        return fail_usage("sense",
                          "--frames with a step of %u: sense looks from one frame to the next, so it "
                          "takes A:B only",
                          o->frames.step);
    return EXIT_RAN;
}

bool sense_options_parse(int argument_count, char **arguments, sense_options *out, int *code) {
    sense_options o = {.frames = frame_range_all(),
                       .sensors = cscd_sensor_defaults(),
                       .picture = picture_options_defaults(),
                       .argument_count = argument_count,
                       .arguments = arguments};
    given_options given;
    io_error error;
    if (!option_table_read(&sense_table, argument_count, arguments, &o, &given, code)) return false;
    if (given.input_count < 2)
        *code = fail_usage("sense", given.input_count < 1 ? "no MODEL given" : "no FRAMES given");
    if (*code == EXIT_RAN) *code = check_options(&o, &given);
    o.no_plan = o.plan_path != NULL && strcmp(o.plan_path, "none") == 0;
    if (o.no_plan) o.plan_path = NULL;
    if (*code == EXIT_RAN && !output_paths_are_safe(&sense_table, &o, &given, &error))
        *code = fail_usage("sense", "%s", error.text);
    if (*code != EXIT_RAN) return false;
    recording_options_take(&o.source, &given);
    o.picture.y_up = up_axis_choose(o.up, recording_options_path(&o.source)) == UP_Y;
    *out = o;
    return true;
}
