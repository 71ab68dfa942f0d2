# Sourced by the other scripts: installs what is missing (Debian 12, Ubuntu 24.04) and says where everything is.
# SPDX-License-Identifier: MIT
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
    g++ cmake ninja-build pkg-config
    libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers glslang-tools
    libglm-dev libopenexr-dev libpng-dev libjpeg-dev libexif-dev libeigen3-dev libpugixml-dev
    nlohmann-json3-dev libcli11-dev libgtest-dev libcairo2-dev fonts-dejavu-core libglfw3-dev libimgui-dev doxygen
    "$@"
)

missing=()
if command -v dpkg-query >/dev/null; then
    for package in "${packages[@]}"; do
        [[ $(dpkg-query -W -f='${Status}' "$package" 2>/dev/null) == *'ok installed'* ]] || missing+=("$package")
    done
else
    for tool in g++ cmake ninja glslangValidator; do command -v "$tool" >/dev/null || missing+=("$tool"); done
fi

if ((${#missing[@]})); then
    as_root=()
    [[ $(id -u) == 0 ]] || as_root=(sudo)
    if ! command -v apt-get >/dev/null || { ((${#as_root[@]})) && ! command -v sudo >/dev/null; }; then
        echo "Please install these first (names of Debian packages): ${packages[*]}" >&2
        echo "Missing here: ${missing[*]}" >&2
        exit 1
    fi
    echo "Installing ${missing[*]}"
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

# build_preset NAME [SETTING...]: configures and builds; quick when nothing has changed.
build_preset() {
    cmake --preset "$@" >/dev/null
    cmake --build --preset "$1"
}
