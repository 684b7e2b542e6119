/* Lines of results that jobs have left in a file. */
#include "tests/support/tool/result_lines.h"

#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

result_lines result_lines_take(const char *path) {
    result_lines lines = {.count = 0};
    size_t size, at;
    char *text = read_whole_file(path, &size);
    for (char *line = text; line < text + size; lines.count++) {
        char *end = strchr(line, '\n');
        assert_non_null(end);
        json_node *node = json_node_parse(line, (size_t)(end - line), &at);
        assert_non_null(node);
        const size_t job = (size_t)json_node_number(node, "job");
        assert_true(job >= 1 && job <= LINES_MAX);
        assert_null(lines.of[job]);
        lines.of[job] = node;
        line = end + 1;
    }
    free(text);
    remove(path);
    return lines;
}

void result_lines_free(result_lines *lines) {
    for (size_t i = 0; i <= LINES_MAX; i++) json_node_free(lines->of[i]);
}
