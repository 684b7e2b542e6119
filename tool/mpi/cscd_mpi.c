/* cscd-mpi: the shards of a list on the ranks of an MPI job. Rank 0 hands them out one by one and works as well; a shard is a
 * process of `cscd`, and so is the merge at the end. */
#include "tool/mpi/shard_process.h"

#include <mpi.h>

#include <dirent.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum {
    SHARDS_PER_RANK = 8,
    NAP_NS = 2000000, /* between two looks; MPI itself would wait on a busy processor */
    TAG_REPORT = 1,
    TAG_SHARD = 2,
    REPORT_INTS = sizeof(shard_report) / sizeof(int)
};

/* What rank 0 knows. */
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

/* How many shards the folder has results of, as the names of the files say. 0: none; -1: of different numbers. */
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
    if (merge_start(o, count, &report))
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
        } else if (!shard_start(o, shard, board.count, &own)) {
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
        if (shard_start(o, shard[0], shard[1], &report))
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
    const char *wrong = launch_options_read(word_count, words, &o);
    if (o.help || wrong != NULL) {
        if (rank == 0 && o.help) fputs(launch_help, stdout);
        if (rank == 0 && wrong != NULL) say_line("%s", wrong);
        code = wrong != NULL ? 2 : 0;
    } else {
        stop_signals_catch();
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
