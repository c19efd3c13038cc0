#!/usr/bin/env bash
# Runs all tests, or those that the arguments select, as `cargo test` does.
#
# The tests of the GPU code run on lavapipe, Mesa's software Vulkan driver, where it is installed: the same device
# everywhere, so that a failure here is a failure elsewhere. Set VK_DRIVER_FILES to choose another driver.
set -euo pipefail
cd "$(dirname "$0")/.."

lavapipe=$(compgen -G '/usr/share/vulkan/icd.d/lvp_icd.*.json' | head -n 1 || true)
if [[ -z ${VK_DRIVER_FILES:-} && -n $lavapipe ]]; then
  export VK_DRIVER_FILES=$lavapipe
fi
[[ $# -eq 0 ]] || exec cargo test --locked --all-features "$@"
cargo test --locked --all-features --lib --bins --tests
cargo test --locked --all-features --doc
for example in examples/*.rs; do
  cargo run --locked --all-features --example "$(basename "$example" .rs)"
done
