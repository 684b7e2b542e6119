/* Starting `cscd`, and looking whether it has ended. */
#include "tool/mpi/shard_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static volatile sig_atomic_t stop_signal; /* 0: none has come */
static pid_t child;                       /* 0: none runs */

/* Whoever starts ranks signals their processes as well, and a second signal would end cscd at once. */
static void on_signal(int number) {
    if (stop_signal == 0) stop_signal = number;
}

/* What is ignored at the start, as nohup has it with SIGHUP, stays so, here and in the shards. */
void stop_signals_catch(void) {
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    const struct sigaction catch = {.sa_handler = on_signal};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        struct sigaction before;
        if (sigaction(numbers[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(numbers[i], &catch, NULL);
    }
}

int stop_signal_seen(void) {
    return stop_signal;
}

/* mpirun ends the other ranks. */
static _Noreturn void give_up(void) {
    fputs("cscd-mpi: out of memory\n", stderr);
    exit(1);
}

static char *format_text(const char *format, ...) {
    char *text;
    va_list arguments;
    va_start(arguments, format);
    const int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    if (length < 0) give_up();
    return text;
}

static char **allocate_words(int count) {
    char **words = calloc((size_t)count + 1, sizeof *words);
    if (words == NULL) give_up();
    return words;
}

/* Its standard input is empty. */
static bool start_process(char **words, int shard, shard_report *report) {
    posix_spawn_file_actions_t actions;
    pid_t pid = 0;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    const int error = posix_spawnp(&pid, words[0], &actions, NULL, words, environ);
    posix_spawn_file_actions_destroy(&actions);
    *report = (shard_report){.shard = shard, .code = error != 0 ? 127 : 0, .error = error};
    if (error != 0) return false;
    child = pid;
    if (stop_signal != 0) kill(pid, stop_signal); /* it came before the process */
    return true;
}

static char *shard_path(const launch_options *o, int shard, int count) {
    return format_text("%s/shard-%d-of-%d.jsonl", o->results, shard, count);
}

bool shard_start(const launch_options *o, int shard, int count, shard_report *report) {
    char **words = allocate_words(o->passed_count + 10);
    char *part = format_text("%d/%d", shard, count), *path = shard_path(o, shard, count);
    int n = 0;
    words[n++] = (char *)o->program;
    words[n++] = (char *)o->command;
    for (int i = 0; i < o->passed_count; i++) words[n++] = o->passed[i];
    words[n++] = "--shard";
    words[n++] = part;
    words[n++] = "--results";
    words[n++] = path;
    words[n++] = (char *)o->resume;
    words[n++] = "--quiet";
    if (!o->threads) {
        words[n++] = "--threads";
        words[n++] = "1";
    }
    const bool started = start_process(words, shard, report);
    free(words);
    free(part);
    free(path);
    return started;
}

bool merge_start(const launch_options *o, int count, shard_report *report) {
    char **words = allocate_words(count + 5);
    char *output = format_text("%s/all.jsonl", o->results);
    int n = 0;
    words[n++] = (char *)o->program;
    words[n++] = "merge";
    for (int shard = 1; shard <= count; shard++) words[n++] = shard_path(o, shard, count);
    words[n++] = "-o";
    words[n++] = output;
    if (o->quiet) words[n++] = "--quiet";
    const bool started = start_process(words, 0, report);
    for (int shard = 1; shard <= count; shard++) free(words[shard + 1]);
    free(output);
    free(words);
    return started;
}

bool process_runs(void) {
    return child != 0;
}

bool process_ended(shard_report *report) {
    int status;
    if (waitpid(child, &status, WNOHANG) != child) return false;
    child = 0;
    report->code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    report->signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    return true;
}
