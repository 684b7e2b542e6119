/* Which words are for cscd-mpi, and which are for cscd. */
#include "tool/mpi/launch_options.h"

#include <stdlib.h>
#include <string.h>

const char launch_help[] =
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

/* The value of --NAME VALUE or --NAME=VALUE at *i, which moves to the last word of it; NULL: it is another option. "": it lacks one. */
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

const char *launch_options_read(int word_count, char **words, launch_options *o) {
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
