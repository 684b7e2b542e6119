/* Pairs that the user wants left out: tables of pairs of parts, from the names of the command line; pairs of
 * triangles that intersect or touch in the first frame; and those of a list file. */
#include "tool/common/ignore_pairs.h"

#include "tool/io/io.h"
#include "tool/io/text_encoding.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- pairs of parts ------------------------------------------------------------------------------------ */

/* Tables are square, so that many parts are too many. */
enum { PARTS_MAX = 8192 };

static uint32_t row_of(const part_rules *rules, uint32_t part) {
    return part == NO_PART ? rules->size - 1 : part;
}

static void mark_pair(const part_rules *rules, unsigned char *table, uint32_t a, uint32_t b) {
    table[(size_t)a * rules->size + b] = table[(size_t)b * rules->size + a] = 1;
}

static unsigned char *make_table(const part_rules *rules) {
    return io_zeroed((size_t)rules->size * rules->size);
}

/* Marks the pairs of one text; chosen: two times size. */
static bool mark_text(const part_rules *rules, const char *option, const char *text, unsigned char *table,
                      bool *chosen, io_error *error) {
    const char *comma = strchr(text, ','), *names[2] = {text, comma != NULL ? comma + 1 : NULL};
    const size_t lengths[2] = {comma != NULL ? (size_t)(comma - text) : strlen(text),
                               comma != NULL ? strlen(comma + 1) : 0};
    bool *sides[2] = {chosen, chosen + rules->size};
    for (int i = 0; i < 2; i++) {
        memset(sides[i], names[i] == NULL, rules->size * sizeof *sides[i]);
        if (names[i] != NULL && part_names_choose(rules->parts, names[i], lengths[i], sides[i]) == 0)
            return part_names_fail(rules->parts, option, names[i], lengths[i], error);
    }
    for (uint32_t a = 0; a < rules->size; a++)
        for (uint32_t b = 0; b < rules->size; b++)
            if (sides[0][a] && sides[1][b]) mark_pair(rules, table, a, b);
    return true;
}

static bool mark_list(const part_rules *rules, const char *option, const part_pairs_list *list,
                      unsigned char **table, io_error *error) {
    if (list->count == 0) return true;
    bool *chosen = io_realloc(NULL, 2 * (size_t)rules->size * sizeof *chosen), marked = chosen != NULL;
    *table = make_table(rules);
    if (*table == NULL || chosen == NULL) marked = io_fail(error, "%s: out of memory", option);
    for (uint32_t i = 0; i < list->count && marked; i++)
        marked = mark_text(rules, option, list->items[i], *table, chosen, error);
    free(chosen);
    return marked;
}

/* Fails where there are too many parts for rules. The sentence begins with the options, and "take" or
 * "takes". */
static bool check_part_count(const part_names *parts, const char *options_take, io_error *error) {
    return parts->count <= PARTS_MAX ||
           io_fail(error, "%s at most %d parts, and there are %u", options_take, PARTS_MAX, parts->count);
}

static void free_rules(part_rules *rules) {
    free(rules->ignored);
    free(rules->only);
    *rules = (part_rules){0};
}

/* The parts outlive the rules. The error names a part that there is not, and those that there are. */
static bool create_rules(const part_names *parts, const part_pairs_list *ignored, const part_pairs_list *only,
                         part_rules *out, io_error *error) {
    part_rules rules = {.parts = parts, .size = parts->count + 1};
    if (ignored->count + only->count > 0 && !check_part_count(parts, "--ignore-parts and --only take", error))
        return false;
    if (!mark_list(&rules, "--ignore-parts", ignored, &rules.ignored, error) ||
        !mark_list(&rules, "--only", only, &rules.only, error)) {
        free_rules(&rules);
        return false;
    }
    *out = rules;
    return true;
}

bool part_rules_ignore(part_rules *rules, uint32_t a, uint32_t b) {
    if (rules->parts->count > PARTS_MAX) return false;
    if (rules->ignored == NULL) rules->ignored = make_table(rules);
    if (rules->ignored == NULL) return false;
    mark_pair(rules, rules->ignored, row_of(rules, a), row_of(rules, b));
    return true;
}

static bool rules_leave_out_any(const part_rules *rules) {
    return rules->ignored != NULL || rules->only != NULL;
}

static bool any_in_no_part(const part_names *parts, uint32_t triangle_count) {
    for (uint32_t t = 0; t < triangle_count; t++)
        if (parts->labels[t] == NO_PART) return true;
    return false;
}

/* Counts the pairs of parts that are left out, and all, each part with itself among them. What is in no part
 * of a mesh of this many triangles counts as one. */
static void count_part_pairs(const part_rules *rules, uint32_t triangle_count, size_t *left_out,
                             size_t *all) {
    const uint32_t count = rules->parts->count + any_in_no_part(rules->parts, triangle_count);
    *left_out = 0;
    *all = (size_t)count * (count + 1) / 2;
    if (!rules_leave_out_any(rules)) return;
    for (uint32_t a = 0; a < count; a++)
        for (uint32_t b = a; b < count; b++) {
            const size_t pair = (size_t)a * rules->size + b;
            *left_out += (rules->ignored != NULL && rules->ignored[pair]) ||
                         (rules->only != NULL && !rules->only[pair]);
        }
}

/* Two sets of triangles, each that of a feature, are left out if one of the first and one of the second form
 * a pair that is ignored, or if none form a pair that is to be looked at. */
static bool rules_leave_out(const part_rules *rules, const uint32_t *a, uint32_t a_count, const uint32_t *b,
                            uint32_t b_count) {
    bool wanted = rules->only == NULL;
    for (uint32_t i = 0; i < a_count; i++) {
        const size_t row = (size_t)row_of(rules, rules->parts->labels[a[i]]) * rules->size;
        for (uint32_t k = 0; k < b_count; k++) {
            const size_t pair = row + row_of(rules, rules->parts->labels[b[k]]);
            if (rules->ignored != NULL && rules->ignored[pair]) return true;
            wanted = wanted || rules->only[pair];
        }
    }
    return !wanted;
}

/* ---- pairs of triangles -------------------------------------------------------------------------------- */

static bool append_pair(ignored_pair **items, size_t *count, size_t *capacity, uint32_t a, uint32_t b) {
    if (*count == *capacity) {
        size_t wider = *capacity == 0 ? 64 : *capacity * 2;
        ignored_pair *grown = io_realloc(*items, wider * sizeof *grown);
        if (grown == NULL) return false;
        *items = grown;
        *capacity = wider;
    }
    (*items)[(*count)++] = a < b ? (ignored_pair){a, b} : (ignored_pair){b, a};
    return true;
}

static int compare_pairs(const void *left, const void *right) {
    const ignored_pair *l = left, *r = right;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

static void sort_pairs(ignore_pairs *pairs) {
    if (pairs->triangle_count > 0)
        qsort(pairs->triangles, pairs->triangle_count, sizeof *pairs->triangles, compare_pairs);
    if (pairs->component_count > 0)
        qsort(pairs->components, pairs->component_count, sizeof *pairs->components, compare_pairs);
}

/* The things that a line speaks of. */
typedef enum listed_kind { LISTED_TRIANGLES, LISTED_COMPONENTS } listed_kind;

/* Takes an object's name and its ':' off the text, if they are there: object_count when no object has that
 * name. */
static uint32_t take_object(const recording *r, char **text) {
    char *colon = strchr(*text, ':');
    if (colon == NULL || colon > *text + strcspn(*text, " \t,")) return 0;
    *colon = '\0';
    uint32_t object = recording_find_object(r, *text);
    *text = colon + 1;
    return object != UINT32_MAX ? object : r->object_count;
}

/* Reads a number below limit and moves *text behind it. */
static bool take_number(char **text, uint32_t limit, uint32_t *number) {
    char *end = NULL;
    if (**text < '0' || **text > '9') return false;
    errno = 0;
    unsigned long long value = strtoull(*text, &end, 10);
    if (errno != 0 || value >= limit) return false;
    *number = (uint32_t)value;
    *text = end;
    return true;
}

/* Reads two numbers, of triangles of the mesh or of components; UINT32_MAX for a triangle that welding has
 * dropped. False if there is anything else in the text. */
static bool parse_pair(const recording *r, char *text, listed_kind kind, uint32_t pair[2]) {
    for (int i = 0; i < 2; i++) {
        text += strspn(text, " \t,");
        if (kind == LISTED_COMPONENTS) {
            if (!take_number(&text, cscd_mesh_component_count(r->mesh), &pair[i])) return false;
            continue;
        }
        uint32_t index = take_object(r, &text);
        if (index == r->object_count) return false;
        const recorded_object *object = &r->objects[index];
        if (!take_number(&text, object->file.triangle_count, &pair[i])) return false;
        pair[i] = recorded_object_find_triangle(object, pair[i]);
        if (pair[i] != UINT32_MAX) pair[i] += object->first_triangle;
    }
    return text[strspn(text, " \t\r\n")] == '\0';
}

static bool fail_line(const recording *r, listed_kind kind, const char *path, int number, io_error *error) {
    if (kind == LISTED_COMPONENTS)
        return io_fail(error, "%s:%d: expected 'components A B' with A and B below %u", path, number,
                       cscd_mesh_component_count(r->mesh));
    if (r->object_count > 1)
        return io_fail(error, "%s:%d: expected 'NAME:A NAME:B', objects and triangles of their files", path,
                       number);
    return io_fail(error, "%s:%d: expected 'A B' with A and B below %u", path, number,
                   r->objects[0].file.triangle_count);
}

static bool read_line(ignore_pairs *pairs, const recording *r, char *line, const char *path, int number,
                      io_error *error) {
    line[strcspn(line, "#")] = '\0';
    char *text = line + strspn(line, " \t\r\n");
    if (*text == '\0') return true;
    bool components = strncmp(text, "components", 10) == 0 && (text[10] == ' ' || text[10] == '\t');
    listed_kind kind = components ? LISTED_COMPONENTS : LISTED_TRIANGLES;
    uint32_t pair[2];
    if (!parse_pair(r, components ? text + 10 : text, kind, pair))
        return fail_line(r, kind, path, number, error);
    bool added = true;
    if (components)
        added = append_pair(&pairs->components, &pairs->component_count, &pairs->component_capacity, pair[0],
                            pair[1]);
    else if (pair[0] != UINT32_MAX && pair[1] != UINT32_MAX)
        added = append_pair(&pairs->triangles, &pairs->triangle_count, &pairs->triangle_capacity, pair[0],
                            pair[1]);
    return added || io_fail(error, "%s:%d: out of memory", path, number);
}

static bool read_list(ignore_pairs *pairs, const recording *r, const char *path, io_error *error) {
    FILE *file = pipe_file_read(path);
    if (file == NULL) return io_fail(error, "%s: cannot open: %s", path, strerror(errno));
    char *line = NULL;
    size_t size = 0;
    bool read = true;
    ssize_t length;
    for (int number = 1; read && (length = getline(&line, &size, file)) >= 0; number++) {
        if (number == 1 && text_is_utf16(line, (size_t)length)) {
            read = io_fail(error, "%s: " TEXT_UTF16_ADVICE, path);
            break;
        }
        const size_t mark = number == 1 ? text_mark_size(line, (size_t)length) : 0;
        read = read_line(pairs, r, line + mark, path, number, error);
    }
    if (read && ferror(file)) read = io_fail(error, "%s: cannot read: %s", path, strerror(errno));
    free(line);
    fclose(file);
    sort_pairs(pairs);
    return read;
}

/* Leaves out a pair of triangles that intersect or touch at rest, or the parts that these are in. */
static bool add_rest_pair(ignore_pairs *pairs, bool by_parts, const cscd_intersection *found) {
    const uint32_t a = pairs->parts.labels[found->a], b = pairs->parts.labels[found->b];
    pairs->rest_pairs++;
    if (by_parts && a != b) return part_rules_ignore(&pairs->rules, a, b);
    return append_pair(&pairs->triangles, &pairs->triangle_count, &pairs->triangle_capacity, found->a,
                       found->b);
}

static bool list_contains(const ignored_pair *list, size_t count, uint32_t c, uint32_t d) {
    for (size_t i = 0; i < count; i++)
        if ((list[i].a == c && list[i].b == d) || (list[i].a == d && list[i].b == c)) return true;
    return false;
}

/* Notes the components of which triangles are left out with each other. */
static bool separate_components(ignore_pairs *pairs) {
    for (size_t i = 0; i < pairs->triangle_count; i++) {
        const uint32_t c = cscd_mesh_triangle_component(pairs->mesh, pairs->triangles[i].a),
                       d = cscd_mesh_triangle_component(pairs->mesh, pairs->triangles[i].b);
        if (c != d && !list_contains(pairs->separated, pairs->separated_count, c, d) &&
            !append_pair(&pairs->separated, &pairs->separated_count, &pairs->separated_capacity, c, d))
            return false;
    }
    return true;
}

bool ignore_pairs_add_rest(ignore_pairs *pairs, const cscd_intersections *found, bool by_parts) {
    for (size_t i = 0; i < found->count; i++)
        if (!add_rest_pair(pairs, by_parts, &found->items[i])) return false;
    sort_pairs(pairs);
    return separate_components(pairs);
}

/* A duplicate is no pair at rest: it stays to be reported. */
static bool check_rest(ignore_pairs *pairs, bool by_parts, recording *r, cscd_detector *detector,
                       const double *positions, io_error *error) {
    const cscd_view at = cscd_view_doubles(positions, cscd_mesh_vertex_count(r->mesh));
    cscd_intersection_options options = cscd_intersection_defaults();
    options.kinds = ~cscd_intersection_set(CSCD_INTERSECTION_DUPLICATE);
    cscd_intersections found;
    if (cscd_detector_find_intersections(detector, &at, &options, &found) != CSCD_OK)
        return io_fail(error, "frame %d: %s", r->frame_numbers[0], cscd_context_detail(r->context));
    if (ignore_pairs_add_rest(pairs, &found, by_parts)) return true;
    return (!by_parts || check_part_count(&pairs->parts, "--ignore-rest=parts takes", error)) &&
           io_fail(error, "frame %d: out of memory for what intersects or touches at rest",
                   r->frame_numbers[0]);
}

static bool add_rest(ignore_pairs *pairs, bool by_parts, recording *r, io_error *error) {
    double *positions = io_realloc(NULL, (size_t)cscd_mesh_vertex_count(r->mesh) * 3 * sizeof *positions);
    cscd_detector *detector = NULL;
    bool added = positions != NULL || io_fail(error, "out of memory");
    added = added && recording_read(r, 0, positions, error);
    if (added && cscd_detector_create(r->context, r->mesh, NULL, NULL, &detector) != CSCD_OK)
        added = io_fail(error, "frame %d: %s", r->frame_numbers[0], cscd_context_detail(r->context));
    added = added && check_rest(pairs, by_parts, r, detector, positions, error);
    cscd_detector_destroy(detector);
    free(positions);
    return added;
}

bool ignore_options_any(const ignore_options *options) {
    return options->path != NULL || options->rest != REST_KEPT ||
           options->ignored.count + options->only.count > 0;
}

bool ignore_pairs_prepare(const ignore_options *options, recording *r, ignore_pairs *out, io_error *error) {
    *out = (ignore_pairs){.mesh = r->mesh};
    if (options->parts_path != NULL && r->parts_by != MESH_PARTS_BY_FILE)
        return io_fail(error, "--parts and --parts-by both say what the parts are; give one of them");
    const bool named = options->parts_path != NULL
                           ? part_names_read(r, options->parts_path, &out->parts, error)
                           : part_names_find(r, NULL, &out->parts, error);
    if (named && create_rules(&out->parts, &options->ignored, &options->only, &out->rules, error) &&
        (options->path == NULL || read_list(out, r, options->path, error)) &&
        (options->rest == REST_KEPT || add_rest(out, options->rest == REST_PARTS, r, error)) &&
        (separate_components(out) || io_fail(error, "out of memory for the pairs that are left out")))
        return true;
    ignore_pairs_free(out);
    return false;
}

bool ignore_pairs_of(const cscd_mesh *mesh, part_names *parts, ignore_pairs *out, io_error *error) {
    const part_pairs_list none = {.count = 0};
    *out = (ignore_pairs){.mesh = mesh, .parts = *parts};
    *parts = (part_names){0};
    if (create_rules(&out->parts, &none, &none, &out->rules, error)) return true;
    ignore_pairs_free(out);
    return false;
}

/* The triangles that have a feature: of a triangle itself. */
static const uint32_t *triangles_of(const cscd_mesh *mesh, cscd_contact_kind kind, const uint32_t *feature,
                                    bool second, uint32_t *count) {
    *count = 1;
    if (kind == CSCD_CONTACT_TT || (kind == CSCD_CONTACT_VF && second)) return feature;
    return kind == CSCD_CONTACT_VF ? cscd_mesh_vertex_triangles(mesh, *feature, count)
                                   : cscd_mesh_edge_triangles(mesh, *feature, count);
}

static bool components_contain(const ignore_pairs *pairs, uint32_t a, uint32_t b) {
    return list_contains(pairs->components, pairs->component_count,
                         cscd_mesh_triangle_component(pairs->mesh, a),
                         cscd_mesh_triangle_component(pairs->mesh, b));
}

static bool triangles_left_out(const ignore_pairs *pairs, const uint32_t *a, uint32_t a_count,
                               const uint32_t *b, uint32_t b_count) {
    return (pairs->component_count > 0 && components_contain(pairs, a[0], b[0])) ||
           (rules_leave_out_any(&pairs->rules) && rules_leave_out(&pairs->rules, a, a_count, b, b_count));
}

/* The callback for cscd_detector_options.ignore. */
static bool leaves_out(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const ignore_pairs *pairs = user;
    uint32_t a_count, b_count;
    const uint32_t *of_a = triangles_of(pairs->mesh, kind, &a, false, &a_count);
    const uint32_t *of_b = triangles_of(pairs->mesh, kind, &b, true, &b_count);
    return triangles_left_out(pairs, of_a, a_count, of_b, b_count);
}

static bool sets_apart(const ignore_pairs *pairs, const uint32_t *of_feature, uint32_t count,
                       uint32_t triangle) {
    return triangles_left_out(pairs, of_feature, count, &triangle, 1) ||
           list_contains(pairs->separated, pairs->separated_count,
                         cscd_mesh_triangle_component(pairs->mesh, of_feature[0]),
                         cscd_mesh_triangle_component(pairs->mesh, triangle));
}

bool ignore_pairs_separate_vertex(const ignore_pairs *pairs, uint32_t vertex, uint32_t triangle) {
    uint32_t count;
    const uint32_t *of_vertex = cscd_mesh_vertex_triangles(pairs->mesh, vertex, &count);
    return sets_apart(pairs, of_vertex, count, triangle);
}

bool ignore_pairs_separate_edge(const ignore_pairs *pairs, uint32_t edge, uint32_t triangle) {
    uint32_t count;
    const uint32_t *of_edge = cscd_mesh_edge_triangles(pairs->mesh, edge, &count);
    return sets_apart(pairs, of_edge, count, triangle);
}

bool ignore_pairs_separate_triangles(const ignore_pairs *pairs, uint32_t a, uint32_t b) {
    return sets_apart(pairs, &a, 1, b);
}

bool ignore_pairs_any(const ignore_pairs *pairs) {
    return pairs->triangle_count > 0 || pairs->component_count > 0 || rules_leave_out_any(&pairs->rules);
}

static size_t count_different(const ignored_pair *sorted, size_t count) {
    size_t different = 0;
    for (size_t i = 0; i < count; i++) different += i == 0 || compare_pairs(&sorted[i - 1], &sorted[i]) != 0;
    return different;
}

ignore_counts ignore_pairs_count(const ignore_pairs *pairs) {
    ignore_counts counts = {.components = count_different(pairs->components, pairs->component_count),
                            .triangles = count_different(pairs->triangles, pairs->triangle_count)};
    count_part_pairs(&pairs->rules, cscd_mesh_triangle_count(pairs->mesh), &counts.parts, &counts.all_parts);
    return counts;
}

void ignore_pairs_choose(ignore_pairs *pairs, cscd_detector_options *options) {
    options->ignored_count = pairs->triangle_count;
    if (pairs->triangle_count > 0) options->ignored = &pairs->triangles->a;
    if (pairs->component_count == 0 && !rules_leave_out_any(&pairs->rules)) return;
    options->ignore = leaves_out;
    options->ignore_user = pairs;
}

void ignore_pairs_free(ignore_pairs *pairs) {
    free(pairs->triangles);
    free(pairs->components);
    free(pairs->separated);
    free_rules(&pairs->rules);
    part_names_free(&pairs->parts);
    *pairs = (ignore_pairs){0};
}
