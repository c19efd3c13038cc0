#!/usr/bin/env bash
# Runs every lint that a change has to pass. `--online` adds what depends on the world outside as
# well: licences, sources and known vulnerabilities of the dependencies, and semantic versioning.
set -euo pipefail
cd "$(dirname "$0")/.."
PATH=${XDG_CACHE_HOME:-$HOME/.cache}/gdel-tools/bin:$PWD/.cache/tools/python/bin:$PATH

step() {
  echo "== $* ($SECONDS s)"
  "$@"
}

online=false
[[ ${1:-} != --online ]] || online=true

step cargo fmt --all --check
step cargo clippy --locked --workspace --all-targets --all-features -- -D warnings
# The library must build wherever Rust does: with no feature, with threads, which the others then find or do
# not, and with the GPU; clippy has checked it with all of them. The features between which nothing depends on
# each other are checked together.
for features in "" threads glam,mint,nalgebra,ndarray,serde gpu; do
  step cargo check --locked --package gdel --lib --no-default-features --features "$features"
done
wasm=(--target wasm32-unknown-unknown)
step cargo clippy --locked --lib --package gdel --features gdel/gpu \
  --package gdel-web --features gdel-web/d2,gdel-web/d3,gdel-web/edit,gdel-web/tools,gdel-web/derived,gdel-web/surface,gdel-web/transport "${wasm[@]}" -- -D warnings
# The fuzz targets; what they are linked to needs a compiler of C++ and is not needed for a check.
CUSTOM_LIBFUZZER_PATH=target/libfuzzer.a step cargo check --locked --manifest-path fuzz/Cargo.toml --target-dir "${CARGO_TARGET_DIR:-target}"
# With the features of the dependencies that clippy has checked them with.
RUSTDOCFLAGS="-D warnings" step cargo doc --locked --workspace --no-deps --all-features
step typos
step ruff check --quiet python
step ruff format --check --quiet python
step npm run lint --silent
step node scripts/circles.mjs
step node scripts/benchmarks.mjs --check
step node scripts/devices.mjs --check
if $online; then
  step cargo deny --all-features check
  step cargo semver-checks
fi
