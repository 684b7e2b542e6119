"""The library for Conan 2, from the tree that this file stands in: conan create packaging/recipes/conan."""
import os

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain
from conan.tools.files import copy

ROOT = os.path.join("..", "..", "..")
SOURCES = ["CMakeLists.txt", "LICENSE", "include/*", "src/*", "preprocess/*", "runtime/*", "sensors/*", "packaging/*"]


class CscdConan(ConanFile):
    name = "cscd"
    version = "2.0.0"
    license = "MIT"
    description = "Exact self-collision detection of deforming triangle meshes"
    topics = ("mesh", "self-intersection", "continuous-collision-detection")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    # The same questions as CMakeLists.txt asks.
    options = {"shared": [True, False], "baselines": [True, False], "sensors": [True, False]}
    default_options = {"shared": False, "baselines": False, "sensors": True}

    def export_sources(self):
        for pattern in SOURCES:
            copy(self, pattern, src=os.path.join(self.recipe_folder, ROOT), dst=self.export_sources_folder)

    def validate(self):
        if self.settings.os != "Linux" or self.settings.arch not in ("x86_64", "armv8"):
            raise ConanInvalidConfiguration("cscd is tested on Linux, on x86_64 and armv8")

    def requirements(self):
        if self.options.baselines:
            self.requires("gsl/2.7.1")
            self.requires("openblas/0.3.27", options={"build_lapack": True})

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["BUILD_SHARED_LIBS"] = bool(self.options.shared)
        toolchain.cache_variables["CSCD_BASELINES"] = bool(self.options.baselines)
        toolchain.cache_variables["CSCD_SENSORS"] = bool(self.options.sensors)
        toolchain.cache_variables["CSCD_INSTALL"] = True
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", src=self.source_folder, dst=os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "cscd")
        self.cpp_info.set_property("cmake_target_name", "cscd::cscd")
        self.cpp_info.libs = ["cscd"]
        self.cpp_info.system_libs = ["m", "pthread", "dl"]
