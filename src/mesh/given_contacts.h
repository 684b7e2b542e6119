/* Lists of contacts that a caller gives back, and the parts that they are of. */
#pragma once

#include "src/mesh/part_labels.h"

/* Are all features those of the mesh? INVALID_ARGUMENT names the contact; function is the name of the API's. */
cscd_status given_contacts_check(cscd_context *context, const cscd_mesh *mesh, const char *function,
                                 const cscd_contact *contacts, size_t count);

/* The key of the parts that the two features of a contact are in. */
uint64_t parts_of_contact(const part_labels *labels, const cscd_mesh *mesh, cscd_contact_kind kind,
                          uint32_t a, uint32_t b);
