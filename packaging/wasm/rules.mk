# What a build for WebAssembly makes otherwise.

# Its linker makes no relocatable object with local names, so the archive has the objects, whose own names are hidden.
$(LIBRARY): $(CORE_OBJECTS)
	@mkdir -p $(@D)
	$(say) '  AR $@'
	@rm -f $@
	$(Q)$(TOOLS)ar qcs $@ $^

# Programs on the library alone, and the tests of rooms.
$(BUILD)/tests/wasm/%.js: $(OBJECTS)/tests/wasm/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) -o $@ $^

WASM_ROOMS := $(addsuffix .js,$(ROOMS))
$(WASM_ROOMS): $(OBJECTS)/tests/support/room.o $(BUILD)/tests/support.a $(BUILD)/inside.a
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(TEST_LIBS)

define wasm_room_rules
$(BUILD)/tests/$(1)/room.js: $(addprefix $(OBJECTS)/,$(addsuffix .o,$(basename $(filter tests/$(1)/%,$(ROOM_SOURCES)))))
$(addsuffix .js,$(filter $(BUILD)/tests/$(1)/%,$(TESTS))): $(BUILD)/tests/$(1)/room.js
	@ln -sfn room.js $$@
endef
$(foreach room,$(TEST_ROOMS_HERE),$(eval $(call wasm_room_rules,$(room))))
$(BUILD)/tests/core/room.js: $(TEST_LEVELS)

# NATIVE: tests/wasm/contacts.c of this machine.
WASM_TESTS := $(addsuffix .js,$(TESTS))
test-wasm-run: $(addprefix $(BUILD)/tests/wasm/,contacts.js sizes.js) $(WASM_TESTS)
	@tests/wasm/run.sh $(NATIVE) $(BUILD)/tests/wasm $(WASM_TESTS)
.PHONY: test-wasm-run

# What runs once need not be fast, but soon compiled.
$(addprefix $(OBJECTS)/,tests/% benchmarks/%): CFLAGS_ALL += -O1
