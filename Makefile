# corcast: one Makefile for everything. `make help` lists the targets.
#
# MODE   release (default), debug, asan, tsan; objects live in build/$(MODE)/
# CC     gcc or clang
# V=1    show the commands

MODE ?= release
PREFIX ?= /usr/local
CC ?= cc
BUILD := build/$(MODE)
Q := $(if $(V),,@)
say = $(if $(V),,@printf '  %-6s %s\n' $(1) $(2))

ROOMS := $(filter-out app,$(notdir $(patsubst %/,%,$(wildcard src/*/))))
ROOM_SOURCES := $(wildcard $(ROOMS:%=src/%/*.c))
APP_SOURCES := $(wildcard src/app/*.c)
TEST_SOURCES := $(wildcard tests/unit/*_test.c)

ROOM_OBJECTS := $(ROOM_SOURCES:%.c=$(BUILD)/%.o)
APP_OBJECTS := $(APP_SOURCES:%.c=$(BUILD)/%.o)
TEST_PROGRAMS := $(TEST_SOURCES:tests/unit/%.c=$(BUILD)/tests/%)

WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wdouble-promotion \
	-Wstrict-prototypes -Wmissing-prototypes -Wold-style-definition -Wvla -Wformat=2 -Wcast-qual \
	-Wpointer-arith -Wundef -Wwrite-strings -Werror
OPTIMISE_release := -O2 -g
OPTIMISE_debug := -O0 -g3
OPTIMISE_asan := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
OPTIMISE_tsan := -O1 -g -fsanitize=thread
PACKAGES := libpng jansson
# Same seed, same bytes with every compiler: no contraction of a * b + c, no reassociation.
CFLAGS := -std=c11 $(OPTIMISE_$(MODE)) -ffp-contract=off $(WARNINGS)
CPPFLAGS := -Isrc -D_GNU_SOURCE $(shell pkg-config --cflags $(PACKAGES) 2>/dev/null)
LDFLAGS := $(filter -fsanitize%,$(OPTIMISE_$(MODE)))
LDLIBS := $(shell pkg-config --libs $(PACKAGES) 2>/dev/null) -linih -lpthread -lm

.PHONY: all deps demo check unit layers format asan tsan golden-update install clean help
.DELETE_ON_ERROR:
.SECONDARY:

all: build/corcast

# The program users run is always the release build.
ifeq ($(MODE),release)
build/corcast: $(BUILD)/corcast
	$(Q)cp $< $@
else
build/corcast:
	$(Q)$(MAKE) MODE=release build/corcast
endif

$(BUILD)/corcast: $(APP_OBJECTS) $(BUILD)/rooms.a
	$(call say,LINK,$@)
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(LDLIBS)

$(BUILD)/rooms.a: $(ROOM_OBJECTS)
	$(call say,AR,$@)
	$(Q)rm -f $@ && $(AR) rcs $@ $^

$(BUILD)/%.o: %.c Makefile
	$(call say,CC,$<)
	$(Q)mkdir -p $(@D)
	$(Q)$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<

$(BUILD)/tests/%: $(BUILD)/tests/unit/%.o $(BUILD)/rooms.a
	$(call say,LINK,$@)
	$(Q)mkdir -p $(@D)
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(LDLIBS) -lcmocka

-include $(ROOM_OBJECTS:.o=.d) $(APP_OBJECTS:.o=.d) $(TEST_SOURCES:%.c=$(BUILD)/%.d)

unit: $(TEST_PROGRAMS)
	$(Q)for program in $(TEST_PROGRAMS); do $$program || exit 1; done

layers:
	$(Q)tests/check-layers
