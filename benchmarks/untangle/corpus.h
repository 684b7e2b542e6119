/* The scenes that benchmarks/untangle tries, each with its class: made here, and read from recordings. */
#pragma once

#include "benchmarks/untangle/tangle_scene.h"

typedef struct corpus_entry {
    char name[40];
    tangle_class class;
    bool held_out;           /* nothing is tuned to it */
    bool large;              /* about 100,000 triangles */
    bool quick;              /* one of a few */
    tangle_maker *make;      /* NULL: it is read from files */
    uint32_t triangle_count; /* that are asked for */
    uint32_t seed;
    const char *folder, *kind; /* where recordings are, and the folder in it */
} corpus_entry;

const char *tangle_class_name(tangle_class class);
const char *tangle_class_title(tangle_class class);

/* The class of that name; false: there is none. */
bool tangle_class_from_name(const char *name, tangle_class *out);

typedef struct corpus {
    corpus_entry *entries;
    uint32_t count, capacity;
} corpus;

/* Lists the scenes in the order of classes. Recordings of ours are files in `models`; `data` is the folder of recordings
 * that are not part of the repository, or NULL. What is missing is left out, with a sentence on stdout. */
corpus corpus_list(const char *models, const char *data);
void corpus_free(corpus *c);

bool corpus_open(const corpus_entry *entry, tangle_scene *out, io_error *error);
