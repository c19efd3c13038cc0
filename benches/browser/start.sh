#!/bin/bash
# Starts what is bundled here (scripts/browser-gpu.sh): an X server and the benchmark, or with `test` the tests that
# need a GPU, or with `report` the page that writes the report of a device.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
export CHROMIUM=$here/chromium.sh DISPLAY=:77 GDEL_REAL_GPU=1
# Chromium's processes share memory there: a mesh of five million points takes gigabytes.
free=$(df -BG --output=avail /dev/shm 2>/dev/null | tail -n 1 | tr -dc 0-9)
if [[ $EUID == 0 && ${free:-0} -lt 16 ]]; then
  mount -o remount,size=40G /dev/shm 2>/dev/null || mount -t tmpfs -o size=40G tmpfs /dev/shm 2>/dev/null || true
fi
# The X server looks for it there.
[[ -e /usr/bin/xkbcomp ]] || cp "$here/bin/xkbcomp" /usr/bin/
mkdir -p /tmp/.X11-unix
"$here/with-libraries.sh" "$here/bin/Xvfb" "$DISPLAY" -screen 0 1600x1200x24 -nolisten tcp -xkbdir "$here/xkb" >/dev/null 2>&1 &
trap 'kill $! 2>/dev/null || true' EXIT
until [[ -e /tmp/.X11-unix/X77 ]]; do
  kill -0 $! || { echo 'the X server does not start' >&2 && exit 1; }
  sleep 0.1
done
cd "$here"
if [[ ${1:-} == test ]]; then
  GDEL_PACKED=$here/target/browser-gpu/packed bin/node --test tests/web/chromium.test.mjs
elif [[ ${1:-} == report ]]; then
  bin/node benches/js/report.mjs "${@:2}"
else
  bin/node benches/js/browser.mjs "$@"
fi
