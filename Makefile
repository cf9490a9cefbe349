# Thin wrapper: installs what is missing, builds with Meson, runs.  The build itself is meson.build.
#
#   make          build/ptie
#   make demo     a synthetic recording of a jet, reconstructed and denoised: out/demo/
#   make test     every test; the last line counts them
#   make levels   the tests again with every kernel level of this machine forced
#   make sanitize the tests again under ASan + UBSan, then TSan (longer)
#   make kills    a run of 20,000 frames, killed five times and resumed
#   make fuzz     every reader against damaged files, one minute each (clang); see tools/fuzz

BUILD ?= build
MESON_FLAGS ?=

.PHONY: all demo test levels sanitize kills fuzz clean
all: $(BUILD)/build.ninja
	@ninja -C $(BUILD)

$(BUILD)/build.ninja: | dependencies
	@meson setup $(BUILD) $(MESON_FLAGS)

.PHONY: dependencies
dependencies:
	@tools/install-dependencies build

.PHONY: test-dependencies
test-dependencies:
	@tools/install-dependencies build test program

demo: all
	@tools/demo $(BUILD)/ptie out/demo

test: test-dependencies all
	@meson test -C $(BUILD) --print-errorlogs; tools/count-tests $(BUILD)/meson-logs/testlog.json

levels: test-dependencies all
	@tools/test-levels $(BUILD)

sanitize: test-dependencies
	@tools/sanitize

kills: all
	@tests/cli/kills $(BUILD)/ptie 20000 5 128

fuzz: dependencies
	@tools/fuzz

clean:
	@rm -rf $(BUILD) build-asan build-tsan build-fuzz out
