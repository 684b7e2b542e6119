/* Streams into memory, lines, copies, and the sentences for errors. */
#include "tool/windows/posix.h"

#include <errno.h>
#include <pthread.h>
#include <windows.h>

#undef fflush
#undef fclose
#undef strerror

/* A stream into memory is a file that is deleted when it is closed, and that the system keeps in memory while
 * there is room. */
typedef struct memory_stream {
    FILE *file;
    char **text;
    size_t *size;
    struct memory_stream *next;
} memory_stream;

static memory_stream *memory_streams;
static pthread_mutex_t stream_lock = PTHREAD_MUTEX_INITIALIZER;

static FILE *open_nameless(void) {
    wchar_t folder[MAX_PATH + 1], name[MAX_PATH + 1];
    if (GetTempPathW(MAX_PATH + 1, folder) == 0 || GetTempFileNameW(folder, L"csc", 0, name) == 0)
        return NULL;
    const HANDLE handle =
        CreateFileW(name, GENERIC_READ | GENERIC_WRITE | DELETE, FILE_SHARE_READ | FILE_SHARE_DELETE, NULL,
                    CREATE_ALWAYS, FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, NULL);
    const int file = handle != INVALID_HANDLE_VALUE
                         ? _open_osfhandle((intptr_t)handle, O_RDWR | O_BINARY | O_CLOEXEC)
                         : -1;
    return file >= 0 ? fdopen(file, "w+b") : NULL;
}

FILE *windows_open_memstream(char **text, size_t *size) {
    memory_stream *stream = malloc(sizeof *stream);
    FILE *file = stream != NULL ? open_nameless() : NULL;
    *text = NULL;
    *size = 0;
    if (file == NULL) {
        free(stream);
        errno = ENOMEM;
        return NULL;
    }
    *stream = (memory_stream){file, text, size, NULL};
    pthread_mutex_lock(&stream_lock);
    stream->next = memory_streams;
    memory_streams = stream;
    pthread_mutex_unlock(&stream_lock);
    return file;
}

static memory_stream *find_stream(const FILE *file, bool take) {
    pthread_mutex_lock(&stream_lock);
    memory_stream **at = &memory_streams;
    while (*at != NULL && (*at)->file != file) at = &(*at)->next;
    memory_stream *found = *at;
    if (found != NULL && take) *at = found->next;
    pthread_mutex_unlock(&stream_lock);
    return found;
}

/* The text up to where the stream is; that is where writing goes on afterwards. */
static bool read_back(const memory_stream *stream) {
    const off_t size = fflush(stream->file) == 0 ? ftello(stream->file) : -1;
    char *text = size >= 0 ? realloc(*stream->text, (size_t)size + 1) : NULL;
    if (text == NULL) return false;
    *stream->text = text;
    *stream->size = (size_t)size;
    text[size] = '\0';
    rewind(stream->file);
    const bool whole = fread(text, 1, (size_t)size, stream->file) == (size_t)size;
    return fseeko(stream->file, size, SEEK_SET) == 0 && whole;
}

int windows_fflush(FILE *file) {
    const memory_stream *stream = file != NULL ? find_stream(file, false) : NULL;
    return stream == NULL ? fflush(file) : read_back(stream) ? 0 : EOF;
}

int windows_fclose(FILE *file) {
    memory_stream *stream = find_stream(file, true);
    const bool whole = stream == NULL || read_back(stream);
    free(stream);
    return fclose(file) == 0 && whole ? 0 : EOF;
}

ssize_t windows_getline(char **line, size_t *size, FILE *file) {
    size_t length = 0;
    for (int c = 0; c != '\n' && (c = getc(file)) != EOF;) {
        if (length + 2 > *size || *line == NULL) {
            const size_t room = 2 * length + 128;
            char *grown = realloc(*line, room);
            if (grown == NULL) return -1;
            *line = grown;
            *size = room;
        }
        (*line)[length++] = (char)c;
    }
    if (length == 0) return -1;
    (*line)[length] = '\0';
    return (ssize_t)length;
}

char *windows_strndup(const char *text, size_t length) {
    const size_t size = strnlen(text, length);
    char *copy = malloc(size + 1);
    if (copy == NULL) return NULL;
    memcpy(copy, text, size);
    copy[size] = '\0';
    return copy;
}

char *windows_strsep(char **rest, const char *separators) {
    char *word = *rest;
    if (word == NULL) return NULL;
    char *end = word + strcspn(word, separators);
    *rest = *end != '\0' ? end + 1 : NULL;
    *end = '\0';
    return word;
}

void *windows_memmem(const void *text, size_t size, const void *word, size_t word_size) {
    const char *at = text, *end = at + size;
    for (; word_size <= (size_t)(end - at); at++) {
        at = memchr(at, *(const char *)word, (size_t)(end - at) - word_size + 1);
        if (at == NULL) return NULL;
        if (memcmp(at, word, word_size) == 0) return (void *)(uintptr_t)at;
    }
    return NULL;
}

/* ---- times and orders -------------------------------------------------------------------------------------- */

struct tm *windows_gmtime_r(const time_t *time, struct tm *out) {
    return gmtime_s(out, time) == 0 ? out : NULL;
}

/* qsort_s of Windows gives its comparison the user's pointer first. */
typedef struct user_order {
    int (*compare)(const void *, const void *, void *);
    void *user;
} user_order;

static int compare_for_user(void *context, const void *a, const void *b) {
    const user_order *order = context;
    return order->compare(a, b, order->user);
}

void windows_qsort_r(void *items, size_t count, size_t size,
                     int (*compare)(const void *, const void *, void *), void *user) {
    user_order order = {compare, user};
    qsort_s(items, count, size, compare_for_user, &order);
}

/* Functions that the C library of Windows calls otherwise, or does not have. */
char *windows_strerror(int cause) {
    static char too_many[] = "Too many open files", not_folder[] = "Not a directory",
                is_folder[] = "Is a directory", too_long[] = "File name too long",
                not_empty[] = "Directory not empty", no_utf8[] = "Not a name in UTF-8",
                broken_pipe[] = "Broken pipe", io[] = "Input/output error",
                memory[] = "Cannot allocate memory";
    switch (cause) {
    case EMFILE:
        return too_many;
    case ENOTDIR:
        return not_folder;
    case EISDIR:
        return is_folder;
    case ENAMETOOLONG:
        return too_long;
    case ENOTEMPTY:
        return not_empty;
    case EILSEQ:
        return no_utf8;
    case EPIPE:
        return broken_pipe;
    case EIO:
        return io;
    case ENOMEM:
        return memory;
    default:
        return strerror(cause);
    }
}
