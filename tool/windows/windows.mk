# Flags and sources of a build for Windows; included before the Makefile makes lists of objects.

# Each file sees POSIX as posix.h has it. mingw's gcc cannot align 32-byte vectors on the stack (GCC bug 54412), so its assembler
# makes each aligned move an unaligned one, which costs nothing where the address is aligned.
WINDOWS_ASSEMBLER := $(if $(findstring clang,$(CC)),,-Wa,-muse-unaligned-vector-move)
WINDOWS_FLAGS := -D_FILE_OFFSET_BITS=64 -D__USE_MINGW_ANSI_STDIO=1 -DWIN32_LEAN_AND_MEAN -isystem tool/windows/include \
                 -isystem $(WINDOWS_LIBRARIES)/include $(WINDOWS_ASSEMBLER)
CFLAGS_ALL += -include tool/windows/posix.h $(WINDOWS_FLAGS)
CXXFLAGS   += $(WINDOWS_FLAGS)

# Programs need no DLL but those of Windows. gcc would add .exe to a name; -o of the linker has the last word.
LINK_ALL = $(OPTIMISE_$(CONFIG)) -pthread -static -municode -Wl,-o,$@ $(LDFLAGS)

CORE_LIBS   :=
EXPAT_LIBS  := -lexpat
TOOL_LIBS   := -L$(WINDOWS_LIBRARIES)/lib -lpng -lz -ljson-c -lexpat -lm
TEST_LIBS   := -L$(WINDOWS_LIBRARIES)/lib -lcmocka-static $(TOOL_LIBS)
# Tests alone have a dense solver, one of their own, to compare the tree with.
BASELINE_SOURCES := preprocess/baselines/dense/dense_system.c tests/windows/dense_solve.c

# Without a library for Windows: GMP, FLINT and Arb. Without a meaning there: what Unix alone has. tests/windows/left_out.txt says
# why each program is missing, and which tests of others are known to fail.
SUPPORT_SOURCES := $(filter-out tests/support/ccd/algebraic_%.c tests/support/untangle/%.c \
                     tests/support/solver/exact_distance.c,$(SUPPORT_SOURCES))
TEST_SOURCES := $(filter-out $(shell sed -n 's|^\(tests/[^: ]*\):.*|\1|p' tests/windows/left_out.txt),$(TEST_SOURCES))

# Python's module is linked by a rule of its own (rules.mk), and libpng reads no variable there.
NATIVE_SOURCES := $(filter-out %/standard_error.c,$(NATIVE_SOURCES))

COMMON_SOURCES += $(wildcard tool/windows/*.c)
