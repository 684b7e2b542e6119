/* Reads the tool's contact files back, strictly: CSV and JSON Lines. */
#include "tests/support/tool/contact_rows.h"
#include "tests/support/test.h"

#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { FIELDS = 16 };

static const char header[] = "frame,kind,toi,a0,a1,b0,b1,b2,u,v,x,y,z,nx,ny,nz";

static void add_row(contact_rows *rows, const contact_record *record) {
    contact_record *grown = realloc(rows->items, (rows->count + 1) * sizeof *grown);
    assert_non_null(grown);
    rows->items = grown;
    rows->items[rows->count++] = *record;
}

/* Splits at commas, in place. The test fails unless there are as many fields as the header has. */
static void split_line(char *line, char *fields[FIELDS]) {
    int count = 0;
    for (char *at = line; at != NULL; count++) {
        assert_true(count < FIELDS);
        fields[count] = at;
        at = strchr(at, ',');
        if (at != NULL) *at++ = '\0';
    }
    assert_int_equal(count, FIELDS);
}

static double number_of(const char *field) {
    char *end = NULL;
    assert_true(*field != '\0');
    double value = strtod(field, &end);
    assert_int_equal(*end, '\0');
    return value;
}

static uint32_t index_of(const char *field) {
    assert_true(*field != '\0' && strspn(field, "0123456789") == strlen(field));
    return (uint32_t)strtoul(field, NULL, 10);
}

static cscd_contact_kind kind_of(const char *name) {
    bool vf = strcmp(name, "vf") == 0;
    assert_true(vf || strcmp(name, "ee") == 0);
    return vf ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
}

static contact_record row_of(char *fields[FIELDS]) {
    contact_record r = {
        .frame = (int32_t)index_of(fields[0]), .kind = kind_of(fields[1]), .toi = number_of(fields[2])};
    bool vf = r.kind == CSCD_CONTACT_VF;
    r.a[0] = index_of(fields[3]);
    assert_true(!vf || *fields[4] == '\0'); /* a1 of a vertex and b2 of an edge are empty */
    assert_true(vf || *fields[7] == '\0');
    if (!vf) r.a[1] = index_of(fields[4]);
    for (int i = 0; i < (vf ? 3 : 2); i++) r.b[i] = index_of(fields[5 + i]);
    r.u = number_of(fields[8]);
    r.v = number_of(fields[9]);
    for (int k = 0; k < 3; k++) r.point[k] = number_of(fields[10 + k]);
    for (int k = 0; k < 3; k++) r.normal[k] = number_of(fields[13 + k]);
    return r;
}

/* Returns the next whole line without its end, or NULL at the end of the text. */
static char *next_line(char **text) {
    char *line = *text, *end = strchr(line, '\n');
    if (*line == '\0') return NULL;
    assert_non_null(end); /* every line must be whole */
    *end = '\0';
    *text = end + 1;
    return line;
}

contact_rows contact_rows_read_csv(const char *path) {
    contact_rows rows = {0};
    char *text = read_whole_file(path, NULL), *rest = text, *fields[FIELDS];
    char *line = next_line(&rest);
    assert_non_null(line);
    assert_string_equal(line, header);
    while ((line = next_line(&rest)) != NULL) {
        split_line(line, fields);
        contact_record row = row_of(fields);
        add_row(&rows, &row);
    }
    free(text);
    return rows;
}

static void read_indices(const json_node *line, const char *key, size_t count, uint32_t *out) {
    const json_node *list = json_node_member(line, key);
    assert_int_equal(list->count, count);
    for (size_t i = 0; i < count; i++) out[i] = (uint32_t)json_node_item(list, i)->number;
}

static void read_vector(const json_node *line, const char *key, double out[3]) {
    const json_node *list = json_node_member(line, key);
    assert_int_equal(list->count, 3);
    for (size_t k = 0; k < 3; k++) out[k] = json_node_item(list, k)->number;
}

static contact_record line_of(const json_node *line) {
    contact_record r = {.frame = (int32_t)json_node_number(line, "frame"),
                        .kind = kind_of(json_node_string(line, "kind")),
                        .toi = json_node_number(line, "toi"),
                        .u = json_node_number(line, "u"),
                        .v = json_node_number(line, "v")};
    bool vf = r.kind == CSCD_CONTACT_VF;
    read_indices(line, "a", vf ? 1 : 2, r.a);
    read_indices(line, "b", vf ? 3 : 2, r.b);
    read_vector(line, "point", r.point);
    read_vector(line, "normal", r.normal);
    assert_int_equal(line->count, json_node_find(line, "objects") != NULL ? 10 : 9);
    return r;
}

contact_rows contact_rows_read_jsonl(const char *path) {
    contact_rows rows = {0};
    char *text = read_whole_file(path, NULL), *rest = text;
    for (char *line; (line = next_line(&rest)) != NULL;) {
        json_node *node = json_node_parse(line, strlen(line), NULL);
        assert_non_null(node);
        contact_record row = line_of(node);
        add_row(&rows, &row);
        json_node_free(node);
    }
    free(text);
    return rows;
}

void contact_rows_free(contact_rows *rows) {
    free(rows->items);
    *rows = (contact_rows){0};
}

size_t contact_rows_of(const contact_rows *rows, int32_t frame, cscd_contact_kind kind) {
    size_t count = 0;
    for (size_t i = 0; i < rows->count; i++)
        count += rows->items[i].frame == frame && rows->items[i].kind == kind;
    return count;
}

void contact_rows_assert_equal(const contact_rows *a, const contact_rows *b) {
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->count; i++) {
        const contact_record *l = &a->items[i], *r = &b->items[i];
        assert_true(l->frame == r->frame && l->kind == r->kind);
        assert_memory_equal(l->a, r->a, sizeof l->a);
        assert_memory_equal(l->b, r->b, sizeof l->b);
        assert_true(l->toi == r->toi && l->u == r->u && l->v == r->v);
        assert_memory_equal(l->point, r->point, sizeof l->point);
        assert_memory_equal(l->normal, r->normal, sizeof l->normal);
    }
}
