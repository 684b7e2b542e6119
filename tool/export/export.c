/* Results in the files of other programs, by what was asked for: the options, and all files that they
 * name. */
#include "tool/export/export.h"

#include "tool/common/options.h"
#include "tool/export/export_values.h"
#include "tool/io/io.h"
#include "tool/io/output_file.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

typedef struct export_run {
    recording *recording;
    export_values values;
    vtk_output vtk;
    ply_output ply;
    selection_output selection;
    uint32_t frame_count; /* so far */
} export_run;

/* ---- paths --------------------------------------------------------------------------------------------- */

/* Is path in that folder? */
static bool lies_in_folder(const char *path, const char *folder) {
    const char *name = path_file_name(path);
    char *own = name > path ? strndup(path, (size_t)(name - path)) : strdup(".");
    struct stat first, second;
    const bool same = own != NULL && stat(own, &first) == 0 && stat(folder, &second) == 0 &&
                      S_ISDIR(second.st_mode) && first.st_dev == second.st_dev &&
                      first.st_ino == second.st_ino;
    free(own);
    return same;
}

/* In a folder of frames each mesh would be a frame of the next run. */
static bool leaves_folders(const export_request *request, const recording *r, io_error *error) {
    for (uint32_t i = 0; request->ply_path != NULL && i < r->object_count; i++) {
        const recorded_source *source = &r->objects[i].source;
        for (size_t k = 0; k < source->frame_path_count; k++)
            if (lies_in_folder(request->ply_path, source->frame_paths[k]))
                return io_fail(error, "--ply '%s' would lie among the frames of '%s'; choose another folder",
                               request->ply_path, source->frame_paths[k]);
    }
    return true;
}

/* Can the first files be written? */
static bool series_opens(const export_request *request, const recording *r, io_error *error) {
    char *vtk = request->vtk_path != NULL ? export_names_stem(request->vtk_path, ".pvd") : NULL;
    char *ply = request->ply_path != NULL ? export_names_stem(request->ply_path, ".ply") : NULL;
    char *collection = vtk != NULL ? export_names_join(vtk, ".pvd") : NULL;
    char *mesh = ply != NULL ? export_names_frame(ply, r->frame_numbers[0], ".ply") : NULL;
    const bool opens = output_path_opens(collection, error) && output_path_opens(mesh, error);
    free(vtk);
    free(ply);
    free(collection);
    free(mesh);
    return opens;
}

/* ---- frames -------------------------------------------------------------------------------------------- */

static bool open_outputs(const export_request *request, const part_names *parts, const cscd_plan *plan,
                         export_run *run, io_error *error) {
    recording *r = run->recording;
    if (!leaves_folders(request, r, error) || !series_opens(request, r, error) ||
        !export_values_open(r, parts, plan,
                            (export_choice){.contacts = request->contacts, .depths = !request->no_depths},
                            &run->values, error))
        return false;
    return (request->vtk_path == NULL ||
            vtk_output_open(request->vtk_path, (vtk_choice){recording_fps(r), !request->no_depths}, r, parts,
                            &run->values, &run->vtk, error)) &&
           (request->ply_path == NULL ||
            ply_output_open(request->ply_path, r, parts, &run->values, &run->ply, error)) &&
           (request->select_path == NULL ||
            selection_output_open(request->select_path, r, parts, &run->selection, error));
}

static void free_run(export_run *run) {
    vtk_output_free(&run->vtk);
    ply_output_free(&run->ply);
    export_values_free(&run->values);
    free(run);
}

bool exports_open(const export_request *request, recording *r, const part_names *parts, const cscd_plan *plan,
                  exports *out, io_error *error) {
    *out = (exports){0};
    if (!export_request_any(request)) return true;
    export_run *run = calloc(1, sizeof *run);
    if (run == NULL) return io_fail(error, "out of memory");
    run->recording = r;
    if (!open_outputs(request, parts, plan, run, error)) {
        free_run(run);
        return false;
    }
    out->run = run;
    return true;
}

void exports_add_contacts(exports *e, const cscd_contacts *contacts) {
    if (e->run != NULL) export_values_add_contacts(&e->run->values, contacts);
}

bool exports_add_frame(exports *e, uint32_t frame, const double *positions, const cscd_intersections *found,
                       io_error *error) {
    export_run *run = e->run;
    if (run == NULL) return true;
    const int32_t number = run->recording->frame_numbers[frame];
    const bool series = run->vtk.stem != NULL || run->ply.stem != NULL;
    if (series) export_values_set_frame(&run->values, found);
    run->frame_count++;
    const bool written =
        (run->vtk.stem == NULL || vtk_output_add_frame(&run->vtk, number, positions, found->curves, error)) &&
        (run->ply.stem == NULL || ply_output_add_frame(&run->ply, number, positions, error)) &&
        (run->selection.path == NULL || selection_output_add_frame(&run->selection, number, found, error));
    export_values_clear_contacts(&run->values);
    return written;
}

bool exports_close(exports *e, io_error *error) {
    export_run *run = e->run;
    if (run == NULL) return true;
    const bool finished =
        run->vtk.stem == NULL || run->frame_count == 0 || vtk_output_finish(&run->vtk, error);
    const bool closed =
        run->selection.path == NULL ||
        selection_output_close(&run->selection, run->frame_count > 0, finished ? error : NULL);
    free_run(run);
    *e = (exports){0};
    return finished && closed;
}

/* ---- the options of exports, and which paths fit them -------------------------------------------------- */

static const option_row rows[] = {
    {"vtk", "OUT", read_output_stem, offsetof(export_request, vtk_path),
     "write OUT.pvd and OUT_FRAME.vtp for ParaView: parts, pairs by kind, what is buried, depths, regions; and the "
     "curves, OUT_curves.pvd"},
    {"ply", "OUT", read_output_stem, offsetof(export_request, ply_path),
     "write the same of vertices and faces as properties of OUT_FRAME.ply"},
    {"select", "OUT.json", read_output_path, offsetof(export_request, select_path),
     "write the vertices and polygons that cross, by frame and part, as MODEL numbers them from 0: to be selected "
     "in a modelling program; - is the standard output"},
};

const option_list export_rows = {"Files for other programs:", rows, sizeof rows / sizeof *rows};

bool export_request_any(const export_request *request) {
    return request->vtk_path != NULL || request->ply_path != NULL || request->select_path != NULL;
}

/* Paths of several files, whose frames are named by them. */
static bool stem_fits(const char *option, const char *path, const char *ending, io_error *error) {
    if (path == NULL) return true;
    io_error reason;
    if (output_file_is_standard(path))
        return io_fail(error, "%s writes several files, which the standard output cannot hold", option);
    const size_t mesh_ending = path_mesh_ending(path);
    if (mesh_ending > 0 && strcasecmp(path + strlen(path) - mesh_ending, ending) != 0)
        return io_fail(error, "%s '%s' would be no %s file; choose a name that ends in %s, or in nothing",
                       option, path, path + strlen(path) - mesh_ending + 1, ending);
    return output_path_fits(path, ending, &reason) || io_fail(error, "%s %s", option, reason.text);
}

bool export_request_fits(const export_request *request, io_error *error) {
    return stem_fits("--vtk", request->vtk_path, ".pvd", error) &&
           stem_fits("--ply", request->ply_path, ".ply", error);
}
