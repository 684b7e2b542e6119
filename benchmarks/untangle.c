/* Scenes to untangle, by class: what is in each of them. */
#include "benchmarks/lib/options.h"
#include "benchmarks/untangle/corpus.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: untangle [options]\n"
    "\n"
    "Lists scenes whose surfaces are in each other, by class: triangles, frames, those with pairs of triangles that\n"
    "intersect, and the least and most pairs in these. Recordings of ours are read from build/models (`make models`),\n"
    "others from CSCD_DATA.\n"
    "\n"
    "  --class NAME   limbs, folds, bodies, rods, cloth, flush or heavy\n"
    "  --scene NAME   the scenes whose names begin so\n"
    "  --frames       a line for each frame\n";

typedef struct listing {
    const char *class, *scene;
    bool frames;
    cscd_context *context;
} listing;

static cscd_status make_detector(const tangle_scene *s, cscd_context *context, cscd_mesh **mesh,
                                 cscd_detector **detector) {
    cscd_object_desc objects[TANGLE_OBJECTS_MAX];
    for (uint32_t i = 0; i < s->object_count; i++) {
        const body *b = &s->objects[i];
        objects[i] = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
        objects[i].obstacle = s->obstacles[i];
    }
    cscd_status status = cscd_mesh_create(context, objects, s->object_count, mesh);
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = s->seams;
    options.seam_count = s->seam_count;
    if (status == CSCD_OK) status = cscd_detector_create(context, *mesh, NULL, &options, detector);
    return status;
}

static cscd_status list_frames(const listing *l, const corpus_entry *e, const tangle_scene *s,
                               cscd_detector *detector) {
    size_t least = SIZE_MAX, most = 0;
    uint32_t crossing = 0, first = UINT32_MAX;
    for (uint32_t f = 0; f < s->frame_count; f++) {
        cscd_intersections found;
        cscd_status status =
            cscd_detector_check(detector, CSCD_DOUBLES(tangle_scene_frame(s, f), s->vertex_count), &found);
        if (status != CSCD_OK) return status;
        if (l->frames)
            printf("%-24s %5u %8zu (%zu crossing, %zu coplanar, %zu folded, %zu duplicate, %zu touching)\n",
                   e->name, f, found.count, found.crossing, found.coplanar, found.folded, found.duplicate,
                   found.touching);
        if (found.count == 0) continue;
        if (first == UINT32_MAX) first = f;
        crossing++;
        if (found.count < least) least = found.count;
        if (found.count > most) most = found.count;
    }
    printf("%-7s %-24s %8u %7u %9u", tangle_class_name(e->class), e->name, s->triangle_count, s->frame_count,
           crossing);
    if (crossing > 0) printf(" %6u %8zu %8zu", first, least, most);
    printf("%s\n", e->held_out ? "  held out" : "");
    return CSCD_OK;
}

static bool list_entry(const listing *l, const corpus_entry *e, io_error *error) {
    tangle_scene s;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    if (!corpus_open(e, &s, error)) return false;
    cscd_status status = make_detector(&s, l->context, &mesh, &detector);
    if (status == CSCD_OK) status = list_frames(l, e, &s, detector);
    if (status != CSCD_OK) io_fail(error, "%s: %s", e->name, cscd_context_detail(l->context));
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    tangle_scene_free(&s);
    return status == CSCD_OK;
}

static bool is_wanted(const listing *l, const corpus_entry *e) {
    return (l->class == NULL || strcmp(l->class, tangle_class_name(e->class)) == 0) &&
           (l->scene == NULL || strncmp(e->name, l->scene, strlen(l->scene)) == 0);
}

static bool list_all(const listing *l, io_error *error) {
    corpus all = corpus_list("build/models", getenv("CSCD_DATA"));
    bool good = true;
    printf("class   scene                    triangles  frames crossing  first    least     most\n");
    for (uint32_t i = 0; good && i < all.count; i++)
        if (is_wanted(l, &all.entries[i])) good = list_entry(l, &all.entries[i], error);
    corpus_free(&all);
    return good;
}

int main(int argument_count, char **arguments) {
    listing l = {.class = NULL};
    io_error error;
    setvbuf(stdout, NULL, _IOLBF, 0);
    for (int i = 1; i < argument_count; i++) {
        if (strcmp(arguments[i], "--frames") == 0) {
            l.frames = true;
        } else if (strcmp(arguments[i], "--class") == 0 && i + 1 < argument_count) {
            l.class = arguments[++i];
        } else if (strcmp(arguments[i], "--scene") == 0 && i + 1 < argument_count) {
            l.scene = arguments[++i];
        } else {
            const bool wanted = strcmp(arguments[i], "--help") == 0;
            fputs(help, wanted ? stdout : stderr);
            return wanted ? 0 : 2;
        }
    }
    if (cscd_context_create(NULL, &l.context) != CSCD_OK) return 1;
    const bool good = list_all(&l, &error);
    if (!good) fprintf(stderr, "untangle: %s\n", error.text);
    cscd_context_destroy(l.context);
    return good ? 0 : 1;
}
