/* Texts as strangers write them: Visual C's words for what is no number, decimal commas, marks of UTF-8, UTF-16, names with
 * blanks and #, in every text format. */
#include "src/io/text_encoding.h"
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <string.h>

/* A square in each format, in which one word stands for the 1 of vertex 1's x. */
typedef struct text_format {
    const char *name, *before, *behind;
    const char *place;  /* of the word */
    const char *vertex; /* what a message calls it */
} text_format;

static const text_format formats[] = {
    {"mesh.obj", "v 0 0 0\nv ", " 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", ":2: ", "x of vertex 2"},
    {"mesh.off", "OFF\n4 1 0\n0 0 0\n", " 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", ":4: ", "x of vertex 1"},
    {"mesh.ply",
     "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
     "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n",
     " 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", ":11: ", "x of vertex 1"},
    {"mesh.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex ",
     " 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n", ":5: ", "x of vertex 1"},
};

enum { FORMATS = sizeof formats / sizeof *formats };

static file_bytes text_with(const text_format *format, const char *word, char text[1024]) {
    const int length = snprintf(text, 1024, "%s%s%s", format->before, word, format->behind);
    assert_in_range(length, 1, 1023);
    return (file_bytes){format->name, text, (size_t)length};
}

TEST(words_for_no_number_are_refused) {
    static const char *const words[] = {"1.#QNAN", "-1.#IND", "1.#INF",  "-1.#INF00",    "1.#SNAN",
                                        "1.#R",    "-1.#J",   "+1.#INF", "-1.#IND000000"};
    char text[1024];
    for (int f = 0; f < FORMATS; f++) {
        mesh_check_square(text_with(&formats[f], "1.0", text));
        for (size_t i = 0; i < sizeof words / sizeof *words; i++)
            mesh_check_error(text_with(&formats[f], words[i], text), formats[f].place, formats[f].vertex,
                             strstr(words[i], "INF") != NULL ? "inf, expected a finite number"
                                                             : "nan, expected a finite number");
    }
}

/* A # within a word is of the word, so that such a word is no number. */
TEST(words_with_a_hash_are_no_numbers) {
    static const char *const words[] = {"1#",     "1.#",    "1.#1",     "1.#inf", "1.#INF1",
                                        "2.#INF", "1#QNAN", "1.#QNAN.", "1.#-"};
    char text[1024], found[64];
    for (int f = 0; f < FORMATS; f++)
        for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
            snprintf(found, sizeof found, "found '%s'", words[i]);
            mesh_check_error(text_with(&formats[f], words[i], text), formats[f].place, found, "expected");
        }
    mesh_check_square(text_with(&formats[0], "1 0 0 # 2", text));
    mesh_check_square(text_with(&formats[1], "1 0 0 #2", text));
}

TEST(decimal_commas_are_told) {
    static const char advice[] = "this is a decimal comma: write numbers with a decimal point";
    char text[1024];
    for (int f = 0; f < FORMATS; f++) {
        mesh_check_error(text_with(&formats[f], "1,0", text), formats[f].place, "found '1,0'", advice);
        mesh_check_error(text_with(&formats[f], "-1,25e-3", text), formats[f].place, "found '-1,25e-3'",
                         advice);
        mesh_check_error(text_with(&formats[f], ",5", text), formats[f].place, "found ',5'", advice);
    }
}

/* Numbers between commas are none with a comma in it. */
TEST(other_commas_are_not) {
    static const char *const words[] = {"1,0,0", "1,", ",", "a,5", "1,-5", "1,x"};
    io_error error;
    mesh_file mesh;
    char text[1024];
    for (int f = 0; f < FORMATS; f++)
        for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
            assert_false(mesh_check_read(text_with(&formats[f], words[i], text), &mesh, &error));
            assert_null(strstr(error.text, "decimal"));
        }
}

/* Each character as two bytes, behind a mark or not. */
static size_t widen_text(const char *narrow, size_t size, bool big, bool marked, char *wide) {
    size_t at = 0;
    if (marked) {
        memcpy(wide, big ? "\xfe\xff" : "\xff\xfe", 2);
        at = 2;
    }
    for (size_t i = 0; i < size; i++) {
        wide[at++] = big ? '\0' : narrow[i];
        wide[at++] = big ? narrow[i] : '\0';
    }
    return at;
}

TEST(wide_texts_are_told) {
    char text[1024], wide[2050];
    for (int f = 0; f < FORMATS; f++)
        for (int way = 0; way < 4; way++) {
            const file_bytes narrow = text_with(&formats[f], "1", text);
            const size_t size = widen_text(narrow.bytes, narrow.size, way & 1, way & 2, wide);
            mesh_check_error((file_bytes){narrow.name, wide, size}, ": ", "this is text in UTF-16",
                             "save it as UTF-8");
        }
}

TEST(marks_of_utf8_are_passed) {
    char text[1024], marked[1027] = "\xef\xbb\xbf";
    for (int f = 0; f < FORMATS; f++) {
        const file_bytes plain = text_with(&formats[f], "1", text);
        memcpy(marked + 3, plain.bytes, plain.size);
        mesh_check_square((file_bytes){plain.name, marked, plain.size + 3});
    }
    assert_int_equal(text_mark_size("\xef\xbb", 2), 0);
    assert_false(text_is_utf16("\xff\xfe", 2));
    assert_false(text_is_utf16("\xff\xfe\0\0\0\0\0\0\0\0", 10));
}

TEST(names_keep_blanks_and_hashes) {
    static const char text[] =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no  Left Arm \t\nf 1 2 3\no Part#1\r\nf 1 3 4\n"
        "g Sleeve # 2 of 3\nf 1 2 3\ng # 4\nf 1 3 4\no a\\\nb\nf 1 2 4\no\nf 2 3 4\n";
    static const char *const names[] = {"Left Arm",   "Part#1", "Part#1/Sleeve # 2 of 3",
                                        "Part#1/# 4", "a",      NULL};
    static const uint32_t labels[] = {0, 1, 2, 3, 4, NO_MESH_PART};
    mesh_check_parts(FILE_OF("mesh.obj", text), names, labels);
}
