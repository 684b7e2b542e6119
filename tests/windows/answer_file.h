/* Elementary queries with their answers, as a Linux run writes them and a Windows run reads them: bytes of x86-64. */
#pragma once

#include "tests/support/ccd/elementary_cases.h"

#include <stdbool.h>
#include <stdint.h>

/* The exact answer, by the algebraic oracle, and what the product said, to the bit. */
typedef struct recorded_answer {
    uint64_t kind;
    elementary_query query;
    uint64_t exactly_touching, touching;
    double toi_low, toi_high; /* of the exact answer, when it touches */
    elementary_contact hit;   /* of the product; zeros where nothing touches */
} recorded_answer;

#define ANSWER_FILE_TITLE "cscd answers 1\n"
