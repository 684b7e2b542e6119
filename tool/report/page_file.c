/* Puts a page together: the template, and in it the document and the arrays. */
#include "tool/report/page_file.h"

#include "tool/io/output_file.h"

#include <string.h>

void page_file_list(json *out, const page_arrays *arrays) {
    json_begin_array(out, "arrays");
    for (size_t i = 0; i < arrays->count; i++) {
        json_begin_object(out, NULL);
        json_string(out, "name", arrays->items[i].name);
        json_string(out, "type", arrays->items[i].type);
        json_integer(out, "count", page_array_count(&arrays->items[i]));
        json_end_object(out);
    }
    json_end_array(out);
}

static bool put_text(FILE *file, const char *text, size_t size) {
    return fwrite(text, 1, size, file) == size;
}

/* `<` could end the element around the JSON, in which it occurs in strings only. */
static bool put_json(FILE *file, const char *text) {
    while (*text != '\0') {
        size_t size = strcspn(text, "<");
        if (!put_text(file, text, size) || (text[size] == '<' && fputs("\\u003c", file) == EOF)) return false;
        text += size + (text[size] == '<');
    }
    return true;
}

static bool put_array(FILE *file, const page_array *array) {
    return fprintf(file, "<script type=\"application/octet-stream\" id=\"cscd-array-%s\">", array->name) >
               0 &&
           packed_array_write(array->values, file) && fputs("</script>\n", file) != EOF;
}

static bool put_page(FILE *file, const report_template *page, const char *text, const page_arrays *arrays) {
    bool written = put_text(file, page->head, page->head_size) &&
                   fputs("<script type=\"application/json\" id=\"cscd-report\">", file) != EOF &&
                   put_json(file, text) && fputs("</script>\n", file) != EOF;
    for (size_t i = 0; i < arrays->count && written; i++) written = put_array(file, &arrays->items[i]);
    return written && put_text(file, page->tail, page->tail_size) && fflush(file) == 0;
}

bool page_file_write(const char *path, const report_template *page, const char *text,
                     const page_arrays *arrays, io_error *error) {
    output_file out;
    bool written = output_file_open(path, &out);
    if (written) {
        written = put_page(out.file, page, text, arrays);
        written = output_file_close(&out, written ? OUTPUT_WHOLE : OUTPUT_ABANDONED);
    }
    return written || io_fail_write(error, path);
}
