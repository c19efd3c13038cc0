#!/usr/bin/env bash
# The guard against losses that nobody notices. It counts, and times nothing: instructions of the
# CPU's work on small fixed inputs, under callgrind; what the GPU engine does on lavapipe; and the
# bytes of the npm package. A count that is off the committed one in benches/guard/figures.json by
# more than its margin fails, whether it is worse or better.
#
#   scripts/guard.sh [--accept] [instructions] [gpu] [sizes]
#
# Without names it counts all; `sizes` needs `npm run build` first. `--accept` writes the rows that
# are off their margins, and those that are new or gone; the others keep their figures, so that
# small losses add up until they are seen. Instructions depend on the compiler: with another rustc
# than that of the figures, it writes all of theirs.
set -euo pipefail
cd "$(dirname "$0")/.."

accept=() sections=()
for argument in "$@"; do
  case $argument in
    --accept) accept=(--accept) ;;
    instructions | gpu | sizes) sections+=("$argument") ;;
    *)
      echo "usage: scripts/guard.sh [--accept] [instructions] [gpu] [sizes]" >&2
      exit 2
      ;;
  esac
done
[[ ${#sections[@]} -gt 0 ]] || sections=(instructions gpu sizes)

[[ ${sections[*]} == sizes ]] || scripts/setup.sh guard
counts=target/guard
mkdir -p "$counts"

# What is pinned, and why:
# * The environment: gungraun clears it and switches address randomisation off. The crate is
#   compiled without the feature `gpu`, so there is one thread.
# * glibc's copies of memory, of which it has several and chooses by the processor: those of SSE2,
#   and no string instructions, whose use depends on the sizes of caches (GLIBC_TUNABLES, in
#   benches/guard/instructions.rs).
# * Profile and lock file: those of the crate, with which it is built for users.
count_instructions() {
  [[ $(uname -sm) == "Linux x86_64" ]] || {
    echo "guard: the figures are those of Linux on x86-64; leave out 'instructions' here" >&2
    exit 1
  }
  GUNGRAUN_RUNNER=$(PATH=${XDG_CACHE_HOME:-$HOME/.cache}/gdel-tools/bin:$PATH command -v gungraun-runner) \
    cargo bench --quiet --locked --package gdel-guard --bench instructions -- \
    --parallel=2 --output-format=json >"$counts/instructions.jsonl"
}

# * lavapipe's threads: with one, the invocations of a kernel always race in the same way.
# * Its vectors, which otherwise are as wide as the processor's: they are what it runs at a time.
# * A folder without which a library of Mesa complains.
# * The cores that are seen, since kernels that stride have two workgroups for each. The profile for
#   tests, with which the tests have compiled nearly all of it: optimisation changes no count.
count_gpu() {
  local lavapipe
  lavapipe=$(compgen -G '/usr/share/vulkan/icd.d/lvp_icd.*.json' | head -n 1)
  cargo test --quiet --locked --all-features --bench gpu_counts --no-run
  XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-$PWD/$counts} VK_DRIVER_FILES=$lavapipe LP_NUM_THREADS=1 LP_NATIVE_VECTOR_WIDTH=256 \
    taskset --cpu-list "$(two_cores)" cargo test --quiet --locked --all-features --bench gpu_counts >"$counts/gpu.txt"
}

# The first two of the cores that this process may use.
two_cores() {
  node -e '
    const status = require("fs").readFileSync("/proc/self/status", "utf8");
    const list = status.match(/^Cpus_allowed_list:\s*(.*)$/m)[1];
    const cores = list.split(",").flatMap((range) => {
      const [first, last = first] = range.split("-").map(Number);
      return Array.from({ length: last - first + 1 }, (_, i) => first + i);
    });
    if (cores.length < 2) throw new Error("the counts of lavapipe are those of two cores");
    console.log(cores.slice(0, 2).join(","));'
}

for section in "${sections[@]}"; do
  [[ $section == sizes ]] || "count_$section"
done
node benches/guard/compare.mjs "${accept[@]}" "${sections[@]}"
