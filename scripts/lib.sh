# shellcheck shell=bash
# Shared by the scripts of this folder and by benches/peers/run: messages, the folder of downloaded tools, the
# installation of Debian packages, the Rust that can compile for the browser, and the wasm-bindgen that belongs to this
# checkout.

cache=${XDG_CACHE_HOME:-$HOME/.cache}/qhat
wasm_target=wasm32-unknown-unknown
aarch64_target=aarch64-unknown-linux-gnu
# The loader and the C library that a program for aarch64 finds under emulation.
aarch64_libraries=/usr/aarch64-linux-gnu

say() { printf '%s: %s\n' "${0##*/}" "$*"; }
die() {
    printf '%s: %s\n' "${0##*/}" "$*" >&2
    exit 1
}

# Runs a command for at most this many seconds, or without a limit on systems that have no `timeout`.
bounded() {
    local -a limit=()
    if command -v timeout >/dev/null; then limit=(timeout --foreground "$1"); fi
    "${limit[@]}" "${@:2}"
}

# Installs Debian packages; the only step that needs root.
install_debian() {
    command -v apt-get >/dev/null || die "please install: $* (this machine has no apt-get to do it with)"
    local -a root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || die "please install as root: apt-get install --no-install-recommends $*"
        say "this needs root, so sudo may ask for your password: apt-get install $*"
        root=(sudo)
    fi
    local log
    log=$(mktemp)
    # The lists may be old or absent; a broken third-party source must not stop us from using the others.
    "${root[@]}" apt-get -q update >"$log" 2>&1 ||
        say "apt-get update reported a problem; trying to install all the same"
    if ! "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get -qy -o DPkg::Lock::Timeout=300 install --no-install-recommends "$@" >>"$log" 2>&1; then
        tail -n 20 "$log" >&2
        die "apt-get could not install: $*"
    fi
    rm -f "$log"
}

# Whether the Rust on PATH has the standard library of a target. The sysroot is searched, because a Rust that rustup
# does not manage may have it, too.
rust_has() { [ -d "$(rustc --print sysroot)/lib/rustlib/$1/lib" ]; }

# The Rust that compiles for the browser: `own` (the one on PATH has the target), `debian` (the second Rust of
# Debian 12, which builds the standard library from source), or nothing.
wasm_rust() {
    if rust_has "$wasm_target"; then
        echo own
    elif [ -x /usr/bin/rustc ] && [ -x /usr/bin/cargo ] && debian_std_source >/dev/null && wasm_linker >/dev/null; then
        echo debian
    fi
}

# The folder in which -Z build-std expects the source of the standard library of the second Rust.
debian_std_source() {
    local source
    source=$(/usr/bin/rustc --print sysroot)/lib/rustlib/src/rust/library/Cargo.lock
    [ -e "$source" ] && echo "$source"
}

# Debian's second Rust has no linker for wasm: use the linker of the rustup toolchain, or LLVM's.
wasm_linker() {
    local host linker
    host=$(rustc -vV | sed -n 's/^host: //p')
    for linker in "$(rustc --print sysroot)/lib/rustlib/$host/bin/rust-lld" wasm-ld wasm-ld-19; do
        command -v "$linker" && return
    done
    return 1
}

# The command wasm-bindgen and the crate must have the same version; Cargo.lock has the version of the crate.
wasm_bindgen_version() {
    local version
    [ -e Cargo.lock ] || die "Cargo.lock is missing; it says which wasm-bindgen to use"
    version=$(awk '/^name = "wasm-bindgen"$/ { getline; gsub(/version = |"/, ""); print; exit }' Cargo.lock)
    [ -n "$version" ] || die "Cargo.lock names no wasm-bindgen"
    echo "$version"
}

# The wasm-bindgen command of this version: the copy of scripts/setup, or the command on PATH if its version is the
# same.
wasm_bindgen() {
    local version=$1 own=$cache/wasm-bindgen-$1/bin/wasm-bindgen
    if [ -x "$own" ]; then
        echo "$own"
    elif [ "$(wasm-bindgen --version 2>/dev/null)" = "wasm-bindgen $version" ]; then
        command -v wasm-bindgen
    fi
}
