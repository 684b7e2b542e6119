/* Point caches: all frames of an animation in one PC2 or MDD file, read and written frame by frame. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stdint.h>

/* PC2: 32 bytes, little endian: "POINTCACHE2" with its NUL, int32 version (1), int32 points, float32 start,
 * float32 rate, int32 samples; then for each sample x,y,z float32 of every point. MDD: big endian: int32
 * frames, int32 points, float32 time of every frame; then for each frame x,y,z float32 of every point. Frames
 * are taken in the file's order. A PC2 header says what they are called: the first is number start, and the
 * others follow in steps of rate, if both are whole numbers and rate is at least 1. MDD's times, in seconds,
 * are not used. */
#define POINT_CACHE_PC2_MAGIC "POINTCACHE2"
enum {
    POINT_CACHE_PC2_MAGIC_SIZE = sizeof POINT_CACHE_PC2_MAGIC,
    POINT_CACHE_PC2_HEADER_SIZE = 32,
    POINT_CACHE_MDD_HEADER_SIZE = 8,
    POINT_CACHE_VERTEX_SIZE = 12
};

typedef struct point_cache point_cache;

/* True if path is to be read as a point cache: it begins like a PC2 file, or ends in .pc2 or .mdd. */
bool point_cache_recognise(const char *path);

/* Checks the header and the file's size against it; vertex_count is at least 1. On false *out is
 * untouched. */
bool point_cache_open(const char *path, uint32_t vertex_count, point_cache **out, io_error *error);
void point_cache_close(point_cache *cache);

uint32_t point_cache_frame_count(const point_cache *cache);

/* The number that the header gives a frame; its index where there is none. */
int32_t point_cache_frame_number(const point_cache *cache, uint32_t frame);

/* frame is below the count; positions takes vertex_count * 3 and is undefined on false. */
bool point_cache_read(point_cache *cache, uint32_t frame, double *positions, io_error *error);

/* ---- writing ------------------------------------------------------------------------------------------- */

typedef struct point_cache_writer point_cache_writer;

/* Begins the file for path, whose extension (.pc2 or .mdd) says the format, and writes the header. Counts are
 * 1 to INT32_MAX. PC2 gets start 0 and rate 1, MDD 24 frames a second. On false *out is untouched. */
bool point_cache_writer_open(const char *path, uint32_t vertex_count, uint32_t frame_count,
                             point_cache_writer **out, io_error *error);

/* Before the first frame: says what the frames are called, `first` and so on in steps. Of MDD nothing is
 * said, nor where a float cannot hold the number. */
bool point_cache_writer_number(point_cache_writer *writer, int32_t first, uint32_t step, io_error *error);

/* The frames to come are written from this one on. Each is written once. */
bool point_cache_writer_seek(point_cache_writer *writer, uint32_t frame, io_error *error);

/* Appends a frame, vertex_count * 3 positions rounded to float32; a value that is not finite in float32
 * is an error. After an error nothing is left of the file, every further write fails, and only close is
 * left to do. */
bool point_cache_writer_write(point_cache_writer *writer, const double *positions, io_error *error);

/* Before the end: the file ends with `count` frames, 1 or more, from `first` on, which have been written, and
 * has no others. Files alone can end so, no pipes. A failure is that of a write. */
bool point_cache_writer_keep(point_cache_writer *writer, uint32_t first, uint32_t count, io_error *error);

/* Frees the writer; NULL is fine. Nothing is left of the file, and an older one stays. */
void point_cache_writer_abandon(point_cache_writer *writer);

/* Always frees the writer; NULL is fine. True if all frame_count frames are in the file. If not, none of it
 * is there; *error is set unless a write has already failed and said why. */
bool point_cache_writer_close(point_cache_writer *writer, io_error *error);
