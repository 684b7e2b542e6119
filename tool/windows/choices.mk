# What a build for Windows is made with: HOST=x86_64-w64-mingw32, by the compiler of Debian's gcc-mingw-w64-x86-64-posix. Threads are
# those of winpthreads. LAPACKE and GSL are not built for Windows; the rest comes from packaging/libraries.sh.
WINDOWS := 1
BASELINES := 0
EXPAT   := 1
ifeq ($(origin CC),default)
CC      := $(HOST)-gcc-posix
endif
ifeq ($(origin CXX),default)
CXX     := $(HOST)-g++-posix
endif
WINDOWS_LIBRARIES := build/windows/libraries
