/* The name of the system. */
#pragma once

struct utsname {
    char sysname[16], release[32], machine[16];
};

int uname(struct utsname *out);
