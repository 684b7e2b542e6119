/* A skinned figure whose arms go through its trunk, in each of the forms in which animations come. */
#include "models/mannequin/mannequin.h"
#include "tool/io/point_cache.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: mannequin FOLDER [cache|skin|frames|objects]...\n"
    "\n"
    "Writes a jointed figure of ten parts and 48 frames of its motion. The left forearm goes through the trunk from\n"
    "frame 17 to 31 and is deepest at 24, the right one from 36 to 44, deepest at 40. Eyes, which turn, teeth and belt\n"
    "intersect head and trunk in all frames.\n"
    "\n"
    "  cache    mannequin.obj, an object for each part, and mannequin.pc2 (what is written without a word)\n"
    "  skin     mannequin.glb: a node for each part, a skin and an animation\n"
    "  frames   frame-00.obj to frame-47.obj\n"
    "  objects  NAME.obj and NAME.pc2 of each part, for cscd --object\n";

typedef double frame_positions[MANNEQUIN_VERTICES_MAX][3];

static bool fail_at(const char *path, io_error *error) {
    io_fail(error, "%s: %s", path, strerror(errno));
    return false;
}

/* Writes the parts from first to end, in one frame, named unless there is one only. */
static bool write_model(const char *path, const mannequin *m, int frame, int first, int end,
                        io_error *error) {
    static frame_positions positions;
    FILE *file = fopen(path, "w");
    if (file == NULL) return fail_at(path, error);
    mannequin_pose(m, frame, positions);
    const uint32_t base = m->first_vertex[first];
    for (uint32_t v = base; v < m->first_vertex[end]; v++)
        fprintf(file, "v %.9g %.9g %.9g\n", (float)positions[v][0], (float)positions[v][1],
                (float)positions[v][2]);
    for (int part = first; part < end; part++) {
        if (end > first + 1) fprintf(file, "o %s\n", mannequin_part_names[part]);
        for (uint32_t t = m->first_triangle[part]; t < m->first_triangle[part + 1]; t++) {
            const uint32_t *c = m->triangles[t];
            fprintf(file, "f %u %u %u\n", c[0] - base + 1, c[1] - base + 1, c[2] - base + 1);
        }
    }
    const bool written = !ferror(file);
    return (fclose(file) == 0 && written) || fail_at(path, error);
}

static bool write_cache(const char *path, const mannequin *m, int first, int end, io_error *error) {
    static frame_positions positions;
    const uint32_t base = m->first_vertex[first];
    point_cache_writer *writer;
    if (!point_cache_writer_open(path, m->first_vertex[end] - base, MANNEQUIN_FRAMES, &writer, error))
        return false;
    for (int frame = 0; frame < MANNEQUIN_FRAMES; frame++) {
        mannequin_pose(m, frame, positions);
        if (!point_cache_writer_write(writer, positions[base], error)) break;
    }
    return point_cache_writer_close(writer, error);
}

static bool write_form(const char *folder, const char *form, const mannequin *m, io_error *error) {
    char path[4096], other[4096];
    if (strcmp(form, "cache") == 0) {
        snprintf(path, sizeof path, "%s/mannequin.obj", folder);
        snprintf(other, sizeof other, "%s/mannequin.pc2", folder);
        return write_model(path, m, 0, 0, MANNEQUIN_PARTS, error) &&
               write_cache(other, m, 0, MANNEQUIN_PARTS, error);
    }
    if (strcmp(form, "skin") == 0) {
        snprintf(path, sizeof path, "%s/mannequin.glb", folder);
        return skinned_file_write(path, m, error);
    }
    if (strcmp(form, "frames") == 0) {
        for (int frame = 0; frame < MANNEQUIN_FRAMES; frame++) {
            snprintf(path, sizeof path, "%s/frame-%02d.obj", folder, frame);
            if (!write_model(path, m, frame, 0, MANNEQUIN_PARTS, error)) return false;
        }
        return true;
    }
    for (int part = 0; part < MANNEQUIN_PARTS; part++) {
        snprintf(path, sizeof path, "%s/%s.obj", folder, mannequin_part_names[part]);
        snprintf(other, sizeof other, "%s/%s.pc2", folder, mannequin_part_names[part]);
        if (!write_model(path, m, 0, part, part + 1, error) || !write_cache(other, m, part, part + 1, error))
            return false;
    }
    return true;
}

static bool is_form(const char *word) {
    static const char *const forms[] = {"cache", "skin", "frames", "objects"};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        if (strcmp(word, forms[i]) == 0) return true;
    return false;
}

int main(int argument_count, char **arguments) {
    static mannequin m;
    io_error error;
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) {
        fputs(help, stdout);
        return 0;
    }
    if (argument_count < 2 || strlen(arguments[1]) > 4000) {
        fputs("mannequin: expected a folder and what to write; see --help\n", stderr);
        return 2;
    }
    for (int i = 2; i < argument_count; i++) {
        if (is_form(arguments[i])) continue;
        fprintf(stderr, "mannequin: '%s' is not cache, skin, frames or objects\n", arguments[i]);
        return 2;
    }
    mannequin_make(&m);
    for (int i = argument_count > 2 ? 2 : 1; i < argument_count; i++) {
        if (!write_form(arguments[1], i == 1 ? "cache" : arguments[i], &m, &error)) {
            fprintf(stderr, "mannequin: %s\n", error.text);
            return 1;
        }
    }
    printf("%u vertices, %u triangles, %d parts, %d frames\n", m.vertex_count, m.triangle_count,
           MANNEQUIN_PARTS, MANNEQUIN_FRAMES);
    return 0;
}
