/* Between the UTF-8 of our programs and the UTF-16 of Windows: text, paths, errors. */
#include "tool/windows/wide.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

/* The wide functions take longer paths only with a prefix, which turns off everything that they do for
 * us: slashes, dots, and what is relative. A folder's limit is lower, because a name of 8.3 must fit
 * behind it. */
enum { PREFIX_FROM = MAX_PATH - 12, PREFIX_ROOM = 8 };

wchar_t *wide_text(const char *text) {
    const int size = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text, -1, NULL, 0);
    wchar_t *wide = size > 0 ? malloc((size_t)size * sizeof *wide) : NULL;
    if (wide != NULL) MultiByteToWideChar(CP_UTF8, 0, text, -1, wide, size);
    if (wide == NULL) errno = size > 0 ? ENOMEM : EILSEQ;
    return wide;
}

char *narrow_text(const wchar_t *text) {
    const int size = WideCharToMultiByte(CP_UTF8, 0, text, -1, NULL, 0, NULL, NULL);
    char *narrow = size > 0 ? malloc((size_t)size) : NULL;
    if (narrow != NULL) WideCharToMultiByte(CP_UTF8, 0, text, -1, narrow, size, NULL, NULL);
    if (narrow == NULL) errno = ENOMEM;
    return narrow;
}

/* The absolute path, with the prefix if it is that long; to be freed. */
static wchar_t *lengthen_path(const wchar_t *path) {
    const DWORD size = GetFullPathNameW(path, 0, NULL, NULL);
    wchar_t *whole = size > 0 ? malloc((size + PREFIX_ROOM) * sizeof *whole) : NULL;
    if (whole == NULL) {
        errno = size > 0 ? ENOMEM : ENOENT;
        return NULL;
    }
    wchar_t *full = whole + PREFIX_ROOM;
    const DWORD length = GetFullPathNameW(path, size, full, NULL);
    const bool is_share = length > 2 && full[0] == L'\\' && full[1] == L'\\';
    const bool is_plain = length < PREFIX_FROM || (is_share && (full[2] == L'?' || full[2] == L'.'));
    const wchar_t *prefix = is_plain ? L"" : is_share ? L"\\\\?\\UNC\\" : L"\\\\?\\";
    const size_t taken = wcslen(prefix), skipped = !is_plain && is_share ? 2 : 0;
    memmove(whole + taken, full + skipped, (length - skipped + 1) * sizeof *whole);
    memcpy(whole, prefix, taken * sizeof *whole);
    return whole;
}

wchar_t *wide_path(const char *path) {
    if (path[0] == '\0') {
        errno = ENOENT;
        return NULL;
    }
    if (strcmp(path, "/dev/null") == 0) return wide_text("NUL");
    wchar_t *wide = wide_text(path);
    if (wide == NULL) return NULL;
    wchar_t *whole = lengthen_path(wide);
    free(wide);
    return whole;
}

int wide_failure(void) {
    switch (GetLastError()) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_NAME:
    case ERROR_BAD_PATHNAME:
    case ERROR_BAD_NETPATH:
    case ERROR_BAD_NET_NAME:
    case ERROR_INVALID_DRIVE:
        errno = ENOENT;
        break;
    case ERROR_DIRECTORY:
        errno = ENOTDIR;
        break;
    case ERROR_FILE_EXISTS:
    case ERROR_ALREADY_EXISTS:
        errno = EEXIST;
        break;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION:
    case ERROR_LOCK_VIOLATION:
        errno = EACCES;
        break;
    case ERROR_WRITE_PROTECT:
        errno = EROFS;
        break;
    case ERROR_TOO_MANY_OPEN_FILES:
        errno = EMFILE;
        break;
    case ERROR_NOT_ENOUGH_MEMORY:
    case ERROR_OUTOFMEMORY:
        errno = ENOMEM;
        break;
    case ERROR_DISK_FULL:
    case ERROR_HANDLE_DISK_FULL:
        errno = ENOSPC;
        break;
    case ERROR_FILENAME_EXCED_RANGE:
        errno = ENAMETOOLONG;
        break;
    case ERROR_DIR_NOT_EMPTY:
        errno = ENOTEMPTY;
        break;
    case ERROR_BROKEN_PIPE:
    case ERROR_NO_DATA:
        errno = EPIPE;
        break;
    case ERROR_INVALID_HANDLE:
        errno = EBADF;
        break;
    default:
        errno = EIO;
    }
    return -1;
}
