/* A line on the terminal that shows how far a long command is, and signals that interrupt it. */
#include "tool/common/terminal.h"

#include "tool/io/io.h"

#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { REDRAW_MS = 100, BAR_WIDTH = 30, LONG_CALL_MS = 1000, PERCENT = 100 };

static double now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

bool terminal_outputs_are_one(void) {
    struct stat out, error;
    if (isatty(STDOUT_FILENO) && isatty(STDERR_FILENO)) return true;
    return fstat(STDOUT_FILENO, &out) == 0 && fstat(STDERR_FILENO, &error) == 0 &&
           out.st_dev == error.st_dev && out.st_ino == error.st_ino;
}

void terminal_progress_begin(terminal_progress *p, bool quiet) {
    *p = (terminal_progress){.shown = !quiet && isatty(STDERR_FILENO) != 0};
}

/* stage: of a call that takes long, and NULL otherwise. */
static void draw_line(terminal_progress *p, const char *stage, double fraction) {
    p->last_ms = now_ms();
    char bar[BAR_WIDTH + 1];
    uint32_t filled = p->total > 0 ? (uint32_t)((uint64_t)p->done * BAR_WIDTH / p->total) : 0;
    for (uint32_t i = 0; i < BAR_WIDTH; i++) bar[i] = i < filled ? '#' : '.';
    bar[BAR_WIDTH] = '\0';
    fprintf(stderr, "\r%s %s %u/%u", p->what, bar, p->done, p->total);
    if (stage != NULL) fprintf(stderr, ", %s %d %%", stage, (int)(fraction * PERCENT));
    fputs("\033[K", stderr);
    fflush(stderr);
}

void terminal_progress_update(terminal_progress *p, uint32_t done, uint32_t total, const char *what) {
    if (!p->shown) return;
    p->done = done;
    p->total = total;
    p->what = what;
    p->begun_ms = now_ms();
    if (done == total || p->begun_ms - p->last_ms >= REDRAW_MS) draw_line(p, NULL, 0.0);
}

bool terminal_progress_within(void *line, const char *stage, double fraction) {
    terminal_progress *p = line;
    if (p->shown && p->what != NULL) {
        const double now = now_ms();
        if (now - p->begun_ms >= LONG_CALL_MS && now - p->last_ms >= REDRAW_MS) draw_line(p, stage, fraction);
    }
    return !(p->may_stop && interrupt_ends_wait());
}

void terminal_progress_say(terminal_progress *p, const char *text) {
    if (!p->shown) return;
    fprintf(stderr, "\r%s ...\033[K", text);
    fflush(stderr);
}

void terminal_progress_end(terminal_progress *p) {
    if (p->shown) fputs("\r\033[K", stderr);
    p->shown = false;
}

/* Any thread may get the signal, and all may ask. The number of the first signal; 0: none has come. */
static atomic_int interrupt_signal;
static atomic_bool wait_ended; /* by it; in whatever thread */

static void note_interrupt(int signal_number) {
    int none = 0;
    atomic_compare_exchange_strong(&interrupt_signal, &none, signal_number);
}

/* Whoever starts the program with the signal ignored wants it to go on. */
static void catch_signal(int signal_number, const struct sigaction *action) {
    struct sigaction before;
    if (sigaction(signal_number, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
        sigaction(signal_number, action, NULL);
}

/* A second signal ends the process at once. */
static bool second_ends = true;

void interrupt_catch(void) {
    const unsigned flags = SA_RESTART | (second_ends ? SA_RESETHAND : 0);
    struct sigaction action = {.sa_handler = note_interrupt, .sa_flags = (int)flags};
    sigemptyset(&action.sa_mask);
    catch_signal(SIGINT, &action);
    catch_signal(SIGTERM, &action);
    catch_signal(SIGHUP, &action);
    pipe_file_ask(interrupt_ends_wait);
}

void interrupt_outlast(void) {
    second_ends = false;
    interrupt_catch();
}

bool interrupted(void) {
    return atomic_load(&interrupt_signal) != 0;
}

bool interrupt_ends_wait(void) {
    if (!interrupted()) return false;
    atomic_store(&wait_ended, true);
    return true;
}

bool interrupt_ended_wait(void) {
    return atomic_load(&wait_ended);
}

int interrupt_exit_code(void) {
    return 128 + atomic_load(&interrupt_signal);
}

void interrupt_tell(const interrupt_kept *kept) {
    fflush(stdout);
    fprintf(stderr, "cscd: interrupted after %u of %u %s", kept->done, kept->whole, kept->what);
    if (kept->done > 0) fprintf(stderr, " (frames %d to %d)", kept->first, kept->last);
    const char *before = "; what was found is kept in ";
    for (size_t i = 0; i < kept->path_count; i++) {
        if (kept->paths[i] == NULL) continue;
        bool standard = strcmp(kept->paths[i], "-") == 0;
        fprintf(stderr, "%s%s", before, standard ? "the standard output" : kept->paths[i]);
        before = ", ";
    }
    fputc('\n', stderr);
}
