/* The origin of a result: version, machine, options and hashes of the inputs. */
#include "tool/common/provenance.h"

#include "cscd/cscd.h"

#include <inttypes.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#ifndef CSCD_COMMIT
#define CSCD_COMMIT "unknown"
#endif
#ifndef CSCD_FLAGS
#define CSCD_FLAGS "unknown"
#endif
#ifdef __clang__
#define CSCD_COMPILER "clang " __clang_version__
#else
#define CSCD_COMPILER "gcc " __VERSION__
#endif

const char *provenance_commit(void) {
    return CSCD_COMMIT;
}

void provenance_generator(char text[PROVENANCE_GENERATOR_SIZE]) {
    snprintf(text, PROVENANCE_GENERATOR_SIZE, "cscd %s (%s)", cscd_version_string(), provenance_commit());
}

uint64_t provenance_hash(uint64_t hash, const void *bytes, size_t size) {
    const unsigned char *b = bytes;
    for (size_t i = 0; i < size; i++) hash = (hash ^ b[i]) * 0x100000001b3u;
    return hash;
}

uint64_t provenance_hash_numbers(uint64_t hash, const void *numbers, size_t count, size_t size) {
    const unsigned char *b = numbers;
    const uint16_t one = 1;
    const bool lowest_first = *(const unsigned char *)&one == 1;
    if (lowest_first) return provenance_hash(hash, numbers, count * size);
    for (size_t i = 0; i < count; i++)
        for (size_t k = size; k-- > 0;) hash = (hash ^ b[i * size + k]) * 0x100000001b3u;
    return hash;
}

/* The "model name" of the first processor, "" if the system does not give it. */
static void read_processor(char *name, size_t size) {
    name[0] = '\0';
    FILE *file = fopen("/proc/cpuinfo", "r");
    if (file == NULL) return;
    char line[256];
    while (name[0] == '\0' && fgets(line, sizeof line, file) != NULL) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || colon == NULL) continue;
        snprintf(name, size, "%s", colon + 1 + strspn(colon + 1, " "));
        name[strcspn(name, "\n")] = '\0';
    }
    fclose(file);
}

static void write_machine(json *out) {
    struct utsname system = {0};
    char processor[200];
    uname(&system);
    read_processor(processor, sizeof processor);
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    json_begin_object(out, "machine");
    json_string(out, "system", system.sysname);
    json_string(out, "release", system.release);
    json_string(out, "architecture", system.machine);
    json_string(out, "processor", processor);
    json_integer(out, "processors", processors > 0 ? (uint64_t)processors : 0);
    json_end_object(out);
}

void provenance_write_build(json *out) {
    json_string(out, "version", cscd_version_string());
    json_string(out, "commit", provenance_commit());
    json_string(out, "compiler", CSCD_COMPILER);
    json_string(out, "flags", CSCD_FLAGS);
}

void provenance_write(json *out, int argument_count, char **arguments, uint32_t thread_count) {
    char date[32];
    time_t now = time(NULL);
    struct tm utc;
    gmtime_r(&now, &utc);
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &utc);
    provenance_write_build(out);
    json_string(out, "date", date);
    write_machine(out);
    json_integer(out, "threads", thread_count);
    json_begin_array(out, "arguments");
    for (int i = 0; i < argument_count; i++) json_string(out, NULL, arguments[i]);
    json_end_array(out);
}

void provenance_write_input(json *out, const char *name, uint64_t hash) {
    char digits[17];
    snprintf(digits, sizeof digits, "%016" PRIx64, hash);
    json_begin_object(out, NULL);
    json_string(out, "name", name);
    json_string(out, "fnv1a64", digits);
    json_end_object(out);
}
