/* Long arrays of a summary become columns of the page where all their rows are alike, and stay as they are where not. */
#include "src/tool/report/json_table.h"
#include "tests/support/io_allocations.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An object with an array of so many rows, `odd` being one of another form in their midst; to be freed. */
static char *make_text(const char *name, int rows, const char *odd) {
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    fprintf(file, "{\"first\": [1, {\"a\": \"},]\\\"\"}], \"%s\": [", name);
    for (int i = 0; i < rows; i++) {
        if (i > 0) fputs(", ", file);
        if (odd != NULL && i == rows / 2)
            fputs(odd, file);
        else
            fprintf(file, "{\"frame\": %d, \"toi\": %s, \"ms\": {\"all\": %g}, \"state\": \"%s\"}", i,
                    i % 3 == 0 ? "null" : "0.5", 0.1 * i, i % 2 == 0 ? "a\\\\" : "b");
    }
    fputs("], \"last\": {\"x\": 1}}", file);
    assert_int_equal(fclose(file), 0);
    return text;
}

/* The text that results; NULL: nothing was moved. */
static char *move_text(const char *text, page_arrays *arrays) {
    char *moved = NULL;
    *arrays = (page_arrays){.count = 0};
    assert_true(json_table_move(text, "s", arrays, &moved));
    return moved;
}

static void expect_moved(const char *name, int rows, const char *odd, bool expected) {
    page_arrays arrays;
    char *text = make_text(name, rows, odd), *moved = move_text(text, &arrays);
    if ((moved != NULL) != expected)
        fail_msg("%d rows of %s, %s: %s", rows, name, odd != NULL ? odd : "all alike",
                 moved != NULL ? "moved" : "not moved");
    assert_int_equal(arrays.count, expected ? 4 : 0);
    page_arrays_free(&arrays);
    free(moved);
    free(text);
}

TEST(rows_that_are_alike_are_moved) {
    page_arrays arrays;
    char *text = make_text("intervals", JSON_TABLE_ROWS_LEAST, NULL), *moved = move_text(text, &arrays);
    assert_string_equal(
        moved,
        "{\"first\": [1, {\"a\": \"},]\\\"\"}], \"intervals\": {\"count\":1000,\"columns\":["
        "{\"path\":[\"frame\"],\"array\":{\"name\":\"s-intervals-0\",\"type\":\"u32\",\"count\":1000}},"
        "{\"path\":[\"toi\"],\"array\":{\"name\":\"s-intervals-1\",\"type\":\"f64\",\"count\":1000}},"
        "{\"path\":[\"ms\",\"all\"],\"array\":{\"name\":\"s-intervals-2\",\"type\":\"f64\",\"count\":1000}},"
        "{\"path\":[\"state\"],\"array\":{\"name\":\"s-intervals-3\",\"type\":\"u32\",\"count\":1000},"
        "\"texts\":[\"a\\\\\",\"b\"]}]}, \"last\": {\"x\": 1}}");
    for (size_t i = 0; i < arrays.count; i++) assert_int_equal(page_array_count(&arrays.items[i]), 1000);
    page_arrays_free(&arrays);
    free(moved);
    free(text);
    expect_moved("frames", JSON_TABLE_ROWS_LEAST + 1, NULL, true);
    expect_moved("intervals", JSON_TABLE_ROWS_LEAST - 1, NULL, false);
    expect_moved("events", JSON_TABLE_ROWS_LEAST, NULL, false);
    expect_moved("in<tervals", JSON_TABLE_ROWS_LEAST, NULL, false);
}

TEST(other_rows_stay) {
    static const char *const odd[] = {
        "{}",
        "{\"frame\": 1}",
        "7",
        "[]",
        "null",
        "{\"frame\": 1, \"toi\": 2, \"ms\": {\"all\": 3}, \"state\": 4, \"more\": 5}",
        "{\"frame\": 1, \"toi\": 2, \"ms\": 3, \"state\": 4}",
        "{\"frame\": 1, \"toi\": 2, \"all\": 3, \"state\": 4}",
        "{\"toi\": 1, \"frame\": 2, \"ms\": {\"all\": 3}, \"state\": 4}",
        "{\"frame\": 1, \"toi\": 2, \"ms\": {\"all\": {\"deep\": {\"deeper\": 3}}}, \"state\": 4}"};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
        expect_moved("intervals", JSON_TABLE_ROWS_LEAST, odd[i], false);
}

/* What is cut anywhere, or is no JSON, is copied or left alone, and nothing is read beyond its end. */
TEST(damaged_text_is_survived) {
    char *text = make_text("intervals", JSON_TABLE_ROWS_LEAST, NULL);
    const size_t size = strlen(text);
    for (size_t length = 0; length < size; length += length < 80 || length + 80 > size ? 1 : 997) {
        page_arrays arrays;
        char *cut = malloc(length + 1);
        assert_non_null(cut);
        memcpy(cut, text, length);
        cut[length] = '\0';
        free(move_text(cut, &arrays));
        page_arrays_free(&arrays);
        free(cut);
    }
    free(text);
}

/* ---- memory ---------------------------------------------------------------------------------------------- */

TEST(memory_may_run_out) {
    char *text = make_text("intervals", JSON_TABLE_ROWS_LEAST, NULL), *moved = NULL;
    bool made = false;
    size_t refused = 0;
    for (; io_allocations_go_on((long)refused); refused++) {
        page_arrays arrays = {.count = 0};
        free(moved);
        moved = NULL;
        made = json_table_move(text, "s", &arrays, &moved);
        io_allocations_left = -1;
        if (!made) assert_null(moved);
        page_arrays_free(&arrays);
    }
    print_message("refused in %zu places\n", refused - 1);
    assert_true(refused > 10);
    assert_non_null(moved);
    free(moved);
    free(text);
}
