/* Finds the frames in a folder and makes sure that they are one series. */
#include "tool/io/frames/frame_folder.h"
#include "tool/io/frames/frame_series.h"
#include "tool/io/mesh_format.h"
#include "tool/io/path_name.h"

#include <string.h>

/* Plans lie beside the meshes that they were made for. */
static bool keep_mesh(const char *name, const void *context) {
    (void)context;
    return name[0] != '.' && path_mesh_ending(name) > 0 && !path_has_extension(name, ".plan.ply");
}

static bool check_extensions(const char *folder, const frame_names *list, io_error *error) {
    const char *first = frame_names_at(list, 0);
    for (size_t i = 1; i < frame_names_count(list); i++)
        if (strcmp(strrchr(first, '.'), strrchr(frame_names_at(list, i), '.')) != 0)
            return io_fail(error, "%s: holds both %s and %s, expected one extension", folder, first,
                           frame_names_at(list, i));
    return true;
}

/* Compares all names with the first: each must differ from it in one number, always the same one, and no two may be
 * equal. */
static bool check_series(const char *folder, const frame_names *list, size_t *number, io_error *error) {
    size_t series_number = 0;
    for (size_t i = 1; i < frame_names_count(list); i++) {
        const char *before = frame_names_at(list, i - 1), *name = frame_names_at(list, i);
        const name_difference from_first = frame_series_compare(frame_names_at(list, 0), name);
        if (from_first.in_text)
            return io_fail(error, "%s: holds both %s and %s, expected names that differ in a number only",
                           folder, frame_names_at(list, 0), name);
        if (frame_series_compare(before, name).number_count == 0)
            return io_fail(error, "%s: holds both %s and %s, which are the same frame", folder, before, name);
        if (i == 1) series_number = from_first.last_number;
        if (from_first.number_count != 1 || from_first.last_number != series_number)
            return io_fail(error, "%s: holds both %s and %s, expected names that differ in one number only",
                           folder, frame_names_at(list, 0), name);
    }
    *number = frame_names_count(list) > 1 ? series_number : SIZE_MAX;
    return true;
}

bool frame_folder_find(const char *folder, const char *prefix, bool allow_gaps, frame_names *list,
                       bool *fractions, io_error *error) {
    *fractions = false;
    if (!frame_names_read_folder(list, folder, keep_mesh, NULL, error)) return false;
    if (frame_names_count(list) == 0)
        return io_fail(error, "%s: no frames in this folder, expected " MESH_FORMAT_ENDINGS " files", folder);
    frame_names_sort(list);
    size_t number = SIZE_MAX;
    if (!check_extensions(folder, list, error)) return false;
    if (!frame_series_find(list, &number) && !frame_series_take_fractions(list, fractions))
        return io_fail(error, "%s: out of memory", folder);
    if (*fractions) return frame_series_end_fractions(prefix, list, allow_gaps, error);
    if (!check_series(folder, list, &number, error)) return false;
    return frame_series_read(prefix, list, number, &list->numbers, error) &&
           (allow_gaps || frame_series_is_complete(prefix, list, number, error));
}
