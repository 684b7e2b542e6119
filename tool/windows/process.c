/* Signals, the environment, and what the system is. */
#include "tool/windows/console.h"
#include "tool/windows/posix.h"
#include "tool/windows/wide.h"

#include <errno.h>
#include <stdatomic.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <windows.h>

enum { SIGNALS = 32 };

/* The handlers are called on a thread that the system makes for the event. */
typedef struct signal_entry {
    _Atomic(uintptr_t) handler; /* 0: none */
    atomic_int flags;
} signal_entry;

static signal_entry signals[SIGNALS];
static atomic_bool listening;

/* False: nobody has asked for it, or it is the second one of those who asked once. */
static bool deliver_signal(int number) {
    signal_entry *entry = &signals[number];
    const uintptr_t handler = atomic_load(&entry->handler);
    if (handler == (uintptr_t)SIG_IGN) return true;
    if (handler == (uintptr_t)SIG_DFL) return false;
    if ((atomic_load(&entry->flags) & SA_RESETHAND) != 0) atomic_store(&entry->handler, (uintptr_t)SIG_DFL);
    ((void (*)(int))handler)(number);
    return true;
}

/* A process whose window was closed ends when this function returns, and after some seconds in any case. */
static BOOL WINAPI hear_console(DWORD event) {
    if (event == CTRL_C_EVENT) return deliver_signal(SIGINT);
    if (event == CTRL_BREAK_EVENT) return deliver_signal(SIGTERM);
    if (!deliver_signal(SIGHUP)) return FALSE;
    Sleep(INFINITE);
    return TRUE;
}

int windows_sigaction(int number, const struct windows_sigaction *action, struct windows_sigaction *before) {
    if (number < 1 || number >= SIGNALS) {
        errno = EINVAL;
        return -1;
    }
    signal_entry *entry = &signals[number];
    if (before != NULL)
        *before = (struct windows_sigaction){.sa_handler = (void (*)(int))atomic_load(&entry->handler),
                                             .sa_flags = atomic_load(&entry->flags)};
    if (action == NULL) return 0;
    atomic_store(&entry->flags, action->sa_flags);
    atomic_store(&entry->handler, (uintptr_t)action->sa_handler);
    if (!atomic_exchange(&listening, true)) SetConsoleCtrlHandler(hear_console, TRUE);
    return 0;
}

void (*windows_signal(int number, void (*handler)(int)))(int) {
    struct windows_sigaction before, action = {.sa_handler = handler};
    return windows_sigaction(number, &action, &before) == 0 ? before.sa_handler : SIG_ERR;
}

int windows_raise(int number) {
    if (!deliver_signal(number)) _exit(128 + number);
    return 0;
}

/* ---- the environment --------------------------------------------------------------------------------------- */

static int set_variable(const char *name, const char *value) {
    wchar_t *wide_name = wide_text(name), *wide_value = value != NULL ? wide_text(value) : NULL;
    const bool good = wide_name != NULL && (value == NULL || wide_value != NULL) &&
                      _wputenv_s(wide_name, wide_value != NULL ? wide_value : L"") == 0;
    free(wide_name);
    free(wide_value);
    return good ? 0 : -1;
}

int windows_setenv(const char *name, const char *value, int overwrite) {
    return overwrite == 0 && windows_getenv(name) != NULL ? 0 : set_variable(name, value);
}

int windows_unsetenv(const char *name) {
    return set_variable(name, NULL);
}

/* The value in UTF-8. Values that were given out stay, as callers expect; each of them once. */
char *windows_getenv(const char *name) {
    typedef struct given_value {
        struct given_value *next;
        char text[];
    } given_value;
    static given_value *given;
    wchar_t *wide_name = wide_text(name);
    const wchar_t *value = wide_name != NULL ? _wgetenv(wide_name) : NULL;
    char *text = value != NULL ? narrow_text(value) : NULL;
    free(wide_name);
    if (text == NULL) return NULL;
    given_value *g = given;
    while (g != NULL && strcmp(g->text, text) != 0) g = g->next;
    if (g == NULL && (g = malloc(sizeof *g + strlen(text) + 1)) != NULL) {
        strcpy(g->text, text);
        g->next = given;
        given = g;
    }
    free(text);
    return g != NULL ? g->text : NULL;
}

/* ---- the system ---------------------------------------------------------------------------------------------- */

long windows_sysconf(int name) {
    SYSTEM_INFO info;
    GetSystemInfo(&info);
    return name == _SC_PAGESIZE ? (long)info.dwPageSize : (long)GetActiveProcessorCount(ALL_PROCESSOR_GROUPS);
}

int uname(struct utsname *out) {
    SYSTEM_INFO info;
    GetNativeSystemInfo(&info);
    const bool arm = info.wProcessorArchitecture == PROCESSOR_ARCHITECTURE_ARM64;
    strcpy(out->sysname, "Windows");
    strcpy(out->machine, arm ? "aarch64" : "x86_64");
    OSVERSIONINFOW version = {.dwOSVersionInfoSize = sizeof version};
    if (!GetVersionExW(&version)) version = (OSVERSIONINFOW){0};
    snprintf(out->release, sizeof out->release, "%lu.%lu.%lu", version.dwMajorVersion, version.dwMinorVersion,
             version.dwBuildNumber);
    return 0;
}

int getrlimit(int resource, struct rlimit *out) {
    (void)resource;
    *out = (struct rlimit){(unsigned long long)_getmaxstdio(), 2048};
    return 0;
}

int setrlimit(int resource, const struct rlimit *limit) {
    (void)resource;
    return _setmaxstdio((int)limit->rlim_cur) < 0 ? -1 : 0;
}

void *mmap(void *address, size_t size, int protection, int flags, int file, long offset) {
    (void)address, (void)protection, (void)flags, (void)file, (void)offset;
    void *pages = VirtualAlloc(NULL, size, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
    return pages != NULL ? pages : MAP_FAILED;
}

int mprotect(void *address, size_t size, int protection) {
    DWORD before;
    const DWORD now = protection == PROT_NONE          ? PAGE_NOACCESS
                      : (protection & PROT_WRITE) != 0 ? PAGE_READWRITE
                                                       : PAGE_READONLY;
    return VirtualProtect(address, size, now, &before) ? 0 : wide_failure();
}

int munmap(void *address, size_t size) {
    (void)size;
    return VirtualFree(address, 0, MEM_RELEASE) ? 0 : wide_failure();
}

/* ---- standard files of bytes, and a console that shows UTF-8 ------------------------------------------- */

static void ignore_parameter(const wchar_t *expression, const wchar_t *function, const wchar_t *file,
                             unsigned line, uintptr_t reserved) {
    (void)expression, (void)function, (void)file, (void)line, (void)reserved;
}

static void show_sequences(HANDLE console) {
    DWORD mode;
    if (GetConsoleMode(console, &mode)) SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

unsigned console_begin(void) {
    _set_invalid_parameter_handler(ignore_parameter);
    for (int file = 0; file <= 2; file++) _setmode(file, O_BINARY);
    show_sequences(GetStdHandle(STD_ERROR_HANDLE));
    const unsigned page = GetConsoleOutputCP();
    SetConsoleOutputCP(CP_UTF8);
    return page;
}

void console_end(unsigned page) {
    SetConsoleOutputCP(page);
}
