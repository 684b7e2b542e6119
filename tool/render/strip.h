/* Several frames of a recording side by side in one picture. */
#pragma once

#include "tool/picture/picture.h"
#include "tool/render/contact_picture.h"
#include "tool/render/render_options.h"

/* picture: loaded, and painted unless contacts are wanted. beside: NULL for none. Writes the file of the
 * options. */
bool strip_draw(const render_options *options, recording *r, contact_picture *picture,
                picture_scenery *beside, io_error *error);
