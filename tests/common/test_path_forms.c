/* The tool finds and writes files whatever their paths look like: names in UTF-8, long paths, the separators of the system; it reads
 * lines that end as on the other system; and whoever reads an output while it is replaced finds the older or the newer one. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef _WIN32
#include <windows.h>
#endif

static recorded scene;

static int make_scene(void **state) {
    (void)state;
    scene = recorded_tetrahedra(8);
    return 0;
}

static int free_scene(void **state) {
    (void)state;
    recorded_free(&scene);
    return 0;
}

/* Asks the system itself, which knows a file in UTF-8 by another name when a program has not said what it writes. */
static bool system_knows(const char *path) {
#ifdef _WIN32
    wchar_t wide[1024] = L"\\\\?\\Z:";
    size_t prefix = path[0] == '/' ? wcslen(wide) : 4;
    if (MultiByteToWideChar(CP_UTF8, 0, path, -1, wide + prefix, (int)(1024 - prefix)) == 0) return false;
    for (wchar_t *c = wide; *c != L'\0'; c++)
        if (*c == L'/') *c = L'\\';
    return GetFileAttributesW(wide) != INVALID_FILE_ATTRIBUTES;
#else
    return access(path, F_OK) == 0;
#endif
}

static temp_folder folder_inside(const temp_folder *parent, const char *name) {
    temp_folder inner;
    const int length = snprintf(inner.path, sizeof inner.path, "%s/%s", parent->path, name);
    assert_true(length > 0 && (size_t)length < sizeof inner.path);
    assert_int_equal(mkdir(inner.path, 0777), 0);
    return inner;
}

/* What the scene has, and the bytes of Linux. */
static void expect_contacts(const char *path) {
    size_t size, lines = 0;
    char *text = read_whole_file(path, &size);
    for (size_t i = 0; i < size; i++) lines += text[i] == '\n';
    assert_true(lines > 1);
    assert_null(memchr(text, '\r', size));
    free(text);
}

static void expect_whole(const char *path) {
    json_node *root = json_node_read_file(path);
    assert_true(json_node_boolean(json_node_member(root, "summary"), "complete"));
    json_node_free(root);
}

/* Replays with every output in the folder that the names are in; paths are as given. */
static void expect_replayed(const char *model, const char *frames, const char *csv, const char *json,
                            const char *page) {
    EXPECT_TOOL(0, "replay", model, frames, "--contacts", csv, "--json", json, "--report", page, "--quiet");
    expect_contacts(csv);
    expect_whole(json);
}

#ifdef _WIN32
static temp_path with_backslashes(temp_path path) {
    for (char *c = path.text; *c != '\0'; c++)
        if (*c == '/') *c = '\\';
    return path;
}
#else
static temp_path with_backslashes(temp_path path) {
    return path;
}
#endif

/* A mesh in one piece is called by its file's name, without folder and ending. */
static void expect_part(const temp_folder *folder, const char *name) {
    char file[128], expected[128];
    snprintf(file, sizeof file, "%s.obj", name);
    snprintf(expected, sizeof expected, "\n%s x itself", name);
    recorded fold = recorded_fold(12, 8, 6);
    const temp_path model = with_backslashes(recorded_write_mesh(folder, file, &fold, 0));
    const temp_path cache = with_backslashes(recorded_write_cache(folder, "folding.pc2", &fold));
    recorded_free(&fold);
    tool_run run = RUN_TOOL("check", model.text, cache.text);
    if (run.code != 0 || strstr(run.out, expected) == NULL)
        fail_msg("not called %s: %s%s", name, run.out, run.error);
    tool_run_free(&run);
}

/* Letters of two, three and four bytes. */
#define NAME "K\u00f6rper \u5f62 \U0001f9ca"

TEST(names_are_utf8) {
    const temp_folder outer = temp_folder_make(), folder = folder_inside(&outer, "Ordner " NAME);
    const temp_path model = recorded_write_mesh(&folder, NAME ".obj", &scene, 0);
    const temp_path cache = recorded_write_cache(&folder, NAME ".pc2", &scene);
    const temp_path frames = recorded_write_sequence(&folder, NAME " %03d.obj", &scene);
    const temp_path csv = temp_file_path(&folder, NAME ".csv"), json = temp_file_path(&folder, NAME ".json");
    const temp_path page = temp_file_path(&folder, NAME ".html"), png = temp_file_path(&folder, NAME ".png");
    const temp_path plan = temp_file_path(&folder, NAME ".plan.ply");
    expect_replayed(model.text, cache.text, csv.text, json.text, page.text);
    expect_replayed(model.text, frames.text, csv.text, json.text, page.text);
    EXPECT_TOOL(0, "preprocess", model.text, "--method", "kmeans:2", "--quiet");
    EXPECT_TOOL(0, "render", model.text, cache.text, "--frame", "5", "-o", png.text);
    const char *const all[] = {model.text, cache.text, csv.text, json.text, page.text, png.text, plan.text};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (!system_knows(all[i])) fail_msg("the system does not know %s", all[i]);
    expect_part(&folder, NAME " sheet");
    EXPECT_ERROR(1, TEXTS(NAME " is not there.obj", "No such file"), "check",
                 temp_file_path(&folder, NAME " is not there.obj").text);
    temp_folder_remove(&folder);
    temp_folder_remove(&outer);
}

#define WORD_64 "a-path-may-be-as-long-as-the-file-system-allows-and-not-260-only"
#define WORD_96 WORD_64 "-as-programs-for-Windows-believe"

/* 260 characters were all that Windows took; it still takes no longer one for the current folder. */
TEST(paths_are_long) {
    const temp_folder outer = temp_folder_make(), folder = folder_inside(&outer, WORD_96);
    const temp_path model = recorded_write_mesh(&folder, WORD_96 WORD_64 ".obj", &scene, 0);
    const temp_path cache = recorded_write_cache(&folder, WORD_96 WORD_64 ".pc2", &scene);
    const temp_path frames = recorded_write_sequence(&folder, WORD_96 WORD_64 "-%03d.obj", &scene);
    const temp_path csv = temp_file_path(&folder, WORD_96 WORD_64 ".csv");
    const temp_path json = temp_file_path(&folder, WORD_96 WORD_64 ".json");
    const temp_path page = temp_file_path(&folder, WORD_96 WORD_64 ".html");
    assert_true(strlen(csv.text) > 260 && system_knows(model.text));
    expect_replayed(model.text, cache.text, csv.text, json.text, page.text);
    expect_replayed(model.text, frames.text, csv.text, json.text, page.text);
    assert_true(system_knows(csv.text) && system_knows(json.text) && system_knows(page.text));
    temp_folder_remove(&folder);
    temp_folder_remove(&outer);
}

/* A folder whose path has that many bytes. */
static temp_folder folder_of_length(const temp_folder *parent, size_t length) {
    char name[sizeof parent->path] = "";
    assert_true(strlen(parent->path) + 1 < length && length < sizeof name);
    memset(name, 'f', length - strlen(parent->path) - 1);
    return folder_inside(parent, name);
}

/* Each name is short, and the path that the system makes of it is not. */
TEST(short_names_are_in_long_folders) {
    char before[1024];
    assert_non_null(getcwd(before, sizeof before));
    const temp_folder outer = temp_folder_make(), folder = folder_of_length(&outer, 240);
    recorded_write_mesh(&folder, "a name of 24 bytes...obj", &scene, 0);
    recorded_write_cache(&folder, "a name of 24 bytes...pc2", &scene);
    assert_int_equal(chdir(folder.path), 0);
    expect_replayed("a name of 24 bytes...obj", "a name of 24 bytes...pc2", "a name of 24 bytes...csv",
                    "a name of 24 bytes..json", "a name of 24 bytes..html");
    assert_int_equal(chdir(before), 0);
    temp_folder_remove(&folder);
    temp_folder_remove(&outer);
}

#ifdef _WIN32
/* The folder is what precedes the last of either: outputs, plans and frames are in it, and the part is called by what follows. */
TEST(backslashes_separate) {
    const temp_folder folder = temp_folder_make();
    const temp_path model = with_backslashes(recorded_write_mesh(&folder, "pair.obj", &scene, 0));
    const temp_path cache = with_backslashes(recorded_write_cache(&folder, "pair.pc2", &scene));
    const temp_path frames = with_backslashes(recorded_write_sequence(&folder, "walk_%03d.obj", &scene));
    const temp_path csv = with_backslashes(temp_file_path(&folder, "out.csv"));
    const temp_path json = with_backslashes(temp_file_path(&folder, "out.json"));
    const temp_path page = with_backslashes(temp_file_path(&folder, "out.html"));
    const temp_path plan = temp_file_path(&folder, "pair.plan.ply");
    EXPECT_TOOL(0, "preprocess", model.text, "--method", "kmeans:2", "--quiet");
    assert_true(system_knows(plan.text));
    expect_replayed(model.text, cache.text, csv.text, json.text, page.text);
    expect_replayed(model.text, frames.text, csv.text, json.text, page.text);
    tool_run run = RUN_TOOL("replay", model.text, cache.text);
    if (strstr(run.out, "pair.plan.ply") == NULL) fail_msg("the plan is not found: %s", run.out);
    tool_run_free(&run);
    expect_part(&folder, "sheet");
    temp_folder_remove(&folder);
}
#else
/* A backslash is a letter like others. */
TEST(backslashes_separate) {
    const temp_folder folder = temp_folder_make();
    expect_part(&folder, "left\\right");
    temp_folder_remove(&folder);
}

/* The names have quotes, a backslash, a tab, characters beyond ASCII, and a byte that is not valid UTF-8; the JSON is valid. Names
 * of Windows are text. */
TEST(names_are_bytes) {
    const temp_folder folder = temp_folder_make();
    const temp_path model = recorded_write_mesh(&folder, "\"Mod\\ell\"\t\u00e4\u20ac.obj", &scene, 0);
    const temp_path cache = recorded_write_cache(&folder, "'\xff frames\x01.pc2", &scene);
    const temp_path summary = temp_file_path(&folder, "\u65e5 \"out\".json");
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--json", summary.text);
    json_node *root = json_node_read_file(summary.text);
    const json_node *inputs = json_node_member(json_node_member(root, "provenance"), "inputs");
    assert_string_equal(json_node_string(json_node_item(inputs, 0), "name"), model.text);
    assert_non_null(strstr(json_node_string(json_node_item(inputs, 1), "name"), "'\ufffd frames\x01.pc2"));
    json_node_free(root);
    temp_folder_remove(&folder);
}
#endif

/* The same lines, each with a carriage return. */
static void write_returns(const temp_folder *folder, const char *name, const char *text) {
    size_t size = 0;
    char *longer = malloc(2 * strlen(text) + 1);
    assert_non_null(longer);
    for (const char *c = text; *c != '\0'; c++) {
        if (*c == '\n') longer[size++] = '\r';
        longer[size++] = *c;
    }
    temp_file_write(folder, name, longer, size);
    free(longer);
}

static void copy_with_returns(const temp_folder *folder, const char *name, const temp_path *from) {
    char *text = read_whole_file(from->text, NULL);
    assert_non_null(strchr(text, '\n'));
    write_returns(folder, name, text);
    free(text);
}

static void expect_same_bytes(const temp_path *a, const temp_path *b) {
    size_t size, other_size;
    char *bytes = read_whole_file(a->text, &size), *other = read_whole_file(b->text, &other_size);
    if (size != other_size || memcmp(bytes, other, size) != 0) fail_msg("%s\n%s", bytes, other);
    free(bytes);
    free(other);
}

typedef struct checked_files {
    temp_path model, cache, ignore, parts, events, json;
} checked_files;

static checked_files name_files(const temp_folder *folder, const char *model) {
    return (checked_files){temp_file_path(folder, model),        temp_file_path(folder, "frames.pc2"),
                           temp_file_path(folder, "ignore.txt"), temp_file_path(folder, "parts.csv"),
                           temp_file_path(folder, "out.csv"),    temp_file_path(folder, "out.json")};
}

static void check_files(const checked_files *f) {
    EXPECT_TOOL(0, "check", f->model.text, f->cache.text, "--ignore", f->ignore.text, "--parts",
                f->parts.text, "--events", f->events.text, "--json", f->json.text, "--quiet");
    expect_contacts(f->events.text);
}

/* Models, tables and lists, with the line ends of either system. */
static void check_line_ends(const temp_folder *folder, const temp_folder *other, const char *model) {
    static const char ignored[] = "# rests\n0 4\n1 5\n",
                      parts[] =
                          "triangle,name\n0,Wall\n1,Wall\n2,Wall\n3,Wall\n4,Dart\n5,Dart\n6,Dart\n7,Dart\n";
    const checked_files plain = name_files(folder, model), returns = name_files(other, model);
    recorded_write_cache(folder, "frames.pc2", &scene);
    recorded_write_cache(other, "frames.pc2", &scene);
    recorded_write_mesh(folder, model, &scene, 0);
    copy_with_returns(other, model, &plain.model);
    temp_file_write(folder, "ignore.txt", ignored, strlen(ignored));
    temp_file_write(folder, "parts.csv", parts, strlen(parts));
    write_returns(other, "ignore.txt", ignored);
    write_returns(other, "parts.csv", parts);
    check_files(&plain);
    check_files(&returns);
    expect_same_bytes(&plain.events, &returns.events);
    expect_same_bytes(&plain.json, &returns.json);
}

TEST(lines_end_either_way) {
    const temp_folder folder = temp_folder_make(), other = temp_folder_make();
    check_line_ends(&folder, &other, "model.obj");
    check_line_ends(&folder, &other, "model.ply");
    temp_folder_remove(&folder);
    temp_folder_remove(&other);
}

/* Reads a file over and over while it is replaced. */
typedef struct watched_output {
    const char *path;
    size_t size; /* of the whole file */
    atomic_bool ends;
    int reads, missing, partial;
} watched_output;

static void read_once(watched_output *w, char *bytes) {
    FILE *file = fopen(w->path, "rb");
    w->reads++;
    w->missing += file == NULL;
    if (file == NULL) return;
    w->partial +=
        fread(bytes, 1, w->size + 1, file) != w->size || bytes[0] != '{' || bytes[w->size - 2] != '}';
    fclose(file);
}

static void *watch_output(void *user) {
    watched_output *w = user;
    char *bytes = malloc(w->size + 1);
    for (; bytes != NULL && !atomic_load(&w->ends); usleep(200)) read_once(w, bytes);
    free(bytes);
    return NULL;
}

TEST(an_output_is_replaced_in_one_step) {
    const temp_folder folder = temp_folder_make();
    const temp_path model = recorded_write_mesh(&folder, "pair.obj", &scene, 0);
    const temp_path cache = recorded_write_cache(&folder, "pair.pc2", &scene);
    const temp_path json = temp_file_path(&folder, "out.json");
    watched_output watched = {.path = json.text};
    EXPECT_TOOL(0, "check", model.text, cache.text, "--json", json.text, "--quiet");
    free(read_whole_file(json.text, &watched.size));
    pthread_t reader;
    assert_int_equal(pthread_create(&reader, NULL, watch_output, &watched), 0);
    for (int i = 0; i < 20; i++)
        EXPECT_TOOL(0, "check", model.text, cache.text, "--json", json.text, "--quiet");
    atomic_store(&watched.ends, true);
    pthread_join(reader, NULL);
    print_message("read %d times: %d times missing, %d times in part\n", watched.reads, watched.missing,
                  watched.partial);
    assert_true(watched.reads > 20 && watched.missing == 0 && watched.partial == 0);
    temp_folder_remove(&folder);
}

/* As a page that a browser shows: it keeps nobody from writing the next one, and stays as it was. */
TEST(an_open_output_is_replaced) {
    static const char older[] = "what was there";
    char kept[64] = "";
    const temp_folder folder = temp_folder_make();
    const temp_path model = recorded_write_mesh(&folder, "pair.obj", &scene, 0);
    const temp_path json = temp_file_write(&folder, "out.json", older, strlen(older));
    FILE *reader = fopen(json.text, "rb");
    assert_non_null(reader);
    EXPECT_TOOL(0, "check", model.text, "--json", json.text, "--quiet");
    json_node_free(json_node_read_file(json.text));
    assert_int_equal(fread(kept, 1, sizeof kept - 1, reader), strlen(older));
    assert_string_equal(kept, older);
    fclose(reader);
    temp_folder_remove(&folder);
}

AROUND_ALL(make_scene, free_scene)
