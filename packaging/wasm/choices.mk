# What a build for WebAssembly is made with: HOST=wasm32-emscripten, by Debian's emscripten, on the scalar level and without threads.
# LAPACKE and GSL are not built for it.
WASM  := 1
TOOLS := em
BASELINES := 0
EXPAT  := 0
ifeq ($(origin CC),default)
CC     := emcc
endif
# Where emcc finds no acorn of its own.
export NODE_PATH := /usr/share/nodejs
WASM_LIBRARIES := build/wasm32-emscripten/libraries
