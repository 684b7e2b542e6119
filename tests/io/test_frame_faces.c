/* Frames from mesh files must have the faces of each other, and of a model that has as many. */
#include "src/io/animation.h"
#include "src/io/mesh_file.h"
#include "tests/support/io/frame_fixture.h"
#include "tests/support/test.h"

#include <string.h>

#define VERTICES "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static const char quad[] = VERTICES "f 1 2 3 4\n", turned[] = VERTICES "f 2 3 4 1\n",
                  split[] = VERTICES "f 1 2 3\nf 1 3 4\n", other_split[] = VERTICES "f 1 2 4\nf 2 3 4\n";

/* Reads the two frames of a model; complaint: what the error says, NULL when there is none. */
static void check_faces(const char *model, const char *first, const char *second, const char *complaint) {
    const temp_path paths[] = {temp_file_write(&frame_fixture_folder, "model.obj", model, strlen(model)),
                               temp_file_write(&frame_fixture_folder, "s1.obj", first, strlen(first)),
                               temp_file_write(&frame_fixture_folder, "s2.obj", second, strlen(second))};
    const char *const frames[] = {paths[1].text, paths[2].text};
    mesh_file mesh;
    io_error error = {""};
    animation *opened;
    double positions[12];
    assert_true(mesh_file_read(paths[0].text, &mesh, &error));
    const animation_options options = {.model_face_count = mesh.polygon_count,
                                       .model_faces_hash = mesh.faces_hash};
    assert_true(animation_open(frames, 2, mesh.vertex_count, &options, &opened, &error));
    const bool read =
        animation_read(opened, 0, positions, &error) && animation_read(opened, 1, positions, &error);
    if (read != (complaint == NULL) || (complaint != NULL && strstr(error.text, complaint) == NULL))
        fail_msg("expected '%s': %s", complaint != NULL ? complaint : "no error", error.text);
    animation_close(opened);
    mesh_file_free(&mesh);
}

/* What shape a face has in a frame plays no part: in the second one it is concave. */
TEST(same_faces_are_read) {
    const char *dart = "v 0 0 1\nv 0.9 0.8 1\nv 1 1 1\nv 0 1 1\nf 1 2 3 4\n";
    check_faces(quad, quad, dart, NULL);
    check_faces(split, quad, dart, NULL); /* the model is triangulated, the frames are not */
    check_faces(quad, split, split, NULL);
}

TEST(other_faces_are_refused) {
    check_faces(quad, turned, turned, "s1.obj: has other faces than the model, though as many");
    check_faces(quad, quad, split, "s2.obj: has other faces than");
    check_faces(quad, split, other_split, "export without triangulating");
    check_faces(split, other_split, other_split, "export without triangulating");
}

AROUND_EACH(frame_fixture_make_folder, frame_fixture_remove_folder)
