/* Sets of objects, as the traversal sees them: can two sets hold a pair of objects that is looked at? */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* In place of an object: triangles of more than one. */
#define OBJECT_SEVERAL UINT32_MAX

/* In place of an object: it has not been looked for. */
#define OBJECT_UNKNOWN (UINT32_MAX - 1)

/* Categories of the library's own, beside those of the caller. Obstacles are looked at with free objects only, unless
 * both of them ask for each other. */
enum { OBJECT_FREE = 1, OBJECT_OBSTACLE = 2, OBJECT_ASKING_OBSTACLE = 4 };

/* A set of one object or more. What the set says holds for some of its objects. */
typedef struct object_set {
    uint64_t categories,
        masks; /* of the caller; two objects are looked at if each one's category is in both masks */
    uint8_t kinds, kinds_sought; /* the same of the library; who seeks a kind is sought by it */
    bool self;                   /* an object is looked at with itself */
    uint32_t first, last;        /* the least and the greatest object */
} object_set;

/* Do sets of one object say the same of it? */
static inline bool object_sets_are_alike(const object_set *a, const object_set *b) {
    return a->categories == b->categories && a->masks == b->masks && a->kinds == b->kinds &&
           a->kinds_sought == b->kinds_sought && a->self == b->self;
}

static inline object_set object_sets_join(const object_set *a, const object_set *b) {
    return (object_set){.categories = a->categories | b->categories,
                        .masks = a->masks | b->masks,
                        .kinds = a->kinds | b->kinds,
                        .kinds_sought = a->kinds_sought | b->kinds_sought,
                        .self = a->self || b->self,
                        .first = a->first < b->first ? a->first : b->first,
                        .last = a->last > b->last ? a->last : b->last};
}

/* Is an object of a looked at with one of b? Exact for sets of one object each; of larger sets it may be said of two
 * that hold no such pair. */
static inline bool object_sets_may_meet(const object_set *a, const object_set *b) {
    if (a->first <= b->last && b->first <= a->last) {
        if (a->self && b->self) return true;
        if (a->first == b->last && a->last == b->first) return false; /* one object and itself */
    }
    return (a->categories & b->masks) != 0 && (b->categories & a->masks) != 0 &&
           (a->kinds & b->kinds_sought) != 0;
}
