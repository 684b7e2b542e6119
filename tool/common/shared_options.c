/* Rows of options that several commands have, so that each has one text. */
#include "tool/common/shared_options.h"

#include "tool/common/ignore_pairs.h"
#include "tool/common/option_values.h"
#include "tool/common/output_path.h"
#include "tool/common/recording.h"

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
