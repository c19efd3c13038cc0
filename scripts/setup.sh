#!/usr/bin/env bash
# Installs what building and testing gdel needs, starting from a Debian 12 with rustup, Node 20 and git. It says what it
# does and skips what is there: a second run starts at once.
set -euo pipefail
cd "$(dirname "$0")/.."

say() { echo "setup: $*"; }
fail() {
  echo "setup: $*" >&2
  exit 1
}

# System packages: the linker that rustc calls, and a software Vulkan driver (lavapipe) for the tests of the GPU code.
install_packages() {
  local missing=() package
  for package in gcc libc6-dev libvulkan1 mesa-vulkan-drivers; do
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

if [[ -n $(command -v apt-get) ]]; then
  install_packages
else
  say "no apt-get here: a C linker and a Vulkan driver (Mesa's lavapipe will do) have to be there already"
fi
install_rust_parts
say "ready"
