/* Prints all frames of a glTF file as the tool reads them: FILE FPS [ANIMATION]. First a line with the numbers of vertices,
 * parts and frames; then the name of each part; then the part of each vertex; then a line for each frame: its number, and its
 * coordinates with 17 digits. */
#include "tool/io/animation.h"
#include "tool/io/mesh_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static bool print_frame(animation *frames, uint32_t frame, uint32_t vertex_count, double *positions,
                        io_error *error) {
    if (!animation_read(frames, frame, positions, error)) return false;
    printf("%" PRId32, animation_frame_number(frames, frame));
    for (size_t i = 0; i < 3 * (size_t)vertex_count; i++) printf(" %.17g", positions[i]);
    printf("\n");
    return true;
}

static bool print_parts(const mesh_file *mesh) {
    uint32_t *of_vertex = calloc(mesh->vertex_count, sizeof *of_vertex);
    if (of_vertex == NULL) return false;
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        of_vertex[mesh->triangles[i]] = mesh->parts.of_triangle[i / 3];
    for (uint32_t i = 0; i < mesh->parts.count; i++) printf("%s\n", mesh->parts.names[i]);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) printf("%" PRIu32 " ", of_vertex[i]);
    printf("\n");
    free(of_vertex);
    return true;
}

int main(int argument_count, char **arguments) {
    mesh_file mesh = {0};
    animation *frames = NULL;
    io_error error;
    if (argument_count < 3) return 2;
    const char *path = arguments[1];
    const animation_options options = {.fps = strtod(arguments[2], NULL),
                                       .animation_name = argument_count > 3 ? arguments[3] : NULL};
    bool done = mesh_file_read(path, &mesh, &error) &&
                animation_open(&path, 1, mesh.vertex_count, &options, &frames, &error);
    const uint32_t count = done ? animation_frame_count(frames) : 0;
    double *positions = done ? malloc(3 * sizeof *positions * mesh.vertex_count) : NULL;
    if (done && positions != NULL) {
        printf("%" PRIu32 " %" PRIu32 " %" PRIu32 "\n", mesh.vertex_count, mesh.parts.count, count);
        done = print_parts(&mesh);
    }
    for (uint32_t frame = 0; done && positions != NULL && frame < count; frame++)
        done = print_frame(frames, frame, mesh.vertex_count, positions, &error);
    if (!done) fprintf(stderr, "%s\n", error.text);
    free(positions);
    animation_close(frames);
    mesh_file_free(&mesh);
    return done && fflush(stdout) == 0 ? 0 : 1;
}
