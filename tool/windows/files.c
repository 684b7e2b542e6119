/* Files by the wide functions of Windows, with the meanings of POSIX. */
#include "tool/windows/posix.h"
#include "tool/windows/wide.h"

#include <errno.h>
#include <stdarg.h>
#include <windows.h>

/* ---- files --------------------------------------------------------------------------------------------- */

#undef stat

/* A path that is a moment away from being free, because a virus scanner or an indexer looks at it, is tried
 * again. */
enum { RETRIES = 20, RETRY_MS = 25 };

/* Whoever reads a file keeps nobody from replacing or removing it, as elsewhere. */
static const DWORD share_all = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

static HANDLE handle_of(int file) {
    return (HANDLE)_get_osfhandle(file);
}

/* ---- opening --------------------------------------------------------------------------------------------- */

static DWORD access_of(int flags) {
    const int way = flags & (O_RDONLY | O_WRONLY | O_RDWR);
    return way == O_RDONLY ? GENERIC_READ : way == O_WRONLY ? GENERIC_WRITE : GENERIC_READ | GENERIC_WRITE;
}

static DWORD creation_of(int flags) {
    if ((flags & (O_CREAT | O_EXCL)) == (O_CREAT | O_EXCL)) return CREATE_NEW;
    if ((flags & (O_CREAT | O_TRUNC)) == (O_CREAT | O_TRUNC)) return CREATE_ALWAYS;
    if ((flags & O_CREAT) != 0) return OPEN_ALWAYS;
    return (flags & O_TRUNC) != 0 ? TRUNCATE_EXISTING : OPEN_EXISTING;
}

/* A folder opens for reading, so that whoever reads it can say that it is one. */
static int open_wide(const wchar_t *path, int flags) {
    SECURITY_ATTRIBUTES inherited = {sizeof inherited, NULL, (flags & O_CLOEXEC) == 0};
    const HANDLE handle = CreateFileW(path, access_of(flags), share_all, &inherited, creation_of(flags),
                                      FILE_ATTRIBUTE_NORMAL | FILE_FLAG_BACKUP_SEMANTICS, NULL);
    if (handle == INVALID_HANDLE_VALUE) return wide_failure();
    const int file = _open_osfhandle((intptr_t)handle, (flags & (O_APPEND | O_CLOEXEC)) | O_BINARY);
    if (file < 0) CloseHandle(handle);
    return file;
}

int windows_open(const char *path, int flags, ...) {
    wchar_t *wide = wide_path(path);
    if (wide == NULL) return -1;
    const int file = open_wide(wide, flags);
    free(wide);
    return file;
}

FILE *windows_fopen(const char *path, const char *mode) {
    const bool both = strchr(mode, '+') != NULL;
    const int way = both ? O_RDWR : mode[0] == 'r' ? O_RDONLY : O_WRONLY;
    const int made = mode[0] == 'r' ? 0 : mode[0] == 'w' ? O_CREAT | O_TRUNC : O_CREAT | O_APPEND;
    const int file = windows_open(path, way | made | O_CLOEXEC);
    if (file < 0) return NULL;
    const char binary[] = {mode[0], 'b', both ? '+' : '\0', '\0'};
    FILE *stream = fdopen(file, binary);
    if (stream == NULL) close(file);
    return stream;
}

/* ---- what a path is -------------------------------------------------------------------------------------- */

static int64_t seconds_of(FILETIME time, long *nanoseconds) {
    const uint64_t ticks = (uint64_t)time.dwHighDateTime << 32 | time.dwLowDateTime;
    *nanoseconds = (long)(ticks % 10000000) * 100;
    return (int64_t)(ticks / 10000000) - INT64_C(11644473600);
}

static int describe_handle(HANDLE handle, struct windows_stat *out) {
    BY_HANDLE_FILE_INFORMATION info;
    *out = (struct windows_stat){.st_nlink = 1};
    const DWORD type = GetFileType(handle);
    if (type == FILE_TYPE_CHAR || type == FILE_TYPE_PIPE) {
        out->st_mode = type == FILE_TYPE_CHAR ? S_IFCHR | 0666 : S_IFIFO | 0666;
        out->st_ino = (uint64_t)(uintptr_t)handle; /* so no two pipes are one file */
        return 0;
    }
    if (!GetFileInformationByHandle(handle, &info)) return wide_failure();
    const bool is_folder = (info.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
    const bool is_fixed = (info.dwFileAttributes & FILE_ATTRIBUTE_READONLY) != 0;
    out->st_mode = (is_folder ? S_IFDIR | 0111u : S_IFREG) | (is_fixed ? 0444u : 0666u);
    out->st_dev = info.dwVolumeSerialNumber;
    out->st_ino = (uint64_t)info.nFileIndexHigh << 32 | info.nFileIndexLow;
    out->st_nlink = info.nNumberOfLinks;
    out->st_size = (off_t)((uint64_t)info.nFileSizeHigh << 32 | info.nFileSizeLow);
    out->st_mtime = out->st_mtim.tv_sec = seconds_of(info.ftLastWriteTime, &out->st_mtim.tv_nsec);
    return 0;
}

int windows_stat(const char *path, struct windows_stat *out) {
    wchar_t *wide = wide_path(path);
    if (wide == NULL) return -1;
    const HANDLE handle = CreateFileW(wide, FILE_READ_ATTRIBUTES, share_all, NULL, OPEN_EXISTING,
                                      FILE_FLAG_BACKUP_SEMANTICS, NULL);
    free(wide);
    if (handle == INVALID_HANDLE_VALUE) return wide_failure();
    const int result = describe_handle(handle, out);
    CloseHandle(handle);
    return result;
}

int windows_fstat(int file, struct windows_stat *out) {
    const HANDLE handle = handle_of(file);
    if (handle != INVALID_HANDLE_VALUE) return describe_handle(handle, out);
    errno = EBADF;
    return -1;
}

/* Whether a file can be executed is not asked of Windows: whatever is there can be tried. */
int windows_access(const char *path, int mode) {
    struct windows_stat status;
    if (windows_stat(path, &status) != 0) return -1;
    if ((mode & W_OK) == 0 || (status.st_mode & 0222) != 0 || S_ISDIR(status.st_mode)) return 0;
    errno = EACCES;
    return -1;
}

int windows_isatty(int file) {
    DWORD mode;
    return GetConsoleMode(handle_of(file), &mode) != 0;
}

/* Links are followed by the system; none is read. */
ssize_t windows_readlink(const char *path, char *target, size_t size) {
    (void)path, (void)target, (void)size;
    errno = EINVAL;
    return -1;
}

/* The path by which the system knows an open file, without the prefix of the wide functions; to be freed. */
static char *final_path(HANDLE handle) {
    wchar_t wide[PATH_MAX];
    const DWORD length = GetFinalPathNameByHandleW(handle, wide, PATH_MAX, FILE_NAME_NORMALIZED);
    if (length == 0 || length >= PATH_MAX) {
        wide_failure();
        return NULL;
    }
    const bool is_share = wcsncmp(wide, L"\\\\?\\UNC\\", 8) == 0;
    if (is_share) wide[6] = L'\\';
    char *path = narrow_text(is_share ? wide + 6 : wcsncmp(wide, L"\\\\?\\", 4) == 0 ? wide + 4 : wide);
    for (char *c = path; c != NULL && *c != '\0'; c++)
        if (*c == '\\') *c = '/';
    return path;
}

/* With slashes, as our programs put paths together. */
char *windows_realpath(const char *path, char *resolved) {
    (void)resolved;
    wchar_t *wide = wide_path(path);
    if (wide == NULL) return NULL;
    const HANDLE handle = CreateFileW(wide, FILE_READ_ATTRIBUTES, share_all, NULL, OPEN_EXISTING,
                                      FILE_FLAG_BACKUP_SEMANTICS, NULL);
    free(wide);
    if (handle == INVALID_HANDLE_VALUE) {
        wide_failure();
        return NULL;
    }
    char *whole = final_path(handle);
    CloseHandle(handle);
    return whole;
}

/* ---- changing what is there ------------------------------------------------------------------------------ */

static bool try_again(int attempt) {
    const DWORD cause = GetLastError();
    if (attempt >= RETRIES || (cause != ERROR_SHARING_VIOLATION && cause != ERROR_ACCESS_DENIED))
        return false;
    Sleep(RETRY_MS);
    return true;
}

/* FileRenameInfoEx, which headers have from a later version of Windows on than ours. */
static const FILE_INFO_BY_HANDLE_CLASS rename_info_ex = (FILE_INFO_BY_HANDLE_CLASS)22;

/* Renames the file as POSIX does, also where somebody has one of that name open: he keeps what he has
 * opened. Windows 10 does so on its own file system; false: this one does not, or it went wrong. */
static bool rename_as_posix(const wchar_t *from, const wchar_t *to) {
    const size_t size = wcslen(to) * sizeof *to;
    FILE_RENAME_INFO *info = calloc(1, sizeof *info + size);
    if (info == NULL) return false;
    info->Flags = FILE_RENAME_FLAG_REPLACE_IF_EXISTS | FILE_RENAME_FLAG_POSIX_SEMANTICS;
    info->FileNameLength = (DWORD)size;
    memcpy(info->FileName, to, size);
    const HANDLE handle =
        CreateFileW(from, DELETE, share_all, NULL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, NULL);
    const bool renamed =
        handle != INVALID_HANDLE_VALUE &&
        SetFileInformationByHandle(handle, rename_info_ex, info, (DWORD)(sizeof *info + size));
    if (handle != INVALID_HANDLE_VALUE) CloseHandle(handle);
    free(info);
    return renamed;
}

/* Takes the place of a file that is there, in one step. */
static bool rename_wide(const wchar_t *from, const wchar_t *to) {
    if (rename_as_posix(from, to)) return true;
    BOOL moved = FALSE;
    for (int i = 0; !moved && (i == 0 || try_again(i)); i++)
        moved = MoveFileExW(from, to, MOVEFILE_REPLACE_EXISTING | MOVEFILE_COPY_ALLOWED);
    return moved;
}

int windows_rename(const char *from, const char *to) {
    wchar_t *wide_from = wide_path(from), *wide_to = wide_path(to);
    int result = -1;
    if (wide_from != NULL && wide_to != NULL) result = rename_wide(wide_from, wide_to) ? 0 : wide_failure();
    free(wide_from);
    free(wide_to);
    return result;
}

int windows_remove(const char *path) {
    wchar_t *wide = wide_path(path);
    if (wide == NULL) return -1;
    const DWORD attributes = GetFileAttributesW(wide);
    const bool is_folder =
        attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
    const BOOL removed = is_folder ? RemoveDirectoryW(wide) : DeleteFileW(wide);
    const int result = removed ? 0 : wide_failure();
    free(wide);
    return result;
}

int windows_rmdir(const char *path) {
    return windows_remove(path);
}

int windows_mkdir(const char *path, unsigned mode) {
    (void)mode;
    wchar_t *wide = wide_path(path);
    if (wide == NULL) return -1;
    const int result = CreateDirectoryW(wide, NULL) ? 0 : wide_failure();
    free(wide);
    return result;
}

/* The six X at the end become digits that no folder has yet. */
char *windows_mkdtemp(char *pattern) {
    char *digits = pattern + strlen(pattern) - 6;
    for (unsigned i = 0; i < 1000000; i++) {
        snprintf(digits, 7, "%06u", (unsigned)(GetCurrentProcessId() * 1000u + i) % 1000000u);
        if (windows_mkdir(pattern, 0700) == 0) return pattern;
        if (errno != EEXIST) break;
    }
    return NULL;
}

int windows_chdir(const char *path) {
    wchar_t *wide = wide_path(path);
    if (wide == NULL) return -1;
    const int result = SetCurrentDirectoryW(wide) ? 0 : wide_failure();
    free(wide);
    return result;
}

char *windows_getcwd(char *path, size_t size) {
    wchar_t wide[PATH_MAX];
    const DWORD length = GetCurrentDirectoryW(PATH_MAX, wide);
    char *own = length > 0 && length < PATH_MAX ? narrow_text(wide) : NULL;
    const bool fits = own != NULL && strlen(own) < size;
    if (fits) strcpy(path, own);
    for (char *c = path; fits && *c != '\0'; c++)
        if (*c == '\\') *c = '/';
    free(own);
    if (!fits) errno = ERANGE;
    return fits ? path : NULL;
}

int windows_truncate(const char *path, off_t size) {
    const int file = windows_open(path, O_WRONLY | O_CLOEXEC);
    if (file < 0) return -1;
    const int result = ftruncate(file, size);
    close(file);
    return result;
}

/* Windows has one of the permissions here: whether the file may be written. */
int windows_chmod(const char *path, unsigned mode) {
    wchar_t *wide = wide_path(path);
    if (wide == NULL) return -1;
    const DWORD fixed = (mode & 0222) == 0 ? FILE_ATTRIBUTE_READONLY : FILE_ATTRIBUTE_NORMAL;
    const int result = SetFileAttributesW(wide, fixed) ? 0 : wide_failure();
    free(wide);
    return result;
}

int windows_fchmod(int file, unsigned mode) {
    (void)file, (void)mode;
    return 0;
}

/* ---- bytes ----------------------------------------------------------------------------------------------- */

enum { TRANSFER_MAX = 1 << 30 };

ssize_t windows_read(int file, void *bytes, size_t size) {
    return _read(file, bytes, size < TRANSFER_MAX ? (unsigned)size : TRANSFER_MAX);
}

ssize_t windows_write(int file, const void *bytes, size_t size) {
    return _write(file, bytes, size < TRANSFER_MAX ? (unsigned)size : TRANSFER_MAX);
}

/* Unlike that of POSIX it moves the place at which the next plain read begins, which nobody uses beside
 * it. */
ssize_t windows_pread(int file, void *bytes, size_t size, off_t offset) {
    OVERLAPPED place = {.Offset = (DWORD)offset, .OffsetHigh = (DWORD)((uint64_t)offset >> 32)};
    DWORD got = 0;
    if (ReadFile(handle_of(file), bytes, size < TRANSFER_MAX ? (DWORD)size : TRANSFER_MAX, &got, &place))
        return (ssize_t)got;
    return GetLastError() == ERROR_HANDLE_EOF ? 0 : wide_failure();
}

int windows_fsync(int file) {
    if (GetFileType(handle_of(file)) != FILE_TYPE_DISK) {
        errno = EINVAL;
        return -1;
    }
    return _commit(file);
}

/* ---- descriptors and locks --------------------------------------------------------------------------------- */

static int duplicate_from(int file, int lowest) {
    int made[64], count = 0, result = -1;
    while (count < 64 && (result = _dup(file)) >= 0 && result < lowest) made[count++] = result;
    for (int i = 0; i < count; i++) close(made[i]);
    if (result >= 0) SetHandleInformation(handle_of(result), HANDLE_FLAG_INHERIT, 0);
    return result;
}

/* F_GETFL does not know whether a file was opened for reading alone. */
int windows_fcntl(int file, int command, ...) {
    if (handle_of(file) == INVALID_HANDLE_VALUE || (intptr_t)handle_of(file) == -2) {
        errno = EBADF;
        return -1;
    }
    va_list arguments;
    va_start(arguments, command);
    const int lowest = command == F_DUPFD_CLOEXEC ? va_arg(arguments, int) : 0;
    va_end(arguments);
    return command == F_DUPFD_CLOEXEC ? duplicate_from(file, lowest) : command == F_GETFL ? O_RDWR : 0;
}

/* Locks of Windows keep others from reading what is locked, so a byte is locked where no file ends. */
int windows_flock(int file, int operation) {
    OVERLAPPED place = {.Offset = 0, .OffsetHigh = 0x40000000};
    const DWORD flags =
        LOCKFILE_EXCLUSIVE_LOCK | ((operation & LOCK_NB) != 0 ? LOCKFILE_FAIL_IMMEDIATELY : 0);
    const BOOL done = (operation & LOCK_UN) != 0 ? UnlockFileEx(handle_of(file), 0, 1, 0, &place)
                                                 : LockFileEx(handle_of(file), flags, 0, 1, 0, &place);
    if (done) return 0;
    if (GetLastError() == ERROR_INVALID_FUNCTION)
        errno = EOPNOTSUPP; /* a device */
    else if (GetLastError() == ERROR_LOCK_VIOLATION || GetLastError() == ERROR_IO_PENDING)
        errno = EWOULDBLOCK;
    else
        return wide_failure();
    return -1;
}

/* ---- folders ------------------------------------------------------------------------------------------- */

struct windows_folder {
    HANDLE search;
    WIN32_FIND_DATAW found;
    bool ready; /* found holds an entry that was not read yet */
    struct windows_entry entry;
    char path[];
};

static HANDLE begin_search(const char *path, WIN32_FIND_DATAW *found) {
    const size_t length = strlen(path);
    char *pattern = malloc(length + 3);
    if (pattern == NULL) return INVALID_HANDLE_VALUE;
    memcpy(pattern, path, length);
    strcpy(pattern + length, "/*");
    wchar_t *wide = wide_path(pattern);
    free(pattern);
    const HANDLE search = wide != NULL ? FindFirstFileW(wide, found) : INVALID_HANDLE_VALUE;
    if (wide != NULL && search == INVALID_HANDLE_VALUE) wide_failure();
    free(wide);
    return search;
}

windows_folder *windows_opendir(const char *path) {
    struct windows_stat status;
    if (windows_stat(path, &status) != 0) return NULL;
    if (!S_ISDIR(status.st_mode)) {
        errno = ENOTDIR;
        return NULL;
    }
    const size_t size = strlen(path) + 1;
    windows_folder *folder = malloc(sizeof *folder + size);
    if (folder == NULL) return NULL;
    memcpy(folder->path, path, size);
    folder->search = begin_search(path, &folder->found);
    folder->ready = true;
    if (folder->search != INVALID_HANDLE_VALUE) return folder;
    free(folder);
    return NULL;
}

struct windows_entry *windows_readdir(windows_folder *folder) {
    if (!folder->ready && !FindNextFileW(folder->search, &folder->found)) {
        if (GetLastError() != ERROR_NO_MORE_FILES) wide_failure();
        return NULL;
    }
    folder->ready = false;
    char *name = narrow_text(folder->found.cFileName);
    if (name == NULL) return NULL;
    snprintf(folder->entry.d_name, sizeof folder->entry.d_name, "%s", name);
    free(name);
    return &folder->entry;
}

int windows_closedir(windows_folder *folder) {
    FindClose(folder->search);
    free(folder);
    return 0;
}

int windows_fstatat(windows_folder *folder, const char *name, struct windows_stat *out, int flags) {
    (void)flags;
    const size_t folder_size = strlen(folder->path), name_size = strlen(name) + 1;
    char *path = malloc(folder_size + 1 + name_size);
    if (path == NULL) return -1;
    memcpy(path, folder->path, folder_size);
    path[folder_size] = '/';
    memcpy(path + folder_size + 1, name, name_size);
    const int result = windows_stat(path, out);
    free(path);
    return result;
}
