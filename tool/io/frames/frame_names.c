/* A growing list of file names, filled from a folder and sorted in natural order. */
#include "tool/io/frames/frame_names.h"
#include "tool/io/io.h"

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

bool frame_names_number_begins(const char *name, const char *at) {
    if (path_is_digit(*at)) return true;
    return *at == '-' && path_is_digit(at[1]) &&
           (at == name || strchr("._-", at[-1]) != NULL || path_is_separator(at[-1]));
}

/* A number without its leading zeros. */
typedef struct name_number {
    const char *digits;
    size_t length; /* 0: it is 0 */
    bool negative;
} name_number;

/* Moves *text past its number. */
static name_number take_number(const char **text) {
    name_number number = {.negative = **text == '-'};
    *text += number.negative;
    while (**text == '0') (*text)++;
    number.digits = *text;
    while (path_is_digit(**text)) (*text)++;
    number.length = (size_t)(*text - number.digits);
    number.negative = number.negative && number.length > 0;
    return number;
}

static int compare_numbers(const name_number *a, const name_number *b) {
    if (a->negative != b->negative) return a->negative ? -1 : 1;
    int order =
        a->length != b->length ? (a->length < b->length ? -1 : 1) : memcmp(a->digits, b->digits, a->length);
    return a->negative ? -order : order;
}

static int compare_naturally(const char *first, const char *second) {
    const char *a = first, *b = second;
    while (*a != '\0' && *b != '\0') {
        if (frame_names_number_begins(first, a) && frame_names_number_begins(second, b)) {
            const name_number a_number = take_number(&a), b_number = take_number(&b);
            const int order = compare_numbers(&a_number, &b_number);
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

typedef struct numbered_name {
    int32_t number;
    char *name;
} numbered_name;

static int compare_numbered(const void *left, const void *right) {
    const numbered_name *a = left, *b = right;
    return a->number != b->number ? (a->number < b->number ? -1 : 1) : strcmp(a->name, b->name);
}

bool frame_names_sort_by_number(frame_names *list) {
    const size_t count = list->names.count;
    char **names = list->names.data;
    int32_t *numbers = list->numbers.data;
    numbered_name *both = io_realloc(NULL, (count + 1) * sizeof *both);
    if (both == NULL) return false;
    for (size_t i = 0; i < count; i++) both[i] = (numbered_name){numbers[i], names[i]};
    if (count > 1) qsort(both, count, sizeof *both, compare_numbered);
    for (size_t i = 0; i < count; i++) {
        names[i] = both[i].name;
        numbers[i] = both[i].number;
    }
    free(both);
    return true;
}
