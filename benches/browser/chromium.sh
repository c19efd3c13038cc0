#!/bin/bash
# Starts the bundled Chromium in a window of the X server, with WebGPU on the machine's GPU. What would choose another
# adapter among the arguments is left out. Without Vulkan for what pages draw, Chromium gives them SwiftShader.
here=$(cd "$(dirname "$0")" && pwd)
arguments=()
for argument; do
  case $argument in
    --headless* | --use-webgpu-adapter=* | --use-vulkan=* | --use-angle=* | --use-gl=* | --disable-gpu* | --disable-dev-shm-usage) ;;
    --enable-features=* | --enable-unsafe-swiftshader | --ozone-platform=*) ;;
    *) arguments+=("$argument") ;;
  esac
done
exec "$here/with-libraries.sh" "$here/chromium/chromium" --ozone-platform=x11 --window-position=0,0 --test-type \
  --enable-unsafe-webgpu --ignore-gpu-blocklist --enable-webgpu-developer-features \
  --use-angle=vulkan --enable-features=Vulkan --disable-vulkan-surface --js-flags=--expose-gc "${arguments[@]}"
