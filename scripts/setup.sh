# Sourced by the other scripts: installs what is missing (Debian 12, Ubuntu 24.04), says what is done and how long it took.
# SPDX-License-Identifier: MIT
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
    g++ cmake ninja-build pkg-config
    libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers glslang-tools
    libglm-dev libopenexr-dev libpng-dev libjpeg-dev libexif-dev libwebp-dev libdraco-dev libeigen3-dev libembree-dev libmeshoptimizer-dev libpugixml-dev
    libtinygltf-dev libprotobuf-dev protobuf-compiler
    nlohmann-json3-dev libcli11-dev libgtest-dev libcairo2-dev fonts-dejavu-core libglfw3-dev libimgui-dev doxygen
    "$@"
)

# step TEXT: says what begins, and how long the step before took.
step_began=
step() {
    step_end
    step_began=$SECONDS step_text=$1
    echo "== $1"
}
step_end() {
    [[ -z $step_began ]] || echo "   $step_text: $(in_minutes $((SECONDS - step_began)))"
    step_began=
}
in_minutes() { printf '%d min %02d s' $(($1 / 60)) $(($1 % 60)); }

# bar DONE OF TEXT: a bar that stays on its line in a terminal.
bar() {
    local width=30 filled end='\n'
    filled=$((width * $1 / $2))
    [[ ! -t 1 || $1 == "$2" ]] || end='\r'
    printf "[%-${width}s] %*d/%d %-50.50s$end" "$(printf '%*s' "$filled" '' | tr ' ' '#')" ${#2} "$1" "$2" "$3"
}

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
    step "Installing ${missing[*]}"
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
    step_end
fi

# Packages without which some tests are passed over: installed where that is possible.
wanted=()
for package in ${optional_packages[@]+"${optional_packages[@]}"}; do
    [[ $(dpkg-query -W -f='${Status}' "$package" 2>/dev/null) == *'ok installed'* ]] || wanted+=("$package")
done
if ((${#wanted[@]})) && [[ $(id -u) == 0 ]] && command -v apt-get >/dev/null; then
    step "Installing ${wanted[*]}"
    { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${wanted[@]}"; } \
        >/dev/null 2>&1 || echo "Not installed; tests that need them are passed over"
    step_end
fi

# configure PRESET [SETTING...]
configure() { cmake --preset "$@" >/dev/null; }
# build PRESET [--target TARGET...]: quick when nothing has changed. Ninja shows a share and seconds.
build() { NINJA_STATUS='[%p, %e s] ' cmake --build --preset "$@"; }
