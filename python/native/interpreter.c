/* Keeps the functions of Python that were handed over. */
#include "python/native/interpreter.h"

#include "python/native/exports.h"

#include <string.h>

interpreter python;

PYTHON_API bool cscdpy_set_interpreter(void *const *functions, size_t count) {
    if (count * sizeof *functions != sizeof python) return false;
    memcpy(&python, functions, sizeof python);
    return true;
}

/* Copies what a list of the library has into an array of Python's. */
PYTHON_API void cscdpy_copy(void *to, const void *from, size_t size) {
    if (size > 0) memcpy(to, from, size);
}
