#!/bin/bash
# Runs a program with the libraries of this bundle, and those of NVIDIA's driver where it is mounted.
here=$(cd "$(dirname "$0")" && pwd)
libraries=$here/lib
# The system's C++ library is newer, if there is one.
ldconfig -p | grep -q 'libstdc++\.so\.6' || libraries=$libraries:$here/fallback
for folder in /usr/local/nvidia/lib64 /usr/local/nvidia/lib; do
  [[ ! -d $folder ]] || libraries=$libraries:$folder
done
icd=/usr/local/nvidia/share/vulkan/icd.d/nvidia_icd.json
[[ ! -e $icd || -n ${VK_ICD_FILENAMES:-} ]] || export VK_ICD_FILENAMES=$icd
# The name of before, which Chromium replaces where it is to use SwiftShader.
[[ -z ${VK_DRIVER_FILES:-} ]] || export VK_ICD_FILENAMES=$VK_DRIVER_FILES
unset VK_DRIVER_FILES
export LD_LIBRARY_PATH=$libraries FONTCONFIG_FILE=$here/fonts.conf XDG_RUNTIME_DIR=${TMPDIR:-/tmp}
exec "$@"
