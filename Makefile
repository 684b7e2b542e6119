# cscd: `make demo` and `make test` do all their own set-up; `make help` lists the rest.
#
#   CONFIG=release|debug|sanitize|fuzz|tsan|scalar   CC=gcc|clang   BASELINES=0   SENSORS=0   EXPAT=0   DYNAMIC=1   WERROR=1   HOST=...   `make -j` as usual
# BASELINES=0 leaves out libcscd-baselines.so, what cscd is compared with and needs LAPACKE, OpenBLAS and GSL (GPL-3); nothing else changes.
# SENSORS=0 leaves out the particle sensors and their command, `sense`; so does `rm -r sensors`.
# EXPAT=0 builds a tool that does not read GIFTI surfaces, as on a machine where pkg-config finds no expat; the library never needs it.
# NIGHTLY=1 tests more random cases, in a folder of its own.
# DYNAMIC=1 is for distributions: the tool and the Python package link libcscd.so and the libraries of the system in place of archives.
# HOST=aarch64-linux-gnu builds by that cross compiler, in build/aarch64-linux-gnu, with the libraries in SYSROOT if that is set.
# HOST=wasm32-emscripten builds the library for WebAssembly: see packaging/wasm/choices.mk.
# HOST=x86_64-w64-mingw32 builds for Windows, in build/x86_64-w64-mingw32: see tool/windows/windows.mk.
# One build folder per configuration; the release tool is also linked as ./cscd.

CONFIG  ?= release
# Not from the environment, where some shells keep the name of the machine.
HOST    :=
SYSROOT ?=
TOOLS   := $(if $(HOST),$(HOST)-)
ifneq ($(findstring mingw,$(HOST)),)
include tool/windows/choices.mk
endif
ifneq ($(findstring wasm,$(HOST)),)
include packaging/wasm/choices.mk
endif
ifeq ($(origin CC),default)
CC      := $(TOOLS)gcc
endif
ifeq ($(origin CXX),default)
CXX     := $(TOOLS)g++
endif
WERROR  ?= 0
BASELINES ?= 1
SENSORS ?= 1
DYNAMIC ?= 0
NIGHTLY ?= 0
BUILD_ROOT ?= build$(if $(HOST),/$(HOST))
MORE_CASES := $(if $(filter 1,$(NIGHTLY)),-nightly)
# A machine without expat builds in the same folder as one with it; only who leaves it out on purpose has another.
WITHOUT_EXPAT := $(if $(filter 0,$(EXPAT)),-without-expat)
WITHOUT_SENSORS := $(if $(filter 0,$(SENSORS)),-without-sensors)
BUILD   := $(BUILD_ROOT)/$(CONFIG)$(if $(WINDOWS)$(WASM),,$(WITHOUT_EXPAT)$(if $(filter 1,$(DYNAMIC)),-dynamic))$(WITHOUT_SENSORS)$(MORE_CASES)
# The flags of a package that pkg-config finds, else those given here.
PKG_CONFIG := $(if $(HOST),PKG_CONFIG_SYSROOT_DIR='$(SYSROOT)' PKG_CONFIG_LIBDIR='$(SYSROOT)/usr/lib/$(HOST)/pkgconfig:$(SYSROOT)/usr/share/pkgconfig') pkg-config
packaged = $(shell $(PKG_CONFIG) $(1) 2>/dev/null || echo $(2))
EXPAT   ?= $(if $(shell $(PKG_CONFIG) --modversion expat 2>/dev/null),1,0)

OPTIMISE_release  := -O3 -g -DNDEBUG
OPTIMISE_debug    := -O0 -g3
# Sanitizers name lines; without the names of variables, programs are half as large.
OPTIMISE_sanitize := -O1 -g1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all
OPTIMISE_tsan     := -O1 -g1 -fno-omit-frame-pointer -fsanitize=thread
# Fuzzing that follows the paths of the code, by clang alone: see fuzz-readers.
OPTIMISE_fuzz     := -O1 -g1 -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
# The scalar twin: vector units must compute the same, bit for bit.
OPTIMISE_scalar   := -O2 -g -DCSCD_SCALAR -fno-tree-vectorize
ifeq ($(OPTIMISE_$(CONFIG)),)
$(error CONFIG=$(CONFIG) is unknown: use release, debug, sanitize, fuzz, tsan or scalar)
endif

# The headers refuse these, too (src/core/floating.h), but clang does not tell them of each.
OTHER_ARITHMETIC := -Ofast -ffast-math -funsafe-math-optimizations -fassociative-math -freciprocal-math -ffinite-math-only -fno-signed-zeros
ifneq ($(filter $(OTHER_ARITHMETIC),$(CC) $(CPPFLAGS) $(CFLAGS)),)
$(error cscd proves what it says by IEEE arithmetic: leave out $(filter $(OTHER_ARITHMETIC),$(CC) $(CPPFLAGS) $(CFLAGS)); -O3 is the default)
endif
# The static library is made by objcopy, of machine code, so whoever asks for link-time optimisation gets the same library.
allowed = $(filter-out -flto% -ffat-lto-objects -ffp-contract=%,$(1))

CPP_WARNINGS := -Wall -Wextra -Wpedantic -Wconversion -Wshadow
WARNINGS := -Wall -Wextra -Wconversion -Wshadow -Wmissing-prototypes -Wstrict-prototypes -Wvla
ifeq ($(WERROR),1)
WARNINGS += -Werror
CPP_WARNINGS += -Werror
endif
# Inner loops are compiled once per instruction set; at run time the processor decides which ones run.
MACHINE := $(shell $(CC) -dumpmachine)
ifneq ($(filter x86_64%,$(MACHINE)),)
LEVELS := scalar avx2 avx512
CORE_DEFINITIONS := -DCSCD_WITH_AVX
else ifneq ($(filter aarch64%,$(MACHINE)),)
LEVELS := scalar neon
CORE_DEFINITIONS := -DCSCD_WITH_NEON
else
LEVELS := scalar
endif
# On s390x gcc takes strict C to mean that floats are computed as doubles; this leaves them floats.
ifneq ($(filter s390x%,$(MACHINE)),)
CORE_DEFINITIONS := -fexcess-precision=fast
endif
LEVEL_scalar := -DSIMD_LEVEL=0
LEVEL_avx2   := -DSIMD_LEVEL=1 -mavx2
LEVEL_avx512 := -DSIMD_LEVEL=2 -mavx512f -mavx512vl -mavx512dq -mavx512bw
LEVEL_neon   := -DSIMD_LEVEL=3

# -ffp-contract=off: error bounds are derived for separate multiplications and additions. -fPIC: both libraries are
# made of the same objects, which run no slower for it.
CFLAGS_ALL := -std=c11 -D_GNU_SOURCE $(OPTIMISE_$(CONFIG)) $(WARNINGS) -ffp-contract=off -fvisibility=hidden -fPIC \
              -Wno-psabi -pthread -MMD -MP -Iinclude -I. $(CORE_DEFINITIONS) $(CPPFLAGS) $(call allowed,$(CFLAGS))
LINK_ALL   := $(OPTIMISE_$(CONFIG)) -pthread $(LDFLAGS)
# libcscd opens libcscd-baselines.so when it needs it. (Where dlopen is in libc, -ldl is an empty archive.)
CORE_LIBS     := -lm -ldl
BASELINE_LIBS := -llapacke -lgsl -lopenblas -lm
EXPAT_LIBS  := $(if $(filter 0,$(EXPAT)),,$(call packaged,--libs expat,-lexpat))
FILE_LIBS   := $(call packaged,--libs libpng zlib json-c,-lpng -lz -ljson-c) $(EXPAT_LIBS)
TOOL_LIBS   := $(FILE_LIBS) $(CORE_LIBS)
TEST_LIBS   := -lcmocka -lflint-arb -lflint -lgmp $(TOOL_LIBS) $(BASELINE_LIBS)

HAS_SENSORS := $(if $(filter 0,$(SENSORS)),,$(wildcard sensors/*.c))
# A file that ends in _simd.c is compiled once per instruction set. libcscd-baselines.so has sources of its own.
BASELINE_SOURCES := $(wildcard preprocess/baselines/dense/*.c runtime/baselines/*_export.c)
CORE_FILES      := $(wildcard src/core/*.c src/mesh/*.c preprocess/*.c preprocess/*/*.c runtime/*/*.c) $(HAS_SENSORS)
CORE_SOURCES    := $(filter-out %_simd.c $(BASELINE_SOURCES),$(CORE_FILES))
KERNEL_SOURCES  := $(filter %_simd.c,$(CORE_FILES))
# What commands of the tool share, and the commands.
WITHOUT_GIFTI   := tool/io/no_gifti.c
OTHER_PROCESSES := $(foreach file,jobs/job_processes common/blas_kernels,tool/$(file)$(if $(WINDOWS),,_windows).c)
COMMON_SOURCES  := $(filter-out $(OTHER_PROCESSES) $(if $(filter 0,$(EXPAT)),tool/io/gifti.c,$(WITHOUT_GIFTI)), \
                     $(wildcard tool/io/*.c tool/io/*/*.c tool/picture/*.c tool/common/*.c tool/answers/*.c \
                     tool/jobs/*.c tool/export/*.c tool/report/*.c))
COMMAND_SOURCES := $(wildcard tool/*.c $(patsubst %,tool/%/*.c,check replay render untangle) $(if $(HAS_SENSORS),sensors/tool/*.c))
NATIVE_SOURCES  := $(wildcard python/native/*.c)
SUPPORT_SOURCES := $(filter-out $(if $(HAS_SENSORS),,tests/support/sensors/%),$(wildcard tests/support/*.c tests/support/*/*.c))
# `rm -r runtime/baselines`, and its lines in runtime/detector/method_table.c: what needs them is not built then.
HAS_BASELINES   := $(wildcard runtime/baselines/*.h)
# The browser's tests look at pages, which no other configuration writes differently. Only a release is installed. Under sanitizers each
# program of models/ runs (models/test_programs); how bodies and cloth move in them is looked at in a release.
BROWSER_TESTS   := tests/report/test_report_browser.py tests/report/test_report_view.py
NOT_HERE        := $(if $(filter %/release,$(BUILD)),,tests/install/test_baseline_library.py tests/install/test_embedding.py \
                     tests/install/test_headers.py tests/install/test_header_versions.py) \
                   $(if $(filter %/release,$(BUILD)),,$(BROWSER_TESTS)) \
                   $(if $(filter release,$(CONFIG)),,tests/install/test_flags.py tests/install/test_install.py tests/install/test_places.py) \
                   $(if $(filter sanitize,$(CONFIG)),$(wildcard tests/models/test_cloth_*.c tests/models/test_recording*.c tests/models/test_soft_body*.c) \
                     tests/models/test_shapes.c tests/tool/test_large_recordings.py) \
                   $(if $(filter 0,$(EXPAT)),tests/io/test_gifti.py tests/io/test_gifti_memory.c) \
                   $(if $(HAS_BASELINES),,$(wildcard tests/baselines/*)) $(if $(HAS_SENSORS),,$(wildcard tests/sensors/*))
TEST_SOURCES    := $(filter-out $(NOT_HERE),$(wildcard tests/*/test_*.c tests/*/test_*.cpp tests/*/test_*.py))
ifneq ($(findstring mingw,$(HOST)),)
include tool/windows/windows.mk
endif
ifdef WASM
include packaging/wasm/wasm.mk
endif
# The thread sanitizer sees the tests that use threads, and no others are built for it.
THREAD_TESTS := bvh/test_traversal core/test_threads core/test_progress core/test_parallel_for core/test_contexts core/test_host_loop \
                detector/test_reentry detector/test_lifetimes detector/test_shared_mesh detector/test_clone_threads \
                intersections/test_first_pairs intersections/test_surface_answers cpp/test_callbacks \
                proofs/test_steps proofs/test_solver_calls proofs/test_told proofs/test_intersections proofs/test_creations proofs/test_energies
ifeq ($(CONFIG),tsan)
TEST_SOURCES    := $(filter $(addsuffix .%,$(addprefix tests/,$(THREAD_TESTS))),$(TEST_SOURCES))
endif
# The files of a room in C are one program, whichever of them ONLY="bvh line_search detector:step" chooses to run: those of these rooms, with
# one of these words in their names, or with it in this room.
ROOM_SOURCES    := $(filter-out %.py,$(TEST_SOURCES))
ONLY ?=
ifneq ($(strip $(ONLY)),)
TEST_SOURCES    := $(sort $(foreach word,$(patsubst test_%,%,$(subst :test_,:,$(ONLY))),$(filter $(TEST_SOURCES),$(if $(findstring :,$(word)),\
                     $(wildcard tests/$(subst :,/test_*,$(word))*.*),$(wildcard tests/*/test_*$(word)*.* tests/$(word)/test_*.*)))))
endif
FUZZ_SOURCES    := $(wildcard tests/fuzz/fuzz_*.c)
MODEL_SOURCES   := $(wildcard models/*.c)
MODEL_PARTS     := $(wildcard models/*/*.c)
CPP_MODEL_SOURCES := $(wildcard models/*.cpp)
CPP_MODEL_PARTS   := $(wildcard models/*/*.cpp)
BENCHMARK_SOURCES := $(filter-out $(if $(HAS_BASELINES),,benchmarks/thesis.c benchmarks/thesis_figures.c benchmarks/volumes.c) $(if $(HAS_SENSORS),,benchmarks/sensors.c),$(wildcard benchmarks/*.c))
BENCHMARK_PARTS   := $(filter-out %_simd.c,$(wildcard benchmarks/lib/*.c benchmarks/untangle/*.c $(if $(HAS_SENSORS),benchmarks/sensors/*.c sensors/tool/object_pairs.c)))
PEER_SOURCES      := $(wildcard benchmarks/peers/*.c benchmarks/peers/*.cpp)
SOURCES := $(CORE_SOURCES) $(BASELINE_SOURCES) $(KERNEL_SOURCES) $(COMMON_SOURCES) $(COMMAND_SOURCES) $(NATIVE_SOURCES) $(SUPPORT_SOURCES) $(ROOM_SOURCES) $(FUZZ_SOURCES) \
           $(MODEL_SOURCES) $(MODEL_PARTS) $(CPP_MODEL_SOURCES) $(CPP_MODEL_PARTS) $(BENCHMARK_SOURCES) $(BENCHMARK_PARTS) \
           $(PEER_SOURCES)

# One short line per file; V=1 shows the commands.
V ?= 0
Q := $(if $(filter 1,$(V)),,@)
say = $(if $(findstring s,$(firstword -$(MAKEFLAGS))),@:,@echo)

# The version stands in the header and nowhere else.
VERSION := $(shell awk '/define CSCD_VERSION_/ {print $$3}' include/cscd/cscd.h | paste -sd .)
MAJOR   := $(firstword $(subst ., ,$(VERSION)))

# Objects have a folder of their own: a program may have the name of the folder of its parts.
OBJECTS := $(BUILD_ROOT)/$(CONFIG)$(MORE_CASES)/objects
objects = $(patsubst %.c,$(OBJECTS)/%.o,$(1))
KERNEL_OBJECTS := $(foreach level,$(LEVELS),$(patsubst %.c,$(OBJECTS)/%.$(level).o,$(KERNEL_SOURCES)))
CORE_OBJECTS := $(call objects,$(CORE_SOURCES)) $(KERNEL_OBJECTS)
# What tests of its parts link of libcscd-baselines.so.
BASELINE_OBJECTS := $(call objects,$(filter-out %_export.c,$(BASELINE_SOURCES)))
COMMON_OBJECTS := $(call objects,$(COMMON_SOURCES))
IO_OBJECTS     := $(call objects,$(filter tool/io/% tool/windows/%,$(COMMON_SOURCES)))
LIBRARY := $(BUILD)/libcscd.a
SHARED  := $(BUILD)/$(if $(WINDOWS),libcscd-$(MAJOR).dll,libcscd.so.$(VERSION))
BASELINES_SHARED := $(if $(filter 0,$(BASELINES)),,$(BUILD)/libcscd-baselines.so.$(VERSION))
TOOL    := $(BUILD)/cscd
TESTS   := $(addprefix $(BUILD)/,$(basename $(TEST_SOURCES)))
ROOMS   := $(sort $(foreach source,$(ROOM_SOURCES),$(BUILD)/$(dir $(source))room))
# Tests of 0.7 seconds or more of processor time in the release: `make test` runs them, `make check` leaves them out.
# tests/run.sh ends with the slowest programs of a run and their seconds: programs that become slow are added here.
SLOW_answers       := left_out
SLOW_baselines     := benchmarks contour iccd
SLOW_bvh           := bvh_order bvh_slivers near_triangles traversal
SLOW_ccd           := algebraic algebraic_oracle cubic elementary_degenerate elementary_exact elementary_oracle half_space min_separation_random root_finders separated_in_part
SLOW_core          := float_environment host_loop parallel_for progress
SLOW_cpp           := callbacks
SLOW_culling       := choice culling local_culling verlet_list
SLOW_depths        := deepest_points work_budget
SLOW_detector      := change_mesh lifetimes list_cap object_rules oracle reentry waiting_random
SLOW_energy        := energy_sums
SLOW_events        := event_tracker event_tracker_bodies
SLOW_install       := baseline_library embedding header_versions headers install places run_script
SLOW_intersections := collapsed curves find_intersections first_pairs live_answers memory_budget pair_kind static_check_kernel winding
SLOW_io            := frame_series point_caches
SLOW_jobs          := each job_processes list merge merge_files stopped_jobs
SLOW_loose         := loose_solver loose_steps
SLOW_mesh          := predicates triangle_intersection
SLOW_models        := cloth_scenes ipc_scenes programs recording_pawn recordings shape_regions shapes soft_body
SLOW_narrow_phase  := exclusions feature_queue orphan_pairs
SLOW_preprocess    := best_draft charge connected_regions cover labelling motion plan_failures rank_blocks regions stiffness
SLOW_proofs        := creations intersections solver_calls steps told
SLOW_report        := report_browser report_frames report_page report_view
SLOW_sensors       := exact_check partition partition_counts sensor_recall sensor_scenes
SLOW_solver        := float_march max_step
SLOW_tool          := large_recordings tool tool_export tool_figure tool_outputs tool_preprocess tool_render tool_shards tool_stop tool_streaming
rooms_of = $(sort $(notdir $(patsubst %/,%,$(dir $(1)))))
TEST_ROOMS := $(call rooms_of,$(wildcard tests/*/test_*.c*))
SLOW_TESTS := $(foreach room,$(call rooms_of,$(wildcard tests/*/test_*)),$(addprefix $(room)/test_,$(SLOW_$(room))))
$(foreach test,$(SLOW_TESTS),$(if $(wildcard tests/$(test).*),,$(warning tests/$(test) is called slow, but there is none)))
# They start first, and of these the longest, so that no processor waits for one of them at the end.
LONGEST_TESTS := report/test_report_browser report/test_report_view install/test_embedding preprocess/test_cover
IN_ORDER := $(filter $(addprefix $(BUILD)/tests/,$(LONGEST_TESTS)),$(TESTS))
IN_ORDER += $(filter-out $(IN_ORDER),$(TESTS))
FAST_TESTS := $(filter-out $(addprefix $(BUILD)/tests/,$(SLOW_TESTS)),$(TESTS))
C_MODELS   := $(patsubst models/%.c,$(BUILD)/models/%,$(MODEL_SOURCES))
CPP_MODELS := $(patsubst models/%.cpp,$(BUILD)/models/%,$(CPP_MODEL_SOURCES))
MODELS  := $(C_MODELS) $(CPP_MODELS)
BENCHMARKS := $(filter-out %/peers,$(patsubst benchmarks/%.c,$(BUILD)/benchmarks/%,$(BENCHMARK_SOURCES)))

COMMIT := $(shell git rev-parse --short=12 HEAD 2>/dev/null || echo unknown)

# What installs packages; a build that leaves expat out on purpose does not ask for it.
PACKAGES = BASELINES=$(BASELINES) EXPAT=$(if $(WITHOUT_EXPAT),0,1) .ci/packages

.PHONY: all python wheel wheels test-wheels sdist test-python programs test-programs tool library install install-library uninstall reference freeze-api packages demo models gallery bench reproduce bench-charge bench-peers bench-instructions referee bench-plot claims manual performance check check-run test test-run test-threads test-threads-run test-without-baselines test-without-sensors test-blender blender-extension test-vtk test-engine windows windows-libraries windows-zip test-windows test-windows-run test-bridges test-farm test-mutants test-aarch64 test-s390x wasm test-wasm test-riscv64 deb test-deb test-builds cscd-mpi python-oracle benchmarks template lint format examples clean help fuzz-elementary fuzz-surfaces fuzz-untangle fuzz-readers test-fuzz test-faults FORCE
.DELETE_ON_ERROR:
.SECONDARY:

# Installs no package: it says which are missing.
all:
	@$(PACKAGES) --tell build
	@$(MAKE) --no-print-directory tool library

tool: $(TOOL)
	@if [ "$(BUILD)" = build/release ]; then ln -sfn $(TOOL) cscd; fi

library: $(LIBRARY) $(SHARED) $(BASELINES_SHARED)

# The Python package as it is imported: PYTHONPATH=build/python. libcscd-baselines.so lies in it, unless BASELINES=0 leaves that out.
PYTHON_PACKAGE := $(BUILD_ROOT)/python/cscd
PYTHON_SOURCES := $(wildcard python/cscd/*.py python/cscd/py.typed)
NATIVE_LIBRARY := $(PYTHON_PACKAGE)/libcscd-python.$(if $(WINDOWS),dll,so)
PACKED_BASELINES := $(if $(filter-out 1,$(DYNAMIC)),$(if $(BASELINES_SHARED),$(PYTHON_PACKAGE)/libcscd-baselines.so.$(MAJOR)))
# What an older version, or a build with that library, has left there goes.
python: $(NATIVE_LIBRARY) $(BASELINES_SHARED)
	@cp -p $(PYTHON_SOURCES) $(PYTHON_PACKAGE)
	@$(if $(PACKED_BASELINES),cp -p $(BASELINES_SHARED) $(PACKED_BASELINES))
	@rm -rf $(filter-out $(addprefix $(PYTHON_PACKAGE)/,$(notdir $(PYTHON_SOURCES))) $(PACKED_BASELINES) $<,$(wildcard $(PYTHON_PACKAGE)/*))

# The interpreter that builds wheels and is tested: the first that has numpy.
PYTHON ?= $(or $(shell for python in python3 /usr/bin/python3; do \
              $$python -c 'import numpy' 2>/dev/null && echo $$python && break; done),/usr/bin/python3)
BACK_END = PYTHONPATH=python PYTHONDONTWRITEBYTECODE=1 CC='$(CC)' $(PYTHON) -m build_backend

# The wheel to give away, without libcscd-baselines.so, and the archive of the sources.
wheel:
	@$(BACK_END) wheel build/dist $(if $(HOST),$(HOST) '$(or $(WINDOWS_LIBRARIES),$(SYSROOT))')

# The wheels of all platforms, by the cross compilers and the libraries of Debian; and their tests, in emulators.
wheels: wheel windows-libraries
	@.ci/packages aarch64
	@packaging/sysroot.sh arm64 $(ARM64_SYSROOT) libc6-dev libpng-dev zlib1g-dev libjson-c-dev libexpat1-dev
	@$(MAKE) --no-print-directory wheel HOST=aarch64-linux-gnu SYSROOT=$(abspath $(ARM64_SYSROOT)) \
	    CC='$(CACHE)aarch64-linux-gnu-gcc --sysroot=$(abspath $(ARM64_SYSROOT))'
	@$(ON_WINDOWS) wheel

ARM64_SYSROOT := build/sysroot/arm64-wheel
test-wheels: packages wheels
	@.ci/packages wine
	@CC='$(CC)' tests/wheels/run.sh build/dist

sdist:
	@$(BACK_END) sdist build/dist

test-python:
	@$(PACKAGES) python
	@$(MAKE) --no-print-directory python python-oracle $(BUILD)/models/record $(BUILD)/models/folds $(BUILD)/models/mannequin
	@CC='$(CC)' $(PYTHON) python/tests/run.py

# Installs what is built and builds the rest; it needs no network and no package but those of `make`, and install-library
# none but those of the library.
PREFIX     ?= /usr/local
BINDIR     ?= $(PREFIX)/bin
LIBDIR     ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
MANDIR     ?= $(PREFIX)/share/man
# One word of the shell, whatever is in it.
quoted = '$(subst ','\'',$(1))'
INSTALLER = BUILD=$(call quoted,$(BUILD)) VERSION='$(VERSION)' STATIC_LIBS='$(CORE_LIBS) -pthread' BASELINES='$(BASELINES)' SENSORS='$(SENSORS)' \
            POINTER_SIZE='$(shell echo __SIZEOF_POINTER__ | $(CC) $(CFLAGS) -E -P -)' DESTDIR=$(call quoted,$(DESTDIR)) \
            BINDIR=$(call quoted,$(BINDIR)) LIBDIR=$(call quoted,$(LIBDIR)) INCLUDEDIR=$(call quoted,$(INCLUDEDIR)) \
            MANDIR=$(call quoted,$(MANDIR)) packaging/install.sh
install: $(TOOL) library
	@$(INSTALLER) install

install-library: library
	@$(INSTALLER) install-library

uninstall:
	@$(INSTALLER) uninstall

# The functions and classes of the library as HTML, from the comments of the headers; a warning of doxygen is an error.
reference:
	@$(PACKAGES) reference
	@mkdir -p build/reference
	@VERSION='$(VERSION)' OUTPUT=build/reference doxygen docs/Doxyfile

# Writes down what the public headers promise, for tests/install/test_headers.py; once 2.0.0 is released, additions alone.
freeze-api:
	@CC="$(CC)" tests/install/api_headers.py write

# Installs what the build or the tests need and this machine lacks.
packages:
	@$(PACKAGES)

demo: packages
	@$(MAKE) --no-print-directory tool $(BUILD)/models/record
	@BUILD=$(BUILD) models/demo.sh

# The recordings, and every shape at its default size; this takes about a minute, once.
models: packages
	@$(MAKE) --no-print-directory build/models/made

build/models/made: $(addprefix $(BUILD)/models/,record cloth ipc objects shape mannequin folds capsule_bend)
	@BUILD=$(BUILD) models/make.sh build/models
	@touch $@

# Redraws the pictures of README and docs.
gallery: models
	@.ci/packages browser
	@$(MAKE) --no-print-directory tool
	@BUILD=$(BUILD) models/gallery.sh build/models docs/images

# All programs and all tests, without running them.
programs: tool library $(MODELS) $(BENCHMARKS)
test-programs: $(TESTS)

# Everything for Windows, by the compiler and the libraries of Debian's packages, in build/x86_64-w64-mingw32: programs and tests are
# compiled, and nothing is run. The archive to give away: make windows-zip.
CACHE := $(if $(findstring ccache,$(CC)),ccache )
ON_WINDOWS = $(MAKE) --no-print-directory HOST=x86_64-w64-mingw32 CC='$(CACHE)x86_64-w64-mingw32-gcc-posix' \
             CXX='$(CACHE)x86_64-w64-mingw32-g++-posix'
windows-libraries:
	@.ci/packages windows
	@packaging/libraries.sh x86_64-w64-mingw32 build/windows/libraries libpng json-c expat cmocka

windows: windows-libraries
	+@$(ON_WINDOWS) tool library

WINDOWS_ARCHIVE := build/dist/cscd-$(VERSION)-windows-x86_64.zip
windows-zip: windows
	@mkdir -p build/dist
	@packaging/windows/pack.py build/x86_64-w64-mingw32/release build/windows/libraries $(VERSION) $(WINDOWS_ARCHIVE)

# The tests under wine. What needs FLINT and Arb is asked from answers that Linux has written, and plans are compared with its own.
ANSWERS := build/windows/answers
test-windows: packages windows-zip
	@.ci/packages wine
	@$(MAKE) --no-print-directory $(BUILD)/tests/windows/write_answers $(TOOL) $(BUILD)/models/shape
	@$(BUILD)/tests/windows/write_answers $(ANSWERS) 20000
	+@ANSWERS=$(abspath $(ANSWERS)) NATIVE=$(abspath $(BUILD)) ARCHIVE=$(WINDOWS_ARCHIVE) $(ON_WINDOWS) test-windows-run

test: packages
	@$(if $(TEST_SOURCES),,$(error no test has a word of ONLY="$(ONLY)" in its name))
	@$(if $(filter $(BROWSER_TESTS),$(TEST_SOURCES)),.ci/packages browser)
	@$(MAKE) --no-print-directory test-run

# The inner loop: the tests that take less than 0.7 seconds each.
check: packages
	@$(MAKE) --no-print-directory check-run

# Tests run these programs, too.
TESTED_BENCHMARKS := $(addprefix $(BUILD)/benchmarks/,queries methods volumes)
check-run: tool library $(FAST_TESTS) $(MODELS) $(TESTED_BENCHMARKS)
	@BUILD=$(BUILD) tests/run.sh $(FAST_TESTS)

test-run: tool library $(TESTS) $(MODELS) $(TESTED_BENCHMARKS)
	@BUILD=$(BUILD) tests/run.sh $(IN_ORDER)

# Frames of glTF files beside the vertices that Blender itself evaluates, and faces that its script selects; nothing else needs
# Blender.
test-blender:
	@.ci/packages blender
	@$(MAKE) --no-print-directory tool $(BUILD)/tests/blender/print_frames
	@$(MAKE) --no-print-directory python blender-extension
	@BUILD=$(BUILD) PYTHON_PACKAGE=$(BUILD_ROOT)/python PAGE=$(PAGE) tests/blender/run.sh

# The extension as an archive that Blender installs, with the wheels of all platforms in it: build/blender/cscd_blender-VERSION.zip.
# WHEELS="FILE..." packs these instead, such as the one of `make wheel`.
WHEELS ?=
blender-extension: $(if $(WHEELS),,wheels)
	@python3 blender/pack.py build/blender $(or $(WHEELS),build/dist/cscd-$(VERSION)-py3-none-linux_x86_64.whl \
	    build/dist/cscd-$(VERSION)-py3-none-linux_aarch64.whl build/dist/cscd-$(VERSION)-py3-none-win_amd64.whl)

# What --vtk writes, read by VTK itself and compared with the other outputs; nothing else needs VTK.
test-vtk:
	@.ci/packages vtk
	@$(MAKE) --no-print-directory tool
	@BUILD=$(BUILD) tests/vtk/run.sh

# Soft bodies of Bullet, whose frames cscd makes safe; nothing else needs Bullet. ENGINE: options of the program, such as
# "--scene press". PAGE=--write draws the pictures of docs/solver/in-your-engine.md.
ENGINE ?=
ENGINE_OBJECTS := $(patsubst %.cpp,$(OBJECTS)/%.o,$(wildcard tests/engine/*.cpp))
$(ENGINE_OBJECTS): CPPFLAGS += $(patsubst -I%,-isystem %,$(shell pkg-config --cflags bullet))
$(BUILD)/tests/engine/soft_bodies: $(ENGINE_OBJECTS) $(LIBRARY)
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CXX) $(LINK_ALL) -o $@ $^ $(shell pkg-config --libs bullet) -lm
test-engine:
	@.ci/packages engine
	@$(MAKE) --no-print-directory tool $(BUILD)/tests/engine/soft_bodies
	@BUILD=$(BUILD) PAGE=$(PAGE) tests/engine/run.sh $(ENGINE)

# The shards of a list on the ranks of MPI; nothing else needs MPI. With another compiler wrapper: MPICC=...
MPICC ?= mpicc
MPI_SOURCES := $(wildcard tool/mpi/*.c)
cscd-mpi: $(BUILD)/cscd-mpi
$(BUILD)/cscd-mpi: $(MPI_SOURCES)
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)OMPI_CC='$(CC)' $(MPICC) -std=c11 -D_GNU_SOURCE $(OPTIMISE_$(CONFIG)) $(WARNINGS) -I. $(CFLAGS) $(MPI_SOURCES) $(LDFLAGS) -o $@

# Shards that the engines of docs/artist/engines.md start, and whose node dies; nothing else needs these. As root, for the daemons.
test-farm:
	@.ci/packages farm
	@$(MAKE) --no-print-directory tool cscd-mpi
	@$(MAKE) --no-print-directory python
	@CSCD=$(abspath $(BUILD)/cscd) CSCD_MPI=$(abspath $(BUILD)/cscd-mpi) PYTHONPATH=$(abspath $(BUILD_ROOT)/python) tests/farm/run.sh

# The Python package beside meshio, VTK and torch, by the blocks of docs/python/bridges.md; nothing else needs these.
test-bridges:
	@.ci/packages bridges
	@$(MAKE) --no-print-directory python $(BUILD)/models/folds
	@BUILD=$(BUILD) /usr/bin/python3 python/tests/run.py bridges

# The tests on other processors, by emulation: about an hour on two cores. Nothing is installed for these processors; Debian's
# libraries are unpacked into build/sysroot.
test-aarch64:
	@.ci/packages aarch64
	@tests/cross/emulated.sh arm64 $(or $(ONLY),all)

# The library for WebAssembly, by Debian's emscripten, in build/wasm32-emscripten; and what node finds with it, compared with this
# machine, and the tests of core, mesh, preprocessing and runtime.
wasm:
	@.ci/packages wasm
	@$(MAKE) --no-print-directory HOST=wasm32-emscripten CC=emcc build/wasm32-emscripten/release/libcscd.a

test-wasm: wasm
	@$(MAKE) --no-print-directory $(BUILD)/tests/wasm/contacts
	@packaging/libraries.sh wasm32-emscripten build/wasm32-emscripten/libraries cmocka
	@$(MAKE) --no-print-directory HOST=wasm32-emscripten CC=emcc NATIVE=$(BUILD)/tests/wasm/contacts test-wasm-run

# Big-endian: the tests of what reads files, and of the detector.
test-s390x:
	@.ci/packages s390x
	@tests/cross/emulated.sh s390x $(or $(ONLY),rooms)

# The tool alone, with libraries that are built from Debian's sources, because Debian has no packages of them for this processor.
test-riscv64:
	@.ci/packages riscv64
	@tests/cross/emulated.sh riscv64 $(or $(ONLY),all)

# Debian's packages of the last commit, in build/deb; test-deb builds them twice, installs them, tests them and purges them.
deb:
	@.ci/packages deb
	@packaging/deb.sh build/deb

test-deb:
	@.ci/packages deb
	@tests/deb/run.sh build/test-deb

# Builds and installations in the ways that users ask for, each in a copy of the sources, as root: some minutes.
test-builds: packages
	@.ci/packages checks
	@tests/builds/run.sh build/test-builds

# What is left without runtime/baselines builds, and passes its tests: about a minute.
test-without-baselines test-without-sensors: test-without-%: packages
	@tests/without.sh $*

# Faults planted one at a time in copies of the sources, and the tests that catch them: tests/mutants/run.py says what the words are for.
SAMPLE ?=
export MATRIX KEEP RESUME
test-mutants: packages
	@CC='$(CC)' SAMPLE='$(SAMPLE)' ONLY='$(ONLY)' ROOM='$(ROOM)' PYTHONDONTWRITEBYTECODE=1 $(PYTHON) tests/mutants/run.py

# The tests that use threads, under the thread sanitizer.
test-threads: packages
	@$(MAKE) --no-print-directory CONFIG=tsan test-threads-run

test-threads-run: $(TESTS)
	@BUILD=$(BUILD) TSAN_OPTIONS=halt_on_error=1 tests/run.sh $(TESTS)

# Random queries against the exact oracle; 0 is no limit.
SECONDS ?= 60
QUERIES ?= 0
SEED    ?= 1
KIND    ?= both
fuzz-elementary: packages
	@$(MAKE) --no-print-directory $(BUILD)/tests/fuzz/fuzz_elementary
	@$(BUILD)/tests/fuzz/fuzz_elementary $(SECONDS) $(QUERIES) $(SEED) $(KIND)

# Curves, patches and winding numbers of random small scenes against the exact oracle.
SCENES ?= 1000000
fuzz-surfaces: packages
	@$(MAKE) --no-print-directory $(BUILD)/tests/fuzz/fuzz_surfaces
	@$(BUILD)/tests/fuzz/fuzz_surfaces $(SCENES) $(SEED)

# Random tangles, untangled and judged by whole numbers and by what is promised; 0 is no limit.
TANGLES ?= 0
fuzz-untangle: packages
	@$(MAKE) --no-print-directory $(BUILD)/tests/fuzz/fuzz_untangle
	@$(BUILD)/tests/fuzz/fuzz_untangle $(SECONDS) $(TANGLES) $(SEED)

# Files of every format with random damage, and random scenes against exact answers, SECONDS for each kind; SEED: hexadecimal.
FUZZERS := $(patsubst %.c,$(BUILD_ROOT)/sanitize/%,$(FUZZ_SOURCES))
test-fuzz: packages
	@$(MAKE) --no-print-directory tool $(BUILD)/models/shape $(BUILD)/models/mannequin
	@$(MAKE) --no-print-directory CONFIG=sanitize $(FUZZERS)
	@MAKERS=$(BUILD) BUILD=$(BUILD_ROOT)/sanitize tests/fuzz/run.sh $(SECONDS) $(SEED)

# Files of every format, or of FORMATS="gltf ply", that libFuzzer makes by the paths that they take through our code, SECONDS for each;
# KEEP=1 keeps those that reach new code in tests/fuzz/corpus. It takes clang, and what comes with it on Debian as libclang-rt-*-dev.
FORMATS ?=
KEEP    ?= 0
fuzz-readers:
	@.ci/packages fuzzing
	@$(MAKE) --no-print-directory CONFIG=fuzz CC='$(patsubst %gcc,%clang,$(CC))' $(BUILD_ROOT)/fuzz/tests/fuzz/coverage_target
	@KEEP=$(KEEP) tests/fuzz/coverage.sh $(SECONDS) $(BUILD_ROOT)/fuzz/tests/fuzz/coverage_target $(BUILD_ROOT)/fuzz/found $(FORMATS)

# Every command when memory or the disk runs out at each place, and when inputs end at each byte. SHARE=N: at every N-th place, from one
# that SEED chooses, a hexadecimal number.
SHARE ?= 1
FAILING_MEMORY := $(BUILD)/tests/faults/failing_memory.so
test-faults: packages
	@$(MAKE) --no-print-directory tool $(BUILD)/models/shape $(BUILD)/models/mannequin $(FAILING_MEMORY)
	@PYTHONDONTWRITEBYTECODE=1 tests/faults/run.py $(BUILD) $(FAILING_MEMORY) $(SHARE) $(SEED)

$(FAILING_MEMORY): tests/faults/failing_memory.c
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) -std=c11 -O2 $(WARNINGS) -fPIC -shared $(CFLAGS) -o $@ $< $(LDFLAGS) -ldl

benchmarks: packages
	@$(MAKE) --no-print-directory $(BENCHMARKS)

# All methods on all recordings; this takes some minutes. BENCH: options of benchmarks/methods, such as --quick.
BENCH ?= --json build/bench.json
bench: packages
	@$(MAKE) --no-print-directory $(BUILD)/benchmarks/methods
	@$(BUILD)/benchmarks/methods $(BENCH)

# The tables and figures of both theses, with their numbers beside ours: docs/theory/thesis.md.
reproduce: packages
	@.ci/packages reproduce
	@$(MAKE) --no-print-directory tool $(addprefix $(BUILD)/benchmarks/,thesis thesis_figures volumes experiments $(if $(HAS_SENSORS),sensors))
	@benchmarks/reproduce.sh $(BUILD)

# The cost of a step by size, scene and machine, on one thread except for the rows on threads; some minutes.
PERFORMANCE_PROGRAMS := machine scaling threads motion cloth topology callers loose
performance: packages
	@$(MAKE) --no-print-directory $(addprefix $(BUILD)/benchmarks/,$(PERFORMANCE_PROGRAMS))
	@for program in $(PERFORMANCE_PROGRAMS); do \
	    echo; echo "== $$program"; $(BUILD)/benchmarks/$$program $(PERFORMANCE) || exit 1; done

# Embree's broad phase and CGAL's check beside ours (Debian: libembree-dev, libcgal-dev), which nothing else needs. PEERS: options
# of benchmarks/peers, or pairs of mesh files.
PEERS ?= --json build/peers.json
bench-peers:
	@$(PACKAGES) peers
	@$(MAKE) --no-print-directory $(BUILD)/benchmarks/peers
	@$(BUILD)/benchmarks/peers $(PEERS)

# Our pairs of triangles beside those of CGAL, tetgen and MeshLab, which nothing else needs: docs/about/referee.md. REFEREE: options of
# benchmarks/referee/compare.py, such as --quick.
referee:
	@$(PACKAGES) referee
	@$(MAKE) --no-print-directory $(BUILD)/benchmarks/referee $(BUILD)/benchmarks/cgal_pairs
	@PYTHONDONTWRITEBYTECODE=1 benchmarks/referee/compare.py --build $(BUILD) $(REFEREE)

$(BUILD)/benchmarks/cgal_pairs: benchmarks/referee/cgal_pairs.cpp
	@mkdir -p $(@D)
	$(say) '  CXX $<'
	$(Q)$(CXX) -std=c++17 -O3 -DNDEBUG -frounding-math $(CXXFLAGS) -o $@ $< -lmpfr -lgmp

# Instructions by kernel and by room on x86-64 and on aarch64, counted by an emulator: the same on every machine. About two minutes.
bench-instructions:
	@.ci/packages aarch64
	@tests/cross/emulated.sh arm64 build
	@$(MAKE) --no-print-directory tool $(BUILD)/models/record
	@BUILD=$(BUILD) CC='$(CC)' benchmarks/instructions/run.sh

# Charges: their errors, times and memory, up to 1,000,000 triangles; CHARGE_BENCH: options of benchmarks/charge, such as --quick.
CHARGE_BENCH ?= --json build/bench-charge.json
bench-charge: packages
	@$(MAKE) --no-print-directory $(BUILD)/benchmarks/charge
	@$(BUILD)/benchmarks/charge $(CHARGE_BENCH)

# The page cscd(1), from what the tool says of its options.
manual: tool
	@python3 packaging/manual.py $(BUILD)/cscd

# The page of what we claim, docs/about/measurements.md, from the tables in benchmarks/results.
claims:
	@python3 benchmarks/claims.py

# The charts of docs/about/measurements.md, from the last make bench and make bench-charge.
bench-plot:
	@.ci/packages plots
	@for kind in methods charge; do \
	    json=build/bench$$(test $$kind = methods || echo -$$kind).json; \
	    if [ ! -e $$json ]; then echo "$$json is missing, so nothing of it is drawn"; continue; fi; \
	    benchmarks/plot.sh $$kind $$json docs/images || exit 1; done

# Bundles the page of the reports from its sources. The result is committed, so only those who change it need node.
template:
	@command -v node >/dev/null && command -v npm >/dev/null || { \
	    echo 'make template needs node and npm (Debian: nodejs, npm), to bundle tool/report/web' >&2; exit 1; }
	@cd tool/report/web && npm ci --no-audit --no-fund && node build.mjs

lint: packages
	@.ci/lint

format:
	clang-format -i $$(git ls-files '*.c' '*.h' '*.cpp' '*.hpp')

examples: packages
	@CC="$(CC)" .ci/examples

clean:
	rm -rf build cscd

help:
	@echo 'make demo      a soft pawn falls and bows: simulate it, find its contacts with itself, draw it'
	@echo 'make models    all shapes and recordings, in build/models'
	@echo 'make gallery   redraw the pictures of README and docs'
	@echo 'make check     build and run the tests that take less than a second each, for the inner loop'
	@echo 'make test      build and run every test (CONFIG=sanitize: with sanitizers; ONLY="bvh line_search": of these rooms or names;'
	@echo '               NIGHTLY=1: more random cases, in a folder of its own)'
	@echo 'make test-without-baselines   build and test what is left when runtime/baselines is removed; make test-without-sensors'
	@echo 'make test-mutants   plant faults in copies of the sources, and show which test catches each (ROOM="tool/io": its own)'
	@echo 'make test-blender   frames of glTF files beside those that Blender evaluates, faces selected in it, the extension, and the steps of docs/artist/from-your-program.md'
	@echo '               (installs blender); PAGE=--write puts what the steps print into the page, and draws its pictures'
	@echo 'make blender-extension   the extension of Blender, with the Python package in it, in build/blender'
	@echo 'make test-vtk   what --vtk writes, read by VTK and compared with the other outputs (installs python3-vtk9)'
	@echo 'make test-engine   soft bodies of Bullet, made safe frame by frame: five minutes (installs libbullet-dev; ENGINE="--scene press");'
	@echo '               PAGE=--write draws the pictures of docs/solver/in-your-engine.md'
	@echo 'make cscd-mpi       build/release/cscd-mpi, for docs/artist/engines.md: needs MPI, as Debian has it in libopenmpi-dev'
	@echo 'make test-farm      shards that the engines of docs/artist/engines.md start, and whose node dies (installs these)'
	@echo 'make windows   the tool and the library for Windows, in build/x86_64-w64-mingw32 (installs mingw-w64); make windows-zip: to give'
	@echo '               away, in build/dist; make test-windows: the tests under wine (installs wine64)'
	@echo 'make test-bridges   the blocks of docs/python/bridges.md, with meshio, VTK and torch (installs these)'
	@echo 'make test-aarch64   every test under qemu-user, and the same bits as on this machine: about an hour (installs cross compilers, qemu);'
	@echo '               make test-s390x: those of readers and detector on a big-endian processor; ONLY=quick, ONLY="core/test_simd"'
	@echo 'make test-riscv64   files of every format and replays give the bytes of this machine, under qemu-user; ONLY=quick'
	@echo 'make wasm      the library for WebAssembly, in build/wasm32-emscripten (installs emscripten); make test-wasm: under node, its'
	@echo '               contacts beside those of this machine, sizes of more than 4 GiB, and tests of core, mesh, preprocess and runtime (ONLY="bvh")'
	@echo 'make deb       Debian packages of the last commit, in build/deb (installs debhelper, doxygen); make test-deb: built twice, installed,'
	@echo '               tested and purged, as root (installs lintian, autopkgtest)'
	@echo 'make test-builds   other compilers, flags, users and folders, and without each optional library; as root: some minutes'
	@echo 'make test-threads   the tests that use threads, under the thread sanitizer'
	@echo 'make           build the tool (./cscd), build/release/libcscd.a and libcscd.so; make library builds these alone'
	@echo '               BASELINES=0: without libcscd-baselines.so, for LAPACKE, OpenBLAS and GSL (--charge dense); SENSORS=0: without sense;'
	@echo '               EXPAT=0: a tool without GIFTI surfaces'
	@echo 'make python    the Python package, in build/python; make wheel: a wheel to give away, make sdist: its sources, in build/dist;'
	@echo '               make test-python: its tests, types and archives (installs pytest, mypy, venv); PYTHON=python3'
	@echo 'make wheels    the wheels of Linux (x86-64, aarch64) and Windows, in build/dist (installs cross compilers); make test-wheels:'
	@echo '               what is in them, and that they work in emulators (installs qemu-user, wine64)'
	@echo 'make install   [PREFIX=/usr/local] [DESTDIR=] tool, library, man pages; make install-library; make uninstall'
	@echo 'make reference   the functions of the library as HTML, in build/reference (installs doxygen)'
	@echo 'make freeze-api   write down what the public headers promise, when functions or members were added'
	@echo 'make bench     all methods on all recordings (BENCH=--quick: 30 s); make bench-plot draws its charts'
	@echo 'make reproduce   the tables and figures of both theses, with their numbers beside ours: five minutes'
	@echo 'make manual    docs/man/cscd.1, from what --help says'
	@echo 'make claims    docs/about/measurements.md, from the tables in benchmarks/results'
	@echo 'make bench-charge   errors, times and memory of charges (CHARGE_BENCH=--quick: 20 s); make bench-plot draws its charts'
	@echo 'make performance   machine limits, cost per triangle by size, threads, bulk motion, cloth, new meshes (PERFORMANCE=--quick)'
	@echo 'make benchmarks   build all programs that print tables: docs/about/measurements.md'
	@echo 'make bench-peers   steps beside Embree'"'"'s broad phase, checks beside CGAL'"'"'s (installs these; PEERS="--quick", or FIRST SECOND of frames)'
	@echo 'make bench-instructions   instructions by kernel on x86-64 and aarch64, counted under qemu-user (installs it, and a cross compiler)'
	@echo 'make referee   pairs of triangles beside those of CGAL, tetgen and MeshLab (installs these; REFEREE=--quick)'
	@echo 'make fuzz-elementary   elementary tests against exact answers, [SECONDS=60] [QUERIES=0] [SEED=1] [KIND=both]'
	@echo 'make fuzz-surfaces   curves, patches and winding numbers against exact answers, [SCENES=1000000] [SEED=1]'
	@echo 'make fuzz-untangle   random tangles, each result against exact answers and promises, [SECONDS=60] [TANGLES=0] [SEED=1]'
	@echo 'make fuzz-readers   files of every format by coverage-guided fuzzing, [SECONDS=60] for each, [FORMATS="gltf ply"] (installs clang);'
	@echo '               KEEP=1 keeps those that reach new code in tests/fuzz/corpus'
	@echo 'make test-fuzz   the kept files, damaged files of every format, and the three kinds of scenes, [SECONDS=60] for each kind, [SEED=1]'
	@echo 'make test-faults   every command when memory, disk or an input ends early, [SHARE=1] of the places, from [SEED=1] on'
	@echo 'make template  bundle the page of the reports, after changes in tool/report/web (needs node and npm)'
	@echo 'make lint      format, file sizes, rooms, names, exported symbols'
	@echo 'make examples  compile and run the examples of README and docs'
	@echo 'make format    clang-format all sources; make clean removes build/'

# A static library is one relocatable object in which everything but the public API is local.
ifeq ($(WINDOWS)$(WASM),)
$(LIBRARY): $(CORE_OBJECTS)
	@mkdir -p $(@D)
	$(say) '  AR $@'
	$(Q)$(TOOLS)ld -r -o $(@:.a=.o) $^
	$(Q)$(TOOLS)objcopy --localize-hidden $(@:.a=.o)
	@rm -f $@
	$(Q)$(TOOLS)ar rcs $@ $(@:.a=.o)
endif

# The shared library names the libraries that it needs, so that a user links -lcscd alone. The functions of sanitizers
# come with the program.
SHARED_FLAGS := -shared -Wl,--as-needed $(if $(findstring -fsanitize,$(OPTIMISE_$(CONFIG))),,-Wl,-z,defs)
ifndef WINDOWS
$(SHARED): $(CORE_OBJECTS) $(BUILD)/cscd.map
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) $(SHARED_FLAGS) -Wl,-soname,libcscd.so.$(MAJOR) -Wl,--version-script,$(BUILD)/cscd.map \
	    -o $@ $(CORE_OBJECTS) $(CORE_LIBS)
	@ln -sfn $(@F) $(BUILD)/libcscd.so.$(MAJOR)
	@ln -sfn libcscd.so.$(MAJOR) $(BUILD)/libcscd.so
endif

# All of the tool but its program, and what Python calls. Its own functions are meant wherever it calls one of the library, whatever
# else the process has loaded.
NATIVE_OBJECTS := $(if $(filter 1,$(DYNAMIC)),,$(CORE_OBJECTS)) $(COMMON_OBJECTS) $(call objects,$(filter-out tool/main.c,$(COMMAND_SOURCES)) $(NATIVE_SOURCES)) \
                  $(if $(filter 1,$(DYNAMIC)),$(SHARED))
NATIVE_FILE_LIBS = $(if $(filter 1,$(DYNAMIC)),$(FILE_LIBS),$(call packaged,--static --libs libpng zlib json-c,-lpng -lz -ljson-c -lm) $(EXPAT_LIBS))
ifndef WINDOWS
$(NATIVE_LIBRARY): $(NATIVE_OBJECTS) python/native/link.sh
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)LINK='$(CC) $(LINK_ALL) $(SHARED_FLAGS) -Wl,-Bsymbolic' FILE_LIBS='$(NATIVE_FILE_LIBS)' OTHER_LIBS='$(CORE_LIBS)' \
	    DYNAMIC='$(DYNAMIC)' OBJCOPY=$(TOOLS)objcopy python/native/link.sh $@ $(NATIVE_OBJECTS)
endif

# It exports a function for each of its parts, and needs two more files of libcscd.
BASELINE_LIBRARY_OBJECTS := $(call objects,$(BASELINE_SOURCES) preprocess/charge/potential.c)
$(BUILD)/libcscd-baselines.so.$(VERSION): $(BASELINE_LIBRARY_OBJECTS)
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) $(SHARED_FLAGS) -Wl,-soname,libcscd-baselines.so.$(MAJOR) -o $@ $^ $(BASELINE_LIBS)
	@ln -sfn $(@F) $(BUILD)/libcscd-baselines.so.$(MAJOR)

# The tool finds it beside itself here, and in the prefix where it is installed. Programs below the build folder find it by their paths
# for libraries; of the two kinds it is the older one, because sanitizers open libraries in the place of a program.
ifndef WINDOWS
FINDS_BASELINES := -Wl,--disable-new-dtags,-rpath,'$$ORIGIN/..:$$ORIGIN/../..'
endif
$(TOOL) $(C_MODELS) $(CPP_MODELS) $(BENCHMARKS) $(ROOMS): | $(BASELINES_SHARED)

$(BUILD)/cscd.map: packaging/cscd.map.in include/cscd/cscd.h
	@mkdir -p $(@D)
	@sed 's/@MAJOR@/$(MAJOR)/g' $< > $@

# The tool uses the public API alone, so it links the library and not its objects.
$(TOOL): $(call objects,$(COMMAND_SOURCES)) $(COMMON_OBJECTS) $(if $(filter 1,$(DYNAMIC)),$(SHARED),$(LIBRARY))
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) -o $@ $^ $(if $(filter 1,$(DYNAMIC)),$(FILE_LIBS) -lm,$(TOOL_LIBS))

# models/*.c are programs, and models/*/ has their parts; they use the public API alone, too.
MODEL_PART_OBJECTS := $(call objects,$(MODEL_PARTS))
$(C_MODELS): $(BUILD)/models/%: $(OBJECTS)/models/%.o $(MODEL_PART_OBJECTS) $(IO_OBJECTS) $(LIBRARY)
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) $(FINDS_BASELINES) -o $@ $^ $(TOOL_LIBS)

# Programs in C++ have parts in C++ alone.
$(CPP_MODELS): $(BUILD)/models/%: $(OBJECTS)/models/%.o $(patsubst %.cpp,$(OBJECTS)/%.o,$(CPP_MODEL_PARTS)) \
               $(filter $(OBJECTS)/tool/windows/%,$(IO_OBJECTS)) $(LIBRARY)
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) $(FINDS_BASELINES) -o $@ $^ $(CORE_LIBS) -lstdc++ -lm

# Benchmarks may use internals, as tests do: benchmarks/*.c are programs, and benchmarks/lib has what they share.
MACHINE_LEVELS := $(foreach level,$(LEVELS),$(OBJECTS)/benchmarks/lib/machine_kernels_simd.$(level).o)
$(MACHINE_LEVELS): CFLAGS_ALL += -fno-tree-vectorize -fno-tree-slp-vectorize
$(BUILD)/benchmarks/lib.a: $(call objects,$(BENCHMARK_PARTS)) $(MACHINE_LEVELS)
	@mkdir -p $(@D)
	@rm -f $@
	$(Q)$(TOOLS)ar rcs $@ $^

# benchmarks/peers/ has the other programs, one of them in C++.
PEER_OBJECTS := $(addprefix $(OBJECTS)/,$(addsuffix .o,$(basename $(PEER_SOURCES))))
$(BUILD)/benchmarks/peers: $(PEER_OBJECTS)
$(BUILD)/benchmarks/peers: PEER_LIBS := -lembree3 -lmpfr -lstdc++
$(OBJECTS)/benchmarks/peers/cgal_peer.o: OPTIMISE_$(CONFIG) += -DNDEBUG -frounding-math
$(BENCHMARKS) $(BUILD)/benchmarks/peers: $(BUILD)/benchmarks/%: $(OBJECTS)/benchmarks/%.o $(BUILD)/benchmarks/lib.a $(BUILD)/inside.a
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) $(FINDS_BASELINES) -Wl,--as-needed -o $@ $(filter %.o,$^) $(filter %.a,$^) $(TOOL_LIBS) -lgmp $(PEER_LIBS)

# Tests use internals: they link the objects and libraries that they need and no others. The linker gold, where it is, takes half
# of the time. LDFLAGS with another linker come after it, and win. What tests put in the place of the product's is wrapped.
TEST_LINKER := $(if $(HOST),,$(shell $(CC) -fuse-ld=gold -Wl,--version >/dev/null 2>&1 && echo -fuse-ld=gold))
TEST_PARTS  := $(OBJECTS)/tests/support/room.o $(OBJECTS)/tests/support/io_allocations.o $(BUILD)/tests/support.a $(BUILD)/inside.a
WRAPPED     := -Wl,--wrap=io_realloc
LINK_TEST    = $(Q)$(CC) $(TEST_LINKER) $(LINK_ALL) $(FINDS_BASELINES) -Wl,--as-needed $(WRAPPED) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(TEST_LIBS)
$(ROOMS): $(TEST_PARTS)
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(LINK_TEST)

# A link with the name of each file starts the program of the room with it.
define room_rules
$(BUILD)/tests/$(1)/room: $(addprefix $(OBJECTS)/,$(addsuffix .o,$(basename $(filter tests/$(1)/%,$(ROOM_SOURCES)))))
$(addprefix $(BUILD)/,$(basename $(filter tests/$(1)/%,$(ROOM_SOURCES)))): $(BUILD)/tests/$(1)/room
	@ln -sfn room $$@
endef
$(foreach room,$(TEST_ROOMS),$(eval $(call room_rules,$(room))))

# A link with the name of a file of pytest starts that with it. It may have been one of the room, when the file was in C.
PYTEST_LINKS := $(addprefix $(BUILD)/,$(basename $(filter %.py,$(TEST_SOURCES))))
$(PYTEST_LINKS): FORCE
	@[ $@ -ef tests/run_pytest.py ] || { mkdir -p $(@D) && ln -sfn $(CURDIR)/tests/run_pytest.py $@; }

# By its name a test finds its file: tests/support/test.h.
test_file = $(if $(filter test_%,$(notdir $(1))),-DTEST_FILE='"$(basename $(notdir $(1)))"')

# Programs beside those of rooms.
$(BUILD)/tests/%: $(OBJECTS)/tests/%.o $(BUILD)/tests/support.a $(BUILD)/inside.a
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(TEST_LINKER) $(LINK_ALL) $(FINDS_BASELINES) -Wl,--as-needed -o $@ $(filter %.o,$^) $(filter %.a,$^) $(TEST_LIBS)

# Brute force for the tests of the Python package, which load it.
PYTHON_ORACLE := $(BUILD)/tests/python/oracle.so
python-oracle: $(PYTHON_ORACLE)
$(PYTHON_ORACLE): $(OBJECTS)/tests/python/oracle.o $(BUILD)/tests/support.a $(BUILD)/inside.a
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) -shared -Wl,-Bsymbolic,--as-needed -o $@ $^ $(TEST_LIBS)

# Parts of tests that are compiled once per instruction set.
TEST_LEVELS := $(foreach level,$(LEVELS),$(OBJECTS)/tests/core/simd_operations_simd.$(level).o)
$(BUILD)/tests/core/room: $(TEST_LEVELS)

# Whether there are baselines or sensors is a word on the command line, which a compiler cache looks at; at __has_include it does not.
$(OBJECTS)/tests/support/variants.o: CFLAGS_ALL += $(if $(HAS_BASELINES),-DWITH_BASELINES)
$(OBJECTS)/tool/tool.o: CFLAGS_ALL += $(if $(HAS_SENSORS),-DWITH_SENSORS)

# Readers that one command has for itself, and what damaged files and those of libFuzzer go through.
READING_OBJECTS := $(call objects,tests/fuzz/readings.c tool/summary_file.c)
$(BUILD)/tests/fuzz/fuzz_readers $(BUILD)/tests/fuzz/coverage_target: $(READING_OBJECTS)
# gold warns of hundreds of the sanitizer's own symbols.
$(BUILD)/tests/fuzz/coverage_target: TEST_LINKER :=
$(BUILD)/tests/fuzz/coverage_target: LINK_ALL += -fsanitize=fuzzer

$(BUILD)/tests/cpp/room $(if $(WASM),,$(BUILD)/tests/sensors/room): TEST_LIBS += -lstdc++
ifneq ($(filter tests/ccd/test_root_finders.c,$(ROOM_SOURCES)),)
$(BUILD)/tests/ccd/room: WRAPPED += -Wl,--wrap=cubic_guess_roots
endif

# Elementary tests go through the same batches in tests and benchmarks, and densities are compared alike.
$(BUILD)/tests/support.a: $(call objects,$(SUPPORT_SOURCES) benchmarks/lib/pair_batches.c benchmarks/lib/density_ranks.c models/shapes/extreme_shapes.c)
	@mkdir -p $(@D)
	@rm -f $@
	$(Q)$(TOOLS)ar rcs $@ $^

# A program on the public functions alone, for two machines.
$(BUILD)/tests/wasm/contacts: $(OBJECTS)/tests/wasm/contacts.o $(LIBRARY)
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) -o $@ $^ $(CORE_LIBS)

# q: objects of different folders may have the same name. Windows and WebAssembly, which have no libcscd-baselines, have one for tests.
$(BUILD)/inside.a: $(filter-out $(if $(WINDOWS)$(WASM),%/src/core/baseline_library.o),$(CORE_OBJECTS)) $(BASELINE_OBJECTS) $(COMMON_OBJECTS) $(MODEL_PART_OBJECTS)
	@mkdir -p $(@D)
	@rm -f $@
	$(Q)$(TOOLS)ar qcs $@ $^

define compile_level
$$(OBJECTS)/%.$(1).o: %.c
	@mkdir -p $$(@D)
	$$(say) '  CC $$< ($(1))'
	$$(Q)$$(CC) $$(CFLAGS_ALL) $$(LEVEL_$(1)) -c -o $$@ $$<
endef
$(foreach level,$(LEVELS),$(eval $(call compile_level,$(level))))

# Under sanitizers -O1 compiles quickly; what tests run longest, the library and the programs of models/, pays for -O2.
ifneq ($(filter sanitize tsan,$(CONFIG)),)
$(addprefix $(OBJECTS)/,src/core/% src/mesh/% preprocess/% runtime/% models/%): CFLAGS_ALL += -O2
endif
# A machine on which tests repeat less, because programs take many times as long there: with sanitizers, or in an emulator.
TEST_PACE := $(if $(filter sanitize tsan,$(CONFIG))$(HOST),-DSLOW_MACHINE)$(if $(filter 1,$(NIGHTLY)), -DNIGHTLY_TESTS)
$(addprefix $(OBJECTS)/,tests/%): CFLAGS_ALL += $(TEST_PACE)

$(OBJECTS)/%.o: %.c
	@mkdir -p $(@D)
	$(say) '  CC $<'
	$(Q)$(CC) $(CFLAGS_ALL) $(call test_file,$<) -c -o $@ $<

$(OBJECTS)/%.o: %.cpp
	@mkdir -p $(@D)
	$(say) '  CXX $<'
	$(Q)$(CXX) -std=c++17 $(OPTIMISE_$(CONFIG)) $(CPP_WARNINGS) -fPIC -pthread -MMD -MP -Iinclude -I. $(CPPFLAGS) $(call allowed,$(CXXFLAGS)) $(TEST_PACE) $(call test_file,$<) -c -o $@ $<

# Without errno in square roots and without traps in comparisons; otherwise its loops are not vectorised.
$(OBJECTS)/preprocess/charge/potential.o: CFLAGS_ALL += -fno-math-errno -fno-trapping-math

# Some systems have the libraries of a prefix in a folder for their machine.
MULTIARCH := $(shell $(CC) -print-multiarch 2>/dev/null)
$(OBJECTS)/src/core/baseline_library.o: CFLAGS_ALL += $(if $(MULTIARCH),-DLIBRARY_FOLDER='"$(MULTIARCH)"')

# This object contains the pages of the reports.
$(OBJECTS)/tool/report/page_file.o: tool/report/template.html tool/report/jobs.html

# Only this file is compiled again when the commit changes.
$(OBJECTS)/tool/common/provenance.o: CFLAGS_ALL += -DCSCD_COMMIT='"$(COMMIT)"' -DCSCD_FLAGS='"$(OPTIMISE_$(CONFIG))"'
$(OBJECTS)/tool/common/provenance.o: $(BUILD)/commit
$(BUILD)/commit: FORCE
	@mkdir -p $(@D)
	@echo $(COMMIT) | cmp -s - $@ || echo $(COMMIT) > $@
FORCE:

ifdef WINDOWS
include tool/windows/rules.mk
endif
ifdef WASM
include packaging/wasm/rules.mk
endif

-include $(addprefix $(OBJECTS)/,$(addsuffix .d,$(basename $(SOURCES)))) $(KERNEL_OBJECTS:.o=.d) \
         $(MACHINE_LEVELS:.o=.d) $(VOLUME_LEVELS:.o=.d) $(TEST_LEVELS:.o=.d) $(OBJECTS)/tests/blender/print_frames.d $(OBJECTS)/tests/python/oracle.d $(ENGINE_OBJECTS:.o=.d)
