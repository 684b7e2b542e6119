/* Finds the frames in a folder and makes sure that they are one series. */
#include "src/io/frame_folder.h"
#include "src/io/path_name.h"

#include <string.h>

/* How two names differ: in the text around their numbers, or in the values of this many numbers. */
typedef struct name_difference {
    bool in_text;
    size_t number_count;
    size_t last_number; /* how many numbers precede the last one that differs */
} name_difference;

/* Plans lie beside the meshes that they were made for. */
static bool keep_mesh(const char *name, const void *context) {
    (void)context;
    return name[0] != '.' && frame_names_is_mesh(name) && !path_has_extension(name, ".plan.ply");
}

/* Steps over the numbers that both names have here; true if their values are the same. */
static bool skip_equal_numbers(const char **a, const char **b) {
    *a += strspn(*a, "0");
    *b += strspn(*b, "0");
    const size_t a_length = strspn(*a, "0123456789"), b_length = strspn(*b, "0123456789");
    const bool equal = a_length == b_length && memcmp(*a, *b, a_length) == 0;
    *a += a_length;
    *b += b_length;
    return equal;
}

static name_difference compare_names(const char *a, const char *b) {
    name_difference difference = {0};
    for (size_t number = 0; *a != '\0' || *b != '\0';) {
        if (path_is_digit(*a) && path_is_digit(*b)) {
            if (!skip_equal_numbers(&a, &b)) {
                difference.number_count++;
                difference.last_number = number;
            }
            number++;
        } else if (*a++ != *b++) {
            difference.in_text = true;
            break;
        }
    }
    return difference;
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
static bool check_series(const char *folder, const frame_names *list, io_error *error) {
    size_t series_number = 0;
    for (size_t i = 1; i < frame_names_count(list); i++) {
        const char *before = frame_names_at(list, i - 1), *name = frame_names_at(list, i);
        const name_difference from_first = compare_names(frame_names_at(list, 0), name);
        if (from_first.in_text)
            return io_fail(error, "%s: holds both %s and %s, expected names that differ in a number only",
                           folder, frame_names_at(list, 0), name);
        if (compare_names(before, name).number_count == 0)
            return io_fail(error, "%s: holds both %s and %s, which are the same frame", folder, before, name);
        if (i == 1) series_number = from_first.last_number;
        if (from_first.number_count != 1 || from_first.last_number != series_number)
            return io_fail(error, "%s: holds both %s and %s, expected names that differ in one number only",
                           folder, frame_names_at(list, 0), name);
    }
    return true;
}

bool frame_folder_find(const char *folder, frame_names *list, io_error *error) {
    if (!frame_names_read_folder(list, folder, keep_mesh, NULL, error)) return false;
    if (frame_names_count(list) == 0)
        return io_fail(error, "%s: no frames in this folder, expected .obj, .ply or .off files", folder);
    frame_names_sort(list);
    return check_extensions(folder, list, error) && check_series(folder, list, error);
}
