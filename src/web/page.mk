# Builds the page that grows trees, build/grow/corcast.html: `make page` calls this file. The program is compiled
# with and without vectors, by clang for WASI [docs/decisions/wasm-by-clang.md].
OUT := build/grow
SYSROOT := $(or $(WASI_SYSROOT),/usr)
CLANG := $(or $(WASI_CC),clang)
# Modules that growing, refining, measuring and triangulating need. What needs an operating system or a library is in
# src/web/host.c instead.
MODULES := base geom tree treeio domain grow flownetwork derive options scene stage mesh print emit field job job/tree web
ABSENT := src/base/file.c src/base/isolated.c src/base/json.c src/base/system.c
SOURCES := $(filter-out $(ABSENT),$(wildcard $(MODULES:%=src/%/*.c) $(patsubst %,src/%/*/*.c,$(filter-out job job/tree,$(MODULES))))) \
	$(wildcard src/job/export/*.c) $(addprefix src/job/picture/,picture.c coloring.c placing.c) \
	$(addprefix src/image/,colorscale.c encoding.c colormap.c)
FLAGS := --target=wasm32-wasi --sysroot=$(SYSROOT) -std=c11 -O3 -DCORCAST_PAGE '-DCORCAST_PREFIX=""' -D_GNU_SOURCE -D_WASI_EMULATED_PROCESS_CLOCKS -Isrc \
	-ffunction-sections -fdata-sections -fno-math-errno -fno-trapping-math -Wall -Wno-unused
# Growth alone gains from vectors, so both programs share the objects of all other modules. Vectors come from loops only:
# clang 14 miscompiles vectors that it makes of single statements [docs/decisions/wasm-by-clang.md].
GROWTH := $(filter $(addprefix src/,base/% geom/% tree/% domain/% grow/% derive/%),$(SOURCES))
LIMITS := -Wl,--gc-sections,--stack-first,-z,stack-size=1048576,--strip-all

$(OUT)/corcast.html: $(OUT)/made/simd.wasm $(OUT)/made/plain.wasm $(wildcard templates/grow/* templates/viewer/* templates/colormaps/*) \
		templates/page/page.html templates/looks/cast.ini build/viewer/viewer.js
	@printf '  %-6s %s\n' MADE $@
	@templates/grow/bundle $(OUT)

define MODULE
$(OUT)/made/$(1).wasm: $(GROWTH:%.c=$(OUT)/$(1)/%.o) $(patsubst %.c,$(OUT)/plain/%.o,$(filter-out $(GROWTH),$(SOURCES)))
	@printf '  %-6s %s\n' LINK $$@
	@mkdir -p $$(@D)
	@$(CLANG) $(FLAGS) -mexec-model=reactor $(LIMITS) -o $$@ $$^ -lwasi-emulated-process-clocks
$(OUT)/$(1)/%.o: %.c
	@printf '  %-6s %s\n' WASM $$<
	@mkdir -p $$(@D)
	@$(CLANG) $(FLAGS) $(2) -ffp-contract=off -MMD -MP -c -o $$@ $$<
-include $(SOURCES:%.c=$(OUT)/$(1)/%.d)
endef
$(eval $(call MODULE,simd,-msimd128 -fno-slp-vectorize))
$(eval $(call MODULE,plain,))
