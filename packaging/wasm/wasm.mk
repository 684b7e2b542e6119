# Flags and sources of a build for WebAssembly; included before the Makefile makes lists of objects.
CFLAGS_ALL := $(filter-out -g -pthread -fPIC,$(CFLAGS_ALL))
# cmocka.h defines uintptr_t where this macro does not tell it that there is one.
CFLAGS_ALL += -isystem $(WASM_LIBRARIES)/include -D_UINTPTR_T
# Modules of tests grow to the 4 GiB that a 32-bit size can name.
LINK_ALL   := -O1 -sINITIAL_MEMORY=64MB -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=4GB -sTOTAL_STACK=5MB -sEXIT_RUNTIME=1 -sNODERAWFS=1 $(LDFLAGS)
CORE_LIBS  := -lm

# The tests of the rooms of core, mesh, preprocessing and runtime. Readers and writers of files are not built, and the dense
# solver is that of the tests on Windows; files of pytest run the tool, which is not built. tests/wasm/left_out.txt says why a program is missing.
TEST_LIBS       := -L$(WASM_LIBRARIES)/lib -lcmocka-static
TEST_ROOMS_HERE := core mesh ccd bvh culling narrow_phase loose intersections events baselines detector solver sensors preprocess proofs
BASELINE_SOURCES := preprocess/baselines/dense/dense_system.c tests/windows/dense_solve.c
COMMON_SOURCES  := tool/io/io.c tool/io/io_memory.c
SUPPORT_SOURCES := $(filter-out tests/support/ccd/algebraic_%.c tests/support/untangle/%.c \
                     tests/support/solver/exact_distance.c \
                     $(foreach room,install io models report tool,tests/support/$(room)/%),$(SUPPORT_SOURCES)) \
                   tests/support/models/bodies.c
TEST_SOURCES    := $(filter-out $(shell sed -n 's|^\(tests/[^: ]*\):.*|\1|p' tests/wasm/left_out.txt) %.py, \
                    $(filter $(addprefix tests/,$(addsuffix /%,$(TEST_ROOMS_HERE))),$(TEST_SOURCES)))
