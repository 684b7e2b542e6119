/* The options of `cscd sense`. */
#include "src/tool/sense/sense_options.h"

#include "src/tool/common/command.h"
#include "src/tool/common/option_values.h"
#include "src/tool/common/output_path.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: cscd sense MODEL FRAMES... [options]\n"
    "\n"
    "Watches every pair of objects (components of MODEL) with particles that walk on their surfaces, and "
    "warns\n"
    "where two come near: an early warning, which can miss contacts. FRAMES as for replay.\n"
    "\n"
    "  --compare              also find all contacts (cscd replay, method none): recall and precision of "
    "the\n"
    "                         pairs of objects, and the time of both\n"
    "  --method cells         a particle in every cell of the partition (default)\n"
    "  --method random        a fixed number on each object, from random vertices: to compare with\n"
    "  --mu D                 the collision distance, a length in the files' unit (default 0: what the "
    "longest\n"
    "                         edges and the motion ask for)\n"
    "  --reff D               how far particles feel each other, a length, at least --mu (default 0: mu and\n"
    "                         the two largest cells)\n"
    "  --cells N              cells of each part (default 0: by how many of the smallest spheres touch one)\n"
    "  --particles N          with random: on each object (default 5)\n"
    "  --seed N               with random: default 1\n"
    "  --plan PLAN.ply|none   whose regions are the parts of concave objects (default as for replay); none:\n"
    "                         every component is one part\n"
    "  --within               with cells: parts of one object are watched for each other, too\n"
    "  --no-exact             warnings are not checked by elementary tests\n"
    "  --csv OUT.csv          write each warning: frame, parts, objects, vertices, distance, contact\n"
    "  --json OUT.json        write a summary: every interval, counts, timings, provenance\n"
    "  --picture OUT.png      draw cells, particles and where they have been\n"
    "  --frame K              of the picture (default: the last)\n"
    "  --size WxH             of the picture: pixels (default 1280x960)\n"
    "  --view AZ,EL           of the picture: degrees around the vertical axis, degrees above the horizon\n"
    "  --up y|z               of the picture: which axis points up (default z)\n"
    "  --frames A:B           only from frame A to frame B, both included (A: and :B are open ends)\n"
    "  --weld exact|EPS       join vertices that coincide, or lie within EPS, in the first frame\n"
    "  --threads N            default 1; 0: one per processor\n"
    "  --quiet                no progress, no warnings, no table\n";

enum option_id {
    OPTION_COMPARE = 1,
    OPTION_METHOD,
    OPTION_MU,
    OPTION_REFF,
    OPTION_CELLS,
    OPTION_PARTICLES,
    OPTION_SEED,
    OPTION_PLAN,
    OPTION_WITHIN,
    OPTION_NO_EXACT,
    OPTION_CSV,
    OPTION_JSON,
    OPTION_PICTURE,
    OPTION_FRAME,
    OPTION_SIZE,
    OPTION_VIEW,
    OPTION_UP,
    OPTION_FRAMES,
    OPTION_WELD,
    OPTION_THREADS,
    OPTION_QUIET,
    OPTION_HELP,
    OPTION_COUNT
};

static const struct option long_options[] = {
    {"compare", no_argument, NULL, OPTION_COMPARE},
    {"method", required_argument, NULL, OPTION_METHOD},
    {"mu", required_argument, NULL, OPTION_MU},
    {"reff", required_argument, NULL, OPTION_REFF},
    {"cells", required_argument, NULL, OPTION_CELLS},
    {"particles", required_argument, NULL, OPTION_PARTICLES},
    {"seed", required_argument, NULL, OPTION_SEED},
    {"plan", required_argument, NULL, OPTION_PLAN},
    {"within", no_argument, NULL, OPTION_WITHIN},
    {"no-exact", no_argument, NULL, OPTION_NO_EXACT},
    {"csv", required_argument, NULL, OPTION_CSV},
    {"json", required_argument, NULL, OPTION_JSON},
    {"picture", required_argument, NULL, OPTION_PICTURE},
    {"frame", required_argument, NULL, OPTION_FRAME},
    {"size", required_argument, NULL, OPTION_SIZE},
    {"view", required_argument, NULL, OPTION_VIEW},
    {"up", required_argument, NULL, OPTION_UP},
    {"frames", required_argument, NULL, OPTION_FRAMES},
    {"weld", required_argument, NULL, OPTION_WELD},
    {"threads", required_argument, NULL, OPTION_THREADS},
    {"quiet", no_argument, NULL, OPTION_QUIET},
    {"help", no_argument, NULL, OPTION_HELP},
    {NULL, 0, NULL, 0},
};

/* 1 at the option's number: it was given. */
typedef struct given_options {
    unsigned char option[OPTION_COUNT];
} given_options;

static bool parse_sensor_method(const char *text, cscd_sensor_method *out) {
    *out = strcmp(text, "random") == 0 ? CSCD_SENSORS_RANDOM : CSCD_SENSORS_CELLS;
    return *out == CSCD_SENSORS_RANDOM || strcmp(text, "cells") == 0;
}

/* Of the method, the partition and the particles. */
static bool set_sensor_option(int id, const char *value, sense_options *o) {
    switch (id) {
    case OPTION_METHOD:
        return parse_sensor_method(value, &o->sensors.method);
    case OPTION_MU:
        return parse_length(value, &o->sensors.collision_distance);
    case OPTION_REFF:
        return parse_length(value, &o->sensors.effective_radius);
    case OPTION_CELLS:
        return parse_unsigned(value, &o->partition.cells);
    case OPTION_PARTICLES:
        return parse_unsigned(value, &o->sensors.particles) && o->sensors.particles > 0;
    case OPTION_SEED:
        return parse_unsigned(value, &o->sensors.seed);
    case OPTION_PLAN:
        o->no_plan = strcmp(value, "none") == 0;
        o->plan_path = o->no_plan ? NULL : value;
        return true;
    case OPTION_WITHIN:
        return o->partition.within = true;
    case OPTION_NO_EXACT:
        o->sensors.exact = false;
        return true;
    default:
        return false;
    }
}

/* False when the value does not fit. */
static bool set_option(int id, const char *value, sense_options *o) {
    switch (id) {
    case OPTION_COMPARE:
        return o->compare = true;
    case OPTION_CSV:
        o->csv_path = value;
        return true;
    case OPTION_JSON:
        o->json_path = value;
        return true;
    case OPTION_PICTURE:
        o->picture_path = value;
        return true;
    case OPTION_FRAME:
        return parse_unsigned(value, &o->frame);
    case OPTION_SIZE:
        return parse_picture_size(value, &o->picture);
    case OPTION_VIEW:
        return parse_picture_view(value, &o->picture);
    case OPTION_UP:
        return parse_picture_up(value, &o->picture);
    case OPTION_FRAMES:
        return frame_range_parse(value, &o->frames);
    case OPTION_WELD:
        return parse_weld(value, &o->source.weld, &o->source.weld_epsilon);
    case OPTION_THREADS:
        return parse_unsigned(value, &o->source.thread_count) && o->source.thread_count <= 256;
    case OPTION_QUIET:
        return o->quiet = true;
    default:
        return set_sensor_option(id, value, o);
    }
}

/* Reads the options; MODEL and FRAMES are left in arguments from optind on. */
static int read_options(int argument_count, char **arguments, sense_options *o, given_options *given) {
    opterr = 0;
    optind = 1;
    for (int id, index = 0; (id = getopt_long(argument_count, arguments, ":", long_options, &index)) != -1;) {
        if (id == ':' || id == '?') return fail_option("sense", id, arguments);
        given->option[id] = 1;
        if (id == OPTION_HELP) return EXIT_RAN;
        if (!set_option(id, optarg, o))
            return fail_usage("sense", "--%s cannot be '%s'", long_options[index].name, optarg);
    }
    return EXIT_RAN;
}

/* What does not go together. */
static int check_options(const sense_options *o, const given_options *given) {
    static const int of_picture[] = {OPTION_FRAME, OPTION_SIZE, OPTION_VIEW, OPTION_UP};
    static const char *const names[] = {"frame", "size", "view", "up"};
    const cscd_sensor_options *s = &o->sensors;
    bool random = s->method == CSCD_SENSORS_RANDOM;
    for (int i = 0; i < 4; i++)
        if (o->picture_path == NULL && given->option[of_picture[i]])
            return fail_usage("sense", "--%s is of a picture; say which with --picture OUT.png", names[i]);
    if (!random && (given->option[OPTION_PARTICLES] || given->option[OPTION_SEED]))
        return fail_usage("sense", "--%s is of --method random; cells has one particle in each cell",
                          given->option[OPTION_PARTICLES] ? "particles" : "seed");
    if (random && given->option[OPTION_CELLS])
        return fail_usage("sense", "--cells is of --method cells; random takes --particles");
    if (random && o->partition.within)
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

/* Outputs are not inputs, and not each other. */
static int check_paths(const sense_options *o, const char *const *inputs, size_t input_count) {
    const char *others[] = {o->plan_path, o->csv_path, o->json_path};
    const char *const outputs[] = {o->csv_path, o->json_path, o->picture_path};
    static const char *const names[] = {"csv", "json", "picture"};
    io_error error;
    for (size_t i = 0; i < 3; i++)
        if (!output_path_is_safe(outputs[i], inputs, input_count, &error) ||
            !output_path_is_safe(outputs[i], others, i + 1, &error))
            return fail_usage("sense", "--%s %s", names[i], error.text);
    return EXIT_RAN;
}

bool sense_options_parse(int argument_count, char **arguments, sense_options *out, int *code) {
    given_options given = {{0}};
    sense_options o = {.source = {.thread_count = 1},
                       .frames = frame_range_all(),
                       .partition = cscd_partition_defaults(),
                       .sensors = cscd_sensor_defaults(),
                       .frame = UINT32_MAX,
                       .picture = picture_options_defaults(),
                       .argument_count = argument_count,
                       .arguments = arguments};
    *code = read_options(argument_count, arguments, &o, &given);
    if (given.option[OPTION_HELP]) fputs(help, stdout);
    if (given.option[OPTION_HELP] || *code != EXIT_RAN) return false;
    const char *const *inputs = (const char *const *)(arguments + optind);
    int rest = argument_count - optind;
    if (rest < 2) *code = fail_usage("sense", rest < 1 ? "no MODEL given" : "no FRAMES given");
    if (*code == EXIT_RAN) *code = check_options(&o, &given);
    if (*code == EXIT_RAN) *code = check_paths(&o, inputs, (size_t)rest);
    if (*code != EXIT_RAN) return false;
    o.source.model_path = inputs[0];
    o.source.frame_paths = inputs + 1;
    o.source.frame_path_count = (size_t)rest - 1;
    *out = o;
    return true;
}
