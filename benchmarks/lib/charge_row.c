/* The members that the rows of all tables of charges have in common in JSON. */
#include "benchmarks/lib/charge_tables.h"

bool charge_row_begin(json *out, const char *table, const char *name, uint32_t triangles,
                      cscd_charge_solver solver) {
    if (out->file == NULL) return false;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "table", table);
    json_string(out, "body", name);
    json_integer(out, "triangles", triangles);
    json_string(out, "solver", charge_solver_name(solver));
    return true;
}

void charge_row_end(json *out, const charge_trial *t) {
    json_integer(out, "iterations", t->iterations);
    json_number(out, "total_ms", t->total_ms);
    json_number(out, "peak_bytes", t->peak_bytes);
    json_end_object(out);
}
