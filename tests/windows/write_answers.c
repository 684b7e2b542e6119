/* Writes random queries of every degeneracy, their exact answers and ours: write_answers FILE COUNT. It needs FLINT and Arb, which
 * Windows has not; there compare_answers asks the same. */
#include "tests/support/ccd/algebraic_oracle.h"
#include "tests/support/ccd/elementary_generator.h"
#include "tests/windows/answer_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool write_answers(FILE *file, cscd_contact_kind kind, size_t count) {
    random_stream random = stream_start(71 + (uint64_t)kind);
    elementary_query *queries = calloc(count, sizeof *queries);
    query_answer *answers = calloc(count, sizeof *answers);
    bool good = queries != NULL && answers != NULL;
    for (size_t i = 0; good && i < count; i++)
        queries[i] = generate_query(&random, kind, (query_family)(i % FAMILY_COUNT));
    if (good) pair_test_all(kind, queries, count, answers);
    for (size_t i = 0; good && i < count; i++) {
        const oracle_verdict exact = algebraic_oracle(kind, &queries[i]);
        recorded_answer record;
        memset(&record, 0, sizeof record);
        record.kind = kind;
        record.query = queries[i];
        record.exactly_touching = exact.touching;
        record.touching = answers[i].touching;
        record.toi_low = exact.touching ? exact.toi_low : 0.0;
        record.toi_high = exact.touching ? exact.toi_high : 0.0;
        record.hit = answers[i].hit;
        good = fwrite(&record, sizeof record, 1, file) == 1;
    }
    free(queries);
    free(answers);
    return good;
}

int main(int argument_count, char **arguments) {
    const size_t count = argument_count == 3 ? strtoul(arguments[2], NULL, 10) : 0;
    FILE *file = count > 0 ? fopen(arguments[1], "wb") : NULL;
    if (file == NULL) {
        fputs("usage: write_answers FILE COUNT: the file, and how many queries of each kind\n", stderr);
        return 2;
    }
    const bool written = fputs(ANSWER_FILE_TITLE, file) >= 0 && write_answers(file, CSCD_CONTACT_VF, count) &&
                         write_answers(file, CSCD_CONTACT_EE, count);
    algebraic_oracle_finish();
    if (fclose(file) == 0 && written) return 0;
    fprintf(stderr, "write_answers: cannot write %s\n", arguments[1]);
    return 1;
}
