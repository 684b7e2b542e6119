/* Sets of object pairs, those of warnings and those of contacts, so that they can be compared. */
#pragma once

#include "cscd/cscd.h"
#include "cscd/sensors.h"
#include "tool/io/io.h"

typedef struct object_pairs {
    growable keys; /* of uint64_t: the smaller object, then the larger; ascending once closed */
} object_pairs;

object_pairs object_pairs_none(void);
void object_pairs_free(object_pairs *pairs);
void object_pairs_clear(object_pairs *pairs);
bool object_pairs_add(object_pairs *pairs, uint32_t a, uint32_t b);

/* Sorts, and leaves each pair once. */
void object_pairs_close(object_pairs *pairs);
uint32_t object_pairs_count(const object_pairs *pairs);

/* Returns the number of pairs that both have; both are closed. */
uint32_t object_pairs_common(const object_pairs *a, const object_pairs *b);

/* The object and the part of every vertex; UINT32_MAX for a vertex without a triangle. */
typedef struct object_map {
    uint32_t *objects, *parts;
} object_map;

bool object_map_make(const cscd_mesh *mesh, const cscd_sensors *sensors, object_map *out);
void object_map_free(object_map *map);

/* Makes the closed set of object pairs of contacts. With `within`, an object also counts as a pair with
 * itself, if the first vertices of the two features belong to different parts. False when out of memory. */
bool object_pairs_of_contacts(const cscd_mesh *mesh, const object_map *map, const cscd_contacts *contacts,
                              bool within, object_pairs *out);

/* Makes the closed set of object pairs of warnings; confirmed_only: of those whose exact check has found a
 * contact. */
bool object_pairs_of_warnings(const cscd_warnings *warnings, bool confirmed_only, object_pairs *out);
