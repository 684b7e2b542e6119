/* The options of exports, and which paths fit them. */
#include "tool/common/option_values.h"
#include "tool/common/output_path.h"
#include "tool/export/exports.h"
#include "tool/io/output_file.h"
#include "tool/io/path_name.h"

#include <string.h>
#include <strings.h>

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
