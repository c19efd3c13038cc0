#!/usr/bin/env bash
# Tests and measures the package and the page in Chromium on a real GPU. Prints a line of JSON per row.
#
#   scripts/browser-gpu.sh [ARGUMENT…]              here
#   scripts/browser-gpu.sh --on COMMAND [ARGUMENT…] on another machine, on which COMMAND runs a command line that is its
#                                                   last argument, with its standard input and output: 'ssh HOST',
#                                                   'docker exec -i NAME sh -c'
#   scripts/browser-gpu.sh --bundle                 only makes target/browser-gpu/{browser,site}.tar.xz, for a machine to
#                                                   which they are brought in another way: unpack both into one folder
#                                                   there, and start its `start.sh [ARGUMENT…]`
#
# ARGUMENTS are those of benches/js/browser.mjs, or `test` to run the tests that need a GPU, or `report` for what the page
# report/ says of the GPU. The other machine needs
# Linux with the C library of Debian 12 or a newer one, a driver with Vulkan, tar and xz. Chromium, Node, an X server
# and their libraries are brought along.
set -euo pipefail
cd "$(dirname "$0")/.."
out=target/browser-gpu
libraries=/usr/lib/x86_64-linux-gnu

say() { echo "browser-gpu: $*" >&2; }

# Prints the libraries that programs and libraries load, but for those of the C library.
libraries_of() {
  ldd "$@" 2>/dev/null | awk '$2 == "=>" && $3 ~ /^\// { print $3 }' |
    grep -Ev '/(libc|libm|libdl|libpthread|librt|libresolv|libutil|ld-linux-x86-64)\.so' | sort -u
}

# Chromium, an X server, Node, fonts, and the libraries that they need.
bundle_browser() {
  local to=$out/browser name
  rm -rf "$to" && mkdir -p "$to"/{bin,chromium/locales,lib,fallback,fonts}
  cp -a /usr/lib/chromium/. "$to/chromium/"
  rm -rf "$to"/chromium/{MEIPreload,extensions,chrome-sandbox}
  find "$to/chromium/locales" -name '*.pak' ! -name en-US.pak -delete
  cp "$(command -v Xvfb)" "$(command -v xkbcomp)" "$to/bin/"
  cp "$(command -v node)" "$to/bin/" && strip "$to/bin/node"
  cp -aL /usr/share/X11/xkb "$to/xkb"
  cp /usr/share/fonts/truetype/*/*Sans*.ttf "$to/fonts/" 2>/dev/null || say 'there are no fonts'
  # These are opened by name.
  local opened=()
  for name in nssckbi softokn3 freebl3 freeblpriv3 X11-xcb Xcursor Xi Xrender xcb-dri3 xcb-glx xcb-present xcb-sync \
    xcb-randr xcb-shm xcb-xfixes xshmfence EGL GL GLX GLESv2 OpenGL GLdispatch vulkan pci; do
    opened+=($(compgen -G "$libraries/lib$name.so" || compgen -G "$libraries/lib$name.so.[0-9]" || true))
  done
  local files=("$to/chromium/chromium" "$to"/bin/{Xvfb,xkbcomp} "${opened[@]}")
  cp -L "${opened[@]}" $(libraries_of "${files[@]}") "$to/lib/"
  # The other machine's driver may need a newer one of these.
  mv "$to"/lib/{libstdc++.so.6,libgcc_s.so.1} "$to/fallback/"
  cp benches/browser/* "$to/"
  tar -C "$to" -c . | xz -T0 >"$out/browser.tar.xz"
}

# The package, the page, and what tests and measures them.
bundle_site() {
  node web/build.mjs >&2
  npm run build --silent --workspace www >&2
  rm -rf "$out/packed" && mkdir "$out/packed"
  node -e "import('./tests/web/package.mjs').then(({ packInto }) => packInto('$PWD/$out/packed'))"
  tar -c --exclude www/tests/screenshots "$out/packed" benches/js benches/browser tests/web tests/data package.json web/dist web/package.json www/dist www/tests \
    node_modules/playwright-core | xz -3 -T0 >"$out/site.tar.xz"
}

on=()
case ${1:-} in
  --on)
    read -ra on <<<"$2"
    shift 2
    ;;
esac
scripts/setup.sh browser-gpu >&2
mkdir -p "$out"
version=$(dpkg-query --show chromium | tr '\t' ' ')
if [[ ! -e $out/browser.tar.xz || $(cat "$out/version" 2>/dev/null) != "$version" ]]; then
  say "bundling $version"
  bundle_browser
  echo "$version" >"$out/version"
fi
say 'building the package and the page'
bundle_site
[[ ${1:-} != --bundle ]] || exit 0

there=(bash -c)
folder=$PWD/$out/run
if ((${#on[@]})); then
  there=("${on[@]}")
  folder=gdel-browser
fi
for part in browser site; do
  "${there[@]}" "mkdir -p $folder && tar -xJ -C $folder" <"$out/$part.tar.xz"
done
"${there[@]}" "$folder/start.sh $(printf '%q ' "$@")"
