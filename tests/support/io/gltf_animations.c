/* glTF files with animations of one triangle. */
#include "tests/support/io/gltf_animations.h"

#include <stdio.h>

const double gltf_animations_triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/* Accessor 0: the triangle; 1: times; 2: values; 3 and 4: targets that move vertex 1 along y, and vertex 2 along z. */
file_bytes gltf_animations_channel(gltf_fixture *fixture, gltf_channel_keys keys) {
    static const double along_y[] = {0, 0, 0, 0, 1, 0, 0, 0, 0}, along_z[] = {0, 0, 0, 0, 0, 0, 0, 0, 1};
    char rest[1024];
    *fixture = (gltf_fixture){0};
    gltf_fixture_array(fixture, 5126, "VEC3", 9, gltf_animations_triangle);
    gltf_fixture_array(fixture, 5126, "SCALAR", keys.time_count, keys.times);
    gltf_fixture_array(fixture, 5126, keys.type, keys.value_count, keys.values);
    gltf_fixture_array(fixture, 5126, "VEC3", 9, along_y);
    gltf_fixture_array(fixture, 5126, "VEC3", 9, along_z);
    snprintf(
        rest, sizeof rest,
        "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{"
        "\"POSITION\":3},{\"POSITION\":4}]}]}],\"animations\":[{\"name\":\"Walk\",\"samplers\":[{\"input\":1,"
        "\"output\":2,\"interpolation\":\"%s\"}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":"
        "\"%s\"}}]}]",
        keys.interpolation, keys.path);
    return gltf_fixture_glb(fixture, rest);
}

file_bytes gltf_animations_two(gltf_fixture *fixture, const char *channels_of_a) {
    static const double two[] = {0, 2}, half[] = {0.5, 1}, moves[] = {0, 0, 0, 8, 0, 0},
                        scales[] = {1, 1, 1, 3, 3, 3};
    char rest[1500];
    *fixture = (gltf_fixture){0};
    gltf_fixture_array(fixture, 5126, "VEC3", 9, gltf_animations_triangle);
    gltf_fixture_array(fixture, 5126, "SCALAR", 2, two);
    gltf_fixture_array(fixture, 5126, "SCALAR", 2, half);
    gltf_fixture_array(fixture, 5126, "VEC3", 6, moves);
    gltf_fixture_array(fixture, 5126, "VEC3", 6, scales);
    snprintf(
        rest, sizeof rest,
        "\"nodes\":[{\"mesh\":0},{\"children\":[0],\"translation\":[0,5,0]},{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"animations\":[{\"name\":\"A\",\"samplers\":[{"
        "\"input\":1,\"output\":3},{\"input\":2,\"output\":4}],\"channels\":[%s]},{\"name\":\"B\",\"samplers\":[{\"input\":2,"
        "\"output\":3}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}]}]",
        channels_of_a);
    return gltf_fixture_glb(fixture, rest);
}
