# Builds, tests and installs corcast. `make help` lists the targets.
#
# MODE     release (default), debug, asan, tsan, fuzz (clang only); objects are stored in build/$(MODE)/
# CC       gcc or clang
# V=1      print the commands that run
# JOBS     number of parallel jobs where the Makefile calls itself (default: all processors)
# PREFIX   folder that `make install` installs into (default: /usr/local); DESTDIR goes in front of it. Give it to `make all`,
#          too: where the system does not tell the program's path, the program looks for its templates below this folder
# LIBDIR, PYTHONDIR   folders for the library (default: PREFIX/lib) and for the Python modules (default: PREFIX/lib/python3/dist-packages)
# FONTS    folder that has the Liberation fonts: install links to them instead of copies
# WERROR=1 treat warnings as errors; the checks do
# CFLAGS, CPPFLAGS, LDFLAGS   additional flags, from the environment or the command line; they follow the Makefile's own

MODE ?= release
comma := ,
PREFIX ?= /usr/local
CC ?= cc
PKG_CONFIG ?= pkg-config
LIBDIR ?= $(PREFIX)/lib
PYTHONDIR ?= $(PREFIX)/lib/python3/dist-packages
JOBS ?= $(shell nproc)
BUILD := build/$(MODE)
Q := $(if $(V),,@)
say = $(if $(V),,@printf '  %-6s %s\n' $(1) $(2))
# Runs this Makefile again, after `make deps` has installed packages. Adds -j only if the caller gave none.
AGAIN = $(MAKE) --no-print-directory $(if $(filter -j%,$(MAKEFLAGS)),,-j$(JOBS))

ROOMS := $(filter-out cli python web,$(notdir $(patsubst %/,%,$(wildcard src/*/))))
ROOM_SOURCES := $(wildcard $(ROOMS:%=src/%/*.c) $(ROOMS:%=src/%/*/*.c))
CLI_SOURCES := $(wildcard src/cli/*.c src/cli/*/*.c)
TEST_SOURCES := $(wildcard tests/unit/*_test.c)
FORMATTED := $(sort $(wildcard src/*/*.[ch] src/*/*/*.[ch] tests/unit/*.c tests/unit/*.h tests/oracle/*.c \
	tests/alloc/*.c tests/bench/*.c tests/suite/*.c tests/fuzz/*.c tests/fuzz/*.h tests/power/*.c tests/power/*.h tests/fit/*.c tests/fit/*.h tests/optima/*.c \
	tests/api/*.c docs/examples/*.c src/*.h))

# Kernels of the renderer are compiled once for each instruction set [src/render/tile/lanes.h].
KERNELS := $(if $(filter x86_64%,$(shell $(CC) -dumpmachine)),$(wildcard src/render/*/*kernels.c))
ROOM_OBJECTS := $(ROOM_SOURCES:%.c=$(BUILD)/%.o) $(foreach kind,avx2 avx512,$(KERNELS:%.c=$(BUILD)/%.$(kind).o))
CLI_OBJECTS := $(CLI_SOURCES:%.c=$(BUILD)/%.o)
TEST_OBJECTS := $(TEST_SOURCES:%.c=$(BUILD)/%.o)
TEST_PROGRAMS := $(TEST_SOURCES:tests/unit/%.c=$(BUILD)/tests/%)
API_PROGRAMS := $(patsubst tests/api/%.c,$(BUILD)/tests/api/%,$(wildcard tests/api/*.c))
ORACLE := $(BUILD)/tests/check_tree
FAILING := $(BUILD)/tests/failing.so
POWER_OBJECTS := $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/power/*.c))
POWER := $(BUILD)/tests/power/power
EMBREE := $(BUILD)/tests/bench/embree
FRAMES := $(BUILD)/tests/bench/frames
MESHES := $(BUILD)/tests/bench/meshes
PULSES := $(BUILD)/tests/bench/pulse
FLOWS := $(BUILD)/tests/bench/flow
FIT := $(BUILD)/tests/fit/fit_blob
OPTIMA := $(BUILD)/tests/optima/optima
FUZZ_SOURCES := $(wildcard tests/fuzz/*.c)
HARNESSES := $(filter-out fuzz replay,$(FUZZ_SOURCES:tests/fuzz/%.c=%))
FUZZ_PROGRAMS := $(HARNESSES:%=$(BUILD)/tests/fuzz/%)

WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wdouble-promotion \
	-Wstrict-prototypes -Wmissing-prototypes -Wold-style-definition -Wvla -Wformat=2 -Wcast-qual \
	-Wpointer-arith -Wundef -Wwrite-strings
# clang reports the standard's INFINITY and NAN, which are floats, as promotions to double.
WARNINGS += $(if $(findstring clang,$(CC)),-Wno-double-promotion)
# Only the checks treat a warning as an error, and only with the project's own flags: other compilers and other levels of
# optimisation give other warnings, and a package must build with them.
check check-all check-quick asan tsan: export WERROR := yes
WARNINGS += $(if $(WERROR),$(if $(strip $(CFLAGS)),,-Werror))
OPTIMISE_release := -O2 -g
OPTIMISE_debug := -O0 -g3
OPTIMISE_asan := -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
# TRAP=1: undefined behaviour ends a program without a sentence, which compiles and runs faster.
OPTIMISE_asan += $(if $(TRAP),-fsanitize-trap=undefined)
OPTIMISE_fuzz := -O1 -g -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
# Uses of freed handles are detected in modes where speed does not matter [src/api/handle.c].
FIND_FREED := $(if $(filter debug asan fuzz,$(MODE)),-DCORCAST_DEBUG)
# The runtime of a sanitizer is in the program, so a library built with sanitizers has undefined symbols.
DEFINED := $(if $(filter release debug,$(MODE)),-Wl$(comma)-z$(comma)defs)
OPTIMISE_tsan := -O1 -g -fsanitize=thread
VECTORS_release := -O3 -fno-math-errno -fno-trapping-math
PACKAGES := libpng libdeflate libisal zlib libtiff-4 libjpeg libwebp lcms2 jansson expat libmd cairo-ft freetype2 liblz4
# `view` loads SDL 2 when it opens a window; only its header is needed here.
HEADERS := sdl2
PACKAGE_LIBS := $(shell $(PKG_CONFIG) --exists $(HEADERS) && $(PKG_CONFIG) --libs $(PACKAGES) 2>/dev/null)
# libnifti2-dev has no pkg-config file, and OpenEXR's links its C++ libraries as well. The headers of NIfTI are in a folder
# `nifti` on the compiler's path, and include each other as if that folder were on the path, too.
PLAIN_LIBS := -lOpenEXRCore -lnifti2 -lznz -lpthread -lm
PLAIN_HEADERS := $(shell printf '\043include <nifti/znzlib.h>\n\043include <OpenEXR/openexr.h>\n' | \
	$(CC) $(CPPFLAGS) $(CFLAGS) -M -x c - 2>/dev/null)
NIFTI := $(patsubst %/znzlib.h,%,$(filter %/nifti/znzlib.h,$(PLAIN_HEADERS)))
# Hardening of the release: checks of the stack and of the C library's buffers, and tables of addresses that are read-only
# before main runs. _FORTIFY_SOURCE needs optimisation. A level of _FORTIFY_SOURCE given by the caller is kept.
HARDEN_release = -fstack-protector-strong $(if $(filter -O0,$(OPTIMISE_$(MODE)) $(CFLAGS))$(findstring _FORTIFY_SOURCE,$(CPPFLAGS) $(CFLAGS)),, \
	-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3)
# The same seed must give the same bytes with every compiler: no contraction of a * b + c, no reassociation. gcc 12 must not
# make vectors of statements, because it then leaves out conversions of doubles to float and back
# [docs/decisions/same-bytes.md]. These flags come last, so that no flag of the caller overrides them.
EXACT := -ffp-contract=off $(if $(findstring clang,$(CC)),,-fno-tree-slp-vectorize)
INEXACT := $(filter -Ofast -ffast-math -funsafe-math-optimizations -fassociative-math -freciprocal-math -ffinite-math-only \
	-fno-signed-zeros -ffp-model=fast -mrecip%,$(CC) $(CPPFLAGS) $(CFLAGS) $(LDFLAGS))
ifneq ($(INEXACT),)
$(error $(INEXACT) changes results, which are to be the same bytes everywhere: leave it out of CC, CPPFLAGS, CFLAGS and LDFLAGS)
endif
# The Makefile's own flags; the caller's CFLAGS, CPPFLAGS and LDFLAGS follow them.
VECTORS :=
# The folder of the build is left out of what the compiler writes, so that two builds have the same bytes.
OWN_CFLAGS := -std=c11 $(OPTIMISE_$(MODE)) -ffile-prefix-map=$(CURDIR)=. -fPIC -fvisibility=hidden $(WARNINGS)
OWN_CPPFLAGS := -Isrc $(FIND_FREED) -D_GNU_SOURCE $(NIFTI:%=-isystem %) $(shell $(PKG_CONFIG) --cflags $(PACKAGES) $(HEADERS) 2>/dev/null)
OWN_LDFLAGS := $(filter -fsanitize%,$(OPTIMISE_$(MODE))) -pie -Wl,-z,relro,-z,now,-z,noexecstack
COMPILE = $(CC) $(OWN_CPPFLAGS) $(CPPFLAGS) $(OWN_CFLAGS) $(HARDEN_$(MODE)) $(VECTORS) $(CFLAGS) $(EXACT)
LINK = $(CC) $(OWN_LDFLAGS) $(LDFLAGS)
# A release has the viewer already, so that its build needs no network.
VIEWER := $(or $(wildcard templates/page/viewer.js),build/viewer/viewer.js)
LIBS := $(PACKAGE_LIBS) $(PLAIN_LIBS)

.PHONY: all lib abi api-programs deps page demo figures gallery hero validate bench bench-grow bench-render bench-view bench-compare bench-mesh bench-trees bench-pulse bench-flow bench-large export-all verify-all coronary answers-long power power-program metamorph suite fit-blob optima check check-all check-quick program unit \
	unit-programs layers format format-check asan tsan \
	fuzz fuzz-programs golden-update reference install uninstall dist clean help packages libraries
.DELETE_ON_ERROR:
.SECONDARY:

all: build/corcast $(and $(shell command -v npm),$(shell command -v esbuild),$(VIEWER)) ## build the program, build/corcast, and the viewer for web pages of trees (the default target)
	@:

help: ## list the targets
	@echo 'make TARGET [MODE=release|debug|asan|tsan] [CC=gcc|clang] [V=1]'
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  %-14s %s\n", $$1, $$2 }' Makefile

deps: ## install missing Debian packages; FOR=bench, fuzz or all for other sets
	$(Q).ci/deps $(or $(FOR),build run check page)

demo: ## grow a tree, draw it with POV-Ray and corcast, and verify the pictures; results in out/demo/
	$(Q).ci/deps build run
	$(Q)$(AGAIN) all
	$(Q)docs/demo

figures: ## draw the figures of the paper, as pages and with POV-Ray; results in out/figures/
	$(Q).ci/deps build run
	$(Q)$(AGAIN) all
	$(Q)docs/figures

HERO_SIZE := 1600
hero: build/corcast ## draw docs/examples/hero.pov with POV-Ray: out/hero/hero.png, HERO_SIZE pixels wide
	$(Q)docs/examples/hero out/hero $(HERO_SIZE)

gallery: build/corcast ## redraw the pictures of docs/GALLERY.md, each with the command beside it
	$(Q)docs/images/gallery-pictures

validate: ## grow the trees of docs/VALIDATION.md, section 1, again and check its table
	$(Q).ci/deps build check
	$(Q)$(AGAIN) all
	$(Q)tests/validate

bench: ## run all benchmarks, one after another
	$(Q)for part in grow render view compare mesh trees large; do $(MAKE) --no-print-directory bench-$$part || exit; done

bench-grow: ## time growth; BENCH=full adds 10^6 terminals
	$(Q).ci/deps build bench
	$(Q)$(AGAIN) all
	$(Q)tests/bench/grow

bench-render: ## time drawing, compared with POV-Ray and other renderers; BENCH=full|quick
	$(Q).ci/deps build run bench
	$(Q)$(AGAIN) all $(EMBREE) $(FRAMES)
	$(Q)tests/bench/render

bench-view: ## count pictures per second while a window is turned; BENCH=full adds 10^6 terminals
	$(Q).ci/deps build run check
	$(Q)$(AGAIN) all
	$(Q)tests/bench/view

bench-compare: ## time `compare` on large pictures, compared with idiff and odiff
	$(Q).ci/deps build check
	$(Q)$(AGAIN) all
	$(Q)tests/bench/compare

bench-mesh: ## time the triangulation, and measure its distance from the surface; BENCH=quick
	$(Q).ci/deps build
	$(Q)$(AGAIN) all $(MESHES)
	$(Q)tests/bench/mesh

export-all: ## export hundreds of grown and random trees, and check each mesh with admesh; GROWN=96 RANDOM=200
	$(Q).ci/deps build check
	$(Q)$(AGAIN) all
	$(Q)tests/export-all $(or $(GROWN),96) $(or $(RANDOM),200)

bench-trees: ## time reading and writing a tree, compared with numpy and VTK; BENCH=full for 10^6 terminals
	$(Q).ci/deps build check
	$(Q)$(AGAIN) all
	$(Q)tests/bench/trees

bench-pulse: ## time pulse waves of 16 harmonics in 10^6 segments
	$(Q).ci/deps build
	$(Q)$(AGAIN) all $(PULSES)
	$(Q)mkdir -p out/bench
	$(Q)[ -s out/bench/pulse.swc ] || build/corcast grow --quiet --domain ball:40 --terminals 500000 -o out/bench/pulse.swc
	$(Q)$(PULSES) out/bench/pulse.swc

bench-flow: ## time steady flow in a random network of 10^6 segments
	$(Q)$(AGAIN) $(FLOWS)
	$(Q)$(FLOWS)

bench-large: ## time growing, reading and drawing 10^6 terminals; BENCH=full adds 10^7
	$(Q).ci/deps build check
	$(Q)$(AGAIN) all
	$(Q)tests/bench/large

verify-all: ## verify all models x trees x projections x shadows x antialiasing; report in out/verify/
	$(Q).ci/deps build run
	$(Q)$(AGAIN) all
	$(Q)JOBS=$(JOBS) tests/verify-all

coronary: ## grow a coronary artery on a measured heart in stages, and compare it with published morphometry; results in out/coronary/
	$(Q).ci/deps build run
	$(Q)$(AGAIN) all
	$(Q)docs/coronary/run

answers-long: build/corcast ## plant faults and check that answers find them; prove certificates; prints the table of docs/VALIDATION.md, section 10
	$(Q)tests/answers-long

power: ## plant faults and count which `verify` and the tests find; writes docs/VALIDATION.md, sections 5 and 6
	$(Q).ci/deps build run check
	$(Q)$(AGAIN) all power-program unit-programs
	$(Q)tests/power/run
	$(Q)JOBS=$(JOBS) tests/power/run-shared

power-program: $(POWER)

suite: build/corcast ## grade POV-Ray, Tachyon, Embree and corcast by the tube suite; score cards in out/suite/
	$(Q).ci/deps build run bench
	$(Q)tests/suite/cards

metamorph: build/corcast ## search for broken relations at length: planted faults, corcast (PAIRS=10000), POV-Ray, Tachyon; results in out/metamorph/
	$(Q)tests/relations/metamorph $(PAIRS)

optima: $(OPTIMA) ## find the best trees of small point sets, and count how often annealing finds them
	$(Q)$(OPTIMA) tests/optima/sets.txt

fit-blob: $(FIT) ## measure how far the blob is from the potential; HOW=fit searches its numbers again
	$(Q)$(FIT) $(HOW)

check: ## run every test; ends with "N passed, N failed"
	$(Q).ci/deps build run check page
	$(Q)JOBS=$(JOBS) tests/check

check-all: ## run `make check`, and tests that need large packages (500 MB): PrusaSlicer, Blender, gmsh, Slurm, Firefox
	$(Q).ci/deps build run check page
	$(Q).ci/deps all || echo 'tests that need these packages are skipped' >&2
	$(Q)JOBS=$(JOBS) ALLOC=all tests/check usual all

check-quick: ## run the fast tests that need no other program, in half a minute
	$(Q)JOBS=$(JOBS) tests/check quick

# build/corcast is always the release build.
ifeq ($(MODE),release)
build/corcast: $(BUILD)/corcast
	$(Q)cp --remove-destination $< $@
else
build/corcast:
	$(Q)$(MAKE) MODE=release build/corcast
endif

# The viewer in pages of `export T -o P.html`. The program is complete without it.
build/viewer/viewer.js: $(wildcard templates/viewer/*)
	$(call say,MADE,$@)
	$(Q)templates/viewer/bundle $(@D) || :

page: build/viewer/viewer.js ## build the page that grows trees, build/grow/corcast.html
	$(Q).ci/deps page web
	+$(Q)$(AGAIN) -f src/web/page.mk

program: $(BUILD)/corcast ## build the program of this MODE, build/MODE/corcast

$(BUILD)/corcast: $(CLI_OBJECTS) $(BUILD)/rooms.a
	$(call say,LINK,$@)
	$(Q)$(LINK) -o $@ $^ $(LIBS)

$(BUILD)/rooms.a: $(ROOM_OBJECTS)
	$(call say,AR,$@)
	$(Q)rm -f $@ && $(AR) rcs $@ $^

# The library: all modules except cli. Everything is compiled with hidden visibility, so only the declarations of corcast.h
# are visible from outside. The static library hides all other symbols too.
SONAME := libcorcast.so.0
$(BUILD)/$(SONAME): $(BUILD)/rooms.a src/api/libcorcast.map
	$(call say,LINK,$@)
	$(Q)$(filter-out -pie,$(LINK)) -shared -Wl,-soname,$(SONAME) -Wl,--version-script=src/api/libcorcast.map $(DEFINED) \
		-o $@ -Wl,--whole-archive $(BUILD)/rooms.a -Wl,--no-whole-archive $(LIBS)

$(BUILD)/libcorcast.a: $(BUILD)/rooms.a
	$(call say,AR,$@)
	$(Q)rm -f $@ $(@:.a=.o)
	$(Q)ld -r -o $(@:.a=.o) --whole-archive $< && objcopy --localize-hidden --wildcard --localize-symbol='_TIFF*alloc' $(@:.a=.o) && $(AR) rcs $@ $(@:.a=.o)
	$(Q)rm -f $(@:.a=.o)

lib: build/$(SONAME) build/libcorcast.a ## build the library, build/libcorcast.so.0 and build/libcorcast.a

ifeq ($(MODE),release)
build/$(SONAME): $(BUILD)/$(SONAME)
	$(Q)cp --remove-destination $< $@
	$(Q)ln -sf $(SONAME) build/libcorcast.so
build/libcorcast.a: $(BUILD)/libcorcast.a
	$(Q)cp --remove-destination $< $@
else
build/$(SONAME) build/libcorcast.a:
	$(Q)$(MAKE) MODE=release $@
endif

$(BUILD)/cli.a: $(filter-out %/main.o,$(CLI_OBJECTS))
	$(call say,AR,$@)
	$(Q)rm -f $@ && $(AR) rcs $@ $^

define COMPILE_OBJECT
	$(call say,CC,$<)
	$(Q)mkdir -p $(@D)
	$(Q)$(COMPILE) $(LANES) -MMD -MP -c -o $@ $<
endef
$(BUILD)/%.avx2.o: LANES := -DLANES_AVX2
$(BUILD)/%.avx512.o: LANES := -DLANES_AVX512
$(BUILD)/%.avx2.o: %.c Makefile | libraries
	$(COMPILE_OBJECT)
$(BUILD)/%.avx512.o: %.c Makefile | libraries
	$(COMPILE_OBJECT)
$(BUILD)/%.o: %.c Makefile | libraries
	$(COMPILE_OBJECT)

$(BUILD)/tests/%_test: $(BUILD)/tests/unit/%_test.o $(BUILD)/cli.a $(BUILD)/rooms.a
	$(call say,LINK,$@)
	$(Q)mkdir -p $(@D)
	$(Q)$(LINK) -o $@ $^ $(LIBS) -lcmocka

# Programs that use the library as its users do: through its header and its shared object only.
$(API_PROGRAMS): $(BUILD)/tests/api/%: tests/api/%.c src/corcast.h $(BUILD)/$(SONAME)
	$(call say,LINK,$@)
	$(Q)mkdir -p $(@D)
	$(Q)$(CC) -D_GNU_SOURCE -Isrc $(CPPFLAGS) $(OWN_CFLAGS) $(CFLAGS) $(filter-out -pie,$(OWN_LDFLAGS)) -pie -o $@ $< $(BUILD)/$(SONAME) \
		-Wl,-rpath,$(abspath $(BUILD)) -lpthread -lm

api-programs: $(API_PROGRAMS)

$(OPTIMA) $(FIT) $(PULSES) $(FLOWS): %: %.o $(BUILD)/rooms.a
	$(call say,LINK,$@)
	$(Q)mkdir -p $(@D)
	$(Q)$(LINK) -o $@ $^ $(LIBS)

$(FRAMES): $(BUILD)/tests/bench/frames.o $(BUILD)/rooms.a
	$(call say,LINK,$@)
	$(Q)$(LINK) -o $@ $^ $(LIBS)

# Fuzzing harnesses: driven by libFuzzer in the mode fuzz; in other modes they replay files.
$(FUZZ_PROGRAMS): $(BUILD)/tests/fuzz/%: $(BUILD)/tests/fuzz/%.o $(BUILD)/tests/fuzz/fuzz.o \
	$(if $(filter fuzz,$(MODE)),,$(BUILD)/tests/fuzz/replay.o) $(BUILD)/cli.a $(BUILD)/rooms.a
	$(call say,LINK,$@)
	$(Q)$(subst fuzzer-no-link,fuzzer,$(LINK)) -o $@ $^ $(LIBS)

$(MESHES): $(BUILD)/tests/bench/meshes.o $(BUILD)/rooms.a
	$(call say,LINK,$@)
	$(Q)$(LINK) -o $@ $^ $(LIBS)

# A renderer for comparison; `make deps FOR=bench` installs libembree-dev.
$(EMBREE): $(BUILD)/tests/bench/embree.o $(BUILD)/rooms.a
	$(call say,LINK,$@)
	$(Q)$(LINK) -o $@ $^ $(LIBS) -lembree3

$(POWER): $(POWER_OBJECTS) $(BUILD)/rooms.a
	$(call say,LINK,$@)
	$(Q)mkdir -p $(@D)
	$(Q)$(LINK) -o $@ $^ $(LIBS)

# The oracles share no code with the program they check.
$(BUILD)/tests/%: tests/oracle/%.c Makefile
	$(call say,CC,$<)
	$(Q)mkdir -p $(@D)
	$(Q)$(filter-out -Isrc,$(COMPILE)) $(OWN_LDFLAGS) $(LDFLAGS) -o $@ $< -lm

# The module render reads no files and takes minutes to build with sanitizers, so fuzzing builds it without.
ifeq ($(MODE),fuzz)
$(filter $(BUILD)/src/render/%,$(ROOM_OBJECTS)): OWN_CFLAGS := $(filter-out -fsanitize%,$(OWN_CFLAGS))
endif

# failing.so makes allocations fail. It is loaded before the program's own libraries, and is never sanitized.
$(FAILING): tests/alloc/failing.c Makefile
	$(call say,CC,$<)
	$(Q)mkdir -p $(@D)
	$(Q)$(CC) -D_GNU_SOURCE -std=c11 -O1 -g $(WARNINGS) -fPIC -shared -o $@ $<

# Loops over pixels get faster with vectors, and growth with square roots that do not set errno.
$(filter $(BUILD)/src/answer/% $(BUILD)/src/image/% $(BUILD)/src/compare/% $(BUILD)/src/grow/% $(BUILD)/src/pulse/% $(BUILD)/src/render/raster/% $(BUILD)/src/render/light/% $(BUILD)/src/mesh/% $(BUILD)/src/render/tile/%,$(ROOM_OBJECTS)): VECTORS := $(VECTORS_$(MODE))

# The program looks for its templates below this folder last.
$(BUILD)/src/options/templates.o: OWN_CPPFLAGS += '-DCORCAST_PREFIX="$(PREFIX)"'

# Kernels of pictures read no input and write to arrays of fixed size. The stack protector would cost them 2 % of their speed.
$(filter %kernels.o %kernels.avx2.o %kernels.avx512.o,$(ROOM_OBJECTS)): HARDEN_release += -fno-stack-protector

-include $(ROOM_OBJECTS:.o=.d) $(CLI_OBJECTS:.o=.d) $(TEST_OBJECTS:.o=.d) $(POWER_OBJECTS:.o=.d) $(EMBREE).d $(FRAMES).d $(MESHES).d $(PULSES).d $(FLOWS).d $(FIT).d $(FUZZ_SOURCES:%.c=$(BUILD)/%.d)

libraries:
ifeq ($(and $(strip $(PACKAGE_LIBS)),$(NIFTI)),)
	@echo 'corcast needs $(PACKAGES) $(HEADERS), OpenEXR, libnifti2 and pkg-config to build: run "make deps" first' >&2; exit 1
endif
	@mkdir -p $(BUILD) 2>/dev/null && test -w $(BUILD) || \
		{ echo '$(BUILD) cannot be written to: "make program BUILD=FOLDER" builds in another folder' >&2; exit 1; }

unit-programs: $(TEST_PROGRAMS) $(API_PROGRAMS) $(OPTIMA) $(ORACLE) $(FAILING)

fuzz-programs: $(FUZZ_PROGRAMS)

abi: $(BUILD)/$(SONAME) ## store the library's binary interface again, after a change that is visible to users
	$(Q)rm -rf build/abi && mkdir -p build/abi && cp src/corcast.h build/abi
	$(Q)abidw --no-show-locs --drop-private-types --headers-dir build/abi --exported-interfaces-only --no-corpus-path \
		--no-comp-dir-path $< --out-file tests/api/libcorcast.abi

fuzz: ## fuzz every reader with libFuzzer, FUZZ=60 seconds each; TARGET=NAME for one harness
	$(Q).ci/deps build fuzz
	$(Q)$(AGAIN) MODE=fuzz CC=clang fuzz-programs
	$(Q)tests/fuzz/run "$(or $(FUZZ),60)" $(or $(TARGET),$(HARNESSES))

unit: unit-programs ## build and run the unit tests in this MODE
	$(Q)for program in $(TEST_PROGRAMS); do $$program || exit 1; done

layers: ## check the includes against src/LAYERS
	$(Q)tests/check-layers

format: ## format the C sources
	$(Q)clang-format -i $(FORMATTED)

format-check: ## list the C sources that are not formatted
	$(Q)clang-format --dry-run -Werror $(FORMATTED)

asan: ## build and run the unit tests with the address and undefined-behaviour sanitizers
	$(Q)$(AGAIN) MODE=asan program unit

tsan: ## build and run the unit tests with the thread sanitizer
	$(Q)$(AGAIN) MODE=tsan program unit

golden-update: build/corcast ## redraw one golden picture: CASE=name REASON="why"; without CASE, record the current scenes of all
	$(Q)tests/golden-update "$(CASE)" "$(REASON)"

# Manual pages and completions, generated from the program's own option tables.
PAGES := build/share/man/man1
build/share: build/corcast src/corcast.h src/api/manual.awk
	$(call say,MADE,$@)
	$(Q)rm -rf $@ && mkdir -p $(PAGES) $@/bash-completion/completions $@/zsh/site-functions $@/fish/vendor_completions.d
	$(Q)build/corcast help --as man > $(PAGES)/corcast.1
	$(Q)for name in $$(build/corcast help --as names); do \
		build/corcast help $$name --as man > $(PAGES)/corcast-$$name.1 || exit; done
	$(Q)build/corcast help --as bash > $@/bash-completion/completions/corcast
	$(Q)build/corcast help --as zsh > $@/zsh/site-functions/_corcast
	$(Q)build/corcast help --as fish > $@/fish/vendor_completions.d/corcast.fish
	$(Q)mkdir -p $@/man/man3
	$(Q)awk -v version=$(VERSION) -f src/api/manual.awk src/corcast.h > $@/man/man3/corcast.h.3

reference: build/corcast ## generate docs/REFERENCE.md
	$(Q)build/corcast help --as markdown > build/REFERENCE.md && mv build/REFERENCE.md docs/

# Folders may have blanks in their names.
BIN = "$(DESTDIR)$(PREFIX)/bin
INCLUDE = "$(DESTDIR)$(PREFIX)/include
SHARE = "$(DESTDIR)$(PREFIX)/share
LIBRARIES = "$(DESTDIR)$(LIBDIR)
PYTHON = "$(DESTDIR)$(PYTHONDIR)
install: build/corcast lib build/share ## install program, library, manual pages and completions under $(DESTDIR)$(PREFIX)
	install -d $(BIN)" $(INCLUDE)" $(SHARE)/corcast" $(LIBRARIES)/pkgconfig" $(PYTHON)"
	install -m755 build/corcast $(BIN)/corcast"
	install -m755 build/$(SONAME) $(LIBRARIES)/$(SONAME)"
	ln -sf $(SONAME) $(LIBRARIES)/libcorcast.so"
	install -m644 build/libcorcast.a $(LIBRARIES)/libcorcast.a"
	sed 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(VERSION)|; s|@PACKAGES@|$(PACKAGES)|; s|@LIBS@|$(PLAIN_LIBS)|' \
		src/api/corcast.pc.in > $(LIBRARIES)/pkgconfig/corcast.pc"
	install -m644 src/corcast.h $(INCLUDE)/corcast.h"
	install -m644 src/python/corcast.py src/python/corcast_pytest.py $(PYTHON)"
	cp -R templates $(SHARE)/corcast"
	rm -rf $(SHARE)/corcast/templates/viewer/node_modules"
	$(if $(FONTS),cd $(SHARE)/corcast/templates/fonts" && for font in Liberation*.ttf; do ln -sf "$(FONTS)/$$font" .; done)
	test ! -e build/viewer/viewer.js || install -m644 build/viewer/viewer.js $(SHARE)/corcast/templates/page/viewer.js"
	for folder in $$(cd build/share && find . -type d); do install -d $(SHARE)/$$folder"; done
	for file in $$(cd build/share && find . -type f); do install -m644 build/share/$$file $(SHARE)/$$file"; done
	for folder in . docs docs/decisions docs/images docs/images/looks docs/images/gallery; do install -d $(SHARE)/doc/corcast/$$folder"; done
	install -m644 README.md CHANGELOG.md LICENSE CITATION.cff $(SHARE)/doc/corcast"
	install -m644 docs/*.md $(SHARE)/doc/corcast/docs"
	install -m644 docs/decisions/*.md $(SHARE)/doc/corcast/docs/decisions"
	for folder in images images/looks images/gallery; do install -m644 docs/$$folder/*.[jp]*g $(SHARE)/doc/corcast/docs/$$folder" || exit; done

uninstall: ## remove the files of `make install`
	rm -f $(BIN)/corcast" $(SHARE)/man/man1/corcast.1" $(SHARE)"/man/man1/corcast-*.1
	rm -f $(SHARE)/bash-completion/completions/corcast" $(SHARE)/zsh/site-functions/_corcast"
	rm -f $(SHARE)/fish/vendor_completions.d/corcast.fish"
	rm -f $(LIBRARIES)/$(SONAME)" $(LIBRARIES)/libcorcast.so" $(LIBRARIES)/libcorcast.a" $(LIBRARIES)/pkgconfig/corcast.pc"
	rm -f $(PYTHON)/corcast.py" $(PYTHON)/corcast_pytest.py"
	rm -f $(INCLUDE)/corcast.h" $(SHARE)/man/man3/corcast.h.3"
	rm -rf $(SHARE)/corcast" $(SHARE)/doc/corcast"

VERSION := $(shell sed -n 's/^.define CORCAST_VERSION "\(.*\)"/\1/p' src/base/version.h)
# What a release has beside the commit: the page that grows trees, the viewer, and the parts of three.js that it is made of, so that it can be made again.
RELEASED := LICENSE package.json build/three.core.js build/three.module.js examples/jsm/controls/OrbitControls.js
dist: $(VIEWER) page ## pack the sources of the last commit, the viewer and the page that grows trees into build/corcast-VERSION.tar.gz, with the same bytes each time
	$(Q)mkdir -p build
	$(Q)git archive --format=tar -o build/corcast-$(VERSION).tar --prefix=corcast-$(VERSION)/templates/page/ --add-file=$(VIEWER) \
		$(foreach file,$(RELEASED),--prefix=corcast-$(VERSION)/templates/viewer/node_modules/three/$(filter-out ./,$(dir $(file))) --add-file=build/viewer/node_modules/three/$(file)) \
		--prefix=corcast-$(VERSION)/ --add-file=build/grow/corcast.html HEAD
	$(Q)gzip -9nf build/corcast-$(VERSION).tar

packages: ## build, lint and test the packages of .ci/packages; PACKAGE=wheel for one; results in build/packages/
	$(Q).ci/deps build
	$(Q).ci/packages/run $(PACKAGE)

clean: ## remove build/ and out/
	rm -rf build out
