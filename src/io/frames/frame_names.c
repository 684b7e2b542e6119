/* A growing list of file names, filled from a folder and sorted in natural order. */
#include "src/io/frames/frame_names.h"
#include "src/io/path_name.h"

#include <dirent.h>
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

frame_names frame_names_none(void) {
    return (frame_names){growable_of(sizeof(char *)), growable_of(sizeof(int32_t))};
}

size_t frame_names_count(const frame_names *list) {
    return list->names.count;
}

const char *frame_names_at(const frame_names *list, size_t index) {
    return ((char *const *)list->names.data)[index];
}

char *frame_names_copy(const char *text, size_t length) {
    char *copy = io_realloc(NULL, length + 1);
    if (copy == NULL) return NULL;
    memcpy(copy, text, length);
    copy[length] = '\0';
    return copy;
}

bool frame_names_add(frame_names *list, const char *name) {
    char *copy = frame_names_copy(name, strlen(name));
    if (copy == NULL) return false;
    char **entry = growable_push(&list->names);
    if (entry == NULL) {
        free(copy);
        return false;
    }
    *entry = copy;
    return true;
}

void frame_names_free(frame_names *list) {
    char **names = list->names.data;
    for (size_t i = 0; i < list->names.count; i++) free(names[i]);
    growable_free(&list->names);
    growable_free(&list->numbers);
}

/* A path that cannot be examined counts as no folder: it stays in the list, and reading it says what is
 * wrong. */
static bool is_folder(DIR *stream, const char *name) {
    struct stat status;
    return fstatat(dirfd(stream), name, &status, 0) == 0 && S_ISDIR(status.st_mode);
}

bool frame_names_read_folder(frame_names *list, const char *folder,
                             bool (*keep)(const char *name, const void *context), const void *context,
                             io_error *error) {
    const char *path = folder[0] == '\0' ? "." : folder;
    DIR *stream = opendir(path);
    if (stream == NULL) return io_fail(error, "%s: cannot open the folder: %s", path, strerror(errno));
    bool added = true;
    const struct dirent *entry;
    errno = 0; /* the only way to tell an error from the end */
    while (added && (entry = readdir(stream)) != NULL) {
        if (keep(entry->d_name, context) && !is_folder(stream, entry->d_name))
            added = frame_names_add(list, entry->d_name);
        errno = 0;
    }
    const int cause = errno;
    closedir(stream);
    if (!added) return io_fail(error, "%s: out of memory after %zu file names", path, list->names.count);
    if (cause != 0) return io_fail(error, "%s: cannot read the folder: %s", path, strerror(cause));
    return true;
}

/* Moves *text past its run of digits; returns where the run's value begins, past leading zeros. */
static const char *take_number(const char **text) {
    while (**text == '0') (*text)++;
    const char *start = *text;
    while (path_is_digit(**text)) (*text)++;
    return start;
}

static int compare_naturally(const char *a, const char *b) {
    while (*a != '\0' && *b != '\0') {
        if (path_is_digit(*a) && path_is_digit(*b)) {
            const char *a_start = take_number(&a), *b_start = take_number(&b);
            const size_t a_length = (size_t)(a - a_start), b_length = (size_t)(b - b_start);
            if (a_length != b_length) return a_length < b_length ? -1 : 1;
            const int order = memcmp(a_start, b_start, a_length);
            if (order != 0) return order;
        } else if (*a != *b) {
            return (unsigned char)*a < (unsigned char)*b ? -1 : 1;
        } else {
            a++;
            b++;
        }
    }
    return (*a != '\0') - (*b != '\0');
}

static int compare_names(const void *left, const void *right) {
    const char *a = *(char *const *)left, *b = *(char *const *)right;
    const int order = compare_naturally(a, b);
    return order != 0 ? order : strcmp(a, b); /* f1 and f01 */
}

void frame_names_sort(frame_names *list) {
    if (list->names.count > 1) qsort(list->names.data, list->names.count, sizeof(char *), compare_names);
}

bool frame_names_are_sorted(const frame_names *list) {
    char *const *names = list->names.data;
    for (size_t i = 1; i < list->names.count; i++)
        if (compare_names(names + i - 1, names + i) > 0) return false;
    return true;
}
