/* Mesh files: devices, pipes, long paths, counts up to the limits, garbage, and writing OBJ. */
#include "tests/support/files.h"
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"
#include "tool/io/file_reader.h"
#include "tool/io/io.h"
#include "tool/io/mesh_builder.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#define SQUARE_OFF "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"

static void check_unreadable(const char *path, const char *found) {
    mesh_file mesh = {0};
    io_error error = {""};
    assert_false(mesh_file_read(path, &mesh, &error));
    assert_non_null(strstr(error.text, found));
    assert_null(mesh.positions);
    assert_false(mesh_file_read(path, &mesh, NULL));
}

TEST(refuses_what_is_no_file) {
    check_unreadable("/dev/zero", "/dev/zero: is a device, expected a file");
#ifdef __linux__
    check_unreadable("/proc/self/mem", "/proc/self/mem: cannot read: "); /* nothing is at its address 0 */
#endif
}

TEST(keeps_messages_on_one_line) {
    io_error error = {""};
    mesh_file mesh;
    char path[3000];
    memset(path, 'a', sizeof path);
    memcpy(path + sizeof path - 12, "\nend/end.obj", 13 - 1);
    path[sizeof path - 1] = '\0';
    assert_false(mesh_file_read(path, &mesh, &error));
    assert_memory_equal(error.text, "...aaaa", 7);
    assert_non_null(strstr(error.text, "a?end/end.ob: cannot open: "));
}

/* A pipe does not say how much it will give. */
TEST(reads_pipes) {
    int ends[2];
    char path[64], bytes[20000];
    io_error error = {""};
    mesh_file mesh = {0};
    memset(bytes, '\n', sizeof bytes);
    memcpy(bytes, SQUARE_OFF, sizeof SQUARE_OFF - 1);
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(write(ends[1], bytes, sizeof bytes), sizeof bytes);
    close(ends[1]);
    snprintf(path, sizeof path, "/dev/fd/%d", ends[0]);
    bool done = mesh_file_read(path, &mesh, &error);
    close(ends[0]);
    assert_string_equal(error.text, "");
    assert_true(done);
    assert_int_equal(mesh.triangle_count, 2);
    mesh_file_free(&mesh);
}

TEST(frees_zeroed_meshes) {
    mesh_file mesh = {0};
    mesh_file_free(&mesh);
    mesh_file_free(&mesh);
    assert_null(mesh.positions);
}

TEST(grows_only_to_sizes_that_exist) {
    growable array = growable_of(24);
    assert_false(growable_reserve(&array, SIZE_MAX / 24 + 1));
    assert_false(growable_reserve(&array, SIZE_MAX));
    assert_true(array.data == NULL && array.capacity == 0);
    array.count = array.capacity = SIZE_MAX / 24; /* as if it were full; its data is not touched */
    assert_null(growable_push(&array));
    assert_int_equal(array.count, SIZE_MAX / 24);
}

TEST(counts_up_to_the_limit) {
    io_error error = {""};
    file_reader reader = {.path = "big.obj", .error = &error, .line = 12};
    mesh_builder builder = mesh_builder_of(&reader, 1);
    builder.triangle_count = MESH_COUNT_LIMIT; /* as if there were so many */
    assert_true(mesh_builder_begin_face(&builder));
    for (uint32_t corner = 0; corner < 3; corner++) assert_true(mesh_builder_add_corner(&builder, corner));
    assert_false(mesh_builder_end_face(&builder));
    assert_string_equal(error.text, "big.obj:12: more than 2147483647 triangles, the most of a mesh");
    builder.positions.count = MESH_COUNT_LIMIT;
    assert_false(mesh_builder_add_vertex(&builder, (double[]){0, 0, 0}));
    assert_string_equal(error.text, "big.obj:12: more than 2147483647 vertices, the most of a mesh");
    mesh_builder_free(&builder);
}

TEST(parses_integers_up_to_18_digits) {
    int64_t value = 0;
    assert_true(text_parse_integer((text_token){"-999999999999999999", 19}, &value));
    assert_int_equal(value, -999999999999999999);
    assert_false(text_parse_integer((text_token){"1000000000000000000", 19}, &value));
    assert_false(text_parse_integer((text_token){"", 0}, &value));
    assert_false(text_parse_integer((text_token){"1 2", 3}, &value));
}

/* A xorshift generator: the same garbage in every run. */
static uint64_t next_random(uint64_t *random) {
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    return *random;
}

TEST(survives_garbage) {
    static const char *const names[] = {"a.obj", "a.off", "a.ply", "a"};
    static const char *const starts[] = {"", "OFF\n", "ply\nformat binary_big_endian 1.0\nelement vertex 3\n",
                                         "f v "};
    static const char alphabet[] = "0123 4567\n89-.\rvf e/\\#n+xlist";
    uint64_t random = 88172645463325252u;
    for (int i = 0; i < 4000; i++) {
        char bytes[512];
        const char *start = starts[i / 4 % 4];
        size_t used = strlen(start), size = used + next_random(&random) % (sizeof bytes - used);
        memcpy(bytes, start, used);
        for (size_t j = used; j < size; j++) {
            uint64_t r = next_random(&random);
            bytes[j] = (char)(i % 3 == 0 ? r & 0xff : (uint64_t)alphabet[r % (sizeof alphabet - 1)]);
        }
        mesh_check_survives((file_bytes){names[i % 4], bytes, size});
    }
}

TEST(writes_what_it_reads) {
    double positions[] = {0.1, -1.0 / 3, 1e-300, 4.9406564584124654e-324, 1.7976931348623157e308, -0.0,
                          3,   2,        1};
    uint32_t triangles[] = {0, 1, 2, 2, 1, 0};
    mesh_file mesh = mesh_file_of(3, 2, positions, triangles), again = {0};
    io_error error = {""};
    temp_folder folder = temp_folder_make();
    temp_path path = temp_file_path(&folder, "out.obj");
    assert_true(mesh_file_write_obj(path.text, &mesh, &error));
    assert_true(mesh_file_read(path.text, &again, &error));
    temp_folder_remove(&folder);
    assert_string_equal(error.text, "");
    assert_int_equal(again.vertex_count, 3);
    assert_int_equal(again.triangle_count, 2);
    assert_memory_equal(again.positions, positions, sizeof positions);
    assert_memory_equal(again.triangles, triangles, sizeof triangles);
    mesh_file_free(&again);
}

static double some_positions[3000];
static uint32_t some_triangles[3000];
static const mesh_file some_mesh = {
    .vertex_count = 1000, .triangle_count = 1, .positions = some_positions, .triangles = some_triangles};
static const mesh_file many_triangles = {
    .vertex_count = 1, .triangle_count = 1000, .positions = some_positions, .triangles = some_triangles};

TEST(reports_where_it_cannot_write) {
    struct stat status;
    io_error error = {""};
    temp_folder folder = temp_folder_make();
    assert_false(mesh_file_write_obj(temp_file_path(&folder, "none/a.obj").text, &some_mesh, &error));
    assert_non_null(strstr(error.text, "none/a.obj: cannot open for writing: No such file"));
    assert_false(mesh_file_write_obj(folder.path, &some_mesh, &error));
    assert_non_null(strstr(error.text, ": cannot open for writing: Is a directory"));
    assert_false(mesh_file_write_obj("/dev/full", &some_mesh, &error));
    assert_string_equal(error.text, "/dev/full: cannot write: No space left on device");
    assert_false(mesh_file_write_obj("/dev/full", &many_triangles, &error));
    assert_string_equal(error.text, "/dev/full: cannot write: No space left on device");
    assert_int_equal(stat("/dev/full", &status), 0); /* it removes files only */
    temp_folder_remove(&folder);
}

/* What was there before stays. */
TEST(leaves_nothing_that_it_cannot_finish) {
    struct rlimit before, limit;
    struct stat status;
    io_error error = {""};
    temp_folder folder = temp_folder_make();
    temp_path path = temp_file_path(&folder, "out.obj");
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    limit = before;
    limit.rlim_cur = 5000;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    bool done = mesh_file_write_obj(path.text, &some_mesh, &error);
    const bool gone = stat(path.text, &status) != 0;
    path = temp_file_write(&folder, "out.obj", "older", 5);
    done = mesh_file_write_obj(path.text, &some_mesh, NULL) || done;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, handler);
    assert_false(done);
    assert_non_null(strstr(error.text, "/out.obj: cannot write: File too large"));
    assert_true(gone);
    assert_int_equal(stat(path.text, &status), 0);
    assert_int_equal(status.st_size, 5);
    temp_folder_remove(&folder);
}
