"""What the public headers promise and show, and what names them: the frozen API, their examples, the C++ interface, recipes."""
import re

from support.install.built_tree import BUILD, ROOT, functions_of, shell

# Functions that programs in C++ use as they are.
PLAIN = """cscd_contact_kind_name cscd_curve_end_name cscd_intersection_kind_name cscd_left_out_name cscd_max_memory_default
    cscd_mesh_context cscd_method_from_name cscd_method_name cscd_mode_from_name cscd_mode_name cscd_reason_text
    cscd_simd_from_name cscd_simd_name cscd_version_string cscd_volume_from_name cscd_volume_name"""


def test_headers_are_as_frozen():
    """Version 2 keeps what it promises: values of enumerators, places and types of members, functions and their types.

    When this has changed before 2.0.0 is released, run make freeze-api. After it, take the change back, unless it adds to what
    was there: callers were compiled with that.
    """
    frozen = set((ROOT / "tests/install/api_frozen.txt").read_text().splitlines())
    now = set(shell("tests/install/api_headers.py print").splitlines())
    assert frozen == now


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


def test_recipes_fit_the_tree():
    """The recipes of package managers name the version, the licence, the options and the files of this tree."""
    shell("PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 tests/install/recipes.py")
