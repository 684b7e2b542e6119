/* Lists of jobs: what their lines may say, and which shard has which job. */
#include "tests/support/files.h"
#include "tests/support/random.h"
#include "tests/support/test.h"
#include "tool/jobs/job_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- lines ----------------------------------------------------------------------------------------------- */

static void expect_option(const job_line *line, size_t i, const char *name, const char *value) {
    assert_true(i < line->option_count);
    assert_string_equal(line->options[i].name, name);
    if (value == NULL)
        assert_null(line->options[i].value);
    else
        assert_string_equal(line->options[i].value, value);
}

TEST(a_line_says_all) {
    static const char text[] =
        "{\"model\": \"a b.obj\", \"frames\": [\"f1.obj\", \"f2.obj\"], \"name\": \"shot 41\", "
        "\"size\": 1200, \"parts\": \"p.csv\", \"options\": {\"fps\": 24, \"weld\": 0.125, "
        "\"allow-gaps\": true, \"quiet\": false, \"unit\": null, \"only\": [\"A\", \"B,C\"]}, "
        "\"outputs\": {\"json\": \"o\\u00e4.json\"}}";
    job_line line;
    io_error error;
    if (!job_line_read(text, strlen(text), &line, &error)) fail_msg("%s", error.text);
    assert_string_equal(line.name, "shot 41");
    assert_int_equal(line.input_count, 3);
    assert_string_equal(line.inputs[0], "a b.obj");
    assert_string_equal(line.inputs[1], "f1.obj");
    assert_string_equal(line.inputs[2], "f2.obj");
    assert_int_equal(line.size, 1200);
    assert_int_equal(line.option_count, 7);
    expect_option(&line, 0, "parts", "p.csv");
    expect_option(&line, 1, "fps", "24");
    expect_option(&line, 2, "weld", "0.125");
    expect_option(&line, 3, "allow-gaps", NULL);
    expect_option(&line, 4, "only", "A");
    expect_option(&line, 5, "only", "B,C");
    expect_option(&line, 6, "json", "o\xc3\xa4.json");
    job_line_free(&line);
}

TEST(a_model_is_enough) {
    static const char text[] = " {\"model\":\"a.glb\",\"frames\":\"a.glb\"}\r";
    job_line line;
    assert_true(job_line_read(text, strlen(text), &line, NULL));
    assert_string_equal(line.name, "a.glb");
    assert_int_equal(line.input_count, 2);
    assert_true(line.size == NO_JOB_SIZE);
    assert_int_equal(line.option_count, 0);
    job_line_free(&line);
}

TEST(wrong_lines_say_what_is_wrong) {
    static char many_objects[8000];
    for (int k = 0; k < 2000; k++) strcat(many_objects, k == 0 ? "[{}" : ",{}");
    const struct {
        const char *text, *error;
    } wrong[] = {
        {"{\"model\": \"a.obj\"", "the line ends too early"},
        {"{\"model\": \"a.obj\",}", "no valid JSON at character 19"},
        {"{\"model\": \"a.obj\"} x", "no valid JSON at character 20"},
        {"[\"a.obj\"]", "a job must be an object"},
        {many_objects, "more objects than one in ten bytes"},
        {"7", "a job must be an object"},
        {"null", "a job must be an object"},
        {"{\"modle\": \"a.obj\"}", "'modle' is no member of a job"},
        {"{}", "a job needs a 'model'"},
        {"{\"model\": null}", "a job needs a 'model'"},
        {"{\"model\": \"\"}", "'model' is empty"},
        {"{\"model\": 7}", "'model' must be the name of a file"},
        {"{\"model\": [\"a.obj\", \"b.obj\"]}", "'model' must be the name of a file"},
        {"{\"model\": \"a\\u0000b\"}", "'model' has a character 0"},
        {"{\"model\": \"a.obj\", \"name\": true}", "'name' must be a text or a number"},
        {"{\"frames\": \"a.pc2\", \"name\": \"x\"}", "'frames' need a 'model'"},
        {"{\"model\": \"a.obj\", \"frames\": [1]}", "'frames' must be the name of a file"},
        {"{\"model\": \"a.obj\", \"size\": -1}", "'size' must be a whole number"},
        {"{\"model\": \"a.obj\", \"size\": 1.5}", "'size' must be a whole number"},
        {"{\"model\": \"a.obj\", \"size\": 1000000000001}", "'size' must be a whole number"},
        {"{\"model\": \"a.obj\", \"options\": [\"--weld\"]}", "'options' must be an object"},
        {"{\"model\": \"a.obj\", \"options\": {\"weld\": {}}}", "'weld' must be a text or a number"},
        {"{\"model\": \"a.obj\", \"outputs\": \"a.json\"}", "'outputs' must be an object"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        job_line line;
        io_error error = {""};
        if (job_line_read(wrong[i].text, strlen(wrong[i].text), &line, &error))
            fail_msg("read: %s", wrong[i].text);
        if (strstr(error.text, wrong[i].error) == NULL) fail_msg("%s: %s", wrong[i].text, error.text);
    }
}

/* A line is a part of a text, and what follows it is not read. */
TEST(a_line_ends_where_it_ends) {
    static const char text[] = "{\"model\": \"a.obj\"}garbage";
    job_line line;
    assert_true(job_line_read(text, 18, &line, NULL));
    job_line_free(&line);
    assert_false(job_line_read(text, 17, &line, NULL));
}

/* ---- lists ----------------------------------------------------------------------------------------------- */

static temp_path write_list(const char *text) {
    return temp_file_write(&own_folder, "jobs.jsonl", text, strlen(text));
}

TEST(blank_lines_hold_no_job) {
    io_error error;
    job_list list;
    job_line line;
    temp_path path = write_list("\n{\"model\": \"a.obj\", \"size\": 3}\r\n  \n\t{\"model\": \"b.obj\"}");
    if (!job_list_read(path.text, &list, &error)) fail_msg("%s", error.text);
    assert_int_equal(list.count, 2);
    assert_int_equal(list.jobs[0].size, 3);
    assert_true(list.jobs[1].size == NO_JOB_SIZE);
    assert_int_equal(list.jobs[1].line, 4);
    assert_true(job_list_line(&list, 1, &line, &error));
    assert_string_equal(line.name, "b.obj");
    job_line_free(&line);
    job_list_free(&list);
}

TEST(faults_name_their_line) {
    static const struct {
        const char *text, *error;
    } wrong[] = {{"{\"model\": \"a.obj\"}\n\n{\"model\": 3}\n", "jobs.jsonl:3: 'model' must be the name"},
                 {"{\"model\": \"a.obj\"}\n{\"mod", "jobs.jsonl:2: no valid JSON"},
                 {"", "there is no job in the list"},
                 {" \n\n", "there is no job in the list"}};
    io_error error;
    job_list list;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        temp_path path = write_list(wrong[i].text);
        assert_false(job_list_read(path.text, &list, &error));
        if (strstr(error.text, wrong[i].error) == NULL) fail_msg("%s", error.text);
    }
    assert_false(job_list_read("/nowhere/jobs.jsonl", &list, &error));
    assert_non_null(strstr(error.text, "/nowhere/jobs.jsonl: cannot open"));
}

/* Any other text is another list, and so are other names or the same in another order. */
TEST(hashes_tell_lists_apart) {
    static const char *const names[][3] = {
        {"a", "b", "c"}, {"a", "c", "b"}, {"ab", "", "c"}, {"a", "b", "d"}};
    job_list lists[4];
    io_error error;
    for (int i = 0; i < 4; i++) assert_true(job_list_of_names(names[i], 3, &lists[i], &error));
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < i; k++) assert_true(lists[i].hash != lists[k].hash);
    for (int i = 0; i < 4; i++) job_list_free(&lists[i]);
    uint64_t before = 0;
    static const char *const texts[] = {"{\"model\": \"a\"}\n", "{\"model\": \"a\"}", "{\"model\": \"b\"}\n"};
    for (int i = 0; i < 3; i++) {
        temp_path path = write_list(texts[i]);
        assert_true(job_list_read(path.text, &lists[0], &error));
        assert_true(lists[0].hash != before);
        before = lists[0].hash;
        job_list_free(&lists[0]);
    }
}

/* ---- shards ---------------------------------------------------------------------------------------------- */

enum { JOBS_MAX = 200 };

static job_list list_of_sizes(listed_job *jobs, const uint64_t *sizes, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) jobs[i] = (listed_job){.size = sizes[i]};
    return (job_list){.jobs = jobs, .count = count};
}

/* Puts the shard of each job, from 1, into `shards`; each job must have one. */
static void find_shards(const job_list *list, uint32_t shard_count, uint32_t *shards) {
    memset(shards, 0, list->count * sizeof *shards);
    for (uint32_t s = 1; s <= shard_count; s++) {
        uint32_t *jobs, count;
        assert_true(job_shard_choose(list, (shard_choice){s, shard_count}, &jobs, &count, NULL));
        for (uint32_t i = 0; i < count; i++) {
            assert_true(i == 0 || jobs[i] > jobs[i - 1]);
            assert_int_equal(shards[jobs[i]], 0);
            shards[jobs[i]] = s;
        }
        free(jobs);
    }
    for (uint32_t i = 0; i < list->count; i++) assert_true(shards[i] > 0);
}

TEST(jobs_without_a_size_go_round) {
    uint64_t sizes[10];
    uint32_t shards[10];
    listed_job jobs[10];
    for (int i = 0; i < 10; i++) sizes[i] = NO_JOB_SIZE;
    job_list list = list_of_sizes(jobs, sizes, 10);
    find_shards(&list, 3, shards);
    for (uint32_t i = 0; i < 10; i++) assert_int_equal(shards[i], i % 3 + 1);
    uint32_t *all, count;
    assert_true(job_shard_choose(&list, (shard_choice){0, 0}, &all, &count, NULL));
    assert_int_equal(count, 10);
    free(all);
}

/* By hand: 9 to 1, 7 to 2, 5 to 3, then 4 to 3 (9), 3 to 2 (10), 2 to 1 (11), 2 to 3; the one without a size is the third. */
TEST(the_largest_goes_to_the_least) {
    static const uint64_t sizes[] = {2, 4, NO_JOB_SIZE, 9, 5, 2, 7, 3};
    static const uint32_t expected[] = {1, 3, 3, 1, 3, 3, 2, 2};
    uint32_t shards[8];
    listed_job jobs[8];
    job_list list = list_of_sizes(jobs, sizes, 8);
    find_shards(&list, 3, shards);
    for (uint32_t i = 0; i < 8; i++) assert_int_equal(shards[i], expected[i]);
}

/* Graham's bound: no shard has more than the mean and the largest job together; and never one without work beside one with two jobs. */
TEST(random_lists_are_balanced) {
    random_stream random = stream_start(11);
    uint64_t sizes[JOBS_MAX];
    uint32_t shards[JOBS_MAX];
    listed_job jobs[JOBS_MAX];
    for (int trial = 0; trial < 300; trial++) {
        const uint32_t count = 1 + stream_below(&random, JOBS_MAX),
                       shard_count = 1 + stream_below(&random, 40);
        uint64_t loads[41] = {0}, sum = 0, largest = 0, most = 0;
        for (uint32_t i = 0; i < count; i++) {
            sizes[i] = trial % 3 == 0 ? stream_below(&random, 4) : 1 + stream_below(&random, 1000000);
            if (trial % 3 == 1 && i % 9 == 0) sizes[i] = JOB_SIZE_MAX;
            sum += sizes[i];
            if (sizes[i] > largest) largest = sizes[i];
        }
        job_list list = list_of_sizes(jobs, sizes, count);
        find_shards(&list, shard_count, shards);
        for (uint32_t i = 0; i < count; i++) loads[shards[i]] += sizes[i];
        for (uint32_t s = 1; s <= shard_count; s++) most = loads[s] > most ? loads[s] : most;
        assert_true((double)most <= (double)sum / shard_count + (double)largest);
    }
}

TEST(shards_are_read) {
    static const char *const wrong[] = {
        "",   "1",    "/",     "0/3",  "4/3",  "1/0",       "1/",
        "/3", "-1/3", "1/3/4", "1/3x", " 1/3", "1/1000001", "99999999999999999999/3"};
    shard_choice shard = {0, 0};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (read_shard(wrong[i], &shard)) fail_msg("'%s' was read", wrong[i]);
    assert_int_equal(shard.count, 0);
    assert_true(read_shard("3/3", &shard));
    assert_int_equal(shard.index, 3);
    assert_int_equal(shard.count, 3);
    assert_true(read_shard("1/1000000", &shard));
}

AROUND_ALL(own_folder_make, own_folder_remove)
