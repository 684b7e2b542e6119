/* cscd-mpi: the shards of a list on the ranks of an MPI job. Rank 0 hands them out one by one and works as
 * well; a shard is a process of `cscd`, and so is the merge at the end. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <mpi.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* ---- the command line ---------------------------------------------------------------------------------- */

enum { SHARDS_MAX = 10000 }; /* their results fit on a command line */

typedef struct launch_options {
    const char *command, *results, *program; /* NULL: not given */
    int shards;                              /* 0: not given */
    bool threads, quiet, help;
    const char *resume;
    char **passed; /* for cscd */
    int passed_count;
} launch_options;

static const char launch_help[] =
    "usage: mpirun [...] cscd-mpi check|replay --list JOBS.jsonl --results FOLDER [--shards N] [--program CSCD] [OPTION...]\n"
    "\n"
    "Runs a list of jobs in shards, which the ranks take one after the other, and merges their results into FOLDER/all.jsonl.\n"
    "All nodes see the list, its files and FOLDER. Shards that FOLDER has already go on where they were.\n"
    "\n"
    "  --results FOLDER  for the results; it is made if need be\n"
    "  --shards N        parts of the list; default: as many as FOLDER has already, else 8 per rank\n"
    "  --program CSCD    the program; default: cscd\n"
    "  OPTION...         what else cscd check or replay takes; --threads is that of one shard, 1 by default\n"
    "\n"
    "The exit code is that of `cscd merge`, that is, of one run of the whole list.\n";

/* The value of --NAME VALUE or --NAME=VALUE at *i, which moves to the last word of it; NULL: it is another
 * option. "": it lacks one. */
static const char *read_value(int word_count, char **words, int *i, const char *name) {
    const size_t length = strlen(name);
    const char *word = words[*i];
    if (strncmp(word, name, length) != 0) return NULL;
    if (word[length] == '=') return word + length + 1;
    if (word[length] != '\0') return NULL;
    return *i + 1 < word_count ? words[++*i] : "";
}

static bool read_shards(const char *text, int *shards) {
    char *end;
    const long value = strtol(text, &end, 10);
    *shards = (int)value;
    return *text != '\0' && *end == '\0' && value >= 1 && value <= SHARDS_MAX;
}

/* NULL: they are right; else what is wrong. o->passed is to be freed in both cases. */
static const char *read_options(int word_count, char **words, launch_options *o) {
    const char *value;
    *o = (launch_options){
        .program = "cscd", .resume = "--resume", .passed = calloc((size_t)word_count + 1, sizeof *o->passed)};
    if (o->passed == NULL) return "out of memory";
    for (int i = 1; i < word_count; i++) {
        const char *word = words[i];
        if (strcmp(word, "--help") == 0)
            o->help = true;
        else if (o->command == NULL)
            o->command = word;
        else if ((value = read_value(word_count, words, &i, "--results")) != NULL)
            o->results = value;
        else if ((value = read_value(word_count, words, &i, "--program")) != NULL)
            o->program = value;
        else if ((value = read_value(word_count, words, &i, "--shards")) != NULL) {
            if (!read_shards(value, &o->shards)) return "--shards needs a number from 1 to 10000";
        } else if (strcmp(word, "--shard") == 0 || strncmp(word, "--shard=", 8) == 0)
            return "--shard is for the ranks; --shards says how many there are";
        else if (strcmp(word, "--resume") == 0 || strncmp(word, "--resume=", 9) == 0)
            o->resume = word;
        else if (strcmp(word, "--quiet") == 0)
            o->quiet = true;
        else {
            o->threads = o->threads || strcmp(word, "--threads") == 0 || strncmp(word, "--threads=", 10) == 0;
            o->passed[o->passed_count++] = words[i];
        }
    }
    if (o->help) return NULL;
    if (o->command == NULL || (strcmp(o->command, "check") != 0 && strcmp(o->command, "replay") != 0))
        return "the first word is check or replay; cscd-mpi --help says more";
    if (o->results == NULL || *o->results == '\0') return "--results FOLDER is missing";
    return *o->program == '\0' ? "--program needs a name" : NULL;
}

/* ---- processes of `cscd`, one at a time, a shard or the merge ------------------------------------------ */

/* The end of a shard, as ranks tell it to rank 0. */
typedef struct shard_report {
    int shard;  /* 0: there was none, the rank asks for its first one */
    int code;   /* its exit code; with `error`, 127 */
    int signal; /* that ended it; 0: none */
    int error;  /* errno: it could not be started */
} shard_report;

/* Exit codes of a shard that did not run all its jobs; any other shard would end so too. */
enum { SHARD_USAGE = 2, SHARD_UNDONE = 4 };

extern char **environ;

static volatile sig_atomic_t stop_signal; /* 0: none has come */
static pid_t child;                       /* 0: none runs */

/* Whoever starts ranks signals their processes as well, and a second signal would end cscd at once. */
static void on_signal(int number) {
    if (stop_signal == 0) stop_signal = number;
}

/* A signal that is ignored at the start, as nohup has it with SIGHUP, stays so, here and in the shards. */
static void catch_stop_signals(void) {
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    const struct sigaction catch = {.sa_handler = on_signal};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        struct sigaction before;
        if (sigaction(numbers[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(numbers[i], &catch, NULL);
    }
}

static int stop_signal_seen(void) {
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

/* Start a process; false: it could not be, as *report says. None may run. */
static bool start_shard(const launch_options *o, int shard, int count, shard_report *report) {
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

static bool start_merge(const launch_options *o, int count, shard_report *report) {
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

static bool process_runs(void) {
    return child != 0;
}

/* Whether our process has ended; how is in *report then. Never waits. */
static bool process_ended(shard_report *report) {
    int status;
    if (waitpid(child, &status, WNOHANG) != child) return false;
    child = 0;
    report->code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    report->signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    return true;
}

/* ---- ranks --------------------------------------------------------------------------------------------- */

enum {
    SHARDS_PER_RANK = 8,
    NAP_NS = 2000000, /* between two looks; MPI itself would wait on a busy processor */
    TAG_REPORT = 1,
    TAG_SHARD = 2,
    REPORT_INTS = sizeof(shard_report) / sizeof(int)
};

/* The knowledge of rank 0. */
typedef struct shard_board {
    int next, count;
    int dismissed; /* ranks that have been told that there is no more */
    int refusal; /* the exit code of a shard that could not even begin, so that no other is started; 0: none */
} shard_board;

static void say_line(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fputs("cscd-mpi: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

/* After a signal, once our process has closed its files. */
static void leave_if_stopped(void) {
    if (stop_signal_seen() != 0 && !process_runs()) MPI_Abort(MPI_COMM_WORLD, 128 + stop_signal_seen());
}

static void take_nap(void) {
    leave_if_stopped();
    nanosleep(&(struct timespec){.tv_nsec = NAP_NS}, NULL);
}

/* ---- rank 0 -------------------------------------------------------------------------------------------- */

/* The number of shards of which the folder has results, as the names of the files say. 0: none; -1: of
 * different numbers. */
static int shards_in_folder(const char *results) {
    DIR *folder = opendir(results);
    int found = 0;
    if (folder == NULL) return 0;
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        int shard, count, length = 0;
        if (sscanf(entry->d_name, "shard-%d-of-%d.jsonl%n", &shard, &count, &length) != 2 || length == 0)
            continue;
        if (entry->d_name[length] != '\0' || count < 1 || count > SHARDS_MAX) continue;
        found = found == 0 || found == count ? count : -1;
        if (found < 0) break;
    }
    closedir(folder);
    return found;
}

/* 0: it has said why not. */
static int choose_shards(const launch_options *o, int ranks) {
    if (mkdir(o->results, 0777) != 0 && errno != EEXIST) {
        say_line("%s: cannot be made: %s", o->results, strerror(errno));
        return 0;
    }
    if (o->shards > 0) return o->shards;
    const int found = shards_in_folder(o->results);
    if (found < 0)
        say_line("%s has results of different numbers of shards: say which by --shards", o->results);
    if (found != 0) return found > 0 ? found : 0;
    return ranks < SHARDS_MAX / SHARDS_PER_RANK ? ranks * SHARDS_PER_RANK : SHARDS_MAX;
}

static void note_report(shard_board *board, const launch_options *o, const shard_report *r, int rank) {
    if (r->shard == 0) return;
    if (r->error != 0)
        say_line("rank %d: %s: %s", rank, o->program, strerror(r->error));
    else if (r->signal != 0)
        say_line("shard %d of %d, on rank %d, was ended by signal %d", r->shard, board->count, rank,
                 r->signal);
    else if (r->code != 0 && r->code != 1 && r->code != 3)
        say_line("shard %d of %d, on rank %d, ended with %d", r->shard, board->count, rank, r->code);
    if (r->error != 0 || r->code == SHARD_USAGE || r->code == SHARD_UNDONE) board->refusal = r->code;
}

/* The next shard; 0: there is none. */
static int take_shard(shard_board *board) {
    return board->refusal == 0 && board->next <= board->count ? board->next++ : 0;
}

/* Answers one rank, if one asks. */
static bool answer_rank(shard_board *board, const launch_options *o) {
    int asks;
    MPI_Status status;
    shard_report report;
    MPI_Iprobe(MPI_ANY_SOURCE, TAG_REPORT, MPI_COMM_WORLD, &asks, &status);
    if (!asks) return false;
    MPI_Recv(&report, REPORT_INTS, MPI_INT, status.MPI_SOURCE, TAG_REPORT, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    note_report(board, o, &report, status.MPI_SOURCE);
    const int shard[2] = {take_shard(board), board->count};
    MPI_Send(shard, 2, MPI_INT, status.MPI_SOURCE, TAG_SHARD, MPI_COMM_WORLD);
    board->dismissed += shard[0] == 0;
    return true;
}

static int merge_shards(const launch_options *o, int count) {
    shard_report report;
    if (start_merge(o, count, &report))
        while (!process_ended(&report)) take_nap();
    leave_if_stopped();
    if (report.error != 0) say_line("%s: %s", o->program, strerror(report.error));
    if (report.signal != 0) say_line("the merge was ended by signal %d", report.signal);
    return report.signal != 0 ? 128 + report.signal : report.code;
}

static int lead_ranks(const launch_options *o, int ranks) {
    shard_board board = {.next = 1, .count = choose_shards(o, ranks)};
    shard_report own = {.shard = 0};
    if (board.count == 0) board.refusal = 1;
    for (bool working = true; working || board.dismissed < ranks - 1;) {
        while (answer_rank(&board, o)) {
        }
        if (process_runs()) {
            if (!process_ended(&own)) {
                take_nap();
                continue;
            }
            note_report(&board, o, &own, 0);
            leave_if_stopped();
        }
        const int shard = working ? take_shard(&board) : 0;
        if (shard == 0) {
            working = false;
            take_nap();
        } else if (!start_shard(o, shard, board.count, &own)) {
            note_report(&board, o, &own, 0);
        }
    }
    return board.refusal != 0 ? board.refusal : merge_shards(o, board.count);
}

/* ---- the other ranks ----------------------------------------------------------------------------------- */

static void wait_for(MPI_Request *request) {
    for (int done = 0;;) {
        MPI_Test(request, &done, MPI_STATUS_IGNORE);
        if (done) return;
        take_nap();
    }
}

static void follow_rank_0(const launch_options *o) {
    shard_report report = {.shard = 0};
    for (;;) {
        int shard[2];
        MPI_Request request;
        MPI_Irecv(shard, 2, MPI_INT, 0, TAG_SHARD, MPI_COMM_WORLD, &request);
        MPI_Send(&report, REPORT_INTS, MPI_INT, 0, TAG_REPORT, MPI_COMM_WORLD);
        wait_for(&request);
        if (shard[0] == 0) return;
        if (start_shard(o, shard[0], shard[1], &report))
            while (!process_ended(&report)) take_nap();
        leave_if_stopped();
    }
}

/* ---- all ------------------------------------------------------------------------------------------------ */

int main(int word_count, char **words) {
    launch_options o;
    int rank, ranks, code = 0;
    MPI_Init(&word_count, &words);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    const char *wrong = read_options(word_count, words, &o);
    if (o.help || wrong != NULL) {
        if (rank == 0 && o.help) fputs(launch_help, stdout);
        if (rank == 0 && wrong != NULL) say_line("%s", wrong);
        code = wrong != NULL ? 2 : 0;
    } else {
        catch_stop_signals();
        if (rank == 0)
            code = lead_ranks(&o, ranks);
        else
            follow_rank_0(&o);
    }
    /* All wait for the merge: a rank that ends with something else than 0 lets mpirun stop the others. */
    MPI_Request together;
    MPI_Ibarrier(MPI_COMM_WORLD, &together);
    wait_for(&together);
    free(o.passed);
    MPI_Finalize();
    return code;
}
