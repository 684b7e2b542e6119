/* The exact families of the query generator: small integers and quarters. */
#pragma once

#include "tests/support/ccd/elementary_generator.h"

/* Both ends included. */
int stream_integer(random_stream *random, int lowest, int highest);

/* A query of the family, which comes before FAMILY_NUDGED. */
elementary_query exact_query(random_stream *random, cscd_contact_kind kind, query_family family);
