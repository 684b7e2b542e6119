# What a build for WebAssembly makes otherwise.

# Its linker makes no relocatable object with local names, so the archive has the objects, whose own names are hidden.
$(LIBRARY): $(OPENED_OBJECTS)
	@mkdir -p $(@D)
	$(say) '  AR $@'
	@rm -f $@
	$(Q)$(TOOLS)ar qcs $@ $^

# Programs on the library alone.
$(BUILD)/tests/wasm/%.js: $(OBJECTS)/tests/wasm/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(say) '  LD $@'
	$(Q)$(CC) $(LINK_ALL) -o $@ $^
