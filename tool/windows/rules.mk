# What a build for Windows makes otherwise.

# The DLL, its import library, and the list of its functions, of which other compilers make an import library of their own.
$(SHARED): $(CORE_OBJECTS) include/cscd/cscd.h
	@mkdir -p $(@D)
	$(say) '  LD $@'
	@{ echo EXPORTS; $(TOOLS)nm -g --defined-only $(CORE_OBJECTS) | awk '$$2 == "T" && $$3 ~ /^cscd_/ {print "    " $$3}' | sort -u; } \
	    >$(BUILD)/libcscd-$(MAJOR).def
	$(Q)$(CC) $(OPTIMISE_$(CONFIG)) -shared -static -pthread -Wl,--out-implib,$(BUILD)/libcscd.dll.a -o $@ $(CORE_OBJECTS) \
	    $(BUILD)/libcscd-$(MAJOR).def $(LDFLAGS)

# Objects of Windows have no hidden names, so what is not of the public API gets a prefix that no program has, with the pointers by
# which other objects reach it.
$(LIBRARY): $(CORE_OBJECTS)
	@mkdir -p $(@D)
	$(say) '  AR $@'
	@rm -f $@
	$(Q)$(TOOLS)ar qcs $@ $^
	@$(TOOLS)nm -g --defined-only $@ | awk 'NF == 3 && $$3 !~ /^(\.refptr\.)?cscd_/ && $$3 !~ /^\.refptr\.(__|_)/ { \
	    name = $$3; own = sub(/^\.refptr\./, "", name) ? ".refptr.cscd_own_" name : "cscd_own_" name; print $$3, own}' | \
	    sort -u >$(BUILD)/own_names.txt
	$(Q)$(TOOLS)objcopy --redefine-syms=$(BUILD)/own_names.txt $@

# Python's module: the tool without its program, what Python calls, and the libraries for files and pictures. A program begins in
# wmain.c, which a DLL has not.
$(NATIVE_LIBRARY): $(filter-out %/tool/windows/wmain.o,$(NATIVE_OBJECTS))
	@mkdir -p $(@D)
	$(say) '  LD $@'
	@{ echo EXPORTS; $(TOOLS)nm -g --defined-only $^ | awk '$$2 == "T" && $$3 ~ /^cscd(py)?_/ {print "    " $$3}' | sort -u; } \
	    >$(BUILD)/libcscd-python.def
	$(Q)$(CC) $(OPTIMISE_$(CONFIG)) -shared -static -pthread -o $@ $^ $(BUILD)/libcscd-python.def $(TOOL_LIBS) $(LDFLAGS)

# ANSWERS: the file that a Linux run wrote.
WINDOWS_TESTS := $(addprefix $(BUILD)/tests/windows/,compare_answers console_events wide_paths)
test-windows-run: tool library $(MODELS) $(TESTS) $(WINDOWS_TESTS)
	@for program in $(TOOL) $(MODELS); do cp -p $$program $$program.exe; done
	@BUILD=$(BUILD) tests/windows/run.sh $(TESTS) $(WINDOWS_TESTS)

# The macros of cmocka take the formats of Microsoft for granted; and what runs once need not be fast, but soon compiled.
$(addprefix $(OBJECTS)/,tests/% benchmarks/%): CFLAGS_ALL += -Wno-format -Wno-format-extra-args -O1 -g0
$(ROOMS): LINK_ALL += -Wl,--strip-debug

# A solver that waits for -O1 is what takes longest.
$(OBJECTS)/tests/windows/dense_solve.o: CFLAGS_ALL += -O3
