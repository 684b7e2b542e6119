/* Colours: between sRGB bytes and linear light, and the map from numbers to colours. */
#pragma once

#include <stdint.h>

#define PICTURE_ENCODE_STEPS 4096

/* Tables for both directions; light is added and averaged in linear values. */
typedef struct picture_gamma {
    float linear[256];
    uint8_t encoded[PICTURE_ENCODE_STEPS + 1];
} picture_gamma;

void picture_gamma_set(picture_gamma *out);

/* linear is clamped to 0..1. */
uint8_t picture_gamma_encode(const picture_gamma *gamma, double linear);

/* A perceptually uniform map (viridis) from dark violet at 0 over green to yellow at 1; value is clamped. */
void picture_colour_map(double value, uint8_t rgb[3]);

/* One of 21 distinct colours, the first seven the most; those of index and index + 21 are the same. */
void picture_colour_category(uint32_t index, uint8_t rgb[3]);
