/* The tool's wishes for the standard files of its process; Windows alone has to be asked. */
#pragma once

#ifdef _WIN32

/* The standard files carry bytes, a console shows UTF-8 and understands the sequences that clear a line, and
 * a wrong descriptor is an error of the call and no end of the process. Returns what console_end takes. */
unsigned console_begin(void);
void console_end(unsigned page);

#else

static inline unsigned console_begin(void) {
    return 0;
}

static inline void console_end(unsigned page) {
    (void)page;
}

#endif
