/* Meshes that are hard to solve for charges. */
#pragma once

#include "models/shapes/body.h"
#include "tool/io/io.h"

enum { HARD_CONDUCTORS = 16 };

/* To be freed by body_free(&c->body). */
typedef struct hard_conductor {
    char name[48];
    body body;
    double capacitance; /* of all components together, about; NAN: not known */
} hard_conductor;

bool hard_conductor_make(uint32_t index, hard_conductor *out, io_error *error);
