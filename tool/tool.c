/* Finds the command of the tool and runs it. */
#include "tool/tool.h"

#include "cscd/cscd.h"
#include "tool/common/command.h"
#include "tool/common/provenance.h"
#include "tool/common/terminal.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

typedef struct command {
    const char *name, *summary;
    int (*run)(int argument_count, char **arguments);
} command;

static const command commands[] = {
    {"preprocess", "cut a closed mesh into regions, once, so that replays are faster", command_preprocess},
    {"replay", "find every contact between the frames of a recording, and what check finds", command_replay},
    {"report", "compare runs of replay, or list many jobs, on one page for a browser", command_report},
#ifdef WITH_SENSORS
    {"sense", "warn where objects come near each other; can miss contacts", command_sense},
#endif
    {"check", "find which parts cross or touch in which frames, and how deep", command_check},
    {"untangle", "move vertices until no parts cross or touch", command_untangle},
    {"merge", "bring the results of the shards of a list together", command_merge},
    {"info", "counts, components, holes, bounds of a mesh", command_info},
    {"render", "draw frames to a PNG", command_render},
};

enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static void print_help(void) {
    printf("cscd - find where the surfaces of meshes and animations go through each other\n\n"
           "usage: cscd COMMAND ...\n\n");
    for (int i = 0; i < COMMAND_COUNT; i++) printf("  %-11s %s\n", commands[i].name, commands[i].summary);
    printf(
        "\ncscd COMMAND --help says more; cscd --version.\n"
        "exit: 0 ran, 1 bad input, 2 wrong usage, 3 found what --fail-on asks for, or not untangled, 4 not all jobs have run, 129, 130, 143 interrupted\n");
}

/* NULL: there is none of that name. */
static const command *find_command(const char *name) {
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(name, commands[i].name) == 0) return &commands[i];
    return NULL;
}

/* `cscd help replay` is `cscd replay --help`. */
static int help_on(char *name) {
    char help[] = "--help";
    const command *asked = find_command(name);
    if (asked == NULL) return fail_usage("", "unknown command '%s'", name);
    return asked->run(2, (char *[]){name, help, NULL});
}

static int run_command(int argument_count, char **arguments) {
    if (argument_count < 2) return fail_usage("", "no command given");
    const char *name = arguments[1];
    if (strcmp(name, "help") == 0 && argument_count > 2) return help_on(arguments[2]);
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0) {
        print_help();
        return EXIT_RAN;
    }
    if (strcmp(name, "--version") == 0) {
        printf("cscd %s (%s)\n", cscd_version_string(), provenance_commit());
        return EXIT_RAN;
    }
    const command *asked = find_command(name);
    return asked != NULL ? asked->run(argument_count - 1, arguments + 1)
                         : fail_usage("", "unknown command '%s'", name);
}

int tool_run(int argument_count, char **arguments) {
    /* A closed pipe and a file that may not grow (ulimit -f) are then write errors like any other, so that
     * files still get finished. */
    signal(SIGPIPE, SIG_IGN);
#ifdef SIGXFSZ /* Windows has none */
    signal(SIGXFSZ, SIG_IGN);
#endif
    int code = run_command(argument_count, arguments);
    /* A file that an interrupt has kept from being opened is no bad input. */
    if ((code == EXIT_BAD_INPUT || code == EXIT_UNDONE) && interrupt_ended_wait())
        code = interrupt_exit_code();
    if ((fflush(stdout) != 0 || ferror(stdout)) && code != EXIT_BAD_INPUT) {
        const int failed = fail_input("standard output: cannot write: %s", io_write_reason());
        code = code < EXIT_INTERRUPTED ? failed : code; /* the reader of a pipe hears the same signal */
    }
    return code;
}
