/* The options of a command about the report that it writes. */
#include "tool/report/report_request.h"

#include "tool/common/output_path.h"

bool report_request_is_safe(const report_request *r, const char *const *others, size_t other_count,
                            io_error *error) {
    const char *own[] = {r->scenery_path, r->scenery_frames_path};
    if (r->path == NULL) {
        if (own[0] == NULL && own[1] == NULL) return true;
        return io_fail(error, "--scenery is drawn in a report; say where with --report OUT.html");
    }
    if (r->scenery_frames_path != NULL && r->scenery_path == NULL)
        return io_fail(error, "--scenery-frames moves the mesh of --scenery MODEL, which is missing");
    io_error reason;
    if (output_path_is_safe(r->path, others, other_count, &reason) &&
        output_path_fits(r->path, ".html", &reason) && output_path_differs(r->path, own, 2, &reason))
        return true;
    return io_fail(error, "--report %s", reason.text);
}
