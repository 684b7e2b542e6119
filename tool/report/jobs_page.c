/* Packs the jobs of a list into the columns of their page. */
#include "tool/report/report.h"

#include "tool/io/io.h"
#include "tool/report/page.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- links --------------------------------------------------------------------------------------------- */

/* Takes the last name away. */
static size_t parent_length(const char *path, size_t length) {
    while (length > 0 && path[length - 1] != '/') length--;
    return length > 0 ? length - 1 : 0;
}

/* Adds the names of a path to a folder, in place. */
static void add_names(char *folder, const char *path) {
    size_t length = strlen(folder);
    while (*path != '\0') {
        const size_t size = strcspn(path, PATH_SEPARATORS);
        const bool stays = size == 0 || (size == 1 && path[0] == '.');
        if (size == 2 && memcmp(path, "..", 2) == 0)
            length = parent_length(folder, length);
        else if (!stays) {
            folder[length++] = '/';
            memcpy(folder + length, path, size);
            length += size;
        }
        path += size + path_is_separator(path[size]);
    }
    folder[length] = '\0';
}

static char *absolute_path(const char *here, const char *path) {
    char *whole = malloc(strlen(here) + strlen(path) + 2);
    if (whole == NULL) return NULL;
    const size_t drive = path_drive_length(path);
    strcpy(whole, drive > 0 || path_is_separator(path[0]) ? "" : here);
    if (drive > 0) snprintf(whole, drive + 1, "%s", path);
    add_names(whole, path + drive);
    return whole;
}

/* A folder that links do not lead away from; one that does not exist is taken as it is called. */
static char *real_folder(const char *here, const char *folder) {
    char *found = realpath(folder, NULL);
    if (found == NULL) return absolute_path(here, folder);
    const size_t drive = path_drive_length(found);
    if (strcmp(found + drive, "/") == 0) found[drive] = '\0';
    return found;
}

/* Finds the folder of a page; "-", the standard output, is in the current one. False: memory is short. */
static bool page_folder_find(const char *page, page_folder *out) {
    const char *slash = path_last_separator(page);
    char *folder = slash != NULL ? strndup(page, (size_t)(slash - page) + 1) : strdup(".");
    out->here = real_folder("", ".");
    out->page = folder != NULL && out->here != NULL ? real_folder(out->here, folder) : NULL;
    free(folder);
    return out->page != NULL;
}

static void page_folder_free(page_folder *folder) {
    free(folder->page);
    free(folder->here);
}

/* The length of the folders that both have in common. */
static size_t common_length(const char *folder, const char *path) {
    size_t common = 0, i = 0;
    for (;; i++) {
        const bool ends = folder[i] == '\0' || folder[i] == '/';
        if (ends && (path[i] == '/' || path[i] == '\0')) common = i;
        if (folder[i] == '\0' || folder[i] != path[i]) return common;
    }
}

char *page_link_make(const page_folder *folder, const char *path) {
    char *target = absolute_path(folder->here, path);
    if (target == NULL) return NULL;
    const size_t common = common_length(folder->page, target);
    size_t up = 0;
    for (const char *c = folder->page + common; *c != '\0'; c++) up += *c == '/';
    char *link = malloc(3 * up + strlen(target + common) + 1), *at = link;
    if (link != NULL) {
        for (size_t i = 0; i < up; i++, at += 3) memcpy(at, "../", 3);
        strcpy(at, target + common + (target[common] == '/'));
    }
    free(target);
    return link;
}

/* ---- the page ------------------------------------------------------------------------------------------ */

enum { TEXTS = 3 };

struct jobs_page {
    jobs_page_options options;
    page_arrays arrays;
    packed_array *outcomes, *found, *texts[TEXTS], *numbers[JOBS_PAGE_NUMBERS];
    bool any[JOBS_PAGE_NUMBERS]; /* has a job this number? */
    page_folder folder;
};

static const char *const number_names[JOBS_PAGE_NUMBERS] = {"crossing_frames", "frames", "events",
                                                            "depth",           "pairs",  "seconds"};

static bool create_arrays(jobs_page *p) {
    static const char *const text_names[TEXTS] = {"names", "answers", "links"};
    p->outcomes = page_arrays_add(&p->arrays, "outcome", "u8");
    p->found = p->outcomes != NULL ? page_arrays_add(&p->arrays, "found", "u8") : NULL;
    bool created = p->found != NULL;
    for (int i = 0; i < TEXTS && created; i++)
        created = (p->texts[i] = page_arrays_add(&p->arrays, text_names[i], "u8")) != NULL;
    for (int i = 0; i < JOBS_PAGE_NUMBERS && created; i++)
        created = (p->numbers[i] = page_arrays_add(&p->arrays, number_names[i], "f64")) != NULL;
    return created;
}

bool jobs_page_create(const jobs_page_options *options, jobs_page **out, io_error *error) {
    jobs_page *p = calloc(1, sizeof *p);
    if (p == NULL) return io_fail(error, "out of memory");
    p->options = *options;
    if (!create_arrays(p) || !page_folder_find(options->path, &p->folder)) {
        jobs_page_destroy(p);
        return io_fail(error, "out of memory");
    }
    *out = p;
    return true;
}

void jobs_page_destroy(jobs_page *p) {
    if (p == NULL) return;
    page_arrays_free(&p->arrays);
    page_folder_free(&p->folder);
    free(p);
}

/* Texts end with a 0. */
static bool add_text(packed_array *array, const char *text) {
    return packed_array_add_bytes(array, (const uint8_t *)text, strlen(text) + 1);
}

static bool add_link(const jobs_page *p, const char *path) {
    char *link = path[0] != '\0' ? page_link_make(&p->folder, path) : strdup("");
    const bool added = link != NULL && add_text(p->texts[2], link);
    free(link);
    return added;
}

bool jobs_page_add(jobs_page *p, const jobs_page_row *row, io_error *error) {
    const uint8_t found = row->found;
    bool added = packed_array_add_bytes(p->outcomes, &row->outcome, 1) &&
                 packed_array_add_bytes(p->found, &found, 1) && add_text(p->texts[0], row->name) &&
                 add_text(p->texts[1], row->answer) && add_link(p, row->report);
    for (int i = 0; i < JOBS_PAGE_NUMBERS && added; i++) {
        p->any[i] |= !isnan(row->numbers[i]);
        added = packed_array_add_f64(p->numbers[i], &row->numbers[i], 1);
    }
    return added || io_fail(error, "out of memory");
}

/* ---- the file -------------------------------------------------------------------------------------------------- */

static void write_document(const jobs_page *p, FILE *file) {
    json out = {.file = file};
    char digits[17];
    snprintf(digits, sizeof digits, "%016" PRIx64, p->options.list);
    json_begin_object(&out, NULL);
    json_integer(&out, "format", 1);
    json_string(&out, "kind", "jobs");
    json_string(&out, "title", p->options.title);
    json_string(&out, "generator", p->options.generator);
    json_string(&out, "list", digits);
    json_string(&out, "missing", p->options.missing);
    json_begin_array(&out, "outcomes");
    for (const char *const *name = p->options.outcomes; *name != NULL; name++) json_string(&out, NULL, *name);
    json_end_array(&out);
    page_file_list(&out, &p->arrays);
    json_end_object(&out);
}

/* Leaves out the columns that no job has. */
static bool finish_arrays(jobs_page *p) {
    size_t kept = 0;
    bool finished = true;
    for (size_t i = 0; i < p->arrays.count; i++) {
        page_array *array = &p->arrays.items[i];
        bool wanted = true;
        for (int k = 0; k < JOBS_PAGE_NUMBERS; k++) wanted &= array->values != p->numbers[k] || p->any[k];
        if (wanted) {
            finished &= packed_array_finish(array->values);
            p->arrays.items[kept++] = *array;
        } else
            packed_array_destroy(array->values);
    }
    p->arrays.count = kept;
    return finished;
}

bool jobs_page_write(jobs_page *p, io_error *error) {
    report_template page;
    char *text = NULL;
    size_t size;
    if (!report_template_load(TEMPLATE_JOBS, &page, error)) return false;
    FILE *memory = finish_arrays(p) ? open_memstream(&text, &size) : NULL;
    if (memory != NULL) write_document(p, memory);
    bool written = memory != NULL && !ferror(memory);
    written = (memory == NULL || fclose(memory) == 0) && written;
    written = written && text != NULL; /* as it is when the last bytes found no room */
    written = written ? page_file_write(p->options.path, &page, text, &p->arrays, error)
                      : io_fail(error, "%s: out of memory for the report", p->options.path);
    free(text);
    return written;
}
