/* The options of a command about the report that it writes. */
#include "tool/report/report_request.h"

bool report_request_agrees(const report_request *r, io_error *error) {
    if (r->path == NULL && (r->scenery_path != NULL || r->scenery_frames_path != NULL))
        return io_fail(error, "--scenery is drawn in a report; say where with --report OUT.html");
    return r->scenery_frames_path == NULL || r->scenery_path != NULL ||
           io_fail(error, "--scenery-frames moves the mesh of --scenery MODEL, which is missing");
}
