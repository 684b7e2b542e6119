/* The number of files that a process may have open. */
#pragma once

#define RLIMIT_NOFILE 7

struct rlimit {
    unsigned long long rlim_cur, rlim_max;
};

int getrlimit(int resource, struct rlimit *out);
int setrlimit(int resource, const struct rlimit *limit);
