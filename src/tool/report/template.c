/* The page without its data: src/tool/report/template.html, a part of the program. */
#include "src/tool/report/template.h"

#include <string.h>

/* The file as it is, between two names of this program's own; the assembler finds it from the folder of the
 * Makefile. */
__asm__(".pushsection .rodata, \"a\"\n"
        ".hidden cscd_report_page\n"
        ".hidden cscd_report_page_end\n"
        ".globl cscd_report_page\n"
        ".globl cscd_report_page_end\n"
        "cscd_report_page:\n"
        ".incbin \"src/tool/report/template.html\"\n"
        "cscd_report_page_end:\n"
        ".byte 0\n"
        ".popsection\n");

extern const char cscd_report_page[], cscd_report_page_end[];

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

bool report_template_load(report_template *out, io_error *error) {
    return report_template_divide(cscd_report_page, (size_t)(cscd_report_page_end - cscd_report_page), out,
                                  error);
}
