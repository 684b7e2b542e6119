/* sRGB transfer tables and the colour map for scalar fields. */
#include "tool/picture/colour.h"

#include <math.h>

/* The transfer functions of IEC 61966-2-1. */
static double decode_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

static double encode_srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

void picture_gamma_set(picture_gamma *out) {
    for (int i = 0; i < 256; i++) out->linear[i] = (float)decode_srgb(i / 255.0);
    for (int i = 0; i <= PICTURE_ENCODE_STEPS; i++)
        out->encoded[i] = (uint8_t)(255.0 * encode_srgb((double)i / PICTURE_ENCODE_STEPS) + 0.5);
}

uint8_t picture_gamma_encode(const picture_gamma *gamma, double linear) {
    if (!(linear > 0.0)) return 0;
    return gamma->encoded[linear < 1.0 ? (int)(linear * PICTURE_ENCODE_STEPS + 0.5) : PICTURE_ENCODE_STEPS];
}

/* Viridis (Smith and van der Walt, 2015, in the public domain) at every eighth; linear between is not told
 * apart by the eye. */
static const uint8_t viridis[9][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                      {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                      {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};

void picture_colour_map(double value, uint8_t rgb[3]) {
    double place = 8.0 * (value > 0.0 ? fmin(value, 1.0) : 0.0);
    int lower = place < 7.0 ? (int)place : 7;
    double share = place - lower;
    for (int i = 0; i < 3; i++)
        rgb[i] = (uint8_t)(viridis[lower][i] * (1.0 - share) + viridis[lower + 1][i] * share + 0.5);
}

/* The colours of Okabe and Ito (2008), told apart with any colour vision; then the same lighter, and
 * darker. */
void picture_colour_category(uint32_t index, uint8_t rgb[3]) {
    static const uint8_t hues[7][3] = {{86, 180, 233}, {230, 159, 0}, {0, 158, 115},  {213, 94, 0},
                                       {240, 228, 66}, {0, 114, 178}, {204, 121, 167}};
    static const struct {
        uint16_t target, share; /* how many 256ths of the way to this grey */
    } tones[3] = {{0, 0}, {255, 128}, {0, 112}};
    const uint8_t *hue = hues[index % 7];
    uint32_t tone = index / 7 % 3, share = tones[tone].share, target = tones[tone].target;
    for (int i = 0; i < 3; i++) rgb[i] = (uint8_t)((hue[i] * (256 - share) + target * share) / 256);
}
