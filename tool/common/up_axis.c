/* Which axis of a model points up in pictures and pages. */
#include "tool/common/up_axis.h"

#include "tool/common/option_values.h"
#include "tool/io/gltf.h"
#include "tool/io/path_name.h"

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
