/* The program `cscd`. */
#include "src/tool/tool.h"

int main(int argument_count, char **arguments) {
    return tool_run(argument_count, arguments);
}
