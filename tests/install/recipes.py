"""Compares the recipes of package managers in packaging with the tree: versions, licences, options, and every path.

None of these package managers is asked: their files are parsed, vcpkg's by CMake with functions that print their arguments.
Ends with 1 and a line for each difference. Run it in the root of the tree.
"""
import ast
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

import yaml

RECIPES = "packaging/recipes"
complaints = []


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def expect(what, found, expected):
    if found != expected:
        complaints.append(f"{what}: found {found!r}, expected {expected!r}")


def expect_path(what, path):
    if not glob.glob(path):
        complaints.append(f"{what}: the tree has no {path}")


def known_variables(makefile):
    return set(re.findall(r"^([A-Z_]+) *\??:?=", makefile, re.M)) | {"DESTDIR"}


def check_make(what, text):
    """Every variable that a script gives to make is one of the Makefile."""
    given = set(re.findall(r"\b([A-Z][A-Z_]+)=", " ".join(re.findall(r"^make\b(.*)$", text, re.M))))
    if not given:
        complaints.append(f"{what}: gives nothing to make")
    for name in given - known_variables(read("Makefile")):
        complaints.append(f"{what}: the Makefile does not know {name}")


def check_vcpkg(version, licence, options):
    port = os.path.abspath(f"{RECIPES}/vcpkg")
    manifest = json.loads(read(f"{port}/vcpkg.json"))
    expect("vcpkg.json, version", manifest["version"], version)
    expect("vcpkg.json, license", manifest["license"], licence)
    commands = ("vcpkg_check_features", "vcpkg_cmake_configure", "vcpkg_cmake_install", "vcpkg_cmake_config_fixup",
                "vcpkg_install_copyright")
    stubs = "".join(f'function({name})\n  message("{name};${{ARGV}}")\nendfunction()\n' for name in commands)
    with tempfile.TemporaryDirectory() as folder:
        script = os.path.join(folder, "port.cmake")
        with open(script, "w", encoding="utf-8") as file:
            file.write(f'{stubs}set(CURRENT_PORT_DIR "{port}")\nset(CURRENT_PACKAGES_DIR "{folder}")\n'
                       f'include("{port}/portfile.cmake")\n')
        printed = subprocess.run(["cmake", "-P", script], capture_output=True, text=True)
    if printed.returncode != 0:
        complaints.append(f"portfile.cmake: {printed.stderr}")
        return
    called = {words[0]: words[1:] for words in (line.split(";") for line in printed.stderr.splitlines())}
    expect("portfile.cmake, commands", sorted(called), sorted(commands))
    features = called["vcpkg_check_features"]
    pairs = features[features.index("FEATURES") + 1:]
    expect("portfile.cmake, features", sorted(pairs[::2]), sorted(manifest["features"]))
    expect("portfile.cmake, options of the features", set(pairs[1::2]), options - {"CSCD_INSTALL", "BUILD_SHARED_LIBS"})
    configured = called["vcpkg_cmake_configure"]
    expect("portfile.cmake, sources", configured[configured.index("SOURCE_PATH") + 1], os.getcwd())
    for name in re.findall(r"-D([A-Za-z_]+)=", " ".join(configured)):
        expect(f"portfile.cmake, {name} is an option of CMakeLists.txt", name in options, True)
    expect("portfile.cmake, licence", called["vcpkg_install_copyright"][-1], os.path.abspath("LICENSE"))
    folder = re.search(r"set\(cscd_package \$\{CMAKE_INSTALL_LIBDIR\}/(\S+)\)", read("CMakeLists.txt"))[1]
    expect("portfile.cmake, package", called["vcpkg_cmake_config_fixup"][-1], f"lib/{folder}")


def check_conan(version, licence, options):
    path = f"{RECIPES}/conan/conanfile.py"
    tree = ast.parse(read(path), path)
    [recipe] = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    values = {}
    for node in [*tree.body, *recipe.body]:
        if isinstance(node, ast.Assign) and not isinstance(node.value, ast.Call):
            values[node.targets[0].id] = ast.literal_eval(node.value)
    expect("conanfile.py, version", values["version"], version)
    expect("conanfile.py, license", values["license"], licence)
    expect("conanfile.py, defaults", sorted(values["default_options"]), sorted(values["options"]))
    used = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)
            and isinstance(node.value, ast.Attribute) and node.value.attr == "options"}
    expect("conanfile.py, options that are used", sorted(used), sorted(values["options"]))
    given = {node.slice.value for node in ast.walk(tree) if isinstance(node, ast.Subscript)
             and isinstance(node.value, ast.Attribute) and node.value.attr == "cache_variables"}
    expect("conanfile.py, options of CMakeLists.txt", given, options)
    [root] = [node.value for node in tree.body if isinstance(node, ast.Assign) and node.targets[0].id == "ROOT"]
    up = os.path.join(*(word.value for word in root.args))
    expect("conanfile.py, sources", os.path.realpath(os.path.join(RECIPES, "conan", up)), os.path.realpath("."))
    for pattern in values["SOURCES"]:
        expect_path("conanfile.py", pattern)
    # What CMakeLists.txt names is among the sources.
    listed = tuple(pattern.replace("*", "") for pattern in values["SOURCES"])
    for name in re.findall(r"\b(?:src|preprocess|runtime|include|packaging)/[\w/.]*", read("CMakeLists.txt")):
        expect(f"conanfile.py, {name} is copied", name.startswith(listed), True)


def check_conda(version, licence):
    folder = f"{RECIPES}/conda-forge"
    text = read(f"{folder}/meta.yaml")
    expect("meta.yaml, version", re.search(r'{% set version = "([^"]*)" %}', text)[1], version)
    text = re.sub(r"{%.*?%}", "", text).replace("{{ version }}", version)
    recipe = yaml.safe_load(re.sub(r"{{.*?}}", "filled-in", text))
    expect("meta.yaml, package", recipe["package"], {"name": "cscd", "version": version})
    expect("meta.yaml, license", recipe["about"]["license"], licence)
    root = os.path.realpath(os.path.join(folder, recipe["source"]["path"]))
    expect("meta.yaml, sources", root, os.path.realpath("."))
    expect_path("meta.yaml, license_file", os.path.join(root, recipe["about"]["license_file"]))
    for path in re.findall(r"\$PREFIX/(include/\S+)", text):
        expect_path("meta.yaml, test", path)
    installed = read("packaging/install.sh") + "lib/pkgconfig/cscd.pc"
    for path in re.findall(r"\$PREFIX/(lib/\S+)", text):
        expect(f"meta.yaml, {path} is installed", os.path.basename(path) in installed, True)
    check_make("build.sh", read(f"{folder}/build.sh"))


def main():
    header = read("include/cscd/cscd.h")
    version = ".".join(re.search(rf"^#define CSCD_VERSION_{part} (\d+)$", header, re.M)[1] for part in ("MAJOR", "MINOR", "PATCH"))
    licence = re.search(r'\[project\.license\]\ntext = "(.*)"', read("pyproject.toml"))[1]
    expect("LICENSE", read("LICENSE").splitlines()[0], f"{licence} License")
    options = set(re.findall(r"^option\((\w+)", read("CMakeLists.txt"), re.M))
    check_vcpkg(version, licence, options)
    check_conan(version, licence, options)
    check_conda(version, licence)
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
