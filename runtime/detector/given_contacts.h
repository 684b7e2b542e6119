/* Lists of contacts that a caller gives back. */
#pragma once

#include "src/mesh/mesh.h"

/* Are all features those of the mesh? INVALID_ARGUMENT names the contact; function is the name of the API's. */
cscd_status given_contacts_check(cscd_context *context, const cscd_mesh *mesh, const char *function,
                                 const cscd_contact *contacts, size_t count);
