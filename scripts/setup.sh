#!/usr/bin/env bash
# Installs what building and testing gdel needs, starting from a Debian 12 with rustup, Node 20 and
# git. It says what it does and skips what is there: a second run starts at once.
#
# `scripts/setup.sh guard` also installs what scripts/guard.sh counts instructions with: valgrind
# and gungraun's runner; `scripts/setup.sh lints` what scripts/lint.sh runs, `lints-online` also
# cargo-deny, which it runs with `--online`; `scripts/setup.sh web` what the npm package needs:
# wasm-pack, wasm-bindgen and the npm packages; `scripts/setup.sh web-tests` what checks and tests
# it on top: the browsers, Deno and the linter; `scripts/setup.sh browser-gpu` what
# scripts/browser-gpu.sh bundles; `scripts/setup.sh python` what builds and tests the Python package, except for what pip
# installs.
set -euo pipefail
cd "$(dirname "$0")/.."

say() { echo "setup: $*"; }
fail() {
  echo "setup: $*" >&2
  exit 1
}

what=${1:-rust}
case $what in
  rust | guard | lints | lints-online | web | web-tests | browser-gpu | python) ;;
  *) fail "usage: scripts/setup.sh [guard | lints | lints-online | web | web-tests | browser-gpu | python]" ;;
esac

# System packages: the linker that rustc calls, and a software Vulkan driver (lavapipe) for the
# tests of the GPU code; two browsers for those of the npm package.
packages=(g++ gcc libc6-dev libvulkan1 mesa-vulkan-drivers)
[[ $what != web-tests ]] || packages+=(chromium firefox-esr)
[[ $what != browser-gpu ]] || packages+=(chromium xvfb x11-xkb-utils xkb-data fonts-dejavu-core xz-utils libegl1 libgles2 libgl1)
[[ $what != guard ]] || packages+=(valgrind)
[[ $what != lints* && $what != python ]] || packages+=(python3-venv)

install_packages() {
  local missing=() package
  for package in "${packages[@]}"; do
    [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
      missing+=("$package")
  done
  [[ ${#missing[@]} -gt 0 ]] || return 0

  local as_root=()
  if [[ $EUID -ne 0 ]]; then
    # -n: never wait for a password where there is nobody to type it.
    sudo -n true 2>/dev/null || [[ -t 0 && -n $(command -v sudo) ]] ||
      fail "please run as root: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  say "installing ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -qqy -o Dpkg::Use-Pty=0 --no-install-recommends "${missing[@]}" </dev/null
}

# rustfmt, clippy and the WebAssembly target, for the toolchain that cargo uses here.
install_rust_parts() {
  command -v rustup >/dev/null || fail "rustup is missing: see https://rustup.rs"
  if ! rustup show active-toolchain >/dev/null 2>&1; then
    say "installing the stable Rust toolchain"
    rustup default stable
  fi

  local wanted version
  wanted=$(sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml)
  version=$(rustc --version | cut -d ' ' -f 2)
  [[ $(printf '%s\n' "$wanted" "$version" | sort --version-sort | head -n 1) == "$wanted" ]] ||
    fail "rustc is $version, $wanted or later is needed: run 'rustup update stable'"

  local component components
  components=$(rustup component list --installed)
  for component in rustfmt clippy rust-std-wasm32-unknown-unknown; do
    # A here-string, not a pipe: grep -q closes a pipe early, which pipefail takes for an error.
    grep -q "^$component" <<<"$components" && continue
    say "installing $component"
    case $component in
      rust-std-*) rustup target add "${component#rust-std-}" ;;
      *) rustup component add "$component" ;;
    esac
  done
}

# The version of a crate in the lock file.
locked() { sed -n "/^name = \"$1\"$/{n;s/^version = \"\(.*\)\"$/\1/p}" Cargo.lock; }

# Where tools from crates.io are: all checkouts on this machine share them, since they take minutes to compile.
crates_tools=${XDG_CACHE_HOME:-$HOME/.cache}/gdel-tools

# Installs a tool from crates.io, unless it is there or on the PATH in this version. The tools do not have
# to be fast, but to compile fast: with the optimisation that their work needs.
install_tool() {
  local optimisation=$1 command=$2 crate=$3 version=$4
  shift 4
  ! grep -qs "^\"$crate $version " "$crates_tools/.crates.toml" || return 0
  [[ $("$command" --version 2>/dev/null) != "$command $version"* ]] || return 0
  say "compiling $crate $version: a few minutes"
  CARGO_PROFILE_RELEASE_OPT_LEVEL=$optimisation CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 \
    cargo install --quiet --root "$crates_tools" --version "$version" "$@" "$crate"
}

# The glue that wasm-bindgen writes has to be of the version that the crate was compiled with.
install_wasm_tools() {
  install_tool 1 wasm-bindgen wasm-bindgen-cli "$(locked wasm-bindgen)" --no-default-features --bin wasm-bindgen
  install_tool 0 wasm-pack wasm-pack 0.15.1
}

# The bench and its runner have to be of one version.
install_guard_parts() {
  install_tool 0 gungraun-runner gungraun-runner "$(locked gungraun-runner)" --locked
}

install_npm_packages() {
  local node=0
  node=$(node --version 2>/dev/null | sed 's/^v\([0-9]*\).*/\1/') || true
  [[ ${node:-0} -ge 20 ]] || fail "Node 20 or later is needed: see https://nodejs.org"

  if [[ ! node_modules/.package-lock.json -nt package-lock.json ]]; then
    say "installing the npm packages"
    npm ci --no-audit --no-fund --loglevel=error
    touch node_modules/.package-lock.json
  fi
}

# The linter and formatter. This and Deno are not among the npm packages: a lock file would have to
# name their binaries for all systems, and not every registry has them.
install_biome() {
  local version=2.6.8
  [[ $(.cache/biome/node_modules/.bin/biome --version 2>/dev/null) != "Version: $version" ]] || return 0
  say "installing Biome"
  npm install --prefix .cache/biome --no-save --no-audit --no-fund --loglevel=error "@biomejs/biome@$version"
}

# typos checks the spelling, ruff the Python package.
install_lints() {
  local typos=1.52.0 ruff=0.17.6 tools=.cache/tools/python/bin
  [[ $("$tools/typos" --version 2>/dev/null) != "typos-cli $typos" ||
    $("$tools/ruff" --version 2>/dev/null) != "ruff $ruff" ]] || return 0
  say "installing typos and ruff"
  python3 -m venv .cache/tools/python
  "$tools/pip" install --quiet --disable-pip-version-check "typos==$typos" "ruff==$ruff"
}

# cargo-deny checks licences, sources and known vulnerabilities.
install_online_lints() {
  install_tool 0 cargo-deny cargo-deny 0.20.2 --locked --no-default-features
}

# For one test, which says so where it is missing.
install_deno() {
  [[ ! -e .cache/tools/node_modules/.bin/deno && -z $(command -v deno) ]] || return 0
  say "installing Deno"
  npm install --prefix .cache/tools --no-save --no-audit --no-fund --loglevel=error deno@2.9.6 ||
    say "there is no Deno for this machine: its test will be skipped"
}

# Where there is no package of it: the whole one, since the shell that has no windows does not use the GPU.
install_chromium() {
  [[ -z $(command -v apt-get) ]] || return 0
  say "installing Chromium"
  node_modules/.bin/playwright-core install --no-shell chromium
}

if [[ -n $(command -v apt-get) ]]; then
  install_packages
else
  say "no apt-get here: these packages of Debian, or what they are elsewhere, have to be there: ${packages[*]}"
fi
install_rust_parts
case $what in
  guard) install_guard_parts ;;
  lints | lints-online)
    install_lints
    install_biome
    [[ $what == lints ]] || install_online_lints
    ;;
  web | web-tests | browser-gpu)
    install_npm_packages
    install_wasm_tools
    ;;
esac
if [[ $what == web-tests ]]; then
  install_biome
  install_deno
  install_chromium
fi
say "ready"
