#!/usr/bin/env bash
# Chooses the Rust toolchain for this checkout: `scripts/toolchain.sh stable`, or `msrv` for the
# oldest version that Cargo.toml promises.
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1:-} in
  stable) version=stable ;;
  msrv) version=$(sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml | head -n 1) ;;
  *)
    echo "usage: scripts/toolchain.sh stable | msrv" >&2
    exit 2
    ;;
esac
rustup toolchain install "$version" --profile minimal --component rustfmt --component clippy
rustup override set "$version"
