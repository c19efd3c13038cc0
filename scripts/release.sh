#!/usr/bin/env bash
# The steps of a release, in order:
#
#   scripts/release.sh check vX.Y.Z   the tag, the crates, the package and the changelog agree
#   scripts/release.sh crate          publishes the crates; --dry-run packs and builds them only
#   scripts/release.sh npm            builds and publishes the npm package; --dry-run packs it only
set -euo pipefail
cd "$(dirname "$0")/.."

fail() {
  echo "release: $*" >&2
  exit 1
}

version() { sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -n 1; }

case ${1:-} in
  check)
    tag=${2:?usage: scripts/release.sh check vX.Y.Z}
    [[ $tag == "v$(version)" ]] || fail "the tag is $tag, Cargo.toml says $(version)"
    npm=$(node -p "require('./web/package.json').version")
    [[ $tag == "v$npm" ]] || fail "the tag is $tag, web/package.json says $npm"
    grep -q "^## \[${tag#v}\]" CHANGELOG.md || fail "CHANGELOG.md has no section [${tag#v}]"
    for file in Cargo.toml web/package.json; do
      ! grep -q 'REPOSITORY' "$file" || fail "$file still has the placeholder REPOSITORY"
    done
    ;;
  crate)
    shift
    cargo publish --locked -p gdel -p gdel-io -p gdel-cli -p gdel-cuda "$@"
    ;;
  npm)
    shift
    npm run build
    # Provenance can only be attested where the forge signs it.
    [[ -z ${GITHUB_ACTIONS:-} ]] || set -- --provenance "$@"
    npm publish --workspace web --access public "$@"
    ;;
  *)
    fail "usage: scripts/release.sh check vX.Y.Z | crate [--dry-run] | npm [--dry-run]"
    ;;
esac
