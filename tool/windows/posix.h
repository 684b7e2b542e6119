/* The part of POSIX that our programs use and Windows lacks, or has with other meanings. A build for Windows
 * includes this file before every file in C (-include), so that no other one knows of Windows: paths are
 * UTF-8, may be as long as the system allows, and have either slash; files are never translated; whoever has
 * a file open keeps nobody from replacing it. */
#pragma once

#if defined(_WIN32) && !defined(__cplusplus)

#include <dirent.h>
#include <fcntl.h>
#include <io.h>
#include <math.h>
#include <process.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

/* Our functions that print take what printf of C11 takes, and not what Microsoft's does. */
#define format(style, text, values) __format__(__gnu_##style##__, text, values)

/* The macros of mingw-w64 are slower, and warn of conversions inside them. */
#undef isfinite
#undef isinf
#undef isnan
#undef signbit
#define isfinite(x) __builtin_isfinite(x)
#define isinf(x)    __builtin_isinf(x)
#define isnan(x)    __builtin_isnan(x)
#define signbit(x)  __builtin_signbit(x)

/* ---- files ------------------------------------------------------------------------------------------- */

#undef stat
#undef fstat
#undef lstat
#undef fstatat

typedef struct windows_time {
    int64_t tv_sec;
    long tv_nsec;
} windows_time;

struct windows_stat {
    uint64_t st_dev, st_ino;
    unsigned st_mode, st_nlink;
    off_t st_size;
    int64_t st_mtime;
    windows_time st_mtim;
};

int windows_stat(const char *path, struct windows_stat *out);
int windows_fstat(int file, struct windows_stat *out);
int windows_open(const char *path, int flags, ...);
FILE *windows_fopen(const char *path, const char *mode);
int windows_rename(const char *from, const char *to);
int windows_remove(const char *path);
int windows_access(const char *path, int mode);
char *windows_mkdtemp(char *pattern);
int windows_mkdir(const char *path, unsigned mode);
int windows_rmdir(const char *path);
int windows_chdir(const char *path);
char *windows_getcwd(char *path, size_t size);
int windows_truncate(const char *path, off_t size);
int windows_fchmod(int file, unsigned mode);
int windows_chmod(const char *path, unsigned mode);
ssize_t windows_readlink(const char *path, char *target, size_t size);
char *windows_realpath(const char *path, char *resolved);
ssize_t windows_read(int file, void *bytes, size_t size);
ssize_t windows_write(int file, const void *bytes, size_t size);
ssize_t windows_pread(int file, void *bytes, size_t size, off_t offset);
int windows_fsync(int file);
int windows_fcntl(int file, int command, ...);
int windows_flock(int file, int operation);
int windows_isatty(int file);

#define stat     windows_stat
#define fstat    windows_fstat
#define lstat    windows_stat
#define open     windows_open
#define fopen    windows_fopen
#define rename   windows_rename
#define remove   windows_remove
#define unlink   windows_remove
#define access   windows_access
#define mkdtemp  windows_mkdtemp
#define mkdir    windows_mkdir
#define rmdir    windows_rmdir
#define chdir    windows_chdir
#define getcwd   windows_getcwd
#define truncate windows_truncate
#define fchmod   windows_fchmod
#define chmod    windows_chmod
#define readlink windows_readlink
#define realpath windows_realpath
#define read     windows_read
#define write    windows_write
#define pread    windows_pread
#define fsync    windows_fsync
#define fcntl    windows_fcntl
#define flock    windows_flock
#undef isatty
#define isatty windows_isatty

#ifndef PATH_MAX
#define PATH_MAX 32768
#endif
#define O_CLOEXEC       _O_NOINHERIT
#define O_NONBLOCK      0
#define F_GETFD         1
#define F_GETFL         3
#define F_DUPFD_CLOEXEC 1030
#define LOCK_EX         2
#define LOCK_NB         4
#define LOCK_UN         8
#ifndef S_ISLNK
#define S_ISLNK(mode) 0
#endif

/* ---- folders ------------------------------------------------------------------------------------------ */

typedef struct windows_folder windows_folder;

struct windows_entry {
    char d_name[1024]; /* 255 units of UTF-16 have at most 765 bytes */
};

windows_folder *windows_opendir(const char *path);
struct windows_entry *windows_readdir(windows_folder *folder);
int windows_closedir(windows_folder *folder);
int windows_fstatat(windows_folder *folder, const char *name, struct windows_stat *out, int flags);

#define DIR           windows_folder
#define dirent        windows_entry
#define opendir       windows_opendir
#define readdir       windows_readdir
#define closedir      windows_closedir
#define dirfd(folder) (folder)
#define fstatat       windows_fstatat

/* ---- text --------------------------------------------------------------------------------------------- */

/* The bytes that are written to it become text and size when it is flushed or closed. */
FILE *windows_open_memstream(char **text, size_t *size);
int windows_fflush(FILE *file);
int windows_fclose(FILE *file);
ssize_t windows_getline(char **line, size_t *size, FILE *file);
char *windows_strndup(const char *text, size_t length);
char *windows_strsep(char **rest, const char *separators);
void *windows_memmem(const void *text, size_t size, const void *word, size_t word_size);

/* The sentence for errno that other systems have. */
char *windows_strerror(int cause);

#define open_memstream windows_open_memstream
#define fflush         windows_fflush
#define fclose         windows_fclose
#define getline        windows_getline
#define strndup        windows_strndup
#define memmem         windows_memmem
#define strsep         windows_strsep
#define strerror       windows_strerror

/* ---- times and orders --------------------------------------------------------------------------------- */

struct tm *windows_gmtime_r(const time_t *time, struct tm *out);
void windows_qsort_r(void *items, size_t count, size_t size,
                     int (*compare)(const void *, const void *, void *), void *user);

#define gmtime_r windows_gmtime_r
#define qsort_r  windows_qsort_r

/* ---- the process -------------------------------------------------------------------------------------- */

#define SIGHUP       1
#define SIGPIPE      13
#define SA_RESTART   1
#define SA_RESETHAND 2

typedef struct windows_signals {
    int none;
} windows_signals;

struct windows_sigaction {
    void (*sa_handler)(int);
    windows_signals sa_mask;
    int sa_flags;
};

/* Ctrl-C is SIGINT, Ctrl-Break is SIGTERM, and a window that is closed is SIGHUP. */
int windows_sigaction(int number, const struct windows_sigaction *action, struct windows_sigaction *before);
void (*windows_signal(int number, void (*handler)(int)))(int);
int windows_raise(int number);

#define sigaction         windows_sigaction
#define sigset_t          windows_signals
#define sigemptyset(mask) ((mask)->none = 0)
#define signal            windows_signal
#define raise             windows_raise

int windows_setenv(const char *name, const char *value, int overwrite);
int windows_unsetenv(const char *name);
char *windows_getenv(const char *name);

#define setenv   windows_setenv
#define unsetenv windows_unsetenv
#define getenv   windows_getenv

#define _SC_NPROCESSORS_ONLN 84
#define _SC_PAGESIZE         30
long windows_sysconf(int name);
#define sysconf windows_sysconf

#endif
