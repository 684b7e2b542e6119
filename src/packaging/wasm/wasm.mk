# Flags and sources of a build for WebAssembly; included before the Makefile makes lists of objects.
CFLAGS_ALL := $(filter-out -g -pthread -fPIC -fexceptions,$(CFLAGS_ALL))
# Modules of tests grow to the 4 GiB that a 32-bit size can name.
LINK_ALL   := -O1 -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=4GB -sTOTAL_STACK=5MB -sEXIT_RUNTIME=1 -sNODERAWFS=1 $(LDFLAGS)
SHARED_LIBS :=
STATIC_LIBS := -lm
