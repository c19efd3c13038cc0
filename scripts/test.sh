#!/usr/bin/env bash
# Sets up what is missing and runs all tests: those of the crates, the npm package, the demo page and the Python package.
#
#   scripts/test.sh                everything
#   scripts/test.sh crate          the crates
#   scripts/test.sh js [FILE…]     the package and the page, or these test files of theirs
#   scripts/test.sh python [ARG…]  the Python package: a wheel in a fresh environment, or what pytest makes of these arguments
#   scripts/test.sh ARGUMENT…      what `cargo test` makes of these arguments
#
# The tests of the GPU code run on lavapipe, Mesa's software Vulkan driver, where it is installed:
# the same device everywhere, so that a failure here is a failure elsewhere. Set VK_DRIVER_FILES to
# choose another driver.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD

scratch=$(mktemp -d)
# What still runs when a step has failed ends, too.
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$scratch"' EXIT

# Without this folder, a library of Mesa complains on standard error as soon as somebody looks for a GPU.
export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-$scratch}

on_lavapipe() {
  local lavapipe
  lavapipe=$(compgen -G '/usr/share/vulkan/icd.d/lvp_icd.*.json' | head -n 1 || true)
  if [[ -z ${VK_DRIVER_FILES:-} && -n $lavapipe ]]; then
    VK_DRIVER_FILES=$lavapipe "$@"
  else
    "$@"
  fi
}

targets=(--all-features --tests)
build_crate() {
  cargo test --locked --no-run "${targets[@]}" &&
    cargo build --locked --all-features --examples
}
test_crate() {
  build_crate &&
    on_lavapipe cargo test --locked "${targets[@]}" &&
    on_lavapipe cargo test --locked --all-features --doc &&
    for example in examples/*.rs; do
      on_lavapipe "${CARGO_TARGET_DIR:-target}/debug/examples/$(basename "$example" .rs)" || return
    done
}

build_js() { node web/build.mjs && npm run build --silent --workspace www; }
test_js() { node --no-concurrent-recompilation scripts/test-js.mjs "$@"; }

# Builds the wheel with the profile of the tests, of which most is compiled then, and tests it in a fresh environment.
test_python() {
  local environment=$scratch/python pip
  python3 -m venv "$environment" || return
  # On Windows, the programs are elsewhere.
  PATH=$environment/bin:$environment/Scripts:$PATH
  pip=(python -m pip install --quiet --disable-pip-version-check)
  "${pip[@]}" --requirement python/tests/requirements.txt &&
    maturin build --locked --quiet --profile dev --auditwheel skip --manifest-path python/Cargo.toml --out "$scratch/wheels" &&
    "${pip[@]}" --no-deps --no-index "$scratch"/wheels/*.whl &&
    (cd "$scratch" && mypy --config-file "$root/python/pyproject.toml" &&
      python -m mypy.stubtest gdel._gdel --mypy-config-file "$root/python/pyproject.toml") &&
    on_lavapipe pytest --config-file python/pyproject.toml "${@:-python/tests}"
}

# Runs a step of the crate and one of the package and the page at the same time, since neither keeps
# all processors busy. What the second one prints comes after the first one, except for what it says of its progress on
# standard error, which is shown at once; it is left out where only the first one failed, so that the failure is the last
# thing that is said.
both() {
  local log=$scratch/$2 first=passed second=passed
  "$2" 2>&1 >"$log" &
  local beside=$!
  "$1" || first=failed
  wait "$beside" || second=failed
  [[ $first == failed && $second == passed ]] || cat "$log"
  echo "$1 has $first, $2 has $second."
  [[ $first == passed && $second == passed ]]
}

case ${1:-} in
  '')
    scripts/setup.sh web-tests
    scripts/setup.sh python
    both build_crate build_js
    # The page's tests check with it what the page saves.
    export GDEL=${CARGO_TARGET_DIR:-$PWD/target}/debug/gdel
    both test_crate test_js
    test_python
    echo 'All tests of the crate, the packages and the page have passed.'
    ;;
  crate)
    scripts/setup.sh
    test_crate
    ;;
  js)
    scripts/setup.sh web-tests
    build_js
    test_js "${@:2}"
    ;;
  python)
    scripts/setup.sh python
    test_python "${@:2}"
    ;;
  *) on_lavapipe cargo test --locked --all-features "$@" ;;
esac
