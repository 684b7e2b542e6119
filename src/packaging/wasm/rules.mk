# What a build for WebAssembly makes otherwise.

# Its linker makes no relocatable object with local names, so the archive has the objects, whose own names are hidden.
$(LIBRARY): $(OPENED_OBJECTS)
	@mkdir -p $(@D)
	$(say) '  AR $@'
	@rm -f $@
	$(Q)$(TOOLS)ar qcs $@ $^

# Programs on the library alone, and the tests of rooms.
$(BUILD)/tests/wasm/%.js: $(OBJECTS)/tests/wasm/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) -o $@ $^

$(BUILD)/tests/%.js: $(OBJECTS)/tests/%.o $(BUILD)/tests/support.a $(BUILD)/inside.a
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(TEST_LIBS)

$(BUILD)/tests/core/test_simd.js: $(TEST_LEVELS)

# NATIVE: tests/wasm/contacts.c of this machine.
WASM_TESTS := $(addsuffix .js,$(TESTS))
test-wasm-run: $(addprefix $(BUILD)/tests/wasm/,contacts.js sizes.js) $(WASM_TESTS)
	@tests/wasm/run.sh $(NATIVE) $(BUILD)/tests/wasm $(WASM_TESTS)
.PHONY: test-wasm-run

# What runs once need not be fast, but soon compiled.
$(addprefix $(OBJECTS)/,tests/% benchmarks/%): CFLAGS_ALL += -O1
