/* What the host has given the library to call, for tests that look at each of them. */
#pragma once

typedef enum host_callback { HOST_ALLOCATOR, HOST_PARALLEL_FOR, HOST_PROGRESS, HOST_IGNORE } host_callback;
