"""What the public headers promise and show, and what names them: the frozen API, their examples, the C++ interface, recipes."""
import re
import subprocess

import pytest

from support.install.built_tree import BUILD, ROOT, functions_of, shell

# Functions that programs in C++ use as they are.
PLAIN = "cscd_from_name cscd_mesh_context cscd_mesh_count cscd_name cscd_version_string"


def test_headers_are_as_frozen():
    """Version 2 keeps what it promises: values of enumerators, places and types of members, functions and their types.

    When this has changed before 2.0.0 is released, run make freeze-api. After it, take the change back, unless it adds to what
    was there: callers were compiled with that.
    """
    frozen = set((ROOT / "tests/install/api_frozen.txt").read_text().splitlines())
    now = set(shell("tests/install/api_headers.py print").splitlines())
    assert frozen == now


def test_what_is_made_from_headers():
    """Prototypes of Python and the man page are those of the headers, as make freeze-api writes them."""
    shell("tests/install/api_headers.py check")


def test_python_calls_what_its_library_has():
    """The calls of python/native that Python lists are those that stand there."""
    listed = set(re.findall(r'"(?:cscdpy_)?(\w+)": ', (ROOT / "python/cscd/_prototypes.py").read_text()))
    native = "\n".join(path.read_text() for path in (ROOT / "python/native").glob("*.c"))
    found = re.findall(r"\b(?:(?:CALL|RESULT)_OF\((?!name\b)|cscdpy_(?!##))(\w+)(?=[,(])", native)
    assert listed == set(found)


def test_structs_can_grow():
    """No struct ends in padding, and the library is told the size of every one that may grow."""
    shell("tests/install/api_headers.py rules")


def test_examples_run(tmp_path):
    """The examples in the comments compile without warnings, run, and print what they say."""
    assert " 0 bad" in shell(f"python3 tests/install/header_examples.py '{tmp_path}' '{BUILD}/libcscd.a' -lm -pthread")


def test_every_function_has_a_wrapper():
    """The C++ interface calls every function of C that has to do with an object."""
    text = "\n".join(path.read_text() for path in (ROOT / "include/cscd").glob("*.hpp"))
    called = set(re.findall(r"\w+", "\n".join(line for line in text.splitlines() if not line.startswith(" *"))))
    apart = {*functions_of("research.h"), *functions_of("sensors.h")}
    assert sorted(set(functions_of()) - apart - called) == PLAIN.split()


def compile_in_cpp(code, *flags):
    """What the compiler says of a program in C++, "" if it takes it."""
    command = ["g++", "-std=c++17", "-fsyntax-only", f"-I{ROOT / 'include'}", *flags, "-x", "c++", "-"]
    return subprocess.run(command, input=code, text=True, capture_output=True, check=False).stderr


def test_macros_and_warnings_of_a_host():
    """A host may have a macro `check`, as the Unreal Engine has, and take every warning for an error."""
    code = """
        #define check(expression) ((void)(expression))
        #include <cscd/cscd.hpp>
        #include <cscd/research.h>
        #include <cscd/sensors.hpp>
        int main() { check(cscd_intersection_set(CSCD_INTERSECTION_CROSSING)); }"""
    warnings = "-Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast -Wcast-qual -Werror"
    assert compile_in_cpp(code, *warnings.split()) == ""


@pytest.mark.parametrize(
    "code, says",
    [
        ("auto view = cscd::view_of(std::vector<double>(9));", "the container is a temporary"),
        ("auto view = cscd::view_of_columns(std::vector<double>(9));", "the container is a temporary"),
        ("std::vector<odd> points; auto view = cscd::view_of(points);", "specialize cscd::scalar_of"),
        ("std::vector<odd> points; cscd::positions given(points);", "specialize cscd::scalar_of"),
        ("std::vector<int> numbers; cscd::positions given(numbers);", "specialize cscd::scalar_of"),
        ("matrix<0, 1> rows; cscd::positions given(rows);", "say view_of_columns"),
        ("matrix<1, 2> with_gaps; cscd::positions given(with_gaps);", "say view_of_columns"),
    ],
)
def test_mistakes_do_not_compile(code, says):
    """The compiler says what is wrong with a view of what is gone, or of points that nobody knows."""
    known = """
        #include <cscd/cscd.hpp>
        struct odd { int weight; double place[3]; };
        template <int vector, int stride> struct matrix { /* as those of Eigen */
            enum { IsRowMajor = 0, IsVectorAtCompileTime = vector, InnerStrideAtCompileTime = stride };
            const float *data() const;
            std::size_t size() const;
        };"""
    assert says in compile_in_cpp(f"{known}\nint main() {{ {code} }}")
    assert compile_in_cpp(f"{known}\nint main() {{ std::vector<double> x(9); cscd::view_of(cscd::span<double>(x)); }}") == ""


def test_recipes_fit_the_tree():
    """The recipes of package managers name the version, the licence, the options and the files of this tree."""
    shell("PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 tests/install/recipes.py")
