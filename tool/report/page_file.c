/* Puts a page together: the template, which is a part of the program, and in it the document and the
 * arrays. */
#include "tool/report/page.h"

#include "tool/io/output_file.h"

#include <string.h>

/* ---- templates ----------------------------------------------------------------------------------------- */

/* The place of constants, in words of the assembler; only ELF has names that are hidden. */
#if defined(__ELF__)
#define IN_CONSTANTS ".pushsection .rodata, \"a\"\n"
#define IN_CODE      ".popsection\n"
#define HIDE(name)   ".hidden " name "\n"
#elif defined(_WIN32)
#define IN_CONSTANTS ".section .rdata, \"dr\"\n"
#define IN_CODE      ".text\n"
#define HIDE(name)   ""
#elif defined(__APPLE__)
#define IN_CONSTANTS ".section __TEXT, __const\n"
#define IN_CODE      ".text\n"
#define HIDE(name)   ".private_extern " name "\n"
#else
#error "say here where the assembler of this system puts constants"
#endif

/* A file as it is, between two names of this program's own; the assembler finds it from the folder of the
 * Makefile. */
#define PUT_FILE(name, path)                                                                                 \
    __asm__(IN_CONSTANTS HIDE(name) HIDE(name "_end") ".globl " name "\n"                                    \
                                                      ".globl " name "_end\n" name ":\n"                     \
                                                      ".incbin \"" path "\"\n" name "_end:\n"                \
                                                      ".byte 0\n" IN_CODE)

PUT_FILE("cscd_report_page", "tool/report/template.html");
PUT_FILE("cscd_jobs_page", "tool/report/jobs.html");

/* By the names that the assembler sees; those of C begin with another character on some systems. */
extern const char cscd_report_page[] __asm__("cscd_report_page"), cscd_jobs_page[] __asm__("cscd_jobs_page");
extern const char cscd_report_page_end[] __asm__("cscd_report_page_end");
extern const char cscd_jobs_page_end[] __asm__("cscd_jobs_page_end");

static const char mark[] = "\n<!--cscd:data-->\n";

bool report_template_divide(const char *page, size_t size, report_template *out, io_error *error) {
    const char *end = page + size;
    const char *found = memmem(page, size, mark, strlen(mark));
    if (found == NULL)
        return io_fail(error,
                       "the template of the report lacks the line <!--cscd:data-->; run make template");
    const char *head_end = found + 1, *tail = found + strlen(mark);
    if (memmem(tail - 1, (size_t)(end - tail) + 1, mark, strlen(mark)) != NULL)
        return io_fail(error,
                       "the template of the report has the line <!--cscd:data--> twice; run make template");
    *out = (report_template){page, tail, (size_t)(head_end - page), (size_t)(end - tail)};
    return true;
}

bool report_template_load(template_kind kind, report_template *out, io_error *error) {
    const char *page = kind == TEMPLATE_JOBS ? cscd_jobs_page : cscd_report_page;
    const char *end = kind == TEMPLATE_JOBS ? cscd_jobs_page_end : cscd_report_page_end;
    return report_template_divide(page, (size_t)(end - page), out, error);
}

/* ---- the file ------------------------------------------------------------------------------------------ */

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
