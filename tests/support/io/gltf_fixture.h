/* Small glTF files, written piece by piece: accessors with their numbers, and the rest as text. */
#pragma once

#include "tests/support/io/mesh_check.h"

#include <stddef.h>
#include <stdint.h>

/* One buffer, its views and its accessors. A zeroed struct is an empty one. */
typedef struct gltf_fixture {
    unsigned char bytes[4096];
    size_t size;
    int view_count, accessor_count;
    char views[4096], accessors[4096];
    char file[16384];
    size_t file_size;
} gltf_fixture;

/* Appends numbers to the buffer in this component type (5120 to 5126) and a view of them; gives the number of the view. */
int gltf_fixture_view(gltf_fixture *fixture, int component, size_t count, const double *numbers);

/* Appends an accessor with this JSON; gives its number. */
int gltf_fixture_accessor(gltf_fixture *fixture, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Both at once: elements of a type such as "VEC3" and so many numbers in all. */
int gltf_fixture_array(gltf_fixture *fixture, int component, const char *type, size_t count,
                       const double *numbers);

/* Whole files; the rest is the JSON behind "asset": nodes, meshes, scenes. They share the fixture's memory: one at a time. */
file_bytes gltf_fixture_glb(gltf_fixture *fixture, const char *rest);
file_bytes gltf_fixture_embedded(gltf_fixture *fixture, const char *rest);
/* The buffer is at this URI. */
file_bytes gltf_fixture_separate(gltf_fixture *fixture, const char *rest, const char *uri);
