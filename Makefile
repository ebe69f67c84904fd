# The commands for people and for CI; `make` without a target lists them. scripts/setup installs missing tools.

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
MAKEFLAGS += --no-builtin-rules --no-print-directory
# Two runs of cargo in one target folder wait for each other, and cargo itself uses every core. So make starts one
# command at a time. A -j for make is not passed on to cargo, which would wait for job tokens of make.
.NOTPARALLEL:
unexport MAKEFLAGS MFLAGS
.PHONY: help play build page test tests check format lint docs fuzz bits bench clean FORCE

# The pinned Rust, or the default one where rustup cannot fetch the pinned one.
TOOLCHAIN := $(shell scripts/toolchain)
ifneq ($(TOOLCHAIN),)
export RUSTUP_TOOLCHAIN := $(TOOLCHAIN)
endif

# The command is always compiled with its page, so that no target causes another to compile again.
WORKSPACE := --workspace --features qhat-cli/page
COMMAND := target/release/qhat
PAGE := playground/dist/index.html
WASM := playground/src/wasm/qhat_wasm_bg.wasm

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "make %-7s %s\n", $$1, $$2 }' Makefile

play: build ## open the page (SCENE=scenes/name.toml for a scene of your own)
	@$(COMMAND) play $(SCENE)

build: page ## the qhat command with the page inside, in target/release/qhat
	@echo "Building the command"
	@cargo build --release --package qhat-cli --features page

page: $(PAGE) ## the page alone, in playground/dist

# The list has folders as well as files, so that a removed file counts as a change.
PAGE_SOURCES = $(shell find playground/src playground/public scenes \
	-path playground/src/wasm -prune -o -print 2>/dev/null)
$(PAGE): $(WASM) $(PAGE_SOURCES) \
		$(wildcard playground/*.json playground/*.ts playground/*.html)
	@echo "Building the page"
	@npm --prefix playground run --silent build

# The script runs every time, because cargo knows which sources changed. It does not touch the file if its
# content is the same.
$(WASM): FORCE
	@scripts/setup wasm page
	@echo "Building the engine for the browser"
	@scripts/build-wasm

# In this order, one after the other: a failed test is more important than a failed lint.
test: build tests lint docs ## all builds, tests, lints and documents, here and in CI

tests:
	@scripts/setup browser
	@echo "Testing the Rust crates"
	@cargo test --release $(WORKSPACE)
	@echo "Testing that wasm computes the same bits"
	@scripts/build-wasm --node
	@node --test crates/qhat-wasm/tests/golden.mjs
	@echo "Testing the page"
	@npm --prefix playground run --silent test

check: ## fast checks while you write: format, lints and tests of the crates that differ from main (CRATES="qhat …")
	@scripts/check $(CRATES)

format: ## format all files; a good pre-commit hook
	@cargo fmt --all
	@if [ -d playground/node_modules ]; then npm --prefix playground run --silent format; fi

lint: page
	@echo "Checking format, lints and types"
	@cargo fmt --all --check
	@cargo clippy $(WORKSPACE) --all-targets -- -D warnings
	@npm --prefix playground run --silent check

docs: ## the Rust documentation, in target/doc
	@echo "Building the documentation"
	@RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps

fuzz: ## random frameworks, heaps, expressions and scenes: TIMES=20 test runs of them, or new ones for MINUTES=n
	@cargo build --release --quiet --package qhat-differ
ifdef MINUTES
	@echo "Trying new frameworks and hostile scenes for $(MINUTES) minutes"
	@target/release/qhat-differ fuzz $(MINUTES)
else
	@echo "Trying $(or $(TIMES),20) times as many random cases as a test run does"
	@QHAT_FUZZ=$(or $(TIMES),20) cargo test --release --package qhat --test all -- random_ long_heaps
	@QHAT_FUZZ=$(or $(TIMES),20) cargo test --release --package qhat-scene --test all -- hostile
	@cargo test --release --package qhat-differ --test all -- --ignored planted
	@target/release/qhat-differ seeds 0 $$((390 * $(or $(TIMES),20)))
endif

bits: ## compare the bits of a debug build, and of aarch64 under emulation, with those of the golden test
	@echo "Testing that a debug build computes the same bits"
	@cargo test --package qhat-scene --test golden
	@scripts/setup aarch64
	@echo "Testing that aarch64 computes the same bits"
	@scripts/bits

bench: ## time, length error and energy error of qhat and other engines, into benches/results (about half an hour)
	@cargo build --release --quiet --package qhat-bench
	@echo "Running every shipped scene three times"
	@target/release/qhat-bench scenes
	@echo "Running every workload"
	@target/release/qhat-bench workloads
	@benches/peers/run
	@echo "Counting the instructions of seven kernels"
	@target/release/qhat-bench kernels

clean: ## remove everything that was built (npm packages and cached tools stay)
	@cargo clean --quiet
	@rm -rf playground/dist playground/src/wasm
